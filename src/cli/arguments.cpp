#include "cli/arguments.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>

#include "cli/accuracy_arguments.h"
#include "cli/exit_code.h"
#include "cli/job_arguments.h"
#include "cli/log_arguments.h"
#include "cli/usage.h"

namespace aircut::cli {

namespace {

const char* const version = AIRCUT_VERSION;

CLI::Option* add_when(CLI::App* app, const std::string& name, When& when, const std::string& text) {
  const std::map<std::string, When> words = {
      {"auto", When::automatic}, {"always", When::always}, {"never", When::never}};
  return app->add_option(name, when, text)
      ->transform(CLI::CheckedTransformer(words).description(""))
      ->type_name("auto|always|never");
}

void add_color(CLI::App* app, When& color) {
  add_when(app, "--color", color, "colours in messages (NO_COLOR and CLICOLOR_FORCE are honoured)");
}

void add_program(CLI::App* app, ProgramArguments& a, std::vector<std::string>& set) {
  app->add_option("-t,--tools", a.tools, "tool table (.tbl) or tools.toml; replaces the machine's")
      ->type_name("FILE");
  app->add_option(
         "--ini", a.ini,
         "set-up file of a LinuxCNC machine: its interpreter options, parameter file, tools")
      ->type_name("FILE");
  app->add_option("--var", a.parameters, "parameter file")->type_name("FILE");
  app->add_option("--set", set, "set a parameter: '#100=5' or '#<name>=2' (repeatable)")
      ->type_name("ASSIGNMENT");
  app->add_option("--sub-path", a.sub_path, "folder of called subs (repeatable)")->type_name("DIR");
  app->add_option("--dialect", a.dialect,
                  "whose control the program is for (default: the machine's)")
      ->check(CLI::IsMember({"linuxcnc", "fanuc", "haas", "auto"}).description(""))
      ->type_name("linuxcnc|fanuc|haas|auto");
  app->add_flag("--whole-units", a.whole_units,
                "Fanuc and Haas: numbers without a decimal point are mm or in, not increments");
  app->add_flag("--lathe", a.lathe,
                "Fanuc and Haas: a turning centre (default: when the machine has no Y)");
  app->add_flag("--block-delete", a.block_delete, "skip blocks that begin with /");
  app->add_flag("--optional-stop", a.optional_stop, "M1 stops");
  app->add_option("--max-blocks", a.max_blocks, "blocks executed before the run ends as unknown")
      ->check([](const std::string& text) {
        return text.starts_with("-") ? std::string("--max-blocks takes a whole number above 0")
                                     : "";
      })
      ->type_name("N");
}

void add_output(CLI::App* app, OutputArguments& o, std::string& fail_on) {
  const std::map<std::string, Format> formats = {
      {"human", Format::human},  {"json", Format::json},   {"jsonl", Format::jsonl},
      {"gcc", Format::gcc},      {"sarif", Format::sarif}, {"junit", Format::junit},
      {"github", Format::github}};
  app->add_option("--format", o.format, "form of the findings on stdout")
      ->transform(CLI::CheckedTransformer(formats).description(""))
      ->type_name("human|json|jsonl|gcc|sarif|junit|github");
  app->add_flag_callback(
      "--json", [&o] { o.format = Format::json; }, "the same as --format json");
  app->add_option("--fail-on", fail_on, "from which severity the exit code is 1 (default: error)")
      ->check(CLI::IsMember({"error", "warning", "info", "never"}).description(""))
      ->type_name("error|warning|info|never");
  app->add_flag("--strict", o.strict, "what makes the verdict unknown is an error");
  app->add_option("--waive", o.waive,
                  "accept messages: KIND=REASON, KIND:FILE=REASON or KIND:FILE:LINE=REASON "
                  "(repeatable); the report lists them")
      ->allow_extra_args(false)
      ->type_name("WAIVER");
  app->add_option("--raise", o.raise, "make a kind of message an error (repeatable)")
      ->allow_extra_args(false)
      ->type_name("KIND");
  app->add_option("--baseline", o.baseline, "accept what an earlier result.json or SARIF file has")
      ->type_name("FILE");
  app->add_option("--max-findings", o.max_findings, "messages printed for people (default 100)")
      ->type_name("N");
  app->add_flag("-q,--quiet", o.quiet, "print the verdict only");
  add_color(app, o.color);
}

void add_view(CLI::App* app, ViewArguments& view, const std::string& more_cameras) {
  app->add_option("--camera", view.camera,
                  more_cameras + "iso, front, back, left, right, top, fit=BODY or X,Y,Z,tx,ty,tz")
      ->type_name("NAME");
  app->add_option("--section", view.section,
                  "cut the pictures open at a plane of the work's frame: X=12.5, Y=0 or Z=-4 (mm)")
      ->type_name("AXIS=MM");
  app->add_option("--hide", view.hidden,
                  "a body that pictures leave out; NAME* for all that begin so (repeatable)")
      ->allow_extra_args(false)
      ->type_name("BODY");
  app->add_option("--see-through", view.see_through,
                  "a body that pictures show translucent, such as a cover (repeatable)")
      ->allow_extra_args(false)
      ->type_name("BODY");
}

// Which checks there are; `existing` of them can be asked of this command.
void add_checks(CLI::App* app, std::vector<std::string>& checks,
                const std::vector<std::string>& existing) {
  std::string words;
  for (const std::string& word : existing) words += (words.empty() ? "" : "|") + word;
  app->add_option("--check", checks, "what to check (default all)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check([=](const std::string& word) -> std::string {
        if (std::find(existing.begin(), existing.end(), word) != existing.end()) return "";
        const std::string there_are = "; this command has " + words;
        if (word == "dynamics") return "the check '" + word + "' does not exist yet" + there_are;
        if (word == "collision" || word == "cut")
          return "only aircut run has the check '" + word + "'" + there_are;
        return "there is no check '" + printable(word) + "'." + did_you_mean(word, existing) +
               there_are;
      })
      ->type_name(words);
}

std::optional<Severity> severity_of(const std::string& word) {
  if (word == "warning") return Severity::warning;
  if (word == "info") return Severity::info;
  if (word == "never") return std::nullopt;
  return Severity::error;
}

// "#100=5" → {"#100", 5}
Expected<std::vector<std::pair<std::string, double>>> assignments(
    const std::vector<std::string>& texts) {
  std::vector<std::pair<std::string, double>> out;
  for (const std::string& text : texts) {
    const std::size_t equals = text.find('=');
    std::optional<double> value;
    if (equals != std::string::npos) value = parse_number(text.substr(equals + 1));
    if (!text.starts_with('#') || !value)
      return unexpected(make_error(
          "usage",
          "--set '" + printable(text) + "': write '#100=5' or '#<name>=2', with a plain number"));
    out.emplace_back(text.substr(0, equals), *value);
  }
  return out;
}

Expected<std::pair<int, int>> picture_size(const std::string& text) {
  const std::size_t x = text.find('x');
  const double w = parse_number(text.substr(0, x)).value_or(0);
  const double h = x == std::string::npos ? 0 : parse_number(text.substr(x + 1)).value_or(0);
  const auto good = [](double v) { return v >= 16 && v <= 8192 && v == std::floor(v); };
  if (!good(w) || !good(h))
    return unexpected(
        make_error("usage", "--size '" + printable(text) +
                                "': write WIDTHxHEIGHT in pixels from 16 to 8192, like 1280x800"));
  return std::pair(static_cast<int>(w), static_cast<int>(h));
}

}  // namespace

std::variant<Arguments, int> parse(int argc, char** argv) {
  CLI::App app{
      "aircut runs an NC program on a virtual machine and says whether it is safe to run."};
  app.name("aircut");
  app.set_version_flag("--version", std::string("aircut ") + version);
  app.set_help_all_flag("--help-all", "help of all commands");
  app.require_subcommand(1);
  app.fallthrough(false);

  RunArguments run;
  JobArguments job;
  CheckArguments check;
  TraceArguments trace;
  MachineArguments machine;
  KinArguments kin;
  WorkspaceArguments workspace;
  AccuracyArguments accuracy;
  LogArguments log;
  DiffArguments diff;
  ExplainArguments explain;
  std::vector<std::string> set;
  std::string fail_on = "error", size = "1280x800";
  std::string trace_format = "text";

  CLI::App* c_run = app.add_subcommand(
      "run",
      "run a program on a machine: joints, collisions, frames, verdict\n\n"
      "  aircut run programs/bracket.ngc -m mill3 -o out\n"
      "  aircut run part.ngc -m machines/ox-glide-crossed --frames count=24 -o out --force");
  c_run->add_option("PROGRAM", run.program.program, "the program; - reads standard input");
  c_run
      ->add_option("--channel", run.channels,
                   "in place of PROGRAM: the program of a channel by its name or number in the "
                   "package; all that are given run at once (repeatable; docs/channels.md)")
      ->type_name("NAME=PROGRAM");
  c_run
      ->add_option("-m,--machine", run.program.machine,
                   "shipped name, package folder, machine.toml, LinuxCNC .ini or robot .urdf")
      ->required()
      ->type_name("MACHINE");
  c_run->add_option("--setup", run.program.setup, "setup.toml: fixtures, work offsets, start")
      ->type_name("FILE");
  add_program(c_run, run.program, set);
  c_run->add_option("-o,--out", run.folder, "output folder; nothing is written without it")
      ->type_name("DIR");
  c_run->add_flag("--force", run.force, "write into a folder that exists");
  c_run
      ->add_option("--log", run.log,
                   "joint log, .csv or .h5, or null for none (default: joints.csv in the folder)")
      ->type_name("FILE");
  c_run
      ->add_option("--part", run.part,
                   "what is left of the stock: .stl or .3mf, or null for none (default: part.stl "
                   "and part.3mf in the folder)")
      ->type_name("FILE");
  c_run
      ->add_option("--save-stock", run.save_stock,
                   "the stock for the next job, whose set-up says [stock] file = \"FILE\"")
      ->type_name("FILE");
  c_run
      ->add_option("--accuracy", run.accuracy,
                   "bodies, tools, materials (docs/accuracy.md): what the cutting forces do to the "
                   "sizes of the part")
      ->type_name("FILE");
  c_run
      ->add_option("--overrides", run.overrides,
                   "what is set at the panel at which time: feed, rapid and spindle override, hold")
      ->type_name("FILE");
  c_run->add_option("--period", run.period, "servo and log period, s (default 0.001)")
      ->check(CLI::Range(1e-5, 1.0).description(""))
      ->type_name("S");
  c_run->add_option("--log-every", run.log_every, "log every N-th sample")
      ->check(CLI::Range(1, 1000000).description(""))
      ->type_name("N");
  c_run->add_option("--near", run.near, "tell approaches closer than this, mm (default 2; 0 = off)")
      ->check(CLI::Range(0.0, 1000.0).description(""))
      ->type_name("MM");
  add_checks(c_run, run.checks, {"all", "syntax", "semantics", "limits", "collision", "cut"});
  c_run
      ->add_option("--frames", run.frames,
                   "every=2s, at=12.5,80, line=128, tool-change, finding, count=24 (repeatable; "
                   "with -o default count=12 and finding; none for no frames)")
      ->type_name("SPEC");
  add_view(c_run, run.view, "work, tool (follows it), ");
  c_run
      ->add_option("--stock-colors", run.stock_colors,
                   "plain, or tool: what each tool has cut in a colour of its own (milling)")
      ->check(CLI::IsMember({"plain", "tool"}).description(""))
      ->type_name("plain|tool");
  c_run
      ->add_option("--path-colors", run.path_colors,
                   "of the tool path in pictures: by kind (rapid, feed, done), by time, or none")
      ->check(CLI::IsMember({"kind", "time", "none"}).description(""))
      ->type_name("kind|time|none");
  c_run->add_option("--size", size, "picture size (default 1280x800)")->type_name("WxH");
  c_run
      ->add_option("--motion", run.motion,
                   "animation in the folder: glb writes motion.glb (glTF 2.0), png the frames by "
                   "time as motion.png, mp4 as motion.mp4 through an installed ffmpeg (repeatable)")
      ->check(CLI::IsMember({"glb", "png", "mp4"}).description(""))
      ->type_name("glb|png|mp4");
  c_run
      ->add_option("--max-sim-time", run.max_time,
                   "simulated seconds before the run ends as unknown")
      ->type_name("S");
  add_when(c_run, "--progress", run.output.progress, "progress line on stderr");
  add_output(c_run, run.output, fail_on);

  CLI::App* c_job = add_job(app, job);
  CLI::App* c_check =
      app.add_subcommand("check",
                         "fast gate: interpret programs and report errors, no motion\n\n"
                         "  aircut check programs/*.ngc\n"
                         "  aircut check part.ngc -m mill3 --format gcc");
  c_check->add_option("PROGRAM", check.programs, "programs")->required();
  c_check->add_option("-m,--machine", check.program.machine, "machine whose axes and tools count")
      ->type_name("MACHINE");
  add_checks(c_check, check.checks, {"all", "syntax", "semantics", "limits"});
  add_program(c_check, check.program, set);
  add_output(c_check, check.output, fail_on);

  CLI::App* c_trace =
      app.add_subcommand("trace",
                         "print the canonical commands, nothing moves\n\n"
                         "  aircut trace part.ngc\n"
                         "  aircut trace part.ngc --format rs274 -t tool.tbl --var empty.var");
  c_trace->add_option("PROGRAM", trace.program.program, "the program; - reads standard input")
      ->required();
  c_trace->add_option("-m,--machine", trace.program.machine, "machine whose axes and tools count")
      ->type_name("MACHINE");
  add_program(c_trace, trace.program, set);
  c_trace->add_option("--format", trace_format, "text, jsonl or rs274")
      ->check(CLI::IsMember({"text", "jsonl", "rs274"}).description(""))
      ->type_name("text|jsonl|rs274");
  add_color(c_trace, trace.color);

  CLI::App* c_machine =
      app.add_subcommand("machine",
                         "look at a machine package, or begin one\n\n"
                         "  aircut machine info -m mill3\n"
                         "  aircut machine render -m machines/ox-glide-crossed -o machine.png");
  c_machine->require_subcommand(1);
  const auto add_machine = [&](const char* name, const char* text,
                               MachineArguments::Action action) {
    CLI::App* c = c_machine->add_subcommand(name, text);
    c->add_option("-m,--machine,MACHINE", machine.machine,
                  "shipped name, package folder, machine.toml, LinuxCNC .ini or robot .urdf")
        ->required()
        ->type_name("MACHINE");
    c->add_option("--setup", machine.setup, "setup.toml")->type_name("FILE");
    c->add_option("-t,--tools", machine.tools, "tool table or tools.toml")->type_name("FILE");
    add_color(c, machine.color);
    c->callback([&machine, action] { machine.action = action; });
    return c;
  };
  add_machine("check", "read the package and say what is wrong with it",
              MachineArguments::Action::check);
  add_machine("info", "axes, limits, bodies, pairs", MachineArguments::Action::info);
  CLI::App* c_render =
      add_machine("render", "a picture of the machine at home", MachineArguments::Action::render);
  c_render->add_option("-o,--out", machine.output, "PNG file (default machine.png)")
      ->type_name("FILE");
  add_view(c_render, machine.view, "");
  c_render->add_option("--size", size, "picture size (default 1280x800)")->type_name("WxH");
  c_render->add_option("--tool", machine.tool, "tool in the spindle")->type_name("T");
  c_render->add_flag("--force", machine.force, "replace a file that exists");
  CLI::App* c_new = c_machine->add_subcommand(
      "new",
      "write a package made from a structural formula, with simple bodies and usual limits\n\n"
      "  aircut machine new --formula 'R(MS:C)-O-T(TS:X)-T(VS:Z)' mylathe\n"
      "  aircut machine check ./mylathe");
  c_new->add_option("NAME", machine.machine, "folder of the new package")->required();
  c_new
      ->add_option("--formula", machine.formula,
                   "structural formula, from the workpiece to the tool")
      ->required()
      ->type_name("FORMULA");
  c_new->add_flag("--force", machine.force, "write into a folder that exists");
  add_color(c_new, machine.color);
  c_new->callback([&machine] { machine.action = MachineArguments::Action::create; });
  CLI::App* c_import = c_machine->add_subcommand(
      "import",
      "write a package made from the set-up of a LinuxCNC machine or a robot's description\n\n"
      "  aircut machine import mymill.ini mymill\n"
      "  aircut machine import robot.urdf:tool0 myrobot --package-root ~/ws/src");
  c_import
      ->add_option("FILE", machine.machine,
                   "FILE.ini, FILE.urdf, or FILE.urdf:LINK with the link that carries the tool")
      ->required();
  c_import->add_option("NAME", machine.output, "folder of the new package")->required();
  c_import
      ->add_option("--package-root", machine.package_root,
                   "folder of the packages that package://NAME/… names (default: above the file)")
      ->type_name("DIR");
  c_import->add_flag("--force", machine.force, "write into a folder that exists");
  add_color(c_import, machine.color);
  c_import->callback([&machine] { machine.action = MachineArguments::Action::convert; });

  CLI::App* c_kin = app.add_subcommand(
      "kin",
      "the kinematics of a machine as a filter: a row of numbers per line from standard input\n\n"
      "Pose words are the machine's program axes in the order X Y Z A B C U V W (the point at the\n"
      "spindle's face, in mm and degrees), joints those of the joint log. Numbers are separated "
      "by\n"
      "blanks or commas; words like X1 Y2 B30 (S1=395.3 for joints) may stand in any order. Of\n"
      "several solutions the one nearest to home is taken. A row without an answer gives a line\n"
      "`error: …`, and exit code 1.\n\n"
      "  echo '250 0 -300' | aircut kin ik -m ox-glide-crossed\n"
      "  echo '10 20 -150' | aircut kin ik --type delta-linear --param radius=120\n"
      "  echo 'X250 Y0 Z-300' | aircut kin ik -m ox-glide-crossed | aircut kin fk -m "
      "ox-glide-crossed");
  c_kin->require_subcommand(1);
  const auto add_kin = [&](const char* name, const char* text, KinArguments::Action action) {
    CLI::App* c = c_kin->add_subcommand(name, text);
    c->add_option("-m,--machine", kin.machine,
                  "shipped name, package folder, machine.toml, LinuxCNC .ini or robot .urdf")
        ->type_name("MACHINE");
    c->add_option("--type", kin.type,
                  "a kinematics without a package, by the `type` of its machine.toml")
        ->type_name("NAME")
        ->excludes("-m");
    c->add_option("--kinstype", kin.kinstype,
                  "which of the machine's kinematics, by the number of its channel from 0 on")
        ->check(CLI::Range(0, 99).description(""))
        ->needs("-m")
        ->type_name("N");
    c->add_option("--param", kin.parameters,
                  "a parameter of --type, as in machine.toml (repeatable)")
        ->type_name("KEY=VALUE")
        ->needs("--type");
    if (action == KinArguments::Action::sweep)
      c->add_option("RANGE", kin.ranges,
                    "WORD=FROM:TO:STEP or WORD=VALUE; words that are not given stay at home")
          ->required();
    if (action == KinArguments::Action::ik)
      c->add_flag("--tool-vector", kin.tool_vector,
                  "rows are X Y Z I J K, the tip and the tool's direction; all joint positions");
    add_color(c, kin.color);
    c->callback([&kin, action] { kin.action = action; });
  };
  add_kin("fk", "joints → pose", KinArguments::Action::fk);
  add_kin("ik", "pose → joints, which must be inside their limits", KinArguments::Action::ik);
  add_kin("jac",
          "pose → d joint / d pose word, row by row: all pose words of the first joint, then of "
          "the second, …",
          KinArguments::Action::jac);
  add_kin("sweep",
          "a grid of poses, each with its joints: the words that change as WORD=FROM:TO:STEP\n\n"
          "  aircut kin sweep -m ox-glide-crossed X=160:340:20 Z=-350:-300:10",
          KinArguments::Action::sweep);
  CLI::App* c_rot = c_kin->add_subcommand(
      "rot",
      "orientations of one convention in another one, frames of a rotation cycle, angles of a "
      "head\n\n"
      "A convention is an order of the axes or its BIN number, and int (turned axes) or ext "
      "(fixed\n"
      "axes): XYZ-int, 57-ext. Rows are three angles in the order of the axes, in degrees.\n\n"
      "  echo '30 45 60' | aircut kin rot --from XYZ-ext --to ZXY-int");
  c_rot->add_option("--from", kin.from, "convention of the rows, or `matrix` (R11 R12 … R33)")
      ->type_name("CONVENTION");
  c_rot
      ->add_option(
          "--to", kin.to,
          "convention of the answers, `all`, `matrix`, `head` or `head45` (C, A and the\n"
          "roll that is left, all solutions), `table` or `table45` (turntable, C and A of\n"
          "least travel from zero)")
      ->type_name("CONVENTION");
  c_rot->add_flag("--inverse", kin.inverse, "both sets of angles");
  c_rot->add_flag("--frame", kin.frame,
                  "rows are POS_X POS_Y POS_Z, the orientation, POS_X_R POS_Y_R POS_Z_R; answers\n"
                  "begin with the frame's origin");
  c_rot->add_flag("--add", kin.add, "each row is a step on top of the row before");
  c_rot->add_flag(
      "--cycle", kin.cycle,
      "rows are the 18 arguments of CYCLE600; answers are head, three angles, INEXOUT,\n"
      "BIN_OUT and the frame's origin");
  add_color(c_rot, kin.color);
  c_rot->callback([&kin] { kin.action = KinArguments::Action::rot; });

  CLI::App* c_workspace = app.add_subcommand(
      "workspace",
      "what a machine reaches, on a grid: share, area or volume, extent, largest box\n\n"
      "A range is FROM:TO in mm (or degrees), or one number for a slice; an axis without one is\n"
      "searched as far as the joints reach.\n\n"
      "  aircut workspace -m ox-glide-crossed --y 0 --pitch 1\n"
      "  aircut workspace -m lola50-horizontal --pitch 100 --nodes --tilt-a=-25:25 "
      "--tilt-b=-25:25");
  c_workspace
      ->add_option("-m,--machine", workspace.machine,
                   "shipped name, package folder, machine.toml, LinuxCNC .ini or robot .urdf")
      ->required()
      ->type_name("MACHINE");
  for (const auto& [name, text] : {std::pair("--x", &workspace.x), std::pair("--y", &workspace.y),
                                   std::pair("--z", &workspace.z)})
    c_workspace->add_option(name, *text, "range along this axis")->type_name("FROM:TO");
  c_workspace->add_option("--tilt-a", workspace.a, "range of A that every point must allow")
      ->type_name("FROM:TO");
  c_workspace->add_option("--tilt-b", workspace.b, "range of B that every point must allow")
      ->type_name("FROM:TO");
  c_workspace->add_option("--pitch", workspace.pitch, "distance of the points (default 10)")
      ->type_name("MM");
  c_workspace->add_flag("--nodes", workspace.nodes, "points at the ends of the ranges, not cells");
  c_workspace->add_flag("--connected", workspace.connected,
                        "only what is connected with home by neighbouring points");
  c_workspace->add_flag("--collision-free", workspace.free,
                        "only where no two bodies of machine, tool and fixtures touch");
  c_workspace->add_option("--setup", workspace.setup, "setup.toml: fixtures and stock")
      ->type_name("FILE");
  c_workspace->add_option("-t,--tools", workspace.tools, "tool file, for --tool")
      ->type_name("FILE");
  c_workspace->add_option("--tool", workspace.tool, "tool in the spindle, whose tip is asked about")
      ->type_name("N")
      ->check(CLI::NonNegativeNumber.description(""));
  c_workspace->add_option("--threads", workspace.threads, "(default: one per core)")
      ->type_name("N")
      ->check(CLI::Range(1, 64).description(""));
  c_workspace
      ->add_option(
          "-o,--out", workspace.output,
          "the points (.csv, .npy), the solid of what is reached (.stl) or a picture (.png); "
          "repeatable")
      ->type_name("FILE");
  c_workspace->add_flag("--force", workspace.force, "replace files that exist");
  add_color(c_workspace, workspace.color);
  CLI::App* c_accuracy = add_accuracy(app, accuracy);
  CLI::App* c_log = add_log(app, log);
  CLI::App* c_diff = add_diff(app, diff);

  CLI::App* c_explain = app.add_subcommand("explain",
                                           "what a kind of message means\n\n"
                                           "  aircut explain arc_error\n"
                                           "  aircut explain --list");
  c_explain->add_option("KIND", explain.kind, "the word in brackets of a message");
  c_explain->add_flag("--list", explain.list, "all kinds");
  CLI::App* c_doctor =
      app.add_subcommand("doctor", "version, build and what this program can do here");
  CLI::App* c_help = app.add_subcommand("help", "help of a command");
  std::string topic;
  c_help->add_option("COMMAND", topic, "the command");

  const auto active = [&] { return active_command(app); };
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    std::fputs(active()->help().c_str(), stdout);
    return 0;
  } catch (const CLI::CallForAllHelp&) {
    std::fputs(app.help("", CLI::AppFormatMode::All).c_str(), stdout);
    return 0;
  } catch (const CLI::CallForVersion& e) {
    std::printf("%s\n", e.what());
    return 0;
  } catch (const CLI::ParseError& e) {
    return usage_error(usage_diagnostic(app, e), active());
  }

  if (c_help->parsed()) {
    if (topic.empty()) {
      std::fputs(app.help().c_str(), stdout);
      return 0;
    }
    std::vector<std::string> names;
    for (const CLI::App* sub : app.get_subcommands({})) names.push_back(sub->get_name());
    for (CLI::App* sub : app.get_subcommands({}))
      if (sub->get_name() == topic) {
        std::fputs(sub->help().c_str(), stdout);
        return 0;
      }
    return usage_error(make_error("usage", "there is no command '" + printable(topic) + "'." +
                                               did_you_mean(topic, names)),
                       &app);
  }
  const auto sets = assignments(set);
  if (!sets) return usage_error(sets.error(), active());
  const auto pixels = picture_size(size);
  if (!pixels) return usage_error(pixels.error(), active());

  for (const double value : {run.near, run.period, run.max_time.value_or(0)})
    if (!std::isfinite(value) || value < 0)
      return usage_error(
          make_error("usage",
                     "--near, --period and --max-sim-time take plain numbers of 0 or more"),
          active());
  if (c_run->parsed()) {
    if (run.program.program.empty() == run.channels.empty())
      return usage_error(
          make_error("usage", run.channels.empty()
                                  ? "run needs a PROGRAM, or --channel NAME=PROGRAM for each of "
                                    "several channels"
                                  : "run takes either a PROGRAM or --channel NAME=PROGRAM"),
          c_run);
    run.program.set = *sets;
    run.output.fail_on = severity_of(fail_on);
    std::tie(run.width, run.height) = *pixels;
    return Arguments(run);
  }
  if (c_job->parsed()) return Arguments(job);
  if (c_check->parsed()) {
    check.program.set = *sets;
    check.output.fail_on = severity_of(fail_on);
    return Arguments(check);
  }
  if (c_trace->parsed()) {
    trace.program.set = *sets;
    trace.format = trace_format == "jsonl"   ? TraceFormat::jsonl
                   : trace_format == "rs274" ? TraceFormat::rs274
                                             : TraceFormat::text;
    return Arguments(trace);
  }
  if (c_machine->parsed()) {
    std::tie(machine.width, machine.height) = *pixels;
    return Arguments(machine);
  }
  if (c_kin->parsed()) {
    if (kin.action != KinArguments::Action::rot && kin.machine.empty() && kin.type.empty())
      return usage_error(make_error("usage", "name a machine with -m, or a kinematics with --type"),
                         active());
    return Arguments(kin);
  }
  if (c_workspace->parsed()) return Arguments(workspace);
  if (c_accuracy->parsed()) {
    if ((!accuracy.plot.empty() || !accuracy.of.empty()) && accuracy.sweep.empty())
      return usage_error(make_error("usage", "--plot and --of draw a --sweep; name what changes"),
                         active());
    return Arguments(accuracy);
  }
  if (c_log->parsed()) return Arguments(log);
  if (c_diff->parsed()) return Arguments(diff);
  if (c_explain->parsed()) {
    if (explain.kind.empty() && !explain.list)
      return usage_error(make_error("usage", "explain needs a kind, or --list for all of them"),
                         c_explain);
    return Arguments(explain);
  }
  (void)c_doctor;
  return Arguments(DoctorArguments{});
}

}  // namespace aircut::cli
