// Spindle: S, G96 G97, M3 M4 M5 M19, each with $ for one of several spindles.
#include <cmath>

#include "base/text.h"
#include "interp/codes/codes.h"

namespace aircut::interp {
namespace {

struct SpindleRange {
  int first = 0, last = 0;
};

// `$-1` means every spindle, no `$` at all the first.
std::optional<SpindleRange> spindles_of(BlockRun& run) {
  const int count = run.session.options.spindles;
  if (!run.has('$')) return SpindleRange{0, 0};
  const auto index = run.integer('$', -1, count - 1, "spindle_unknown");
  if (!index) return std::nullopt;
  if (*index == -1) return SpindleRange{0, count - 1};
  return SpindleRange{*index, *index};
}

SpindleState& spindle_at(BlockRun& run, int index) {
  return run.state.spindles[static_cast<std::size_t>(index)];
}

}  // namespace

std::optional<int> spindle_of(BlockRun& run, int otherwise) {
  if (!run.has('$')) return otherwise;
  return run.integer('$', 0, run.session.options.spindles - 1, "spindle_unknown");
}

// With G96 S is a surface speed: m/min with G21, feet/min with G20.
void speed_word(BlockRun& run) {
  const double value = *run.number('S');
  if (value < 0) return run.error("word_value", 'S', "S, the spindle speed, can't be negative");
  const auto range = spindles_of(run);
  if (!range) return;
  for (int i = range->first; i <= range->last; ++i) {
    SpindleState& spindle = spindle_at(run, i);
    spindle.speed = value;
    const bool feet = spindle.css && run.state.unit == canon::Unit::inch;
    run.emit(canon::SetSpindleSpeed{i, feet ? value * 0.3048 : value});
  }
}

void spindle_mode(const CodeRule& rule, BlockRun& run) {
  const auto range = spindles_of(run);
  if (!range) return;
  double limit = 0;
  if (rule.code == 960) {
    if (!run.has('S')) return run.error("word_missing", rule, "G96 needs S: the surface speed");
    limit = std::fabs(run.number_or('D', no_css_limit));
    if (limit == 0)
      return run.error("word_value", 'D', "D, the highest spindle speed, must be above 0");
  }
  for (int i = range->first; i <= range->last; ++i) {
    spindle_at(run, i).css = rule.code == 960;
    spindle_at(run, i).css_limit = limit;
    run.emit(canon::SetSpindleMode{i, limit});
  }
}

void spindle_turn(const CodeRule& rule, BlockRun& run) {
  const auto range = spindles_of(run);
  if (!range) return;
  const canon::SpindleTurn turn = rule.code == 3   ? canon::SpindleTurn::clockwise
                                  : rule.code == 4 ? canon::SpindleTurn::counterclockwise
                                                   : canon::SpindleTurn::stop;
  for (int i = range->first; i <= range->last; ++i) {
    spindle_at(run, i).turn = turn;
    canon::TurnSpindle command;
    command.spindle = i;
    command.turn = turn;
    run.emit(command);
  }
}

void spindle_orient(const CodeRule& rule, BlockRun& run) {
  const auto spindle = spindle_of(run, 0);
  if (!spindle) return;
  if (const auto r = run.number('R'); r && (*r < 0 || *r > 360))
    return run.error("word_value", 'R', "R, the angle of M19, must be from 0 to 360 degrees");
  int direction = 0;
  if (run.has('P')) {
    const auto p = run.integer('P', 0, 2);
    if (!p) return;
    direction = *p;
  }
  if (run.has('Q') && *run.number('Q') <= 0)
    return run.error("word_value", 'Q', "Q, the longest wait of M19, must be above 0 seconds");
  run.state.spindles[static_cast<std::size_t>(*spindle)].turn = canon::SpindleTurn::stop;
  if (!run.has('R') && !run.has('P'))
    return run.warning("word_ignored", run.place(rule),
                       "M19 without R and P does not move the spindle; give R, the angle");
  const double angle = run.number_or('R', 0) + run.session.options.orient_offset;
  run.emit(canon::OrientSpindle{*spindle, angle * radian_per_degree, direction});
}

}  // namespace aircut::interp
