// Vectors of any number type (double, Jet, Slope, Interval): what closed forms are written in.
#pragma once

#include <array>
#include <cmath>

#include "geometry/geometry.h"
#include "machine/kinematics/derivatives.h"

namespace aircut::machine {

template <class T>
using Vector = std::array<T, 3>;

template <class T>
Vector<T> vector_of(const Vec3& v) {
  return {T(v.x()), T(v.y()), T(v.z())};
}

/// With a constant vector; its zeros cost nothing and add no width.
template <class T>
T dot(const Vec3& a, const Vector<T>& b) {
  T sum(0);
  for (int i = 0; i < 3; ++i)
    if (a[i] != 0) sum = sum + T(a[i]) * b[static_cast<std::size_t>(i)];
  return sum;
}

template <class T>
T dot(const Vector<T>& a, const Vector<T>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class T>
Vector<T> cross(const Vector<T>& a, const Vector<T>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// A turn about a constant unit vector (Rodrigues), by its matrix' entries.
template <class T>
struct Turn {
  std::array<Vector<T>, 3> rows;
  Turn(const Vec3& u, const T& angle) {
    using std::cos;
    using std::sin;
    const T c = cos(angle), s = sin(angle), v = T(1) - c;
    const Mat3 K = skew(u);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        T entry = u[i] * u[j] == 0 ? T(0) : T(u[i] * u[j]) * v;
        if (i == j) entry = entry + c;
        if (K(i, j) != 0) entry = entry + T(K(i, j)) * s;
        rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = entry;
      }
  }
  Vector<T> operator()(const Vector<T>& p) const {
    return {dot(rows[0], p), dot(rows[1], p), dot(rows[2], p)};
  }
  static Mat3 skew(const Vec3& u) {
    Mat3 K;
    K << 0, -u.z(), u.y(), u.z(), 0, -u.x(), -u.y(), u.x(), 0;
    return K;
  }
};

template <class T>
Vector<T> operator+(const Vector<T>& a, const Vector<T>& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
template <class T>
Vector<T> operator-(const Vector<T>& a, const Vector<T>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <class T>
T squared_norm(const Vector<T>& a) {
  return square(a[0]) + square(a[1]) + square(a[2]);
}
inline Vec3 vec3(const Vector<double>& v) { return {v[0], v[1], v[2]}; }

/// Three axes in a matrix of any number type.
template <class T>
struct Rotation {
  std::array<Vector<T>, 3> rows;

  /// Rz(c) · Ry(b) · Rx(a): about the fixed X, then Y, then Z axis.
  static Rotation about_fixed(const T& a, const T& b, const T& c) {
    using std::cos;
    using std::sin;
    const T ca = cos(a), sa = sin(a), cb = cos(b), sb = sin(b), cc = cos(c), sc = sin(c);
    return {{{{cc * cb, cc * sb * sa - sc * ca, cc * sb * ca + sc * sa},
              {sc * cb, sc * sb * sa + cc * ca, sc * sb * ca - cc * sa},
              {-sb, cb * sa, cb * ca}}}};
  }
  Vector<T> operator()(const Vec3& p) const {
    return {dot(p, rows[0]), dot(p, rows[1]), dot(p, rows[2])};
  }
};

}  // namespace aircut::machine
