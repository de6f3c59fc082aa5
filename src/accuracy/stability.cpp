// Milling: the force that a vibration makes through the chip thickness is averaged over a
// revolution (zeroth order of its Fourier series). That leaves a 2×2 matrix of direction factors α
// between the angles of entry and exit; with the responses G of the two modes, the cut is at its
// limit where a0 Λ² + a1 Λ + 1 = 0. Λ gives the depth, its phase the speeds. Poor below a_e/D of
// about 0.1.
//
// Source: Y. Altintas, E. Budak, Analytical prediction of stability lobes in milling, CIRP Annals
// 1995.
#include "accuracy/stability.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aircut::accuracy {

using std::numbers::pi;

std::complex<double> Mode::response(double hz) const {
  const double r = hz / frequency;
  return 1.0 / (stiffness * std::complex<double>(1 - r * r, 2 * damping * r));
}

double turning_limit(const Mode& mode, double force) {
  return 2 * mode.stiffness * mode.damping * (1 + mode.damping) / force;
}

std::vector<MillingLimit> milling_limits(int teeth, const Engagement& phi, double K_t, double K_r,
                                         const Mode& x, const Mode& y, double hz, int lobes) {
  const auto span = [&](auto g) { return 0.5 * (g(phi.exit) - g(phi.start)); };
  const auto c2 = [](double p) { return std::cos(2 * p); };
  const auto s2 = [](double p) { return std::sin(2 * p); };
  const double xx = span([&](double p) { return c2(p) - 2 * K_r * p + K_r * s2(p); });
  const double xy = span([&](double p) { return -s2(p) - 2 * p + K_r * c2(p); });
  const double yx = span([&](double p) { return -s2(p) + 2 * p + K_r * c2(p); });
  const double yy = span([&](double p) { return -c2(p) - 2 * K_r * p - K_r * s2(p); });
  const auto Gx = x.response(hz), Gy = y.response(hz);
  const auto a0 = Gx * Gy * (xx * yy - xy * yx), a1 = xx * Gx + yy * Gy;
  const auto root = std::sqrt(a1 * a1 - 4.0 * a0);
  std::vector<MillingLimit> out;
  for (const double sign : {1.0, -1.0}) {
    MillingLimit limit;
    limit.eigenvalue = -(a1 + sign * root) / (2.0 * a0);
    limit.kappa = limit.eigenvalue.imag() / limit.eigenvalue.real();
    limit.depth =
        -2 * pi * limit.eigenvalue.real() / (teeth * K_t) * (1 + limit.kappa * limit.kappa);
    if (!(limit.depth > 0)) continue;
    const double phase = pi - 2 * std::atan(limit.kappa);
    for (int q = 0; q < lobes; ++q)
      limit.rpm.push_back(60 * 2 * pi * hz / (teeth * (phase + 2 * q * pi)));
    out.push_back(limit);
  }
  return out;
}

// Along the frequency each solution is a curve of depth and of waves between two teeth. At the
// given speed those frequencies chatter whose waves add a whole number to the curve's own phase:
// they are looked for between neighbouring frequencies, on the same curve.
std::optional<double> milling_depth_limit(int teeth, const Engagement& phi, double K_t, double K_r,
                                          const Mode& mode, double rpm) {
  // Steps a twentieth of the resonance's width; an octave above it the limit is far away.
  const double step = std::min(1.0, mode.frequency * mode.damping / 20);
  const double per_tooth = rpm * teeth / 60;  // Hz
  std::optional<double> out;
  std::vector<MillingLimit> before;
  const auto waves = [&](double hz, const MillingLimit& limit) {
    return hz / per_tooth - (pi - 2 * std::atan(limit.kappa)) / (2 * pi);
  };
  const int steps = static_cast<int>(std::min(2.5 * mode.frequency / step, 1e5));
  const double first = mode.frequency / 2;
  for (int i = 0; i <= steps; ++i) {
    const double hz = first + i * step;
    auto now = milling_limits(teeth, phi, K_t, K_r, mode, mode, hz, 0);
    for (const MillingLimit& limit : now)
      for (const MillingLimit& last : before) {
        const double apart = std::abs(limit.eigenvalue - last.eigenvalue);
        if (std::any_of(before.begin(), before.end(), [&](const MillingLimit& other) {
              return std::abs(limit.eigenvalue - other.eigenvalue) < apart;
            }))
          continue;
        const double a = waves(hz - step, last), b = waves(hz, limit);
        const double whole = std::floor(std::max(a, b));
        if (whole < 0 || whole < std::min(a, b) || std::abs(b - a) > 0.5) continue;
        const double part = a == b ? 0 : (whole - a) / (b - a);
        const double depth = last.depth + part * (limit.depth - last.depth);
        out = std::min(out.value_or(depth), depth);
      }
    before = std::move(now);
  }
  return out;
}

}  // namespace aircut::accuracy
