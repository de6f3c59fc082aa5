// Arguments, in this order: _INEXIN _MIHEAD _SW_REC _BIN_IN _POS_X _POS_Y _POS_Z _ANG_1 _ANG_2
// _ANG_3 _POS_X_R _POS_Y_R _POS_Z_R _INEXOUT _BIN_OUT _ROT_AD _ROT_INV _RETR_Z (kinematics.md d.4).
// _MIHEAD is a name, in quotes or not; all others are numbers.
#include "machine/rotation/cycle600.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace aircut::machine {

namespace {

constexpr std::array<const char*, 18> names = {
    "_INEXIN",  "_MIHEAD",  "_SW_REC",  "_BIN_IN", "_POS_X",   "_POS_Y",
    "_POS_Z",   "_ANG_1",   "_ANG_2",   "_ANG_3",  "_POS_X_R", "_POS_Y_R",
    "_POS_Z_R", "_INEXOUT", "_BIN_OUT", "_ROT_AD", "_ROT_INV", "_RETR_Z"};
constexpr std::size_t head_at = 1;

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string_view> split(std::string_view text) {
  std::vector<std::string_view> parts;
  for (std::size_t comma = text.find(','); comma != text.npos; comma = text.find(',')) {
    parts.push_back(trimmed(text.substr(0, comma)));
    text.remove_prefix(comma + 1);
  }
  parts.push_back(trimmed(text));
  return parts;
}

}  // namespace

tl::expected<Cycle600, std::string> read_cycle600(std::string_view text) {
  text = trimmed(text);
  if (text.starts_with("CYCLE600")) {
    text = trimmed(text.substr(8));
    if (!text.starts_with('(') || !text.ends_with(')'))
      return unexpected(std::string("CYCLE600 needs its arguments in parentheses"));
    text = text.substr(1, text.size() - 2);
  }
  const auto parts = split(text);
  if (parts.size() != names.size())
    return unexpected("CYCLE600 has 18 arguments, from _INEXIN to _RETR_Z; this call has " +
                      std::to_string(parts.size()));
  std::array<double, names.size()> v{};
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (i == head_at) continue;
    const auto value = parse_number(parts[i]);
    if (!value)
      return unexpected("argument " + std::to_string(i + 1) + ", " + names[i] +
                        ", needs a number, this is '" + printable(parts[i]) + "'");
    v[i] = *value;
  }
  for (const std::size_t i : {0u, 2u, 13u, 15u, 16u, 17u})
    if (v[i] != 0 && v[i] != 1)
      return unexpected("argument " + std::to_string(i + 1) + ", " + names[i] +
                        ", is 0 or 1, this is " + shortest(v[i]));
  Cycle600 call;
  std::string_view head = parts[head_at];
  if (head.size() >= 2 && head.starts_with('"') && head.ends_with('"'))
    head = head.substr(1, head.size() - 2);
  if (head.empty()) return unexpected(std::string("argument 2, _MIHEAD, needs the head's name"));
  call.head = head;
  const auto in = convention_of_bin(v[3], v[0] == 1);
  if (!in) return unexpected("_BIN_IN: " + in.error());
  const auto out = convention_of_bin(v[14], v[13] == 1);
  if (!out) return unexpected("_BIN_OUT: " + out.error());
  constexpr double deg = std::numbers::pi / 180;
  call.step = {{v[4], v[5], v[6]}, Vec3(v[7], v[8], v[9]) * deg, {v[10], v[11], v[12]}, *in};
  call.out = *out;
  call.only_compute = v[2] == 1;
  call.additive = v[15] == 1;
  call.inverse = v[16] == 1;
  call.retract = v[17] == 1;
  return call;
}

Cycle600Result run(const Cycle600& call, const Pose& previous) {
  Cycle600Result result;
  result.frame = call.additive ? added(previous, call.step) : frame_of(call.step);
  result.angles = angles_of(call.out, result.frame.linear());
  if (call.inverse) result.angles.angles = other_angles(result.angles.angles);
  return result;
}

}  // namespace aircut::machine
