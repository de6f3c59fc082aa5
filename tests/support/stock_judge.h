// A slow judge of material removal: whether a point was swept, by looking for the time at which the
// cutter holds it. Shares no code with src/stock.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <vector>

#include "geometry/geometry.h"

namespace aircut::test {

/// How far a point of the cutter's frame (radius d, height z) is outside; negative inside. Has the
/// right sign everywhere and is the distance near the surface.
using CutterShape = std::function<double(double d, double z)>;

inline CutterShape flat_shape(double diameter, double height) {
  return [=](double d, double z) { return std::max({d - diameter / 2, -z, z - height}); };
}
inline CutterShape bull_shape(double diameter, double corner, double height) {
  return [=](double d, double z) {
    const double e = diameter / 2 - corner;
    double side = d - diameter / 2;
    if (z < corner) side = d < e ? -z : std::hypot(d - e, z - corner) - corner;
    return std::max({side, -z, z - height});
  };
}
inline CutterShape cone_shape(double tip, double diameter, double cone_height, double height) {
  return [=](double d, double z) {
    const double run = (diameter - tip) / 2, length = std::hypot(run, cone_height);
    const double slanted = ((d - tip / 2) * cone_height - z * run) / length;
    return std::max({slanted, d - diameter / 2, -z, z - height});
  };
}

struct JudgedMove {
  CutterShape shape;
  Vec3 start, end;
  Vec3 axis = Vec3::UnitZ();

  double outside_at(const Vec3& p, double t) const {
    const Vec3 rel = p - (start + t * (end - start));
    const double z = rel.dot(axis);
    return shape((rel - z * axis).norm(), z);
  }

  /// The least over the move. The cutter is convex, so this is a convex function of the time.
  double outside(const Vec3& p) const {
    constexpr int samples = 32;
    int best = 0;
    double least = outside_at(p, 0);
    for (int i = 1; i <= samples; ++i)
      if (const double v = outside_at(p, static_cast<double>(i) / samples); v < least) {
        least = v;
        best = i;
      }
    double low = std::max(best - 1, 0) / static_cast<double>(samples);
    double high = std::min(best + 1, samples) / static_cast<double>(samples);
    for (int i = 0; i < 60; ++i) {
      const double a = low + (high - low) / 3, b = high - (high - low) / 3;
      if (outside_at(p, a) < outside_at(p, b))
        high = b;
      else
        low = a;
    }
    return std::min(least, outside_at(p, (low + high) / 2));
  }
};

/// The least over all moves: negative where material was removed.
inline double outside_all(const std::vector<JudgedMove>& moves, const Vec3& p) {
  double out = 1e9;
  for (const JudgedMove& move : moves) out = std::min(out, move.outside(p));
  return out;
}

/// Edges that don't have exactly two triangles running along them in opposite directions, after
/// welding by position as a reader of an STL file does.
inline std::size_t open_edges(const TriangleMesh& mesh) {
  std::map<std::array<double, 3>, std::size_t> places;
  const auto place = [&](std::uint32_t v) {
    const Vec3& p = mesh.vertices[v];
    return places.try_emplace({p.x(), p.y(), p.z()}, places.size()).first->second;
  };
  std::map<std::pair<std::size_t, std::size_t>, std::pair<int, int>> edges;
  for (const auto& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t a = place(t[i]), b = place(t[(i + 1) % 3]);
      auto& [forward, backward] = edges[std::minmax(a, b)];
      ++(a < b ? forward : backward);
    }
  return static_cast<std::size_t>(std::count_if(
      edges.begin(), edges.end(), [](const auto& e) { return e.second != std::pair(1, 1); }));
}

inline std::size_t flat_triangles(const TriangleMesh& mesh) {
  return static_cast<std::size_t>(
      std::count_if(mesh.triangles.begin(), mesh.triangles.end(), [&](const auto& t) {
        const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
        return !((b - a).cross(c - a).norm() > 0);
      }));
}

}  // namespace aircut::test
