// G74 (pecks along Z), G75 (pecks along X) and G76 (a thread in many passes) of Fanuc-like turning
// centres. The first line of a pair holds what belongs to the tool, the second one the geometry.
//
// G74, G75: from the start the tool pecks to the depth, going back by R of the first line, moves
// aside by R of the second line at the bottom, returns, steps over, and so on to the end.
//
// G76: pass n lies Q·√n below the top of the thread, but at least the least cut deeper than the
// pass before; then come the finishing passes at the full depth P. The start of each pass moves
// along Z so that, with the angle of the thread, one flank does the cutting.
#include <algorithm>
#include <cmath>

#include "interp/codes/codes.h"
#include "interp/codes/lathe.h"
#include "interp/codes/turning.h"

namespace aircut::interp {
namespace {

constexpr int max_moves = 100'000;

// Values from `from` towards `to` in steps of `step`, the last one is `to`.
std::vector<double> steps(double from, double to, double step) {
  std::vector<double> values;
  const double way = to - from, sign = way < 0 ? -1 : 1;
  if (step > 0)
    for (int n = 1; n * step < std::fabs(way) - 1e-9; ++n) values.push_back(from + sign * n * step);
  values.push_back(to);
  return values;
}

class Grooving {
 public:
  Grooving(const CodeRule& rule, BlockRun& run)
      : rule_(rule),
        run_(run),
        motion_(
            rule, run,
            rule.code == 740 ? TurningMotion::Passes::along_z : TurningMotion::Passes::along_x) {}

  void execute();

 private:
  void peck(double aside, double start, double end, double step);

  const CodeRule& rule_;
  BlockRun& run_;
  TurningMotion motion_;
};

void Grooving::execute() {
  const bool along_z = rule_.code == 740;
  const PlanePoint start = lathe_position(run_), end = lathe_target(run_, start);
  const double from = along_z ? start.u : start.v, to = along_z ? end.u : end.v;
  const double side = along_z ? start.v : start.u, last_side = along_z ? end.v : end.u;
  // P counts along X, Q along Z.
  const double step = increments(run_, along_z ? 'Q' : 'P');
  const double across = increments(run_, along_z ? 'P' : 'Q');
  if (!lathe_words_given(run_, rule_, !along_z, along_z) || !feed_is_set(run_, rule_)) return;
  if (last_side != side && across <= 0)
    return run_.error(
        "word_missing", rule_,
        name_of(rule_) + " needs " + (along_z ? "P" : "Q") + " above 0: the step to the side");
  if (step <= 0)
    return run_.error(
        "word_missing", rule_,
        name_of(rule_) + " needs " + (along_z ? "Q" : "P") + " above 0: the depth of a peck");
  const double pecks = std::fabs(to - from) / step + 1;
  const double grooves = across > 0 ? std::fabs(last_side - side) / across + 1 : 1;
  if (2 * pecks * grooves > max_moves)
    return run_.error("limit_reached", rule_,
                      "this line would make more than 100000 moves; use larger steps");
  const double relief = run_.length('R') * (last_side > side ? -1 : 1);
  std::vector<double> sides = {side};
  if (last_side != side)
    for (const double at : steps(side, last_side, across)) sides.push_back(at);
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (i > 0) motion_.rapid({from, sides[i]}, "to the side");
    peck(sides[i], from, to, step);
    // The first groove has no room beside it yet.
    if (relief != 0 && i > 0) motion_.rapid({to, sides[i] + relief}, "off the wall");
    motion_.rapid({from, relief != 0 && i > 0 ? sides[i] + relief : sides[i]}, "out");
  }
  motion_.rapid({from, side}, "to the start");
}

void Grooving::peck(double aside, double start, double end, double step) {
  const double back = run_.state.turning.groove_escape * (end < start ? 1 : -1);
  for (const double depth : steps(start, end, step)) {
    motion_.feed({depth, aside}, "peck");
    if (depth != end && back != 0) motion_.rapid({depth + back, aside}, "chip break");
  }
}

struct ThreadWords {
  double height = 0, first = 0, least = 0, finish = 0, taper = 0, angle = 0;
  int finishing = 1;
  double chamfer = 0;  ///< at the end, leads
};

// `G76 P Q R` and then `G76 X Z R P Q F`, or all in one line with K, D and A.
std::optional<ThreadWords> thread_words(const CodeRule& rule, BlockRun& run) {
  const TurningState& kept = run.state.turning;
  ThreadWords words;
  words.least = kept.thread_least;
  words.finish = kept.thread_allowance;
  words.angle = kept.thread_angle;
  words.finishing = kept.thread_finishing;
  words.chamfer = kept.thread_chamfer / 10.0;
  const bool one_line = run.has('K');
  words.height = one_line ? run.length('K') : increments(run, 'P');
  words.first = increments(run, one_line ? 'D' : 'Q');
  words.taper = run.length(one_line ? 'I' : 'R');
  if (one_line) words.angle = run.number_or('A', 0) * radian_per_degree;
  if (one_line) words.finish = words.chamfer = 0;
  const auto fail = [&](const char* kind, Place place, const char* text) {
    run.error(kind, place, text);
    return std::nullopt;
  };
  if (!one_line && !run.has('P'))
    return fail("word_missing", run.place(rule),
                "G76 needs P: the height of the thread in least increments");
  if (!run.has(one_line ? 'D' : 'Q'))
    return fail("word_missing", run.place(rule),
                one_line ? "G76 needs D: the depth of the first pass"
                         : "G76 needs Q: the depth of the first pass in least increments");
  if (words.height <= 0)
    return fail("thread_error", run.place(one_line ? 'K' : 'P'),
                "the height of the thread must be above 0");
  if (words.first <= 0 || words.first > words.height)
    return fail("thread_error", run.place(one_line ? 'D' : 'Q'),
                "the first pass must be deeper than 0 and not deeper than the thread");
  if (words.finish >= words.height)
    return fail("thread_error", run.place(rule),
                "the finishing allowance (R of the first G76) must be smaller than the height");
  return words;
}

// The depths of all passes, from the top of the thread. Empty: too many.
std::vector<double> thread_depths(const ThreadWords& words) {
  const double rough = words.height - words.finish;
  std::vector<double> depths;
  double depth = 0;
  for (int n = 1; depth < rough - 1e-9; ++n) {
    if (n > max_moves / 5) return {};
    depth = std::max(words.first * std::sqrt(n), depth + words.least);
    depths.push_back(std::min(depth, rough));
  }
  const int finishing = words.finish > 0 ? words.finishing : words.finishing - 1;
  for (int i = 0; i < finishing; ++i) depths.push_back(words.height);
  return depths;
}

void cut_thread(const CodeRule& rule, BlockRun& run) {
  if (!lathe_words_given(run, rule, true, true)) return;
  if (!spindle_turns(run, rule, 0) || !feed_is_set(run, rule)) return;
  const auto words = thread_words(rule, run);
  if (!words) return;
  const PlanePoint start = lathe_position(run), root = lathe_target(run, start);
  const double dz = root.u - start.u;
  if (std::fabs(dz) < 1e-9)
    return run.error("thread_error", run.has('Z') ? 'Z' : 'W', "the thread has no length");
  const double outwards = start.v > root.v ? 1 : -1;
  const double along = std::max(std::fabs(dz), std::fabs(words->taper));
  const double pitch = run.state.feed * run.state.unit_mm();
  const double lead = pitch * std::hypot(dz, words->taper) / along;
  const auto depths = thread_depths(*words);
  if (depths.empty())
    return run.error("limit_reached", rule, "more than 20000 passes; use a larger first depth");
  TurningMotion motion(rule, run, TurningMotion::Passes::along_z);
  for (const double depth : depths) {
    const double above = outwards * (words->height - depth);
    const double along_flank = depth * std::tan(words->angle / 2) * (dz < 0 ? -1 : 1);
    const PlanePoint begin{start.u + along_flank, root.v + words->taper + above};
    motion.rapid({begin.u, start.v}, "start of a pass");
    motion.rapid(begin, "to depth");
    // The chamfer at the end leaves the thread at 45 degrees, turning on with the spindle.
    const double slope = -words->taper / (root.u - begin.u);
    const double out = std::min(
        {words->chamfer * pitch, std::fabs(root.u - begin.u), std::fabs(start.v - root.v - above)});
    const double last = root.u - (dz < 0 ? -out : out);
    const double bottom = root.v + above + slope * (last - root.u);
    motion.thread({last, bottom}, lead, 0, "thread");
    if (out > 0)
      motion.thread({root.u, bottom + outwards * out}, pitch * std::sqrt(2), 0, "chamfer");
    motion.rapid({root.u, start.v}, "out");
    motion.rapid(start, "back");
  }
}

// `G76 P mm rr aa Q R`: six digits of P are the finishing passes, the chamfer and the angle.
void keep_thread_words(BlockRun& run) {
  TurningState& kept = run.state.turning;
  if (run.has('P')) {
    const auto p = run.integer('P', 0, 999'999);
    if (!p) return;
    kept.thread_finishing = std::max(1, *p / 10'000);
    kept.thread_chamfer = *p / 100 % 100;
    kept.thread_angle = *p % 100 * radian_per_degree;
  }
  if (run.has('Q')) kept.thread_least = increments(run, 'Q');
  if (run.has('R')) kept.thread_allowance = run.length('R');
}

}  // namespace

void lathe_groove(const CodeRule& rule, BlockRun& run) {
  if (!run.has_axis_words()) {
    if (!run.has('R'))
      return run.error("word_missing", rule,
                       name_of(rule) + " needs X or Z, or in its first line R: the way back");
    run.state.turning.groove_escape = std::fabs(run.length('R'));
    return;
  }
  Grooving(rule, run).execute();
}

void lathe_thread_cycle(const CodeRule& rule, BlockRun& run) {
  if (run.has_axis_words()) return cut_thread(rule, run);
  keep_thread_words(run);
}

}  // namespace aircut::interp
