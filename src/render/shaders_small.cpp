// Shaders that read what small_triangles.cpp has drawn: one look-up a pixel.
#include "render/shaders.h"

namespace aircut::render::shaders {

const char* const depth_of = R"(
uniform vec4 depth_terms;    // clip depth is x - y·d in a parallel view, y / d - x otherwise
float window_depth(float d) {
  float clip = parallel > 0.5 ? depth_terms.x - depth_terms.y * d : depth_terms.y / d - depth_terms.x;
  return clip * 0.5 + 0.5;
}
)";

const char* const small_texel = R"(
uniform usampler2D small;
float signed_16(uint bits) { return float(int(bits << 16) >> 16) / 32767.0; }
vec3 normal_of(uvec4 t) {
  vec3 n = vec3(signed_16(t.y), signed_16(t.y >> 16), signed_16(t.z));
  return normalize(n + vec3(0.0, 0.0, 1e-9));
}
int cover_of(uvec4 t) { return int(t.z >> 16) & 15; }
// mm in front of the eye.
float view_depth_of(float clip) {
  return parallel > 0.5 ? (depth_terms.x - clip) / depth_terms.y : depth_terms.y / (clip + depth_terms.x);
}
)";

// Of four pixels the one that is covered best.
const char* const small_geometry_fragment = R"(uniform mat4 view;
out vec4 geometry;
void main() {
  ivec2 last = textureSize(small, 0) - 1;
  uvec4 best = uvec4(0u);
  int most = 0;
  for (int k = 0; k < 4; ++k) {
    uvec4 t = texelFetch(small, min(ivec2(gl_FragCoord.xy) * 2 + ivec2(k & 1, k >> 1), last), 0);
    int cover = cover_of(t);
    cover = (cover & 1) + (cover >> 1 & 1) + (cover >> 2 & 1) + (cover >> 3);
    if (cover > most) { most = cover; best = t; }
  }
  if (most == 0) discard;
  float d = view_depth_of(uintBitsToFloat(best.x));
  geometry = vec4(mat3(view) * normal_of(best), d);
  gl_FragDepth = window_depth(d);
}
)";

// The surface stands a little deeper than it is, as polygon offset has it for large triangles, so
// that lines upon it are seen.
const char* const small_fragment = R"(uniform mat4 view;
uniform mat4 camera_to_world;
uniform vec4 unproject;      // scale and offset from clip to camera coordinates
uniform vec2 picture;        // pixels
uniform float mm_per_pixel;  // at depth 1, or everywhere in a parallel view
out vec4 color;
void main() {
  uvec4 t = texelFetch(small, ivec2(gl_FragCoord.xy), 0);
  int cover = cover_of(t);
  color = vec4(0.0);
  float depth = 1.0;
  // Runs once where there is something; a processor skips it where there is nothing.
  int times = cover == 0 ? 0 : 1;
  for (int k = 0; k < times; ++k) {
    float d = view_depth_of(uintBitsToFloat(t.x));
    vec3 n = normal_of(t);
    vec3 seen = mat3(view) * n;
    float slope = mm_per_pixel * (parallel > 0.5 ? 1.0 : d) * length(seen.xy) / max(seen.z, 0.1);
    vec2 p = (gl_FragCoord.xy / picture * 2.0 - 1.0 + unproject.zw) * unproject.xy;
    vec3 world = (camera_to_world * vec4(p * (parallel > 0.5 ? 1.0 : d), -d, 1.0)).xyz;
    vec4 look = vec4(t.w & 255u, t.w >> 8 & 255u, t.w >> 16 & 255u, t.w >> 24) / 255.0;
    vec3 c = shaded(world, n, pow(look.rgb, vec3(2.2)), look.a, 0.46 - 0.12 * look.a, gathered(d, slope * 1.4));
    color = vec4(c, 1.0);
    depth = window_depth(d + slope);
  }
  if (cover == 0) discard;
  gl_SampleMask[0] = cover;
  gl_FragDepth = depth;
}
)";

}  // namespace aircut::render::shaders
