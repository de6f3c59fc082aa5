// The stream as the reference program `rs274 -g` prints it.
//
// That program prints program coordinates in the active frame and unit, so the writer follows what
// the stream says about units, work offset, rotation and G92 and takes each point back:
//
//   p_program = R(-rotation) (p_tip - work offset) - G92        (X and Y; no rotation elsewhere)
//
// and divides lengths by the active unit. The tool length offset needs no removal, because
// canonical positions are of the tip. Three calls of the reference are not one command of ours:
//   * in inverse time mode it prints, before the moves of a block, the feed rate that they get: the
//     length of the path times the F word, at least 0.1;
//   * synchronised moves stand between START_SPEED_FEED_SYNC and STOP_SPEED_FEED_SYNCH; the moves
//   of
//     one block share a pair, so the closing line is held back until the next command is known;
//   * the six lines that it prints before the program are made from the commands of the start
//   state.
#include <algorithm>
#include <cmath>
#include <utility>

#include "canon/canon.h"
#include "canon/way.h"
#include "canon/words.h"

namespace aircut::canon {

struct Rs274Writer::State {
  // What the stream said.
  double unit_mm = 1;
  int system = 1;
  AxisValues work_offset, g92_offset, tool_offset;
  double rotation = 0;
  FeedMode feed_mode = FeedMode::per_minute;
  double moves_per_minute = 0;   // inverse time
  std::string told_rate;         // inverse time: the last line that told a rate
  std::uint64_t rate_block = 0;  // and its block
  bool surface_speed[32] = {};   // G96, by spindle
  AxisValues tip;

  // What is written.
  bool header_written = false;
  bool sync_open = false;
  double sync_pitch = 0;
  int sync_spindle = 0;
  std::uint64_t sync_block = 0;
  std::uint32_t number = 0;
  std::string n_field = "N..... ";
  std::string out;

  void line(const std::string& call) {
    std::string count = std::to_string(++number);
    if (count.size() < 5) count.insert(0, 5 - count.size(), ' ');
    out += count + ' ' + n_field + call + '\n';
  }
  double length(double mm) const { return mm / unit_mm; }
  AxisValues to_program(const AxisValues& p) const;
  std::string six(const AxisValues& p_machine) const;
  std::string lengths(const AxisValues& mm) const;
  void header();
  void open_sync(const SyncFeed& move, std::uint64_t block);
  void close_sync();
  void inverse_time_rate(Way way, std::uint64_t block);
  void arc(const ArcFeed& move, std::uint64_t block);
  void set_n_field(const SourceSpan& span);
};

namespace {

std::string four(double value) { return fixed(value, 4); }

/// The one-per-line start of a block: `/`, then N and its number.
std::string n_of(std::string_view text) {
  std::size_t i = 0;
  const auto skip = [&] {
    while (i < text.size() && (text[i] == ' ' || text[i] == '\t')) ++i;
  };
  skip();
  if (i < text.size() && text[i] == '/') ++i;
  skip();
  if (i >= text.size() || (text[i] != 'N' && text[i] != 'n')) return {};
  ++i;
  std::string digits;
  for (skip(); i < text.size() && text[i] >= '0' && text[i] <= '9'; ++i, skip()) digits += text[i];
  return digits;
}

}  // namespace

AxisValues Rs274Writer::State::to_program(const AxisValues& p) const {
  AxisValues q = p - work_offset;
  const double c = std::cos(rotation), s = std::sin(rotation);
  const double x = q[Axis::x], y = q[Axis::y];
  q[Axis::x] = c * x + s * y;
  q[Axis::y] = -s * x + c * y;
  return q - g92_offset;
}

/// `x, y, z, a, b, c` of lengths in mm and angles in rad. The reference's trace has no U V W.
std::string Rs274Writer::State::lengths(const AxisValues& values) const {
  std::string text;
  for (const Axis axis : all_axes) {
    if (index(axis) > index(Axis::c)) break;
    if (!text.empty()) text += ", ";
    text += four(is_rotary(axis) ? values[axis] * degrees_per_radian : length(values[axis]));
  }
  return text;
}

std::string Rs274Writer::State::six(const AxisValues& p_machine) const {
  return lengths(to_program(p_machine));
}

void Rs274Writer::State::header() {
  header_written = true;
  const std::string field = std::exchange(n_field, "N..... ");
  line(unit_mm == 1 ? "USE_LENGTH_UNITS(CANON_UNITS_MM)" : "USE_LENGTH_UNITS(CANON_UNITS_INCHES)");
  line("SET_G5X_OFFSET(" + std::to_string(system) + ", " + lengths(work_offset) + ")");
  line("SET_G92_OFFSET(" + lengths(g92_offset) + ")");
  line("SET_XY_ROTATION(" + four(rotation * degrees_per_radian) + ")");
  line("SET_FEED_REFERENCE(CANON_XYZ)");
  line("ON_RESET()");
  n_field = field;
}

void Rs274Writer::State::open_sync(const SyncFeed& move, std::uint64_t block) {
  if (sync_open && (sync_block != block || move.rigid_tap)) close_sync();
  if (!sync_open || sync_pitch != move.per_revolution || sync_spindle != move.spindle)
    line("START_SPEED_FEED_SYNC(" + fixed(length(move.per_revolution), 6) + "," +
         std::to_string(move.spindle) + ")");
  sync_open = true;
  sync_block = block;
  sync_pitch = move.per_revolution;
  sync_spindle = move.spindle;
}

void Rs274Writer::State::close_sync() {
  if (sync_open) line("STOP_SPEED_FEED_SYNCH()");
  sync_open = false;
}

// Units, or degrees of rotary axes, per minute.
void Rs274Writer::State::inverse_time_rate(Way way, std::uint64_t block) {
  constexpr double least = 0.1;  // the reference's
  const double units = way.rotary ? way.length * degrees_per_radian : length(way.length);
  std::string rate = "SET_FEED_RATE(" + four(std::max(least, units * moves_per_minute)) + ")";
  if (block != rate_block || rate != told_rate) line(rate);
  rate_block = block;
  told_rate = std::move(rate);
}

void Rs274Writer::State::arc(const ArcFeed& move, std::uint64_t block) {
  AxisValues centre;
  centre[Axis::x] = move.centre.x();
  centre[Axis::y] = move.centre.y();
  centre[Axis::z] = move.centre.z();
  const AxisValues c = to_program(centre), end = to_program(move.end);
  // First and second axis of the plane, and the one along its normal.
  Axis first = Axis::x, second = Axis::y, third = Axis::z;
  if (move.plane == Plane::zx) first = Axis::z, second = Axis::x, third = Axis::y;
  if (move.plane == Plane::yz) first = Axis::y, second = Axis::z, third = Axis::x;
  if (feed_mode == FeedMode::inverse_time) inverse_time_rate(arc_way(tip, move), block);
  std::string text = "ARC_FEED(";
  for (const double mm : {end[first], end[second], c[first], c[second]})
    text += four(length(mm)) + ", ";
  text += std::to_string(move.turns) + ", " + four(length(end[third]));
  for (const Axis axis : {Axis::a, Axis::b, Axis::c})
    text += ", " + four(end[axis] * degrees_per_radian);
  line(text + ")");
}

void Rs274Writer::State::set_n_field(const SourceSpan& span) {
  std::string digits = n_of(span.line_text());
  if (digits.empty()) {
    n_field = "N..... ";
    return;
  }
  if (digits.size() < 5) digits.append(5 - digits.size(), ' ');
  n_field = "N" + digits + " ";
}

namespace {

/// Writes the lines of one command.
struct Write {
  Rs274Writer::State& s;
  std::uint64_t block;

  void operator()(const Rapid& c) const { s.line("STRAIGHT_TRAVERSE(" + s.six(c.end) + ")"); }
  void operator()(const LinearFeed& c) const {
    if (s.feed_mode == FeedMode::inverse_time)
      s.inverse_time_rate(straight_way(s.tip, c.end), block);
    s.line("STRAIGHT_FEED(" + s.six(c.end) + ")");
  }
  void operator()(const ArcFeed& c) const { s.arc(c, block); }
  void operator()(const SplineFeed& c) const {
    s.line("NURBS_FEED(" + std::to_string(c.points.size()) + ", ...)");
  }
  void operator()(const Dwell& c) const { s.line("DWELL(" + four(c.seconds) + ")"); }
  void operator()(const SyncFeed& c) const {
    s.open_sync(c, block);
    const AxisValues p = s.to_program(c.end);
    if (!c.rigid_tap) return s.line("STRAIGHT_FEED(" + s.lengths(p) + ")");
    s.line("RIGID_TAP(" + four(s.length(p[Axis::x])) + ", " + four(s.length(p[Axis::y])) + ", " +
           four(s.length(p[Axis::z])) + ")");
    s.close_sync();
  }
  void operator()(const Probe& c) const {
    s.line("TURN_PROBE_ON()");
    s.line("STRAIGHT_PROBE(" + s.six(c.end) + ")");
    s.line("TURN_PROBE_OFF()");
  }
  void operator()(const SetFeedMode& c) const {
    s.feed_mode = c.mode;
    s.line(c.mode == FeedMode::per_revolution ? "SET_FEED_MODE(0, 1)" : "SET_FEED_MODE(0, 0)");
  }
  void operator()(const SetFeedRate& c) const {
    switch (s.feed_mode) {
      case FeedMode::inverse_time:
        s.moves_per_minute = c.value * seconds_per_minute;
        return;  // printed with each move
      case FeedMode::per_minute:
        return s.line("SET_FEED_RATE(" + four(s.length(c.value) * seconds_per_minute) + ")");
      case FeedMode::per_revolution:
        return s.line("SET_FEED_RATE(" + four(s.length(c.value)) + ")");
    }
  }
  void operator()(const SelectPlane& c) const {
    static constexpr const char* names[] = {"XY", "XZ", "YZ", "UNKNOWN", "UNKNOWN", "UNKNOWN"};
    s.line(std::string("SELECT_PLANE(CANON_PLANE_") + word(c.plane, names) + ")");
  }
  void operator()(const UseUnit& c) const {
    s.unit_mm = c.unit == Unit::inch ? mm_per_inch : 1;
    s.line(c.unit == Unit::inch ? "USE_LENGTH_UNITS(CANON_UNITS_INCHES)"
                                : "USE_LENGTH_UNITS(CANON_UNITS_MM)");
  }
  void operator()(const WorkOffset& c) const {
    s.system = c.system;
    s.work_offset = c.offset;
    s.line("SET_G5X_OFFSET(" + std::to_string(c.system) + ", " + s.lengths(c.offset) + ")");
  }
  void operator()(const WorkRotation& c) const {
    s.rotation = c.angle;
    s.line("SET_XY_ROTATION(" + four(c.angle * degrees_per_radian) + ")");
  }
  // The reference has no such map; its coordinates are those behind it.
  void operator()(const ProgramMap&) const {}
  void operator()(const G92Offset& c) const {
    s.g92_offset = c.offset;
    s.line("SET_G92_OFFSET(" + s.lengths(c.offset) + ")");
  }
  void operator()(const ToolLengthOffset& c) const {
    std::string text = "USE_TOOL_LENGTH_OFFSET(";
    for (const Axis axis : all_axes) {
      if (axis != Axis::x) text += is_first_of_three(axis) ? ", " : " ";
      const double value = c.offset[axis];
      text += four(is_rotary(axis) ? value * degrees_per_radian : s.length(value));
    }
    s.line(text + ")");
    // The controlled point stays, so the tip moves.
    s.tip += s.tool_offset - c.offset;
    s.tool_offset = c.offset;
  }
  void operator()(const SetPathMode& c) const {
    switch (c.mode) {
      case PathMode::exact_path:
        return s.line("SET_MOTION_CONTROL_MODE(CANON_EXACT_PATH)");
      case PathMode::exact_stop:
        return s.line("SET_MOTION_CONTROL_MODE(CANON_EXACT_STOP)");
      case PathMode::continuous:
        return s.line("SET_MOTION_CONTROL_MODE(CANON_CONTINUOUS, " +
                      fixed(s.length(c.tolerance), 6) + ")");
    }
  }
  void operator()(const SetNaiveCam& c) const {
    s.line("SET_NAIVECAM_TOLERANCE(" + four(s.length(c.tolerance)) + ")");
  }
  void operator()(const SetSpindleMode& c) const {
    if (bool* on = surface_speed(c.spindle)) *on = c.css_max_rpm != 0;
    s.line("SET_SPINDLE_MODE(" + std::to_string(c.spindle) + " " + four(c.css_max_rpm) + ")");
  }
  void operator()(const SetSpindleSpeed& c) const {
    // With G96 the program says m/min or, in inches, ft/min.
    const bool* css = surface_speed(c.spindle);
    const bool feet = css && *css && s.unit_mm != 1;
    s.line("SET_SPINDLE_SPEED(" + std::to_string(c.spindle) + ", " +
           four(feet ? c.value * mm_per_metre / mm_per_foot : c.value) + ")");
  }
  void operator()(const TurnSpindle& c) const {
    static constexpr const char* calls[] = {"STOP_SPINDLE_TURNING", "START_SPINDLE_CLOCKWISE",
                                            "START_SPINDLE_COUNTERCLOCKWISE"};
    s.line(std::string(word(c.turn, calls)) + '(' + std::to_string(c.spindle) + ')');
  }
  void operator()(const OrientSpindle& c) const {
    s.line("ORIENT_SPINDLE(" + std::to_string(c.spindle) + ", " +
           four(c.angle * degrees_per_radian) + ", " + std::to_string(c.direction) + ")");
  }
  void operator()(const SelectTool& c) const { numbered("SELECT_TOOL", c.number); }
  void operator()(const ChangeTool& c) const { numbered("CHANGE_TOOL", c.number); }
  void operator()(const SetToolNumber& c) const { numbered("CHANGE_TOOL_NUMBER", c.number); }
  void operator()(const Coolant& c) const {
    const char* kind = c.kind == Coolant::Kind::mist ? "MIST" : "FLOOD";
    s.line(std::string(kind) + (c.on ? "_ON()" : "_OFF()"));
  }
  void operator()(const Override& c) const {
    static constexpr const char* names[] = {"_FEED_OVERRIDE(", "_SPEED_OVERRIDE(",
                                            "_ADAPTIVE_FEED(", "_FEED_HOLD("};
    s.line(std::string(c.enabled ? "ENABLE" : "DISABLE") + word(c.kind, names) +
           (c.kind == Override::Kind::speed ? std::to_string(c.spindle) : "") + ")");
  }
  void operator()(const DigitalOutput& c) const {
    numbered(c.with_motion ? (c.on ? "SET_MOTION_OUTPUT_BIT" : "CLEAR_MOTION_OUTPUT_BIT")
                           : (c.on ? "SET_AUX_OUTPUT_BIT" : "CLEAR_AUX_OUTPUT_BIT"),
             c.index);
  }
  void operator()(const AnalogOutput& c) const {
    s.line(std::string(c.with_motion ? "SET_MOTION_OUTPUT_VALUE(" : "SET_AUX_OUTPUT_VALUE(") +
           std::to_string(c.index) + "," + fixed(c.value, 6) + ")");
  }
  void operator()(const SwitchKinematics&) const {}  // a thing of the machine behind it
  void operator()(const WaitInput&) const {}         // the reference prints nothing for these two
  void operator()(const UserCode&) const {}
  void operator()(const ProgramStop& c) const {
    s.line(c.optional ? "OPTIONAL_PROGRAM_STOP()" : "PROGRAM_STOP()");
  }
  void operator()(const PalletChange&) const { s.line("PALLET_SHUTTLE()"); }
  void operator()(const ProgramEnd&) const { s.line("PROGRAM_END()"); }
  void operator()(const Message& c) const {
    switch (c.kind) {
      case Message::Kind::message:
      case Message::Kind::debug:
        return quoted("MESSAGE", c.text);
      case Message::Kind::comment:
        return quoted("COMMENT", c.text);
      case Message::Kind::print:  // goes to the console between the lines
        s.out += printable(c.text) + '\n';
        return;
    }
  }
  void operator()(const LogFile& c) const {
    switch (c.kind) {
      case LogFile::Kind::open:
        return quoted("LOGOPEN", c.text);
      case LogFile::Kind::append:
        return quoted("LOGAPPEND", c.text);
      case LogFile::Kind::write:
        return quoted("LOG", c.text);
      case LogFile::Kind::close:
        return s.line("LOGCLOSE()");
      case LogFile::Kind::probe_open:
        return quoted("COMMENT", "PROBEOPEN " + c.text);
      case LogFile::Kind::probe_close:
        return s.line("COMMENT(\"PROBECLOSE\")");
    }
  }

 private:
  static bool is_first_of_three(Axis axis) { return index(axis) % 3 == 0; }
  bool* surface_speed(int spindle) const {
    const bool known = spindle >= 0 && spindle < static_cast<int>(std::size(s.surface_speed));
    return known ? &s.surface_speed[spindle] : nullptr;
  }
  void numbered(const char* call, int number) const {
    s.line(std::string(call) + '(' + std::to_string(number) + ')');
  }
  void quoted(const char* call, const std::string& text) const {
    s.line(std::string(call) + "(\"" + printable(text) + "\")");
  }
};

}  // namespace

Rs274Writer::Rs274Writer(Unit start_unit) : state_(std::make_unique<State>()) {
  state_->unit_mm = start_unit == Unit::inch ? mm_per_inch : 1;
}
Rs274Writer::~Rs274Writer() = default;
Rs274Writer::Rs274Writer(Rs274Writer&&) noexcept = default;

std::string Rs274Writer::write(const Command& command) {
  State& s = *state_;
  s.out.clear();
  const bool start_state = command.block == 0;
  if (!start_state) {
    if (!s.header_written) s.header();
    const auto* sync = std::get_if<SyncFeed>(&command.action);
    if (!sync || sync->rigid_tap || command.block != s.sync_block) s.close_sync();
    s.set_n_field(command.span);
  }
  std::visit(Write{s, command.block}, command.action);
  s.tip = end_of(command.action, s.tip);
  if (start_state) {  // told by the header
    s.out.clear();
    s.number = 0;
  }
  return s.out;
}

std::string Rs274Writer::finish() {
  State& s = *state_;
  s.out.clear();
  if (!s.header_written) s.header();
  s.close_sync();
  return s.out;
}

}  // namespace aircut::canon
