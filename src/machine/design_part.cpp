// The part that a job makes: `[part]` of a setup.toml, or `part = "target.stl"`.
#include <cmath>
#include <numbers>

#include "machine/kinematics/kinematics_table.h"
#include "machine/mesh_check.h"
#include "machine/reading.h"

namespace aircut::machine {

namespace {

constexpr double deg = std::numbers::pi / 180;
constexpr double largest_tolerance = 100;  // mm

// A length of 0 or more at a key.
double tolerance(config::Table& table, const std::string& key, double fallback, double unit_mm) {
  const double value = table.number(key, fallback / unit_mm) * unit_mm;
  if (value >= 0 && value <= largest_tolerance) return value;
  table.error(key, "'" + key + "' must be 0 to " + shortest(largest_tolerance) + " mm");
  return fallback;
}

void read_leave(config::Table& table, DesignPart& part, double unit_mm) {
  for (config::Table box : table.tables("leave")) {
    const Vec3 low = point(box, "low", Vec3::Zero(), unit_mm);
    const Vec3 high = point(box, "high", Vec3::Zero(), unit_mm);
    if (!(low.array() < high.array()).all())
      box.error("high", "a box needs low = [x, y, z] and high = [x, y, z], each above its low");
    else
      part.leave.emplace_back(low, high);
  }
}

}  // namespace

std::optional<SetupPart> read_part(config::Table& top, double unit_mm) {
  top.know("part");
  if (!top.has("part")) return std::nullopt;
  SetupPart out;
  out.part.span = out.mesh_span = top.span("part");
  out.mesh_options.unit_mm = unit_mm;
  if (!top.holds_table("part")) {
    out.mesh_path = top.text("part", "");
    if (out.mesh_path.empty()) top.error("part", "'part' needs the path of a mesh file");
    return out;
  }
  auto table = top.table("part");
  if (!table) return std::nullopt;
  out.mesh_path = table->required_text("mesh");
  if (table->has("mesh")) out.mesh_span = table->span("mesh");
  out.mesh_options = read_mesh_options(*table, unit_mm);
  out.place = point(*table, "place", Vec3::Zero(), unit_mm);
  out.angle = table->number("angle", 0) * deg;
  out.part.gouge = tolerance(*table, "gouge", out.part.gouge, unit_mm);
  out.part.excess = tolerance(*table, "excess", out.part.excess, unit_mm);
  out.part.allowance = tolerance(*table, "allowance", 0, unit_mm);
  read_leave(*table, out.part, unit_mm);
  return out;
}

void place_part(const SetupPart& wanted, const PackageFiles& files, Machine& machine,
                Diagnostics& out) {
  if (!machine.stock_)
    return out.error("setup_invalid", wanted.part.span,
                     "a part is compared with the stock, and there is none: add [stock]");
  const auto mesh =
      setup_solid(files, wanted.mesh_path, wanted.mesh_options, wanted.mesh_span, "part");
  if (!mesh) return out.add(mesh.error());
  Pose X_SP = translation(wanted.place);
  X_SP.linear() = Eigen::AngleAxisd(wanted.angle, Vec3::UnitZ()).toRotationMatrix();
  DesignPart part = wanted.part;
  part.mesh = std::make_shared<TriangleMesh>(transformed(**mesh, X_SP));
  machine.part_ = std::move(part);
}

}  // namespace aircut::machine
