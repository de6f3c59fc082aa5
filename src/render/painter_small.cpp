// Bodies of small triangles: drawn by small_triangles.cpp, handed to OpenGL as pixels.
#include <algorithm>
#include <cmath>

#include "render/painter_frame.h"
#include "render/small_triangles.h"

namespace aircut::render {
namespace {

std::uint32_t look_of(const machine::Color& color) {
  const double metal = material_of(color).metal;
  return static_cast<std::uint32_t>(color.r) | static_cast<std::uint32_t>(color.g) << 8 |
         static_cast<std::uint32_t>(color.b) << 16 |
         static_cast<std::uint32_t>(std::lround(metal * 255)) << 24;
}

SmallBody small_body(const StageItem& item) {
  return {item.mesh->shape(), item.model, look_of(item.body->color)};
}

}  // namespace

Eigen::Vector4d depth_terms(const View& view) {
  const Eigen::Matrix4d& P = view.projection;
  return view.orthographic ? Eigen::Vector4d(P(2, 3), P(2, 2), 0, 0)
                           : Eigen::Vector4d(P(2, 2), P(2, 3), 0, 0);
}

bool Painter::draw_small_shadows(const Stage& stage) const {
  const Gl& gl = *gl_;
  PixelRect rect;
  for (const StageItem& item : stage.items)
    if (item.small)
      rect.extend(pixels_of(item.box, stage.world_to_shadow, shadow_side, shadow_side));
  if (rect.empty()) return false;
  small_->start_depths(shadow_side, rect);
  for (const StageItem& item : stage.items)
    if (item.small) small_->draw_depths(small_body(item), stage.world_to_shadow);
  gl.BindTexture(GL_TEXTURE_2D, targets_->shadow_map.get());
  gl.PixelStorei(GL_UNPACK_ROW_LENGTH, shadow_side);
  gl.TexSubImage2D(GL_TEXTURE_2D, 0, rect.x0, rect.y0, rect.width(), rect.height(),
                   GL_DEPTH_COMPONENT, GL_FLOAT,
                   small_->depths() + static_cast<std::ptrdiff_t>(rect.y0) * shadow_side + rect.x0);
  gl.PixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  gl.BindTexture(GL_TEXTURE_2D, 0);
  return true;
}

void Painter::prepare_small(Frame& frame) const {
  const Gl& gl = *gl_;
  const int width = targets_->width, height = targets_->height;
  const auto wanted = [&](const StageItem& item) {
    return item.small && in_view(item.box, frame.to_clip);
  };
  for (const StageItem& item : frame.stage.items)
    if (wanted(item)) frame.small.extend(pixels_of(item.box, frame.to_clip, width, height));
  if (frame.small.empty()) return;
  // The lighting pass looks at blocks of 2 x 2 pixels.
  PixelRect& rect = frame.small;
  rect = {rect.x0 & ~1, rect.y0 & ~1, std::min((rect.x1 + 1) & ~1, width),
          std::min((rect.y1 + 1) & ~1, height)};
  small_->start_picture(width, height, rect);
  for (const StageItem& item : frame.stage.items)
    if (wanted(item)) small_->draw(small_body(item), frame.to_clip);
  gl.ActiveTexture(GL_TEXTURE2);
  gl.BindTexture(GL_TEXTURE_2D, targets_->small.get());
  gl.PixelStorei(GL_UNPACK_ROW_LENGTH, width);
  gl.TexSubImage2D(GL_TEXTURE_2D, 0, rect.x0, rect.y0, rect.width(), rect.height(), GL_RGBA_INTEGER,
                   GL_UNSIGNED_INT,
                   small_->texels() + static_cast<std::ptrdiff_t>(rect.y0) * width + rect.x0);
  gl.PixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  gl.ActiveTexture(GL_TEXTURE0);
}

void Painter::draw_small_rect(const Frame& frame, const Program& program, int shrink) const {
  const PixelRect& rect = frame.small;
  program.set("small", 2);
  program.set("depth_terms", depth_terms(frame.view()));
  program.set("parallel", frame.parallel());
  program.set("view", frame.view().view);
  gl_->Enable(GL_SCISSOR_TEST);
  gl_->Scissor(rect.x0 / shrink, rect.y0 / shrink, (rect.width() + shrink - 1) / shrink,
               (rect.height() + shrink - 1) / shrink);
  screen_triangle();
  gl_->Disable(GL_SCISSOR_TEST);
}

void Painter::draw_small_geometry(const Frame& frame) const {
  if (frame.small.empty()) return;
  programs_->small_geometry.use();
  draw_small_rect(frame, programs_->small_geometry, 2);
}

void Painter::draw_small(const Frame& frame) const {
  if (frame.small.empty()) return;
  const Program& program = programs_->small;
  set_body_program(frame, program);
  program.set("camera_to_world", Eigen::Matrix4d(frame.view().view.inverse()));
  program.set("unproject", frame.unproject);
  program.set("picture", Eigen::Vector2d(targets_->width, targets_->height));
  program.set("mm_per_pixel", 2 / (frame.projection(1, 1) * targets_->height));
  draw_small_rect(frame, program, 1);
}

}  // namespace aircut::render
