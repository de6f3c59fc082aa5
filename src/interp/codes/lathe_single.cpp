// One-pass cycles of Fanuc-like turning centres, and the codes that lathes have of their own.
//
//        4 ◄─────────── ● start        G90: 1 rapid to X, 2 feed to Z, 3 feed out, 4 rapid back
//        ▼              │ 1            G92: the same, 2 is a thread, 3 and 4 are rapid
//   ─────●◄─────────────▼              G94: 1 rapid to Z, 2 feed to X, 3 feed out, 4 rapid back
//        3      2
//
// R makes 2 a cone: it is the radius (G94: Z) of its start less that of its end. X, Z and R stay in
// force until another code of the motion group.
#include <cmath>

#include "interp/codes/codes.h"
#include "interp/codes/lathe.h"
#include "interp/codes/turning.h"

namespace aircut::interp {

PlanePoint lathe_position(const BlockRun& run) {
  const AxisValues at = to_program(run.state, run.state.tip);
  return {at[Axis::z], at[Axis::x]};
}

PlanePoint lathe_target(const BlockRun& run, PlanePoint from) {
  PlanePoint to = from;
  if (const auto x = run.axis(Axis::x)) to.v = *x;
  if (const auto z = run.axis(Axis::z)) to.u = *z;
  if (const auto u = run.increment(Axis::x)) to.v = from.v + *u;
  if (const auto w = run.increment(Axis::z)) to.u = from.u + *w;
  return to;
}

double increments(const BlockRun& run, char letter) {
  const Word* word = run.block.find(letter);
  if (!word) return 0;
  const double unit = run.state.unit_mm();
  const bool inch = run.state.unit == canon::Unit::inch;
  if (!word->no_point) return word->number * unit;
  return word->number * unit / (inch ? 10'000 : 1000);
}

bool lathe_words_given(BlockRun& run, const CodeRule& rule, bool x, bool z) {
  if (x && !run.has('X') && !run.has('U')) {
    run.error("word_missing", rule, name_of(rule) + " needs X or U");
    return false;
  }
  if (z && !run.has('Z') && !run.has('W')) {
    run.error("word_missing", rule, name_of(rule) + " needs Z or W");
    return false;
  }
  if (run.state.comp.side == CompSide::off) return true;
  run.error("comp_illegal", rule,
            name_of(rule) + " can't be used while radius compensation is on; give G40 before");
  return false;
}

void single_pass(const CodeRule& rule, BlockRun& run) {
  TurningState& kept = run.state.turning;
  const PlanePoint start = lathe_position(run);
  if (kept.code != rule.code) {
    kept.code = rule.code;
    kept.end = start;
    kept.taper = 0;
    if (!lathe_words_given(run, rule, true, true)) return;
  }
  const PlanePoint named = lathe_target(run, start);
  if (run.has('X') || run.has('U')) kept.end.v = named.v;
  if (run.has('Z') || run.has('W')) kept.end.u = named.u;
  if (run.has('R')) kept.taper = run.length('R');
  if (!lathe_words_given(run, rule, false, false)) return;
  const PlanePoint end = kept.end;
  TurningMotion motion(rule, run, TurningMotion::Passes::along_z);
  if (rule.code == 920) {
    if (!spindle_turns(run, rule, 0) || !feed_is_set(run, rule)) return;
    const double dz = end.u - start.u, dx = kept.taper;
    const double along = std::max(std::fabs(dz), std::fabs(dx));
    if (along < 1e-9)
      return run.error("thread_error", rule, "the thread of G92 has no length; give another Z");
    // F is the lead along the longer axis; the command wants it along the way.
    const double lead = run.state.feed * run.state.unit_mm() * std::hypot(dz, dx) / along;
    motion.rapid({start.u, end.v + kept.taper}, "to depth");
    motion.thread(end, lead, 0, "thread");
    motion.rapid({end.u, start.v}, "out");
  } else if (!feed_is_set(run, rule)) {
    return;
  } else if (rule.code == 940) {
    motion.rapid({end.u + kept.taper, start.v}, "to depth");
    motion.feed(end, "face");
    motion.feed({start.u, end.v}, "out");
  } else {
    motion.rapid({start.u, end.v + kept.taper}, "to depth");
    motion.feed(end, "turn");
    motion.feed({end.u, start.v}, "out");
  }
  motion.rapid(start, "back");
}

// G32 and G33: F is the lead along the axis that moves farther.
void lathe_thread(const CodeRule& rule, BlockRun& run) {
  if (!run.has_axis_words())
    return run.error("axis_word_missing", rule, name_of(rule) + " needs X or Z");
  if (!spindle_turns(run, rule, 0) || !feed_is_set(run, rule)) return;
  const auto end = target_of(run);
  if (!end) return;
  const double dx = (*end)[Axis::x] - run.state.tip[Axis::x];
  const double dz = (*end)[Axis::z] - run.state.tip[Axis::z];
  const double along = std::max(std::fabs(dx), std::fabs(dz));
  if (along < 1e-9)
    return run.error("thread_error", rule, "the thread ends where it begins; give another X or Z");
  canon::SyncFeed move;
  move.end = *end;
  move.per_revolution = run.state.feed * run.state.unit_mm() * std::hypot(dx, dz) / along;
  run.emit(std::move(move));
  run.state.tip = *end;
}

void lathe_feed_mode(const CodeRule& rule, BlockRun& run) {
  run.state.feed_mode =
      rule.code == 980 ? canon::FeedMode::per_minute : canon::FeedMode::per_revolution;
  run.state.feed = 0;
  run.emit(canon::SetFeedMode{run.state.feed_mode});
  run.emit(canon::SetFeedRate{});
}

// G50 S: the highest speed that G96 may ask for. G50 X Z: coordinates of the point where the tool
// stands, as G92 of machining centres.
void speed_limit(const CodeRule& rule, BlockRun& run) {
  if (run.has_axis_words()) {
    coordinate_shift(rule, run);
    if (!run.has('S') || !run.ok()) return;
  }
  if (!run.has('S')) return run.error("word_missing", rule, "G50 needs S: the highest speed");
  const double limit = *run.number('S');
  if (limit <= 0)
    return run.error("word_value", 'S', "S of G50, the highest speed, must be above 0");
  SpindleState& spindle = run.state.spindles[0];
  spindle.css_limit = limit;
  if (spindle.css) run.emit(canon::SetSpindleMode{0, limit});
}

void lathe_surface_speed(const CodeRule& rule, BlockRun& run) {
  if (!run.has('S')) return run.error("word_missing", rule, "G96 needs S: the surface speed");
  SpindleState& spindle = run.state.spindles[0];
  spindle.css = true;
  run.emit(canon::SetSpindleMode{0, spindle.css_limit > 0 ? spindle.css_limit : 1e30});
}

}  // namespace aircut::interp
