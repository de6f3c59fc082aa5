// Mechanistic forces: each piece db of an edge at the angle φ cuts a chip of thickness h = f_t sin
// φ sin κ and receives dF_q = (K_qc h + K_qe) db along, across and up the edge. For a flat end mill
// (κ = 90°, db = dz) and six constants the sums over height and angle are closed: with the
// antiderivatives g(φ) below, a tooth whose edge covers the phases from φ(top) to φ(tip) has the
// force [g] D / (2 tan β), and the mean over a revolution is N a [g] / 2π whatever the helix.
//
// Everything else (ball, taper, Kienzle's curve) is integrated along the edge's length and over the
// angle with Gauss points; the two ways are tested against each other.
//
// Source of the closed forms: Y. Altintas, Manufacturing Automation, ch. 2; derived again for φ
// clockwise from +y and forces on the tool.
#include "accuracy/milling.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace aircut::accuracy {
namespace {

using std::numbers::pi;

// Of the tooth feed: below it the edge only enters or leaves.
constexpr double least_chip = 1e-12;

MillingForce operator+(const MillingForce& a, const MillingForce& b) {
  return {a.force + b.force, a.tangential + b.tangential, a.torque + b.torque};
}

MillingForce operator*(double s, const MillingForce& a) {
  return {s * a.force, s * a.tangential, s * a.torque};
}

// A left-hand helix pushes the chip down instead of up.
MillingCoefficients by_hand(MillingCoefficients K, const Cutter& cutter) {
  if (cutter.helix < 0) {
    K.K_ac = -K.K_ac;
    K.K_ae = -K.K_ae;
  }
  return K;
}

// A cutter that turns the other way is the mirror image in y; its torque keeps its size.
MillingForce by_turn(MillingForce f, const Cutter& cutter) {
  if (cutter.counter_clockwise) f.force.y() = -f.force.y();
  return f;
}

// Antiderivatives over φ of the force per mm of a straight edge.
MillingForce antiderivative(const MillingCoefficients& K, double c, double phi) {
  const double s = std::sin(phi), k = std::cos(phi);
  const double s2 = std::sin(2 * phi), k2 = std::cos(2 * phi);
  MillingForce g;
  g.force.x() = c / 4 * (K.K_tc * k2 - K.K_rc * (2 * phi - s2)) - K.K_te * s + K.K_re * k;
  g.force.y() = c / 4 * (K.K_tc * (2 * phi - s2) + K.K_rc * k2) - K.K_te * k - K.K_re * s;
  g.force.z() = K.K_ac * c * k - K.K_ae * phi;
  g.tangential = -K.K_tc * c * k + K.K_te * phi;
  return g;
}

MillingForce between(const MillingCoefficients& K, double c, double from, double to) {
  return antiderivative(K, c, to) + -1.0 * antiderivative(K, c, from);
}

// Force on the tool of 1 mm of edge at φ, for an edge whose normal leans by κ from the axis.
MillingForce edge_force(const EdgeLaw& law, double hand, double f_t, double phi, double kappa,
                        double radius) {
  const double h = f_t * std::sin(phi) * std::sin(kappa);
  MillingForce out;
  if (!(h > least_chip * f_t)) return out;
  const Vec3 F = law.per_length(h);
  const double s = std::sin(phi), c = std::cos(phi);
  const Vec3 normal(std::sin(kappa) * s, std::sin(kappa) * c, -std::cos(kappa));
  const Vec3 along(std::cos(kappa) * s, std::cos(kappa) * c, std::sin(kappa));
  out.force = -(F[0] * Vec3(c, -s, 0) + F[1] * normal + hand * F[2] * along);
  out.tangential = F[0];
  out.torque = F[0] * radius;
  return out;
}

struct EdgePoint {
  double z = 0, kappa = 0, radius = 0;
  double db = 0;  // length of edge that it stands for
};

// Gauss-Legendre points and weights on [0, 1].
constexpr std::array<std::array<double, 2>, 4> gauss = {
    {{0.06943184420297371, 0.17392742256872693},
     {0.33000947820757187, 0.32607257743127307},
     {0.66999052179242813, 0.32607257743127307},
     {0.93056815579702629, 0.17392742256872693}}};

template <class F>
void integrate(double from, double to, int panels, F f) {
  const double width = (to - from) / panels;
  for (int i = 0; i < panels; ++i)
    for (const auto& [at, weight] : gauss) f(from + (i + at) * width, weight * width);
}

// The edge up to a_p, in points along its length (so the bottom of a ball is no singularity).
std::vector<EdgePoint> edge_points(const Cutter& cutter, double a_p, int panels) {
  std::vector<EdgePoint> out;
  const double R = cutter.diameter / 2;
  double from_z = 0;
  if (cutter.shape == Cutter::Shape::ball) {
    const double top = std::min(a_p, R);
    integrate(0, std::acos(1 - top / R), panels, [&](double kappa, double d) {
      out.push_back({R * (1 - std::cos(kappa)), kappa, R * std::sin(kappa), R * d});
    });
    from_z = top;  // above the equator the ball is a cylinder
  }
  const double lean = cutter.shape == Cutter::Shape::taper ? cutter.half_angle : 0;
  if (a_p > from_z)
    integrate(from_z, a_p, panels, [&](double z, double d) {
      out.push_back({z, pi / 2 - lean, R + z * std::tan(lean), d / std::cos(lean)});
    });
  return out;
}

double lag_per_height(const Cutter& cutter) { return 2 * std::tan(cutter.helix) / cutter.diameter; }

double hand_of(const Cutter& cutter) { return cutter.helix < 0 ? -1 : 1; }

// φ brought next to the engaged interval; whether it lies in it.
bool engaged(const Engagement& phi, double& at) {
  at -= 2 * pi * std::floor((at - phi.start) / (2 * pi));
  return at <= phi.exit;
}

}  // namespace

Vec3 EdgeLaw::per_length(double h) const {
  if (is_kienzle()) {
    const double tangential = kienzle.k11 * std::pow(h, 1 - kienzle.m);
    return tangential * Vec3(1, radial_ratio, axial_ratio);
  }
  return {constants.K_tc * h + constants.K_te, constants.K_rc * h + constants.K_re,
          constants.K_ac * h + constants.K_ae};
}

double Cutter::pitch() const { return 2 * pi / teeth; }

Engagement engagement(double diameter, double a_e, MillingMode mode) {
  const double alpha = std::acos(std::clamp(1 - 2 * a_e / diameter, -1.0, 1.0));
  switch (mode) {
    case MillingMode::up:
      return {0, alpha};
    case MillingMode::down:
      return {pi - alpha, pi};
    case MillingMode::slot:
      break;
  }
  return {0, pi};
}

MillingForce mean_force(const Cutter& cutter, const MillingCoefficients& K, const MillingCut& cut) {
  MillingForce out = cutter.teeth * cut.a_p / (2 * pi) *
                     between(by_hand(K, cutter), cut.f_t, cut.phi.start, cut.phi.exit);
  out.torque = out.tangential * cutter.diameter / 2;
  return by_turn(out, cutter);
}

MillingForce force_at(const Cutter& cutter, const MillingCoefficients& K0, const MillingCut& cut,
                      double theta) {
  const MillingCoefficients K = by_hand(K0, cutter);
  const double lag = lag_per_height(cutter);
  MillingForce out;
  for (int j = 0; j < cutter.teeth; ++j) {
    const double tip = theta + j * cutter.pitch(), top = tip - lag * cut.a_p;
    const double low = std::min(tip, top), high = std::max(tip, top);
    if (high - low < 1e-12) {
      double phi = tip;
      if (!engaged(cut.phi, phi)) continue;
      // The derivative of the antiderivatives: the force per mm at one angle.
      const double s = std::sin(phi), c = std::cos(phi), h = cut.f_t * s;
      if (!(h > least_chip * cut.f_t)) continue;
      const double t = K.K_tc * h + K.K_te, r = K.K_rc * h + K.K_re, a = K.K_ac * h + K.K_ae;
      out = out + cut.a_p * MillingForce{{-t * c - r * s, t * s - r * c, -a}, t, 0};
      continue;
    }
    // A long flute may pass the engaged angle more than once.
    const double first = std::ceil((low - cut.phi.exit) / (2 * pi));
    const double last = std::floor((high - cut.phi.start) / (2 * pi));
    for (double m = first; m <= last; ++m) {
      const double from = std::max(low - 2 * pi * m, cut.phi.start);
      const double to = std::min(high - 2 * pi * m, cut.phi.exit);
      if (to > from) out = out + 1 / std::abs(lag) * between(K, cut.f_t, from, to);
    }
  }
  out.torque = out.tangential * cutter.diameter / 2;
  return by_turn(out, cutter);
}

MillingForce mean_force(const Cutter& cutter, const EdgeLaw& law, const MillingCut& cut) {
  constexpr int panels = 24;
  const double hand = hand_of(cutter);
  MillingForce sum;
  for (const EdgePoint& p : edge_points(cutter, cut.a_p, panels))
    integrate(cut.phi.start, cut.phi.exit, panels, [&](double phi, double d) {
      sum = sum + p.db * d * edge_force(law, hand, cut.f_t, phi, p.kappa, p.radius);
    });
  return by_turn(cutter.teeth / (2 * pi) * sum, cutter);
}

MillingForce force_at(const Cutter& cutter, const EdgeLaw& law, const MillingCut& cut,
                      double theta) {
  const double hand = hand_of(cutter), lag = lag_per_height(cutter);
  const auto points = edge_points(cutter, cut.a_p, 100);
  MillingForce sum;
  for (int j = 0; j < cutter.teeth; ++j)
    for (const EdgePoint& p : points) {
      double phi = theta + j * cutter.pitch() - lag * p.z;
      if (engaged(cut.phi, phi))
        sum = sum + p.db * edge_force(law, hand, cut.f_t, phi, p.kappa, p.radius);
    }
  return by_turn(sum, cutter);
}

MillingForce peak_force(const Cutter& cutter, const EdgeLaw& law, const MillingCut& cut) {
  constexpr int angles = 72;
  const bool closed = cutter.shape == Cutter::Shape::flat && !law.is_kienzle();
  MillingForce peak;
  for (int i = 0; i < angles; ++i) {
    const double theta = cutter.pitch() * i / angles;
    const MillingForce f =
        closed ? force_at(cutter, law.constants, cut, theta) : force_at(cutter, law, cut, theta);
    if (f.force.norm() > peak.force.norm()) peak = f;
  }
  return peak;
}

double thickest_chip(const MillingCut& cut) {
  const double at = std::clamp(pi / 2, cut.phi.start, cut.phi.exit);
  return cut.f_t * std::sin(at);
}

double mean_chip(const MillingCut& cut) {
  return cut.f_t * (std::cos(cut.phi.start) - std::cos(cut.phi.exit)) /
         (cut.phi.exit - cut.phi.start);
}

double feed_for_chip(double diameter, double a_e, double h_max) {
  const double share = a_e / diameter;
  return share < 0.5 ? h_max / (2 * std::sqrt(share - share * share)) : h_max;
}

std::vector<double> wall_error(const Cutter& cutter, const EdgeLaw& law, const MillingCut& cut,
                               MillingMode mode, const WallTool& tool,
                               const std::vector<double>& heights) {
  // The wall at z is made when the edge there passes φ = 0 (up) or π (down); all edges that cut
  // then bend the tool.
  const double wall = mode == MillingMode::down ? pi : 0;
  const double lag = lag_per_height(cutter), L = tool.stickout, hand = hand_of(cutter);
  const double EI = tool.youngs_modulus * pi * std::pow(tool.effective_diameter, 4) / 64;
  const auto points = edge_points(cutter, cut.a_p, 200);
  std::vector<double> out;
  for (const double z : heights) {
    double y = 0;
    for (int j = 0; j < cutter.teeth; ++j)
      for (const EdgePoint& p : points) {
        double phi = wall + lag * z + j * cutter.pitch() - lag * p.z;
        if (!engaged(cut.phi, phi)) continue;
        const double force =
            p.db * edge_force(law, hand, cut.f_t, phi, p.kappa, p.radius).force.y();
        const double near = L - std::max(z, p.z), far = L - std::min(z, p.z);
        y += force * near * near * (3 * far - near) / (6 * EI);
      }
    out.push_back(cutter.counter_clockwise ? -y : y);
  }
  return out;
}

}  // namespace aircut::accuracy
