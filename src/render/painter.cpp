// The order of one tile:
//
//   shadow map ─┐
//   geometry ───┴─► light ─► smoothed ─┐            (half resolution)
//   solid bodies, floor, backdrop ◄────┘ ─► edges ─► paths ─► translucent bodies ─► x-ray
//
// The lighting pass is done in half resolution because occlusion and penumbras are smooth; the full
// picture picks the neighbours that lie at its own depth.
#include <algorithm>

#include "render/painter_frame.h"

namespace aircut::render {
Eigen::Vector4d plane_of(const StageItem& item, const Stage& stage) {
  return item.model.transpose() * stage.section.value_or(Eigen::Vector4d::Zero());
}

// Back faces of a closed body that is cut open: they stand for the face of the cut. Where another
// body begins right behind them, they come first.
void Painter::draw_inside(const StageItem& item, const Program& program) const {
  program.set("cut_on", 1.0);
  gl_->Enable(GL_POLYGON_OFFSET_FILL);
  gl_->PolygonOffset(-1.0f, -4.0f);
  gl_->CullFace(GL_FRONT);
  item.mesh->draw_triangles();
  gl_->CullFace(GL_BACK);
  gl_->PolygonOffset(1.0f, 1.0f);
  program.set("cut_on", 0.0);
}

void Painter::cull(const GpuMesh& mesh) const {
  if (mesh.shape().closed)
    gl_->Enable(GL_CULL_FACE);
  else
    gl_->Disable(GL_CULL_FACE);
  gl_->CullFace(GL_BACK);
}

// Bodies drawn from here on lose what lies before the plane of the section.
void Painter::start_cut(const Stage& stage) const {
  if (stage.section) gl_->Enable(GL_CLIP_DISTANCE0);
}

void Painter::end_cut() const { gl_->Disable(GL_CLIP_DISTANCE0); }

void Painter::screen_triangle() const {
  gl_->Disable(GL_CULL_FACE);
  gl_->BindVertexArray(targets_->no_vertices.get());
  gl_->DrawArrays(GL_TRIANGLES, 0, 3);
}

void Painter::floor_square() const {
  gl_->Disable(GL_CULL_FACE);
  gl_->BindVertexArray(targets_->no_vertices.get());
  gl_->DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

void Painter::draw_shadow_map(const Stage& stage) const {
  const Gl& gl = *gl_;
  gl.BindFramebuffer(GL_FRAMEBUFFER, targets_->shadow.get());
  gl.Viewport(0, 0, shadow_side, shadow_side);
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthFunc(GL_LESS);
  gl.DepthMask(GL_TRUE);
  gl.Disable(GL_BLEND);
  gl.Disable(GL_STENCIL_TEST);
  gl.Clear(GL_DEPTH_BUFFER_BIT);
  draw_small_shadows(stage);
  gl.Enable(GL_POLYGON_OFFSET_FILL);
  gl.PolygonOffset(1.5f, 2.0f);
  programs_->depth.use();
  start_cut(stage);
  for (const StageItem& item : stage.items) {
    if (item.body->translucent || item.small) continue;
    programs_->depth.set("transform", Eigen::Matrix4d(stage.world_to_shadow * item.model));
    cull(*item.mesh);
    if (stage.section) {
      // The inside of what is cut open stops the light as the face of the cut would.
      programs_->depth.set("section", plane_of(item, stage));
      gl.Disable(GL_CULL_FACE);
    }
    item.mesh->draw_triangles();
  }
  end_cut();
  gl.Disable(GL_POLYGON_OFFSET_FILL);
}

void Painter::draw_light(const Frame& frame) const {
  const Gl& gl = *gl_;
  const Stage& stage = frame.stage;
  gl.BindFramebuffer(GL_FRAMEBUFFER, targets_->geometry.framebuffer.get());
  gl.Viewport(0, 0, targets_->half_width, targets_->half_height);
  gl.ClearColor(0, 0, 0, 0);
  gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  draw_small_geometry(frame);
  set_body_program(frame, programs_->geometry);
  start_cut(stage);
  for (const StageItem& item : stage.items) {
    if (item.body->translucent || item.small || !in_view(item.box, frame.to_clip)) continue;
    programs_->geometry.set("model", item.model);
    cull(*item.mesh);
    item.mesh->draw_triangles();
    if (stage.section && item.mesh->shape().closed) draw_inside(item, programs_->geometry);
  }
  end_cut();
  gl.Disable(GL_POLYGON_OFFSET_FILL);
  if (stage.floor) {
    set_body_program(frame, programs_->floor_geometry);
    const Vec3 c = stage.solid.center();
    programs_->floor_geometry.set(
        "square", Eigen::Vector4d(c.x(), c.y(), stage.floor->height, stage.floor->extent));
    floor_square();
  }

  gl.Disable(GL_DEPTH_TEST);
  gl.ActiveTexture(GL_TEXTURE1);
  gl.BindTexture(GL_TEXTURE_2D, targets_->shadow_map.get());
  gl.ActiveTexture(GL_TEXTURE0);
  gl.BindTexture(GL_TEXTURE_2D, targets_->geometry.color.get());
  const Program& light = programs_->light;
  gl.BindFramebuffer(GL_FRAMEBUFFER, targets_->light.framebuffer.get());
  light.use();
  light.set("geometry", 0);
  light.set("shadow_map", 1);
  light.set("unproject", frame.unproject);
  light.set("parallel", frame.parallel());
  light.set("camera_to_world", Eigen::Matrix4d(frame.view().view.inverse()));
  Eigen::Matrix4d to_unit = Eigen::Matrix4d::Identity() * 0.5;
  to_unit.col(3) = Eigen::Vector4d(0.5, 0.5, 0.5, 1);
  light.set("to_shadow", Eigen::Matrix4d(to_unit * stage.world_to_shadow));
  light.set("key", stage.lamps.key);
  const double diagonal = stage.diagonal;
  const double across = frame.view().mm_per_pixel * frame.view().height;
  light.set("radius", std::min(0.07 * diagonal, 0.14 * across));
  light.set("pixels_per_mm", frame.half_pixels_per_mm(targets_->half_height));
  light.set("shadow_size", stage.shadow_size);
  light.set("shadow_depth", stage.shadow_depth);
  light.set("lamp_slope", 0.075);
  screen_triangle();

  const Program& smooth = programs_->smooth;
  smooth.use();
  smooth.set("geometry", 0);
  smooth.set("light", 1);
  smooth.set("unproject", frame.unproject);
  smooth.set("parallel", frame.parallel());
  smooth.set("tolerance", 2 / frame.half_pixels_per_mm(targets_->half_height));
  gl.ActiveTexture(GL_TEXTURE1);
  gl.BindFramebuffer(GL_FRAMEBUFFER, targets_->smoothed.framebuffer.get());
  gl.BindTexture(GL_TEXTURE_2D, targets_->light.color.get());
  smooth.set("along", Eigen::Vector2i(1, 0));
  screen_triangle();
  gl.BindFramebuffer(GL_FRAMEBUFFER, targets_->light.framebuffer.get());
  gl.BindTexture(GL_TEXTURE_2D, targets_->smoothed.color.get());
  smooth.set("along", Eigen::Vector2i(0, 1));
  screen_triangle();
  gl.BindTexture(GL_TEXTURE_2D, 0);
  gl.ActiveTexture(GL_TEXTURE0);
  gl.BindTexture(GL_TEXTURE_2D, targets_->light.color.get());
}

void Painter::set_body_program(const Frame& frame, const Program& program) const {
  const View& view = frame.view();
  program.use();
  program.set("view", view.view);
  program.set("projection", frame.projection);
  program.set("eye", view.eye);
  program.set("back", Vec3(view.axes.row(2)));
  program.set("parallel", frame.parallel());
  program.set("key", frame.stage.lamps.key);
  program.set("fill", frame.stage.lamps.fill);
  program.set("rim", frame.stage.lamps.rim);
  program.set("right", frame.stage.lamps.right);
  program.set("ahead", frame.stage.lamps.ahead);
  program.set("light", 0);
  const Eigen::Vector4d section = frame.stage.section.value_or(Eigen::Vector4d::Zero());
  program.set("section", section);
  program.set("cut", section);
  program.set("cut_on", 0.0);
  program.set("target", Vec3(view.eye - view.axes.row(2).transpose() * view.distance));
  program.set("studio_bend", 0.55 / (view.mm_per_pixel * view.height));
}

void Painter::draw_tile(const Stage& stage, const Scene& scene, const Tile& tile,
                        double line_scale) const {
  const Gl& gl = *gl_;
  Frame frame{stage, scene, tile, line_scale, tile_projection(stage.view, tile), {}, {}, {}, {}};
  frame.to_clip = frame.projection * stage.view.view;
  const Eigen::Matrix4d& Q = frame.projection;
  // clip = Q·camera, so camera = (ndc + offset) · scale, times the depth in a perspective view.
  const Eigen::Vector2d offset = stage.view.orthographic ? Eigen::Vector2d(-Q(0, 3), -Q(1, 3))
                                                         : Eigen::Vector2d(Q(0, 2), Q(1, 2));
  frame.unproject = Eigen::Vector4d(1 / Q(0, 0), 1 / Q(1, 1), offset.x(), offset.y());
  int alarms = 0;
  for (const DrawBody& body : scene.bodies)
    frame.alarm_number.push_back(body.highlight ? alarms++ : -1);

  gl.Enable(GL_DEPTH_TEST);
  gl.DepthFunc(GL_LEQUAL);
  gl.DepthMask(GL_TRUE);
  gl.Disable(GL_BLEND);
  gl.Disable(GL_STENCIL_TEST);
  gl.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  prepare_small(frame);
  draw_light(frame);

  gl.BindFramebuffer(GL_FRAMEBUFFER, targets_->multisampled.get());
  gl.Viewport(0, 0, targets_->width, targets_->height);
  gl.Enable(GL_DEPTH_TEST);
  gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  draw_small(frame);
  draw_solids(frame);
  draw_ground(frame);
  draw_edges(frame);
  draw_paths(frame);
  draw_translucent(frame);
  draw_xray(frame);

  gl.BindFramebuffer(GL_READ_FRAMEBUFFER, targets_->multisampled.get());
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, targets_->resolved.get());
  gl.BlitFramebuffer(0, 0, targets_->width, targets_->height, 0, 0, targets_->width,
                     targets_->height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  gl.BindFramebuffer(GL_FRAMEBUFFER, targets_->resolved.get());
}

void Painter::start_ids(const Tile& tile) const {
  const Gl& gl = *gl_;
  gl.BindFramebuffer(GL_FRAMEBUFFER, targets_->id.get());
  gl.Viewport(0, 0, tile.width, tile.height);
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthFunc(GL_LEQUAL);
  gl.DepthMask(GL_TRUE);
  gl.Disable(GL_BLEND);
  gl.Disable(GL_STENCIL_TEST);
  programs_->id.use();
}

void Painter::clear_ids(const Tile& tile, bool keep_depth) const {
  start_ids(tile);
  gl_->ClearColor(0, 0, 0, 0);
  gl_->Clear(keep_depth ? GL_COLOR_BUFFER_BIT : GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

void Painter::draw_id(const Stage& stage, const StageItem& item,
                      const Eigen::Matrix4d& to_clip) const {
  if (!in_view(item.box, to_clip)) return;
  const unsigned id = static_cast<unsigned>(item.index) + 1;
  const Eigen::Vector4d bytes(id & 0xFFu, (id >> 8) & 0xFFu, (id >> 16) & 0xFFu, 255);
  programs_->id.set("transform", Eigen::Matrix4d(to_clip * item.model));
  programs_->id.set("id", Eigen::Vector4d(bytes / 255.0));
  cull(*item.mesh);
  if (stage.section) {
    programs_->id.set("section", plane_of(item, stage));
    gl_->Disable(GL_CULL_FACE);
  }
  start_cut(stage);
  item.mesh->draw_triangles();
  end_cut();
}

}  // namespace aircut::render
