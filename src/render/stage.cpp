#include "render/stage.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace aircut::render {
namespace {

Box3 moved(const Box3& box, const Eigen::Matrix4d& X) {
  Box3 out;
  if (box.isEmpty()) return out;
  for (const Vec3& corner : corners(box))
    out.extend(Vec3((X * Eigen::Vector4d(corner.x(), corner.y(), corner.z(), 1)).head<3>()));
  return out;
}

// The lamps stand with the photographer: key from the upper left behind the camera, fill from the
// right, rim from behind the scene.
Lamps place_lamps(const View& view) {
  Lamps out;
  Vec3 right = view.axes.row(0);
  right.z() = 0;
  right = right.norm() > 1e-6 ? Vec3(right.normalized()) : Vec3(Vec3::UnitX());
  out.right = right;
  out.ahead = Vec3::UnitZ().cross(right);
  const Vec3 up = Vec3::UnitZ();
  out.key = (-0.62 * out.right - 0.42 * out.ahead + 1.05 * up).normalized();
  out.fill = (0.90 * out.right - 0.55 * out.ahead + 0.35 * up).normalized();
  out.rim = (0.35 * out.right + 0.85 * out.ahead + 0.60 * up).normalized();
  return out;
}

// Corners of the part of space that the picture shows between two depths, render frame.
std::array<Vec3, 8> seen_space(const View& view, double near, double far) {
  const Eigen::Matrix4d& P = view.projection;
  std::array<Vec3, 8> out;
  for (unsigned i = 0; i < 8; ++i) {
    const double depth = (i & 4u) != 0 ? far : near;
    const double reach = view.orthographic ? 1 : depth;
    const Vec3 p(((i & 1u) != 0 ? 1 : -1) * reach / P(0, 0),
                 ((i & 2u) != 0 ? 1 : -1) * reach / P(1, 1), -depth);
    out[i] = view.axes.transpose() * p + view.eye;
  }
  return out;
}

// A parallel projection along the key light, onto a square that holds what is both in the picture
// and in the shadow of some body: a body throws shadows only onto points that lie behind it in this
// projection, and so within its own outline. Through the map: the sphere around all bodies.
void place_shadow(Stage& stage) {
  const Vec3 z = stage.lamps.key, x = Vec3::UnitZ().cross(z).normalized(), y = z.cross(x);
  const auto flat = [&](const Vec3& p) { return Eigen::Vector2d(p.dot(x), p.dot(y)); };
  Eigen::AlignedBox2d shaded, shown;
  double near = 1e300, far = -1e300;
  for (const Vec3& corner : corners(stage.solid)) {
    shaded.extend(flat(corner));
    const double depth = -(stage.view.axes.row(2) * (corner - stage.view.eye)).value();
    near = std::min(near, depth);
    far = std::max(far, depth);
  }
  const double radius = stage.solid.diagonal().norm() / 2 * 1.01 + 1e-3;
  // Shadows on the floor reach beyond the bodies.
  const double least = stage.view.orthographic ? near : std::max(near, 0.0);
  for (const Vec3& corner : seen_space(stage.view, least, std::max(far, least) + radius))
    shown.extend(flat(corner));
  Eigen::AlignedBox2d square = shaded.intersection(shown);
  if (square.isEmpty()) square = shaded;
  // The rim is for the softness of shadows at the picture's border.
  const double half = std::max(square.sizes().maxCoeff() / 2 * 1.06, radius / 50);
  const Eigen::Vector2d middle = square.center();
  Eigen::Matrix4d M = Eigen::Matrix4d::Identity();
  M.row(0) << x.transpose() / half, -middle.x() / half;
  M.row(1) << y.transpose() / half, -middle.y() / half;
  M.row(2) << -z.transpose() / radius, z.dot(stage.solid.center()) / radius;
  stage.world_to_shadow = M;
  stage.shadow_size = 2 * half;
  stage.shadow_depth = 2 * radius;
}

// Whether a body's triangles are mean pixels or so, where SmallTriangles is the quicker. What it
// draws must lie before the eye.
bool has_small_triangles(const StageItem& item, const View& view) {
  if (!item.mesh->may_be_small() || item.body->translucent || item.body->highlight) return false;
  const Eigen::Matrix4d to_clip = view.view_projection();
  for (const Vec3& p : corners(item.box)) {
    const Eigen::Vector4d c = to_clip * Eigen::Vector4d(p.x(), p.y(), p.z(), 1);
    if (c.z() < -0.999 * c.w() || c.w() <= 0) return false;
  }
  const double depth = -(view.axes.row(2) * (item.box.center() - view.eye)).value();
  const double mm_per_pixel =
      view.mm_per_pixel * (view.orthographic ? 1 : std::abs(depth) / view.distance);
  constexpr double small = 200;  // pixels; a triangle is mostly seen aslant
  return item.mesh->shape().area < small * mm_per_pixel * mm_per_pixel * item.mesh->triangles();
}

}  // namespace

double round_down_125(double value) {
  if (!(value > 0) || !std::isfinite(value)) return 1;
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  const double lead = value / power * (1 + 1e-12);
  return (lead >= 5 ? 5 : lead >= 2 ? 2 : 1) * power;
}

Eigen::Matrix4d tile_projection(const View& view, const Tile& tile) {
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T(0, 0) = static_cast<double>(view.width) / tile.width;
  T(1, 1) = static_cast<double>(view.height) / tile.height;
  T(0, 3) = static_cast<double>(view.width - 2 * tile.x - tile.width) / tile.width;
  T(1, 3) = static_cast<double>(view.height - 2 * tile.y - tile.height) / tile.height;
  return T * view.projection;
}

bool in_view(const Box3& box, const Eigen::Matrix4d& to_clip) {
  // How far each corner lies inside the six planes: w ± x, w ± y, w ± z, all positive inside.
  Eigen::Vector3d low = Vec3::Constant(-1e300), high = low;
  for (const Vec3& p : corners(box)) {
    const Eigen::Vector4d c = to_clip * Eigen::Vector4d(p.x(), p.y(), p.z(), 1);
    low = low.cwiseMax(Vec3(c.w() + c.x(), c.w() + c.y(), c.w() + c.z()));
    high = high.cwiseMax(Vec3(c.w() - c.x(), c.w() - c.y(), c.w() - c.z()));
  }
  return low.minCoeff() >= 0 && high.minCoeff() >= 0;
}

Stage make_stage(const Scene& scene, const Camera& camera, MeshCache& meshes, int width,
                 int height) {
  meshes.next_frame();
  Stage out;
  Box3 solid, contents;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const DrawBody& body = scene.bodies[i];
    if (body.mesh == nullptr || !body.X_WB.matrix().allFinite()) continue;
    StageItem item{&body, static_cast<int>(i), &meshes.get(body.mesh), body.X_WB.matrix(), {}, 0};
    item.box = moved(item.mesh->shape().box, item.model);
    if (item.box.isEmpty()) continue;
    solid.extend(item.box);
    out.items.push_back(std::move(item));
  }
  contents = solid;
  for (const DrawLine& line : scene.lines)
    for (const Vec3& p : line.points)
      if (p.allFinite()) contents.extend(p);
  // The floor reaches far beyond the bodies and is faded out there.
  Box3 with_floor = contents;
  if (scene.floor && !solid.isEmpty()) {
    const double diagonal = solid.diagonal().norm();
    Floor floor;
    floor.height = solid.min().z() - 5e-4 * diagonal;
    floor.extent = 2.6 * diagonal;
    floor.step = round_down_125(diagonal / 22);
    if (camera.eye.z() > floor.height) {
      const Vec3 c = solid.center(), half(floor.extent, floor.extent, 0);
      with_floor.extend(Vec3(c.x(), c.y(), floor.height) + half);
      with_floor.extend(Vec3(c.x(), c.y(), floor.height) - half);
      out.floor = floor;
    }
  }
  out.view = make_view(camera, with_floor, width, height);
  const Vec3 centre = out.view.centre;
  if (scene.section) {
    const Vec3& n = scene.section->normal;
    out.section = Eigen::Vector4d(n.x(), n.y(), n.z(), -n.dot(scene.section->point - centre));
  }
  for (StageItem& item : out.items) {
    item.model.topRightCorner<3, 1>() -= centre;
    item.box.translate(-centre);
    item.depth = 1e300;
    for (const Vec3& corner : corners(item.box))
      item.depth = std::min(item.depth, -(out.view.axes.row(2) * (corner - out.view.eye)).value());
    item.small = !out.section && has_small_triangles(item, out.view);
  }
  std::stable_sort(out.items.begin(), out.items.end(),
                   [](const StageItem& a, const StageItem& b) { return a.depth < b.depth; });
  if (out.floor) out.floor->height -= centre.z();
  out.solid = solid;
  if (!solid.isEmpty()) out.solid.translate(-centre);
  out.lamps = place_lamps(out.view);
  if (out.solid.isEmpty()) return out;
  out.diagonal = out.solid.diagonal().norm();
  place_shadow(out);
  return out;
}

}  // namespace aircut::render
