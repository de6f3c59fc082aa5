// Fitting a Bezier's parameter to the length of its way.
//
// Along u the tip's speed |B'(u)| changes. If a blend ran along u, keeping a steady speed would
// need a path acceleration that swings by many times what the joints' limits leave for the corner,
// and it would have to be constant between nodes. So u is made a polynomial of the way s: with the
// length G(u) = ∫ |B'|, u(s) = G⁻¹(s) is taken at Chebyshev's points and interpolated. All
// derivatives come from that polynomial by the chain rule, so they are exact for the curve as it is
// run; that its speed is 1 only to about 1e-4 does no harm.
//
//   y = 2 s / whole − 1,  y_j = cos(π j / N),  u(y) = Σ'' c_k T_k(y),  c_k = 2/N Σ'' u(y_j)
//   T_k(y_j)
//
// (Σ'': first and last term halved), then written out by powers of y.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "plan/geometry.h"

namespace aircut::plan {
namespace {

constexpr std::size_t degree = std::tuple_size_v<decltype(Blend::u_of_y)> - 1;
constexpr std::size_t panels = 16;

Vec3 xyz_of(const AxisValues& p) { return {p[Axis::x], p[Axis::y], p[Axis::z]}; }

// |B'(u)| along XYZ and its integral.
class Way {
 public:
  explicit Way(const std::array<AxisValues, 6>& control) {
    for (std::size_t i = 0; i < 5; ++i) leg_[i] = 5 * xyz_of(control[i + 1] - control[i]);
    for (std::size_t i = 0; i < panels; ++i)
      sum_[i + 1] = sum_[i] + part(static_cast<double>(i) / panels, 1.0 / panels);
  }

  double speed(double u) const {
    const double v = 1 - u;
    const double u2 = u * u, v2 = v * v;
    return (v2 * v2 * leg_[0] + 4 * v2 * v * u * leg_[1] + 6 * v2 * u2 * leg_[2] +
            4 * v * u2 * u * leg_[3] + u2 * u2 * leg_[4])
        .norm();
  }
  double whole() const { return sum_.back(); }

  // u with G(u) = s, by Newton's steps inside the panel that holds it.
  double u_at(double s) const {
    const auto above = std::upper_bound(sum_.begin(), sum_.end(), s);
    const auto panel = static_cast<std::size_t>(
        std::clamp<std::ptrdiff_t>(above - sum_.begin() - 1, 0, panels - 1));
    const double low = static_cast<double>(panel) / panels;
    double step = (s - sum_[panel]) / (sum_[panel + 1] - sum_[panel]) / panels;
    for (int i = 0; i < 4; ++i) {
      const double error = part(low, step) - (s - sum_[panel]);
      step -= error / std::max(speed(low + step), 1e-300);
      step = std::clamp(step, 0.0, 1.0 / panels);
    }
    return low + step;
  }

 private:
  // Gauss's rule with four points over [u, u + size].
  double part(double u, double size) const {
    constexpr std::array<double, 4> x = {0.0694318442029737, 0.3300094782075719, 0.6699905217924281,
                                         0.9305681557970263};
    constexpr std::array<double, 4> w = {0.1739274225687269, 0.3260725774312731, 0.3260725774312731,
                                         0.1739274225687269};
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) sum += w[i] * speed(u + size * x[i]);
    return size * sum;
  }

  std::array<Vec3, 5> leg_;
  std::array<double, panels + 1> sum_{};
};

using Powers = std::array<double, degree + 1>;

constexpr Powers along_u = {0.5, 0.5};

// Row i, column j: what the value at y_j adds to the coefficient of y^i. The same for all curves.
using Matrix = std::array<Powers, degree + 1>;

Matrix interpolation() {
  const auto half_at_ends = [](std::size_t i) { return i == 0 || i == degree ? 0.5 : 1.0; };
  Matrix out{};
  Powers before{}, now{};  // T_{k−1}, T_k by powers of y
  now[0] = 1;
  for (std::size_t k = 0; k <= degree; ++k) {
    for (std::size_t j = 0; j <= degree; ++j) {
      const double c = 2.0 / degree * half_at_ends(k) * half_at_ends(j) *
                       std::cos(std::numbers::pi * static_cast<double>(k * j) / degree);
      for (std::size_t i = 0; i <= degree; ++i) out[i][j] += c * now[i];
    }
    Powers next{};  // T_{k+1} = 2 y T_k − T_{k−1}, T_1 = y
    for (std::size_t i = 0; i < degree; ++i) next[i + 1] = (k == 0 ? 1 : 2) * now[i];
    for (std::size_t i = 0; i <= degree; ++i) next[i] -= before[i];
    before = now;
    now = next;
  }
  return out;
}

// Interpolating polynomial through values at y_j = cos(π j / degree), by powers of y.
Powers through(const Powers& values) {
  static const Matrix matrix = interpolation();  // a constant that the compiler can't make
  Powers out{};
  for (std::size_t i = 0; i <= degree; ++i)
    for (std::size_t j = 0; j <= degree; ++j) out[i] += matrix[i][j] * values[j];
  return out;
}

Powers chebyshev_nodes() {
  Powers out{};
  for (std::size_t j = 0; j <= degree; ++j)
    out[j] = std::cos(std::numbers::pi * static_cast<double>(j) / degree);
  return out;
}

bool keeps_others(const std::array<AxisValues, 6>& control) {
  for (const AxisValues& p : control)
    for (std::size_t k = 3; k < p.value.size(); ++k)
      if (p.value[k] != control[0].value[k]) return false;
  return true;
}

bool rises(const Powers& polynomial) {
  for (int k = 0; k <= 32; ++k) {
    const double y = k / 16.0 - 1;
    double value = 0, slope = 0;
    for (std::size_t i = polynomial.size(); i-- > 0;) {
      slope = slope * y + value;
      value = value * y + polynomial[i];
    }
    if (!(slope > 0)) return false;
  }
  return true;
}

}  // namespace

Blend make_curve(const std::array<AxisValues, 6>& control) {
  const Way way(control);
  Blend out;
  out.control = control;
  out.xyz_only = keeps_others(control);
  out.whole = out.length = way.whole();
  Powers values{};
  for (std::size_t j = 0; j <= degree; ++j) {
    static const Powers nodes = chebyshev_nodes();
    values[j] = j == 0 ? 1 : j == degree ? 0 : way.u_at((nodes[j] + 1) / 2 * way.whole());
  }
  out.u_of_y = through(values);
  if (!rises(out.u_of_y)) {
    // A way that nearly stops inside (a cusp) has no smooth inverse: run along u.
    out.u_of_y = along_u;
  }
  return out;
}

Blend scaled_curve(const Blend& like, const std::array<AxisValues, 6>& control, double scale) {
  Blend out = like;
  out.control = control;
  out.xyz_only = keeps_others(control);
  out.whole = scale * like.whole;
  out.begin = scale * like.begin;
  out.length = scale * like.length;
  return out;
}

bool runs_along_u(const Blend& blend) { return blend.u_of_y == along_u; }

}  // namespace aircut::plan
