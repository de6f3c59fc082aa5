// Haas' circular pockets G12 (clockwise) and G13: from the centre of the circle the tool goes down
// to Z at the feed, out to the circle and once round it, and back to the centre.
//
//   I          radius of the circle; with K and Q of the first one
//   K, Q       radius of the last circle, and the step from one to the next
//   D          offset row whose radius is taken off, so that the circles are those of the wall
//   Z, L       depth; with G91 repeated L times, deeper each time
//
// Half circles lead out and back, straight lines from circle to circle: everything stays inside the
// pocket, but the manuals draw it differently, so a warning says that these ways are ours.
#include <cmath>

#include "base/text.h"
#include "interp/codes/codes.h"

namespace aircut::interp {
namespace {

constexpr int max_circles = 20'000;

struct Pocket {
  double tool = 0;            ///< radius, mm
  std::vector<double> radii;  ///< of the wall
  int loops = 1;
};

std::optional<double> tool_radius(const CodeRule& rule, BlockRun& run) {
  if (!run.has('D')) {
    run.error("word_missing", rule,
              name_of(rule) + " needs D: the offset of the tool's radius; D0 for none");
    return std::nullopt;
  }
  const auto d = run.integer('D', 0, OffsetMemory::max_tool);
  if (!d) return std::nullopt;
  if (*d == 0) return 0;
  const ToolOffset* row = run.session.offsets.tool(*d);
  if (row) return row->whole_radius();
  run.error("tool_unknown", 'D',
            "the tool offset " + std::to_string(*d) +
                " is neither in the tool table nor set by G10; add it");
  return std::nullopt;
}

bool find_radii(const CodeRule& rule, BlockRun& run, Pocket& pocket) {
  for (const char word : {'I', 'Z'})
    if (!run.has(word)) {
      run.error("word_missing", rule,
                name_of(rule) + (word == 'I' ? " needs I: the radius of the (first) circle"
                                             : " needs Z: the depth"));
      return false;
    }
  if (run.has('K') != run.has('Q')) {
    run.error("word_missing", rule,
              name_of(rule) + " takes K, the radius of the last circle, together with Q, the step");
    return false;
  }
  const double first = run.length('I'), last = run.length('K', first), step = run.length('Q');
  const auto wrong = [&](char word, const std::string& text) {
    run.error("word_value", word, text);
    return false;
  };
  if (first <= pocket.tool)
    return wrong('I', "I must be larger than the tool's radius, " + fixed(pocket.tool, 4) + " mm");
  if (run.has('K') && last <= first) return wrong('K', "K must be larger than I");
  if (run.has('Q') && step <= 0) return wrong('Q', "Q, the step, must be above 0");
  if (run.has('K') && (last - first) / step > max_circles) {
    run.error("limit_reached", 'Q', "more than 20000 circles; use a larger Q");
    return false;
  }
  for (int n = 0; step > 0 && first + n * step < last - 1e-9; ++n)
    pocket.radii.push_back(first + n * step);
  pocket.radii.push_back(last);
  return true;
}

class PocketMotion {
 public:
  PocketMotion(const CodeRule& rule, BlockRun& run) : rule_(rule), run_(run) {
    program_ = to_program(run.state, run.state.tip);
    x_ = program_[Axis::x];
    y_ = program_[Axis::y];
  }
  void to_centre(double x, double y) {
    x_ = program_[Axis::x] = x;
    y_ = program_[Axis::y] = y;
    run_.state.tip = to_tip(run_.state, program_);
    run_.emit(canon::Rapid{run_.state.tip}, name_of(rule_) + " to the centre");
  }
  void down(double z) {
    program_[Axis::z] = z;
    feed("down");
  }
  void circles(const Pocket& pocket);

 private:
  void feed(const char* what) {
    run_.state.tip = to_tip(run_.state, program_);
    run_.emit(canon::LinearFeed{run_.state.tip}, name_of(rule_) + " " + what);
  }
  void arc(double x, double centre_x, const char* what) {
    program_[Axis::x] = x_ + x;
    AxisValues centre = program_;
    centre[Axis::x] = x_ + centre_x;
    centre = to_tip(run_.state, centre);
    canon::ArcFeed arc;
    arc.end = run_.state.tip = to_tip(run_.state, program_);
    arc.centre = Vec3(centre[Axis::x], centre[Axis::y], centre[Axis::z]);
    arc.normal = plane_normal(run_.state);
    arc.turns = rule_.code == 130 ? 1 : -1;
    arc.plane = run_.state.plane;
    run_.emit(std::move(arc), name_of(rule_) + " " + what);
  }

  const CodeRule& rule_;
  BlockRun& run_;
  AxisValues program_;
  double x_ = 0, y_ = 0;  ///< of the centre
};

void PocketMotion::circles(const Pocket& pocket) {
  double at = 0;
  for (const double wall : pocket.radii) {
    const double radius = wall - pocket.tool;
    if (at == 0) {
      arc(radius, radius / 2, "out to the circle");
    } else {
      program_[Axis::x] = x_ + radius;
      feed("to the next circle");
    }
    arc(radius, 0, "circle");
    at = radius;
  }
  arc(0, at / 2, "back to the centre");
}

bool is_possible(const CodeRule& rule, BlockRun& run) {
  const ModalState& state = run.state;
  AxisSet axes;
  for (const Axis axis : {Axis::x, Axis::y, Axis::z}) axes.add(axis);
  if (state.comp.side != CompSide::off)
    run.error("comp_illegal", rule,
              name_of(rule) + " brings its own compensation; give G40 before");
  else if (state.plane != canon::Plane::xy)
    run.error("cycle_error", rule, name_of(rule) + " needs the XY plane; give G17 before");
  else if (state.feed_mode == canon::FeedMode::inverse_time)
    run.error("cycle_error", rule, name_of(rule) + " can't be used with G93; give G94");
  return run.ok() && frame_allows(run, rule, axes) && feed_is_set(run, rule);
}

}  // namespace

void circular_pocket(const CodeRule& rule, BlockRun& run) {
  if (!is_possible(rule, run)) return;
  Pocket pocket;
  const auto radius = tool_radius(rule, run);
  if (!radius) return;
  pocket.tool = *radius;
  if (!find_radii(rule, run, pocket)) return;
  if (run.has('L')) {
    const auto loops = run.integer('L', 1, 1000);
    if (!loops) return;
    pocket.loops = *loops;
  }
  const auto target = target_of(run);
  if (!target) return;
  const AxisValues end = to_program(run.state, *target);
  const double step = run.state.incremental ? *run.axis(Axis::z) : 0;
  run.warning("control_setting", run.place(rule),
              "the ways from the centre to the circles, between them and back are drawn here as "
              "half circles and lines inside the pocket; the control's own may differ");
  PocketMotion motion(rule, run);
  if (run.has('X') || run.has('Y')) motion.to_centre(end[Axis::x], end[Axis::y]);
  for (int n = 0; n < pocket.loops; ++n) {
    motion.down(end[Axis::z] + n * step);
    motion.circles(pocket);
  }
}

void general_pocket(const CodeRule& rule, BlockRun& run) {
  run.error("unsupported_code", rule,
            "G150 lets the control work out the passes of a pocket of any shape, which its manual "
            "does not tell; write the moves, or let CAM write them");
}

}  // namespace aircut::interp
