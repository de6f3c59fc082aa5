// Intervals with outward rounding: the result of an operation holds every value that the operation
// can have for operands in the intervals, rounding included. `everything()` stands for "no bound is
// known" and swallows all that it meets.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace aircut::machine {

struct Interval {
  double low = 0, high = 0;

  Interval() = default;
  Interval(double value) : low(value), high(value) {}  // NOLINT: a number is an interval
  Interval(double l, double h) : low(l), high(h) {}

  static Interval everything() {
    constexpr double inf = std::numeric_limits<double>::infinity();
    return {-inf, inf};
  }
  bool finite() const { return std::isfinite(low) && std::isfinite(high); }
  double middle() const { return low + (high - low) / 2; }
  double magnitude() const { return std::max(std::abs(low), std::abs(high)); }
};

// Wider by four units in the last place: more than an operation or a function of the C library
// (glibc: at most two) can be off.
inline Interval widened(double low, double high) {
  constexpr double ulps = 4 * std::numeric_limits<double>::epsilon();
  constexpr double tiny = std::numeric_limits<double>::min();
  low -= std::abs(low) * ulps + tiny;
  high += std::abs(high) * ulps + tiny;
  return low <= high && std::isfinite(low) && std::isfinite(high) ? Interval(low, high)
                                                                  : Interval::everything();
}

inline Interval operator+(const Interval& a, const Interval& b) {
  return widened(a.low + b.low, a.high + b.high);
}
inline Interval operator-(const Interval& a) { return {-a.high, -a.low}; }
inline Interval operator-(const Interval& a, const Interval& b) {
  return widened(a.low - b.high, a.high - b.low);
}
inline Interval operator*(const Interval& a, const Interval& b) {
  if (!a.finite() || !b.finite()) return Interval::everything();
  const double p = a.low * b.low, q = a.low * b.high, r = a.high * b.low, s = a.high * b.high;
  return widened(std::min(std::min(p, q), std::min(r, s)),
                 std::max(std::max(p, q), std::max(r, s)));
}
inline Interval operator/(const Interval& a, const Interval& b) {
  if (!(b.low > 0) && !(b.high < 0)) return Interval::everything();
  return a * widened(1 / b.high, 1 / b.low);
}
inline Interval square(const Interval& a) {
  if (!a.finite()) return Interval::everything();
  const double l = a.low * a.low, h = a.high * a.high;
  const bool has_zero = a.low <= 0 && a.high >= 0;
  const Interval out = widened(has_zero ? 0 : std::min(l, h), std::max(l, h));
  return {std::max(out.low, 0.0), out.high};
}
/// Of values that are above zero for certain; otherwise no bound.
inline Interval sqrt(const Interval& a) {
  if (!(a.low > 0)) return Interval::everything();
  return widened(std::sqrt(a.low), std::sqrt(a.high));
}

inline Interval cos(const Interval& a) {
  constexpr double pi = std::numbers::pi;
  if (!a.finite()) return Interval::everything();
  const double l = std::cos(a.low), h = std::cos(a.high);
  Interval out = widened(std::min(l, h), std::max(l, h));
  // Extremes at k·π; an interval that may hold one has it.
  constexpr double slack = 1e-12;
  const auto holds = [&](double offset) {
    return std::ceil((a.low - slack - offset) / (2 * pi)) * 2 * pi + offset <= a.high + slack;
  };
  if (holds(0)) out.high = 1;
  if (holds(pi)) out.low = -1;
  return {std::max(out.low, -1.0), std::min(out.high, 1.0)};
}
inline Interval sin(const Interval& a) {
  return cos(a - widened(std::numbers::pi / 2, std::numbers::pi / 2));
}

/// Angles of a box that keeps clear of the origin. They are one piece of the circle, given near
/// the angle of the box's middle, so no jump at ±π is in it.
inline Interval atan2(const Interval& y, const Interval& x) {
  if (!x.finite() || !y.finite()) return Interval::everything();
  const double middle = std::atan2(y.middle(), x.middle());
  const Interval c(std::cos(middle)), s(std::sin(middle));
  const Interval u = widened(c.low, c.high) * x + widened(s.low, s.high) * y;
  const Interval v = widened(c.low, c.high) * y - widened(s.low, s.high) * x;
  if (!(u.low > 0)) return Interval::everything();
  // For u > 0 the angle grows with v, and its extremes over u are at the ends.
  const double high = std::max(std::atan2(v.high, u.low), std::atan2(v.high, u.high));
  const double low = std::min(std::atan2(v.low, u.low), std::atan2(v.low, u.high));
  return widened(middle, middle) + widened(low, high);
}
inline Interval acos(const Interval& a) {
  if (!(a.low > -1 && a.high < 1)) return Interval::everything();
  return widened(std::acos(a.high), std::acos(a.low));
}

}  // namespace aircut::machine
