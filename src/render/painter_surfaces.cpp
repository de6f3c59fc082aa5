// Backdrop, floor and the surfaces of bodies.
#include <algorithm>

#include "render/painter_frame.h"

namespace aircut::render {
namespace {

Vec3 to_linear(const Vec3& display) { return display.array().pow(2.2).matrix(); }

}  // namespace

// Grey means bare metal, colour means paint: machine files give no more than a colour.
Material material_of(const machine::Color& color) {
  const Vec3 c = display_colour(color);
  const double saturation = c.maxCoeff() > 0 ? (c.maxCoeff() - c.minCoeff()) / c.maxCoeff() : 0.0;
  Material out;
  out.base = to_linear(c);
  // Nearly white and nearly black are paint too.
  out.metal = std::clamp(1.3 - 6 * saturation, 0.0, 1.0) *
              std::clamp((c.maxCoeff() - 0.30) / 0.2, 0.0, 1.0) *
              std::clamp((0.875 - c.maxCoeff()) / 0.05, 0.0, 1.0);
  out.roughness = 0.46 - 0.12 * out.metal;
  return out;
}

// Fills what no body covers: the floor, and the backdrop beside it.
void Painter::draw_ground(const Frame& frame) const {
  const double w = frame.view().width, h = frame.view().height;
  const Eigen::Vector4d whole(1 / w, 1 / h, frame.tile.x / w, frame.tile.y / h);
  if (frame.stage.floor) {
    const Floor& floor = *frame.stage.floor;
    const Program& program = programs_->floor;
    set_body_program(frame, program);
    const Vec3 c = frame.stage.solid.center();
    program.set("frame", whole);
    program.set("square", Eigen::Vector4d(c.x(), c.y(), floor.height, floor.extent));
    // Lines pass through the world's origin.
    program.set("grid", Vec3(-frame.view().centre.x(), -frame.view().centre.y(), floor.step));
    program.set("fade", floor.extent * 0.75);
    program.set("pixel", frame.line_scale);
    floor_square();
  }
  programs_->background.use();
  programs_->background.set("frame", whole);
  gl_->DepthMask(GL_FALSE);
  screen_triangle();
  gl_->DepthMask(GL_TRUE);
}

void Painter::set_material(const StageItem& item, const Frame& frame) const {
  const Program& program = programs_->body;
  Material material = material_of(item.body->color);
  if (item.body->highlight) {
    material.base =
        to_linear(alarm_colour(frame.alarm_number[static_cast<std::size_t>(item.index)]));
    material.metal = 0;
    material.roughness = 0.5;
  }
  program.set("model", item.model);
  program.set("base", material.base);
  program.set("metal", material.metal);
  program.set("roughness", material.roughness);
}

void Painter::draw_solids(const Frame& frame) const {
  const Gl& gl = *gl_;
  set_body_program(frame, programs_->body);
  programs_->body.set("use_light", 1.0);
  programs_->body.set("opacity", 1.0);
  gl.Enable(GL_POLYGON_OFFSET_FILL);
  gl.PolygonOffset(1.0f, 1.0f);
  gl.Enable(GL_STENCIL_TEST);
  gl.StencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
  start_cut(frame.stage);
  for (const StageItem& item : frame.stage.items) {
    if (item.body->translucent || item.small || !in_view(item.box, frame.to_clip)) continue;
    gl.StencilFunc(GL_ALWAYS, item.body->highlight ? seen : 0, 0xFF);
    set_material(item, frame);
    cull(*item.mesh);
    item.mesh->draw_triangles();
    if (!frame.stage.section || !item.mesh->shape().closed) continue;
    gl.StencilFunc(GL_ALWAYS, (item.body->highlight ? seen : 0) | cut_face, 0xFF);
    draw_inside(item, programs_->body);
  }
  end_cut();
  draw_cut_depth(frame);
  gl.Disable(GL_STENCIL_TEST);
  gl.Disable(GL_POLYGON_OFFSET_FILL);
}

// What stood for the face of a cut lay behind it: brings the depth forward, so that lines of the
// body's far side don't show upon it.
void Painter::draw_cut_depth(const Frame& frame) const {
  if (!frame.stage.section) return;
  const Gl& gl = *gl_;
  const Program& program = programs_->cut_depth;
  set_body_program(frame, program);
  program.set("depth_terms", depth_terms(frame.view()));
  program.set("picture", Eigen::Vector2d(targets_->width, targets_->height));
  program.set("unproject", frame.unproject);
  program.set("camera_to_world", Eigen::Matrix4d(frame.view().view.inverse()));
  gl.StencilFunc(GL_EQUAL, cut_face, cut_face);
  gl.StencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  gl.DepthFunc(GL_ALWAYS);
  gl.ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  screen_triangle();
  gl.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  gl.DepthFunc(GL_LEQUAL);
}

void Painter::draw_translucent(const Frame& frame) const {
  const Gl& gl = *gl_;
  const auto& items = frame.stage.items;
  for (auto it = items.rbegin(); it != items.rend(); ++it) {
    if (!it->body->translucent) continue;
    set_body_program(frame, programs_->body);
    programs_->body.set("use_light", 0.0);
    programs_->body.set("opacity", it->body->highlight ? 0.45 : 0.16);
    set_material(*it, frame);
    gl.Enable(GL_BLEND);
    gl.DepthMask(GL_FALSE);
    gl.Enable(GL_CULL_FACE);
    start_cut(frame.stage);
    gl.CullFace(GL_FRONT);
    it->mesh->draw_triangles();
    gl.CullFace(GL_BACK);
    it->mesh->draw_triangles();
    end_cut();
    set_line_program(frame, 1.0, edge_lift, 1);
    draw_item_edges(frame, *it);
  }
  gl.DepthMask(GL_TRUE);
  gl.Disable(GL_BLEND);
}

}  // namespace aircut::render
