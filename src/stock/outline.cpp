#include "stock/outline.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace aircut::stock {
namespace {

double leg(double hypotenuse, double other) {
  return std::sqrt(std::max((hypotenuse - other) * (hypotenuse + other), 0.0));
}

/// Floors of the bands that widen upwards, starting with the level face around the axis.
std::vector<Floor> floors(const std::vector<Band>& bands) {
  std::vector<Floor> out;
  if (bands.front().r0 > 0) out.push_back({.outer = bands.front().r0, .z = bands.front().z0});
  for (const Band& b : bands) {
    if (!(b.r1 > b.r0)) continue;
    Floor floor{.inner = b.r0, .outer = b.r1, .z = b.z0};
    if (b.arc > 0) {
      floor.arc = b.arc;
      floor.e = b.e;
      floor.f = b.f;
    } else {
      floor.slope = (b.z1 - b.z0) / (b.r1 - b.r0);
    }
    out.push_back(floor);
  }
  return out;
}

std::vector<Band> upside_down(const std::vector<Band>& bands) {
  std::vector<Band> out;
  for (auto b = bands.rbegin(); b != bands.rend(); ++b)
    out.push_back({-b->z1, -b->z0, b->r1, b->r0, b->arc, b->e, -b->f});
  return out;
}

double height_over(const std::vector<Floor>& floors, double d) {
  for (const Floor& floor : floors)
    if (d <= floor.outer) return floor.height_at(d);
  return std::numeric_limits<double>::infinity();
}

}  // namespace

double Band::radius_at(double z) const {
  if (arc > 0) return e + leg(arc, z - f);
  return r0 + (r1 - r0) * ((z - z0) / (z1 - z0));
}

double Floor::height_at(double d) const {
  return arc > 0 ? f - leg(arc, d - e) : z + slope * (d - inner);
}

Outline::Outline(std::vector<Band> bands)
    : bands_(std::move(bands)), below_(floors(bands_)), above_(floors(upside_down(bands_))) {
  for (const Band& b : bands_) radius_ = std::max({radius_, b.r0, b.r1});
  wall_low_ = high();
  wall_high_ = low();
  for (const Band& b : bands_) {
    if (b.r0 == radius_)
      wall_low_ = std::min(wall_low_, b.z0), wall_high_ = std::max(wall_high_, b.z0);
    if (b.r1 == radius_)
      wall_low_ = std::min(wall_low_, b.z1), wall_high_ = std::max(wall_high_, b.z1);
  }
  const auto f = [](double value) { return static_cast<float>(value); };
  const auto floats_of = [&](const std::vector<Floor>& from) {
    std::vector<FloorF> out;
    for (const Floor& p : from)
      out.push_back({f(p.inner), f(p.outer), f(p.z), f(p.slope), f(p.arc), f(p.e), f(p.f)});
    return out;
  };
  floats_.below = floats_of(below_);
  floats_.above = floats_of(above_);
  for (const Band& b : bands_)
    floats_.bands.push_back({f(b.z0), f(b.z1), f(b.r0), f(b.r1), f(b.arc), f(b.e), f(b.f)});
  floats_.radius = f(radius_);
  floats_.low = f(low());
  floats_.high = f(high());
  floats_.wall_low = f(wall_low_);
  floats_.wall_high = f(wall_high_);
  floats_.corners =
      std::any_of(bands_.begin(), bands_.end(), [](const Band& b) { return b.arc > 0 && b.e > 0; });
  floats_.roof_edge = f(wall_high_);
}

double Outline::floor_at(double d) const { return height_over(below_, d); }

double Outline::roof_at(double d) const { return -height_over(above_, d); }

double Outline::radius_at(double z) const {
  for (const Band& b : bands_)
    if (z >= b.z0 && z <= b.z1) return b.radius_at(z);
  return -1;
}

double Outline::widest_between(double z0, double z1) const {
  if (z1 < low() || z0 > high()) return -1;
  const double nearest = std::clamp(wall_low_, z0, z1);
  if (nearest >= wall_low_ && nearest <= wall_high_) return radius_;
  return radius_at(std::clamp(z0 > wall_high_ ? z0 : z1, low(), high()));
}

}  // namespace aircut::stock
