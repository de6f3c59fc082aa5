// G5 (cubic), G5.1 (quadratic) and G5.2 … G5.3 (NURBS), XY plane only.
// A Bezier curve is a NURBS with as many control points as its order and weights 1.
#include "interp/codes/codes.h"

namespace aircut::interp {
namespace {

constexpr std::uint32_t max_points = 100'000;

bool allowed(BlockRun& run, const CodeRule& rule) {
  if (run.state.comp.side != CompSide::off) {
    run.error("comp_illegal", rule, "splines can't be used while radius compensation is on");
    return false;
  }
  if (run.state.plane != canon::Plane::xy) {
    run.error("spline_error", rule, "splines need the XY plane; give G17 before");
    return false;
  }
  for (const Axis axis : all_axes) {
    if (axis <= Axis::y || !run.has(letter(axis))) continue;
    run.error("spline_error", letter(axis),
              "a spline moves X and Y only; move the other axes on another line");
    return false;
  }
  return feed_is_set(run, rule);
}

bool has_end(BlockRun& run, const CodeRule& rule) {
  if (run.has('X') || run.has('Y') || run.has('@') || run.has('^')) return true;
  run.error("axis_word_missing", rule, name_of(rule) + " needs X or Y: the end of the curve");
  return false;
}

// The tip position of the current program point moved by (x, y) in program axes.
canon::SplineFeed::Point shifted(const BlockRun& run, const AxisValues& from, double x, double y,
                                 double weight = 1) {
  AxisValues program = to_program(run.state, from);
  program[Axis::x] += x;
  program[Axis::y] += y;
  const AxisValues tip = to_tip(run.state, program);
  return {tip[Axis::x], tip[Axis::y], weight};
}

canon::SplineFeed::Point at(const AxisValues& tip, double weight = 1) {
  return {tip[Axis::x], tip[Axis::y], weight};
}

// The control keeps the tangent for the next G5 where the shift I J of a back bore is, which may go
// on behind G5.
void tell_bore_of_tangent(BlockRun& run) {
  CycleState& cycle = run.state.cycle;
  if (cycle.code != 870) return;
  cycle.i = -run.number_or('P', 0);
  cycle.j = -run.number_or('Q', 0);
}

// L may stand in any of the lines: the last one above 3 counts, without one the order is 3.
bool nurbs_order(BlockRun& run) {
  if (!run.has('L')) return true;
  const auto order = run.integer('L', 0, 20, "spline_error");
  if (order && *order > 3) run.state.nurbs_order = *order;
  return order.has_value();
}

}  // namespace

void cubic_spline(const CodeRule& rule, BlockRun& run) {
  if (!allowed(run, rule) || !has_end(run, rule)) return;
  if (!run.has('P') || !run.has('Q'))
    return run.error("spline_error", rule,
                     "G5 needs P and Q: the second control point, seen from the end");
  if (run.has('I') != run.has('J'))
    return run.error("spline_error", run.has('I') ? 'I' : 'J',
                     "G5 needs both I and J, or none of them");
  SplineMemory& memory = run.state.spline;
  double i = run.length('I'), j = run.length('J');
  if (!run.has('I') && memory.valid) {
    i = memory.dx;
    j = memory.dy;
  }
  const auto end = target_of(run);
  if (!end) return;
  const double p = run.length('P'), q = run.length('Q');
  canon::SplineFeed curve;
  curve.order = 4;
  curve.points = {at(run.state.tip), shifted(run, run.state.tip, i, j), shifted(run, *end, p, q),
                  at(*end)};
  run.emit(std::move(curve));
  run.state.tip = *end;
  memory = {true, -p, -q};
  tell_bore_of_tangent(run);
}

void quadratic_spline(const CodeRule& rule, BlockRun& run) {
  if (!allowed(run, rule) || !has_end(run, rule)) return;
  if (!run.has('I') || !run.has('J'))
    return run.error("spline_error", rule,
                     "G5.1 needs I and J: the control point, seen from the start");
  if (run.number_or('I', 0) == 0 && run.number_or('J', 0) == 0)
    return run.error("spline_error", 'I', "I and J of G5.1 can't both be 0");
  const auto end = target_of(run);
  if (!end) return;
  canon::SplineFeed curve;
  curve.order = 3;
  curve.points = {at(run.state.tip), shifted(run, run.state.tip, run.length('I'), run.length('J')),
                  at(*end)};
  run.emit(std::move(curve));
  run.state.tip = *end;
}

// Collects control points. The current point is the first one and stays it until G5.3: with G91 all
// points are counted from there.
void nurbs_point(const CodeRule& rule, BlockRun& run) {
  if (!allowed(run, rule)) return;
  ModalState& state = run.state;
  auto& points = run.session.nurbs;
  const double weight = run.number_or('P', 1);
  if (weight <= 0)
    return run.error("spline_error", 'P', "P, the weight of a control point, must be above 0");
  if (state.nurbs_points == 0) {
    points.clear();
    state.nurbs_order = 3;
    if (!nurbs_order(run)) return;
    points.push_back(at(state.tip, weight));
    state.nurbs_points = 1;
    if (!run.has('X') && !run.has('Y')) return;
  } else if (!run.has('P')) {
    return run.error("spline_error", rule,
                     "every control point of a NURBS needs P: its weight above 0");
  } else if (!nurbs_order(run)) {
    return;
  }
  if (!run.has('X') || !run.has('Y'))
    return run.error("axis_word_missing", rule, "a control point needs both X and Y");
  if (state.nurbs_points >= max_points)
    return run.error("limit_reached", rule, "more than 100000 control points in one NURBS");
  const auto end = target_of(run);
  if (!end) return;
  points.push_back(at(*end, weight));
  ++state.nurbs_points;
}

void nurbs_end(const CodeRule& rule, BlockRun& run) {
  ModalState& state = run.state;
  if (state.nurbs_points == 0)
    return run.error("spline_error", rule, "G5.3 ends a NURBS; begin it with G5.2");
  if (state.nurbs_points < static_cast<std::uint32_t>(state.nurbs_order))
    return run.error("spline_error", rule,
                     "a NURBS needs at least as many control points as its order L");
  canon::SplineFeed curve;
  curve.order = state.nurbs_order;
  curve.points.assign(run.session.nurbs.begin(), run.session.nurbs.begin() + state.nurbs_points);
  state.nurbs_points = 0;
  state.motion = 800;
  state.tip[Axis::x] = curve.points.back().x;
  state.tip[Axis::y] = curve.points.back().y;
  run.emit(std::move(curve));
}

}  // namespace aircut::interp
