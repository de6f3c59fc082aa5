// The order of one tile:
//
//   shadow map ─┐
//   geometry ───┴─► light ─► smoothed ─┐            (half resolution)
//   backdrop, floor, solid bodies ◄────┘ ─► edges ─► paths ─► translucent bodies ─► x-ray
//
// The lighting pass is done in half resolution because occlusion and penumbras are smooth; the full
// picture picks the neighbours that lie at its own depth.
#include "render/painter.h"

#include <algorithm>
#include <cmath>

#include "render/path_lines.h"

namespace aircut::render {
namespace {

constexpr double edge_lift = 5e-4;  // of the distance to the eye
constexpr double path_lift = 1.2e-3;
// Stencil values: a body in alarm is seen here, or it is behind something and shown through it.
constexpr int seen = 2, covered = 1;

Vec3 to_linear(const Vec3& display) { return display.array().pow(2.2).matrix(); }

Vec3 display_colour(const machine::Color& c) { return Vec3(c.r, c.g, c.b) / 255.0; }

// Two bodies that touch are told apart by their shade of red.
Vec3 alarm_colour(int number) {
  return number % 2 == 0 ? Vec3(0.86, 0.07, 0.07) : Vec3(0.96, 0.36, 0.12);
}

struct Material {
  Vec3 base;  // linear
  double metal = 0, roughness = 0.5;
};

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

}  // namespace

struct Painter::Frame {
  const Stage& stage;
  const Scene& scene;
  Tile tile;
  double line_scale;
  Eigen::Matrix4d projection;  // camera to clip space of the tile
  Eigen::Vector4d unproject;
  Eigen::Matrix4d to_clip;        // render frame to clip space of the tile
  std::vector<int> alarm_number;  // per body of the scene: its number among those in alarm, or -1

  const View& view() const { return stage.view; }
  double parallel() const { return stage.view.orthographic ? 1 : 0; }
  // Pixels of the half-resolution picture per mm, at depth 1 or everywhere.
  double half_pixels_per_mm(int half_height) const { return projection(1, 1) * half_height / 2; }
};

void Painter::cull(const GpuMesh& mesh) const {
  if (mesh.shape().closed)
    gl_->Enable(GL_CULL_FACE);
  else
    gl_->Disable(GL_CULL_FACE);
  gl_->CullFace(GL_BACK);
}

void Painter::screen_triangle() const {
  gl_->Disable(GL_CULL_FACE);
  gl_->DrawArrays(GL_TRIANGLES, 0, 3);
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
  gl.Disable(GL_CULL_FACE);
  gl.Clear(GL_DEPTH_BUFFER_BIT);
  gl.Enable(GL_POLYGON_OFFSET_FILL);
  gl.PolygonOffset(1.5f, 2.0f);
  programs_->depth.use();
  for (const StageItem& item : stage.items) {
    if (item.body->translucent) continue;
    programs_->depth.set("transform", Eigen::Matrix4d(stage.world_to_shadow * item.model));
    item.mesh->draw_triangles();
  }
  gl.Disable(GL_POLYGON_OFFSET_FILL);
}

void Painter::draw_light(const Frame& frame) const {
  const Gl& gl = *gl_;
  const Stage& stage = frame.stage;
  gl.BindFramebuffer(GL_FRAMEBUFFER, targets_->geometry.framebuffer.get());
  gl.Viewport(0, 0, targets_->half_width, targets_->half_height);
  gl.ClearColor(0, 0, 0, 0);
  gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  set_body_program(frame, programs_->geometry);
  for (const StageItem& item : stage.items) {
    if (item.body->translucent || !in_view(item.box, frame.to_clip)) continue;
    programs_->geometry.set("model", item.model);
    cull(*item.mesh);
    item.mesh->draw_triangles();
  }
  if (stage.floor) {
    set_body_program(frame, programs_->floor_geometry);
    const Vec3 c = stage.solid.center();
    programs_->floor_geometry.set(
        "square", Eigen::Vector4d(c.x(), c.y(), stage.floor->height, stage.floor->extent));
    gl.Disable(GL_CULL_FACE);
    gl.DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
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
  const double diagonal = stage.shadow_size;
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
  smooth.set("tolerance", 3 / frame.half_pixels_per_mm(targets_->half_height));
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
  program.set("target", Vec3(view.eye - view.axes.row(2).transpose() * view.distance));
  program.set("studio_bend", 0.55 / (view.mm_per_pixel * view.height));
}

void Painter::draw_backdrop(const Frame& frame) const {
  const Program& program = programs_->background;
  program.use();
  const double w = frame.view().width, h = frame.view().height;
  program.set("frame", Eigen::Vector4d(1 / w, 1 / h, frame.tile.x / w, frame.tile.y / h));
  gl_->Disable(GL_DEPTH_TEST);
  screen_triangle();
  gl_->Enable(GL_DEPTH_TEST);
}

void Painter::draw_floor(const Frame& frame) const {
  if (!frame.stage.floor) return;
  const Floor& floor = *frame.stage.floor;
  const Program& program = programs_->floor;
  set_body_program(frame, program);
  const Vec3 c = frame.stage.solid.center();
  program.set("square", Eigen::Vector4d(c.x(), c.y(), floor.height, floor.extent));
  // Lines pass through the world's origin.
  program.set("grid", Vec3(-frame.view().centre.x(), -frame.view().centre.y(), floor.step));
  program.set("fade", floor.extent * 0.75);
  program.set("pixel", frame.line_scale);
  gl_->Disable(GL_CULL_FACE);
  gl_->Enable(GL_BLEND);
  gl_->DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  gl_->Disable(GL_BLEND);
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
  for (const StageItem& item : frame.stage.items) {
    if (item.body->translucent || !in_view(item.box, frame.to_clip)) continue;
    gl.StencilFunc(GL_ALWAYS, item.body->highlight ? seen : 0, 0xFF);
    set_material(item, frame);
    cull(*item.mesh);
    item.mesh->draw_triangles();
  }
  gl.Disable(GL_STENCIL_TEST);
  gl.Disable(GL_POLYGON_OFFSET_FILL);
}

void Painter::set_line_program(const Frame& frame, double width, double lift,
                               double opacity) const {
  const Program& line = programs_->line;
  line.use();
  line.set("model_view", frame.view().view);
  line.set("projection", frame.projection);
  line.set("viewport", Eigen::Vector2d(frame.tile.width, frame.tile.height));
  line.set("width", width * frame.line_scale);
  line.set("lift", lift);
  line.set("parallel", frame.parallel());
  // Depth of the near plane, from the projection's own coefficients.
  const Eigen::Matrix4d& P = frame.view().projection;
  line.set("near", frame.view().orthographic ? 0.0 : P(2, 3) / (P(2, 2) - 1));
  line.set("fade_below", 0.0);
  line.set("opacity", opacity);
  gl_->Disable(GL_CULL_FACE);
  gl_->Enable(GL_BLEND);
  gl_->DepthMask(GL_FALSE);
}

namespace {

// Edges of a round body where it turns away from the eye: one triangle is seen from the front, the
// other from behind. `creases` also gives the creases that are turned to the eye.
std::vector<LineVertex> outline(const StageItem& item, const View& view, std::array<float, 4> ink,
                                bool creases) {
  const Mat3 R = item.model.topLeftCorner<3, 3>();
  const Vec3 t = item.model.topRightCorner<3, 1>();
  const Eigen::Vector3f eye = (R.transpose() * (view.eye - t)).cast<float>();
  const Eigen::Vector3f back = (R.transpose() * Vec3(view.axes.row(2))).cast<float>();
  std::vector<LineVertex> out;
  for (const DrawEdge& edge : item.mesh->shape().edges) {
    if (edge.crease && !creases) continue;
    const Eigen::Vector3f a(edge.a.data());
    const Eigen::Vector3f v = view.orthographic ? back : Eigen::Vector3f(eye - a);
    const float s1 = Eigen::Vector3f(edge.normal_1.data()).dot(v);
    const float s2 = Eigen::Vector3f(edge.normal_2.data()).dot(v);
    if (edge.crease ? (s1 > 0 || s2 > 0) : (s1 > 0) != (s2 > 0))
      out.push_back({edge.a, edge.b, ink});
  }
  return out;
}

std::array<float, 4> edge_ink(const Vec3& display, double opacity) {
  const Eigen::Vector3f c = (display * 0.22 + Vec3(0.03, 0.035, 0.05)).cast<float>();
  return {c.x(), c.y(), c.z(), static_cast<float>(opacity)};
}

}  // namespace

void Painter::draw_item_edges(const Frame& frame, const StageItem& item) const {
  const bool alarm = item.body->highlight;
  const Vec3 colour = alarm ? alarm_colour(frame.alarm_number[static_cast<std::size_t>(item.index)])
                            : display_colour(item.body->color);
  const double opacity = item.body->translucent ? 0.45 : 0.70;
  const std::array<float, 4> ink = edge_ink(colour, opacity);
  const Program& line = programs_->line;
  line.set("model_view", Eigen::Matrix4d(frame.view().view * item.model));
  line.set("fade_below", 3.5 * frame.line_scale);
  gl_->VertexAttrib4f(2, ink[0], ink[1], ink[2], ink[3]);
  item.mesh->draw_creases();
  line.set("fade_below", 0.0);
  LineBatch(*gl_, outline(item, frame.view(), ink, false)).draw();
}

void Painter::draw_edges(const Frame& frame) const {
  set_line_program(frame, 0.95, edge_lift, 1);
  for (const StageItem& item : frame.stage.items)
    if (!item.body->translucent && in_view(item.box, frame.to_clip)) draw_item_edges(frame, item);
  gl_->DepthMask(GL_TRUE);
  gl_->Disable(GL_BLEND);
}

void Painter::draw_paths(const Frame& frame) const {
  auto lines = path_lines(frame.scene.lines, frame.view().centre, frame.view().mm_per_pixel);
  if (lines.empty()) return;
  const LineBatch batch(*gl_, lines);
  for (LineVertex& line : lines) line.ink = {1, 1, 1, 0.55f};
  const LineBatch halo(*gl_, lines);
  set_line_program(frame, 3.6, path_lift, 1);
  halo.draw();
  set_line_program(frame, 1.9, path_lift, 1);
  batch.draw();
  // What bodies cover stays as a hint.
  gl_->DepthFunc(GL_GREATER);
  set_line_program(frame, 1.4, path_lift, 0.26);
  batch.draw();
  gl_->DepthFunc(GL_LEQUAL);
  gl_->DepthMask(GL_TRUE);
  gl_->Disable(GL_BLEND);
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
    gl.CullFace(GL_FRONT);
    it->mesh->draw_triangles();
    gl.CullFace(GL_BACK);
    it->mesh->draw_triangles();
    set_line_program(frame, 1.0, edge_lift, 1);
    draw_item_edges(frame, *it);
  }
  gl.DepthMask(GL_TRUE);
  gl.Disable(GL_BLEND);
}

void Painter::draw_xray(const Frame& frame) const {
  const Gl& gl = *gl_;
  set_body_program(frame, programs_->xray);
  programs_->xray.set("pixel", frame.line_scale);
  gl.Enable(GL_BLEND);
  gl.Enable(GL_STENCIL_TEST);
  gl.DepthMask(GL_FALSE);
  gl.DepthFunc(GL_GREATER);
  gl.StencilFunc(GL_EQUAL, 0, 0xFF);
  gl.StencilOp(GL_KEEP, GL_KEEP, GL_INCR);  // 0 becomes `covered`, once
  gl.Disable(GL_CULL_FACE);
  const auto alarm = [&](const StageItem& item) {
    return alarm_colour(frame.alarm_number[static_cast<std::size_t>(item.index)]);
  };
  for (const StageItem& item : frame.stage.items) {
    if (!item.body->highlight || item.body->translucent) continue;
    programs_->xray.set("model", item.model);
    programs_->xray.set("base", alarm(item));
    item.mesh->draw_triangles();
  }
  set_line_program(frame, 1.4, 0, 1);
  gl.StencilFunc(GL_EQUAL, covered, 0xFF);
  gl.StencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  for (const StageItem& item : frame.stage.items) {
    if (!item.body->highlight || item.body->translucent) continue;
    programs_->line.set("model_view", Eigen::Matrix4d(frame.view().view * item.model));
    const Eigen::Vector3f c = (alarm(item) * 0.8).cast<float>();
    LineBatch(gl, outline(item, frame.view(), {c.x(), c.y(), c.z(), 0.75f}, true)).draw();
  }
  gl.Disable(GL_STENCIL_TEST);
  gl.DepthFunc(GL_LEQUAL);
  gl.DepthMask(GL_TRUE);
  gl.Disable(GL_BLEND);
}

void Painter::draw_tile(const Stage& stage, const Scene& scene, const Tile& tile,
                        double line_scale) const {
  const Gl& gl = *gl_;
  Frame frame{stage, scene, tile, line_scale, tile_projection(stage.view, tile), {}, {}, {}};
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
  draw_light(frame);

  gl.BindFramebuffer(GL_FRAMEBUFFER, targets_->multisampled.get());
  gl.Viewport(0, 0, targets_->width, targets_->height);
  gl.Enable(GL_DEPTH_TEST);
  gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  draw_backdrop(frame);
  draw_solids(frame);
  draw_floor(frame);
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

void Painter::draw_id(const StageItem& item, const Eigen::Matrix4d& to_clip) const {
  if (!in_view(item.box, to_clip)) return;
  const unsigned id = static_cast<unsigned>(item.index) + 1;
  const Eigen::Vector4d bytes(id & 0xFFu, (id >> 8) & 0xFFu, (id >> 16) & 0xFFu, 255);
  programs_->id.set("transform", Eigen::Matrix4d(to_clip * item.model));
  programs_->id.set("id", Eigen::Vector4d(bytes / 255.0));
  cull(*item.mesh);
  item.mesh->draw_triangles();
}

}  // namespace aircut::render
