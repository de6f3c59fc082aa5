// Small scenes and measurements that the tests of render share.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <numbers>

#include "render/render.h"

namespace aircut::render {

inline DrawBody body(std::string name, TriangleMesh mesh, const Vec3& at = Vec3::Zero()) {
  DrawBody out;
  out.name = std::move(name);
  out.mesh = std::make_shared<const TriangleMesh>(std::move(mesh));
  out.X_WB = translation(at);
  return out;
}

/// A box of the given size about the origin.
inline TriangleMesh block(double x, double y, double z) {
  return make_box(Vec3(-x, -y, -z) / 2, Vec3(x, y, z) / 2);
}

/// Closed cylinder about Z from z = 0 to h.
inline TriangleMesh cylinder(double r, double h, unsigned facets) {
  TriangleMesh out;
  for (unsigned i = 0; i < facets; ++i) {
    const double a = 2 * std::numbers::pi * i / facets;
    out.vertices.emplace_back(r * std::cos(a), r * std::sin(a), 0);
    out.vertices.emplace_back(r * std::cos(a), r * std::sin(a), h);
  }
  out.vertices.emplace_back(0, 0, 0);
  out.vertices.emplace_back(0, 0, h);
  for (unsigned i = 0; i < facets; ++i) {
    const unsigned j = (i + 1) % facets;
    out.triangles.push_back({2 * i, 2 * j, 2 * i + 1});
    out.triangles.push_back({2 * i + 1, 2 * j, 2 * j + 1});
    out.triangles.push_back({2 * facets, 2 * j, 2 * i});
    out.triangles.push_back({2 * facets + 1, 2 * i + 1, 2 * j + 1});
  }
  return out;
}

/// Parallel view from the operator's side: `height` mm from the lower to the upper border.
inline Camera front_camera(double height) {
  Camera out;
  out.eye = Vec3(0, -1000, 0);
  out.target = Vec3::Zero();
  out.field_of_view = 0;
  out.height = height;
  return out;
}

/// Bodies only: no floor, no triad.
inline Scene bare_scene(std::vector<DrawBody> bodies) {
  Scene out;
  out.bodies = std::move(bodies);
  out.floor = false;
  out.triad = false;
  return out;
}

inline Renderer renderer(int width, int height) {
  auto made = Renderer::create({width, height});
  if (!made) {
    ADD_FAILURE() << made.error().message;
    std::abort();
  }
  return std::move(*made);
}

inline std::array<int, 3> pixel(const Image& image, int x, int y) {
  const auto i = (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                  static_cast<std::size_t>(x)) *
                 4;
  return {image.rgba[i], image.rgba[i + 1], image.rgba[i + 2]};
}

inline bool is_red(const std::array<int, 3>& c) { return c[0] > 110 && c[0] > 2 * c[1]; }

/// Mean of the absolute difference of two pictures of one size, 0 to 255.
inline double mean_difference(const Image& a, const Image& b) {
  if (a.rgba.size() != b.rgba.size()) return 255;
  double sum = 0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) sum += std::abs(a.rgba[i] - b.rgba[i]);
  return sum / static_cast<double>(a.rgba.size()) * 4 / 3;  // the opacity never differs
}

/// A scene with a bit of everything, for comparisons.
inline Scene rich_scene() {
  Scene out;
  out.bodies = {body("table", block(200, 120, 20), Vec3(0, 0, -10)),
                body("post", cylinder(20, 90, 48)),
                body("cover", block(80, 80, 120), Vec3(0, 0, 60)),
                body("hit", block(30, 30, 30), Vec3(60, 0, 15))};
  out.bodies[0].color = {150, 155, 160};
  out.bodies[1].color = {40, 90, 160};
  out.bodies[2].translucent = true;
  out.bodies[3].highlight = true;
  out.lines = {{LineKind::rapid, {Vec3(-90, -50, 40), Vec3(-60, -50, 5)}},
               {LineKind::feed, {Vec3(-60, -50, 5), Vec3(60, -50, 5)}},
               {LineKind::arc, {Vec3(60, -50, 5), Vec3(75, -40, 5), Vec3(80, -20, 5)}},
               {LineKind::done, {Vec3(80, -20, 5), Vec3(80, 40, 5)}}};
  out.markers = {{Vec3(50, -15, 10)}};
  out.caption.left = {"part.ngc", "N10 G1 X20 F600"};
  out.caption.right = {"t = 1.000 s", "X 20.000"};
  out.caption.alarm = "collision: post hits block";
  return out;
}

inline Camera rich_camera() {
  return *camera_by_name("iso", Box3(Vec3(-100, -60, -20), Vec3(100, 60, 120)), 1.6);
}

}  // namespace aircut::render
