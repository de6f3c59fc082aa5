// Everything about directions is in three unit vectors: v̂ along the velocity of the work at the
// tool, n̂ out of the work across the feed, f̂ along the feed. The force on the tool is P_cut v̂ +
// P_thrust n̂ − P_feed f̂, for tools on any side of the work and any direction of the spindle.
#include "accuracy/turning.h"

#include <cmath>
#include <numbers>

namespace aircut::accuracy {

using std::numbers::pi;

double PowerTerm::at(double t, double S, double V) const {
  if (!(t > 0) || !(S > 0)) return 0;
  return C * std::pow(t, x) * std::pow(S, y) * std::pow(V, z) * K;
}

TurningForce turning_force(const TurningLaw& law, double t, double S, double V) {
  return {law.cut.at(t, S, V), law.thrust.at(t, S, V), law.feed.at(t, S, V)};
}

PowerTerm KienzleTerm::power_law(double kappa) const {
  return {.C = k11 * std::pow(std::sin(kappa), -m), .x = 1, .y = 1 - m, .z = 0, .K = 1};
}

double effective_kappa(double kappa, double nose_radius, double t) {
  if (!(t < nose_radius * (1 - std::cos(kappa)))) return kappa;
  return std::acos(1 - t / nose_radius) / 2;
}

std::optional<Triad> turning_triad(const Vec3& omega, const Vec3& arm, const Vec3& feed,
                                   const Vec3& normal) {
  const Vec3 velocity = omega.cross(arm);
  if (!(velocity.norm() > 1e-9 * omega.norm())) return std::nullopt;
  return Triad{velocity.normalized(), normal, -feed};
}

TurningCut longitudinal_cut(double D_before, double D_after, double rpm, double feed) {
  const double mean = 0.5 * (D_before + D_after);
  TurningCut out;
  out.t = 0.5 * (D_before - D_after);
  out.S = feed / rpm;
  out.V_outer = pi * D_before * rpm / 1000;
  out.V_mean = pi * mean * rpm / 1000;
  out.Q = pi / 4 * (D_before * D_before - D_after * D_after) * feed;
  out.area = out.Q / (pi * mean * rpm);
  return out;
}

double turning_power(double P_cut, double V, double eta) { return P_cut * V / (60000 * eta); }

double feed_for_force(const PowerTerm& cut, double t, double V, double force) {
  return std::pow(force / (cut.C * std::pow(t, cut.x) * std::pow(V, cut.z) * cut.K), 1 / cut.y);
}

double feed_for_power(const PowerTerm& cut, double t, double V, double power_kW, double eta) {
  return feed_for_force(cut, t, V, 60000 * eta * power_kW / V);
}

double turned_roughness(double S, double nose_radius) { return S * S / (8 * nose_radius); }

AxialCut drilling(const KienzleTerm& material, double diameter, double feed, double point_angle,
                  double feed_ratio, double chisel_factor) {
  const double h = feed / 2 * std::sin(point_angle / 2);
  const double k = material.k11 * std::pow(h, -material.m);
  return {feed_ratio * k * feed * diameter / 2 * chisel_factor, k * feed * diameter * diameter / 8};
}

AxialCut tapping(const KienzleTerm& material, double diameter, double pitch) {
  const double k = material.k11 * std::pow(pitch, -material.m);
  return {0, k * pitch * pitch * diameter / 8};
}

}  // namespace aircut::accuracy
