#pragma once

#include "render/gl.h"

namespace aircut::render {

/// All shader programs, linked once per renderer.
struct Programs {
  Program body, geometry, depth, id, light, smooth, background, floor, floor_geometry, xray, line;
  Program small, small_geometry, cut_depth;
};

Expected<Programs> link_programs(const Gl& gl);

}  // namespace aircut::render
