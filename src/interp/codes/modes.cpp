// Modal settings without motion: planes, units, distance, feed, path control, lathe, and the
// switches of radius compensation. G4 too.
#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "interp/codes/codes.h"
#include "interp/dialect.h"

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
  const canon::Plane plane = rule.code == 170   ? canon::Plane::xy
                             : rule.code == 180 ? canon::Plane::zx
                             : rule.code == 190 ? canon::Plane::yz
                             : rule.code == 171 ? canon::Plane::uv
                             : rule.code == 181 ? canon::Plane::wu
                                                : canon::Plane::vw;
  if (plane != run.state.plane && refuse_with_comp(run, rule)) return;
  if (run.state.frame.turned && plane != run.state.plane)
    return run.error("frame_error", rule,
                     "the plane can't be changed while G68 turns it; give G69 before");
  if (run.state.polar.on && plane != run.state.plane)
    return run.error("polar_error", rule,
                     "the plane can't be changed between G16 and G15; give G15 before");
  run.state.plane = plane;
  run.emit_now(canon::SelectPlane{plane});  // with radius compensation it is the plane in force
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
  run.emit_now(canon::UseUnit{unit});
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
  if (rule.code != 930) run.state.feed = 0;
  run.emit(canon::SetFeedMode{run.state.feed_mode});
  if (rule.code != 930) run.emit(canon::SetFeedRate{});
}

void emit_feed(BlockRun& run) {
  const ModalState& state = run.state;
  canon::SetFeedRate rate;
  switch (state.feed_mode) {
    case canon::FeedMode::per_minute:
      rate.value = state.feed * state.unit_mm() / 60;
      rate.rotary = state.feed * radian_per_degree / 60;
      break;
    case canon::FeedMode::inverse_time:
      rate.value = state.feed / 60;
      break;
    case canon::FeedMode::per_revolution:
      rate.value = state.feed * state.unit_mm();
      break;
  }
  run.emit(rate);
}

void feed_word(BlockRun& run) {
  const double value = *run.number('F');
  if (value < 0) return run.error("word_value", 'F', "F, the feed, can't be negative");
  run.feed_given = true;
  // With G93 it is for this line only.
  if (run.state.feed_mode == canon::FeedMode::inverse_time) {
    canon::SetFeedRate rate;
    rate.value = value / 60;
    return run.emit(rate);
  }
  run.state.feed = value;
  emit_feed(run);
}

void emit_path_mode(BlockRun& run) {
  const ModalState& state = run.state;
  run.emit(canon::SetPathMode{state.path_mode, state.path_tolerance * state.unit_mm()});
}

void emit_naive_tolerance(BlockRun& run) {
  run.emit(canon::SetNaiveCam{run.state.naive_tolerance * run.state.unit_mm()});
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
    const Options& options = run.session.options;
    const double unit = state.unit_mm();
    state.path_tolerance =
        std::max(0.0, run.number_or('P', options.g64_tolerance.value_or(0) / unit));
    const bool plain = !run.has('P') && options.g64_naive_tolerance;
    const double q =
        run.number_or('Q', plain ? *options.g64_naive_tolerance / unit : state.path_tolerance);
    state.naive_tolerance = q >= 0 ? q : state.path_tolerance;
  }
  emit_path_mode(run);
  if (state.path_mode == canon::PathMode::continuous) emit_naive_tolerance(run);
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
  run.session.compensator.finish(run);
  if (!run.ok()) return;
  if (comp.side != CompSide::off && comp.entered) {
    comp.leaving = true;
    comp.left_at = run.state.tip;
    // To all codes in front of the move that leaves the contour the tool is at the programmed
    // point already.
    if (!run.session.table.dialect().macro_b) {
      run.state.tip = comp.programmed;
      comp.entered = false;
    }
  }
  comp.side = CompSide::off;
}

namespace {

/// The tool of a D word, or the one in the spindle; null with an error when there is none.
struct Cutter {
  double diameter = 0;  // mm
  int orientation = 0;
};

std::optional<Cutter> cutter_of_tool(const CodeRule& rule, BlockRun& run) {
  int number = 0;
  if (run.has('D')) {
    const auto d = run.integer('D', 0, 99999);
    if (!d) return std::nullopt;
    number = *d;
  }
  // L belongs to G41.1 and G42.1; it is read here too, and that is all.
  if (run.has('L') && !run.integer('L', -99999, 99999)) return std::nullopt;
  if (number == 0) number = run.state.tool;
  const tool::Tool* tool = run.session.tools.find(number);
  if (tool && run.has('D') && number != run.state.tool && run.state.tool != 0)
    run.warning("wrong_offset", run.place('D'),
                "D takes the diameter of tool " + std::to_string(number) + ", but tool " +
                    std::to_string(run.state.tool) +
                    " is in the spindle: the contour comes out too large or too small; leave D "
                    "out for the tool in the spindle");
  if (tool) return Cutter{tool->diameter, tool->orientation};
  if (number == 0) return Cutter{};
  run.error("tool_unknown", run.has('D') ? run.place('D') : run.place(rule),
            "tool " + std::to_string(number) + " is not in the tool table");
  return std::nullopt;
}

std::optional<Cutter> cutter_of_words(const CodeRule& rule, BlockRun& run) {
  if (!run.has('D')) {
    run.error("word_missing", rule, name_of(rule) + " needs D: the cutter's diameter");
    return std::nullopt;
  }
  Cutter cutter{run.length('D'), 0};
  if (!run.has('L')) return cutter;
  if (run.state.plane != canon::Plane::zx) {
    run.error("comp_illegal", 'L',
              "L, the orientation of a lathe tool, needs the ZX plane; give G18 before");
    return std::nullopt;
  }
  const auto orientation = run.integer('L', 0, 9);
  if (!orientation) return std::nullopt;
  cutter.orientation = *orientation;
  return cutter;
}

}  // namespace

void radius_comp_on(const CodeRule& rule, BlockRun& run) {
  ModalState& state = run.state;
  if (refuse_with_comp(run, rule)) return;
  const bool by_words = rule.code % 10 == 1;
  const auto cutter = by_words ? cutter_of_words(rule, run) : cutter_of_tool(rule, run);
  if (!cutter) return;
  start_compensation(rule, run, rule.code < 420 ? CompSide::left : CompSide::right,
                     cutter->diameter / 2, cutter->orientation);
  state.comp.from_diameter_word = by_words;
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

// The control gives G40, or G41 and G42 without D.
void restore_radius_comp(BlockRun& run, CompSide side) {
  if (run.state.comp.side == side) return;
  const CodeTable& table = run.session.table;
  if (side == CompSide::off) return radius_comp_off(*table.find_g(400), run);
  radius_comp_on(*table.find_g(side == CompSide::left ? 410 : 420), run);
}

}  // namespace aircut::interp
