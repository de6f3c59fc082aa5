// Everything drawn as lines: edges of bodies, tool paths, and bodies in alarm seen through others.
#include "render/painter_frame.h"
#include "render/path_lines.h"

namespace aircut::render {

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

// Where the plane of the section cuts the triangles of a mesh.
std::vector<LineVertex> cut_outline(const TriangleMesh& mesh, const Eigen::Vector4d& plane,
                                    std::array<float, 4> ink) {
  std::vector<LineVertex> out;
  const auto height = [&](const Vec3& p) { return plane.head<3>().dot(p) + plane.w(); };
  for (const auto& t : mesh.triangles) {
    std::vector<std::array<float, 3>> ends;
    for (unsigned k = 0; k < 3; ++k) {
      if (t[k] >= mesh.vertices.size() || t[(k + 1) % 3] >= mesh.vertices.size()) break;
      const Vec3 &a = mesh.vertices[t[k]], &b = mesh.vertices[t[(k + 1) % 3]];
      const double ha = height(a), hb = height(b);
      if ((ha > 0) == (hb > 0)) continue;
      const Eigen::Vector3f p = (a + (b - a) * (ha / (ha - hb))).cast<float>();
      ends.push_back({p.x(), p.y(), p.z()});
    }
    if (ends.size() == 2) out.push_back({ends[0], ends[1], ink});
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
  line.set("section", plane_of(item, frame.stage));
  start_cut(frame.stage);
  item.mesh->draw_creases();
  line.set("fade_below", 0.0);
  LineBatch(*gl_, outline(item, frame.view(), ink, false)).draw();
  end_cut();
  if (frame.stage.section)
    LineBatch(*gl_, cut_outline(*item.mesh->source(), plane_of(item, frame.stage), ink)).draw();
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

}  // namespace aircut::render
