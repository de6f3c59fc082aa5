// The raw piece of a job: `[stock]` of a setup.toml, and its place on the machine.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "machine/kinematics/kinematics_table.h"
#include "machine/mesh_check.h"
#include "machine/reading.h"
#include "machine/rotation/rotation.h"

namespace aircut::machine {

namespace {

constexpr double deg = std::numbers::pi / 180;
constexpr double largest = 1e5;           // mm
constexpr double facet_tolerance = 0.01;  // mm, of drawn cylinders

// Sizes of one shape, all above zero; an error at the key otherwise.
std::optional<std::vector<double>> sizes(config::Table& table, const std::string& key,
                                         std::size_t count, double unit_mm) {
  auto values = table.numbers(key, count);
  if (!values) return std::nullopt;
  for (double& value : *values) {
    value *= unit_mm;
    if (value > 0 && value <= largest) continue;
    table.error(key, "the sizes of '" + key + "' must be above 0 and up to 100 m");
    return std::nullopt;
  }
  return values;
}

// A tube about Z from z = 0: outside of the true wall by at most facet_tolerance.
TriangleMesh tube(double outer, double bore, double height) {
  const double step = std::acos(1 / (1 + facet_tolerance / outer));  // half the angle of a facet
  const auto n = static_cast<std::uint32_t>(std::max(12.0, std::ceil(std::numbers::pi / step)));
  const double r1 = outer / std::cos(std::numbers::pi / n);
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double a = 2 * std::numbers::pi * i / n;
    const Vec3 u(std::cos(a), std::sin(a), 0);
    const Vec3 up(0, 0, height);
    mesh.vertices.insert(mesh.vertices.end(), {u * r1, u * r1 + up, u * bore + up, u * bore});
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t a = 4 * i, b = 4 * ((i + 1) % n);
    for (std::uint32_t k = 0; k < 4; ++k) {
      const std::uint32_t next = (k + 1) % 4;
      mesh.triangles.push_back({a + k, b + k, b + next});
      mesh.triangles.push_back({a + k, b + next, a + next});
    }
  }
  return mesh;
}

std::shared_ptr<const TriangleMesh> surface(const RawStock& raw) {
  if (raw.shape == StockShape::box)
    return std::make_shared<TriangleMesh>(
        make_box(Vec3(-raw.size.x() / 2, -raw.size.y() / 2, 0),
                 Vec3(raw.size.x() / 2, raw.size.y() / 2, raw.size.z())));
  if (raw.bore > 0)
    return std::make_shared<TriangleMesh>(tube(raw.diameter / 2, raw.bore / 2, raw.height));
  return std::make_shared<TriangleMesh>(
      revolve({{raw.diameter / 2, 0}, {raw.diameter / 2, raw.height}}, facet_tolerance));
}

// Exactly one of box, cylinder, tube, mesh, file.
void read_shape(config::Table& table, SetupStock& stock, double unit_mm) {
  RawStock& raw = stock.raw;
  std::vector<std::string> given;
  for (const char* key : {"box", "cylinder", "tube", "mesh", "file"}) {
    table.know(key);
    if (table.has(key)) given.push_back(key);
  }
  if (given.size() != 1)
    return table.error(given.empty() ? "box" : given[1],
                       "[stock] needs one shape: box = [x, y, z], cylinder = [diameter, height], "
                       "tube = [diameter, bore, height], mesh = \"FILE\", or file = \"FILE\" of a "
                       "stock that was saved");
  if (const auto box = sizes(table, "box", 3, unit_mm))
    raw.size = Vec3((*box)[0], (*box)[1], (*box)[2]);
  if (const auto cylinder = sizes(table, "cylinder", 2, unit_mm)) {
    raw.shape = StockShape::cylinder;
    raw.diameter = (*cylinder)[0];
    raw.height = (*cylinder)[1];
  }
  if (const auto tube = sizes(table, "tube", 3, unit_mm)) {
    raw.shape = StockShape::cylinder;
    raw.diameter = (*tube)[0];
    raw.bore = (*tube)[1];
    raw.height = (*tube)[2];
    if (raw.bore >= raw.diameter) table.error("tube", "the bore must be less than the diameter");
  }
  if (given[0] == "file") {
    raw.shape = StockShape::saved;
    stock.mesh_path = table.text("file", "");
    stock.mesh_span = table.span("file");
    if (stock.mesh_path.empty()) table.error("file", "'file' needs the path of a saved stock");
  }
  if (given[0] != "mesh") return;
  raw.shape = StockShape::mesh;
  stock.mesh_path = table.text("mesh", "");
  stock.mesh_span = table.span("mesh");
  stock.mesh_options = read_mesh_options(table, unit_mm);
  if (stock.mesh_path.empty()) table.error("mesh", "'mesh' needs the path of a mesh file");
}

}  // namespace

std::optional<SetupStock> read_stock(config::Table& top, double unit_mm) {
  auto table = top.table("stock");
  if (!table) return std::nullopt;
  SetupStock stock;
  read_shape(*table, stock, unit_mm);
  stock.place = point(*table, "place", Vec3::Zero(), unit_mm);
  stock.angle = table->number("angle", 0) * deg;
  if (const auto angles = table->numbers("angles", 3)) {
    if (table->has("angle"))
      table->error("angles", "'angle' turns about Z alone, 'angles' about all three: give one");
    // Until it is placed, S is seen from what `place` is seen from.
    stock.raw.X_LS.linear() =
        about_fixed_axes(Vec3((*angles)[0], (*angles)[1], (*angles)[2]) * deg);
  }
  stock.fixture = table->text("fixture", "");
  stock.fixture_span = table->has("fixture") ? table->span("fixture") : table->span();
  stock.replaces = table->text("replaces", "");
  stock.replaces_span = table->has("replaces") ? table->span("replaces") : table->span();
  stock.raw.color = read_color(*table, stock.raw.color);
  stock.raw.span = table->span();
  if (const auto pitch = table->number("pitch")) {
    stock.raw.pitch = *pitch * unit_mm;
    if (*stock.raw.pitch < 1e-3 || *stock.raw.pitch > 10)
      table->error("pitch", "'pitch' is the spacing of the lattice: 0.001 to 10 mm");
    if (stock.raw.shape == StockShape::saved)
      table->error("pitch", "a saved stock has its lattice already; take 'pitch' out");
  }
  return stock;
}

void place_stock(const SetupStock& stock, const PackageFiles& files, Machine& machine,
                 Diagnostics& out) {
  RawStock raw = stock.raw;
  const auto fail = [&](const SourceSpan& span, const std::string& message) {
    out.error("setup_invalid", span, message);
  };
  raw.link = machine.work_link();
  Pose X_MS = translation(stock.place);
  X_MS.linear() =
      Eigen::AngleAxisd(stock.angle, Vec3::UnitZ()).toRotationMatrix() * stock.raw.X_LS.linear();
  if (!stock.fixture.empty()) {
    std::vector<std::string> names;
    const Fixture* holder = nullptr;
    for (const Fixture& fixture : machine.fixtures()) {
      names.push_back(fixture.name);
      if (fixture.name == stock.fixture) holder = &fixture;
    }
    if (!holder)
      return fail(stock.fixture_span, "there is no fixture '" + printable(stock.fixture) +
                                          "' on the machine." + did_you_mean(stock.fixture, names));
    Pose X_MF = translation(holder->place);
    X_MF.linear() = Eigen::AngleAxisd(holder->angle, Vec3::UnitZ()).toRotationMatrix();
    X_MS = X_MF * X_MS;
    raw.link = holder->link;
  }
  raw.X_LS = machine.X_LM() * X_MS;
  if (raw.shape == StockShape::mesh) {
    const auto mesh =
        setup_solid(files, stock.mesh_path, stock.mesh_options, stock.mesh_span, "stock");
    if (!mesh) return out.add(mesh.error());
    raw.mesh = *mesh;
  } else if (raw.shape == StockShape::saved) {
    if (!raw.mesh || !raw.saved) return fail(stock.mesh_span, "a saved stock can't be used here");
  } else {
    raw.mesh = surface(raw);
  }
  if (!stock.replaces.empty()) {
    std::vector<std::string> drawn;
    for (const Body& other : machine.bodies())
      if (!other.collide) drawn.push_back(other.name);
    if (std::find(drawn.begin(), drawn.end(), stock.replaces) == drawn.end())
      return fail(stock.replaces_span,
                  "'replaces' needs a body that is only drawn (collide = "
                  "false), and '" +
                      printable(stock.replaces) + "' is none." +
                      did_you_mean(stock.replaces, drawn));
    std::erase_if(machine.bodies_, [&](const Body& other) { return other.name == stock.replaces; });
  }
  for (const Body& other : machine.bodies())
    if (other.name == "stock")
      return fail(other.span,
                  "the machine has a body named 'stock', which is the raw piece's name");
  Body body;
  body.name = "stock";
  body.role = Role::stock;
  body.link = raw.link;
  body.mesh = raw.mesh;
  body.X_LB = raw.X_LS;
  body.color = raw.color;
  body.span = raw.span;
  machine.bodies_.push_back(std::move(body));
  machine.stock_ = std::move(raw);
}

}  // namespace aircut::machine
