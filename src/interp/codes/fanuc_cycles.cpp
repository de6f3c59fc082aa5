// Canned cycles of Fanuc-like machining centres. They differ from LinuxCNC's (cycles.cpp):
//
//   * R, Z, P and Q stay until G80 or a motion code, also when the cycle changes;
//   * the initial level is where the group of cycles began; with G91 R counts from it and Z from R;
//   * the way to the hole comes first, at the level in force, then the way to R;
//   * K (Haas: L) repeats; with 0 the words are only stored; P is milliseconds;
//   * G85 and G89 feed back to R and go on in rapid; taps feed back to R only.
//
// G76 and G87 turn the spindle to a fixed angle and shift the tool by Q away from the wall: along
// the first axis of the plane, or by I and J.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/text.h"
#include "interp/codes/codes.h"
#include "interp/codes/hole_motion.h"

namespace aircut::interp {
namespace {

constexpr int max_moves = 100'000;           // of one line, so that it can't fill the memory
constexpr double default_clearance = 0.254;  // mm, of G73 and G83 without a setting

class FanucCycle : private HoleMotion {
 public:
  FanucCycle(const CodeRule& rule, BlockRun& run) : HoleMotion(rule, run) {}
  void execute();
  /// Cycles at given points of the plane, for patterns.
  bool ready();
  void at(double a, double b, int number, int count);

 private:
  bool allowed();
  bool store_words();
  bool words_fit();
  std::optional<int> repeats();
  bool hole_place(double& a, double& b);
  bool spindle_fits();
  bool levels();
  bool count_moves(int repeats);
  void body();
  void peck_down();
  void tap();
  void rigid_tap(double pitch);
  void fine_bore();
  void back_bore();
  void shift(double direction, const char* what);
  void orient();
  void back_to_clear(const char* what) {
    if (c_ < clear_ || c_ > clear_) rapid_to(clear_, what);
  }

  bool haas() const { return run_.session.options.dialect == Dialect::haas; }
  bool pecks() const { return rule_.code == 730 || rule_.code == 830; }
  bool taps() const { return rule_.code == 740 || rule_.code == 1840 || rule_.code / 10 == 84; }
  bool taps_left() const { return rule_.code == 740 || rule_.code == 843 || rule_.code == 1840; }
  bool shifts() const { return rule_.code == 760 || rule_.code == 870 || rule_.code == 770; }
  bool is_back_bore() const { return rule_.code == 870 || rule_.code == 770; }

  double r_ = 0, z_ = 0, clear_ = 0;
};

bool FanucCycle::allowed() {
  if (state_.comp.side != CompSide::off)
    run_.error("comp_illegal", rule_,
               "canned cycles can't be used while radius compensation is on; give G40 before");
  else if (state_.feed_mode == canon::FeedMode::inverse_time)
    run_.error("cycle_error", rule_, "canned cycles can't be used with G93; give G94 or G95");
  else if (run_.machine_coordinates)
    run_.error("g53_error", rule_, "canned cycles can't be used with G53");
  return run_.ok() && frame_allows_cycle(run_, rule_);
}

bool FanucCycle::store_words() {
  CycleState& cycle = state_.cycle;
  if (cycle.code == 0) {
    cycle = CycleState{};
    cycle.initial = c_;
  }
  cycle.code = rule_.code;
  if (run_.has('R')) {
    cycle.r = run_.length('R');
    cycle.has_r = true;
  }
  if (const auto z = run_.axis(axes_.normal)) {
    cycle.z = *z;
    cycle.has_z = true;
  }
  if (run_.has('Q')) {
    cycle.q = std::fabs(run_.length('Q'));  // the sign does not count
    cycle.has_q = true;
  }
  if (run_.has('P')) {
    if (*run_.number('P') < 0) {
      run_.error("dwell_time", 'P', "the dwell P of a cycle can't be negative");
      return false;
    }
    cycle.p = dwell_seconds(run_, 'P');
  }
  if (run_.has('I')) cycle.i = run_.length('I');
  if (run_.has('J')) cycle.j = taps() ? *run_.number('J') : run_.length('J');
  if (haas() && pecks() && run_.has('K')) cycle.k = run_.length('K');
  return true;
}

bool FanucCycle::words_fit() {
  const CycleState& cycle = state_.cycle;
  const auto missing = [&](char letter, const char* what) {
    run_.error("word_missing", rule_,
               name_of(rule_) + " needs " + std::string(1, letter) + ": " + what);
    return false;
  };
  if (!cycle.has_z) return missing(letter(axes_.normal), "the bottom of the hole");
  if (!cycle.has_r) return missing('R', "the level from which it feeds");
  if (pecks() && !(haas() && cycle.i > 0)) {
    if (!cycle.has_q) return missing('Q', "the depth of a peck");
    if (cycle.q == 0) {
      run_.error("word_value", 'Q', "Q, the depth of a peck, can't be 0");
      return false;
    }
  }
  if (pecks() && haas() && cycle.i > 0 && cycle.k <= 0)
    return missing('K', "the smallest peck, when I and J make the pecks smaller and smaller");
  if (shifts() && !cycle.has_q && cycle.i == 0 && cycle.j == 0)
    return missing('Q', "the shift away from the wall");
  return true;
}

// K, on Haas L. Nothing with an error.
std::optional<int> FanucCycle::repeats() {
  const char letter = haas() || run_.has('L') ? 'L' : 'K';
  if (!run_.has(letter)) return 1;
  return run_.integer(letter, 0, 99'999);
}

bool FanucCycle::spindle_fits() {
  using Turn = canon::SpindleTurn;
  const SpindleState& spindle = state_.spindles[0];
  const bool rigid = state_.rigid_tapping || haas() || rule_.code == 842 || rule_.code == 843;
  if (taps() && rigid) {
    if (spindle.speed > 0 && !spindle.css) return true;
    run_.error("spindle_stopped", rule_,
               name_of(rule_) + " turns the spindle with the feed and needs its speed; give G97 S");
    return false;
  }
  const Turn needed = taps_left() ? Turn::counterclockwise : Turn::clockwise;
  if (taps() && spindle.turn != needed) {
    run_.error(
        "spindle_stopped", rule_,
        name_of(rule_) + " needs the spindle turning " +
            (taps_left() ? "counter-clockwise; give M4 before" : "clockwise; give M3 before"));
    return false;
  }
  if ((rule_.code == 860 || shifts()) && spindle.turn == Turn::stop) {
    run_.error("spindle_stopped", rule_,
               name_of(rule_) + " needs a turning spindle; give M3 or M4 before");
    return false;
  }
  return true;
}

bool FanucCycle::levels() {
  const CycleState& cycle = state_.cycle;
  r_ = state_.incremental ? cycle.initial + cycle.r : cycle.r;
  z_ = state_.incremental ? r_ + cycle.z : cycle.z;
  const Place at = run_.has('R') ? run_.place('R') : run_.place(rule_);
  const std::string r = fixed(r_, 4) + " mm", z = fixed(z_, 4) + " mm";
  if (is_back_bore() ? r_ > z_ : r_ < z_) {
    run_.error(
        "cycle_error", at,
        is_back_bore()
            ? "R (" + r + ") is above Z (" + z + "); back boring feeds upwards from R to Z"
            : "the bottom of the hole (" + z + ") is above R (" + r + "); R must be above it");
    return false;
  }
  // Back boring always returns to the initial level: R is below the part.
  clear_ = state_.retract_to_r && !is_back_bore() ? r_ : std::max(r_, cycle.initial);
  return true;
}

bool FanucCycle::count_moves(int repeats) {
  double per_hole = 12;
  const double step = haas() && state_.cycle.i > 0 ? state_.cycle.k : state_.cycle.q;
  if (pecks()) per_hole += 3 * (r_ - z_) / step;
  if (per_hole * repeats <= max_moves) return true;
  run_.error("limit_reached", rule_,
             "this line would make more than 100000 moves; use less repeats or a larger Q");
  return false;
}

bool FanucCycle::ready() {
  return allowed() && words_fit() && feed_is_set(run_, rule_) && spindle_fits() && levels();
}

void FanucCycle::execute() {
  if (!allowed() || !store_words()) return;
  const auto count = repeats();
  if (!count || *count == 0) return;  // 0: the words are only stored
  if (!run_.has_axis_words() && !run_.has('R')) return;
  if (!ready() || !count_moves(*count)) return;
  for (int i = 1; i <= *count && run_.ok(); ++i) {
    double a = a_, b = b_;
    if (hole_place(a, b)) at(a, b, i, *count);
  }
}

// Where the words put the next hole.
bool FanucCycle::hole_place(double& a, double& b) {
  if (state_.polar.on) {
    const AxisValues from = to_program(state_, state_.tip);
    AxisValues to = from;
    if (!place_polar(run_, from, to)) return false;
    a = to[axes_.first];
    b = to[axes_.second];
    return true;
  }
  if (const auto value = run_.axis(axes_.first)) a = state_.incremental ? a_ + *value : *value;
  if (const auto value = run_.axis(axes_.second)) b = state_.incremental ? b_ + *value : *value;
  return true;
}

void FanucCycle::at(double a, double b, int number, int count) {
  name_hole(number, count);
  move(true, a, b, c_, "to the hole");
  if (is_back_bore()) return back_bore();
  if (c_ < r_ || c_ > r_) rapid_to(r_, "to R");
  body();
}

void FanucCycle::body() {
  const canon::SpindleTurn turning = state_.spindles[0].turn;
  if (pecks()) return peck_down();
  if (taps()) return tap();
  if (rule_.code == 760) return fine_bore();
  feed(z_, "drill");
  switch (rule_.code) {
    case 820:
      if (state_.cycle.p > 0) dwell(state_.cycle.p);
      break;
    case 850:
      feed(r_, "back to R");
      break;
    case 860:
      turn(canon::SpindleTurn::stop);
      back_to_clear("retract");
      turn(turning);
      return;
    case 890:
      if (state_.cycle.p > 0) dwell(state_.cycle.p);
      feed(r_, "back to R");
      break;
    default:
      break;
  }
  back_to_clear("retract");
}

// With I, J and K (Haas) the first peck is I, each is smaller by J than the one before, none is
// smaller than K.
void FanucCycle::peck_down() {
  const Options& options = run_.session.options;
  const CycleState& cycle = state_.cycle;
  const bool full = rule_.code == 830;
  double clearance = full ? options.g83_clearance : options.g73_clearance;
  if (clearance <= 0) clearance = default_clearance;
  const bool shrinking = haas() && cycle.i > 0;
  double step = shrinking ? cycle.i : cycle.q, done = 0;
  const auto next = [&] {
    done += step;
    if (shrinking) step = std::max(step - cycle.j, cycle.k);
    return r_ - done;
  };
  for (double depth = next(); depth > z_ + 1e-9; depth = next()) peck(depth, full, r_, clearance);
  feed(z_, "peck");
  if (cycle.p > 0) dwell(cycle.p);
  back_to_clear("retract");
}

void FanucCycle::tap() {
  using Kind = canon::Override::Kind;
  using Turn = canon::SpindleTurn;
  const SpindleState& spindle = state_.spindles[0];
  const Turn forward = taps_left() ? Turn::counterclockwise : Turn::clockwise;
  const Turn back = taps_left() ? Turn::clockwise : Turn::counterclockwise;
  const bool rigid = state_.rigid_tapping || haas() || rule_.code == 842 || rule_.code == 843;
  if (rigid) {
    const double feed_mm = state_.feed * state_.unit_mm();
    const bool per_rev = state_.feed_mode == canon::FeedMode::per_revolution;
    if (spindle.turn != forward) turn(forward);
    rigid_tap(per_rev ? feed_mm : feed_mm / spindle.speed);
    if (spindle.turn != forward) turn(spindle.turn);
    return back_to_clear("retract");
  }
  run_.emit(canon::Override{Kind::feed, false, 0});
  run_.emit(canon::Override{Kind::speed, false, 0});
  feed(z_, "tap");
  turn(Turn::stop);
  if (state_.cycle.p > 0) dwell(state_.cycle.p);
  turn(back);
  feed(r_, "back out");
  turn(Turn::stop);
  if (state_.cycle.p > 0) dwell(state_.cycle.p);
  turn(forward);
  if (state_.feed_override) run_.emit(canon::Override{Kind::feed, true, 0});
  if (spindle.override_on) run_.emit(canon::Override{Kind::speed, true, 0});
  back_to_clear("retract");
}

// The tap goes to Z and back to R, turning with the feed. J (Haas) is the speed of the way back.
void FanucCycle::rigid_tap(double pitch) {
  canon::SyncFeed sync;
  sync.end = tip_at(a_, b_, z_);
  sync.per_revolution = pitch;
  sync.rigid_tap = true;
  sync.return_factor = state_.cycle.j >= 1 ? state_.cycle.j : 1;
  run_.emit(std::move(sync), told("tap"));
}

void FanucCycle::orient() {
  run_.emit(canon::OrientSpindle{0, 0, 0}, told("spindle to its angle"));
}

// Away from the wall (+1) and back (−1).
void FanucCycle::shift(double direction, const char* what) {
  const CycleState& cycle = state_.cycle;
  const bool by_words = cycle.i != 0 || cycle.j != 0;
  const double da = by_words ? cycle.i : cycle.q, db = by_words ? cycle.j : 0;
  move(true, a_ + direction * da, b_ + direction * db, c_, what);
}

void FanucCycle::fine_bore() {
  const canon::SpindleTurn turning = state_.spindles[0].turn;
  feed(z_, "bore");
  if (state_.cycle.p > 0) dwell(state_.cycle.p);
  orient();
  shift(1, "away from the wall");
  back_to_clear("retract");
  shift(-1, "back to the middle");
  turn(turning);
}

// Through the hole with the tool off centre, then upwards to Z with the spindle turning.
void FanucCycle::back_bore() {
  const canon::SpindleTurn turning = state_.spindles[0].turn;
  orient();
  shift(1, "away from the wall");
  rapid_to(r_, "through the hole");
  shift(-1, "to the middle");
  turn(turning);
  feed(z_, "bore upwards");
  if (state_.cycle.p > 0) dwell(state_.cycle.p);
  orient();
  shift(1, "away from the wall");
  rapid_to(clear_, "retract");
  shift(-1, "back to the middle");
  turn(turning);
}

}  // namespace

bool is_count_of_cycle(const BlockRun& run, char letter) {
  if (letter != 'K' && letter != 'Q' && letter != 'R') return false;
  const CodeRule* cycle = nullptr;
  bool moves = false;
  for (const Word& word : run.block.words) {
    if (!word.rule) continue;
    moves = moves || word.rule->group == ModalGroup::motion;
    if (word.rule->handler == fanuc_cycle || word.rule->handler == lathe_roughing ||
        word.rule->handler == lathe_groove || word.rule->handler == lathe_thread_cycle)
      cycle = word.rule;
  }
  if (!cycle && !moves && run.state.cycle.code != 0)
    cycle = run.session.table.find_g(run.state.cycle.code);
  if (!cycle) return false;
  if (cycle->handler == fanuc_cycle)
    return letter == 'K' && run.session.options.dialect == Dialect::fanuc;
  // Numbers of blocks, and the passes of G73; P and Q of the others are least increments.
  if (cycle->handler == lathe_roughing)
    return letter == 'Q' || (letter == 'R' && cycle->code == 730);
  return letter == 'Q';
}

// Haas reads a P with a decimal point as seconds.
double dwell_seconds(const BlockRun& run, char letter) {
  const Word* word = run.block.find(letter);
  if (!word) return 0;
  const bool seconds = run.session.options.dialect == Dialect::haas && !word->no_point;
  return seconds ? word->number : word->number / 1000;
}

void fanuc_cycle(const CodeRule& rule, BlockRun& run) { FanucCycle(rule, run).execute(); }

void manual_cycle(const CodeRule& rule, BlockRun& run) {
  run.error("unsupported_code", rule,
            name_of(rule) +
                " stops at the bottom and waits for the operator to draw the tool out "
                "by hand, so its motion is not in the program; use G86 or G89");
}

void rigid_tapping(const CodeRule&, BlockRun& run) { run.state.rigid_tapping = true; }

// Haas G70, G71, G72: the cycle in force at points on a circle, an arc, or a line that begins at
// the tool.
void hole_pattern(const CodeRule& rule, BlockRun& run) {
  const CodeRule* cycle = run.session.table.find_g(run.state.cycle.code);
  if (!cycle || run.state.cycle.code == 0)
    return run.error("cycle_error", rule,
                     name_of(rule) + " repeats a canned cycle; give one before, with L0");
  for (const char word : {'I', 'L'})
    if (!run.has(word))
      return run.error("word_missing", rule,
                       name_of(rule) + (word == 'I' ? " needs I: the radius or the distance"
                                                    : " needs L: the number of holes"));
  if (rule.code == 710 && !run.has('K'))
    return run.error("word_missing", rule, "G71 needs K: the angle from hole to hole");
  const auto count = run.integer('L', 1, 10'000);
  if (!count) return;
  const auto start = target_of(run);
  if (!start) return;
  FanucCycle holes(*cycle, run);
  if (!holes.ready()) return;
  const PlaneAxes axes = axes_of(run.state.plane);
  const AxisValues centre = to_program(run.state, *start);
  const double a = centre[axes.first], b = centre[axes.second], i = run.length('I');
  const double first = run.number_or('J', 0) * radian_per_degree;
  for (int n = 0; n < *count && run.ok(); ++n) {
    const double step = rule.code == 700 ? 2 * std::numbers::pi / *count
                                         : run.number_or('K', 0) * radian_per_degree;
    const double angle = rule.code == 720 ? first : first + n * step;
    const double radius = rule.code == 720 ? n * i : i;
    holes.at(a + radius * std::cos(angle), b + radius * std::sin(angle), n + 1, *count);
  }
}

}  // namespace aircut::interp
