// Steps: below −4, −2, −1 tolerances of a gouge, within the tolerances (one step below 0 and one
// above), and beyond 1, 2, 4 … tolerances of excess. The allowance is wanted, so it counts as
// within.
#include "report/deviation.h"

#include <algorithm>
#include <cmath>

#include "geometry/mesh_part.h"

namespace aircut::report {

namespace {

constexpr std::array<std::array<std::uint8_t, 3>, DeviationScale::steps> scale_colors = {{
    {158, 16, 40},    // far too deep
    {222, 70, 44},    //
    {246, 158, 60},   //
    {250, 216, 104},  // too deep
    {116, 190, 108},  // within the tolerances
    {150, 206, 226},  // too much is left
    {92, 158, 214},   //
    {52, 104, 184},   //
    {28, 54, 132},    // far too much
}};

}  // namespace

DeviationScale::DeviationScale(const sim::Summary::Part& part) {
  // A tolerance of 0 still needs steps that differ.
  const double gouge = std::max(part.tol_gouge, 1e-3);
  const double excess = std::max(part.tol_excess + part.allowance, 1e-3);
  borders_ = {-8 * gouge, -4 * gouge, -2 * gouge, -gouge,
              excess,     2 * excess, 4 * excess, 8 * excess};
}

int DeviationScale::step_of(double outside) const {
  return static_cast<int>(std::upper_bound(borders_.begin(), borders_.end(), outside) -
                          borders_.begin());
}

std::array<std::uint8_t, 3> DeviationScale::color_of(int step) {
  return scale_colors[static_cast<std::size_t>(step)];
}

std::string DeviationScale::text_of(int step) const {
  const auto border = [&](int i) { return shortest(borders_[static_cast<std::size_t>(i)]); };
  if (step == 0) return "below " + border(0);
  if (step == steps - 1) return "above " + border(steps - 2);
  return border(step - 1) + " … " + border(step);
}

std::vector<std::array<std::uint8_t, 3>> DeviationScale::colors(
    const std::vector<double>& outside) const {
  std::vector<std::array<std::uint8_t, 3>> out;
  out.reserve(outside.size());
  for (const double d : outside) out.push_back(color_of(step_of(d)));
  return out;
}

// A body per step.
Expected<render::Image> map_picture(const TriangleMesh& mesh, const std::vector<int>& step_of,
                                    const std::vector<MapColor>& steps, const std::string& title,
                                    render::FrameSize size, const Vec3& corner) {
  std::vector<std::vector<std::array<std::uint32_t, 3>>> triangles(steps.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    triangles[static_cast<std::size_t>(step_of[i])].push_back(mesh.triangles[i]);
  auto renderer = render::Renderer::create(size);
  if (!renderer) return unexpected(renderer.error());
  render::Scene scene;
  scene.floor = false;
  scene.caption.left.push_back(title);
  Box3 box;
  for (std::size_t step = 0; step < steps.size(); ++step) {
    if (triangles[step].empty()) continue;
    TriangleMesh part = part_of(mesh, triangles[step]);
    const auto& color = steps[step].color;
    scene.legend.push_back({steps[step].text, {color[0], color[1], color[2]}});
    box.extend(bounds(part));
    scene.bodies.push_back({.name = "map",
                            .mesh = std::make_shared<TriangleMesh>(std::move(part)),
                            .color = {color[0], color[1], color[2]}});
  }
  auto camera = render::camera_by_name("iso", box, static_cast<double>(size.width) / size.height);
  if (!camera) return unexpected(camera.error());
  camera->eye = camera->target + (camera->eye - camera->target).cwiseProduct(corner);
  return renderer->draw(scene, *camera);
}

// The triangles whose vertices are, in the mean, in a step.
Expected<render::Image> deviation_picture(const TriangleMesh& mesh,
                                          const std::vector<double>& outside,
                                          const DeviationScale& scale, render::FrameSize size) {
  std::vector<MapColor> steps;
  for (int step = 0; step < DeviationScale::steps; ++step)
    steps.push_back({DeviationScale::color_of(step), scale.text_of(step)});
  std::vector<int> step_of;
  for (const auto& t : mesh.triangles)
    step_of.push_back(scale.step_of((outside[t[0]] + outside[t[1]] + outside[t[2]]) / 3));
  return map_picture(mesh, step_of, steps, "deviation from the part, mm (below 0: into it)", size);
}

}  // namespace aircut::report
