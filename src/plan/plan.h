// plan: from canonical commands to timed motion. The path is followed exactly, the speed is the
// largest that feed, joint speed and joint acceleration allow through the machine's kinematics.
// Units mm, rad, s.
//
//   push(Command) ─► look-ahead window ─► take() ─► Segment: geometry and s(t)
#pragma once

#include <compare>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "canon/canon.h"
#include "machine/machine.h"

namespace aircut::plan {

/// From `t` on (s since the segment's start): s(τ) = s + vτ + aτ²/2 + jτ³/6 with τ = time − t.
struct ProfileKnot {
  double t = 0, s = 0, v = 0, a = 0, j = 0;
};

/// s(t) as polynomial pieces; the last knot is the end.
struct SpeedProfile {
  std::vector<ProfileKnot> knots;
  double duration() const { return knots.empty() ? 0 : knots.back().t; }
  struct State {
    double s = 0, v = 0, a = 0;
  };
  /// `t` in [0, duration]; clamped.
  State at(double t) const;
  /// Smallest and largest s over [t0, t1] (s never runs backwards).
  std::pair<double, double> range(double t0, double t1) const { return {at(t0).s, at(t1).s}; }
};

/// The tip stands still.
struct Hold {
  AxisValues at;
};

struct Line {
  AxisValues start, end;
  double length = 0;  ///< of the feed metric (planner rule: XYZ, else UVW, else ABC in rad)
};

/// Circle, helix or spiral about a fixed axis; s runs from 0 to length, the angle linearly with it.
struct Arc {
  AxisValues start, end;
  Vec3 centre = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();
  Vec3 radial = Vec3::UnitX();  ///< unit vector from the axis to the start
  double start_radius = 0, end_radius = 0;
  double angle = 0;  ///< swept, rad, signed about normal
  double rise = 0;   ///< along normal, mm
  double length = 0;
};

/// A corner's blend, or a part of one: quintic Bezier in nine axes over u in [0, 1]. s is the
/// length of the way: u is a polynomial of y = 2 (begin + s) / whole − 1 (coefficients by rising
/// power).
struct Blend {
  std::array<AxisValues, 6> control;
  std::array<double, 14> u_of_y{};
  double whole = 0;  ///< length of the whole curve
  double begin = 0;  ///< length of the whole curve before this part
  double length = 0;
  bool xyz_only = false;  ///< the other axes stand still
};

/// A rapid that is straight in no more than the joints (RapidMode joint or dogleg), from rest to
/// rest. s counts along the straight way between its ends.
struct JointWay {
  AxisValues start, end;
  machine::JointVector from, to;
  AxisValues tool_offset;
  const machine::Kinematics* kinematics = nullptr;  ///< outlives it
  double length = 0;
  std::vector<SpeedProfile> laws;  ///< dogleg: of each joint; empty: all in step
  double seconds = 0;              ///< of the longest law
};

using Path = std::variant<Hold, Line, Arc, Blend, JointWay>;

double length(const Path& path);
struct PathPoint {
  AxisValues p;   ///< position
  AxisValues d;   ///< first derivative by s
  AxisValues dd;  ///< second derivative by s
};
PathPoint evaluate(const Path& path, double s);
/// Box of the positions for s in [s0, s1] and the way of each axis; exact or larger. Without bounds
/// for a JointWay.
machine::TipInterval bounds(const Path& path, double s0, double s1);

/// The path of a command from where the tip is, as it is programmed; a Hold for one that does not
/// move. Errors: an arc without a radius; a spline (kind `unsupported_code`).
Expected<Path> path_of(const AxisValues& start, const canon::Action& action);

/// Speed of the tip along the feed metric (XYZ, else UVW, else ABC) per path speed; 1 but for
/// blends and spirals.
double metric_speed(const Path& path, const PathPoint& point);

/// Joints and their derivatives by s at one place of a path.
struct JointPoint {
  machine::JointVector q, dq, ddq;
};
/// Derivatives of the joints from those of the tip: analytic where the kinematics offers it, else
/// by differences of the inverse. The error also says when they are not finite (a singular pose).
tl::expected<JointPoint, machine::ReachError> joint_point(const machine::Kinematics& kinematics,
                                                          const machine::Target& target,
                                                          const AxisValues& d_tip,
                                                          const AxisValues& dd_tip,
                                                          const machine::JointVector& near);

/// Joints of such a rapid.
JointPoint joint_point(const JointWay& way, double s);
/// A rapid of the machine's mode, with its time law, and no way when nothing moves. Error: the end
/// is out of reach.
struct JointRapid {
  JointWay way;
  SpeedProfile profile;
};
tl::expected<JointRapid, machine::ReachError> joint_rapid(const machine::Machine& machine,
                                                          const machine::Kinematics& kinematics,
                                                          const machine::JointVector& from,
                                                          const AxisValues& start,
                                                          const AxisValues& end,
                                                          const AxisValues& tool_offset);
/// True where rapids are straight in the program's axes. (Where each joint is an axis, straight in
/// the joints is the same.)
bool has_straight_rapids(const machine::Machine& machine, const machine::Kinematics& kinematics);

enum class LimitedBy : unsigned char { none, feed, velocity, acceleration, jerk };

/// What held the speed, and whose limit that is.
struct Cause {
  LimitedBy by = LimitedBy::none;
  signed char joint = -1;  ///< JointId; −1: no joint's, as the feed
  auto operator<=>(const Cause&) const = default;
};

enum class MotionKind : unsigned char {
  idle = 0,
  rapid = 1,
  feed = 2,
  arc = 3,
  tool_change = 4,
  probe = 5,
  dwell = 6,
  sync = 7,
  blend = 8
};
std::string_view to_string(MotionKind kind);

/// Why the run can't go on after a segment.
struct Failure {
  std::string kind;     ///< `unreachable`, `singular`
  std::string message;  ///< whole sentence
  double fraction = 0;  ///< of the block's path
  AxisValues pose;      ///< the tip that can't be reached
};

/// How a synchronised segment and the spindle go together.
struct Sync {
  double pitch = 0;  ///< mm of way per revolution
  bool spindle_follows =
      false;         ///< its angle is that of the way (tapping); else it turns on evenly
  double sense = 1;  ///< of the spindle where it follows: 1 = clockwise
};

/// Which overrides count for a motion (M48 to M53).
struct Overridable {
  bool feed = true;  ///< and the rapids'
  bool spindle = true;
  bool hold = true;
  bool adaptive = false;
  bool per_revolution = false;  ///< G95: a slower spindle makes a slower feed
};

/// One command carried out: a piece of path with its time law. Commands that do not move give a
/// segment with a Hold and the time they take (0 for most), so every command reaches the listeners
/// in order.
struct Segment {
  canon::Command command;  ///< the one that this segment carries out
  MotionKind kind = MotionKind::idle;
  Path path = Hold{};
  SpeedProfile profile;
  double t_start = 0;        ///< program time, s
  AxisValues tool_offset;    ///< length offset in force
  bool rounds_feed = false;  ///< a blend of which at least one block is a feed move
  bool merged = false;       ///< part of a chord that replaces several lines (G64 Q)
  double feed = 0;           ///< commanded speed along the feed metric, mm/s (rad/s); 0 = rapid
  int tool = 0;              ///< in the spindle; during a tool change still the old one
  double spindle_rpm = 0;    ///< signed, clockwise positive
  /// Where the motion waits for the spindle: its speed at the start; it changes evenly to
  /// spindle_rpm.
  std::optional<double> spindle_from;
  int work_system = 1;  ///< 1 = G54 … 9 = G59.3
  /// The part of the block's path that this segment covers (a block may be split by blends).
  double u0 = 0, u1 = 1;
  Overridable overridable;
  Cause limited_by;            ///< what held the speed longest
  std::optional<Sync> sync;    ///< of synchronised motion
  std::optional<double> trip;  ///< of a probing move: s at which the probe trips
  std::string sync_problem;    ///< why the axis can't keep to the spindle; empty = it can
  /// Why a joint passes its limit of acceleration or jerk here; empty = none does.
  std::string limit_problem;
  std::optional<Failure> failure;  ///< the run ends here
  /// In force, where a program has switched to another one; null: the machine's. The path and the
  /// offset are in its coordinates.
  const machine::Kinematics* kinematics = nullptr;

  double duration() const { return profile.duration(); }
  double t_end() const { return t_start + duration(); }
};

/// What a segment's time is spent on; waits for the spindle's speed or index are a kind of their
/// own.
enum class TimeUse : unsigned char { rapid, feed, tool_change, spindle_wait, rest };
TimeUse time_use(const Segment& segment);

inline const machine::Kinematics& kinematics_of(const Segment& segment,
                                                const machine::Kinematics& usual) {
  return segment.kinematics ? *segment.kinematics : usual;
}

/// Revolutions of the spindle since the segment's start, and its speed, `t` s after the start.
double spindle_turns(const Segment& segment, double t);
double spindle_rpm(const Segment& segment, double t);

/// What somebody does at the control's panel: from `t` on (program time, s) a factor of the
/// programmed speed, or the motion held and going on.
struct OverrideEvent {
  enum class What : unsigned char { feed, rapid, spindle, adaptive, hold, resume };
  double t = 0;
  What what = What::feed;
  double factor = 1;  ///< 0 or more; 0 holds what it counts for
};

/// What is wrong with a list of events; empty: nothing.
std::string wrong_overrides(const std::vector<OverrideEvent>& events);
/// Every factor that the feed of a motion can have by these events; empty without events.
std::vector<double> feed_factors(const std::vector<OverrideEvent>& events);

struct Options {
  /// In order of time. What is held must be let go again by a later event.
  std::vector<OverrideEvent> overrides = {};
  double period = 0.001;           ///< servo period, s
  double optional_stop = 0;        ///< s
  int tool = 0;                    ///< in the spindle at the start
  std::size_t max_nodes = 200000;  ///< look-ahead window; a node takes about 150 bytes
};

/// What the planning has cost so far.
struct Statistics {
  std::uint64_t pieces = 0;        ///< of path
  std::uint64_t nodes = 0;         ///< along them, at which limits were looked at
  std::uint64_t jerk_windows = 0;  ///< stretches that were planned with limited jerk
  std::uint64_t newton_steps = 0;  ///< of their solver
};

class Planner {
 public:
  /// `start` is where the joints are; the tip follows from forward kinematics.
  Planner(const machine::Machine& machine, const machine::JointVector& start, Options options);
  ~Planner();
  Planner(const Planner&) = delete;
  Planner& operator=(const Planner&) = delete;

  /// Appends a command. Error: a command that no model exists for (kind `unsupported_code`).
  Expected<void> push(const canon::Command& command);
  /// A probing move whose probe trips `trip` along the feed metric from its start: it brakes there
  /// and rests a little farther on, at most at its end. Errors as those of push().
  Expected<void> push_probe(const canon::Command& command, double trip);
  /// The straight way of a command from there, at 1 mm (or rad) a second: to look at before it is
  /// planned.
  Segment straight_way(const canon::Command& command) const;
  /// Everything pushed so far becomes final: the last motion ends at rest.
  void flush();
  /// The tip at the end of everything pushed, in the kinematics in force then.
  const AxisValues& tip() const;
  /// The next final segment, in order; empty when more input (or flush) is needed.
  std::optional<Segment> take();
  Statistics statistics() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace aircut::plan
