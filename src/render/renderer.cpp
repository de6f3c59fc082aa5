// The picture is drawn in tiles of at most `tile_side` pixels, so that memory does not grow with
// its size. Tiles overlap by `tile_margin`, since occlusion looks at neighbouring pixels.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "render/finding_camera.h"
#include "render/overlay.h"
#include "render/painter.h"
#include "render/small_triangles.h"

namespace aircut::render {
namespace {

constexpr int largest_side = 16384;
constexpr int tile_side = 2048;
constexpr int tile_margin = 128;

// Starts and lengths of the tiles along one side: all of one length, the last one flush.
std::vector<int> tile_starts(int total, int length) {
  std::vector<int> out;
  for (int at = 0;; at += length - 2 * tile_margin) {
    if (at + length >= total) {
      out.push_back(total - length);
      return out;
    }
    out.push_back(at);
  }
}

std::vector<Tile> make_tiles(int width, int height, int tile_width, int tile_height) {
  std::vector<Tile> out;
  for (const int y : tile_starts(height, tile_height))
    for (const int x : tile_starts(width, tile_width))
      out.push_back({x, y, tile_width, tile_height});
  return out;
}

// Rows of OpenGL run from the bottom. What lies within the margin of an inner border is left to the
// neighbour.
void copy_tile(Image& image, const Tile& tile, const std::vector<unsigned char>& pixels) {
  const int half = tile_margin;
  const int x0 = tile.x == 0 ? 0 : half;
  const int x1 = tile.x + tile.width == image.width ? tile.width : tile.width - half;
  const int y0 = tile.y == 0 ? 0 : half;
  const int y1 = tile.y + tile.height == image.height ? tile.height : tile.height - half;
  for (int y = y0; y < y1; ++y) {
    const auto row = static_cast<std::size_t>(image.height - 1 - (tile.y + y));
    const auto to =
        (row * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(tile.x + x0)) * 4;
    const auto from = (static_cast<std::size_t>(y) * static_cast<std::size_t>(tile.width) +
                       static_cast<std::size_t>(x0)) *
                      4;
    std::memcpy(&image.rgba[to], &pixels[from], static_cast<std::size_t>(x1 - x0) * 4);
  }
}

Image halved(const Image& image) {
  Image out = make_image(image.width / 2, image.height / 2, {});
  const auto w = static_cast<std::size_t>(out.width);
  for (std::size_t y = 0; y < static_cast<std::size_t>(out.height); ++y)
    for (std::size_t x = 0; x < w; ++x)
      for (std::size_t c = 0; c < 4; ++c) {
        const std::size_t top = (2 * y * 2 * w + 2 * x) * 4 + c, below = top + 2 * w * 4;
        const int sum =
            image.rgba[top] + image.rgba[top + 4] + image.rgba[below] + image.rgba[below + 4];
        out.rgba[(y * w + x) * 4 + c] = static_cast<unsigned char>((sum + 2) / 4);
      }
  return out;
}

}  // namespace

struct Renderer::Impl {
  FrameSize size;
  int tile_width = 0, tile_height = 0;
  // In this order, so that the context outlives its objects.
  std::unique_ptr<GlContext> context;
  Gl gl;
  std::optional<Fonts> fonts;
  std::optional<MeshCache> meshes;
  Programs programs;
  Targets targets;
  SmallTriangles small;

  ~Impl() {
    if (context != nullptr) context->make_current();
  }
  int factor() const { return size.supersample == Supersample::twice ? 2 : 1; }
  std::vector<unsigned char> read_tile(const Tile& tile) const;
  // Depths (0 near, 1 far) in the framebuffer that is bound.
  std::vector<float> read_depths(int width, int height) const;
  Expected<void> start();
};

Expected<void> Renderer::Impl::start() {
  auto made = create_gl_context(size.backend);
  if (!made) return unexpected(made.error());
  context = std::move(*made);
  auto loaded = load_gl(*context);
  if (!loaded) return unexpected(loaded.error());
  gl = *loaded;
  auto linked = link_programs(gl);
  if (!linked) return unexpected(linked.error());
  programs = std::move(*linked);
  tile_width = std::min(size.width * factor(), tile_side);
  tile_height = std::min(size.height * factor(), tile_side);
  auto targets_made = make_picture_targets(gl, tile_width, tile_height);
  if (!targets_made) return unexpected(targets_made.error());
  targets = std::move(*targets_made);
  if (auto ok = add_id_target(gl, targets); !ok) return ok;
  meshes.emplace(gl);
  return {};
}

std::vector<unsigned char> Renderer::Impl::read_tile(const Tile& tile) const {
  std::vector<unsigned char> out(static_cast<std::size_t>(tile.width) *
                                 static_cast<std::size_t>(tile.height) * 4);
  gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
  gl.ReadPixels(0, 0, tile.width, tile.height, GL_RGBA, GL_UNSIGNED_BYTE, out.data());
  return out;
}

std::vector<float> Renderer::Impl::read_depths(int width, int height) const {
  std::vector<float> out(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  gl.ReadPixels(0, 0, width, height, GL_DEPTH_COMPONENT, GL_FLOAT, out.data());
  return out;
}

Renderer::Renderer() : impl_(std::make_unique<Impl>()) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;

Expected<Renderer> Renderer::create(FrameSize size) {
  const int factor = size.supersample == Supersample::twice ? 2 : 1;
  const int limit = largest_side / factor;
  if (size.width < 1 || size.height < 1 || size.width > limit || size.height > limit)
    return unexpected(make_error(
        "output_failed", fmt::format("a picture of {} x {} pixels cannot be drawn; each side must "
                                     "be 1 to {}",
                                     size.width, size.height, limit)));
  Renderer out;
  out.impl_->size = size;
  auto fonts = Fonts::load(font_folders());
  if (!fonts) return unexpected(fonts.error());
  out.impl_->fonts.emplace(std::move(*fonts));
  if (auto ok = out.impl_->start(); !ok) return unexpected(ok.error());
  return out;
}

Image Renderer::draw(const Scene& scene, const Camera& camera) {
  Impl& r = *impl_;
  r.context->make_current();
  const int width = r.size.width * r.factor(), height = r.size.height * r.factor();
  const Stage stage = make_stage(scene, camera, *r.meshes, width, height);
  const Painter painter(r.gl, r.programs, r.targets, r.small);
  painter.draw_shadow_map(stage);
  Image image = make_image(width, height, {});
  // Lines keep their share of large pictures; below 0.7 of a pixel they would be lost.
  const double line_scale = std::max(0.7, layout_scale(r.size.width, r.size.height)) * r.factor();
  for (const Tile& tile : make_tiles(width, height, r.tile_width, r.tile_height)) {
    painter.draw_tile(stage, scene, tile, line_scale);
    copy_tile(image, tile, r.read_tile(tile));
  }
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
  if (r.factor() == 1) {
    draw_overlay(image, scene, stage, *r.fonts);
    return image;
  }
  image = halved(image);
  draw_overlay(image, scene, make_stage(scene, camera, *r.meshes, r.size.width, r.size.height),
               *r.fonts);
  return image;
}

namespace {

// Body index + 1 per pixel; 0 where there is none.
std::vector<int> decode_ids(const std::vector<unsigned char>& pixels) {
  std::vector<int> out;
  out.reserve(pixels.size() / 4);
  for (std::size_t i = 0; i < pixels.size(); i += 4)
    out.push_back(pixels[i] + 256 * pixels[i + 1] + 65536 * pixels[i + 2]);
  return out;
}

// What the bodies that are not in alarm hide: `at` is the depth of the contact, `before` that of
// the foreground's far end.
void look_at_depths(ContactView& view, const std::vector<float>& depths, double at, double before) {
  const auto middle =
      static_cast<std::size_t>(view.height / 2) * static_cast<std::size_t>(view.width) +
      static_cast<std::size_t>(view.width / 2);
  view.point_is_open = static_cast<double>(depths[middle]) >= at;
  const auto near = std::count_if(depths.begin(), depths.end(),
                                  [&](float d) { return static_cast<double>(d) < before; });
  view.foreground = static_cast<double>(near) / static_cast<double>(depths.size());
}

}  // namespace

std::vector<int> Renderer::visible_pixels(const Scene& scene, const Camera& camera) {
  Impl& r = *impl_;
  r.context->make_current();
  const Stage stage = make_stage(scene, camera, *r.meshes, r.size.width, r.size.height);
  const Painter painter(r.gl, r.programs, r.targets, r.small);
  std::vector<int> out(scene.bodies.size(), 0);
  for (int y = 0; y < r.size.height; y += r.tile_height)
    for (int x = 0; x < r.size.width; x += r.tile_width) {
      const Tile tile{x, y, std::min(r.tile_width, r.size.width - x),
                      std::min(r.tile_height, r.size.height - y)};
      for (const bool translucent : {false, true}) {
        painter.clear_ids(tile, translucent);
        painter.draw_ids(stage, tile,
                         [&](const DrawBody& body) { return body.translucent == translucent; });
        for (const int id : decode_ids(r.read_tile(tile)))
          if (id > 0 && static_cast<std::size_t>(id) <= out.size())
            ++out[static_cast<std::size_t>(id) - 1];
      }
    }
  return out;
}

Camera Renderer::camera_for_finding(const std::vector<DrawBody>& bodies, const Vec3& point,
                                    double span) {
  Impl& r = *impl_;
  r.context->make_current();
  const double aspect = static_cast<double>(r.size.width) / r.size.height;
  constexpr double most_pixels = 120.0 * 192.0;
  const double shrink =
      std::min(1.0, std::sqrt(most_pixels / (static_cast<double>(r.size.width) * r.size.height)));
  const int width =
      std::clamp(static_cast<int>(std::lround(r.size.width * shrink)), 1, r.tile_width);
  const int height =
      std::clamp(static_cast<int>(std::lround(r.size.height * shrink)), 1, r.tile_height);
  const Tile tile{0, 0, width, height};
  const auto middle = static_cast<std::size_t>(height / 2) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(width / 2);
  const Painter painter(r.gl, r.programs, r.targets, r.small);
  Scene scene;
  scene.bodies = bodies;
  scene.floor = false;
  Camera best;
  double best_score = -1e300;
  int rank = 0;
  for (const Vec3& direction : candidate_directions()) {
    const Camera camera = contact_camera(point, direction, span, aspect);
    const Stage stage = make_stage(scene, camera, *r.meshes, width, height);
    painter.clear_ids(tile, false);
    painter.draw_ids(stage, tile,
                     [](const DrawBody& body) { return !body.translucent && !body.highlight; });
    ContactView view{width, height, {}};
    look_at_depths(view, r.read_depths(width, height), stage.view.depth(point),
                   stage.view.depth(point + 0.6 * span * direction));
    painter.draw_ids(stage, tile,
                     [](const DrawBody& body) { return !body.translucent && body.highlight; });
    view.ids = decode_ids(r.read_tile(tile));
    const View& v = stage.view;
    view.cover = (v.distance_of(v.depth(point)) -
                  v.distance_of(static_cast<double>(r.read_depths(width, height)[middle]))) /
                 std::max(span, 1e-9);
    const double score = contact_score(view, bodies) - cost_of_rank * rank++;
    if (score > best_score + 1e-9) {
      best = camera;
      best_score = score;
    }
  }
  return best;
}

}  // namespace aircut::render
