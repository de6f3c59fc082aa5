// Usual machines with three linear and one or two rotary axes, as parameters of a chain (chain.h):
// what would otherwise be said by [[axis]] tables alone. X Y Z are on the tool's side.
//
//   four-axis            a table about A, B or C
//   table-ac, -bc, -ab   two tables: the second one (the last letter) is on the first one and
//   carries
//                        the work
//   head-ab, -ca, -cb    two axes of a head, the first one carries the second one
//   head-a-table-c, head-b-table-c
//
// Axes at an angle (nutating heads and tables) are given by `direction1`, `direction2`.
// Points are given in M with all joints at zero, where the tool points along −Z.
#include "machine/kinematics/chain.h"
#include "machine/kinematics/parameters.h"

namespace aircut::machine {

namespace {

struct Preset {
  std::string_view type;
  std::string_view tables;  ///< from the bed to the work
  std::string_view heads;   ///< from the bed to the spindle
};

constexpr std::array<Preset, 8> presets = {{{"table-ac", "AC", ""},
                                            {"table-bc", "BC", ""},
                                            {"table-ab", "AB", ""},
                                            {"head-ab", "", "AB"},
                                            {"head-ca", "", "CA"},
                                            {"head-cb", "", "CB"},
                                            {"head-a-table-c", "C", "A"},
                                            {"head-b-table-c", "C", "B"}}};

Vec3 axis_of(char letter) { return Vec3::Unit(letter - 'A'); }

// The rotary axes of a preset in the order of the joints: tables first.
std::shared_ptr<const Kinematics> read_preset(KinematicsInput& input, std::string_view type,
                                              const std::string& tables, const std::string& heads) {
  Parameters p(input);
  const std::string letters = tables + heads;
  p.joints("TTT" + std::string(letters.size(), 'R'));
  ChainGeometry g;
  g.type = type;
  g.gauge = p.point("gauge", Vec3::Zero());
  const double pivot = heads.empty() ? 0 : p.length("pivot", 200);
  for (int i = 0; i < 3; ++i)
    g.tool.push_back({JointKind::linear, Vec3::Zero(), Vec3::Unit(i), 1, i});
  g.words = {Axis::x, Axis::y, Axis::z};
  for (std::size_t i = 0; i < letters.size(); ++i) {
    const bool table = i < tables.size();
    const std::string number = std::to_string(i + 1);
    const Vec3 at =
        p.point("point" + number, table ? Vec3::Zero() : Vec3(g.gauge + Vec3(0, 0, pivot)));
    const Vec3 direction = p.direction("direction" + number, axis_of(letters[i]));
    const ChainCouple couple{JointKind::rotary, at, direction, table ? -1.0 : 1.0,
                             static_cast<int>(3 + i)};
    (table ? g.work : g.tool).push_back(couple);
    g.words.push_back(*axis_of_letter(letters[i]));
  }
  for (std::size_t i = 0; i < input.driven.size() && p.good(); ++i)
    if (input.driven[i].name != std::string(1, letter(g.words[i])))
      p.fail(
          "type", "'" + std::string(type) + "' needs driven axes named X, Y, Z" +
                      [&] {
                        std::string names;
                        for (const char c : letters) names += std::string(", ") + c;
                        return names;
                      }() +
                      " in this order; axis " + std::to_string(i + 1) + " is '" +
                      input.driven[i].name + "'");
  if (!p.good()) return nullptr;
  std::string reason;
  auto chain = make_chain(g, reason);
  if (!chain) p.fail("type", reason);
  return chain;
}

}  // namespace

std::shared_ptr<const Kinematics> read_four_axis(KinematicsInput& input) {
  Parameters p(input);
  const std::string axis = p.choice("axis", {"A", "B", "C"});
  return read_preset(input, "four-axis", axis, "");
}

std::string four_axis_joints(config::Table& table) {
  return "X Y Z " + table.text("axis", "A") + "*";
}

template <std::size_t row>
std::shared_ptr<const Kinematics> read_preset_row(KinematicsInput& input) {
  const Preset& preset = presets[row];
  return read_preset(input, preset.type, std::string(preset.tables), std::string(preset.heads));
}

std::span<const KinematicsRow> preset_rows() {
  static constexpr std::array<KinematicsRow, 9> rows = {{
      {"four-axis", read_four_axis, true, "X Y Z A*", four_axis_joints},
      {presets[0].type, read_preset_row<0>, true, "X Y Z A* C*", nullptr},
      {presets[1].type, read_preset_row<1>, true, "X Y Z B* C*", nullptr},
      {presets[2].type, read_preset_row<2>, true, "X Y Z A* B*", nullptr},
      {presets[3].type, read_preset_row<3>, true, "X Y Z A* B*", nullptr},
      {presets[4].type, read_preset_row<4>, true, "X Y Z C* A*", nullptr},
      {presets[5].type, read_preset_row<5>, true, "X Y Z C* B*", nullptr},
      {presets[6].type, read_preset_row<6>, true, "X Y Z C* A*", nullptr},
      {presets[7].type, read_preset_row<7>, true, "X Y Z C* B*", nullptr},
  }};
  return rows;
}

}  // namespace aircut::machine
