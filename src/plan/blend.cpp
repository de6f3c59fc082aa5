// Corner blends: a quintic Bezier that meets both sides with their tangent and curvature.
//
//            corner                  On each side three control points: at the cut (distance L
//      L .____.__.-------            from the corner), then (1 − b1) L and (1 − b2) L along the
//         P0 P1 P2  \  P3            tangent, the third moved by the side's curvature so that the
//                    |               second derivatives agree:
//                    | P4              P1 = P0 + (1 − b1) L T
//                    | P5              P2 = P1 + (b1 − b2) L T + h² κN / 20,  h = 5 (1 − b1) L
//
// b1 and b2 by the turn angle θ give about the smallest third derivative for a tolerance. (A shape
// with 10-15 % less curvature exists, b1 = 0.85, b2 = 0.27 at 30°, but its speed along u changes so
// much that it can't be run at a steady speed as smoothly as this one.) Between lines the middle
// point lies (1 + 5 b1 + 10 b2) / 32 · |w − u| · L from the corner (u, w unit tangents), which
// gives L from the tolerance in closed form; at arcs L is bisected until the largest distance from
// the original sides is within it.
//
// Between two lines the curve's form depends on the turn angle alone: its parameter is taken from a
// table over θ.
//
// So are its derivatives at nine places, where the joints are linear in the tip: what a corner asks
// of them is then known without looking at the curve.
//
// No rounder than needed: acceleration on the blend goes with 1 / L at the same speed, so L shrinks
// to the size at which the wanted speed just is possible.
#include "plan/blend.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aircut::plan {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double largest_turn = 175 * degree;  // beyond it the way goes back: stop
constexpr double rotary_tolerance = 0.05 * degree;
constexpr double smallest_cut = 1e-7;  // mm

Vec3 xyz_of(const AxisValues& p) { return {p[Axis::x], p[Axis::y], p[Axis::z]}; }
double uvw_norm(const AxisValues& p) { return metric_length(Metric::uvw, p); }
double abc_norm(const AxisValues& p) { return metric_length(Metric::abc, p); }

struct Shape {
  double b1, b2;
};

Shape shape_for(double theta) {
  struct Row {
    double theta, b1, b2;
  };
  constexpr std::array<Row, 6> rows = {{{30 * degree, 0.60, 0.155},
                                        {60 * degree, 0.58, 0.206},
                                        {90 * degree, 0.58, 0.299},
                                        {120 * degree, 0.66, 0.426},
                                        {150 * degree, 0.78, 0.632},
                                        {170 * degree, 0.88, 0.831}}};
  if (theta <= rows[0].theta) return {rows[0].b1, rows[0].b2};
  for (std::size_t i = 1; i < rows.size(); ++i)
    if (theta <= rows[i].theta) {
      const double f = (theta - rows[i - 1].theta) / (rows[i].theta - rows[i - 1].theta);
      return {std::lerp(rows[i - 1].b1, rows[i].b1, f), std::lerp(rows[i - 1].b2, rows[i].b2, f)};
    }
  return {rows.back().b1, rows.back().b2};
}

std::array<AxisValues, 6> control_points(const CornerShape& corner, const Shape& shape,
                                         double cut) {
  const PathPoint a = evaluate(corner.left, length(corner.left) - cut);
  const PathPoint b = evaluate(corner.right, cut);
  const double first = (1 - shape.b1) * cut, second = (shape.b1 - shape.b2) * cut;
  const double bend = 25 * first * first / 20;  // h² / 20
  std::array<AxisValues, 6> out;
  out[0] = a.p;
  out[1] = a.p + first * a.d;
  out[2] = out[1] + second * a.d + bend * a.dd;
  out[5] = b.p;
  out[4] = b.p - first * b.d;
  out[3] = out[4] - second * b.d + bend * b.dd;
  return out;
}

Blend bezier(const CornerShape& corner, const Shape& shape, double cut) {
  return make_curve(control_points(corner, shape, cut));
}

// The parameter of a line-to-line blend of cut 1, for turns of 0, ½, 1 … 175 degrees. All linear
// mixtures of two neighbours rise from 0 to 1 too; their speed is off by less than 1e-5.
class CornerForms {
 public:
  CornerForms() {
    for (std::size_t i = 0; i < forms_.size(); ++i) {
      const double theta = step * static_cast<double>(i);
      AxisValues in, out;
      in[Axis::x] = -1;
      out[Axis::x] = std::cos(theta);
      out[Axis::y] = std::sin(theta);
      const Path left = make_line(in, {}), right = make_line({}, out);
      forms_[i] = bezier({left, right}, shape_for(theta), 1);
      rates_[i] = rates_of(forms_[i]);
    }
  }

  CornerRates rates_at(double theta) const {
    const double place = theta / step;
    const auto i = std::min(static_cast<std::size_t>(place), forms_.size() - 2);
    const double f = place - static_cast<double>(i);
    const CornerRates &a = rates_[i], &b = rates_[i + 1];
    CornerRates out;
    const auto between = [f](double x, double y) { return x + f * (y - x); };
    for (std::size_t k = 0; k < out.at.size(); ++k)
      for (std::size_t side = 0; side < 2; ++side) {
        out.at[k].d[side] = between(a.at[k].d[side], b.at[k].d[side]);
        out.at[k].dd[side] = between(a.at[k].dd[side], b.at[k].dd[side]);
      }
    out.length = between(a.length, b.length);
    return out;
  }

  /// True where at() takes the parameter from the table.
  bool has(double theta) const {
    const auto i = std::min(static_cast<std::size_t>(theta / step), forms_.size() - 2);
    return !runs_along_u(forms_[i]) && !runs_along_u(forms_[i + 1]);
  }

  Blend at(double theta, const std::array<AxisValues, 6>& control, double cut) const {
    const double place = theta / step;
    const auto i = std::min(static_cast<std::size_t>(place), forms_.size() - 2);
    const Blend &a = forms_[i], &b = forms_[i + 1];
    if (!has(theta)) return make_curve(control);
    const double f = place - static_cast<double>(i);
    Blend form;
    for (std::size_t k = 0; k < form.u_of_y.size(); ++k)
      form.u_of_y[k] = a.u_of_y[k] + f * (b.u_of_y[k] - a.u_of_y[k]);
    form.whole = form.length = a.whole + f * (b.whole - a.whole);
    return scaled_curve(form, control, cut);
  }

 private:
  // The same curve with its two directions told apart: `in` counts along X, `out` along Y.
  static CornerRates rates_of(const Blend& form) {
    CornerRates out;
    Blend apart = form;
    const auto put = [&](std::size_t i, double in, double out_way) {
      apart.control[i] = {};
      apart.control[i][Axis::x] = in;
      apart.control[i][Axis::y] = out_way;
    };
    // Along the first direction the way of the points from the corner, which is negative there.
    const auto way = [&](std::size_t i) {
      const AxisValues& p = form.control[i];
      return std::hypot(p[Axis::x], p[Axis::y]);
    };
    for (std::size_t i = 0; i < 3; ++i) put(i, -way(i), 0);
    for (std::size_t i = 3; i < 6; ++i) put(i, 0, way(i));
    const double last = static_cast<double>(out.at.size() - 1);
    for (std::size_t k = 0; k < out.at.size(); ++k) {
      const PathPoint p = evaluate(apart, apart.length * static_cast<double>(k) / last);
      out.at[k].d = {p.d[Axis::x], p.d[Axis::y]};
      out.at[k].dd = {p.dd[Axis::x], p.dd[Axis::y]};
    }
    out.length = form.length;
    return out;
  }

  static constexpr double step = degree / 2;
  std::array<Blend, 351> forms_;
  std::array<CornerRates, 351> rates_;
};

const CornerForms& corner_forms() {
  static const CornerForms forms;  // a constant that the compiler can't make
  return forms;
}

Blend line_blend(const CornerShape& corner, const Shape& shape, double theta, double cut) {
  return corner_forms().at(theta, control_points(corner, shape, cut), cut);
}

// s of a point of the path near `p`, within [low, high]; for lines and arcs the nearest one but for
// a helix' pitch. (Any point gives a distance that is too large, never too small.)
double near_s(const Path& path, const Vec3& p, double low, double high) {
  if (const auto* line = std::get_if<Line>(&path)) {
    const Vec3 start = xyz_of(line->start), way = xyz_of(line->end) - start;
    return std::clamp((p - start).dot(way) / way.squaredNorm() * line->length, low, high);
  }
  if (const auto* arc = std::get_if<Arc>(&path)) {
    const Vec3 r = p - foot_of(*arc);
    double angle = std::atan2(r.dot(arc->normal.cross(arc->radial)), r.dot(arc->radial));
    const double middle = arc->angle * (low + high) / 2 / arc->length;
    angle += 2 * std::numbers::pi * std::round((middle - angle) / (2 * std::numbers::pi));
    return std::clamp(angle / arc->angle * arc->length, low, high);
  }
  return low;
}

// Distance of the blend's point at u from the sides, as a share of the tolerances.
double deviation_at(const CornerShape& corner, const Blend& blend, double cut, double u) {
  const double left_length = length(corner.left);
  const AxisValues p = evaluate(blend, blend.length * u).p;
  const auto off = [&](const Path& side, double low, double high) {
    const AxisValues way = p - evaluate(side, near_s(side, xyz_of(p), low, high)).p;
    const double linear = std::max(metric_length(Metric::xyz, way), uvw_norm(way));
    return std::max(corner.tolerance > 0 ? linear / corner.tolerance : 0,
                    abc_norm(way) / rotary_tolerance);
  };
  return std::min(off(corner.left, left_length - cut, left_length), off(corner.right, 0, cut));
}

// Its largest value: the best of 33 samples, then thirds around it, because the distance has a
// sharp peak where the nearer side changes. The corner itself must not be farther away either.
double deviation(const CornerShape& corner, const Blend& blend, double cut) {
  constexpr int samples = 32;
  const AxisValues vertex = evaluate(corner.right, 0).p;
  double worst = 0, vertex_off = std::numeric_limits<double>::infinity();
  int at = 0;
  for (int k = 0; k <= samples; ++k) {
    const double u = static_cast<double>(k) / samples;
    if (const double here = deviation_at(corner, blend, cut, u); here > worst) {
      worst = here;
      at = k;
    }
    const AxisValues way = evaluate(blend, blend.length * u).p - vertex;
    vertex_off = std::min(vertex_off, metric_length(Metric::xyz, way));
  }
  double low = std::max(at - 1.0, 0.0) / samples, high = std::min(at + 1.0, 32.0) / samples;
  for (int round = 0; round < 24; ++round) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    const double at_a = deviation_at(corner, blend, cut, a);
    const double at_b = deviation_at(corner, blend, cut, b);
    worst = std::max({worst, at_a, at_b});
    if (at_a > at_b)
      high = b;
    else
      low = a;
  }
  return corner.tolerance > 0 ? std::max(worst, vertex_off / corner.tolerance) : worst;
}

// Longest cut that the tolerance allows between two lines.
double line_cut(const CornerShape& corner, const Shape& shape, const AxisValues& turn) {
  const double share = (1 + 5 * shape.b1 + 10 * shape.b2) / 32;
  double cut = std::min(corner.left_room, corner.right_room);
  if (corner.tolerance > 0)
    cut = std::min(cut, corner.tolerance /
                            (share * std::max(metric_length(Metric::xyz, turn), uvw_norm(turn))));
  if (const double rotary = abc_norm(turn); rotary > 0)
    cut = std::min(cut, rotary_tolerance / (share * rotary));
  return cut;
}

double arc_cut(const CornerShape& corner, const Shape& shape) {
  double room = std::min(corner.left_room, corner.right_room);
  for (const Path* side : {&corner.left, &corner.right})
    if (const auto* arc = std::get_if<Arc>(side))
      room = std::min(room, arc->length / std::abs(arc->angle));  // one radian
  const auto fits = [&](double cut) {
    return deviation(corner, bezier(corner, shape, cut), cut) <= 1;
  };
  if (fits(room)) return room;
  double good = 0, bad = room;
  for (int i = 0; i < 40 && bad - good > 1e-4 * bad; ++i) {
    const double middle = (good + bad) / 2;
    (fits(middle) ? good : bad) = middle;
  }
  return good;
}

}  // namespace

std::optional<CornerBlend> make_blend(const CornerShape& corner, const Demand& demand) {
  const AxisValues in = evaluate(corner.left, length(corner.left)).d;
  const AxisValues out = evaluate(corner.right, 0).d;
  const double in_size = metric_length(Metric::xyz, in), out_size = metric_length(Metric::xyz, out);
  if (!(in_size > 0) || !(out_size > 0)) return std::nullopt;
  const Vec3 u = xyz_of(in) / in_size, w = xyz_of(out) / out_size;
  const double theta = 2 * std::atan2((w - u).norm(), (w + u).norm());
  if (theta > largest_turn) return std::nullopt;
  const Shape shape = shape_for(theta);
  const bool lines =
      std::holds_alternative<Line>(corner.left) && std::holds_alternative<Line>(corner.right);
  double cut = lines ? line_cut(corner, shape, (1 / out_size) * out - (1 / in_size) * in)
                     : arc_cut(corner, shape);
  if (!(cut > smallest_cut)) return std::nullopt;
  if (lines && demand.of_lines) {
    // What is asked goes exactly with 1 / cut.
    const CornerRates rates = corner_forms().rates_at(theta);
    const double need = demand.of_lines(rates, cut);
    if (need < 0.93) cut = std::max(cut * need * 1.03, smallest_cut);
    CornerBlend made{line_blend(corner, shape, theta, cut), cut};
    if (corner_forms().has(theta)) made.rates = rates;
    return made;
  }
  Blend blend = lines ? line_blend(corner, shape, theta, cut) : bezier(corner, shape, cut);
  double need = demand.of_blend(blend);
  for (int round = 0; round < 3 && need < 0.93; ++round) {
    const double smaller = std::max(cut * need * 1.03, smallest_cut);
    const Blend rounded =
        lines ? scaled_curve(blend, control_points(corner, shape, smaller), smaller / cut)
              : bezier(corner, shape, smaller);
    need = demand.of_blend(rounded);
    if (!(need <= 1)) break;
    if (!lines && deviation(corner, rounded, smaller) > 1) break;
    cut = smaller;
    blend = rounded;
  }
  return CornerBlend{blend, cut};
}

}  // namespace aircut::plan
