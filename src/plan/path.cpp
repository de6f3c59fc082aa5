// Geometry of the path pieces: position and two derivatives by the piece's own parameter s, and
// boxes with the way per axis over an interval of s, exact or larger.
//
// Line    p = p0 + s d, d = (p1 − p0) / length.
// Arc     the angle φ runs linearly with s: φ = angle · s / length. With e1 the unit vector from
//         the axis to the start and e2 = normal × e1:
//           xyz = centre + ρ(φ) (cos φ e1 + sin φ e2) + rise · s / length · normal
//         with ρ linear from start_radius to end_radius; the other six axes are linear in s. The
//         start and end points of the piece are taken as they are programmed: `start` gives the
//         height along the normal, so centre may be any point of the axis.
// Blend   quintic Bezier in nine axes over u, with u a polynomial of s (curve.cpp); derivatives by
// the
//         chain rule; boxes from the control points of the part (a Bezier lies in their hull, and
//         its way is no longer than the control polygon, axis by axis).
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "plan/geometry.h"

namespace aircut::plan {
namespace {

constexpr std::array<Axis, 3> xyz = {Axis::x, Axis::y, Axis::z};
constexpr double pi = std::numbers::pi;

PathPoint evaluate_line(const Line& line, double s) {
  PathPoint out;
  if (line.length <= 0) {
    out.p = line.start;
    return out;
  }
  out.d = (1 / line.length) * (line.end - line.start);
  out.p = s >= line.length ? line.end : line.start + s * out.d;
  return out;
}

PathPoint evaluate_arc(const Arc& arc, double s) {
  PathPoint out = evaluate_line(Line{arc.start, arc.end, arc.length}, s);  // ABC and UVW
  const double w = arc.angle / arc.length;                                 // dφ/ds
  const double phi = w * s;
  const double dr = (arc.end_radius - arc.start_radius) / arc.length;
  const double r = arc.start_radius + dr * s;
  const Vec3& e1 = arc.radial;
  const Vec3 e2 = arc.normal.cross(e1);
  const Vec3 c = std::cos(phi) * e1 + std::sin(phi) * e2;  // radial direction
  const Vec3 n = std::cos(phi) * e2 - std::sin(phi) * e1;  // its derivative by φ
  const double climb = arc.rise / arc.length;
  const Vec3 p = foot_of(arc) + r * c + climb * s * arc.normal;
  const Vec3 d = dr * c + r * w * n + climb * arc.normal;
  const Vec3 dd = 2 * dr * w * n - r * w * w * c;
  for (const Axis axis : xyz) {
    const auto i = static_cast<Eigen::Index>(index(axis));
    out.p[axis] = p[i];
    out.d[axis] = d[i];
    out.dd[axis] = dd[i];
  }
  return out;
}

// Weights of the six control points, from the Bernstein polynomials of degree 5 − order: derivative
// number `order` by u is 5 · 4 · … times the differences of that order.
using Weights = std::array<std::array<double, 6>, 3>;

Weights weights_at(double u) {
  const double v = 1 - u;
  const double u2 = u * u, v2 = v * v, u3 = u2 * u, v3 = v2 * v;
  const double a = 5 * v2 * v2, b = 20 * v3 * u, c = 30 * v2 * u2, d = 20 * v * u3, e = 5 * u2 * u2;
  const double k = 20 * v3, l = 60 * v2 * u, m = 60 * v * u2, n = 20 * u3;
  return {{{v3 * v2, a * u, 10 * v3 * u2, 10 * v2 * u3, e * v, u3 * u2},
           {-a, a - b, b - c, c - d, d - e, e},
           {k, l - 2 * k, m - 2 * l + k, n - 2 * m + l, m - 2 * n, n}}};
}

// u and its derivatives by s.
struct Parameter {
  double u, d, dd;
};

Parameter parameter_at(const Blend& blend, double s) {
  const double y = 2 * std::clamp((blend.begin + s) / blend.whole, 0.0, 1.0) - 1;
  // Horner, with the derivatives, over z = y²: u = E(z) + y O(z). Two short chains side by side.
  const double z = y * y;
  double e = 0, de = 0, dde = 0, o = 0, d_o = 0, ddo = 0;
  static_assert(std::tuple_size_v<decltype(blend.u_of_y)> % 2 == 0);
  for (std::size_t i = blend.u_of_y.size(); i > 0; i -= 2) {
    dde = dde * z + 2 * de;
    de = de * z + e;
    e = e * z + blend.u_of_y[i - 2];
    ddo = ddo * z + 2 * d_o;
    d_o = d_o * z + o;
    o = o * z + blend.u_of_y[i - 1];
  }
  const double scale = 2 / blend.whole;
  return {e + y * o, (2 * y * de + o + 2 * z * d_o) * scale,
          (2 * de + 4 * z * dde + y * (6 * d_o + 4 * z * ddo)) * scale * scale};
}

// Sums over the control points for the first `axes` axes; relative to the first point: small blends
// far from zero keep their digits. The sums over the axes are the inner loops, so that they run
// side by side. Then the chain rule, from derivatives by u to those by s.
template <std::size_t axes>
void sum_control(const Blend& blend, const Weights& w, const Parameter& u, PathPoint& out) {
  std::array<double, axes> p{}, d{}, dd{};
  for (std::size_t i = 1; i < 6; ++i) {
    for (std::size_t k = 0; k < axes; ++k) {
      const double way = blend.control[i].value[k] - blend.control[0].value[k];
      p[k] += w[0][i] * way;
      d[k] += w[1][i] * way;
      dd[k] += w[2][i] * way;
    }
  }
  for (std::size_t k = 0; k < axes; ++k) {
    out.p.value[k] += p[k];
    out.d.value[k] = d[k] * u.d;
    out.dd.value[k] = dd[k] * u.d * u.d + d[k] * u.dd;
  }
}

PathPoint evaluate_blend(const Blend& blend, double s) {
  const Parameter u = parameter_at(blend, s);
  const Weights w = weights_at(std::clamp(u.u, 0.0, 1.0));
  PathPoint out;
  out.p = blend.control[0];
  if (blend.xyz_only)
    sum_control<3>(blend, w, u, out);
  else
    sum_control<9>(blend, w, u, out);
  return out;
}

// Control points along one axis of the part of the curve between two values of u: cut at u1 and
// keep the left part, then cut that at u0 / u1 and keep the right part.
std::array<double, 6> control_between(std::array<double, 6> c, double u0, double u1) {
  if (u1 < 1) {
    for (std::size_t last = 5; last > 0; --last)
      for (std::size_t i = 5; i > 5 - last; --i) c[i] = c[i - 1] + u1 * (c[i] - c[i - 1]);
  }
  if (u0 > 0) {
    const double cut = std::min(u0 / u1, 1.0);
    for (std::size_t last = 5; last > 0; --last)
      for (std::size_t i = 0; i < last; ++i) c[i] += cut * (c[i + 1] - c[i]);
  }
  return c;
}

machine::TipInterval bounds_line(const Line& line, double s0, double s1) {
  machine::TipInterval out;
  const AxisValues a = evaluate_line(line, s0).p, b = evaluate_line(line, s1).p;
  for (const Axis axis : all_axes) {
    out.low[axis] = std::min(a[axis], b[axis]);
    out.high[axis] = std::max(a[axis], b[axis]);
    out.travel[axis] = std::abs(b[axis] - a[axis]);
  }
  return out;
}

struct Range {
  double low, high;
  double travel;
};

// cos over [a, b], a ≤ b: smallest and largest value and total variation.
Range cosine_range(double a, double b) {
  if (b - a >= 2 * pi) {
    const double turns = std::ceil((b - a) / (2 * pi));
    return {-1, 1, 4 * turns};
  }
  Range out{std::min(std::cos(a), std::cos(b)), std::max(std::cos(a), std::cos(b)), 0};
  // Extremes lie at the multiples of π in between.
  double last = std::cos(a);
  for (double k = std::ceil(a / pi); k * pi <= b; ++k) {
    const double value = std::fmod(std::abs(k), 2) == 0 ? 1 : -1;
    out.low = std::min(out.low, value);
    out.high = std::max(out.high, value);
    out.travel += std::abs(value - last);
    last = value;
  }
  out.travel += std::abs(std::cos(b) - last);
  return out;
}

machine::TipInterval bounds_arc(const Arc& arc, double s0, double s1) {
  machine::TipInterval out = bounds_line(Line{arc.start, arc.end, arc.length}, s0, s1);
  const Vec3 e2 = arc.normal.cross(arc.radial);
  const Vec3 foot = foot_of(arc);
  const double f0 = s0 / arc.length, f1 = s1 / arc.length;
  const double r0 = arc.start_radius + f0 * (arc.end_radius - arc.start_radius);
  const double r1 = arc.start_radius + f1 * (arc.end_radius - arc.start_radius);
  const double r_low = std::min(r0, r1), r_high = std::max(r0, r1);
  for (const Axis axis : xyz) {
    const auto i = static_cast<Eigen::Index>(index(axis));
    // Circle: ρ g cos(φ − φ0), g the length of the plane's shadow on this axis.
    const double g = std::hypot(arc.radial[i], e2[i]);
    const double phase = std::atan2(e2[i], arc.radial[i]);
    const double a = arc.angle * f0 - phase, b = arc.angle * f1 - phase;
    const Range c = cosine_range(std::min(a, b), std::max(a, b));
    const double z0 = arc.rise * f0 * arc.normal[i], z1 = arc.rise * f1 * arc.normal[i];
    // Rounding of cos and of the sums: a few units in the last place of the largest term.
    const double slack = 4e-15 * (std::abs(foot[i]) + r_high + std::abs(arc.rise) + 1);
    out.low[axis] =
        foot[i] + g * std::min(r_low * c.low, r_high * c.low) + std::min(z0, z1) - slack;
    out.high[axis] =
        foot[i] + g * std::max(r_low * c.high, r_high * c.high) + std::max(z0, z1) + slack;
    out.travel[axis] = g * (r_high * c.travel + (r_high - r_low)) + std::abs(z1 - z0) + 2 * slack;
  }
  return out;
}

machine::TipInterval bounds_blend(const Blend& blend, double s0, double s1) {
  const double u0 = std::clamp(parameter_at(blend, s0).u, 0.0, 1.0);
  const double u1 = std::clamp(parameter_at(blend, s1).u, u0, 1.0);
  machine::TipInterval out;
  const std::size_t axes = blend.xyz_only ? 3 : 9;
  out.low = out.high = blend.control[0];
  for (std::size_t k = 0; k < axes; ++k) {
    const Axis axis = all_axes[k];
    std::array<double, 6> part{};
    double size = 0;
    for (std::size_t i = 0; i < 6; ++i) {
      part[i] = blend.control[i].value[k];
      size = std::max(size, std::abs(part[i]));
    }
    part = control_between(part, u0, u1);
    double low = part[0], high = low, travel = 0;
    for (std::size_t i = 1; i < 6; ++i) {
      low = std::min(low, part[i]);
      high = std::max(high, part[i]);
      travel += std::abs(part[i] - part[i - 1]);
    }
    const double slack = high > low ? 1e-14 * size : 0;
    out.low[axis] = low - slack;
    out.high[axis] = high + slack;
    out.travel[axis] = travel + 2 * slack;
  }
  return out;
}

// Only its joints have bounds (motion.h).
machine::TipInterval boundless() {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  machine::TipInterval out;
  out.low.value.fill(-infinity);
  out.high.value.fill(infinity);
  out.travel.value.fill(infinity);
  return out;
}

}  // namespace

Vec3 foot_of(const Arc& arc) {
  const Vec3 start(arc.start[Axis::x], arc.start[Axis::y], arc.start[Axis::z]);
  return arc.centre + (start - arc.centre).dot(arc.normal) * arc.normal;
}

double length(const Path& path) {
  return std::visit(
      overloaded{[](const Hold&) { return 0.0; }, [](const Line& line) { return line.length; },
                 [](const Arc& arc) { return arc.length; },
                 [](const Blend& blend) { return blend.length; },
                 [](const JointWay& way) { return way.length; }},
      path);
}

PathPoint evaluate(const Path& path, double s) {
  return std::visit(overloaded{[](const Hold& hold) {
                                 return PathPoint{hold.at, {}, {}};
                               },
                               [s](const Line& line) { return evaluate_line(line, s); },
                               [s](const Arc& arc) { return evaluate_arc(arc, s); },
                               [s](const Blend& blend) { return evaluate_blend(blend, s); },
                               [s](const JointWay& way) { return evaluate_joint_way(way, s); }},
                    path);
}

machine::TipInterval bounds(const Path& path, double s0, double s1) {
  return std::visit(overloaded{[](const Hold& hold) {
                                 return machine::TipInterval{hold.at, hold.at, {}, {}};
                               },
                               [&](const Line& line) { return bounds_line(line, s0, s1); },
                               [&](const Arc& arc) { return bounds_arc(arc, s0, s1); },
                               [&](const Blend& blend) { return bounds_blend(blend, s0, s1); },
                               [](const JointWay&) { return boundless(); }},
                    path);
}

TimeUse time_use(const Segment& segment) {
  if (segment.spindle_from) return TimeUse::spindle_wait;
  switch (segment.kind) {
    case MotionKind::rapid:
      return TimeUse::rapid;
    case MotionKind::sync:
      return std::holds_alternative<Hold>(segment.path) ? TimeUse::spindle_wait : TimeUse::feed;
    case MotionKind::feed:
    case MotionKind::arc:
    case MotionKind::blend:
    case MotionKind::probe:
      return TimeUse::feed;
    case MotionKind::tool_change:
      return TimeUse::tool_change;
    case MotionKind::idle:
    case MotionKind::dwell:
      break;
  }
  return TimeUse::rest;
}

std::string_view to_string(MotionKind kind) {
  switch (kind) {
    case MotionKind::idle:
      return "idle";
    case MotionKind::rapid:
      return "rapid";
    case MotionKind::feed:
      return "feed";
    case MotionKind::arc:
      return "arc";
    case MotionKind::tool_change:
      return "tool change";
    case MotionKind::probe:
      return "probe";
    case MotionKind::dwell:
      return "dwell";
    case MotionKind::sync:
      return "sync";
    case MotionKind::blend:
      return "blend";
  }
  return "idle";
}

}  // namespace aircut::plan
