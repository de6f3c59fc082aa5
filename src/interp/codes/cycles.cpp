// Canned cycles G73 G74 G81-G89. Coordinates here: a and b in the plane, c along its normal,
// program coordinates as numbers
// of the unit in force: what a cycle remembers keeps its numbers over G20 and G21, and pecks are
// counted down from R as the control does it, rounding included.
//
//   initial ──●───────────── ○     rapid to the hole at the present level
//             ┊              ┊
//   R       ──┴──►hole       ▲     rapid down to R, then the cycle's own moves,
//                 │          ┊     back to R (G99) or to the initial level (G98)
//   Z       ──────▼──────────┘
//
// The initial level is the one where the group of cycles began.
#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "interp/codes/codes.h"
#include "interp/codes/hole_motion.h"

namespace aircut::interp {
namespace {

constexpr double rounding = 1e-9;  // of a level that was turned into machine coordinates
constexpr const char* shift = "how far beside the axis the tool goes down";
constexpr int max_moves = 100'000;  // of one line, so that it can't fill the memory

class Cycle : private HoleMotion {
 public:
  Cycle(const CodeRule& rule, BlockRun& run) : HoleMotion(rule, run, run.state.unit_mm()) {}

  void execute();

 private:
  bool allowed();
  bool read_words();
  void warn_of_changed_modes(bool same);
  std::optional<double> coordinate(Axis axis) const;
  bool need(char letter, bool same, bool& sticky, double& value, const char* what);
  bool spindle_fits();
  bool count_moves(int repeats);
  void repeat(int number, int repeats);
  void body();
  void drill(double depth) { feed(depth, "drill"); }
  void peck();
  void tap();
  void bore_and_stop();
  void back_bore();
  void bore_by_hand();

  double r_ = 0, z_ = 0, clear_ = 0;
  double polar_a_ = 0, polar_b_ = 0;  // the hole of the polar words
};

bool Cycle::allowed() {
  if (state_.comp.side != CompSide::off)
    run_.error("comp_illegal", rule_,
               "canned cycles can't be used while radius compensation is on; give G40 before");
  else if (state_.feed_mode == canon::FeedMode::inverse_time)
    run_.error("cycle_error", rule_, "canned cycles can't be used with G93; give G94 or G95");
  else if ((rule_.code == 740 || rule_.code == 840) && state_.plane != canon::Plane::xy)
    run_.error("cycle_error", rule_,
               name_of(rule_) +
                   " works in the XY plane only: in others the control moves the "
                   "wrong axes; give G17 before, or use G33.1");
  else if (run_.machine_coordinates)
    run_.error("g53_error", rule_, "canned cycles can't be used with G53");
  else if (state_.feed <= 0)
    run_.error("zero_feed", rule_, name_of(rule_) + " with feed 0; give an F word above 0 first");
  const bool uvw = state_.plane >= canon::Plane::uv;
  for (const Axis axis : all_axes) {
    const bool linear = uvw ? axis >= Axis::u : axis <= Axis::z;
    if (run_.has(letter(axis)) && !linear)
      run_.error("cycle_error", letter(axis),
                 std::string(1, letter(axis)) +
                     " can't be moved by a canned cycle in this plane; " +
                     "move it on a line before");
  }
  return run_.ok();
}

// A word of a cycle: given, or kept from the line before when that was the same cycle.
bool Cycle::need(char letter, bool same, bool& sticky, double& value, const char* what) {
  if (const auto number = run_.number(letter)) {
    value = *number;
    sticky = true;
  } else if (!same || !sticky) {
    run_.error("word_missing", rule_,
               name_of(rule_) + " needs " + std::string(1, letter) + ": " + what);
    return false;
  }
  return true;
}

std::optional<double> Cycle::coordinate(Axis axis) const {
  const auto number = run_.number(letter(axis));
  return number && axis == Axis::x && state_.lathe_diameter ? *number / 2 : number;
}

// What the cycle keeps from the lines before was said in another plane or unit.
void Cycle::warn_of_changed_modes(bool same) {
  CycleState& cycle = state_.cycle;
  if (cycle.plane != state_.plane)
    run_.warning("cycle_modal_change", run_.whole(),
                 "the plane was changed since this group of canned cycles began: the level to "
                 "retract to was taken along another axis; give G80 before the change");
  else if (same && cycle.unit != state_.unit &&
           !(run_.has('R') && run_.has(letter(axes_.normal)) && (run_.has('Q') || !cycle.has_q)))
    run_.warning("cycle_modal_change", run_.whole(),
                 "the unit was changed since this cycle's R, depth or Q were given, and controls "
                 "differ in how they take them over; give them again");
  cycle.plane = state_.plane;
  cycle.unit = state_.unit;
}

bool Cycle::read_words() {
  CycleState& cycle = state_.cycle;
  const bool same = cycle.code == rule_.code;
  if (!same) {
    const bool begins = cycle.code == 0 || cycle.interrupted;
    const double initial = begins ? c_ : cycle.initial;
    const canon::Plane plane = begins ? state_.plane : cycle.plane;
    cycle = CycleState{};
    cycle.initial = initial;
    cycle.plane = plane;
    cycle.unit = state_.unit;
    cycle.code = rule_.code;
  } else if (cycle.interrupted) {
    cycle.initial = c_;
    cycle.interrupted = false;
  }
  warn_of_changed_modes(same);
  const char normal = letter(axes_.normal);
  if (!run_.has('R') && !same) {
    run_.error("word_missing", rule_, name_of(rule_) + " needs R: the level from which it feeds");
    return false;
  }
  if (!run_.has(normal) && !same) {
    run_.error("word_missing", rule_,
               name_of(rule_) + " needs " + std::string(1, normal) + ": the bottom of the hole");
    return false;
  }
  cycle.r = run_.number_or('R', cycle.r);
  cycle.z = coordinate(axes_.normal).value_or(cycle.z);
  switch (rule_.code) {
    case 870:
      if (!need('I', same, cycle.has_i, cycle.i, shift) ||
          !need('J', same, cycle.has_j, cycle.j, shift) ||
          !need('K', same, cycle.has_k, cycle.k, "how far up it bores"))
        return false;
      break;
    case 820:
    case 860:
    case 880:
    case 890:
      if (!need('P', same, cycle.has_p, cycle.p, "the dwell at the bottom in seconds"))
        return false;
      break;
    case 740:
    case 840:
      cycle.p = run_.number_or('P', state_.cycle_dwell);
      break;
    case 730:
    case 830:
      if (run_.has('Q') && *run_.number('Q') <= 0) {
        run_.error("word_value", 'Q', "Q, the depth of a peck, must be above 0");
        return false;
      }
      if (!need('Q', same, cycle.has_q, cycle.q, "the depth of a peck")) return false;
      if (run_.has('D') && *run_.number('D') < 0) {
        run_.error("word_value", 'D', "D, the way back of a peck, can't be negative");
        return false;
      }
      if (run_.has('D')) {
        cycle.d = *run_.number('D');
        cycle.has_d = true;
      }
      break;
    default:
      break;
  }
  if (cycle.p < 0) {
    run_.error("dwell_time", 'P', "the dwell P of a cycle must be 0 or more seconds");
    return false;
  }
  if (run_.has('P')) state_.cycle_dwell = cycle.p;
  return true;
}

bool Cycle::spindle_fits() {
  const auto spindle = spindle_of(run_, 0);
  if (!spindle) return false;
  spindle_ = *spindle;
  const canon::SpindleTurn turn = state_.spindles[static_cast<std::size_t>(spindle_)].turn;
  if (rule_.code == 840 && turn != canon::SpindleTurn::clockwise) {
    run_.error("spindle_stopped", rule_, "G84 needs the spindle turning clockwise; give M3 before");
    return false;
  }
  if (rule_.code == 740 && turn != canon::SpindleTurn::counterclockwise) {
    run_.error("spindle_stopped", rule_,
               "G74 needs the spindle turning counter-clockwise; give M4 before");
    return false;
  }
  const bool turning = rule_.code == 860 || rule_.code == 870 || rule_.code == 880;
  if (turning && turn == canon::SpindleTurn::stop) {
    run_.error("spindle_stopped", rule_,
               name_of(rule_) + " needs a turning spindle; give M3 or M4 before");
    return false;
  }
  return true;
}

bool Cycle::count_moves(int repeats) {
  double per_hole = 12;
  if (rule_.code == 730 || rule_.code == 830) per_hole += 3 * (r_ - z_) / state_.cycle.q;
  if (per_hole * repeats <= max_moves) return true;
  run_.error("limit_reached", rule_,
             "this line would make more than 100000 moves; use a smaller L or a larger Q");
  return false;
}

void Cycle::execute() {
  if (!allowed()) return;
  if (!run_.has_axis_words())
    return run_.error("axis_word_missing", rule_, name_of(rule_) + " needs at least one axis word");
  int repeats = 1;
  if (run_.has('L')) {
    const auto l = run_.integer('L', 1, 1'000'000'000);
    if (!l) return;
    repeats = *l;
  }
  // The control keeps the number that the program gave; ours has come through the frames. A number
  // of few digits is found again, others stay as they are.
  const double tidy = std::round(c_ * 1e9) / 1e9;
  if (std::fabs(c_ - tidy) < 1e-12) c_ = tidy;
  if (!spindle_fits() || !read_words()) return;
  const CycleState& cycle = state_.cycle;
  r_ = state_.incremental ? cycle.initial + cycle.r : cycle.r;
  z_ = state_.incremental ? r_ + cycle.z : cycle.z;
  if (r_ < z_)
    return run_.error("cycle_error", run_.has('R') ? run_.place('R') : run_.place(rule_),
                      "the bottom of the hole (" + fixed(z_ * unit_, 4) + " mm) is above R (" +
                          fixed(r_ * unit_, 4) + " mm); R must be above it");
  if (!count_moves(repeats)) return;
  clear_ = state_.retract_to_r ? r_ : std::max(r_, cycle.initial);
  if (std::fabs(c_ - r_) < rounding) c_ = r_;
  if (cycle.initial < r_ - rounding) rapid_to(r_, "rise to R");
  begin_exact_path(run_);
  for (int i = 1; i <= repeats && run_.ok(); ++i) repeat(i, repeats);
  end_exact_path(run_);
}

void Cycle::repeat(int number, int repeats) {
  name_hole(number, repeats);
  double a = a_, b = b_;
  if (const auto value = coordinate(axes_.first)) a = state_.incremental ? a_ + *value : *value;
  if (const auto value = coordinate(axes_.second)) b = state_.incremental ? b_ + *value : *value;
  if (run_.has('@') || run_.has('^')) {
    // With G90 all repeats are at the same place: what is not named is taken from the line's start.
    if (state_.incremental || number == 1) {
      double x = a * unit_, y = b * unit_;
      if (!apply_polar(run_, x, y)) return;
      polar_a_ = x / unit_;
      polar_b_ = y / unit_;
    }
    a = polar_a_;
    b = polar_b_;
  }
  // From R or below it the way to the hole rises to the level of retraction on the way.
  move(true, a, b, c_ > r_ ? c_ : clear_, "to the hole");
  if (c_ > r_) rapid_to(r_, "down to R");
  body();
}

void Cycle::body() {
  switch (rule_.code) {
    case 730:
    case 830:
      return peck();
    case 740:
    case 840:
      return tap();
    case 860:
      return bore_and_stop();
    case 870:
      return back_bore();
    case 880:
      return bore_by_hand();
    case 820:
      drill(z_);
      dwell(state_.cycle.p);
      return rapid_to(clear_, "retract");
    case 850:
      drill(z_);
      feed(r_, "back to R");
      return rapid_to(clear_, "retract");
    case 890:
      drill(z_);
      dwell(state_.cycle.p);
      return feed(clear_, "retract");
    default:
      drill(z_);
      return rapid_to(clear_, "retract");
  }
}

// G73 breaks the chip by a short way back, G83 returns to R and comes down again to just above the
// depth reached.
void Cycle::peck() {
  const Options& options = run_.session.options;
  const bool full = rule_.code == 830;
  const double option = (full ? options.g83_clearance : options.g73_clearance) / unit_;
  double clearance = option > 0 ? option : state_.unit == canon::Unit::inch ? 0.01 : 0.254;
  if (state_.cycle.has_d) clearance = state_.cycle.d;
  for (double depth = r_ - state_.cycle.q; depth > z_; depth -= state_.cycle.q)
    HoleMotion::peck(depth, full, r_, clearance);
  feed(z_, "peck");
  rapid_to(clear_, "retract");
}

void Cycle::tap() {
  using Kind = canon::Override::Kind;
  using Turn = canon::SpindleTurn;
  const auto& spindle = state_.spindles[static_cast<std::size_t>(spindle_)];
  const Turn forward = rule_.code == 840 ? Turn::clockwise : Turn::counterclockwise;
  const Turn back = rule_.code == 840 ? Turn::counterclockwise : Turn::clockwise;
  run_.emit(canon::Override{Kind::feed, false, 0});
  run_.emit(canon::Override{Kind::speed, false, spindle_});
  feed(z_, "tap");
  turn(Turn::stop);
  turn(back);
  dwell(state_.cycle.p);
  feed(clear_, "back out");
  turn(Turn::stop);
  turn(forward);
  if (state_.feed_override || state_.thread_override)
    run_.emit(canon::Override{Kind::feed, true, 0});
  if (spindle.override_on) run_.emit(canon::Override{Kind::speed, true, spindle_});
}

void Cycle::bore_and_stop() {
  const canon::SpindleTurn before = state_.spindles[static_cast<std::size_t>(spindle_)].turn;
  drill(z_);
  dwell(state_.cycle.p);
  turn(canon::SpindleTurn::stop);
  rapid_to(clear_, "retract");
  turn(before);
}

// With the spindle stopped at one angle the tool goes down beside the hole's axis, bores from the
// bottom up to K and back, and leaves as it came. Two of I, J and K are along the axes of the
// plane, the third one along its normal.
void Cycle::back_bore() {
  const CycleState& cycle = state_.cycle;
  const double words[] = {cycle.i, cycle.j, cycle.k};
  const auto along = [&](Axis axis) { return words[index(axis) % 3]; };
  const double a = a_, b = b_, top = along(axes_.normal) + (state_.incremental ? z_ : 0);
  const double a_beside = a + along(axes_.first), b_beside = b + along(axes_.second);
  const canon::SpindleTurn before = state_.spindles[static_cast<std::size_t>(spindle_)].turn;
  const auto orient = [&] {
    constexpr int clockwise = 2, counterclockwise = 3;  // as the control counts turns here
    turn(canon::SpindleTurn::stop);
    run_.emit(
        canon::OrientSpindle{
            spindle_, 0, before == canon::SpindleTurn::clockwise ? clockwise : counterclockwise},
        told("orient"));
  };
  move(true, a_beside, b_beside, c_, "beside the axis");
  orient();
  rapid_to(z_, "down");
  move(true, a, b, z_, "to the axis");
  turn(before);
  feed(top, "bore upwards");
  feed(z_, "back down");
  orient();
  move(true, a_beside, b_beside, z_, "beside the axis");
  rapid_to(clear_, "retract");
  move(true, a, b, clear_, "to the axis");
  turn(before);
}

// The control counts on the operator's hand: it goes on as if the tool were at the level of
// retraction.
void Cycle::bore_by_hand() {
  const canon::SpindleTurn before = state_.spindles[static_cast<std::size_t>(spindle_)].turn;
  drill(z_);
  dwell(state_.cycle.p);
  turn(canon::SpindleTurn::stop);
  run_.emit(canon::ProgramStop{}, told("stop"));
  turn(before);
  run_.warning(
      "manual_retract", run_.whole(),
      "G88 stops at the bottom for the operator to draw the tool out by hand, which is not "
      "in the program: the next move here begins at the bottom; use G86 or G89");
  c_ = clear_;
  state_.tip = tip_at(a_, b_, c_);
}

}  // namespace

void canned_cycle(const CodeRule& rule, BlockRun& run) { Cycle(rule, run).execute(); }

}  // namespace aircut::interp
