// What the parts of the painter share while one tile is drawn.
#pragma once

#include <cstdio>
#include <ctime>
#include <vector>

#include "render/painter.h"
#include "render/small_triangles.h"
namespace aircut::render {

struct Painter::Frame {
  const Stage& stage;
  const Scene& scene;
  Tile tile;
  double line_scale;
  Eigen::Matrix4d projection;  // camera to clip space of the tile
  Eigen::Vector4d unproject;
  Eigen::Matrix4d to_clip;        // render frame to clip space of the tile
  PixelRect small;                // what bodies of small triangles may cover
  std::vector<int> alarm_number;  // per body of the scene: its number among those in alarm, or -1

  const View& view() const { return stage.view; }
  double parallel() const { return stage.view.orthographic ? 1 : 0; }
  // Pixels of the half-resolution picture per mm, at depth 1 or everywhere.
  double half_pixels_per_mm(int half_height) const { return projection(1, 1) * half_height / 2; }
};

struct Material {
  Vec3 base;  // linear
  double metal = 0, roughness = 0.5;
};
Material material_of(const machine::Color& color);

/// The plane of the section in the body's frame.
Eigen::Vector4d plane_of(const StageItem& item, const Stage& stage);

/// Clip depth as the shaders have it (depth_of).
Eigen::Vector4d depth_terms(const View& view);

constexpr double edge_lift = 5e-4;  ///< of the distance to the eye
constexpr double path_lift = 1.2e-3;
// Stencil values: a body in alarm is seen here, or it is behind something and shown through it.
// A bit above them: the face of a cut.
constexpr int seen = 2, covered = 1, cut_face = 64;

/// Display colour, 0 to 1.
inline Vec3 display_colour(const machine::Color& c) { return Vec3(c.r, c.g, c.b) / 255.0; }

/// Display colour of the bodies in alarm, told apart by their shade of red.
inline Vec3 alarm_colour(int number) {
  return number % 2 == 0 ? Vec3(0.86, 0.07, 0.07) : Vec3(0.96, 0.36, 0.12);
}

}  // namespace aircut::render
