// render: pictures of a scene. OSMesa, libpng and FreeType stay inside this library.
// World units mm, Z up.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "geometry/geometry.h"
#include "machine/machine.h"

namespace aircut::render {

/// 8-bit RGBA, rows from the top.
struct Image {
  int width = 0, height = 0;
  std::vector<unsigned char> rgba;
};
std::string png_bytes(const Image& image);  ///< deterministic; libpng, SUB filter, level 3
/// Pictures from png_bytes, all of one size, as an animated PNG that goes on for ever; empty when
/// they are not.
std::string apng_bytes(std::span<const std::string> pictures, double seconds_each);

struct DrawBody {
  std::string name;
  std::shared_ptr<const TriangleMesh> mesh;
  Pose X_WB = Pose::Identity();
  machine::Color color;
  bool highlight = false;  ///< drawn in the alarm colour, seen through what covers it
  bool translucent = false;
};

enum class LineKind : unsigned char { rapid, feed, arc, done };
struct DrawLine {
  LineKind kind = LineKind::feed;            ///< rapids are dashed
  std::vector<Vec3> points;                  ///< world, mm
  std::optional<machine::Color> color = {};  ///< in place of the kind's
};

struct DrawMarker {
  Vec3 at = Vec3::Zero();  ///< contact point, world, mm
};

struct Camera {
  Vec3 eye = Vec3(1, -1, 1);
  Vec3 target = Vec3::Zero();
  Vec3 up = Vec3::UnitZ();
  double field_of_view = 0.6;  ///< rad, vertical; 0 = orthographic with `height` mm
  double height = 0;
};
/// `iso`, `front`, `top`, `right`, `left`, `back` fitted to a box; or `X,Y,Z,tx,ty,tz`.
/// Error kind `usage` for anything else, with the nearest name.
Expected<Camera> camera_by_name(const std::string& name, const Box3& fit, double aspect);
/// A camera that sees `point` from where it is best visible, `span` mm across: candidate directions
/// are drawn small into an id buffer and the one that shows most of the `highlight` bodies near the
/// point wins.
Camera camera_for_finding(const std::vector<DrawBody>& bodies, const Vec3& point, double span,
                          double aspect);

struct Caption {
  std::vector<std::string> left;   ///< lines, top left
  std::vector<std::string> right;  ///< lines, top right
  std::string alarm;               ///< shown in red when not empty
};

/// What a colour means.
struct LegendRow {
  std::string text;
  machine::Color color;
};

/// What lies on the side of `normal` is cut away; closed bodies are shown as full there.
struct Section {
  Vec3 point = Vec3::Zero();    ///< world, mm
  Vec3 normal = Vec3::UnitZ();  ///< world, unit
};

struct Scene {
  std::vector<DrawBody> bodies;
  std::vector<DrawLine> lines;
  std::vector<DrawMarker> markers;
  Caption caption;
  std::vector<LegendRow> legend;  ///< besides the kinds of lines
  std::optional<Section> section;
  bool floor = true;
  bool triad = true;
};

/// Where the OpenGL context comes from. Both are Mesa's software rasteriser, without a screen.
enum class Backend : unsigned char { automatic, osmesa, egl };

enum class Supersample : unsigned char { once, twice };

struct FrameSize {
  int width = 1280, height = 800;               ///< pixels, 1 to 16384
  Supersample supersample = Supersample::once;  ///< on top of 4 samples a pixel
  Backend backend = Backend::automatic;         ///< OSMesa, or EGL where there is none
};

/// Holds the off-screen context and uploaded meshes (by address). One per thread.
class Renderer {
 public:
  /// Error kind `output_failed`: no GL context, framebuffer incomplete, size out of range.
  static Expected<Renderer> create(FrameSize size);
  ~Renderer();
  Renderer(Renderer&&) noexcept;

  Image draw(const Scene& scene, const Camera& camera);
  /// Pixels that show each body (index into scene.bodies), for tests and for choosing cameras.
  /// Translucent bodies hide nothing here.
  std::vector<int> visible_pixels(const Scene& scene, const Camera& camera);
  /// As the function above, with the meshes that this renderer holds already and its aspect.
  Camera camera_for_finding(const std::vector<DrawBody>& bodies, const Vec3& point, double span);

 private:
  Renderer();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

struct SheetCell {
  Image image;
  std::string caption;
};
/// Contact sheet: cells in a grid, each scaled down and captioned. A picture without size when the
/// fonts are missing (then no Renderer can be created either).
Image contact_sheet(const std::vector<SheetCell>& cells, int columns, int cell_width,
                    const std::string& title);

}  // namespace aircut::render
