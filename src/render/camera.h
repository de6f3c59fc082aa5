// From a camera to matrices. The render frame is the world, shifted to the middle of what is drawn,
// so that 32-bit floats of the graphics pipeline are small numbers.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "render/render.h"

namespace aircut::render {

struct View {
  Vec3 centre = Vec3::Zero();                          ///< origin of the render frame, world, mm
  Vec3 eye = Vec3::Zero();                             ///< render frame, mm
  Mat3 axes = Mat3::Identity();                        ///< rows: right, up and back of the camera
  Eigen::Matrix4d view = Eigen::Matrix4d::Identity();  ///< render frame to camera
  Eigen::Matrix4d projection = Eigen::Matrix4d::Identity();  ///< camera to clip space
  bool orthographic = false;
  double distance = 1;        ///< eye to target, mm
  double mm_per_pixel = 1;    ///< at the target
  int width = 0, height = 0;  ///< pixels

  Eigen::Matrix4d view_projection() const { return projection * view; }
  /// Pixel of a world point, y down; nothing when it lies behind the camera.
  std::optional<Eigen::Vector2d> pixel(const Vec3& world) const;
  /// Depth buffer value of a world point, 0 to 1.
  double depth(const Vec3& world) const;
  /// Distance in front of the eye, mm along the view, of a depth buffer value.
  double distance_of(double depth) const;
};

/// `contents` is what must lie between the clipping planes, world.
View make_view(const Camera& camera, const Box3& contents, int width, int height);
/// The 8 corners.
std::array<Vec3, 8> corners(const Box3& box);

}  // namespace aircut::render
