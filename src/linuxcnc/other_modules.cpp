// Modules of arms and of machines with rods. The types of ours that stand for them have the
// modules' formulas (docs/kinematics.md); here their inputs are named, and the links are laid out
// that the types ask for.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "linuxcnc/module_import.h"

namespace aircut::linuxcnc {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using package::Couple;
using package::DriveText;
using package::fixed_angles;
using package::list_of;

std::string number(const char* key, double value) {
  return std::string(key) + " = " + shortest(value) + "\n";
}

bool enough_joints(ModuleImport& m, int count) {
  if (count <= m.joints()) return true;
  m.error("it needs " + std::to_string(count) + " joints, [KINS]JOINTS says " +
          std::to_string(m.joints()));
  return false;
}

// The control adds a tool's length along Z of the machine whatever the flange does.
void upright_tools_only(ModuleImport& m) {
  m.unchecked(
      "the control counts a tool's length along Z of the machine, however the tool is "
      "tilted; here it is along the tool");
}

// ---- machines with rods and belts ---------------------------------------------------------------

// Motors that the kinematics turns into a platform's place; the platform carries the tool.
void on_platform(ModuleImport& m, int motors, bool turning, const std::string& kinematics,
                 const std::string& angles = "", const std::vector<double>& homes = {}) {
  if (!enough_joints(m, motors)) return;
  for (int joint = 0; joint < motors; ++joint) {
    Couple couple = m.couple(joint, turning, Vector3d::UnitZ());
    if (!homes.empty()) couple.limits.home = homes[static_cast<std::size_t>(joint)];
    m.text().add(couple);
  }
  DriveText drive;
  drive.kinematics = kinematics;
  drive.spindle = m.text().platform(angles);
  m.text().drive(drive);
  m.leave_out_from(motors);
}

void linear_delta(ModuleImport& m) {
  on_platform(m, 3, false,
              "type = \"delta-linear\"\n" + number("radius", m.length("R", 130.25)) +
                  number("rod", m.length("L", 269)));
}

void rotary_delta(ModuleImport& m) {
  on_platform(m, 3, true,
              "type = \"delta-rotary\"\n" + number("hip", m.length("platformradius", 10)) +
                  number("thigh", m.length("thighlength", 10)) +
                  number("shin", m.length("shinlength", 14)) +
                  number("foot", m.length("footradius", 6)));
}

void tripod(ModuleImport& m) {
  on_platform(m, 3, false,
              "type = \"tripod\"\nroot = \"upper\"\n" + number("bx", m.length("Bx", 1)) +
                  number("cx", m.length("Cx", 1)) + number("cy", m.length("Cy", 1)));
}

void corexy(ModuleImport& m) {
  if (!enough_joints(m, 3)) return;
  m.text().add(m.couple(0, false, Vector3d::UnitX()));
  m.text().add(m.couple(1, false, Vector3d::UnitX()));
  m.text().add(m.couple(2, false, Vector3d::UnitZ(), "platform_y"));
  m.text().platform("");
  m.text().drive({.kinematics = "type = \"corexy\"\n", .spindle = "J2"});
  m.leave_out_from(3);
}

void matrix(ModuleImport& m) {
  std::string values;
  for (const char row : std::string("xyz"))
    for (const char column : std::string("xyz")) {
      const std::string pin = std::string("C_") + row + column;
      values += (values.empty() ? "" : ", ") + shortest(m.plain(pin, row == column ? 1 : 0));
    }
  on_platform(m, 3, false, "type = \"calibrated\"\nmatrix = [" + values + "]\n");
}

void rose(ModuleImport& m) {
  if (!enough_joints(m, 3)) return;
  Couple radius = m.couple(0, false, Vector3d::UnitX());
  constexpr double nearest_mm = 0.001;  // at the centre the table's angle is open
  radius.limits.min = std::max(radius.limits.min.value_or(0), 0.0);
  radius.limits.home = std::max(radius.limits.home, nearest_mm);
  m.text().add(radius);
  m.text().add(m.couple(1, false, Vector3d::UnitZ(), "J0"));
  Couple table = m.couple(2, true, Vector3d::UnitZ());
  table.sense = -1;
  m.text().add(table);
  m.text().drive({.kinematics = "type = \"polar\"\n", .work = "J2", .spindle = "J1"});
  m.leave_out_from(3);
}

// Where the platform is with all struts at home: as the set-up says, or above (or below) the base
// by what the struts leave.
Vector3d start_of(ModuleImport& m, const std::vector<Vector3d>& base,
                  const std::vector<Vector3d>& platform) {
  if (const auto home = m.home_point()) return *home;
  double height = 0;
  for (std::size_t i = 0; i < base.size(); ++i) {
    const Vector3d d = platform[i] - base[i];
    const double strut = m.limits(static_cast<int>(i), false).home;
    height += std::sqrt(std::max(strut * strut - d.x() * d.x() - d.y() * d.y(), 1.0)) - d.z();
  }
  return {0, 0, height / static_cast<double>(base.size())};
}

void hexapod(ModuleImport& m) {
  std::vector<Vector3d> base, platform;
  const Vector3d spindle(0, 0, m.length("spindle-offset", 0));
  for (int i = 0; i < 6; ++i) {
    base.push_back(m.point("base." + std::to_string(i)) + spindle);
    platform.push_back(m.point("platform." + std::to_string(i)) + spindle);
  }
  if (!m.gets_tool_length("tool-offset"))
    m.unchecked(
        "tool-offset does not get motion.tooloffset.z, so the control turns the platform "
        "about another point when a tool has a length; here the tip is followed");
  if (m.plain("screw-lead", 0) != 0)
    m.unchecked(
        "the struts are corrected for the turning of their screws (screw-lead), which is "
        "not modelled");
  on_platform(m, 6, false,
              "type = \"hexapod\"\nbase = " + list_of(base) + "\nplatform = " + list_of(platform) +
                  "\nstart = " + list_of(start_of(m, base, platform)) + "\n",
              "cba");
}

void pentapod(ModuleImport& m) {
  if (!enough_joints(m, 5)) return;
  const Vector3d start = m.home_point().value_or(Vector3d::Zero());
  std::vector<Vector3d> base;
  std::vector<double> homes;
  std::string rings, heights;
  bool meet = true;
  for (int i = 0; i < 5; ++i) {
    const std::string n = std::to_string(i);
    base.push_back(m.point("base." + n));
    const double ring = m.length("effector." + n + ".r", {});
    const double height = m.length("effector." + n + ".z", {});
    rings += (i ? ", " : "") + shortest(ring);
    heights += (i ? ", " : "") + shortest(height);
    const Vector3d w = base.back() - start;
    homes.push_back(std::hypot(w.z() - height, std::hypot(w.x(), w.y()) - ring));
    constexpr double close_mm = 0.1;
    meet = meet && std::fabs(m.limits(i, false).home - homes.back()) <= close_mm;
  }
  if (!meet)
    m.unchecked(
        "the joints' HOME lengths are not those of the axes' HOME pose; runs start at the "
        "pose");
  if (!m.gets_tool_length("tool-offset"))
    m.unchecked(
        "tool-offset does not get motion.tooloffset.z, so the control turns the spindle "
        "about another point when a tool has a length; here the tip is followed");
  on_platform(m, 5, false,
              "type = \"pentapod\"\nbase = " + list_of(base) + "\nring = [" + rings +
                  "]\nheight = [" + heights + "]\nstart = " + list_of(start) + "\n",
              "ba", homes);
}

// ---- arms ---------------------------------------------------------------------------------------

struct Hinge {
  Vector3d origin, direction;
};

// Turning joints, one on the other.
void hinges(ModuleImport& m, const std::vector<Hinge>& all, DriveText drive) {
  std::string parent = "bed";
  for (std::size_t i = 0; i < all.size(); ++i) {
    Couple couple = m.couple(static_cast<int>(i), true, all[i].direction, parent);
    couple.origin = all[i].origin;
    parent = couple.name;
    m.text().add(couple);
  }
  drive.spindle = parent;
  m.text().drive(std::move(drive));
  m.leave_out_from(static_cast<int>(all.size()));
}

// Two hinges across the level upper arm, forearm and flange hang down at zero.
void elbow_arm(ModuleImport& m, const std::string& kinematics, double a1, double d1, double a2,
               double a3, double side, double d4, double d6) {
  if (!enough_joints(m, 6)) return;
  upright_tools_only(m);
  const Vector3d y = Vector3d::UnitY(), z = Vector3d::UnitZ();
  const Vector3d elbow(a1 + a2, 0, d1), forearm(a1 + a2 + a3, side, d1);
  const Vector3d wrist = forearm - d4 * z;
  hinges(
      m,
      {{Vector3d::Zero(), z}, {{a1, 0, d1}, y}, {elbow, y}, {forearm, -z}, {wrist, y}, {wrist, -z}},
      {.kinematics = kinematics, .gauge = wrist - d6 * z});
}

void puma(ModuleImport& m) {
  const double a2 = m.length("A2", 300), a3 = m.length("A3", 50), d3 = m.length("D3", 70),
               d4 = m.length("D4", 400), d6 = m.length("D6", 70);
  elbow_arm(m,
            "type = \"puma\"\n" + number("a2", a2) + number("a3", a3) + number("d3", d3) +
                number("d4", d4) + number("d6", d6),
            0, 0, a2, a3, d3, d4, d6);
}

void three21(ModuleImport& m) {
  const double a1 = m.length("A1", 64.2), a2 = m.length("A2", 305), a3 = m.length("A3", 0),
               d1 = m.length("D1", 169.77), d2 = m.length("D2", 0), d3 = m.length("D3", -6.25),
               d4 = m.length("D4", 223.63), d6 = m.length("D6", 36.5);
  elbow_arm(m,
            "type = \"three21\"\n" + number("a1", a1) + number("a2", a2) + number("a3", a3) +
                number("d1", d1) + number("d2", d2) + number("d3", d3) + number("d4", d4) +
                number("d6", d6),
            a1, d1, a2, a3, d2 + d3, d4, d6);
}

// Six modified Denavit-Hartenberg rows; their couples at zero are the frames behind Rx(α)·Tx(a).
void general_arm(ModuleImport& m) {
  constexpr int count = 6;
  if (!enough_joints(m, count)) return;
  upright_tools_only(m);
  std::string rows;
  std::vector<Hinge> all;
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  for (int i = 0; i < count; ++i) {
    const std::string n = "-" + std::to_string(i);
    const double a = m.length("A" + n, {}), d = m.length("D" + n, {});
    const double alpha = m.plain("ALPHA" + n, {});  // rad
    if (m.plain("unrotate" + n, 0) != 0)
      m.error("unrotate" + n + " couples the joints of the arm, which is not modelled");
    rows += (i ? ", [0, " : "[0, ") + shortest(d) + ", " + shortest(a) + ", " +
            shortest(alpha * 180 / std::numbers::pi) + "]";
    X = X * Eigen::AngleAxisd(alpha, Vector3d::UnitX()) * Eigen::Translation3d(a, 0, 0);
    all.push_back({X.translation(), X.linear().col(2).normalized()});
    X = X * Eigen::Translation3d(0, 0, d);
  }
  // The tool points out of the flange: along its z axis, which is −z of the tool.
  const Matrix3d tool = X.linear() * Eigen::AngleAxisd(std::numbers::pi, Vector3d::UnitX());
  hinges(
      m, all,
      {.kinematics = "type = \"serial\"\nconvention = \"modified\"\nangles = \"flange\"\ndh = [" +
                     rows + "]\n",
       .gauge = X.translation(),
       .spindle_angles = fixed_angles(tool)});
}

void scara(ModuleImport& m) {
  if (!enough_joints(m, 4)) return;
  const double d1 = m.length("D1", 490), l1 = m.length("D2", 340), d3 = m.length("D3", 50),
               l2 = m.length("D4", 250), d5 = m.length("D5", 50), d6 = m.length("D6", 50);
  Couple inner = m.couple(0, true, Vector3d::UnitZ());
  Couple outer = m.couple(1, true, Vector3d::UnitZ(), "J0");
  outer.origin = {l1, 0, 0};
  Couple flange = m.couple(3, true, Vector3d::UnitZ(), "J2");
  flange.origin = {l1 + l2, 0, 0};
  m.text().add(inner);
  m.text().add(outer);
  m.text().add(m.couple(2, false, -Vector3d::UnitZ(), "J1"));
  m.text().add(flange);
  m.text().drive({.kinematics = "type = \"scara\"\n" + number("d1", d1) + number("l1", l1) +
                                number("d3", d3) + number("l2", l2) + number("d5", d5) +
                                number("d6", d6),
                  .spindle = "J3",
                  .gauge = {l1 + l2 + d6, 0, d1 + d3 - d5}});
  m.unchecked(
      "the control puts the elbow on the side that joint 1 below or above 90 degrees "
      "gives; here it stays where it is");
  m.leave_out_from(4);
}

void scorbot(ModuleImport& m) {
  if (!enough_joints(m, 5)) return;
  for (int joint = 0; joint < 5; ++joint) m.text().add(m.couple(joint, true, Vector3d::UnitZ()));
  DriveText drive;
  drive.kinematics = "type = \"scorbot\"\n";
  drive.spindle = m.text().platform("");
  m.text().drive(drive);
  m.undrawn("the tilt of the wrist: X Y Z are those of its centre");
  m.leave_out_from(5);
}

constexpr std::string_view hexapod_outputs =
    " last-iterations max-iterations max-error convergence-criterion limit-iterations "
    "fwd-kins-fail x y z a b c correction.0 correction.1 correction.2 correction.3 correction.4 "
    "correction.5 ";
constexpr std::string_view iterations = " last-iterations max-iterations ";
constexpr std::string_view rose_outputs = " revolutions theta_degrees bigtheta_degrees ";

constexpr std::array<ModuleRow, 13> rows = {{{"lineardeltakins", linear_delta, true},
                                             {"rotarydeltakins", rotary_delta, true},
                                             {"tripodkins", tripod, true},
                                             {"corexykins", corexy},
                                             {"matrixkins", matrix, true},
                                             {"rosekins", rose, false, rose_outputs},
                                             {"genhexkins", hexapod, true, hexapod_outputs},
                                             {"pentakins", pentapod, true, hexapod_outputs},
                                             {"pumakins", puma, true},
                                             {"three21kins", three21, true},
                                             {"genserkins", general_arm, true, iterations},
                                             {"scarakins", scara, true},
                                             {"scorbot-kins", scorbot}}};

}  // namespace

std::span<const ModuleRow> other_modules() { return rows; }

}  // namespace aircut::linuxcnc
