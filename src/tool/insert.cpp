// Inserts of lathe tools.
//
//   X                front angle a: an edge leaves the nose along (sin a, cos a) in (X, Z)
//   |     \          .
//   |      \ edge
//   |  .-.  \         The edges touch the nose from outside, so their far ends lie a radius
//   | ( o )___\       beside the lines from its middle. Where that middle is, seen from the
//   |  `-'  edge      controlled point, says the orientation 1 to 9.
//   +-----------Z
#include "tool/insert.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aircut::tool {

namespace {

using Point = std::array<double, 2>;

// Middle of the nose in nose radii: X, Z; by orientation.
constexpr double nose_of[10][2] = {{0, 0},  {1, -1}, {1, 1}, {-1, 1}, {-1, -1},
                                   {0, -1}, {1, 0},  {0, 1}, {-1, 0}, {0, 0}};

double cross(const Point& o, const Point& a, const Point& b) {
  return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
}

// Convex hull by Andrew's monotone chain, from +X towards +Z.
std::vector<Point> hull_of(std::vector<Point> points) {
  std::sort(points.begin(), points.end());
  std::vector<Point> out;
  for (int side = 0; side < 2; ++side) {
    const std::size_t begin = out.size();
    for (const Point& p : points) {
      while (out.size() >= begin + 2 && cross(out[out.size() - 2], out.back(), p) <= 0)
        out.pop_back();
      out.push_back(p);
    }
    out.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return out;
}

}  // namespace

tl::expected<Insert, std::string> insert_of(const Tool& tool) {
  const double radius = tool.diameter / 2, edge = tool.flute_length;
  if (!(edge > 0)) return tl::unexpected(std::string("no edge_length, so its insert has no shape"));
  if (tool.orientation < 1 || tool.orientation > 9)
    return tl::unexpected(std::string("no orientation, so it is not known where its nose is"));
  Insert out;
  out.radius = radius;
  out.nose = {nose_of[tool.orientation][0] * radius, nose_of[tool.orientation][1] * radius};
  const double middle = (tool.front_angle + tool.back_angle) / 2;
  const double wedge = std::abs(tool.front_angle - tool.back_angle);
  if (!(wedge > 0 && wedge < std::numbers::pi))
    return tl::unexpected(std::string("no front and back angle of its edges less than 180° apart"));
  if (tool.orientation < 9 &&
      std::sin(middle) * out.nose[0] + std::cos(middle) * out.nose[1] < -1e-9)
    return tl::unexpected(
        std::string("edges on the other side of its nose than its orientation says"));
  for (int i = 0; i < 2; ++i) {
    const double angle = i == 0 ? tool.front_angle : tool.back_angle;
    const double outwards = angle < middle ? -1 : 1;  // from the wedge
    out.ends[static_cast<std::size_t>(i)] = {
        out.nose[0] + edge * std::sin(angle) + outwards * radius * std::cos(angle),
        out.nose[1] + edge * std::cos(angle) - outwards * radius * std::sin(angle)};
  }
  return out;
}

Block insert_block(const Insert& insert, double thickness) {
  constexpr int corners = 24;
  const double around = insert.radius / std::cos(std::numbers::pi / corners);
  std::vector<Point> points(insert.ends.begin(), insert.ends.end());
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * i / corners;
    points.push_back(
        {insert.nose[0] + around * std::cos(angle), insert.nose[1] + around * std::sin(angle)});
  }
  return {PieceRole::cutter, "insert", hull_of(std::move(points)), -thickness, 0};
}

bool make_convex(std::vector<Point>& outline) {
  if (outline.size() < 3) return false;
  double area = 0;
  for (std::size_t i = 1; i + 1 < outline.size(); ++i)
    area += cross(outline[0], outline[i], outline[i + 1]);
  if (area < 0) std::reverse(outline.begin(), outline.end());
  // Turns one way at every corner, and only once around.
  std::vector<Point> hull = hull_of(outline);
  if (hull.size() != outline.size()) return false;
  const auto first = std::find(outline.begin(), outline.end(), hull.front());
  std::rotate(outline.begin(), first, outline.end());
  return outline == hull;
}

}  // namespace aircut::tool
