// Width of a step: 1, 2 or 5 times a power of ten, so that the range has at most as many as there
// are colours. From blue over green to red as the error rises.
#include "report/accuracy_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace aircut::report {

namespace {

constexpr std::array<std::array<std::uint8_t, 3>, 8> ramp = {{
    {36, 60, 150},
    {58, 120, 196},
    {96, 178, 206},
    {116, 190, 108},
    {196, 206, 92},
    {246, 190, 70},
    {232, 112, 48},
    {166, 24, 40},
}};
constexpr std::array<std::uint8_t, 3> stock_color = {207, 178, 122};
constexpr double um = 1e3;       // per mm
constexpr double finest = 1e-3;  // µm: a narrower step says nothing

double round_width(double least) {
  const double power = std::pow(10, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= least * (1 - 1e-12)) return factor * power;
  return 10 * power;
}

// The corner of the box from which most of the surface with a prediction is seen.
Vec3 best_corner(const TriangleMesh& mesh, const std::vector<std::optional<double>>& errors) {
  Vec3 best = Vec3::Ones();
  double most = -1;
  for (const double x : {1.0, -1.0})
    for (const double y : {1.0, -1.0}) {
      const Vec3 eye = Vec3(x, -y, 1);  // iso looks from +X, -Y, +Z
      double seen = 0;
      for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto& t = mesh.triangles[i];
        const Vec3& a = mesh.vertices[t[0]];
        if (errors[i])
          seen += std::max(0.0, (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).dot(eye));
      }
      if (seen <= most * (1 + 1e-6)) continue;
      most = seen;
      best = {x, y, 1};
    }
  return best;
}

}  // namespace

ErrorScale::ErrorScale(const std::vector<std::optional<double>>& errors) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const auto& error : errors)
    if (error) {
      low = std::min(low, *error * um);
      high = std::max(high, *error * um);
    }
  if (low <= high) {
    // One step less than there are colours: the range may begin inside of the first.
    width_ = round_width(std::max((high - low) / static_cast<double>(ramp.size() - 1), finest));
    first_ = std::floor(low / width_ + 1e-9) * width_;
    const int count = std::clamp(static_cast<int>(std::ceil((high - first_) / width_ - 1e-9)), 1,
                                 static_cast<int>(ramp.size()));
    for (int i = 0; i < count; ++i) {
      const auto at = static_cast<std::size_t>(
          count == 1 ? 3 : i * (static_cast<int>(ramp.size()) - 1) / (count - 1));
      steps_.push_back(
          {ramp[at], shortest(first_ + i * width_) + " … " + shortest(first_ + (i + 1) * width_)});
    }
  }
  steps_.push_back({stock_color, "not predicted"});
}

int ErrorScale::step_of(const std::optional<double>& error) const {
  const int last = static_cast<int>(steps_.size()) - 1;
  if (!error) return last;
  return std::clamp(static_cast<int>(std::floor((*error * um - first_) / width_)), 0, last - 1);
}

Expected<render::Image> error_picture(const TriangleMesh& mesh,
                                      const std::vector<std::optional<double>>& errors,
                                      render::FrameSize size) {
  const ErrorScale scale(errors);
  std::vector<int> step_of;
  for (const auto& error : errors) step_of.push_back(scale.step_of(error));
  return map_picture(mesh, step_of, scale.steps(),
                     "predicted error of the surface, µm (above 0: material is left)", size,
                     best_corner(mesh, errors));
}

std::string error_ply(const TriangleMesh& mesh, const std::vector<std::optional<double>>& errors) {
  const ErrorScale scale(errors);
  TriangleMesh apart;
  std::vector<double> quality;
  std::vector<std::array<std::uint8_t, 3>> colors;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto first = static_cast<std::uint32_t>(apart.vertices.size());
    apart.triangles.push_back({first, first + 1, first + 2});
    for (const std::uint32_t corner : mesh.triangles[i]) {
      apart.vertices.push_back(mesh.vertices[corner]);
      quality.push_back(errors[i] ? *errors[i] * um : std::numeric_limits<double>::quiet_NaN());
      colors.push_back(scale.steps()[static_cast<std::size_t>(scale.step_of(errors[i]))].color);
    }
  }
  return ply_bytes(apart, quality, colors);
}

}  // namespace aircut::report
