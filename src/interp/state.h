// All modal settings as a plain copyable value. Lengths mm, angles rad, positions are of the tool
// tip in machine coordinates (without the tool length offset) unless the name says otherwise.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>

#include "canon/canon.h"
#include "interp/contour.h"
#include "interp/program_frame.h"

namespace aircut::interp {

constexpr double radian_per_degree = std::numbers::pi / 180;
constexpr int max_spindles = 8;

struct SpindleState {
  canon::SpindleTurn turn = canon::SpindleTurn::stop;
  double speed = 0;      ///< rev/min, with css the number of S as programmed
  bool css = false;      ///< G96
  double css_limit = 0;  ///< rev/min, of G96 D
  bool override_on = true;
};

/// What a canned cycle remembers from line to line: the numbers of the words as they stand there,
/// whatever the unit (Fanuc-like dialects: mm); levels are program coordinates along the plane's
/// normal axis.
struct CycleState {
  int code = 0;                                ///< of the cycle group in force, 0 outside
  double initial = 0;                          ///< normal coordinate when the group began
  canon::Plane plane = canon::Plane::xy;       ///< when the group began
  canon::Unit unit = canon::Unit::millimetre;  ///< when its words were given
  double r = 0, z = 0, p = 0, q = 0, d = 0;
  bool has_r = false, has_z = false, has_p = false, has_q = false, has_d = false;
  bool has_i = false, has_j = false, has_k = false;
  double i = 0, j = 0, k = 0;  ///< G87; Fanuc: shift of G76 and G87. Haas: pecks of G73 and G83
  bool interrupted = false;    ///< by G5, G5.1: the initial level is taken anew
};

/// What the cycles of Fanuc-like lathes keep from line to line; mm, X as radius.
struct TurningState {
  int code = 0;                  ///< G90, G92, G94 in force, 0 else
  PlanePoint end;                ///< of it: Z and X
  double taper = 0;              ///< of it: R
  double depth = 0, escape = 0;  ///< G71 G72
  PlanePoint pattern;            ///< G73: way along Z and X
  int pattern_count = 0;
  double groove_escape = 0;                                         ///< G74 G75
  double thread_least = 0, thread_allowance = 0, thread_angle = 0;  ///< G76
  int thread_finishing = 1;
  int thread_chamfer = 0;  ///< tenths of the lead
};

/// Control point that a G5 without I J reflects.
struct SplineMemory {
  bool valid = false;
  double dx = 0, dy = 0;  ///< end − second control point of the last G5
};

/// G16: the words of the plane are a radius and an angle.
struct PolarState {
  bool on = false;
  /// Of the last words since G16; rad, mm.
  std::optional<double> angle, radius;  ///< the radius only when it counts from the zero point
};

enum class CompSide : unsigned char { off, left, right };

struct CompState {
  CompSide side = CompSide::off;
  double radius = 0;  ///< mm, >= 0
  int orientation = 0;
  bool from_diameter_word = false;  ///< G41.1, G42.1
  bool entered = false;             ///< the entry move was made
  bool leaving = false;             ///< G40 was given, the next move must be straight
  AxisValues programmed;            ///< where the tip would be without compensation, once entered
  AxisValues left_at;               ///< where the tip was when G40 was given
};

struct ModalState {
  AxisValues tip;
  AxisValues work_offset;  ///< of the active system
  double rotation = 0;     ///< of the active system about Z
  AxisValues g92;          ///< in force; on Fanuc the local shift (G52) is part of it
  AxisValues local_shift;  ///< G52 of Fanuc
  ProgramFrame frame;      ///< G51.1 G51 G68 of Fanuc
  PolarState polar;        ///< G16 of Fanuc
  /// G68: the program coordinates from before it, until the first move in its plane.
  bool turn_is_fresh = false;
  AxisValues before_turn;
  /// G69: the next move in this plane must be absolute.
  bool turn_was_left = false;
  AxisValues length_offset;
  bool length_offset_on = false;  ///< G43 G43.1 G43.2, not G49
  int system = 1;                 ///< 1 (G54) … 9; 100 + n: G54.1 Pn
  // Fanuc
  bool length_suspended = false;  ///< G28 or G53 took the length offset away while G43 is on
  int length_number = -1;         ///< of the last H word; -1: none yet
  int offset_number = -1;         ///< of the last D word, or of a lathe's T word; -1: none yet
  std::optional<AxisValues> way_point;  ///< intermediate point of G28, for G29: machine coordinates
  bool data_setting = false;            ///< between G10 L50 and G11
  bool tcp = false;                     ///< between G43.4 (G234) and G49

  int kinematics = 0;  ///< number of the machine's kinematics in force

  canon::Unit unit = canon::Unit::millimetre;
  canon::Plane plane = canon::Plane::xy;
  canon::FeedMode feed_mode = canon::FeedMode::per_minute;
  canon::PathMode path_mode = canon::PathMode::continuous;
  double path_tolerance = 0;   ///< the numbers of P and Q as programmed; cycles give them again in
  double naive_tolerance = 0;  ///< the unit then in force
  bool incremental = false;    ///< G91
  bool absolute_centres = false;  ///< G90.1
  bool retract_to_r = true;       ///< G99
  bool lathe_diameter = false;    ///< G7
  int motion = 800;               ///< code × 10 of group 1; 800 for G80
  double feed = 0;                ///< the number of F as programmed

  int selected_tool = -1;  ///< -1: none selected yet
  int tool = 0;            ///< in the spindle
  std::array<SpindleState, max_spindles> spindles{};
  bool mist = false;
  bool flood = false;
  bool feed_override = true;
  bool thread_override = false;  ///< G76 has switched it on since, unknown to the program
  bool adaptive_feed = false;
  bool feed_hold = true;

  CompState comp;
  CycleState cycle;
  TurningState turning;
  bool rigid_tapping = false;  ///< M29: the taps of the next cycle turn with the feed
  double cycle_dwell = 0;      ///< last P of a cycle: G74 and G84 take it when they have none
  SplineMemory spline;
  std::uint32_t nurbs_points = 0;  ///< control points collected since G5.2
  int nurbs_order = 3;

  /// The point from which the next move is programmed.
  const AxisValues& programmed_tip() const { return comp.entered ? comp.programmed : tip; }
  double unit_mm() const { return unit == canon::Unit::inch ? 25.4 : 1.0; }
};

/// Program coordinates of a tip position.
AxisValues to_program(const ModalState& state, const AxisValues& tip);
/// Tip position of program coordinates.
AxisValues to_tip(const ModalState& state, const AxisValues& program);
/// The same without the program's frame: a rigid system, in which lengths are true.
AxisValues to_work(const ModalState& state, const AxisValues& tip);
AxisValues work_to_tip(const ModalState& state, const AxisValues& work);
/// The axes that may move when program coordinates of `named` change; all others stay to the last
/// bit.
AxisSet moved_by(const ModalState& state, AxisSet named);

/// The axes of a plane: first, second and normal, right-handed.
struct PlaneAxes {
  Axis first, second, normal;
};
PlaneAxes axes_of(canon::Plane plane);
/// Unit normal of the plane in force, machine coordinates. The program's frame turns about it and
/// leaves it as it is.
Vec3 plane_normal(const ModalState& state);
/// Whether the frame makes right of left in the plane in force.
bool swaps_sides(const ModalState& state);

}  // namespace aircut::interp
