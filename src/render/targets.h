// The framebuffers that one tile of a picture is drawn into.
#pragma once

#include "render/gl.h"

namespace aircut::render {

/// One texture (or none) and one depth buffer.
struct TextureTarget {
  GlTexture color;
  GlRenderbuffer depth;
  GlFramebuffer framebuffer;
};

struct Targets {
  int width = 0, height = 0;            ///< of a tile, pixels
  int half_width = 0, half_height = 0;  ///< of the lighting pass

  GlRenderbuffer color, depth;  ///< 4 samples; depth has 32 bits, and a stencil
  GlFramebuffer multisampled;
  GlRenderbuffer resolved_color;
  GlFramebuffer resolved;
  GlTexture small;  ///< bodies of small triangles, as SmallTexel
  TextureTarget geometry, light, smoothed;
  GlArray no_vertices;  ///< for shaders that make their own: a core profile wants an array bound
  GlTexture shadow_map;
  GlFramebuffer shadow;
  GlRenderbuffer id_color, id_depth;  ///< one sample
  GlFramebuffer id;
};

constexpr int shadow_side = 2048;  ///< pixels of the shadow map
constexpr int samples = 4;         ///< more than 4 leaves llvmpipe's framebuffer incomplete

/// What the picture needs. Error kind `output_failed`.
Expected<Targets> make_picture_targets(const Gl& gl, int width, int height);
/// What counting bodies needs.
Expected<void> add_id_target(const Gl& gl, Targets& targets);

}  // namespace aircut::render
