// Modules whose joints stand one on the other and in which each joint has the letter of an axis.
// Signs and origins are those of the modules, which are not always those of ISO 841:
//
//   trivkins, gantrykins, gentrivkins   joints are axes; a letter twice is a gantry
//   rotatekins        (qx, qy) = Rz(C) (x, y)
//   xyzac-trt, xyzbc-trt   tilting table A or B about r + d, on it the table C about r:
//                     p = r + Rz(−C)·(d + Rx(−A)·(q − r − d))
//   xyzab_tdr         table B about r, on it the table A about r + d:
//                     p = r + d + Rx(A)·(Ry(B)·(q − r) − d)
//   maxkins           table C, head B that tilts the other way, pivot length P
//   5axiskins         head C, on it B that tilts the other way, pivot length P
//   millturn          X Y Z A, or on the turning side (x, y, z) = (q2, −q1, q0)
//
// with p the tip on the work and q the linear joints less the tool's length. Modules that can be
// switched have a channel for each model, in the order of motion.switchkins-type.
#include <algorithm>
#include <array>

#include "linuxcnc/module_import.h"

namespace aircut::linuxcnc {
namespace {

using Eigen::Vector3d;
using package::Couple;
using package::DriveText;

bool rotary(char letter) { return letter >= 'A' && letter <= 'C'; }
bool linear(char letter) { return letter >= 'X' && letter <= 'Z'; }

// X carries Y, and Y carries Z.
std::string carrier(char letter, const std::string& letters) {
  for (char c = letter; c-- > 'X';)
    if (letters.find(c) != std::string::npos) return std::string(1, c);
  return "bed";
}

std::string last_linear(const std::string& letters) {
  for (const char c : {'Z', 'Y', 'X'})
    if (letters.find(c) != std::string::npos) return std::string(1, c);
  return "bed";
}

Vector3d direction_of(char letter) {
  return Vector3d::Unit(rotary(letter)   ? letter - 'A'
                        : linear(letter) ? letter - 'X'
                                         : letter - 'U');
}

std::string identity(const std::string& letters) {
  return "type = \"identity\"\ncoordinates = \"" + letters + "\"\n";
}

// Nothing when there are fewer joints than letters.
bool enough_joints(ModuleImport& m, const std::string& letters) {
  if (static_cast<int>(letters.size()) <= m.joints()) return true;
  m.error("coordinates " + letters + " need " + std::to_string(letters.size()) +
          " joints, [KINS]JOINTS says " + std::to_string(m.joints()));
  return false;
}

void trivial(ModuleImport& m) {
  std::string letters = m.letters("");
  if (letters.empty())
    letters = std::string("XYZABCUVW").substr(0, static_cast<std::size_t>(std::min(m.joints(), 9)));
  if (!enough_joints(m, letters)) return;
  bool twice = false;
  DriveText drive;
  for (std::size_t i = 0; i < letters.size(); ++i) {
    const char c = letters[i];
    const auto before = std::count(letters.begin(), letters.begin() + static_cast<long>(i), c);
    Couple couple;
    couple.name = std::string(1, c) + (before > 0 ? std::to_string(before + 1) : "");
    couple.rotary = rotary(c);
    couple.direction = direction_of(c);
    couple.parent = linear(c) && before == 0 ? carrier(c, letters) : "bed";
    couple.limits = m.limits(static_cast<int>(i), couple.rotary, c);
    twice = twice || before > 0;
    m.text().add(couple);
  }
  drive.kinematics = identity(letters) + (twice ? "skew_max = 1.0\n" : "");
  drive.spindle = last_linear(letters);
  m.text().drive(drive);
  m.axes_are_joints();
  if (std::any_of(letters.begin(), letters.end(), rotary))
    m.undrawn(
        "where the rotary axes turn, and whether work or tool: a set-up with trivkins does "
        "not say it");
  m.leave_out_from(static_cast<int>(letters.size()));
}

struct Turn {
  char letter;
  bool table;
  Vector3d origin;
  double sense;
};

// X Y Z on the tool's side and rotary axes, tables and heads each from the bed outwards. With
// `switchable` the second model has the rotary axes alone.
void five_axes(ModuleImport& m, const std::string& letters, const std::vector<Turn>& turns,
               bool switchable, bool identity_first) {
  if (!enough_joints(m, letters)) return;
  std::string kept, refused, table = "bed", head = "Z";
  std::vector<std::pair<char, std::string>> parents;
  for (const Turn& turn : turns) {
    std::string& last = turn.table ? table : head;
    parents.emplace_back(turn.letter, last);
    last = std::string(1, turn.letter);
  }
  std::vector<int> left_out;
  DriveText drive;
  for (std::size_t i = 0; i < letters.size(); ++i) {
    const char c = letters[i];
    const int joint = static_cast<int>(i);
    const auto turn =
        std::find_if(turns.begin(), turns.end(), [&](const Turn& t) { return t.letter == c; });
    const bool again = kept.find(c) != std::string::npos;
    if (again || (!linear(c) && turn == turns.end())) {
      left_out.push_back(joint);
      if (!again) refused += c;
      continue;
    }
    kept += c;
    Couple couple;
    couple.name = std::string(1, c);
    couple.direction = direction_of(c);
    if (turn == turns.end()) {
      couple.parent = carrier(c, "XYZ");
      couple.limits = m.limits(joint, false);
    } else {
      couple.rotary = true;
      couple.parent = parents[static_cast<std::size_t>(turn - turns.begin())].second;
      couple.origin = turn->origin;
      couple.sense = turn->sense;
      couple.limits = m.limits(joint, true, c);
    }
    m.text().add(couple);
    drive.axes.push_back(couple.name);
  }
  for (const char c : std::string("XYZ"))
    if (kept.find(c) == std::string::npos) return m.error("coordinates= must have X, Y and Z");
  for (const Turn& t : turns)
    if (kept.find(t.letter) == std::string::npos)
      return m.error(std::string("coordinates= must have ") + t.letter);
  for (int joint = static_cast<int>(letters.size()); joint < m.joints(); ++joint)
    left_out.push_back(joint);
  m.leave_out(left_out, refused);
  drive.name = "tcp";
  drive.kinematics = "type = \"chain\"\n";
  drive.work = table;
  drive.spindle = head;
  DriveText plain = drive;
  plain.name = "joints";
  plain.kinematics = identity(kept);
  plain.work = "bed";
  if (switchable && identity_first) m.text().drive(plain);
  m.text().drive(drive);
  if (switchable && !identity_first) m.text().drive(plain);
}

void needs_tool_length(ModuleImport& m, const std::string& pin) {
  if (!m.gets_tool_length(pin))
    m.unchecked(pin +
                " does not get motion.tooloffset.z, so the control turns about another point "
                "when a tool has a length; here the tip is followed");
}

void tilting_table(ModuleImport& m, char tilt) {
  const Vector3d r(m.length("x-rot-point", 0), m.length("y-rot-point", 0),
                   m.length("z-rot-point", 0));
  const char* side = tilt == 'A' ? "y-offset" : "x-offset";
  Vector3d d(0, 0, m.length("z-offset", 0));
  d[tilt == 'A' ? 1 : 0] = m.length(side, 0);
  needs_tool_length(m, "tool-offset");
  five_axes(m, m.letters(tilt == 'A' ? "XYZAC" : "XYZBC"),
            {{tilt, true, r + d, 1}, {'C', true, r, 1}}, true, m.identity_first());
}

void xyzab_tdr(ModuleImport& m) {
  const Vector3d r(m.length("x-rot-point", 0), m.length("y-rot-point", 0),
                   m.length("z-rot-point", 0));
  const Vector3d d(0, 0, m.length("z-offset", 0));
  needs_tool_length(m, "tool-offset-z");
  five_axes(m, m.letters("XYZAB"), {{'B', true, r, -1}, {'A', true, r + d, -1}}, true, true);
}

double pivot(ModuleImport& m, double usual) {
  const double length = m.length("pivot-length", usual);
  needs_tool_length(m, "pivot-length");
  return length;
}

void maxkins(ModuleImport& m) {
  const Vector3d p(0, 0, pivot(m, 0.666));
  const auto count = static_cast<std::size_t>(std::min(m.joints(), 9));
  five_axes(m, std::string("XYZABCUVW").substr(0, count),
            {{'C', true, Vector3d::Zero(), -1}, {'B', false, p, -1}}, false, false);
}

void bridge_mill(ModuleImport& m) {
  const Vector3d p(0, 0, pivot(m, 250));
  five_axes(m, m.letters("XYZBCW"), {{'C', false, p, 1}, {'B', false, p, -1}}, true,
            m.identity_first());
}

void rotatekins(ModuleImport& m) {
  const std::string letters =
      std::string("XYZABCUVW").substr(0, static_cast<std::size_t>(std::min(m.joints(), 9)));
  if (letters.size() < 6) return m.error("it needs at least 6 joints (X Y Z A B C)");
  for (const int joint : {0, 1, 2, 5}) {
    const char c = letters[static_cast<std::size_t>(joint)];
    Couple couple;
    couple.name = std::string(1, c);
    couple.rotary = rotary(c);
    couple.direction = direction_of(c);
    couple.parent = rotary(c) ? "bed" : carrier(c, "XYZ");
    couple.limits = m.limits(joint, couple.rotary, rotary(c) ? c : '\0');
    m.text().add(couple);
  }
  m.text().drive({.kinematics = "type = \"rotated-xy\"\n", .work = "C", .spindle = "Z"});
  std::vector<int> rest = {3, 4};
  for (int joint = 6; joint < m.joints(); ++joint) rest.push_back(joint);
  m.leave_out(rest);
}

void millturn(ModuleImport& m) {
  if (!enough_joints(m, "XYZA")) return;
  const std::string letters = "XYZA";
  DriveText mill;
  for (std::size_t i = 0; i < letters.size(); ++i) {
    const char c = letters[i];
    Couple couple;
    couple.name = std::string(1, c);
    couple.rotary = rotary(c);
    couple.direction = direction_of(c);
    couple.parent = rotary(c) ? "bed" : carrier(c, letters);
    couple.limits = m.limits(static_cast<int>(i), couple.rotary);
    m.text().add(couple);
    mill.axes.push_back(couple.name);
  }
  mill.name = "mill";
  mill.kinematics = identity(letters);
  mill.spindle = "Z";
  DriveText turn = mill;
  turn.name = "turn";
  turn.axes = {"X", "Y", "Z"};
  turn.kinematics = "type = \"calibrated\"\nmatrix = [0, 0, 1, 0, -1, 0, 1, 0, 0]\n";
  turn.work_angles = {180, -90, 0};
  m.text().drive(mill);
  m.text().drive(turn);
  m.undrawn("where the axis A turns: the set-up does not say it");
  m.leave_out_from(4);
}

constexpr std::string_view no_effect = " x-offset ";

constexpr std::array<ModuleRow, 10> rows = {
    {{"trivkins", trivial},
     {"gantrykins", trivial},
     {"gentrivkins", trivial},
     {"rotatekins", rotatekins},
     {"xyzac-trt-kins", [](ModuleImport& m) { tilting_table(m, 'A'); }, true},
     {"xyzbc-trt-kins", [](ModuleImport& m) { tilting_table(m, 'B'); }, true},
     {"xyzab_tdr_kins", xyzab_tdr, true, no_effect},
     {"maxkins", maxkins, true},
     {"5axiskins", bridge_mill, true},
     {"millturn", millturn}}};

}  // namespace

std::span<const ModuleRow> serial_modules() { return rows; }

}  // namespace aircut::linuxcnc
