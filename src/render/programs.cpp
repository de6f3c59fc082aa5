#include "render/programs.h"

#include <array>

#include "render/shaders.h"

namespace aircut::render {

Expected<Programs> link_programs(const Gl& gl) {
  namespace s = shaders;
  struct Row {
    Program Programs::*program;
    const char* vertex;
    const char* fragment;
    std::vector<const char*> shared = {};  // functions that the fragment shader calls
  };
  const std::array<Row, 14> rows = {{
      {&Programs::body,
       s::body_vertex,
       s::body_fragment,
       {s::parallel_view, s::gather_light, s::surface, s::cut_face}},
      {&Programs::geometry, s::body_vertex, s::geometry_fragment, {s::parallel_view, s::cut_face}},
      {&Programs::cut_depth,
       s::screen_vertex,
       s::cut_depth_fragment,
       {s::parallel_view, s::depth_of}},
      {&Programs::depth, s::depth_vertex, s::depth_fragment},
      {&Programs::id, s::depth_vertex, s::id_fragment},
      {&Programs::light, s::screen_vertex, s::light_fragment, {s::parallel_view, s::half_position}},
      {&Programs::smooth,
       s::screen_vertex,
       s::smooth_fragment,
       {s::parallel_view, s::half_position}},
      {&Programs::background, s::screen_vertex, s::background_fragment, {s::backdrop}},
      {&Programs::floor, s::floor_vertex, s::floor_fragment, {s::gather_light, s::backdrop}},
      {&Programs::small,
       s::screen_vertex,
       s::small_fragment,
       {s::parallel_view, s::depth_of, s::small_texel, s::gather_light, s::surface}},
      {&Programs::small_geometry,
       s::screen_vertex,
       s::small_geometry_fragment,
       {s::parallel_view, s::depth_of, s::small_texel}},
      {&Programs::floor_geometry, s::floor_vertex, s::floor_geometry_fragment},
      {&Programs::xray, s::body_vertex, s::xray_fragment},
      {&Programs::line, s::line_vertex, s::line_fragment},
  }};
  Programs out;
  for (const Row& row : rows) {
    std::string fragment = s::version;
    for (const char* part : row.shared) fragment += part;
    auto program = Program::link(gl, std::string(s::version) + row.vertex, fragment + row.fragment);
    if (!program) return unexpected(program.error());
    out.*row.program = std::move(*program);
  }
  return out;
}

}  // namespace aircut::render
