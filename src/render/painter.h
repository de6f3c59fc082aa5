// Draws one tile of a stage: shadow map, half-resolution lighting, the lit picture.
#pragma once

#include "render/programs.h"
#include "render/stage.h"
#include "render/targets.h"

namespace aircut::render {

class SmallTriangles;

class Painter {
 public:
  Painter(const Gl& gl, const Programs& programs, const Targets& targets, SmallTriangles& small)
      : gl_(&gl), programs_(&programs), targets_(&targets), small_(&small) {}

  /// Once per picture; the map serves all tiles.
  void draw_shadow_map(const Stage& stage) const;
  /// One tile into targets.resolved. `line_scale` is the width of a fine line in pixels.
  void draw_tile(const Stage& stage, const Scene& scene, const Tile& tile, double line_scale) const;
  /// Empties targets.id for a tile: numbers, and depth too unless it is to stay.
  void clear_ids(const Tile& tile, bool keep_depth) const;
  /// Numbers of bodies (index + 1 as RGB) of those items that `wanted` picks.
  template <class Wanted>
  void draw_ids(const Stage& stage, const Tile& tile, const Wanted& wanted) const {
    start_ids(tile);
    const Eigen::Matrix4d to_clip = tile_projection(stage.view, tile) * stage.view.view;
    for (const StageItem& item : stage.items)
      if (wanted(*item.body)) draw_id(stage, item, to_clip);
  }

 private:
  struct Frame;
  void start_ids(const Tile& tile) const;
  void draw_id(const Stage& stage, const StageItem& item, const Eigen::Matrix4d& to_clip) const;
  void draw_light(const Frame& frame) const;
  bool draw_small_shadows(const Stage& stage) const;
  void prepare_small(Frame& frame) const;
  void draw_small_rect(const Frame& frame, const Program& program, int shrink) const;
  void draw_small_geometry(const Frame& frame) const;
  void draw_small(const Frame& frame) const;
  void draw_ground(const Frame& frame) const;
  void draw_cut_depth(const Frame& frame) const;
  void start_cut(const Stage& stage) const;
  void end_cut() const;
  void draw_inside(const StageItem& item, const Program& program) const;
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
  void floor_square() const;

  const Gl* gl_;
  const Programs* programs_;
  const Targets* targets_;
  SmallTriangles* small_;
};

}  // namespace aircut::render
