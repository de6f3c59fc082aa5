// One JSON object per command, for `trace --format jsonl`. Keys carry their units; numbers are the
// shortest text that reads back to the same double.
#include <array>
#include <cmath>

#include "canon/canon.h"
#include "canon/words.h"

namespace aircut::canon {
namespace {

/// The fields of one object, in the order they are added.
class Object {
 public:
  void number(std::string_view key, double value) {
    name(key);
    // JSON has no inf and nan; the interpreter yields none, and null is not a number to trust.
    if (std::isfinite(value))
      append_shortest(out_, value);
    else
      out_ += "null";
  }
  void integer(std::string_view key, long long value) {
    name(key);
    out_ += std::to_string(value);
  }
  void boolean(std::string_view key, bool value) {
    name(key);
    out_ += value ? "true" : "false";
  }
  void text(std::string_view key, std::string_view value) {
    name(key);
    quote(value);
  }
  void raw(std::string_view key, const std::string& json) {
    name(key);
    out_ += json;
  }
  void axes(const AxisValues& values) {
    static constexpr std::array<const char*, 9> keys = {"x_mm",  "y_mm", "z_mm", "a_deg", "b_deg",
                                                        "c_deg", "u_mm", "v_mm", "w_mm"};
    for (const Axis axis : all_axes)
      if (index(axis) <= index(Axis::z) || values[axis] != 0)
        number(keys[index(axis)], shown(axis, values[axis]));
  }
  std::string take() { return out_ + '}'; }

 private:
  void name(std::string_view key) {
    out_ += out_.size() == 1 ? "" : ",";
    quote(key);
    out_ += ':';
  }
  /// Bytes that are not UTF-8 become U+FFFD, one per byte: JSON must be valid for any program text.
  void quote(std::string_view text) {
    static constexpr char hex[] = "0123456789abcdef";
    out_ += '"';
    for (std::size_t i = 0; i < text.size();) {
      const auto byte = static_cast<unsigned char>(text[i]);
      if (byte == '"' || byte == '\\') {
        out_ += '\\';
        out_ += text[i++];
      } else if (byte < 0x20 || byte == 0x7f) {
        out_ += "\\u00";
        out_ += hex[byte >> 4];
        out_ += hex[byte & 15];
        ++i;
      } else if (const std::size_t width = character_width(text.substr(i)); width > 0) {
        out_ += text.substr(i, width);
        i += width;
      } else {
        out_ += "\\ufffd";
        ++i;
      }
    }
    out_ += '"';
  }
  /// Bytes of the UTF-8 character that `text` begins with; 0 when it is none (RFC 3629 table 3-7).
  static std::size_t character_width(std::string_view text) {
    const auto at = [&](std::size_t i) {
      return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u;
    };
    const auto follows = [&](std::size_t i) { return (at(i) & 0xc0) == 0x80; };
    const unsigned first = at(0);
    if (first < 0x80) return 1;
    if (first >= 0xc2 && first <= 0xdf) return follows(1) ? 2 : 0;
    if (first >= 0xe0 && first <= 0xef) {
      const bool overlong = first == 0xe0 && at(1) < 0xa0;
      const bool surrogate = first == 0xed && at(1) > 0x9f;
      return follows(1) && follows(2) && !overlong && !surrogate ? 3 : 0;
    }
    if (first >= 0xf0 && first <= 0xf4) {
      const bool overlong = first == 0xf0 && at(1) < 0x90;
      const bool beyond = first == 0xf4 && at(1) > 0x8f;
      return follows(1) && follows(2) && follows(3) && !overlong && !beyond ? 4 : 0;
    }
    return 0;
  }

  std::string out_ = "{";
};

std::string numbers(std::initializer_list<double> values) {
  std::string out = "[";
  for (const double value : values) {
    if (out.size() > 1) out += ',';
    append_shortest(out, value);
  }
  return out + ']';
}

/// Fields of each action after "do", which is the action's name.
struct Fields {
  Object& o;

  void operator()(const Rapid& c) const { motion("rapid", c.end); }
  void operator()(const LinearFeed& c) const { motion("feed", c.end); }
  void operator()(const ArcFeed& c) const {
    motion("arc", c.end);
    o.raw("centre_mm", numbers({c.centre.x(), c.centre.y(), c.centre.z()}));
    o.raw("normal", numbers({c.normal.x(), c.normal.y(), c.normal.z()}));
    o.integer("turns", c.turns);
    o.text("plane", word(c.plane, plane_words));
  }
  void operator()(const SplineFeed& c) const {
    name("spline");
    o.integer("order", c.order);
    std::string points = "[";
    for (const auto& p : c.points) {
      if (points.size() > 1) points += ',';
      points += numbers({p.x, p.y, p.weight});
    }
    o.raw("points_x_mm_y_mm_weight", points + ']');
  }
  void operator()(const Dwell& c) const {
    name("dwell");
    o.number("time_s", c.seconds);
  }
  void operator()(const SyncFeed& c) const {
    motion(c.rigid_tap ? "tap" : "thread", c.end);
    o.number("pitch_mm_per_rev", c.per_revolution);
    if (c.rigid_tap) o.number("return_factor", c.return_factor);
    o.integer("spindle", c.spindle);
  }
  void operator()(const Probe& c) const {
    motion("probe", c.end);
    o.boolean("away", c.away);
    o.boolean("error_if_missed", c.error_if_missed);
  }
  void operator()(const SetFeedMode& c) const {
    name("feed_mode");
    o.text("mode", word(c.mode, feed_mode_words));
  }
  // A rotary reading exists in per_minute mode only; without it the feed mode in force decides.
  void operator()(const SetFeedRate& c) const {
    name("feed_rate");
    o.number(c.rotary == 0 ? "value_per_s_or_mm_per_rev" : "value_mm_per_s", c.value);
    if (c.rotary != 0) o.number("rotary_deg_per_s", c.rotary * degrees_per_radian);
  }
  void operator()(const SelectPlane& c) const {
    name("plane");
    o.text("plane", word(c.plane, plane_words));
  }
  void operator()(const UseUnit& c) const {
    name("unit");
    o.text("unit", word(c.unit, unit_words));
  }
  void operator()(const WorkOffset& c) const {
    name("work_offset");
    o.integer("system", c.system);
    o.axes(c.offset);
  }
  void operator()(const WorkRotation& c) const {
    name("work_rotation");
    o.number("angle_deg", c.angle * degrees_per_radian);
  }
  void operator()(const G92Offset& c) const { motion("g92_offset", c.offset); }
  void operator()(const ProgramMap& c) const {
    name("program_map");
    std::string rows;
    for (int row = 0; row < 3; ++row)
      rows +=
          (row == 0 ? "[" : ",") + numbers({c.linear(row, 0), c.linear(row, 1), c.linear(row, 2)});
    o.raw("linear", rows + "]");
    o.raw("shift_mm", numbers({c.shift.x(), c.shift.y(), c.shift.z()}));
  }
  void operator()(const ToolLengthOffset& c) const {
    motion("tool_offset", c.offset);
    if (c.tool != 0) o.integer("tool", c.tool);
  }
  void operator()(const SetPathMode& c) const {
    name("path");
    o.text("mode", word(c.mode, path_words));
    if (c.mode == PathMode::continuous) o.number("tolerance_mm", c.tolerance);
  }
  void operator()(const SetNaiveCam& c) const {
    name("naive_cam");
    o.number("tolerance_mm", c.tolerance);
  }
  void operator()(const SetSpindleMode& c) const {
    name("spindle_mode");
    o.text("mode", c.css_max_rpm == 0 ? "rpm" : "surface_speed");
    if (has_limit(c)) o.number("max_rpm", c.css_max_rpm);
    o.integer("spindle", c.spindle);
  }
  void operator()(const SetSpindleSpeed& c) const {
    name("spindle_speed");
    o.number("value_rpm_or_m_per_min", c.value);
    o.integer("spindle", c.spindle);
  }
  void operator()(const TurnSpindle& c) const {
    name("spindle");
    o.text("turn", word(c.turn, turn_words));
    o.boolean("wait_for_speed", c.wait_for_speed);
    o.integer("spindle", c.spindle);
  }
  void operator()(const OrientSpindle& c) const {
    name("orient");
    o.number("angle_deg", c.angle * degrees_per_radian);
    o.integer("direction", c.direction);
    o.integer("spindle", c.spindle);
  }
  void operator()(const SelectTool& c) const { tool("select_tool", c.number); }
  void operator()(const ChangeTool& c) const { tool("change_tool", c.number); }
  void operator()(const SetToolNumber& c) const { tool("tool_number", c.number); }
  void operator()(const Coolant& c) const {
    name("coolant");
    o.text("kind", word(c.kind, coolant_words));
    o.boolean("on", c.on);
  }
  void operator()(const Override& c) const {
    name("override");
    o.text("kind", word(c.kind, override_words));
    o.boolean("enabled", c.enabled);
    o.integer("spindle", c.spindle);
  }
  void operator()(const DigitalOutput& c) const {
    name("digital_output");
    o.integer("index", c.index);
    o.boolean("on", c.on);
    o.boolean("with_motion", c.with_motion);
  }
  void operator()(const AnalogOutput& c) const {
    name("analog_output");
    o.integer("index", c.index);
    o.number("value", c.value);
    o.boolean("with_motion", c.with_motion);
  }
  void operator()(const SwitchKinematics& c) const {
    name("switch_kinematics");
    o.integer("model", c.model);
    o.boolean("with_motion", c.with_motion);
  }
  void operator()(const WaitInput& c) const {
    name("wait_input");
    o.integer("index", c.index);
    o.boolean("analog", c.analog);
    o.integer("mode", c.mode);
    o.number("timeout_s", c.timeout);
  }
  void operator()(const UserCode& c) const {
    name("user_code");
    if (c.letter != 'M') o.text("letter", std::string(1, c.letter));
    if (c.remap.empty())
      o.integer("code", c.code);
    else
      o.text("remap", c.remap);
    if (c.has_p) o.number("p", c.p);
    if (c.has_q) o.number("q", c.q);
  }
  void operator()(const ProgramStop& c) const {
    name("stop");
    o.boolean("optional", c.optional);
  }
  void operator()(const PalletChange&) const { name("pallet_change"); }
  void operator()(const ProgramEnd& c) const {
    name("end");
    o.boolean("pallet", c.pallet);
  }
  void operator()(const Message& c) const {
    name(word(c.kind, message_words));
    o.text("text", c.text);
  }
  void operator()(const LogFile& c) const {
    name(word(c.kind, log_words));
    o.text("text", c.text);
  }

 private:
  void name(const char* action) const { o.text("do", action); }
  void motion(const char* action, const AxisValues& values) const {
    name(action);
    o.axes(values);
  }
  void tool(const char* action, int number) const {
    name(action);
    o.integer("tool", number);
  }
};

}  // namespace

std::string to_json(const Command& command) {
  Object object;
  std::visit(Fields{object}, command.action);
  if (command.span) {
    object.text("file", command.span.text->name());
    object.integer("line", static_cast<long long>(command.span.line));
  }
  object.integer("block", static_cast<long long>(command.block));
  if (!command.expanded.empty()) object.text("expanded", command.expanded);
  return object.take();
}

}  // namespace aircut::canon
