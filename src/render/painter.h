// Draws one tile of a stage: shadow map, half-resolution lighting, the lit picture.
#pragma once

#include "render/programs.h"
#include "render/stage.h"
#include "render/targets.h"

namespace aircut::render {

class Painter {
 public:
  Painter(const Gl& gl, const Programs& programs, const Targets& targets)
      : gl_(&gl), programs_(&programs), targets_(&targets) {}

  /// Once per picture; the map serves all tiles.
  void draw_shadow_map(const Stage& stage) const;
  /// One tile into targets.resolved. `line_scale` is the width of a fine line in pixels.
  void draw_tile(const Stage& stage, const Scene& scene, const Tile& tile, double line_scale) const;
  /// Numbers of bodies (index + 1 as RGB) into targets.id; the second call adds nothing to what the
  /// first one drew but keeps its depth.
  void draw_ids(const Stage& stage, const Tile& tile, bool translucent) const;

 private:
  struct Frame;
  void draw_light(const Frame& frame) const;
  void draw_backdrop(const Frame& frame) const;
  void draw_floor(const Frame& frame) const;
  void draw_solids(const Frame& frame) const;
  void draw_edges(const Frame& frame) const;
  void draw_paths(const Frame& frame) const;
  void draw_translucent(const Frame& frame) const;
  void draw_xray(const Frame& frame) const;
  void draw_item_edges(const Frame& frame, const StageItem& item) const;
  void set_body_program(const Frame& frame, const Program& program) const;
  void set_material(const StageItem& item, const Frame& frame) const;
  void set_line_program(const Frame& frame, double width, double lift, double opacity) const;
  void cull(const GpuMesh& mesh) const;
  void screen_triangle() const;

  const Gl* gl_;
  const Programs* programs_;
  const Targets* targets_;
};

}  // namespace aircut::render
