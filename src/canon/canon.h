// canon: the canonical commands, the contract between the interpreter and the planner.
// Units are mm, rad, s. Positions are of the tool tip in machine coordinates: work offset, G92 and
// rotation are applied, the tool length offset is NOT added (it is a state of its own, see
// ToolLengthOffset), so the controlled point is tip + offset.
// A stream of commands carries all state that a listener needs: the rs274 form of a trace is a pure
// function of it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/base.h"
#include "geometry/geometry.h"

namespace aircut::canon {

enum class Plane : unsigned char { xy, zx, yz, uv, wu, vw };
enum class FeedMode : unsigned char { per_minute, inverse_time, per_revolution };
enum class Unit : unsigned char { inch, millimetre };
enum class PathMode : unsigned char { exact_path, exact_stop, continuous };
enum class SpindleTurn : unsigned char { stop, clockwise, counterclockwise };

// ---- motion ----------------------------------------------------------------------------------

/// Straight in program space, as fast as the machine can.
struct Rapid {
  AxisValues end;
};

/// Straight at the feed.
struct LinearFeed {
  AxisValues end;
};

/// Circle or helix. `centre` is a point on the helix' axis, `normal` its unit direction; the tip
/// turns counter-clockwise about `normal` when turns > 0, clockwise when turns < 0; |turns| − 1 is
/// the number of extra full turns (as ARC_FEED of the reference). All other axes, and the way along
/// `normal`, are linear in the angle; the radius goes linearly from start to end.
struct ArcFeed {
  AxisValues end;
  Vec3 centre = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();
  int turns = 1;
  Plane plane = Plane::xy;
};

/// NURBS in the XY plane.
struct SplineFeed {
  struct Point {
    double x = 0, y = 0, weight = 1;
  };
  std::vector<Point>
      points;  ///< control points, the first is the current position; machine coordinates
  int order = 3;
};

struct Dwell {
  double seconds = 0;
};

/// Spindle-synchronised motion: G33 (thread) and G33.1 (rigid tap, which comes back to the start).
struct SyncFeed {
  AxisValues end;
  double per_revolution = 0;  ///< mm along the move per spindle revolution
  bool rigid_tap = false;
  double return_factor = 1;  ///< speed of the way back, rigid tap only
  int spindle = 0;
};

/// G38.2-.5.
struct Probe {
  AxisValues end;
  bool away = false;             ///< .4 .5: stop when contact is lost
  bool error_if_missed = false;  ///< .2 .4
};

// ---- state -----------------------------------------------------------------------------------

struct SetFeedMode {
  FeedMode mode = FeedMode::per_minute;
};
/// per_minute: mm/s (rad/s for a move of rotary axes alone, see `rotary`); inverse_time: 1/s (moves
/// per second); per_revolution: mm per revolution.
struct SetFeedRate {
  double value = 0;
  double rotary = 0;  ///< the same F word read in degrees, as rad/s; only in per_minute mode
};
struct SelectPlane {
  Plane plane = Plane::xy;
};
struct UseUnit {
  Unit unit = Unit::millimetre;
};
/// Work offset in force: system 1 (G54) … 9 (G59.3), 100 + n: G54.1 Pn.
struct WorkOffset {
  int system = 1;
  AxisValues offset;
};
/// Rotation of the work system about Z.
struct WorkRotation {
  double angle = 0;  ///< rad, counter-clockwise
};
/// G92/G52 offset in force, as the reference prints it.
struct G92Offset {
  AxisValues offset;
};
/// What mirror image, scaling and rotation (Fanuc: G51.1 G51 G68) make of the X Y Z words, before
/// G92 offset and work offset: linear · program + shift, mm. Moves have it applied already.
struct ProgramMap {
  Mat3 linear = Mat3::Identity();
  Vec3 shift = Vec3::Zero();
};
/// Added to the tip to give the controlled point.
struct ToolLengthOffset {
  AxisValues offset;
  int tool = 0;  ///< whose length it is (G43 H); 0: not a tool's, given as numbers or none
};
struct SetPathMode {
  PathMode mode = PathMode::continuous;
  double tolerance = 0;  ///< G64 P, mm; 0 = no limit
};
struct SetNaiveCam {
  double tolerance = 0;  ///< G64 Q, mm; 0 = off
};

struct SetSpindleMode {
  int spindle = 0;
  double css_max_rpm = 0;  ///< 0: constant revolutions (G97); else G96 with this limit
};
struct SetSpindleSpeed {
  int spindle = 0;
  double value = 0;  ///< rev/min, or with G96 m/min
};
struct TurnSpindle {
  int spindle = 0;
  SpindleTurn turn = SpindleTurn::stop;
  bool wait_for_speed = true;
};
struct OrientSpindle {
  int spindle = 0;
  double angle = 0;  ///< rad
  int direction = 0;
};
struct SelectTool {
  int number = 0;
};
struct ChangeTool {
  int number = 0;  ///< tool that is in the spindle afterwards; 0 = none
};
/// M61.
struct SetToolNumber {
  int number = 0;
};
struct Coolant {
  enum class Kind : unsigned char { mist, flood } kind = Kind::flood;
  bool on = false;
};
struct Override {
  enum class Kind : unsigned char { feed, speed, adaptive_feed, feed_hold } kind = Kind::feed;
  bool enabled = true;
  int spindle = 0;
};
struct DigitalOutput {
  int index = 0;
  bool on = false;
  bool with_motion = false;  ///< M62/M63: at the start of the next motion
};
struct AnalogOutput {
  int index = 0;
  double value = 0;
  bool with_motion = false;
};
struct WaitInput {
  int index = 0;
  bool analog = false;
  int mode = 0;  ///< 0 immediate 1 rise 2 fall 3 high 4 low
  double timeout = 0;
};
/// From here on X Y Z … mean what another kinematics of the machine says, by its number. The joints
/// stand still; where the tip is then, whoever moves the machine tells the interpreter.
struct SwitchKinematics {
  int model = 0;
  bool with_motion = false;     ///< M67: at the start of the next motion
  bool unsynchronised = false;  ///< M68: until an M66 the control plans from the old position
};
/// M100–M199 and remaps that are not NC: listed, never run.
struct UserCode {
  char letter = 'M';  ///< G: data setting (G10 L50)
  int code = 0;       ///< -1 for remapped words without a code of M
  double p = 0, q = 0;
  bool has_p = false, has_q = false;
  std::string remap = {};  ///< `G88.1`, `T`: a word that the set-up gives to a program of its own
};

struct ProgramStop {
  bool optional = false;
};
struct PalletChange {};
struct ProgramEnd {
  bool pallet = false;  ///< M30
};

struct Message {
  enum class Kind : unsigned char { message, debug, print, comment } kind = Kind::message;
  std::string text;
};
struct LogFile {
  enum class Kind : unsigned char { open, append, write, close, probe_open, probe_close } kind;
  std::string text;
};

using Action =
    std::variant<Rapid, LinearFeed, ArcFeed, SplineFeed, Dwell, SyncFeed, Probe, SetFeedMode,
                 SetFeedRate, SelectPlane, UseUnit, WorkOffset, WorkRotation, G92Offset, ProgramMap,
                 ToolLengthOffset, SetPathMode, SetNaiveCam, SetSpindleMode, SetSpindleSpeed,
                 TurnSpindle, OrientSpindle, SelectTool, ChangeTool, SetToolNumber, Coolant,
                 Override, DigitalOutput, AnalogOutput, SwitchKinematics, WaitInput, UserCode,
                 ProgramStop, PalletChange, ProgramEnd, Message, LogFile>;

struct Command {
  Action action;
  SourceSpan span;          ///< the block
  std::uint64_t block = 0;  ///< running number of executed blocks, from 1
  /// Motion that a cycle (G81 …) or a return (G28) made out of the block, e.g. "G83 peck 2".
  std::string expanded = {};
};

/// True for a command that moves axes.
bool is_motion(const Action& action);
/// Where the tip is after the command when it was at `start` before.
AxisValues end_of(const Action& action, const AxisValues& start);

/// One line of text, stable, for tests and `trace --format text`: `rapid X10 Y0 Z5`. Lengths mm,
/// angles degrees, feed mm/min.
std::string to_text(const Action& action);
/// One JSON object in one line, for `trace --format jsonl`; keys carry units.
std::string to_json(const Command& command);

/// Text form that can be compared line by line with the reference program's trace. Keeps what the
/// stream said before (units, offsets), so one instance sees the whole stream.
class Rs274Writer {
 public:
  /// `start_unit` is in force until the stream names a unit.
  explicit Rs274Writer(Unit start_unit = Unit::inch);
  ~Rs274Writer();
  Rs274Writer(Rs274Writer&&) noexcept;
  /// The line(s) of one command, each with its line end; empty when the reference prints nothing.
  /// Commands of block 0 describe the start state: they are told by the six lines before the first
  /// block.
  std::string write(const Command& command);
  /// What is still owed after the last command (the end of a synchronised motion).
  std::string finish();

  struct State;  ///< private to the writer

 private:
  std::unique_ptr<State> state_;
};

}  // namespace aircut::canon
