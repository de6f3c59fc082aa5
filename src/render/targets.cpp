#include "render/targets.h"

namespace aircut::render {
namespace {

void attach(const Gl& gl, GLenum place, const GlRenderbuffer& buffer) {
  gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, place, GL_RENDERBUFFER, buffer.get());
}

Expected<TextureTarget> make_texture_target(const Gl& gl, int width, int height, bool depth,
                                            const char* what) {
  TextureTarget out;
  out.color = make_texture(gl, GL_RGBA32F, GL_RGBA, GL_FLOAT, width, height);
  out.framebuffer = make_framebuffer(gl);
  gl.BindFramebuffer(GL_FRAMEBUFFER, out.framebuffer.get());
  gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, out.color.get(), 0);
  if (depth) {
    out.depth = make_renderbuffer(gl, GL_DEPTH_COMPONENT32F, 0, width, height);
    attach(gl, GL_DEPTH_ATTACHMENT, out.depth);
  }
  if (auto ok = check_framebuffer(gl, what); !ok) return unexpected(ok.error());
  return out;
}

Expected<void> add_shadow_map(const Gl& gl, Targets& out) {
  out.shadow_map = make_texture(gl, GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT,
                                shadow_side, shadow_side);
  out.shadow = make_framebuffer(gl);
  gl.BindFramebuffer(GL_FRAMEBUFFER, out.shadow.get());
  gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, out.shadow_map.get(),
                          0);
  gl.DrawBuffer(GL_NONE);
  gl.ReadBuffer(GL_NONE);
  return check_framebuffer(gl, "shadow map");
}

Expected<void> add_multisampled(const Gl& gl, Targets& out) {
  out.color = make_renderbuffer(gl, GL_RGBA8, samples, out.width, out.height);
  out.depth = make_renderbuffer(gl, GL_DEPTH32F_STENCIL8, samples, out.width, out.height);
  out.multisampled = make_framebuffer(gl);
  gl.BindFramebuffer(GL_FRAMEBUFFER, out.multisampled.get());
  attach(gl, GL_COLOR_ATTACHMENT0, out.color);
  attach(gl, GL_DEPTH_STENCIL_ATTACHMENT, out.depth);
  if (auto ok = check_framebuffer(gl, "picture with 4 samples a pixel"); !ok) return ok;
  out.resolved_color = make_renderbuffer(gl, GL_RGBA8, 0, out.width, out.height);
  out.resolved = make_framebuffer(gl);
  gl.BindFramebuffer(GL_FRAMEBUFFER, out.resolved.get());
  attach(gl, GL_COLOR_ATTACHMENT0, out.resolved_color);
  return check_framebuffer(gl, "picture");
}

}  // namespace

Expected<Targets> make_picture_targets(const Gl& gl, int width, int height) {
  Targets out;
  out.width = width;
  out.height = height;
  out.half_width = (width + 1) / 2;
  out.half_height = (height + 1) / 2;
  if (auto ok = add_multisampled(gl, out); !ok) return unexpected(ok.error());
  for (auto [target, depth, what] : {std::tuple{&out.geometry, true, "geometry buffer"},
                                     std::tuple{&out.light, false, "light buffer"},
                                     std::tuple{&out.smoothed, false, "light buffer"}}) {
    auto made = make_texture_target(gl, out.half_width, out.half_height, depth, what);
    if (!made) return unexpected(made.error());
    *target = std::move(*made);
  }
  out.no_vertices = make_array(gl);
  out.small = make_texture(gl, GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT, width, height);
  if (auto ok = add_shadow_map(gl, out); !ok) return unexpected(ok.error());
  return out;
}

Expected<void> add_id_target(const Gl& gl, Targets& targets) {
  targets.id_color = make_renderbuffer(gl, GL_RGBA8, 0, targets.width, targets.height);
  targets.id_depth = make_renderbuffer(gl, GL_DEPTH_COMPONENT32F, 0, targets.width, targets.height);
  targets.id = make_framebuffer(gl);
  gl.BindFramebuffer(GL_FRAMEBUFFER, targets.id.get());
  attach(gl, GL_COLOR_ATTACHMENT0, targets.id_color);
  attach(gl, GL_DEPTH_ATTACHMENT, targets.id_depth);
  return check_framebuffer(gl, "buffer of body numbers");
}

}  // namespace aircut::render
