// Milling: the force that a vibration makes through the chip thickness is averaged over a
// revolution (zeroth order of its Fourier series). That leaves a 2×2 matrix of direction factors α
// between the angles of entry and exit; with the responses G of the two modes, the cut is at its
// limit where a0 Λ² + a1 Λ + 1 = 0. Λ gives the depth, its phase the speeds. Poor below a_e/D of
// about 0.1.
//
// Source: Y. Altintas, E. Budak, Analytical prediction of stability lobes in milling, CIRP Annals
// 1995.
#include "accuracy/stability.h"

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

}  // namespace aircut::accuracy
