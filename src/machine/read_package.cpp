// machine.toml as a whole. Every part records its own problems; the machine is handed out only when
// there is none.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "machine/kinematics/kinematics_table.h"
#include "machine/reading.h"

namespace aircut::machine {

namespace {

constexpr long our_schema = 1;

double seconds(config::Table& table, const std::string& key) {
  const double value = table.number(key, 0);
  constexpr double longest = 3.6e5;  // 100 h, the limit of simulated time
  if (value >= 0 && value <= longest) return value;
  table.error(key, "'" + key + "' needs seconds from 0 to 360000");
  return 0;
}

// X Y Z, or A B C too, or U V W too, as the control has it.
void read_change_position(config::Table& table, Machine& machine, double unit_mm) {
  const auto values = table.numbers("position", 0);
  if (!values) return;
  if (values->size() != 3 && values->size() != 6 && values->size() != 9)
    return table.error("position", "'position' takes 3, 6 or 9 numbers: X Y Z, A B C, U V W");
  const AxisSet axes = machine.kinematics_ ? machine.kinematics().axes() : AxisSet{};
  AxisSet moved;
  AxisValues position;
  for (std::size_t i = 0; i < values->size(); ++i) {
    const Axis axis = all_axes[i];
    if (axes.has(axis)) {
      moved.add(axis);
      position[axis] = (*values)[i] * (is_rotary(axis) ? M_PI / 180 : unit_mm);
    } else if ((*values)[i] != 0) {
      table.error("position", "'position' has a value for " + std::string(1, letter(axis)) +
                                  ", which this machine has not; write 0 there");
    }
  }
  machine.tool_change_.position = {moved, position};
}

// subs/toolchange.ngc: the package's folder `subs` is where called subs are looked for.
void read_change_program(config::Table& table, ReadState& state) {
  const auto path = table.text("program");
  if (!path) return;
  const std::string folder = "subs/", ending = ".ngc";
  const auto is_name = [](const std::string& name) {
    return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    });
  };
  const bool formed = path->starts_with(folder) && path->ends_with(ending) &&
                      path->size() > folder.size() + ending.size();
  const std::string name =
      formed ? path->substr(folder.size(), path->size() - folder.size() - ending.size()) : "";
  if (!is_name(name))
    return table.error("program",
                       "'program' is a file subs/NAME.ngc of the package with the sub o<NAME>; "
                       "NAME has small letters, digits, '_' and '-'");
  if (const auto full = state.files.full_path(*path); !full)
    return table.error("program", full.error().message);
  state.machine.tool_change_.program = name;
  state.machine.tool_change_.program_span = table.span("program");
}

void read_tool_change(config::Table& top, ReadState& state) {
  auto table = top.table("toolchange");
  if (!table) return;
  state.machine.tool_change_.seconds = seconds(*table, "time");
  read_change_position(*table, state.machine, state.unit_mm);
  read_change_program(*table, state);
}

// The number of the channel that the key names, which a program may switch to.
std::optional<int> read_model(config::Table& table, const std::string& key,
                              const Machine& machine) {
  const std::string name = table.required_text(key);
  if (name.empty()) return std::nullopt;  // said already
  const auto& models = machine.models();
  for (std::size_t i = 0; i < models.size(); ++i) {
    if (models[i].channel != name) continue;
    if (models[i].kinematics) return static_cast<int>(i);
    // Seen from another channel it may be possible; this one then has no use for the code.
    return std::nullopt;
  }
  table.error(key, "there is no channel '" + printable(name) + "' to switch to." +
                       did_you_mean(name, machine.channels()));
  return std::nullopt;
}

// Tool centre point control: [tcp] on = "tcp", off = "joints".
void read_tcp(config::Table& top, Machine& machine) {
  auto table = top.table("tcp");
  if (!table) return;
  machine.tcp_on_ = read_model(*table, "on", machine);
  machine.tcp_off_ = read_model(*table, "off", machine);
}

// M-codes of the machine builder: [mcodes] M110 = { kind = "ignore" }.
void read_user_codes(config::Table& top, Machine& machine) {
  auto table = top.table("mcodes");
  if (!table) return;
  for (const std::string& key : table->keys()) {
    const auto code = key.starts_with("M") ? parse_number(key.substr(1)) : std::nullopt;
    if (!code || *code != std::floor(*code) || *code < 0 || *code > 99999) {
      table->error(key, "'" + printable(key) + "' is no M-code; write it like M110");
      continue;
    }
    auto rule = table->table(key);
    if (!rule) continue;
    UserCodeRule out;
    const std::string kind =
        rule->choice("kind", {"ignore", "time", "kinematics", "program", "unknown"}, "unknown");
    if (kind == "ignore") out.kind = UserCodeKind::ignore;
    if (kind == "kinematics") {
      if (*code < 100 || *code > 999)
        table->error(key, "a code that switches the kinematics is one of M100 to M999");
      // A code that this channel can't follow stays unknown.
      if (const auto model = read_model(*rule, "channel", machine)) {
        out.kind = UserCodeKind::kinematics;
        out.model = *model;
      }
    }
    if (kind == "time") {
      out.kind = UserCodeKind::time;
      if (!rule->has("time")) rule->error("time", "'time' is missing: the seconds that it takes");
      out.seconds = seconds(*rule, "time");
    }
    if (kind == "program")
      rule->error("kind", "an M-code that runs a program is not supported by this version");
    if (!machine.user_codes_.emplace(static_cast<int>(*code), out).second)
      table->error(key, "M" + shortest(*code) + " is there twice");
  }
}

void read_files(config::Table& top, ReadState& state) {
  const auto path_of = [&](const std::string& key) -> std::string {
    const auto path = top.text(key);
    if (!path) return {};
    auto full = state.files.full_path(*path);
    if (full) return *full;
    top.error(key, full.error().message);
    return {};
  };
  state.machine.default_tools_ = path_of("tools");
  state.machine.default_parameters_ = path_of("parameters");
}

std::vector<Diagnostic> read_default_fixtures(config::Table& top, ReadState& state) {
  Diagnostics found;
  const auto names = top.texts("fixtures");
  for (std::size_t i = 0; names && i < names->size(); ++i) {
    const SourceSpan span = top.item_span("fixtures", i);
    const std::string& name = (*names)[i];
    if (std::find(names->begin(), names->begin() + static_cast<long>(i), name) !=
        names->begin() + static_cast<long>(i)) {
      found.error("machine_invalid", span, "fixture '" + name + "' is there twice");
      continue;
    }
    if (auto fixture = read_fixture(name, span, state, found))
      state.machine.fixtures_.push_back(std::move(*fixture));
  }
  place_fixtures(state.machine);
  return found.list();
}

void read_collision(config::Table& top, Machine& machine, double unit_mm) {
  auto table = top.table("collision");
  if (!table) return;
  machine.collision_tolerance_ = length(*table, "tolerance", machine.collision_tolerance_, unit_mm);
  if (!(machine.collision_tolerance_ > 0))
    table->error("tolerance", "'tolerance' must be more than 0 mm");
  table->choice("watch", {"all"}, "all");

  std::vector<std::string> known;
  for (const Body& body : machine.bodies()) known.push_back(body.name);
  for (const Link& link : machine.links()) known.push_back(link.name);
  for (const Fixture& fixture : machine.fixtures()) known.push_back(fixture.name);
  const auto add = [&](const std::vector<std::string>& pair, const SourceSpan& span,
                       std::string reason) {
    const auto fail = [&](std::string message) {
      table->report(make_error("machine_invalid", span, std::move(message)));
    };
    if (pair.size() != 2) return fail("a pair that is ignored has two names");
    for (const std::string& name : pair)
      if (std::find(known.begin(), known.end(), name) == known.end())
        return fail("there is no body and no link '" + name + "'." + did_you_mean(name, known));
    machine.exclusions_.push_back({pair[0], pair[1], std::move(reason)});
  };
  if (table->holds_tables("ignore")) {
    std::vector<config::Table> pairs = table->tables("ignore");
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const std::string reason = pairs[i].required_text("reason");
      if (!pairs[i].has("bodies"))
        pairs[i].error("bodies", "'bodies' is missing: the two names of the pair");
      if (const auto names = pairs[i].texts("bodies"))
        add(*names, table->item_span("ignore", i), reason);
    }
  } else {
    const auto pairs = table->text_lists("ignore");
    for (std::size_t i = 0; i < pairs.size(); ++i)
      add(pairs[i], table->item_span("ignore", i), "declared by the machine's file");
  }
}

void check_body_names(config::Table& top, const Machine& machine) {
  // A body and a link may share a name only if the body is on that link: an exclusion names either.
  const std::vector<config::Table> tables = top.tables("body");
  for (std::size_t i = 0; i < tables.size() && i < machine.bodies().size(); ++i) {
    const Body& body = machine.bodies()[i];
    const auto link = machine.find_link(body.name);
    config::Table table = tables[i];
    if (link && *link != body.link)
      table.error("name", "body '" + body.name + "' has the name of a link that it is not on");
  }
}

}  // namespace

Diagnostic summary(const Diagnostics& problems, const std::string& kind, const std::string& what) {
  const auto first =
      std::find_if(problems.list().begin(), problems.list().end(),
                   [](const Diagnostic& d) { return d.severity == Severity::error; });
  return make_error(kind, first->span,
                    what + " has " + std::to_string(problems.errors()) +
                        (problems.errors() == 1 ? " error" : " errors"));
}

double read_units(config::Table& top, double fallback) {
  const std::string units = top.choice("units", {"mm", "inch"}, "");
  return units == "inch" ? 25.4 : units == "mm" ? 1.0 : fallback;
}

void check_schema(config::Table& top) {
  const auto schema = top.integer("schema");
  if (!schema) return;
  if (*schema > our_schema)
    top.error("schema", "schema " + std::to_string(*schema) + " is newer than this version of " +
                            "aircut, which knows schema " + std::to_string(our_schema));
  else if (*schema < 1)
    top.error("schema", "'schema' starts at 1");
}

Expected<std::shared_ptr<const Machine>> read_machine_text(const SourceText& text,
                                                           const std::string& folder,
                                                           const PackageFiles& files,
                                                           Diagnostics& out,
                                                           const std::string& channel) {
  config::Reader reader(text, "machine_invalid");
  config::Table top = reader.top();
  if (!top.has("schema")) top.error("schema", "'schema' is missing: write schema = 1");
  check_schema(top);
  auto machine = std::make_shared<Machine>();
  machine->folder_ = folder;
  machine->name_ = top.required_text("name");
  machine->dialect_ =
      top.choice("dialect", {"linuxcnc", "fanuc", "haas", "sinumerik", "grbl"}, "linuxcnc");
  if (machine->dialect_ == "sinumerik" || machine->dialect_ == "grbl")
    top.error("dialect",
              "the dialect '" + machine->dialect_ +
                  "' is not supported by this version; 'linuxcnc', 'fanuc' and 'haas' are");
  ReadState state{*machine, read_units(top, 1.0), files};

  read_tree(top, state);
  const std::vector<Drive> drives = read_drives(top, channel, state);
  machine->bodies_ = read_bodies(top, "", bed_link, state);
  check_body_names(top, *machine);
  for (Diagnostic& problem : read_default_fixtures(top, state)) top.report(std::move(problem));
  read_collision(top, *machine, state.unit_mm);
  read_tool_change(top, state);
  read_user_codes(top, *machine);
  if (const auto wait = read_wait_codes(top); wait && machine->channels().empty())
    top.error("wait", "[wait] is for a machine with channels, and there is no [[channel]]");
  read_tcp(top, *machine);
  read_files(top, state);

  Diagnostics problems = reader.finish();
  if (problems.errors() == 0)
    for (const Drive& drive : drives) {
      Machine driven = *machine;
      drive.put_on(driven);
      if (const auto reason = tree_disagrees(driven))
        problems.error("machine_invalid", drive.span, *reason);
    }
  for (const Diagnostic& problem : problems.list()) out.add(problem);
  if (problems.errors() == 0) return std::shared_ptr<const Machine>(machine);
  return unexpected(summary(problems, "machine_invalid", "the machine's file"));
}

Expected<std::shared_ptr<const Machine>> read_machine(const std::string& path, SourceMap& sources,
                                                      Diagnostics& out,
                                                      const std::string& channel) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path file =
      fs::is_directory(path, error) ? fs::path(path) / "machine.toml" : fs::path(path);
  const auto text = sources.open(file.string());
  if (!text) {
    out.add(text.error());
    return unexpected(text.error());
  }
  return read_machine(**text, file.has_parent_path() ? file.parent_path().string() : ".", sources,
                      out, channel);
}

Expected<std::shared_ptr<const Machine>> read_machine(const SourceText& text,
                                                      const std::string& folder, SourceMap& sources,
                                                      Diagnostics& out,
                                                      const std::string& channel) {
  return read_machine_text(text, folder, disk_files(folder, sources), out, channel);
}

}  // namespace aircut::machine
