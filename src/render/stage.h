// A scene prepared for one picture: what is drawn where, the lamps, the floor.
#pragma once

#include <vector>

#include "render/camera.h"
#include "render/gpu_mesh.h"

namespace aircut::render {

struct StageItem {
  const DrawBody* body = nullptr;
  int index = 0;  ///< in scene.bodies
  const GpuMesh* mesh = nullptr;
  Eigen::Matrix4d model = Eigen::Matrix4d::Identity();  ///< body to render frame
  Box3 box;                                             ///< render frame
  double depth = 0;    ///< of its nearest corner, mm in front of the eye
  bool small = false;  ///< triangles of a few pixels: drawn by SmallTriangles
};

/// A rectangle of the whole picture, pixels, from the bottom left.
struct Tile {
  int x = 0, y = 0, width = 0, height = 0;
};

struct Lamps {
  Vec3 key, fill, rim;  ///< directions to the lamps, unit
  Vec3 right, ahead;    ///< horizontal directions of the camera
};

struct Floor {
  double height = 0;  ///< render frame
  double extent = 0;  ///< half side of the square, mm
  double step = 10;   ///< of the fine grid, mm; bold lines every fifth
};

struct Stage {
  View view;
  std::vector<StageItem> items;  ///< nearest first
  Box3 solid;                    ///< of all bodies, render frame; may be empty
  Lamps lamps;
  std::optional<Floor> floor;
  /// Normal and offset in the render frame: bodies are seen where n·p + d <= 0.
  std::optional<Eigen::Vector4d> section;
  Eigen::Matrix4d world_to_shadow = Eigen::Matrix4d::Identity();  ///< to clip space
  double shadow_size = 1, shadow_depth = 1;                       ///< of the map, mm
  double diagonal = 1;                                            ///< of all bodies, mm
};

/// Bodies without a mesh are left out.
Stage make_stage(const Scene& scene, const Camera& camera, MeshCache& meshes, int width,
                 int height);
/// From clip space of the whole picture to that of a tile.
Eigen::Matrix4d tile_projection(const View& view, const Tile& tile);
/// False when a box (render frame) lies wholly outside one plane of the view.
bool in_view(const Box3& box, const Eigen::Matrix4d& to_clip);
/// The number of 1, 2, 5 · 10^n next below.
double round_down_125(double value);

}  // namespace aircut::render
