// The error that was predicted for each place of the part, as colours.
#pragma once

#include <optional>

#include "report/deviation.h"

namespace aircut::report {

/// Even steps of a round width from the least to the largest error.
class ErrorScale {
 public:
  /// Errors in mm, by triangle; nothing where none is predicted.
  explicit ErrorScale(const std::vector<std::optional<double>>& errors);

  /// The steps and, last, the colour of what is not predicted.
  const std::vector<MapColor>& steps() const { return steps_; }
  int step_of(const std::optional<double>& error) const;

 private:
  double first_ = 0, width_ = 1;  // µm: of the lowest step
  std::vector<MapColor> steps_;
};

/// Picture of the errors, µm, with a legend.
Expected<render::Image> error_picture(const TriangleMesh& mesh,
                                      const std::vector<std::optional<double>>& errors,
                                      render::FrameSize size);
/// Binary PLY, mm: three vertices of its own for each triangle, with the error in µm as `quality`
/// (not a number where none is predicted) and its colour.
std::string error_ply(const TriangleMesh& mesh, const std::vector<std::optional<double>>& errors);

}  // namespace aircut::report
