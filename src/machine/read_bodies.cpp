// Bodies of the machine and of its fixtures.
#include <charconv>
#include <cmath>
#include <numbers>

#include "machine/kinematics/kinematics_table.h"
#include "machine/reading.h"
#include "machine/rotation/rotation.h"

namespace aircut::machine {

namespace {

constexpr double deg = std::numbers::pi / 180;
constexpr std::size_t max_triangles = 20'000'000;  // of a machine (product limits)

// [x, y, z] or [x, y, z, a, b, c]: degrees, turned about the fixed X, then Y, then Z axis.
Pose read_pose(config::Table& table, double unit_mm) {
  const auto values = table.numbers("pose", 0);
  if (!values) return Pose::Identity();
  const auto fail = [&](const std::string& message) {
    table.error("pose", message);
    return Pose::Identity();
  };
  if (values->size() != 3 && values->size() != 6)
    return fail("'pose' needs [x, y, z] or [x, y, z, a, b, c] with angles in degrees");
  for (const double value : *values)
    if (std::abs(value) * unit_mm > 1e6) return fail("'pose' goes up to 1 km and 1e6 degrees");
  const std::vector<double>& v = *values;
  Pose X = translation(Vec3(v[0], v[1], v[2]) * unit_mm);
  if (v.size() == 6) X.linear() = about_fixed_axes(Vec3(v[3], v[4], v[5]) * deg);
  return X;
}

std::shared_ptr<const TriangleMesh> load_mesh(config::Table& table, ReadState& state) {
  const MeshFileOptions options = read_mesh_options(table, state.unit_mm);
  const std::string path = table.required_text("mesh");
  if (!table.has("mesh") || path.empty()) {
    if (table.has("mesh") && table.text("mesh"))
      table.error("mesh", "'mesh' is empty: it needs the path of a mesh file in the package");
    return nullptr;
  }
  auto mesh = state.files.mesh(path, options);
  if (!mesh) {
    Diagnostic error = mesh.error();
    error.span = table.span("mesh");
    table.report(std::move(error));
    return nullptr;
  }
  if (state.counted.insert(mesh->get()).second) {
    const bool fits = state.triangles <= max_triangles;
    state.triangles += (*mesh)->triangles.size();
    if (fits && state.triangles > max_triangles)
      table.error("mesh", "the meshes of this machine have more than 20 million triangles");
  }
  return *mesh;
}

// A name that can stand in a message, a file name of a picture and a list of exclusions.
void check_name(config::Table& table, const std::string& key, const std::string& name) {
  const bool control = name != printable(name);
  if (name.empty() || control || name.find('/') != std::string::npos)
    table.error(key, "a name must not be empty and has no '/' and no control characters");
}

}  // namespace

Color read_color(config::Table& table, Color fallback) {
  const auto text = table.text("color");
  if (!text) return fallback;
  unsigned rgb = 0;
  const char* end = text->data() + text->size();
  if (text->size() == 7 && text->front() == '#' &&
      std::from_chars(text->data() + 1, end, rgb, 16).ptr == end)
    return {static_cast<unsigned char>(rgb >> 16), static_cast<unsigned char>(rgb >> 8 & 255u),
            static_cast<unsigned char>(rgb & 255u)};
  table.error("color",
              "'color' is written \"#rrggbb\" with two hexadecimal digits each, like "
              "\"#8a8f94\"");
  return {};
}

MeshFileOptions read_mesh_options(config::Table& table, double unit_mm) {
  MeshFileOptions options;
  const std::string unit = table.choice("unit", {"mm", "cm", "m", "inch"}, "");
  options.unit_mm = unit == "mm"     ? 1
                    : unit == "cm"   ? 10
                    : unit == "m"    ? 1000
                    : unit == "inch" ? 25.4
                                     : unit_mm;
  options.y_up = table.choice("up", {"z", "y"}, "z") == "y";
  return options;
}

std::vector<Body> read_bodies(config::Table& top, const std::string& prefix, LinkId link,
                              ReadState& state) {
  std::vector<Body> bodies;
  std::set<std::string> names;
  const bool fixture = !prefix.empty();
  for (config::Table table : top.tables("body")) {
    Body body;
    body.link = link;
    std::string name;
    if (fixture) {
      body.role = Role::fixture;
      name = table.required_text("name");
    } else {
      if (!table.has("link"))
        table.error("link", "'link' is missing: the link that the body moves with");
      body.link = read_link(table, "link", "bed", state.machine);
      name = table.text("name", table.text("link", "bed"));
      const std::string role = table.choice("role", {"machine", "spindle", "fixture"}, "machine");
      body.role = role == "spindle"   ? Role::spindle
                  : role == "fixture" ? Role::fixture
                                      : Role::machine;
    }
    const std::string name_key = table.has("name") ? "name" : "link";
    if (table.has(name_key)) check_name(table, name_key, name);
    if (!names.insert(name).second)
      table.error(name_key, "there are two bodies named '" + name + "'" +
                                (table.has("name") ? "" : "; give them a 'name'"));
    body.name = prefix + name;
    body.span = table.span();
    body.color = read_color(table);
    body.collide = table.boolean("collide", true);
    body.X_LB = read_pose(table, state.unit_mm);
    body.mesh = load_mesh(table, state);
    bodies.push_back(std::move(body));
  }
  return bodies;
}

std::optional<Fixture> read_fixture(const std::string& name, const SourceSpan& span,
                                    ReadState& state, Diagnostics& out) {
  const auto fail = [&](std::string message) {
    out.error("machine_invalid", span, std::move(message));
    return std::nullopt;
  };
  if (name.empty() || name != printable(name) || name.find('/') != std::string::npos)
    return fail("a fixture is named by its file fixtures/NAME.toml, without the folder");
  const auto text = state.files.text("fixtures/" + name + ".toml");
  if (!text) return fail("fixture '" + name + "': " + text.error().message);

  config::Reader reader(**text, "machine_invalid");
  config::Table top = reader.top();
  check_schema(top);
  ReadState here{state.machine, read_units(top, state.unit_mm), state.files, state.triangles,
                 std::move(state.counted)};
  Fixture fixture;
  fixture.name = name;
  const std::string own_name = top.text("name", name);
  if (own_name != name)
    top.error("name", "'name' is '" + own_name + "', but the file is named '" + name + ".toml'");
  const Link& work =
      state.machine.links()[static_cast<std::size_t>(index(state.machine.work_link()))];
  fixture.link = read_link(top, "link", work.name, state.machine);
  fixture.place = point(top, "place", Vec3::Zero(), here.unit_mm);
  fixture.angle = top.number("angle", 0) * deg;
  if (!top.has("body")) top.error("body", "there is no [[body]]: a fixture needs at least one");
  fixture.bodies = read_bodies(top, name + "/", fixture.link, here);
  state.triangles = here.triangles;
  state.counted = std::move(here.counted);

  const Diagnostics problems = reader.finish();
  for (const Diagnostic& problem : problems.list()) out.add(problem);
  if (problems.errors() > 0) return std::nullopt;
  return fixture;
}

void remove_fixture_bodies(Machine& machine) {
  for (const Fixture& fixture : machine.fixtures_)
    std::erase_if(machine.bodies_,
                  [&](const Body& body) { return body.name.starts_with(fixture.name + "/"); });
}

void place_fixtures(Machine& machine) {
  for (const Fixture& fixture : machine.fixtures_) {
    // With all joints at zero every link frame equals the bed's, and so M has the same place in
    // the fixture's link as in the work link.
    Pose X_MF = translation(fixture.place);
    X_MF.linear() = Eigen::AngleAxisd(fixture.angle, Vec3::UnitZ()).toRotationMatrix();
    for (Body body : fixture.bodies) {
      body.link = fixture.link;
      body.X_LB = machine.X_LM() * X_MF * body.X_LB;
      machine.bodies_.push_back(std::move(body));
    }
  }
}

}  // namespace aircut::machine
