// The command line of `aircut accuracy`.
#include "cli/accuracy_arguments.h"

#include <CLI/CLI.hpp>

namespace aircut::cli {

CLI::App* add_accuracy(CLI::App& app, AccuracyArguments& a) {
  CLI::App* c = app.add_subcommand(
      "accuracy",
      "what the cutting forces of a set-up do to the size of the part, and how it scatters\n\n"
      "  aircut accuracy programs/accuracy/twin-turret.toml\n"
      "  aircut accuracy programs/accuracy/twin-turret.toml --sweep T2.t=1:4:1 --plot t2.png\n\n"
      "A sweep changes CONTACT.t, .S, .V, .dt or .start, TOOL.body (the carriage), sign_policy,\n"
      "angular or coupled; several of them give all combinations.");
  c->add_option("SETUP", a.setup, "bodies, tools, contacts, sizes (docs/accuracy.md)")->required();
  const std::map<std::string, Format> formats = {{"human", Format::human}, {"json", Format::json}};
  c->add_option("--format", a.format, "form of the result on standard output")
      ->transform(CLI::CheckedTransformer(formats).description(""))
      ->type_name("human|json");
  c->add_option("-o,--out", a.folder, "folder for accuracy.json and accuracy.csv, or sweep.csv")
      ->type_name("DIR");
  c->add_flag("--force", a.force, "write into a folder that exists, replace a picture");
  c->add_flag("--influence", a.influence, "the compliance blocks E_kl in the JSON");
  c->add_option("--sweep", a.sweep, "what changes: NAME=FROM:TO:STEP or NAME=A,B,C (repeatable)")
      ->type_name("NAME=VALUES");
  c->add_option("--plot", a.plot, "PNG file: the sweep's result over its first range")
      ->type_name("FILE");
  c->add_option("--of", a.of,
                "column of the sweep that is drawn, e.g. T1.delta_um (the default: "
                "the first)")
      ->type_name("COLUMN");
  const std::map<std::string, When> words = {
      {"auto", When::automatic}, {"always", When::always}, {"never", When::never}};
  c->add_option("--color", a.color, "colours in messages")
      ->transform(CLI::CheckedTransformer(words).description(""))
      ->type_name("auto|always|never");
  return c;
}

}  // namespace aircut::cli
