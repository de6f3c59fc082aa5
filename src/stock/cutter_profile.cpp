// Cutter profiles: from words or an outline to convex bodies.
//
// An outline is read as a chain of points from the bottom up. Runs of points that are corners of a
// chain of tangents around one arc (first and last point on the arc, the others outside at equal
// angles, as the tool library writes arcs) become that arc again. Then the chain is cut into convex
// bodies where it turns the wrong way. Two neighbouring bodies must overlap, or rounding could
// leave slivers between their sweeps: one of them goes on straight for a little beyond the place
// where they meet, which stays inside of the other because the outline turns away there.
#include <algorithm>
#include <cmath>
#include <optional>

#include "stock/outline.h"

namespace aircut::stock {
namespace {

constexpr double same_length = 1e-9;  // mm
constexpr double overlap = 0.05;      // mm, of neighbouring bodies

Diagnostic shape_error(std::string message) {
  return make_error("cutter_shape", std::move(message));
}

/// An outline piece before it is split: a band, or a level step (z0 == z1).
Band line(const ProfilePoint& a, const ProfilePoint& b) { return {a.z, b.z, a.r, b.r}; }

bool level(const Band& b) { return b.z1 - b.z0 < same_length; }

/// Direction (dr, dz) of a piece at its lower (or upper) end, unit.
Eigen::Vector2d direction(const Band& b, bool at_top) {
  if (b.arc == 0) return Eigen::Vector2d(b.r1 - b.r0, b.z1 - b.z0).normalized();
  const double r = at_top ? b.r1 : b.r0, z = at_top ? b.z1 : b.z0;
  return Eigen::Vector2d(-(z - b.f), r - b.e).normalized();  // counter-clockwise around the middle
}

/// The arc around which the points i … are a chain of tangents, and the point it ends at.
struct FoundArc {
  double e, f, radius;
  std::size_t last;
};
std::optional<FoundArc> arc_at(const Profile& points, std::size_t i) {
  const auto at = [&](std::size_t k) { return Eigen::Vector2d(points[k].r, points[k].z); };
  if (i + 3 >= points.size()) return std::nullopt;
  const Eigen::Vector2d a = at(i + 1) - at(i), b = at(i + 2) - at(i + 1);
  // The first tangent is half as long as the next. Its normal at the first point and the bisector
  // at the second meet in the middle of the arc.
  const double turn = std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
  if (turn < 1e-4 || turn > 0.6 || std::abs(b.norm() - 2 * a.norm()) > 1e-7) return std::nullopt;
  const double radius = a.norm() / std::tan(turn / 2);
  const Eigen::Vector2d middle = at(i) + radius * Eigen::Vector2d(-a.y(), a.x()).normalized();
  for (std::size_t k = i + 1; k < points.size(); ++k) {
    const double distance = (at(k) - middle).norm();
    if (k > i + 2 && std::abs(distance - radius) < 1e-7)
      return FoundArc{middle.x(), middle.y(), radius, k};
    if (std::abs(distance - radius / std::cos(turn / 2)) > 1e-7) return std::nullopt;
  }
  return std::nullopt;
}

void append_found_arc(std::vector<Band>& out, ProfilePoint from, ProfilePoint to, FoundArc arc) {
  if (std::abs(arc.e) < same_length) arc.e = 0;
  const auto band = [&](double z0, double z1, double r0, double r1) {
    if (z1 - z0 > same_length) out.push_back({z0, z1, r0, r1, arc.radius, arc.e, arc.f});
  };
  if (from.z < arc.f && to.z > arc.f) {  // over its widest place
    band(from.z, arc.f, from.r, arc.e + arc.radius);
    band(arc.f, to.z, arc.e + arc.radius, to.r);
  } else {
    band(from.z, to.z, from.r, to.r);
  }
}

std::vector<Band> chain_of(const Profile& points) {
  std::vector<Band> out;
  for (std::size_t i = 0; i + 1 < points.size();) {
    if (const auto arc = arc_at(points, i)) {
      append_found_arc(out, points[i], points[arc->last], *arc);
      i = arc->last;
      continue;
    }
    const Band b = line(points[i], points[i + 1]);
    if (!level(b) || std::abs(b.r1 - b.r0) > same_length) out.push_back(b);
    ++i;
  }
  return out;
}

/// Goes on straight beyond an end of a body; never beyond the axis.
void extend_up(std::vector<Band>& body, double most) {
  const Band last = body.back();
  const Eigen::Vector2d d = direction(last, true);
  const double slope = d.y() > 1e-6 ? d.x() / d.y() : 0;
  double rise = std::min(overlap, most);
  if (slope < 0) rise = std::min(rise, 0.5 * last.r1 / -slope);
  if (rise > same_length && last.r1 > 0)
    body.push_back({last.z1, last.z1 + rise, last.r1, last.r1 + slope * rise});
}

void extend_down(std::vector<Band>& body, double most) {
  const Band first = body.front();
  const Eigen::Vector2d d = direction(first, false);
  const double slope = d.y() > 1e-6 ? d.x() / d.y() : 0;
  double drop = std::min(overlap, most);
  if (slope > 0) drop = std::min(drop, 0.5 * first.r0 / slope);
  if (drop > same_length && first.r0 > 0)
    body.insert(body.begin(), {first.z0 - drop, first.z0, first.r0 - slope * drop, first.r0});
}

/// Splits the chain where it turns clockwise.
std::vector<Outline> convex_bodies(const std::vector<Band>& chain) {
  std::vector<std::vector<Band>> bodies(1);
  double widen_down = 0;  // room below the next body for its extension
  for (std::size_t i = 0; i < chain.size(); ++i) {
    const Band& b = chain[i];
    if (i > 0) {
      const Eigen::Vector2d in = direction(chain[i - 1], true), out = direction(b, false);
      const bool reflex = in.x() * out.y() - in.y() * out.x() < -1e-9;
      if (reflex && !bodies.back().empty()) {
        const double below = bodies.back().back().z1 - bodies.back().back().z0;
        if (level(chain[i - 1])) {
          widen_down = below;  // a step inwards: the next body reaches down into this one
        } else {
          double room = 0;  // into the next real piece
          for (std::size_t k = i; k < chain.size() && room == 0; ++k)
            if (!level(chain[k])) room = chain[k].z1 - chain[k].z0;
          extend_up(bodies.back(), room);
        }
        bodies.emplace_back();
      }
    }
    if (level(b)) continue;
    bodies.back().push_back(b);
    if (widen_down > 0) extend_down(bodies.back(), widen_down);
    widen_down = 0;
  }
  std::vector<Outline> out;
  for (auto& body : bodies)
    if (!body.empty()) out.emplace_back(std::move(body));
  return out;
}

Expected<void> positive(std::initializer_list<std::pair<const char*, double>> values) {
  for (const auto& [name, value] : values)
    if (!(value > 0) || !std::isfinite(value))
      return unexpected(shape_error(std::string("the cutter's ") + name + " must be more than 0"));
  return {};
}

}  // namespace

CutterProfile::CutterProfile(std::vector<Outline> bodies)
    : bodies_(std::make_shared<const std::vector<Outline>>(std::move(bodies))) {}

Expected<CutterProfile> CutterProfile::flat(double diameter, double height) {
  if (auto ok = positive({{"diameter", diameter}, {"height", height}}); !ok)
    return unexpected(ok.error());
  return CutterProfile({Outline({{0, height, diameter / 2, diameter / 2}})});
}

Expected<CutterProfile> CutterProfile::ball(double diameter, double height) {
  return bull(diameter, diameter / 2, height);
}

Expected<CutterProfile> CutterProfile::bull(double diameter, double corner_radius, double height) {
  if (auto ok = positive({{"diameter", diameter}, {"corner radius", corner_radius}}); !ok)
    return unexpected(ok.error());
  const double r = corner_radius, e = diameter / 2 - r;
  if (e < 0) return unexpected(shape_error("the corner radius is more than half of the diameter"));
  if (!(height >= r) || !std::isfinite(height))
    return unexpected(shape_error("the height is less than the corner radius"));
  std::vector<Band> bands = {{0, r, e, diameter / 2, r, e, r}};
  if (height > r) bands.push_back({r, height, diameter / 2, diameter / 2});
  return CutterProfile({Outline(std::move(bands))});
}

Expected<CutterProfile> CutterProfile::cone(double tip_diameter, double diameter,
                                            double cone_height, double height) {
  if (auto ok = positive({{"diameter", diameter}, {"cone height", cone_height}}); !ok)
    return unexpected(ok.error());
  if (!(tip_diameter >= 0 && tip_diameter < diameter))
    return unexpected(shape_error("the tip's diameter must be from 0 to less than the diameter"));
  if (!(height >= cone_height) || !std::isfinite(height))
    return unexpected(shape_error("the height is less than the cone's"));
  std::vector<Band> bands = {{0, cone_height, tip_diameter / 2, diameter / 2}};
  if (height > cone_height) bands.push_back({cone_height, height, diameter / 2, diameter / 2});
  return CutterProfile({Outline(std::move(bands))});
}

Expected<CutterProfile> CutterProfile::from_outline(const Profile& outline) {
  bool wide = false;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const ProfilePoint& p = outline[i];
    if (!(p.r >= 0) || !std::isfinite(p.r) || !std::isfinite(p.z))
      return unexpected(shape_error("a point of the outline has no radius of 0 or more"));
    if (i > 0 && p.z < outline[i - 1].z)
      return unexpected(shape_error("the outline goes down; its points must run from the tip up"));
    wide = wide || p.r > 0;
  }
  if (!wide || outline.size() < 2 || !(outline.back().z - outline.front().z > same_length))
    return unexpected(shape_error("the outline holds no volume"));
  std::vector<Outline> bodies = convex_bodies(chain_of(outline));
  if (bodies.empty()) return unexpected(shape_error("the outline holds no volume"));
  return CutterProfile(std::move(bodies));
}

CutterProfile CutterProfile::grown(double g) const {
  // Each band moves outwards by g; the ends move by g as straight walls. A slanted or curved side
  // moves outwards by at least g, because it also goes down (or up) with the ends.
  std::vector<Outline> out;
  for (const Outline& body : *bodies_) {
    std::vector<Band> bands;
    double shift = -g;  // what widens upwards goes down, what narrows goes up, walls fill between
    const auto wall_to = [&](double z) {
      const double from = bands.empty() ? body.low() - g : bands.back().z1;
      const double r = (bands.empty() ? body.bands().front().r0 : bands.back().r1 - g) + g;
      if (z - from > same_length) bands.push_back({from, z, r, r});
    };
    for (Band b : body.bands()) {
      if (b.r1 < b.r0 && shift < 0) {
        wall_to(b.z0 + g);
        shift = g;
      }
      b.z0 += shift, b.z1 += shift, b.f += shift;
      b.r0 += g, b.r1 += g, b.e += g;
      if (b.arc > 0 || b.z1 - b.z0 > same_length) bands.push_back(b);
    }
    wall_to(body.high() + g);
    out.emplace_back(std::move(bands));
  }
  return CutterProfile(std::move(out));
}

double CutterProfile::radius() const {
  double out = 0;
  for (const Outline& body : *bodies_) out = std::max(out, body.radius());
  return out;
}

double CutterProfile::low() const { return bodies_->front().low(); }

double CutterProfile::high() const { return bodies_->back().high(); }

}  // namespace aircut::stock
