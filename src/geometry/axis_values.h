// The nine axes of a program and a number for each. A joint belongs to the machine, an axis to the
// program.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

namespace aircut {

enum class Axis : unsigned char { x, y, z, a, b, c, u, v, w };

inline constexpr std::array<Axis, 9> all_axes = {Axis::x, Axis::y, Axis::z, Axis::a, Axis::b,
                                                 Axis::c, Axis::u, Axis::v, Axis::w};

constexpr std::size_t index(Axis axis) { return static_cast<std::size_t>(axis); }
constexpr bool is_rotary(Axis axis) { return axis >= Axis::a && axis <= Axis::c; }
constexpr char letter(Axis axis) { return "XYZABCUVW"[index(axis)]; }
/// The axis of a letter of either case, or nothing.
constexpr std::optional<Axis> axis_of_letter(char c) {
  switch (c | 32) {
    case 'x':
    case 'y':
    case 'z':
      return static_cast<Axis>((c | 32) - 'x');
    case 'a':
    case 'b':
    case 'c':
      return static_cast<Axis>((c | 32) - 'a' + 3);
    case 'u':
    case 'v':
    case 'w':
      return static_cast<Axis>((c | 32) - 'u' + 6);
    default:
      return std::nullopt;
  }
}

/// One number per axis: mm for X Y Z U V W, rad for A B C.
struct AxisValues {
  std::array<double, 9> value{};

  double& operator[](Axis axis) { return value[index(axis)]; }
  double operator[](Axis axis) const { return value[index(axis)]; }
  bool operator==(const AxisValues&) const = default;

  AxisValues& operator+=(const AxisValues& other) {
    for (const Axis axis : all_axes) (*this)[axis] += other[axis];
    return *this;
  }
  AxisValues& operator-=(const AxisValues& other) {
    for (const Axis axis : all_axes) (*this)[axis] -= other[axis];
    return *this;
  }
  friend AxisValues operator+(AxisValues a, const AxisValues& b) { return a += b; }
  friend AxisValues operator-(AxisValues a, const AxisValues& b) { return a -= b; }
  friend AxisValues operator*(double factor, AxisValues a) {
    for (double& v : a.value) v *= factor;
    return a;
  }
};

/// A set of axes, as bits.
struct AxisSet {
  unsigned bits = 0;

  constexpr bool has(Axis axis) const { return (bits >> index(axis) & 1u) != 0; }
  constexpr void add(Axis axis) { bits |= 1u << index(axis); }
  constexpr bool empty() const { return bits == 0; }
  bool operator==(const AxisSet&) const = default;
};

}  // namespace aircut
