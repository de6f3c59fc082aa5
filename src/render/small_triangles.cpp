// Idea: a stock after an hour of milling has triangles of a pixel or less. Mesa's rasteriser spends
// some 0.15 µs on each of them before the first pixel, shades at least 16 pixels for each, and
// takes twice as long again with several samples a pixel. Here a triangle costs a tenth of that:
// its corners are placed, and each pixel of its bounding box asks which of four samples lie inside
// all three edges (numbers relative to the box's corner, so that 32-bit floats are exact enough).
// The nearest triangle that touches a pixel gives its depth, normal and look; the samples of all of
// them are united, so a seam between two triangles, or between two such bodies, shows no
// background. Shading is then done once a pixel by the same shader as that of large triangles,
// which gets depth and samples along, so both kinds hide each other properly.
#include "render/small_triangles.h"

#include <algorithm>
#include <cmath>

#include "render/camera.h"

namespace aircut::render {
namespace {

using Four = float __attribute__((vector_size(16)));
using FourBits = std::int32_t __attribute__((vector_size(16)));

// Where OpenGL's four samples lie in a pixel.
constexpr Four sample_x = {0.375f, 0.875f, 0.125f, 0.625f};
constexpr Four sample_y = {0.125f, 0.375f, 0.625f, 0.875f};

constexpr float sample_rim = 0.125f;
constexpr std::uint32_t middle_bit = 1u << 20;  // of SmallTexel::normal_z

// Inside where a·x + b·y + c is not negative.
struct Edge {
  float a, b, c;
  Edge(float x0, float y0, float x1, float y1) : a(y0 - y1), b(x1 - x0), c(-(a * x0 + b * y0)) {}
  float at(float x, float y) const { return a * x + b * y + c; }
};

// The pixels of a row that the three edges leave, of those from 0 to `width`: long narrow triangles
// fill little of their box.
struct Rows {
  std::array<Edge, 3> edges;
  std::array<float, 3> inverse;  // of a
  int width;

  Rows(const std::array<Edge, 3>& e, int w)
      : edges(e), inverse{1 / e[0].a, 1 / e[1].a, 1 / e[2].a}, width(w) {}
  std::pair<int, int> span(float y) const {
    if (width <= 3) return {0, width};
    float first = 0, last = static_cast<float>(width);
    for (std::size_t k = 0; k < 3; ++k) {
      if (edges[k].a == 0) continue;
      const float border = -(edges[k].b * y + std::max(edges[k].b, 0.0f) + edges[k].c) * inverse[k];
      if (edges[k].a > 0)
        first = std::max(first, border - 1);
      else
        last = std::min(last, border + 1);
    }
    return {static_cast<int>(std::min(first, static_cast<float>(width))),
            static_cast<int>(std::max(last, 0.0f))};
  }
};

std::uint32_t sixteen_bits(float value) {
  const auto whole = static_cast<std::int32_t>(std::clamp(value, -1.0f, 1.0f) * 32767.0f);
  return static_cast<std::uint32_t>(whole) & 0xFFFFu;
}

// Three corners relative to (x0, y0), the first pixel of the box; the box is empty when the
// triangle faces away or holds no sample. Samples keep `rim` from the borders of their pixel.
template <class Corner>
struct Placed {
  PixelRect box;
  std::array<float, 3> x, y, z;
  float twice_area = 0;

  Placed(const Corner& a, const Corner& b, const Corner& c, const PixelRect& rect, float rim) {
    twice_area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
    if (!(twice_area > 0)) return;
    // Numbers that are not negative lose their fraction: quicker than floor.
    const auto first = [&](float v, int from, int to) {
      return static_cast<int>(
          std::min(std::max(v + rim, static_cast<float>(from)), static_cast<float>(to)));
    };
    const float last = 1 - 2 * rim;
    box = {first(std::min(std::min(a.x, b.x), c.x), rect.x0, rect.x1),
           first(std::min(std::min(a.y, b.y), c.y), rect.y0, rect.y1),
           first(std::max(std::max(a.x, b.x), c.x) + last, rect.x0, rect.x1),
           first(std::max(std::max(a.y, b.y), c.y) + last, rect.y0, rect.y1)};
    if (box.empty()) return;
    const auto ox = static_cast<float>(box.x0), oy = static_cast<float>(box.y0);
    x = {a.x - ox, b.x - ox, c.x - ox};
    y = {a.y - oy, b.y - oy, c.y - oy};
    z = {a.z, b.z, c.z};
  }
};

}  // namespace

void PixelRect::extend(const PixelRect& other) {
  if (other.empty()) return;
  if (empty()) {
    *this = other;
    return;
  }
  x0 = std::min(x0, other.x0), y0 = std::min(y0, other.y0);
  x1 = std::max(x1, other.x1), y1 = std::max(y1, other.y1);
}

PixelRect pixels_of(const Box3& box, const Eigen::Matrix4d& to_clip, int width, int height) {
  Eigen::AlignedBox2d seen;
  for (const Vec3& p : corners(box)) {
    const Eigen::Vector4d c = to_clip * Eigen::Vector4d(p.x(), p.y(), p.z(), 1);
    seen.extend(Eigen::Vector2d((c.head<2>() / c.w()).array() * 0.5 + 0.5)
                    .cwiseProduct(Eigen::Vector2d(width, height)));
  }
  const auto whole = [](double v, int last) {
    return static_cast<int>(std::clamp(v, 0.0, static_cast<double>(last)));
  };
  return {whole(seen.min().x() - 1, width), whole(seen.min().y() - 1, height),
          whole(seen.max().x() + 2, width), whole(seen.max().y() + 2, height)};
}

void SmallTriangles::start_picture(int width, int height, const PixelRect& rect) {
  width_ = width, height_ = height, rect_ = rect;
  texels_.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int y = rect.y0; y < rect.y1; ++y)
    std::fill_n(texels_.begin() + static_cast<std::ptrdiff_t>(y) * width + rect.x0, rect.width(),
                SmallTexel{});
}

void SmallTriangles::start_depths(int side, const PixelRect& rect) {
  side_ = side, depth_rect_ = rect;
  depths_.resize(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
  for (int y = rect.y0; y < rect.y1; ++y)
    std::fill_n(depths_.begin() + static_cast<std::ptrdiff_t>(y) * side + rect.x0, rect.width(),
                1.0f);
}

void SmallTriangles::place_corners(const SmallBody& body, const Eigen::Matrix4d& to_clip, int width,
                                   int height) {
  Eigen::Matrix4d to_pixels = Eigen::Matrix4d::Identity();
  to_pixels(0, 0) = to_pixels(0, 3) = width / 2.0;
  to_pixels(1, 1) = to_pixels(1, 3) = height / 2.0;
  const Eigen::Matrix4f M = (to_pixels * to_clip * body.model).cast<float>();
  corners_.resize(body.shape.vertices.size());
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const auto& p = body.shape.vertices[i].position;
    const Eigen::Vector4f c = M.col(0) * p[0] + M.col(1) * p[1] + M.col(2) * p[2] + M.col(3);
    const float scale = 1 / c.w();
    corners_[i] = {c.x() * scale, c.y() * scale, c.z() * scale};
  }
}

void SmallTriangles::draw(const SmallBody& body, const Eigen::Matrix4d& to_clip) {
  place_corners(body, to_clip, width_, height_);
  const Eigen::Matrix3f R = body.model.topLeftCorner<3, 3>().cast<float>();
  normals_.resize(corners_.size());
  for (std::size_t i = 0; i < normals_.size(); ++i) {
    const auto& n = body.shape.vertices[i].normal;
    normals_[i] = R.col(0) * n[0] + R.col(1) * n[1] + R.col(2) * n[2];
  }
  const auto& indices = body.shape.indices;
  for (std::size_t i = 0; i < indices.size(); i += 3) draw_triangle(&indices[i], body.look);
}

void SmallTriangles::draw_triangle(const std::uint32_t* index, std::uint32_t look) {
  const Placed<Corner> t(corners_[index[0]], corners_[index[1]], corners_[index[2]], rect_,
                         sample_rim);
  if (t.box.empty()) return;
  // Edge k lies opposite corner k.
  const std::array<Edge, 3> edges = {Edge(t.x[1], t.y[1], t.x[2], t.y[2]),
                                     Edge(t.x[2], t.y[2], t.x[0], t.y[0]),
                                     Edge(t.x[0], t.y[0], t.x[1], t.y[1])};
  const Four e0 = edges[0].a * sample_x + edges[0].b * sample_y + edges[0].c;
  const Four e1 = edges[1].a * sample_x + edges[1].b * sample_y + edges[1].c;
  const Four e2 = edges[2].a * sample_x + edges[2].b * sample_y + edges[2].c;
  const float near = std::min({t.z[0], t.z[1], t.z[2]}), far = std::max({t.z[0], t.z[1], t.z[2]});
  const float share = 1 / t.twice_area;
  const Rows rows(edges, t.box.width());
  for (int py = t.box.y0; py < t.box.y1; ++py) {
    const auto y = static_cast<float>(py - t.box.y0);
    const auto [from, to] = rows.span(y);
    for (int px = t.box.x0 + from; px < t.box.x0 + to; ++px) {
      const auto x = static_cast<float>(px - t.box.x0);
      const FourBits inside = (e0 + (edges[0].a * x + edges[0].b * y) >= 0.0f) &
                              (e1 + (edges[1].a * x + edges[1].b * y) >= 0.0f) &
                              (e2 + (edges[2].a * x + edges[2].b * y) >= 0.0f) &
                              FourBits{1, 2, 4, 8};
      const auto cover = static_cast<std::uint32_t>(inside[0] | inside[1] | inside[2] | inside[3]);
      const float cx = x + 0.5f, cy = y + 0.5f;
      const float u = edges[0].at(cx, cy) * share, v = edges[1].at(cx, cy) * share;
      // Whose middle is covered comes before who only touches the pixel. Of two triangles with a
      // common edge one at least must have it, whatever is rounded.
      const bool middle = std::min(std::min(u, v), 1 - u - v) >= -1e-4f;
      if (cover == 0 && !middle) continue;
      SmallTexel& texel = texels_[static_cast<std::size_t>(py) * static_cast<std::size_t>(width_) +
                                  static_cast<std::size_t>(px)];
      // The pixel's middle may lie outside: no depth beyond that of the corners.
      const float z = std::clamp(u * t.z[0] + v * t.z[1] + (1 - u - v) * t.z[2], near, far);
      const bool has_middle = (texel.normal_z & middle_bit) != 0;
      const std::uint32_t covered =
          (texel.normal_z & (0xF0000u | middle_bit)) | cover << 16 | (middle ? middle_bit : 0);
      if (middle == has_middle ? z < texel.depth : middle) {
        const float cu = std::clamp(u, 0.0f, 1.0f), cv = std::clamp(v, 0.0f, 1.0f - cu);
        const Eigen::Vector3f n =
            cu * normals_[index[0]] + cv * normals_[index[1]] + (1 - cu - cv) * normals_[index[2]];
        texel.depth = z;
        texel.normal_xy = sixteen_bits(n.x()) | sixteen_bits(n.y()) << 16;
        texel.normal_z = sixteen_bits(n.z()) | covered;
        texel.look = look;
      } else {
        texel.normal_z |= covered;
      }
    }
  }
}

void SmallTriangles::draw_depths(const SmallBody& body, const Eigen::Matrix4d& to_clip) {
  place_corners(body, to_clip, side_, side_);
  const auto& indices = body.shape.indices;
  for (std::size_t i = 0; i < indices.size(); i += 3) draw_triangle_depth(&indices[i]);
}

// One sample in the middle; pushed away from the lamp as glPolygonOffset(1.5, 2) does.
void SmallTriangles::draw_triangle_depth(const std::uint32_t* index) {
  const Placed<Corner> t(corners_[index[0]], corners_[index[1]], corners_[index[2]], depth_rect_,
                         0.5f);
  if (t.box.empty()) return;
  const std::array<Edge, 3> edges = {Edge(t.x[1], t.y[1], t.x[2], t.y[2]),
                                     Edge(t.x[2], t.y[2], t.x[0], t.y[0]),
                                     Edge(t.x[0], t.y[0], t.x[1], t.y[1])};
  const float share = 0.5f / t.twice_area;  // clip depth to 0 … 1
  const float dx = (edges[0].a * t.z[0] + edges[1].a * t.z[1] + edges[2].a * t.z[2]) * share;
  const float dy = (edges[0].b * t.z[0] + edges[1].b * t.z[1] + edges[2].b * t.z[2]) * share;
  const float bias = 1.5f * std::max(std::abs(dx), std::abs(dy)) + 2 * 6e-8f;
  const float z0 =
      (edges[0].c * t.z[0] + edges[1].c * t.z[1] + edges[2].c * t.z[2]) * share + 0.5f + bias;
  const Rows rows(edges, t.box.width());
  for (int py = t.box.y0; py < t.box.y1; ++py) {
    const float y = static_cast<float>(py - t.box.y0) + 0.5f;
    const auto [from, to] = rows.span(y - 0.5f);
    for (int px = t.box.x0 + from; px < t.box.x0 + to; ++px) {
      const float x = static_cast<float>(px - t.box.x0) + 0.5f;
      if (std::min({edges[0].at(x, y), edges[1].at(x, y), edges[2].at(x, y)}) < 0) continue;
      float& depth = depths_[static_cast<std::size_t>(py) * static_cast<std::size_t>(side_) +
                             static_cast<std::size_t>(px)];
      depth = std::min(depth, std::clamp(z0 + dx * x + dy * y, 0.0f, 1.0f));
    }
  }
}

}  // namespace aircut::render
