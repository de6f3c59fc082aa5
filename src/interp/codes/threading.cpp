// G76, a thread cut in several passes. X is radial; the drive line is where the tool stands.
//
//        drive line  ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─    x₀, from z₀ to Z
//   |I|              peak of the thread           x₀ + s·|I|        s = −1 outside, +1 inside
//   dₙ               pass n                       x₀ + s·(|I| + dₙ),  dₙ = J·n^(1/R), at most K
//
// With the infeed angle Q pass n begins dₙ·tan(Q) earlier and ends (K − dₙ)·tan(Q) before Z, so
// that one flank does the cutting. A taper (L, length E) leads in or out over the depth K; there
// the pitch is stretched so that the spindle still turns at the same rate along Z.
#include <algorithm>
#include <cmath>

#include "interp/codes/codes.h"
#include "interp/codes/turning.h"

namespace aircut::interp {
namespace {

constexpr int max_passes = 10'000;

class Thread {
 public:
  Thread(const CodeRule& rule, BlockRun& run) : rule_(rule), run_(run), state_(run.state) {}
  void execute();

 private:
  bool read_words();
  void pass(double depth);
  void rapid(double x, double z, const char* what);
  void feed(double x, double z, double pitch);

  const CodeRule& rule_;
  BlockRun& run_;
  ModalState& state_;
  AxisValues start_;  // program coordinates
  double x0_ = 0, z0_ = 0, z_end_ = 0;
  double x_end_ = 0;  // the drive line, or the X word: where the cycle ends
  double pitch_ = 0, peak_ = 0, first_ = 0, full_ = 0, degression_ = 1, tan_q_ = 0, taper_ = 0;
  double sign_ = 1;
  bool taper_in_ = false, taper_out_ = false;
  int spring_passes_ = 0;
  int spindle_ = 0;
};

bool Thread::read_words() {
  const auto fail = [&](const char* kind, Place place, const char* text) {
    run_.error(kind, place, text);
    return false;
  };
  const Place here = run_.place(rule_);
  if (state_.comp.side != CompSide::off)
    return fail("comp_illegal", here, "G76 can't be used while radius compensation is on");
  if (!run_.has_axis_words() || !run_.has('Z'))
    return fail("word_missing", here, "G76 needs Z: the end of the thread");
  for (const Axis axis : all_axes)
    if (axis != Axis::x && axis != Axis::z && run_.has(letter(axis)))
      return fail("thread_error", run_.place(letter(axis)), "G76 moves X and Z only");
  if (!run_.has('P')) return fail("word_missing", here, "G76 needs P: the pitch of the thread");
  for (const char word : {'I', 'J', 'K'})
    if (!run_.has(word))
      return fail("word_missing", here,
                  "G76 needs I (way to the thread's peak), J (first depth) and K (full depth)");
  const double diameter = state_.lathe_diameter ? 0.5 : 1;
  pitch_ = run_.length('P');
  peak_ = std::fabs(run_.length('I')) * diameter;
  first_ = run_.length('J') * diameter;
  full_ = run_.length('K') * diameter;
  sign_ = run_.length('I') > 0 ? 1 : -1;
  degression_ = std::max(1.0, run_.number_or('R', 1));
  const double angle = run_.number_or('Q', 0);
  taper_ = run_.length('E');
  if (pitch_ <= 0)
    return fail("thread_error", run_.place('P'),
                "P of G76, the distance per revolution, must be above 0, or the cut never ends");
  if (peak_ == 0)
    return fail("thread_error", run_.place('I'),
                "I of G76 can't be 0; negative is an outside, positive an inside thread");
  if (first_ <= 0) return fail("thread_error", run_.place('J'), "J of G76 must be above 0");
  if (full_ <= first_)
    return fail("thread_error", run_.place('K'), "K of G76, the full depth, must be above J");
  if (std::fabs(angle) >= 90)
    return fail("thread_error", run_.place('Q'), "Q of G76 must be between -90 and 90 degrees");
  tan_q_ = std::tan(angle * radian_per_degree);
  if (run_.has('H')) {
    const auto h = run_.integer('H', 0, 1000);
    if (!h) return false;
    spring_passes_ = *h;
  }
  if (run_.has('L')) {
    const auto l = run_.integer('L', 0, 3);
    if (!l) return false;
    taper_in_ = (*l & 1) != 0;
    taper_out_ = (*l & 2) != 0;
  }
  if ((taper_in_ || taper_out_) && taper_ <= 0) {
    run_.warning("word_ignored", run_.place('L'),
                 "the control makes no taper (L) without E above 0, its length; add E or leave L "
                 "out");
    taper_in_ = taper_out_ = false;
  }
  if (!(taper_in_ || taper_out_)) taper_ = 0;
  const auto spindle = spindle_of(run_, 0);
  if (!spindle) return false;
  spindle_ = *spindle;
  if (state_.spindles[static_cast<std::size_t>(spindle_)].turn == canon::SpindleTurn::stop)
    return fail("spindle_stopped", here, "G76 needs a turning spindle; give M3 or M4 before");
  return true;
}

void Thread::execute() {
  if (!read_words()) return;
  start_ = to_program(state_, state_.tip);
  x0_ = start_[Axis::x];
  z0_ = start_[Axis::z];
  z_end_ = *run_.axis(Axis::z) + (state_.incremental ? z0_ : 0);
  const auto x = run_.axis(Axis::x);
  x_end_ = !x ? x0_ : *x + (state_.incremental ? x0_ : 0);
  const double tapers = (taper_in_ ? taper_ : 0) + (taper_out_ ? taper_ : 0);
  if (tapers > std::fabs(z_end_ - z0_))
    return run_.error("thread_error", 'E',
                      "the tapers of the thread are longer than the thread itself");
  if (std::pow(full_ / first_, degression_) > max_passes)
    return run_.error("limit_reached", 'J', "more than 10000 passes; use a larger J");
  // Counted in the numbers of the words: whether a pass meets the full depth, as 3 × 0.3 does 0.9,
  // is left to rounding on the control too.
  const double to_number = (state_.lathe_diameter ? 0.5 : 1);
  const double first = *run_.number('J') * to_number, full = *run_.number('K') * to_number;
  const double peak = std::fabs(*run_.number('I')) * to_number;  // depths count from the drive line
  for (int n = 1; n <= max_passes; ++n) {
    const double depth = first * std::pow(n, 1 / degression_);
    if (peak + depth >= peak + full) break;
    pass(depth * state_.unit_mm());
  }
  for (int i = 0; i <= spring_passes_; ++i) pass(full_);
  rapid(x_end_, z_end_, "end");
}

void Thread::pass(double depth) {
  const double clear = x0_ - sign_ * (full_ - depth);
  const double cut = x0_ + sign_ * (peak_ + depth);
  const double tapered = cut - sign_ * full_;
  const double begin = z0_ - depth * tan_q_;
  const double end = z_end_ + (full_ - depth) * tan_q_;
  // Along a taper the way is longer than its part along Z.
  const double stretched = taper_ > 0 ? pitch_ * std::hypot(taper_, full_) / taper_ : pitch_;
  const double way = end < begin ? -1 : 1;
  rapid(clear, begin, "start of a pass");
  if (!taper_in_) rapid(cut, begin, "to depth");
  run_.emit(canon::Override{canon::Override::Kind::feed, false, 0});
  if (taper_in_) {
    feed(tapered, begin, stretched);
    feed(cut, begin + way * taper_, stretched);
  }
  feed(cut, taper_out_ ? end - way * taper_ : end, pitch_);
  if (taper_out_) feed(tapered, end, stretched);
  rapid(clear, end, "out");
  // The control switches it on even when it was off before.
  run_.emit(canon::Override{canon::Override::Kind::feed, true, 0});
  state_.thread_override = true;
  state_.comp.leaving = state_.comp.entered;
}

void Thread::rapid(double x, double z, const char* what) {
  state_.tip = tip_in_zx(state_, x, z);
  run_.emit(canon::Rapid{state_.tip}, std::string("G76 ") + what);
}

void Thread::feed(double x, double z, double pitch) {
  state_.tip = tip_in_zx(state_, x, z);
  canon::SyncFeed move;
  move.end = state_.tip;
  move.per_revolution = pitch;
  move.spindle = spindle_;
  run_.emit(std::move(move), "G76 cut");
}

}  // namespace

void thread_cycle(const CodeRule& rule, BlockRun& run) { Thread(rule, run).execute(); }

}  // namespace aircut::interp
