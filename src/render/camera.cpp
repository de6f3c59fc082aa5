#include "render/camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace aircut::render {
namespace {

struct NamedView {
  const char* name;
  Vec3 back;  // from the target to the eye
  Vec3 up;
};

// X to the right, Y away from the operator, Z up: `front` is where the operator stands.
std::vector<NamedView> named_views() {
  return {{"iso", Vec3(0.62, -1.0, 0.62), Vec3::UnitZ()}, {"front", -Vec3::UnitY(), Vec3::UnitZ()},
          {"back", Vec3::UnitY(), Vec3::UnitZ()},         {"left", -Vec3::UnitX(), Vec3::UnitZ()},
          {"right", Vec3::UnitX(), Vec3::UnitZ()},        {"top", Vec3::UnitZ(), Vec3::UnitY()}};
}

Mat3 camera_axes(const Vec3& back, const Vec3& up) {
  const Vec3 z = back.norm() > 0 ? Vec3(back.normalized()) : Vec3(Vec3::UnitZ());
  Vec3 x = up.cross(z);
  if (x.norm() < 1e-6) x = Vec3::UnitY().cross(z);  // looking along `up`
  if (x.norm() < 1e-6) x = Vec3::UnitX();
  x.normalize();
  Mat3 out;
  out.row(0) = x;
  out.row(1) = z.cross(x);
  out.row(2) = z;
  return out;
}

// The nearest eye from which a perspective camera of these axes sees all points: the side planes of
// the view (slopes tx, ty) each touch the box. For the right plane x + z·tx ≤ ex + ez·tx for all
// points, for the left one -x + z·tx ≤ -ex + ez·tx; the sum gives ez, the difference ex.
Camera fitted(const NamedView& name, const Box3& fit, double aspect) {
  constexpr double margin = 0.87;  // of the half picture; the caption lies at the top
  Camera out;
  out.field_of_view = 0.42;  // a long lens: verticals stay nearly upright
  const double ty = std::tan(out.field_of_view / 2) * margin;
  const double tx = std::tan(out.field_of_view / 2) * std::max(aspect, 1e-3) * margin;
  const Mat3 axes = camera_axes(name.back, name.up);
  Eigen::Vector4d reach = Eigen::Vector4d::Constant(-1e300);
  for (const Vec3& corner : corners(fit)) {
    const Vec3 p = axes * corner;
    reach = reach.cwiseMax(Eigen::Vector4d(p.x() + p.z() * tx, -p.x() + p.z() * tx,
                                           p.y() + p.z() * ty, -p.y() + p.z() * ty));
  }
  const double middle = (axes * fit.center()).z();
  const double ez =
      std::max({(reach[0] + reach[1]) / (2 * tx), (reach[2] + reach[3]) / (2 * ty), middle + 1e-3});
  const Vec3 eye((reach[0] - reach[1]) / 2, (reach[2] - reach[3]) / 2, ez);
  out.eye = axes.transpose() * eye;
  out.target = axes.transpose() * Vec3(eye.x(), eye.y(), middle);
  out.up = name.up;
  return out;
}

// Six numbers with commas between.
std::optional<std::array<double, 6>> six_numbers(const std::string& text) {
  std::array<double, 6> out{};
  std::size_t start = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    const std::size_t end = text.find(',', start);
    if ((end == std::string::npos) != (i == 5)) return {};
    const auto value = parse_number(std::string_view(text).substr(
        start, end == std::string::npos ? std::string::npos : end - start));
    if (!value) return {};
    out[i] = *value;
    start = end + 1;
  }
  return out;
}

}  // namespace

std::array<Vec3, 8> corners(const Box3& box) {
  std::array<Vec3, 8> out;
  for (unsigned i = 0; i < 8; ++i)
    out[i] = Vec3((i & 1u) != 0 ? box.max().x() : box.min().x(),
                  (i & 2u) != 0 ? box.max().y() : box.min().y(),
                  (i & 4u) != 0 ? box.max().z() : box.min().z());
  return out;
}

Expected<Camera> camera_by_name(const std::string& name, const Box3& fit, double aspect) {
  std::vector<std::string> known;
  Box3 box = fit;
  if (box.isEmpty()) box = Box3(Vec3::Constant(-1), Vec3::Constant(1));
  for (const NamedView& view : named_views()) {
    if (name == view.name) return fitted(view, box, aspect);
    known.emplace_back(view.name);
  }
  if (const auto v = six_numbers(name)) {
    Camera out;
    out.eye = Vec3((*v)[0], (*v)[1], (*v)[2]);
    out.target = Vec3((*v)[3], (*v)[4], (*v)[5]);
    if (!((out.eye - out.target).norm() > 1e-6))
      return unexpected(make_error(
          "usage",
          fmt::format("camera '{}' stands in the point that it looks at", printable(name))));
    if ((out.eye - out.target).normalized().cross(out.up).norm() < 1e-3) out.up = Vec3::UnitY();
    return out;
  }
  return unexpected(make_error(
      "usage", fmt::format("there is no camera '{}'; use iso, front, back, left, right, top, or "
                           "six numbers X,Y,Z,tx,ty,tz (eye and target, mm).{}",
                           printable(name), did_you_mean(name, known))));
}

View make_view(const Camera& camera, const Box3& contents, int width, int height) {
  View out;
  out.width = width;
  out.height = height;
  out.centre = contents.isEmpty() ? camera.target : Vec3(contents.center());
  out.eye = camera.eye - out.centre;
  out.axes = camera_axes(camera.eye - camera.target, camera.up);
  out.distance = std::max((camera.eye - camera.target).norm(), 1e-6);
  out.orthographic = !(camera.field_of_view > 0);
  out.view.topLeftCorner<3, 3>() = out.axes;
  out.view.topRightCorner<3, 1>() = -out.axes * out.eye;
  // Clipping planes around the contents: depths are distances in front of the eye.
  double near = 1e300, far = -1e300;
  if (!contents.isEmpty())
    for (const Vec3& corner : corners(contents)) {
      const double depth = -(out.axes.row(2) * (corner - camera.eye)).value();
      near = std::min(near, depth);
      far = std::max(far, depth);
    }
  const double aspect = static_cast<double>(width) / height;
  Eigen::Matrix4d& P = out.projection;
  P.setZero();
  if (out.orthographic) {
    const double half = std::max(camera.height, 1e-6) / 2;
    if (!(near < far)) near = 0, far = 2 * out.distance;
    const double slack = 0.01 * (far - near) + 1e-3;
    near -= slack, far += slack;
    P(0, 0) = 1 / (half * aspect);
    P(1, 1) = 1 / half;
    P(2, 2) = -2 / (far - near);
    P(2, 3) = -(far + near) / (far - near);
    P(3, 3) = 1;
    out.mm_per_pixel = 2 * half / height;
  } else {
    const double slope = std::tan(std::min(camera.field_of_view, 3.0) / 2);
    // Never nearer than a fiftieth of the way to the target: depth needs the resolution.
    near = std::max(near * 0.98, out.distance / 50);
    far = std::max(far * 1.02, near * 2);
    P(0, 0) = 1 / (slope * aspect);
    P(1, 1) = 1 / slope;
    P(2, 2) = -(far + near) / (far - near);
    P(2, 3) = -2 * far * near / (far - near);
    P(3, 2) = -1;
    out.mm_per_pixel = 2 * slope * out.distance / height;
  }
  return out;
}

double View::depth(const Vec3& world) const {
  const Vec3 p = world - centre;
  const Eigen::Vector4d clip = view_projection() * Eigen::Vector4d(p.x(), p.y(), p.z(), 1);
  return (clip.z() / clip.w() + 1) / 2;
}

double View::distance_of(double depth) const {
  const double ndc = 2 * depth - 1;
  const Eigen::Matrix4d& P = projection;
  return orthographic ? (P(2, 3) - ndc) / P(2, 2) : P(2, 3) / (ndc + P(2, 2));
}

std::optional<Eigen::Vector2d> View::pixel(const Vec3& world) const {
  const Vec3 p = world - centre;
  const Eigen::Vector4d clip = view_projection() * Eigen::Vector4d(p.x(), p.y(), p.z(), 1);
  if (!clip.allFinite() || clip.w() <= 0) return {};
  return Eigen::Vector2d((clip.x() / clip.w() + 1) / 2 * width,
                         (1 - clip.y() / clip.w()) / 2 * height);
}

}  // namespace aircut::render
