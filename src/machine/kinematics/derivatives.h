// Numbers that carry derivatives, so that one closed form of an inverse gives joints, rates and
// travel bounds:
//
//   Jet    value, first and second derivative along a path
//   Slope  an interval of values over a box of poses, with an interval of each partial derivative
//
// With f = f(a), per path parameter: f' = f_a a', f'' = f_aa a'² + f_a a''.
// Functions here are found by name for both and for double: sin, cos, sqrt, atan2, acos, square.
#pragma once

#include <array>
#include <cmath>

#include "machine/kinematics/interval.h"

namespace aircut::machine {

inline double square(double a) { return a * a; }

struct Jet {
  double v = 0, d = 0, dd = 0;
  Jet() = default;
  Jet(double value) : v(value) {}  // NOLINT: a constant
  Jet(double value, double first, double second) : v(value), d(first), dd(second) {}
};

inline Jet operator+(const Jet& a, const Jet& b) { return {a.v + b.v, a.d + b.d, a.dd + b.dd}; }
inline Jet operator-(const Jet& a, const Jet& b) { return {a.v - b.v, a.d - b.d, a.dd - b.dd}; }
inline Jet operator-(const Jet& a) { return {-a.v, -a.d, -a.dd}; }
inline Jet operator*(const Jet& a, const Jet& b) {
  return {a.v * b.v, a.d * b.v + a.v * b.d, a.dd * b.v + 2 * a.d * b.d + a.v * b.dd};
}
inline Jet operator/(const Jet& a, const Jet& b) {
  const double v = a.v / b.v, d = (a.d - v * b.d) / b.v;
  return {v, d, (a.dd - 2 * d * b.d - v * b.dd) / b.v};
}
inline Jet chain(const Jet& a, double f, double df, double ddf) {
  return {f, df * a.d, ddf * a.d * a.d + df * a.dd};
}
inline Jet square(const Jet& a) { return a * a; }
inline Jet sin(const Jet& a) { return chain(a, std::sin(a.v), std::cos(a.v), -std::sin(a.v)); }
inline Jet cos(const Jet& a) { return chain(a, std::cos(a.v), -std::sin(a.v), -std::cos(a.v)); }
inline Jet sqrt(const Jet& a) {
  const double root = std::sqrt(a.v);
  return chain(a, root, 0.5 / root, -0.25 / (root * a.v));
}
inline Jet acos(const Jet& a) {
  const double s2 = (1 - a.v) * (1 + a.v), s = std::sqrt(s2);
  return chain(a, std::acos(a.v), -1 / s, -a.v / (s * s2));
}
inline Jet atan2(const Jet& y, const Jet& x) {
  const double rho = x.v * x.v + y.v * y.v;
  const double first = (x.v * y.d - y.v * x.d) / rho;
  const double second = (x.v * y.dd - y.v * x.dd) / rho - first * 2 * (x.v * x.d + y.v * y.d) / rho;
  return {std::atan2(y.v, x.v), first, second};
}

struct Slope {
  static constexpr std::size_t inputs = 6;  ///< x y z A B C
  Interval v;
  std::array<Interval, inputs> d{};
  Slope() = default;
  Slope(double value) : v(value) {}  // NOLINT: a constant
  explicit Slope(const Interval& value) : v(value) {}
};

template <class Function>
Slope per_input(const Interval& value, Function&& derivative) {
  Slope out(value);
  for (std::size_t i = 0; i < Slope::inputs; ++i) out.d[i] = derivative(i);
  return out;
}

inline Slope operator+(const Slope& a, const Slope& b) {
  return per_input(a.v + b.v, [&](std::size_t i) { return a.d[i] + b.d[i]; });
}
inline Slope operator-(const Slope& a, const Slope& b) {
  return per_input(a.v - b.v, [&](std::size_t i) { return a.d[i] - b.d[i]; });
}
inline Slope operator-(const Slope& a) {
  return per_input(-a.v, [&](std::size_t i) { return -a.d[i]; });
}
inline Slope operator*(const Slope& a, const Slope& b) {
  return per_input(a.v * b.v, [&](std::size_t i) { return a.d[i] * b.v + a.v * b.d[i]; });
}
inline Slope operator/(const Slope& a, const Slope& b) {
  const Interval v = a.v / b.v;
  return per_input(v, [&](std::size_t i) { return (a.d[i] - v * b.d[i]) / b.v; });
}
inline Slope chain(const Slope& a, const Interval& f, const Interval& df) {
  return per_input(f, [&](std::size_t i) { return df * a.d[i]; });
}
inline Slope square(const Slope& a) { return chain(a, square(a.v), Interval(2) * a.v); }
inline Slope sin(const Slope& a) { return chain(a, sin(a.v), cos(a.v)); }
inline Slope cos(const Slope& a) { return chain(a, cos(a.v), -sin(a.v)); }
inline Slope sqrt(const Slope& a) {
  const Interval root = sqrt(a.v);
  return chain(a, root, Interval(0.5) / root);
}
inline Slope acos(const Slope& a) {
  const Interval s2 = (Interval(1) - a.v) * (Interval(1) + a.v);
  return chain(a, acos(a.v), Interval(-1) / sqrt(s2));
}
inline Slope atan2(const Slope& y, const Slope& x) {
  const Interval rho = square(x.v) + square(y.v);
  return per_input(atan2(y.v, x.v),
                   [&](std::size_t i) { return (x.v * y.d[i] - y.v * x.d[i]) / rho; });
}

}  // namespace aircut::machine
