// One line per command, for people, golden files and tests. The form is listed in docs/canon.md.
#include <cmath>
#include <cstdlib>

#include "canon/canon.h"
#include "canon/words.h"

namespace aircut::canon {
namespace {

/// ` X1 Y2 Z3`, and the other axes that are not zero.
std::string axes(const AxisValues& values) {
  std::string out;
  for (const Axis axis : all_axes) {
    const std::string number = tidy(shown(axis, values[axis]));
    if (index(axis) > index(Axis::z) && number == "0") continue;
    out += ' ';
    out += letter(axis);
    out += number;
  }
  return out;
}

/// ` $1` for another spindle than the first.
std::string spindle_text(int spindle) { return spindle == 0 ? "" : " $" + std::to_string(spindle); }

std::string on_off(bool on) { return on ? " on" : " off"; }
std::string with_motion_text(bool with_motion) { return with_motion ? " with_motion" : ""; }

/// The centre without its coordinate along the normal, which does not matter; all three and the
/// normal when the circle's plane is not a main one (work rotation).
std::string centre(const ArcFeed& arc) {
  std::string out = " centre";
  int along = -1;
  for (int i = 0; i < 3; ++i)
    if (std::abs(std::abs(arc.normal[i]) - 1) < 1e-12) along = i;
  for (int i = 0; i < 3; ++i) {
    if (i == along) continue;
    out += ' ';
    out += "XYZ"[i];
    out += tidy(arc.centre[i]);
  }
  if (along >= 0 && arc.normal[along] > 0) return out;
  out += " normal";
  for (int i = 0; i < 3; ++i) out += ' ' + tidy(arc.normal[i]);
  return out;
}

struct ToText {
  std::string operator()(const Rapid& c) const { return "rapid" + axes(c.end); }
  std::string operator()(const LinearFeed& c) const { return "feed" + axes(c.end); }
  std::string operator()(const ArcFeed& c) const {
    const int turns = std::abs(c.turns);
    return std::string("arc ") + word(c.plane, plane_words) + (c.turns > 0 ? " ccw" : " cw") +
           axes(c.end) + centre(c) + (turns > 1 ? " turns " + std::to_string(turns) : "");
  }
  std::string operator()(const SplineFeed& c) const {
    std::string out = "spline order " + std::to_string(c.order);
    for (const auto& p : c.points) {
      out += " (" + tidy(p.x) + ' ' + tidy(p.y);
      if (p.weight != 1) out += " weight " + tidy(p.weight);
      out += ')';
    }
    return out;
  }
  std::string operator()(const Dwell& c) const { return "dwell " + tidy(c.seconds); }
  std::string operator()(const SyncFeed& c) const {
    std::string out = c.rigid_tap ? "tap" : "thread";
    out += axes(c.end) + " pitch " + tidy(c.per_revolution);
    if (c.rigid_tap && c.return_factor != 1) out += " return " + tidy(c.return_factor);
    return out + spindle_text(c.spindle);
  }
  std::string operator()(const Probe& c) const {
    return std::string("probe ") + (c.away ? "away" : "toward") + axes(c.end) +
           (c.error_if_missed ? " must" : "");
  }
  std::string operator()(const SetFeedMode& c) const {
    return std::string("feed_mode ") + word(c.mode, feed_mode_words);
  }
  // A rotary reading exists in per_minute mode only, so it tells mm/s from 1/s and mm/rev, which
  // stand as they are.
  std::string operator()(const SetFeedRate& c) const {
    if (c.rotary == 0) return "feed_rate " + tidy(c.value);
    const std::string linear = tidy(c.value * seconds_per_minute);
    const std::string rotary = tidy(c.rotary * degrees_per_radian * seconds_per_minute);
    return "feed_rate " + linear + (rotary == linear ? "" : " rotary " + rotary);
  }
  std::string operator()(const SelectPlane& c) const {
    return std::string("plane ") + word(c.plane, plane_words);
  }
  std::string operator()(const UseUnit& c) const {
    return std::string("unit ") + word(c.unit, unit_words);
  }
  std::string operator()(const WorkOffset& c) const {
    return "work_offset " + std::to_string(c.system) + axes(c.offset);
  }
  std::string operator()(const WorkRotation& c) const {
    return "work_rotation " + tidy(c.angle * degrees_per_radian);
  }
  std::string operator()(const G92Offset& c) const { return "g92_offset" + axes(c.offset); }
  std::string operator()(const ProgramMap& c) const {
    if (c.linear == Mat3::Identity() && c.shift == Vec3::Zero()) return "program_map off";
    std::string out = "program_map";
    for (int row = 0; row < 3; ++row) {
      out += std::string(" ") + letter(all_axes[static_cast<std::size_t>(row)]) + " =";
      for (int column = 0; column < 3; ++column) out += ' ' + tidy(c.linear(row, column));
      out += " + " + tidy(c.shift[row]);
    }
    return out;
  }
  std::string operator()(const ToolLengthOffset& c) const { return "tool_offset" + axes(c.offset); }
  std::string operator()(const SetPathMode& c) const {
    std::string out = std::string("path ") + word(c.mode, path_words);
    if (c.mode == PathMode::continuous) out += ' ' + tidy(c.tolerance);
    return out;
  }
  std::string operator()(const SetNaiveCam& c) const { return "naive_cam " + tidy(c.tolerance); }
  std::string operator()(const SetSpindleMode& c) const {
    std::string text = c.css_max_rpm == 0 ? "spindle_mode rpm" : "spindle_mode surface_speed";
    if (has_limit(c)) text += " max " + tidy(c.css_max_rpm);
    return text + spindle_text(c.spindle);
  }
  std::string operator()(const SetSpindleSpeed& c) const {
    return "spindle_speed " + tidy(c.value) + spindle_text(c.spindle);
  }
  std::string operator()(const TurnSpindle& c) const {
    return std::string("spindle ") + word(c.turn, turn_words) + spindle_text(c.spindle);
  }
  std::string operator()(const OrientSpindle& c) const {
    return "orient " + tidy(c.angle * degrees_per_radian) + " direction " +
           std::to_string(c.direction) + spindle_text(c.spindle);
  }
  std::string operator()(const SelectTool& c) const {
    return "select_tool " + std::to_string(c.number);
  }
  std::string operator()(const ChangeTool& c) const {
    return "change_tool " + std::to_string(c.number);
  }
  std::string operator()(const SetToolNumber& c) const {
    return "tool_number " + std::to_string(c.number);
  }
  std::string operator()(const Coolant& c) const {
    return word(c.kind, coolant_words) + on_off(c.on);
  }
  std::string operator()(const Override& c) const {
    return std::string("override ") + word(c.kind, override_words) + on_off(c.enabled) +
           spindle_text(c.spindle);
  }
  std::string operator()(const DigitalOutput& c) const {
    return "digital_output " + std::to_string(c.index) + on_off(c.on) +
           with_motion_text(c.with_motion);
  }
  std::string operator()(const AnalogOutput& c) const {
    return "analog_output " + std::to_string(c.index) + ' ' + tidy(c.value) +
           with_motion_text(c.with_motion);
  }
  std::string operator()(const SwitchKinematics& c) const {
    return "switch_kinematics " + std::to_string(c.model) + with_motion_text(c.with_motion);
  }
  std::string operator()(const WaitInput& c) const {
    static constexpr const char* modes[] = {"immediate", "rise", "fall", "high", "low"};
    const bool known = c.mode >= 0 && c.mode < 5;
    return std::string("wait_input ") + (c.analog ? "analog " : "digital ") +
           std::to_string(c.index) + ' ' +
           (known ? modes[c.mode] : std::to_string(c.mode).c_str()) + " timeout " + tidy(c.timeout);
  }
  std::string operator()(const UserCode& c) const {
    std::string out =
        "user_code " + (c.remap.empty() ? c.letter + std::to_string(c.code) : c.remap + " remap");
    if (c.has_p) out += " P" + tidy(c.p);
    if (c.has_q) out += " Q" + tidy(c.q);
    return out;
  }
  std::string operator()(const ProgramStop& c) const {
    return c.optional ? "optional_stop" : "stop";
  }
  std::string operator()(const PalletChange&) const { return "pallet_change"; }
  std::string operator()(const ProgramEnd& c) const { return c.pallet ? "end pallet" : "end"; }
  std::string operator()(const Message& c) const {
    return std::string(word(c.kind, message_words)) + ' ' + printable(c.text);
  }
  std::string operator()(const LogFile& c) const {
    return c.text.empty() ? word(c.kind, log_words)
                          : std::string(word(c.kind, log_words)) + ' ' + printable(c.text);
  }
};

}  // namespace

std::string to_text(const Action& action) { return std::visit(ToText{}, action); }

}  // namespace aircut::canon
