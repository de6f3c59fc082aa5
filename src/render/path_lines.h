// Tool path lines as line instances: dashes, colours by kind.
#pragma once

#include <array>
#include <vector>

#include "render/gpu_mesh.h"
#include "render/render.h"

namespace aircut::render {

/// Display colour of a kind of line.
std::array<float, 3> path_colour(LineKind kind);
std::array<float, 3> path_colour(const DrawLine& line);
/// All lines of a scene in the render frame (world minus `centre`); rapids are dashed with a period
/// that fits `mm_per_pixel`.
std::vector<LineVertex> path_lines(const std::vector<DrawLine>& lines, const Vec3& centre,
                                   double mm_per_pixel);

}  // namespace aircut::render
