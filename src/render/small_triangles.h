// Bodies of triangles about as small as a pixel, drawn by this library itself.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "render/draw_mesh.h"

namespace aircut::render {

/// What one pixel shows. Its 16 bytes are what the shaders read: see shaders_small.cpp.
struct SmallTexel {
  float depth = 2;              ///< of clip space, -1 near to 1 far; 2: nothing here
  std::uint32_t normal_xy = 0;  ///< render frame, 16 bits each
  std::uint32_t normal_z =
      0;                   ///< 16 bits, a bit for each sample that is covered, a bit for the middle
  std::uint32_t look = 0;  ///< red, green, blue, metal from the lowest byte on
};

/// Pixels from (x0, y0) up to but without (x1, y1), from the bottom left.
struct PixelRect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  bool empty() const { return x0 >= x1 || y0 >= y1; }
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  void extend(const PixelRect& other);
};

/// The pixels of a picture of that size that a box of the render frame can touch. `to_clip` must
/// have the box before the eye.
PixelRect pixels_of(const Box3& box, const Eigen::Matrix4d& to_clip, int width, int height);

struct SmallBody {
  const DrawMesh& shape;   ///< closed, with vertices and indices
  Eigen::Matrix4d model;   ///< body to render frame
  std::uint32_t look = 0;  ///< as in SmallTexel
};

/// The buffers are kept from one picture to the next.
class SmallTriangles {
 public:
  /// Empties `rect` of a picture `width` wide.
  void start_picture(int width, int height, const PixelRect& rect);
  void draw(const SmallBody& body, const Eigen::Matrix4d& to_clip);
  const SmallTexel* texels() const { return texels_.data(); }

  /// Likewise for depths alone, 0 near to 1 far.
  void start_depths(int side, const PixelRect& rect);
  void draw_depths(const SmallBody& body, const Eigen::Matrix4d& to_clip);
  const float* depths() const { return depths_.data(); }

 private:
  struct Corner {
    float x, y, z;  // pixels, clip depth
  };
  void place_corners(const SmallBody& body, const Eigen::Matrix4d& to_clip, int width, int height);
  void draw_triangle(const std::uint32_t* corners, std::uint32_t look);
  void draw_triangle_depth(const std::uint32_t* corners);

  int width_ = 0, height_ = 0, side_ = 0;
  PixelRect rect_, depth_rect_;
  std::vector<SmallTexel> texels_;
  std::vector<float> depths_;
  std::vector<Corner> corners_;
  std::vector<Eigen::Vector3f> normals_;  // render frame
};

}  // namespace aircut::render
