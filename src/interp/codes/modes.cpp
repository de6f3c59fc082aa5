// Modal settings without motion: planes, units, distance, feed, path control, lathe, and the
// switches of radius compensation. G4 too.
#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "interp/codes/codes.h"

namespace aircut::interp {
namespace {

bool comp_is_on(const BlockRun& run) { return run.state.comp.side != CompSide::off; }

bool refuse_with_comp(BlockRun& run, const CodeRule& rule) {
  if (!comp_is_on(run)) return false;
  run.error("comp_illegal", rule,
            name_of(rule) + " can't be used while radius compensation is on; give G40 before");
  return true;
}

}  // namespace

void select_plane(const CodeRule& rule, BlockRun& run) {
  if (refuse_with_comp(run, rule)) return;
  const canon::Plane before = run.state.plane;
  switch (rule.code) {
    case 170:
      run.state.plane = canon::Plane::xy;
      break;
    case 180:
      run.state.plane = canon::Plane::zx;
      break;
    case 190:
      run.state.plane = canon::Plane::yz;
      break;
    case 171:
      run.state.plane = canon::Plane::uv;
      break;
    case 181:
      run.state.plane = canon::Plane::wu;
      break;
    default:
      run.state.plane = canon::Plane::vw;
      break;
  }
  if (run.state.frame.turned && run.state.plane != before)
    return run.error("frame_error", rule,
                     "the plane can't be changed while G68 turns it; give G69 before");
  run.emit(canon::SelectPlane{run.state.plane});
}

void select_unit(const CodeRule& rule, BlockRun& run) {
  const canon::Unit unit = rule.code == 200 ? canon::Unit::inch : canon::Unit::millimetre;
  if (unit != run.state.unit && run.feed_given &&
      run.state.feed_mode != canon::FeedMode::inverse_time)
    run.warning("feed_before_unit", run.place('F'),
                std::string("F acts before ") + name_of(rule) +
                    " on the same line, in the unit that was in force; put " + name_of(rule) +
                    " on a line before");
  run.state.unit = unit;
  run.emit(canon::UseUnit{unit});
}

void lathe_mode(const CodeRule& rule, BlockRun& run) { run.state.lathe_diameter = rule.code == 70; }

void distance_mode(const CodeRule& rule, BlockRun& run) {
  run.state.incremental = rule.code == 910;
}

void arc_centre_mode(const CodeRule& rule, BlockRun& run) {
  run.state.absolute_centres = rule.code == 901;
}

// Changing or repeating the mode forgets the feed; with G93 it is given on every line anyway.
void feed_mode(const CodeRule& rule, BlockRun& run) {
  run.state.feed_mode = rule.code == 930   ? canon::FeedMode::inverse_time
                        : rule.code == 940 ? canon::FeedMode::per_minute
                                           : canon::FeedMode::per_revolution;
  run.state.feed = 0;
  run.emit(canon::SetFeedMode{run.state.feed_mode});
  if (rule.code != 930) run.emit(canon::SetFeedRate{});
}

void feed_word(BlockRun& run) {
  ModalState& state = run.state;
  const double value = *run.number('F');
  if (value < 0) return run.error("word_value", 'F', "F, the feed, can't be negative");
  run.feed_given = true;
  state.feed = value;
  emit_feed(run);
}

void emit_feed(BlockRun& run) {
  const ModalState& state = run.state;
  const double value = state.feed;
  canon::SetFeedRate rate;
  switch (state.feed_mode) {
    case canon::FeedMode::per_minute:
      rate.value = value * state.unit_mm() / 60;
      rate.rotary = value * radian_per_degree / 60;
      break;
    case canon::FeedMode::inverse_time:
      rate.value = value / 60;
      break;
    case canon::FeedMode::per_revolution:
      rate.value = value * state.unit_mm();
      break;
  }
  run.emit(rate);
}

void path_mode(const CodeRule& rule, BlockRun& run) {
  if (refuse_with_comp(run, rule)) return;
  ModalState& state = run.state;
  state.path_tolerance = 0;
  if (rule.code == 610) {
    state.path_mode = canon::PathMode::exact_path;
  } else if (rule.code == 611) {
    state.path_mode = canon::PathMode::exact_stop;
  } else {
    state.path_mode = canon::PathMode::continuous;
    // Nothing or less than nothing means no limit.
    state.path_tolerance = std::max(0.0, run.length('P'));
    state.naive_tolerance = std::max(0.0, run.length('Q', state.path_tolerance));
  }
  run.emit(canon::SetPathMode{state.path_mode, state.path_tolerance});
  if (state.path_mode == canon::PathMode::continuous)
    run.emit(canon::SetNaiveCam{state.naive_tolerance});
}

void retract_mode(const CodeRule& rule, BlockRun& run) {
  if (refuse_with_comp(run, rule)) return;
  run.state.retract_to_r = rule.code == 990;
}

void dwell(const CodeRule& rule, BlockRun& run) {
  const auto seconds = run.number('P');
  if (!seconds) return run.error("word_missing", rule, "G4 needs a P word: the time in seconds");
  if (*seconds < 0)
    return run.error("dwell_time", 'P',
                     "G4 needs P of 0 or more seconds, this is " + shortest(*seconds));
  run.emit(canon::Dwell{*seconds});
}

void radius_comp_off(const CodeRule&, BlockRun& run) {
  CompState& comp = run.state.comp;
  run.session.compensator.flush(run);
  if (comp.side != CompSide::off) comp.leaving = comp.entered;
  comp.side = CompSide::off;
}

void radius_comp_on(const CodeRule& rule, BlockRun& run) {
  ModalState& state = run.state;
  if (refuse_with_comp(run, rule)) return;
  if (state.plane != canon::Plane::xy && state.plane != canon::Plane::zx)
    return run.error("comp_illegal", rule,
                     "radius compensation needs the XY or ZX plane; give G17 or G18 before");
  CompState comp;
  comp.side = rule.code < 420 ? CompSide::left : CompSide::right;
  comp.from_diameter_word = rule.code % 10 == 1;
  double diameter = 0;
  if (comp.from_diameter_word) {
    if (!run.has('D'))
      return run.error("word_missing", rule, name_of(rule) + " needs D: the cutter's diameter");
    diameter = run.length('D');
    if (run.has('L')) {
      const auto orientation = run.integer('L', 0, 9);
      if (!orientation) return;
      comp.orientation = *orientation;
    }
  } else {
    int number = 0;
    if (run.has('D')) {
      const auto d = run.integer('D', 0, 99999);
      if (!d) return;
      number = *d;
    }
    if (number == 0) number = state.tool;
    const tool::Tool* tool = run.session.tools.find(number);
    if (!tool && number != 0)
      return run.error("tool_unknown", run.has('D') ? run.place('D') : run.place(rule),
                       "tool " + std::to_string(number) + " is not in the tool table");
    if (run.has('D') && number != state.tool && state.tool != 0)
      run.warning("wrong_offset", run.place('D'),
                  "D takes the diameter of tool " + std::to_string(number) + ", but tool " +
                      std::to_string(state.tool) +
                      " is in the spindle: the contour comes out too large or too small; leave D "
                      "out for the tool in the spindle");
    if (tool) {
      diameter = tool->diameter;
      comp.orientation = tool->orientation;
    }
  }
  start_compensation(rule, run, comp.side, diameter / 2, comp.orientation);
  state.comp.from_diameter_word = comp.from_diameter_word;
}

void start_compensation(const CodeRule& rule, BlockRun& run, CompSide side, double radius,
                        int orientation) {
  if (run.state.plane != canon::Plane::xy && run.state.plane != canon::Plane::zx)
    return run.error("comp_illegal", rule,
                     "radius compensation needs the XY or ZX plane; give G17 or G18 before");
  if (orientation != 0 && orientation != 9 && run.state.plane != canon::Plane::zx)
    return run.error("comp_illegal", rule,
                     "a lathe tool (orientation 1-8) needs the ZX plane; give G18 before");
  CompState comp;
  // A negative radius compensates to the other side.
  comp.side = (side == CompSide::left) == (radius >= 0) ? CompSide::left : CompSide::right;
  comp.radius = std::fabs(radius);
  comp.orientation = orientation;
  run.state.comp = comp;
  run.session.compensator.start();
}

}  // namespace aircut::interp
