// A NURBS over clamped, uniform knots 0 … 0 1 2 … m … m, as RS274's G5.2 has it. A Bezier curve is
// one with as many points as its order.
//
// In homogeneous coordinates (w x, w y, w) the curve is a polynomial spline, whose derivative is a
// spline over the differences of its points:
//
//   A(u) = (w C, w):   C' = (A' − w' C) / w,   C'' = (A'' − 2 w' C' − w'' C) / w
//
// Between two knots the piece with the same ends, tangents and second derivatives of degree 5 is
// taken: the very curve where that is a polynomial of degree 5 or less. Elsewhere it is halved
// until it fits.
#include "plan/spline.h"

#include <algorithm>
#include <cmath>

namespace aircut::plan {
namespace {

constexpr double fit = 1e-5;  // mm
constexpr int deepest = 10;

using Points = std::vector<Vec3>;  // (w x, w y, w)

struct Spline {
  Points points;
  std::vector<double> knots;
  std::size_t degree = 0;

  // De Boor's triangle on the span that holds u; `span` is the knot before it.
  Vec3 at(double u, std::size_t span) const {
    std::array<Vec3, 20> d;
    for (std::size_t i = 0; i <= degree; ++i) d[i] = points[span - degree + i];
    for (std::size_t r = 1; r <= degree; ++r)
      for (std::size_t i = degree; i >= r; --i) {
        const double low = knots[span - degree + i], high = knots[span + 1 + i - r];
        const double f = (u - low) / (high - low);
        d[i] = (1 - f) * d[i - 1] + f * d[i];
      }
    return d[degree];
  }

  Spline derivative() const {
    Spline out;
    if (degree == 0) {
      out = *this;
      for (Vec3& p : out.points) p.setZero();
      return out;
    }
    out.degree = degree - 1;
    out.knots.assign(knots.begin() + 1, knots.end() - 1);
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      const double width = knots[i + degree + 1] - knots[i + 1];
      out.points.push_back(static_cast<double>(degree) / width * (points[i + 1] - points[i]));
    }
    return out;
  }
};

struct Place {
  Eigen::Vector2d p, d, dd;
};

class Curve {
 public:
  explicit Curve(const canon::SplineFeed& spline) {
    const std::size_t n = spline.points.size();
    whole_.degree = static_cast<std::size_t>(spline.order) - 1;
    for (const auto& point : spline.points)
      whole_.points.emplace_back(point.weight * point.x, point.weight * point.y, point.weight);
    spans_ = n - whole_.degree;
    for (std::size_t i = 0; i <= whole_.degree; ++i) whole_.knots.push_back(0);
    for (std::size_t i = 1; i < spans_; ++i) whole_.knots.push_back(static_cast<double>(i));
    for (std::size_t i = 0; i <= whole_.degree; ++i)
      whole_.knots.push_back(static_cast<double>(spans_));
    first_ = whole_.derivative();
    second_ = first_.derivative();
  }

  std::size_t spans() const { return spans_; }

  Place at(std::size_t span, double u) const {
    const auto knot = [span](const Spline& s) { return s.degree + span; };
    const Vec3 a = whole_.at(u, knot(whole_)), da = first_.at(u, knot(first_));
    const Vec3 dda = whole_.degree >= 2 ? second_.at(u, knot(second_)) : Vec3(Vec3::Zero());
    const double w = a.z();
    Place out;
    out.p = a.head<2>() / w;
    out.d = (da.head<2>() - da.z() * out.p) / w;
    out.dd = (dda.head<2>() - 2 * da.z() * out.d - dda.z() * out.p) / w;
    return out;
  }

 private:
  Spline whole_, first_, second_;
  std::size_t spans_ = 0;
};

using Control = std::array<Eigen::Vector2d, 6>;

Control hermite(const Place& a, const Place& b, double h) {
  Control c;
  c[0] = a.p;
  c[1] = a.p + h / 5 * a.d;
  c[2] = a.p + 2 * h / 5 * a.d + h * h / 20 * a.dd;
  c[3] = b.p - 2 * h / 5 * b.d + h * h / 20 * b.dd;
  c[4] = b.p - h / 5 * b.d;
  c[5] = b.p;
  return c;
}

Eigen::Vector2d value(Control c, double f) {
  for (std::size_t n = 5; n > 0; --n)
    for (std::size_t i = 0; i < n; ++i) c[i] += f * (c[i + 1] - c[i]);
  return c[0];
}

void add(const Curve& curve, std::size_t span, double u0, double u1, int depth,
         std::vector<Control>& out) {
  const Control c = hermite(curve.at(span, u0), curve.at(span, u1), u1 - u0);
  double off = 0;
  for (int k = 1; k < 8; ++k) {
    const double f = k / 8.0;
    off = std::max(off, (value(c, f) - curve.at(span, u0 + f * (u1 - u0)).p).norm());
  }
  if (off > fit && depth < deepest) {
    add(curve, span, u0, (u0 + u1) / 2, depth + 1, out);
    add(curve, span, (u0 + u1) / 2, u1, depth + 1, out);
    return;
  }
  out.push_back(c);
}

}  // namespace

std::vector<Blend> spline_pieces(const AxisValues& start, const canon::SplineFeed& spline) {
  const Curve curve(spline);
  std::vector<Control> flat;
  for (std::size_t span = 0; span < curve.spans(); ++span)
    add(curve, span, static_cast<double>(span), static_cast<double>(span + 1), 0, flat);
  std::vector<Blend> out;
  for (const Control& c : flat) {
    std::array<AxisValues, 6> control;
    double way = 0;
    for (std::size_t i = 0; i < 6; ++i) {
      control[i] = start;
      control[i][Axis::x] = c[i].x();
      control[i][Axis::y] = c[i].y();
      if (i > 0) way += (c[i] - c[i - 1]).norm();
    }
    if (way > zero_length) out.push_back(make_curve(control));
  }
  return out;
}

}  // namespace aircut::plan
