// The command line of `aircut log` and `aircut diff`.
#include "cli/log_arguments.h"

#include <CLI/CLI.hpp>
#include <limits>

namespace aircut::cli {
namespace {

// A span of time, and thinning, of the commands that read rows.
void add_span(CLI::App* app, LogArguments& a) {
  app->add_option("--from", a.from, "begin, s")->check(CLI::NonNegativeNumber)->type_name("S");
  app->add_option("--to", a.to, "end, s")->check(CLI::NonNegativeNumber)->type_name("S");
}

}  // namespace

CLI::App* add_log(CLI::App& app, LogArguments& a) {
  using Action = LogArguments::Action;
  CLI::App* log =
      app.add_subcommand("log",
                         "look at joint logs: check, compare, convert, draw\n\n"
                         "  aircut log check out/joints.csv --program part.ngc -m mill3\n"
                         "  aircut log plot out/joints.csv -o joints.png");
  log->require_subcommand(1);
  const auto add = [&](const char* name, const char* text, Action action) {
    CLI::App* c = log->add_subcommand(name, text);
    c->add_option("LOG", a.file, "joints.csv or .h5 of aircut run")->required();
    c->add_option("--color", a.color_word, "colours in messages")
        ->check(CLI::IsMember({"auto", "always", "never"}).description(""))
        ->type_name("auto|always|never");
    c->callback([&a, action] { a.action = action; });
    return c;
  };
  const auto add_out = [&](CLI::App* c, const char* text) {
    c->add_option("-o,--out", a.output, text)->required()->type_name("FILE");
    c->add_flag("--force", a.force, "replace a file that exists");
  };
  CLI::App* check =
      add("check", "speeds, accelerations, jerks, feed and path, by the log's rows alone",
          Action::check);
  check->add_option("--program", a.program.program, "the program, to check the path and the feed")
      ->type_name("FILE");
  check->add_option("-m,--machine", a.program.machine, "the machine that it ran on")
      ->type_name("MACHINE");
  check->add_option("--setup", a.program.setup, "setup.toml of the run")->type_name("FILE");
  check->add_option("-t,--tools", a.program.tools, "tools of the run")->type_name("FILE");
  check->add_option("--var", a.program.parameters, "parameter file of the run")->type_name("FILE");
  add("info", "header, times, and the most that each joint does", Action::info);
  CLI::App* diff = add("diff", "where two logs differ at equal times", Action::diff);
  diff->add_option("OTHER", a.other, "the other log")->required();
  diff->add_option("--tolerance", a.tolerance,
                   "less is no difference, mm or degrees (default 1e-6)")
      ->check(CLI::NonNegativeNumber)
      ->type_name("MM");
  CLI::App* table =
      add("export", "a table: .csv, .json, .npy for numpy, or the log as .h5", Action::table);
  add_out(table, "file; its ending says the form: .csv .json .npy .h5");
  table->add_option("--columns", a.columns, "which columns, e.g. t,line,q0,q1 (default all)")
      ->delimiter(',')
      ->type_name("LIST");
  table->add_option("--every", a.every, "every N-th row")
      ->check(CLI::Range(1, 1000000000).description(""))
      ->type_name("N");
  table->add_flag("--header", a.header, ".csv with the header lines: a joint log again");
  add_span(table, a);
  CLI::App* plot =
      add("plot", "a picture: joints, feed, shares of the limits over time", Action::plot);
  add_out(plot, "PNG file");
  plot->add_option("--width", a.width, "pixels (default 1600)")
      ->check(CLI::Range(600, 16384).description(""))
      ->type_name("PX");
  add_span(plot, a);
  return log;
}

CLI::App* add_diff(CLI::App& app, DiffArguments& a) {
  CLI::App* diff = app.add_subcommand(
      "diff",
      "compare the motion of two programs: path, feed, spindle, tools; comments, line numbers and\n"
      "ways of writing do not count\n\n"
      "  aircut diff old.ngc new.ngc\n"
      "  aircut diff old.ngc new.ngc -m mill3");
  diff->add_option("A", a.one, "a program")->required();
  diff->add_option("B", a.two, "the other program")->required();
  diff->add_option("-m,--machine", a.program.machine, "machine whose axes and tools count")
      ->type_name("MACHINE");
  diff->add_option("-t,--tools", a.program.tools, "tool table")->type_name("FILE");
  diff->add_option("--var", a.program.parameters, "parameter file")->type_name("FILE");
  diff->add_option("--dialect", a.program.dialect, "whose control the programs are for")
      ->check(CLI::IsMember({"linuxcnc", "fanuc", "haas", "auto"}).description(""))
      ->type_name("linuxcnc|fanuc|haas|auto");
  diff->add_option("--tolerance", a.tolerance,
                   "less is no difference, mm or degrees (default 1e-6)")
      ->check(CLI::NonNegativeNumber)
      ->type_name("MM");
  diff->add_option("--max-differences", a.most, "printed; all are counted (default 100)")
      ->type_name("N");
  return diff;
}

}  // namespace aircut::cli
