#include "cli/job.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "cli/exit_code.h"
#include "cli/print_report.h"
#include "stock/stock.h"

namespace aircut::cli {

namespace fs = std::filesystem;

namespace {

std::string folder_of(const std::string& path) {
  const std::size_t slash = path.find_last_of('/');
  return slash == std::string::npos ? "." : path.substr(0, slash);
}

// Every file of a package that can change a result, in a fixed order.
std::string hash_of_package(const std::string& folder) {
  static const std::vector<std::string> kinds = {".toml", ".stl", ".obj", ".ply", ".dae", ".glb",
                                                 ".gltf", ".3mf", ".tbl", ".var", ".ngc"};
  std::vector<std::string> files;
  std::error_code error;
  for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error))
    if (it->is_regular_file(error) &&
        std::find(kinds.begin(), kinds.end(), it->path().extension().string()) != kinds.end())
      files.push_back(fs::relative(it->path(), folder, error).generic_string());
  std::sort(files.begin(), files.end());
  std::string all;
  SourceMap sources;
  for (const std::string& file : files) {
    const auto text = sources.open(folder + "/" + file);
    all += file + " " + (text ? sha256((*text)->content()) : "unreadable") + "\n";
  }
  return sha256(all);
}

constexpr double turned_facets = 0.005;  // mm, of the surface of a saved bar

// The surface of what an earlier job left, for the stock of a setup, and its sizes.
bool load_stock(machine::SetupStock& wanted, bool turned, Job& job) {
  machine::RawStock& raw = wanted.raw;
  if (raw.shape != machine::StockShape::saved) return true;
  const std::string_view bytes = raw.saved->content();
  const std::string name = printable(wanted.mesh_path);
  const auto use = [&](const auto& stock, const auto& surface) {
    if (!stock) {
      job.diagnostics.error("setup_invalid", wanted.mesh_span, stock.error().message);
      return false;
    }
    job.inputs.push_back({"stock", raw.saved->name(), sha256(bytes)});
    raw.pitch = stock->pitch();
    raw.mesh = std::make_shared<TriangleMesh>(surface(*stock));
    if (!raw.mesh->triangles.empty()) return true;
    job.diagnostics.error("setup_invalid", wanted.mesh_span,
                          "nothing is left of the stock in '" + name + "'");
    return false;
  };
  if (!turned)
    return use(stock::Stock::load(bytes, name), [](const auto& stock) { return stock.mesh(); });
  return use(stock::TurnedStock::load(bytes, name), [&](const stock::TurnedStock& stock) {
    raw.diameter = 2 * stock.radius();
    raw.height = stock.length();
    return stock.mesh(turned_facets);
  });
}

// Sets the work offsets of a setup as the parameters that a control keeps them in.
void apply_offsets(const machine::Setup& setup, double unit_mm, interp::ParameterFile& parameters) {
  for (const auto& [system, offset] : setup.offsets) {
    const int first = 5221 + 20 * (system - 1);
    for (const Axis axis : all_axes)
      parameters.values[first + static_cast<int>(index(axis))] =
          is_rotary(axis) ? offset[axis] * 180 / M_PI : offset[axis] / unit_mm;
  }
}

}  // namespace

std::vector<std::string> package_folders() {
  std::vector<std::string> out = {"machines"};
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error) {
    // BUILD/bin/aircut of a build inside the checkout, or an installed PREFIX/bin/aircut.
    for (fs::path up = program.parent_path(); up.has_relative_path(); up = up.parent_path())
      if (fs::is_directory(up / "machines", error)) {
        out.push_back((up / "machines").string());
        break;
      }
    out.push_back((program.parent_path().parent_path() / "share/aircut/machines").string());
  }
  return out;
}

Expected<const SourceText*> open_program(SourceMap& sources, const std::string& path) {
  return path == "-" ? sources.read(stdin, path) : sources.open(path);
}

bool open_inputs(Job& job, const ProgramArguments& arguments, std::optional<double> table_unit_mm) {
  Diagnostics& out = job.diagnostics;
  const auto fail = [&](const Diagnostic& d) {
    // A reader that returns an error may have listed it among the others already.
    if (out.errors() == 0) out.add(d);
    return false;
  };
  if (!open_ini(job, arguments)) return false;
  const double unit_mm = job.control ? job.control->unit_mm : 1.0;
  if (job.machine) {
    // its channels are read already
  } else if (machine::split_channel(arguments.machine).first.ends_with(".ini")) {
    if (arguments.ini_use != ProgramArguments::IniUse::control && !import_ini(job, arguments))
      return false;
  } else if (machine::split_channel(arguments.machine).first.ends_with(".urdf")) {
    if (!import_urdf(job, arguments.machine)) return false;
  } else if (!arguments.machine.empty()) {
    const auto [package, channel] = machine::split_channel(arguments.machine);
    const auto path = machine::find_package(package, package_folders());
    if (!path) return fail(path.error());
    auto machine = machine::read_machine(*path, job.sources, out, channel);
    if (!machine) return fail(machine.error());
    job.machine = *machine;
    job.inputs.push_back({"machine", arguments.machine, hash_of_package(job.machine->folder())});
    job.start = job.machine->home();
    read_switches(job, arguments);
  }
  std::string parameters = arguments.parameters;
  if (parameters.empty() && job.control) parameters = job.control->parameter_file;
  if (parameters.empty() && job.machine) parameters = job.machine->default_parameters_;
  if (!parameters.empty()) {
    const auto text = job.sources.open(parameters);
    if (!text) return fail(text.error());
    job.parameters = interp::read_var(**text, out);
    job.inputs.push_back({"parameters", parameters, sha256((*text)->content())});
  }
  if (!arguments.setup.empty() && job.machine) {
    auto setup = machine::read_setup(arguments.setup, *job.machine, job.sources, out);
    if (!setup) return fail(setup.error());
    if (setup->stock && !load_stock(*setup->stock, sim::turns_the_work(*job.machine), job))
      return false;
    const auto placed = machine::apply_setup(*job.machine, *setup, job.sources, out);
    if (!placed) return fail(placed.error());
    job.machine = *placed;
    if (setup->start) job.start = *setup->start;
    apply_offsets(*setup, unit_mm, job.parameters);
    if (const auto text = job.sources.open(arguments.setup))
      job.inputs.push_back({"setup", arguments.setup, sha256((*text)->content())});
  }
  std::string tools = arguments.tools;
  if (tools.empty() && job.control) tools = job.control->tool_table;
  if (tools.empty() && job.machine) tools = job.machine->default_tools_;
  if (!tools.empty()) {
    const auto table = tool::read_tools(tools, table_unit_mm.value_or(unit_mm), job.sources, out);
    if (!table) return fail(table.error());
    job.tools = *table;
    if (!arguments.tools.empty() || job.control)
      if (const auto text = job.sources.open(tools))
        job.inputs.push_back({"tools", tools, sha256((*text)->content())});
  }
  if (job.control) job.tools.random_changer = job.control->random_tool_changer;
  return out.errors() == 0;
}

bool open_channels(Job& job, const ProgramArguments& arguments,
                   const std::vector<std::string>& channels, machine::ChannelMachines& machines) {
  Diagnostics& out = job.diagnostics;
  const auto path = machine::find_package(arguments.machine, package_folders());
  if (!path) {
    out.add(path.error());
    return false;
  }
  auto read = machine::read_channel_machines(*path, channels, job.sources, out);
  if (!read) {
    if (out.errors() == 0) out.add(read.error());
    return false;
  }
  machines = std::move(*read);
  job.machine = machines.whole;
  job.inputs.push_back({"machine", arguments.machine, hash_of_package(job.machine->folder())});
  job.start = job.machine->home();
  if (!open_inputs(job, arguments)) return false;
  machines.whole = job.machine;
  return true;
}

// What a program can do to switch the kinematics. The analog output of a set-up counts for a
// package too, whose channels are then those of the same name.
interp::KinematicsSwitch switch_of(const Job& job) {
  const auto& models = job.machine->models();
  interp::KinematicsSwitch out = sim::kinematics_switch(*job.machine);
  if (!job.switches) return out;
  out.output = job.switches->switch_output;
  for (const std::string& name : job.switches->models) {
    const auto found = std::find_if(models.begin(), models.end(),
                                    [&](const auto& model) { return model.channel == name; });
    const bool only = models.empty() && job.imported && job.switches->models.size() == 1;
    out.by_value.push_back(found != models.end() ? static_cast<int>(found - models.begin())
                           : only                ? 0
                                                 : -1);
  }
  return out;
}

interp::Options interpreter_options(const Job& job, const ProgramArguments& arguments,
                                    const SourceText& program) {
  interp::Options options;
  if (job.control)
    options = job.control->options;
  else
    for (const Axis axis : all_axes) options.axes.add(axis);
  if (job.machine) {
    const AxisSet axes = job.machine->kinematics().axes();
    const AxisSet named = options.axes;
    options.axes = {};
    for (const Axis axis : all_axes)
      if (axes.has(axis) && (named.has(axis) || !job.imported)) options.axes.add(axis);
    if (const auto tip = job.machine->kinematics().forward(job.start, {})) options.start = *tip;
    options.kinematics = switch_of(job);
    sim::use_tool_change(*job.machine, options);
  }
  const bool automatic = arguments.dialect == "auto";
  const bool named = !arguments.dialect.empty() && !automatic;
  const std::string dialect = named         ? arguments.dialect
                              : job.machine ? job.machine->dialect()
                                            : std::string();
  if (dialect == "fanuc") options.dialect = interp::Dialect::fanuc;
  if (dialect == "haas") options.dialect = interp::Dialect::haas;
  if (automatic) interp::choose_dialect(options, program.content());
  options.whole_units = arguments.whole_units;
  // A turning centre's code system is one of Fanuc-like controls; LinuxCNC has the same codes for
  // all.
  options.lathe = options.dialect != interp::Dialect::linuxcnc &&
                  (arguments.lathe || (job.machine && !options.axes.has(Axis::y)));
  options.block_delete = arguments.block_delete;
  options.optional_stop = arguments.optional_stop;
  options.set = arguments.set;
  options.sub_path.insert(options.sub_path.begin(), folder_of(program.name()));
  if (job.machine) options.sub_path.push_back(job.machine->folder() + "/subs");
  for (const std::string& folder : arguments.sub_path) options.sub_path.push_back(folder);
  if (arguments.max_blocks) {
    interp::Limits& limits = options.limits;
    limits.max_blocks = *arguments.max_blocks;
    limits.max_idle_blocks = std::max(limits.max_idle_blocks, limits.max_blocks);
    limits.max_repeat = std::max(limits.max_repeat, limits.max_blocks);
  }
  return options;
}

Checks asked_for(const std::vector<std::string>& words) {
  const auto has = [&](const char* word) {
    return std::find(words.begin(), words.end(), word) != words.end();
  };
  if (words.empty() || has("all")) return {};
  return {has("semantics"), has("limits"), has("collision"), has("cut")};
}

Expected<report::Rules> rules_of(const OutputArguments& output, SourceMap& sources) {
  std::vector<std::string> names;
  for (const KindText& row : all_kinds()) names.push_back(row.kind);
  const auto unknown_kind = [&](const std::string& option, const std::string& kind) {
    return make_error("usage", option + ": there is no kind '" + printable(kind) + "'." +
                                   did_you_mean(kind, names) + " aircut explain --list has all");
  };
  const auto known = [&](const std::string& kind) {
    return std::find(names.begin(), names.end(), kind) != names.end();
  };
  report::Rules rules;
  rules.strict = output.strict;
  for (const std::string& text : output.waive) {
    auto waiver = report::read_waiver(text);
    if (!waiver) return unexpected(waiver.error());
    if (!known(waiver->kind)) return unexpected(unknown_kind("--waive", waiver->kind));
    rules.waivers.push_back(std::move(*waiver));
  }
  for (const std::string& kind : output.raise) {
    if (!known(kind)) return unexpected(unknown_kind("--raise", kind));
    rules.raised.push_back(kind);
  }
  if (output.baseline.empty()) return rules;
  const auto text = sources.open(output.baseline);
  if (!text) return unexpected(text.error());
  auto baseline = report::read_baseline(**text);
  if (!baseline) return unexpected(baseline.error());
  rules.baseline = std::move(*baseline);
  rules.has_baseline = true;
  return rules;
}

int refuse(const Diagnostics& diagnostics, const OutputArguments& output) {
  print_errors(diagnostics, output.color);
  if (output.format != Format::json && output.format != Format::jsonl)
    return code(ExitCode::unknown);
  report::RunReport report;
  report.version = AIRCUT_VERSION;
  report.diagnostics = diagnostics.list();
  report.summary.unchecked = {"everything: the job could not begin"};
  report.unknown_cause = "input";
  for (const Diagnostic& d : diagnostics.list())
    if (d.kind == "usage") report.unknown_cause = "usage";
  for (const Diagnostic& d : diagnostics.list())
    if (d.kind == "output_failed") report.unknown_cause = "output";
  (void)print_report(report, output);  // it is unknown already
  return code(ExitCode::unknown);
}

int refuse(const Diagnostic& diagnostic, const OutputArguments& output) {
  Diagnostics one;
  one.add(diagnostic);
  return refuse(one, output);
}

SourceReader sub_reader(SourceMap& sources) {
  return [&sources](const std::string& path) { return sources.open(path); };
}

bool use_color(When when, int descriptor) {
  if (when != When::automatic) return when == When::always;
  if (const char* off = std::getenv("NO_COLOR"); off && *off) return false;
  if (const char* on = std::getenv("CLICOLOR_FORCE"); on && *on && std::string(on) != "0")
    return true;
  if (const char* term = std::getenv("TERM"); !term || std::string(term) == "dumb") return false;
  return ::isatty(descriptor) == 1;
}

void print_error(const Diagnostic& diagnostic, When color) {
  std::fputs(format_human(diagnostic, {use_color(color, STDERR_FILENO)}).c_str(), stderr);
}

void print_errors(const Diagnostics& diagnostics, When color) {
  for (const Diagnostic& d : diagnostics.list()) print_error(d, color);
}

}  // namespace aircut::cli
