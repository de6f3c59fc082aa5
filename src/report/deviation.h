// The result of a run against the design: colours of the deviation, and a picture.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "render/render.h"
#include "sim/sim.h"

namespace aircut::report {

/// Green within the tolerances; yellow to red the deeper into the part, blue the more is left.
class DeviationScale {
 public:
  explicit DeviationScale(const sim::Summary::Part& part);

  /// Steps from the deepest gouge to the largest excess.
  static constexpr int steps = 9;
  /// The step of a deviation (mm, negative inside of the part).
  int step_of(double outside) const;
  static std::array<std::uint8_t, 3> color_of(int step);
  /// What a step means, mm.
  std::string text_of(int step) const;
  std::vector<std::array<std::uint8_t, 3>> colors(const std::vector<double>& outside) const;

 private:
  std::array<double, steps - 1> borders_{};  ///< between the steps, mm, ascending
};

/// Binary PLY, mm, with a value `quality` and a colour (red, green, blue) for each vertex.
std::string ply_bytes(const TriangleMesh& mesh, std::span<const double> quality,
                      std::span<const std::array<std::uint8_t, 3>> colors);

/// A colour of a map, and what it means.
struct MapColor {
  std::array<std::uint8_t, 3> color{};
  std::string text;
};
/// The mesh with a legend, steps from the first; `step_of` has a place of `steps` for each
/// triangle.
Expected<render::Image> map_picture(const TriangleMesh& mesh, const std::vector<int>& step_of,
                                    const std::vector<MapColor>& steps, const std::string& title,
                                    render::FrameSize size, const Vec3& corner = Vec3::Ones());

/// The mesh in these colours, with a legend; `outside` has a value for each vertex.
Expected<render::Image> deviation_picture(const TriangleMesh& mesh,
                                          const std::vector<double>& outside,
                                          const DeviationScale& scale, render::FrameSize size);

}  // namespace aircut::report
