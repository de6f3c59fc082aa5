// setup.toml: what a job adds to a machine.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "machine/kinematics/kinematics_table.h"
#include "machine/reading.h"

namespace aircut::machine {

namespace {

constexpr double deg = std::numbers::pi / 180;

std::vector<SetupFixture> read_fixtures(config::Table& top, double unit_mm) {
  std::vector<SetupFixture> fixtures;
  std::set<std::string> names;
  for (config::Table table : top.tables("fixture")) {
    SetupFixture fixture;
    fixture.name = table.required_text("name");
    if (!fixture.name.empty() && !names.insert(fixture.name).second)
      table.error("name", "fixture '" + fixture.name + "' is there twice");
    table.know("place");
    if (table.has("place")) fixture.place = point(table, "place", Vec3::Zero(), unit_mm);
    if (const auto angle = table.number("angle")) fixture.angle = *angle * deg;
    fixture.present = table.boolean("present", true);
    fixture.span = table.has("name") ? table.span("name") : table.span();
    fixtures.push_back(std::move(fixture));
  }
  return fixtures;
}

// G54 = [x, y, z, a, b, c, u, v, w], at least the first three.
std::map<int, AxisValues> read_offsets(config::Table& top, double unit_mm) {
  static const std::vector<std::string> systems = {"G54", "G55",   "G56",   "G57",  "G58",
                                                   "G59", "G59.1", "G59.2", "G59.3"};
  std::map<int, AxisValues> offsets;
  auto table = top.table("offsets");
  if (!table) return offsets;
  for (const std::string& system : systems) {
    const auto values = table->numbers(system, 0);
    if (!values) continue;
    if (values->size() < 3 || values->size() > 9) {
      table->error(system, "'" + system + "' needs 3 to 9 numbers in the order X Y Z A B C U V W");
      continue;
    }
    AxisValues offset;
    for (std::size_t i = 0; i < values->size(); ++i) {
      const Axis axis = all_axes[i];
      offset[axis] = (*values)[i] * (is_rotary(axis) ? deg : unit_mm);
      if (std::abs(offset[axis]) > 1e6)
        table->error(system, "'" + system + "' goes up to 1 km and 1e6 rad");
    }
    const auto number = std::find(systems.begin(), systems.end(), system) - systems.begin() + 1;
    offsets[static_cast<int>(number)] = offset;
  }
  return offsets;
}

std::optional<JointVector> read_start(config::Table& top, const Machine& machine, double unit_mm) {
  auto table = top.table("start");
  if (!table) return std::nullopt;
  auto joints = table->table("joints");
  if (!joints) {
    if (!table->has("joints"))
      table->error("joints", "'joints' is missing, like joints = { X = 100 }");
    return std::nullopt;
  }
  JointVector start = machine.home();
  for (int i = 0; i < machine.joint_count(); ++i) {
    const Joint& joint = machine.joint(JointId{i});
    const double unit = joint.kind == JointKind::rotary ? deg : unit_mm;
    const auto value = joints->number(joint.name);
    if (!value) continue;
    start[i] = *value * unit;
    if (start[i] < joint.min || start[i] > joint.max)
      joints->error(joint.name, joint.name + " " + shortest(*value) + " is outside of the travel " +
                                    shortest(joint.min / unit) + " to " +
                                    shortest(joint.max / unit));
  }
  const auto tip = machine.kinematics().forward(start, {});
  if (!tip)
    table->error("joints", "this start is no position of the machine: " + tip.error().reason);
  return start;
}

void refuse(config::Table& top, const std::string& key, const std::string& what) {
  top.know(key);
  if (!top.has(key)) return;
  top.error(key, what + " is not supported by this version");
}

}  // namespace

Expected<Setup> read_setup_text(const SourceText& text, const Machine& machine, Diagnostics& out) {
  config::Reader reader(text, "setup_invalid");
  config::Table top = reader.top();
  check_schema(top);
  const double unit_mm = read_units(top, 1.0);
  Setup setup;
  setup.fixtures = read_fixtures(top, unit_mm);
  setup.offsets = read_offsets(top, unit_mm);
  setup.start = read_start(top, machine, unit_mm);
  setup.stock = read_stock(top, unit_mm);
  setup.part = read_part(top, unit_mm);
  refuse(top, "probe", "[probe]");
  const Diagnostics problems = reader.finish();
  for (const Diagnostic& problem : problems.list()) out.add(problem);
  if (problems.errors() == 0) return setup;
  return unexpected(summary(problems, "setup_invalid", "the setup"));
}

Expected<Setup> read_setup(const std::string& path, const Machine& machine, SourceMap& sources,
                           Diagnostics& out) {
  const auto text = sources.open(path);
  if (!text) {
    out.add(text.error());
    return unexpected(text.error());
  }
  auto setup = read_setup_text(**text, machine, out);
  if (!setup) return setup;
  const std::size_t slash = path.find_last_of('/');
  setup->folder = slash == std::string::npos ? "." : path.substr(0, slash);
  if (setup->stock && setup->stock->raw.shape == StockShape::saved) {
    const auto saved = disk_files(setup->folder, sources).text(setup->stock->mesh_path);
    if (!saved) {
      Diagnostic error = saved.error();
      error.kind = "setup_invalid";  // the file is the set-up's, not the machine's
      error.span = setup->stock->mesh_span;
      out.add(error);
      return unexpected(error);
    }
    setup->stock->raw.saved = *saved;
  }
  return setup;
}

Expected<std::shared_ptr<const Machine>> apply_setup(const Machine& machine, const Setup& setup,
                                                     SourceMap& sources, Diagnostics& out) {
  auto changed = std::make_shared<Machine>(machine);
  remove_fixture_bodies(*changed);
  const PackageFiles files = disk_files(machine.folder(), sources);
  ReadState state{*changed, 1.0, files};
  const std::size_t errors_before = out.errors();
  for (const SetupFixture& wanted : setup.fixtures) {
    auto& fixtures = changed->fixtures_;
    auto at = std::find_if(fixtures.begin(), fixtures.end(),
                           [&](const Fixture& fixture) { return fixture.name == wanted.name; });
    if (at == fixtures.end()) {
      auto fixture = read_fixture(wanted.name, wanted.span, state, out);
      if (!fixture) continue;
      fixtures.push_back(std::move(*fixture));
      at = fixtures.end() - 1;
    }
    if (!wanted.present) {
      fixtures.erase(at);
      continue;
    }
    at->place = wanted.place.value_or(at->place);
    at->angle = wanted.angle.value_or(at->angle);
  }
  place_fixtures(*changed);
  const PackageFiles own = disk_files(setup.folder, sources);
  if (setup.stock) place_stock(*setup.stock, own, *changed, out);
  if (setup.part) place_part(*setup.part, own, *changed, out);
  if (out.errors() == errors_before) return std::shared_ptr<const Machine>(changed);
  return unexpected(make_error("setup_invalid", "the setup can't be put on the machine"));
}

}  // namespace aircut::machine
