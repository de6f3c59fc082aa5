// The outline of what a section sweeps is walked: the lines that its discs draw on both sides of
// their way, and the section's own outline where the move ends. (Where it began the last move
// ended.) How far a point is outside of the part changes by no more than the way between two
// points, so a step may be as long as the distance that was measured allows:
//
//   two looks s apart with d at the first   ⇒   nothing between them is below d − s/2
//
// With s = 2 (d + tolerance + bound) nothing deeper than tolerance + bound is passed over. Far from
// the part the steps are long; along its finished surface they are some hundredths of a millimetre.
//
// Outside of the raw bar the part is at least as far away as the bar. Inside, it is asked at eight
// places around, as in the end (Part::compare).
#include "sim/checks/turning_gouge.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace aircut::sim {

namespace {

struct Point {
  double r = 0, z = 0;
};

class Walk {
 public:
  Walk(const stock::Part& part, const RawBar& bar, double tolerance, double bound,
       const std::function<bool(double, double)>& is_material)
      : part_(part), bar_(bar), tolerance_(tolerance), bound_(bound), is_material_(is_material) {}

  /// `at(s)` for s from 0 to `length` moves no faster than s.
  template <class At>
  void along(double length, At at) {
    for (double s = 0;;) {
      const double outside = look(at(s));
      if (s >= length) return;
      s = std::min(length, s + 2 * std::max(outside + tolerance_ + bound_, bound_));
    }
  }
  void line(const Point& p, const Point& q) {
    const double length = std::hypot(q.r - p.r, q.z - p.z);
    along(length, [&](double s) {
      const double f = length > 0 ? s / length : 0;
      return Point{p.r + f * (q.r - p.r), p.z + f * (q.z - p.z)};
    });
  }
  void circle(const Point& centre, double radius) {
    along(2 * std::numbers::pi * radius, [&](double s) {
      const double a = radius > 0 ? s / radius : 0;
      return Point{centre.r + radius * std::cos(a), centre.z + radius * std::sin(a)};
    });
  }
  const std::optional<TurningGouge>& deepest() const { return deepest_; }

 private:
  double look(const Point& p) {
    const double off_bar = std::hypot(std::max(0.0, std::abs(p.r) - bar_.radius),
                                      std::max({0.0, -p.z, p.z - bar_.height}));
    if (off_bar > 0) return off_bar;
    double outside = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 8; ++i) {
      const double a = i * std::numbers::pi / 4;
      outside = std::min(outside, part_.outside({p.r * std::cos(a), p.r * std::sin(a), p.z}));
    }
    const double deepest = deepest_ ? deepest_->depth : tolerance_;
    if (-outside > deepest && is_material_(std::abs(p.r), p.z))
      deepest_ = TurningGouge{-outside, std::abs(p.r), p.z};
    return outside;
  }

  const stock::Part& part_;
  RawBar bar_;
  double tolerance_, bound_;
  const std::function<bool(double, double)>& is_material_;
  std::optional<TurningGouge> deepest_;
};

}  // namespace

std::optional<TurningGouge> deepest_in_part(
    const stock::TurningMove& move, const stock::Part& part, const RawBar& bar, double tolerance,
    double bound, const std::function<bool(double, double)>& is_material) {
  Walk walk(part, bar, tolerance, bound, is_material);
  const std::vector<stock::TurningSection::Disc>& discs = move.section->discs;
  const auto start = [&](const auto& disc) { return Point{disc.r + move.r0, disc.z + move.z0}; };
  const auto end = [&](const auto& disc) { return Point{disc.r + move.r1, disc.z + move.z1}; };
  const double way_r = move.r1 - move.r0, way_z = move.z1 - move.z0;
  const double way = std::hypot(way_r, way_z);
  for (std::size_t i = 0; i < discs.size(); ++i) {
    const Point from = start(discs[i]), to = end(discs[i]);
    const double radius = discs[i].radius;
    for (const double side : {-1.0, 1.0}) {
      if (way == 0 || (radius == 0 && side > 0)) break;
      const double dr = -side * radius * way_z / way, dz = side * radius * way_r / way;
      walk.line({from.r + dr, from.z + dz}, {to.r + dr, to.z + dz});
    }
    walk.circle(to, radius);
    // The lines that touch two discs from outside.
    for (std::size_t j = i + 1; j < discs.size(); ++j) {
      const Point other = end(discs[j]);
      const double dr = other.r - to.r, dz = other.z - to.z, length = std::hypot(dr, dz);
      if (length <= std::abs(radius - discs[j].radius)) continue;  // one lies in the other
      const double along = (radius - discs[j].radius) / length;
      const double across = std::sqrt(std::max(0.0, 1 - along * along));
      const bool corners = radius == 0 && discs[j].radius == 0;  // both lines are one
      for (const double side : {-1.0, 1.0}) {
        if (corners && side > 0) break;
        const double nr = (along * dr - side * across * dz) / length;
        const double nz = (along * dz + side * across * dr) / length;
        walk.line({to.r + radius * nr, to.z + radius * nz},
                  {other.r + discs[j].radius * nr, other.z + discs[j].radius * nz});
      }
    }
  }
  return walk.deepest();
}

}  // namespace aircut::sim
