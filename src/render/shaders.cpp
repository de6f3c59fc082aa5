#include "render/shaders.h"

namespace aircut::render::shaders {

// gl_SampleMask comes with the extension.
const char* const version = "#version 330 core\n#extension GL_ARB_sample_shading : enable\n";

const char* const parallel_view = "uniform float parallel;      // 1: orthographic\n";

// Ambient light (x) and key light (y) of this pixel from the half-resolution picture: of the four
// neighbours, those that lie at its own depth.
const char* const gather_light = R"(
uniform sampler2D light;
// `slope` is how much the depth changes from a pixel to the next.
vec2 gathered(float view_depth, float slope) {
  ivec2 size = textureSize(light, 0);
  vec2 p = gl_FragCoord.xy * 0.5 - 0.5;
  ivec2 i = ivec2(floor(p));
  vec2 f = p - vec2(i);
  float tolerance = 0.002 * view_depth + 3.0 * slope;
  vec2 sum = vec2(0.0);
  float weight = 0.0;
  for (int k = 0; k < 4; ++k) {
    ivec2 o = ivec2(k & 1, k >> 1);
    vec3 s = texelFetch(light, clamp(i + o, ivec2(0), size - 1), 0).xyz;
    float bilinear = (o.x == 1 ? f.x : 1.0 - f.x) * (o.y == 1 ? f.y : 1.0 - f.y) + 1e-3;
    float w = bilinear * max(1.0 - abs(s.z - view_depth) / tolerance, 1e-4);
    sum += w * s.xy;
    weight += w;
  }
  return sum / weight;
}
)";

// Where a pixel of the half-resolution picture lies, in the camera's frame.
const char* const half_position = R"(
uniform sampler2D geometry;
uniform vec4 unproject;      // scale and offset from clip to camera coordinates
vec3 position_at(ivec2 pixel, float depth) {
  vec2 ndc = (vec2(pixel) + 0.5) / vec2(textureSize(geometry, 0)) * 2.0 - 1.0;
  vec2 p = (ndc + unproject.zw) * unproject.xy;
  return vec3(p * (parallel > 0.5 ? 1.0 : depth), -depth);
}
)";

const char* const body_vertex = R"(layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform vec4 section;        // where n·p + d is above 0 bodies are cut away; world
uniform mat4 model;          // body to world
uniform mat4 view;           // world to camera
uniform mat4 projection;     // camera to clip space of the tile
out vec3 world_position;
out vec3 world_normal;
out float view_depth;
void main() {
  vec4 w = model * vec4(position, 1.0);
  vec4 v = view * w;
  world_position = w.xyz;
  world_normal = mat3(model) * normal;
  view_depth = -v.z;
  gl_Position = projection * v;
  gl_ClipDistance[0] = -dot(section, w);
}
)";

// Shading model: Cook-Torrance with the GGX distribution (Walter et al. 2007), Schlick's Fresnel
// term, Lambert for what is not metal; three lamps (key with shadow, fill, rim) and an analytic
// studio of sky, floor and soft boxes for reflections. Karis' fit gives the environment's Fresnel.
const char* const surface = R"(
uniform vec3 eye;             // world
uniform vec3 back;            // from the scene to the eye, for parallel views
uniform vec3 key, fill, rim;  // directions to the lamps
uniform vec3 right;           // of the camera, horizontal
uniform vec3 ahead;           // horizontal direction into the picture
// The studio's walls are near: a flat face reflects another part of them at each of its ends.
uniform vec3 target;          // world
uniform float studio_bend;    // per mm

float ggx(float nh, float a) {
  float a2 = a * a;
  float d = nh * nh * (a2 - 1.0) + 1.0;
  return a2 / (3.14159265 * d * d);
}

vec3 lamp(vec3 n, vec3 v, vec3 l, vec3 diffuse, vec3 f0, float a) {
  float nl = clamp(dot(n, l), 0.0, 1.0);
  float nv = clamp(abs(dot(n, v)), 0.05, 1.0);
  vec3 h = normalize(l + v);
  float nh = clamp(dot(n, h), 0.0, 1.0);
  float vh = clamp(dot(v, h), 0.0, 1.0);
  float k = a * 0.5 + 0.05;
  float visible = 0.25 / ((nl * (1.0 - k) + k) * (nv * (1.0 - k) + k));
  float s = 1.0 - vh;
  vec3 f = f0 + (1.0 - f0) * (s * s * s * s * s);
  return (diffuse / 3.14159265 + min(ggx(nh, a) * visible, 6.0) * f) * nl;
}

// What a reflection in direction r meets: dark floor, light walls, a soft box overhead, a strip
// lamp at each side; `soft` blurs the borders for rough metal.
vec3 studio(vec3 r, float soft) {
  float h = r.z;
  vec3 c = mix(vec3(0.16, 0.16, 0.17), vec3(0.62, 0.65, 0.69), smoothstep(-0.25 - soft, 0.12 + soft, h));
  c = mix(c, vec3(0.86, 0.90, 0.96), smoothstep(0.15, 0.95, h));
  float side = dot(r, right);
  float depth = dot(r, ahead);
  float overhead = smoothstep(0.62 - soft, 0.80 + soft, h) * smoothstep(0.62 + soft, 0.2 - soft, abs(side + 0.15));
  // The strips reach below the horizon: seen from above, upright shafts reflect what is there.
  float upright = smoothstep(-0.85, -0.45, h) * smoothstep(0.75 + soft, 0.5 - soft, h);
  float left = smoothstep(0.44 - soft, 0.66 + soft, -side) * upright;
  float beside = 0.45 * smoothstep(0.62 - soft, 0.80 + soft, side) * upright;
  float far_wall = smoothstep(0.35 - soft, 0.95, depth) * smoothstep(-0.05 - soft, 0.3, h);
  return c + vec3(1.00, 0.98, 0.95) * (1.5 * overhead + 1.4 * left + beside) - vec3(0.16) * far_wall;
}

// Display colour of a point with normal n, linear colour `base`, and ambient (x) and key light (y).
vec3 shaded(vec3 world_position, vec3 n, vec3 base, float metal, float roughness, vec2 g) {
  vec3 v = parallel > 0.5 ? back : normalize(eye - world_position);
  vec3 diffuse = base * (1.0 - metal);
  vec3 f0 = mix(vec3(0.045), base, metal);
  float a = roughness * roughness;
  // Brushed metal scatters a good part of its light widely: a share of it is treated as diffuse.
  diffuse += base * metal * 0.34;
  f0 *= 1.0 - 0.12 * metal;

  // A fifth of the key light comes round every corner, so that shapes in shadow keep their form.
  vec3 c = lamp(n, v, key, diffuse, f0, a) * vec3(2.55, 2.49, 2.38) * mix(0.22, 1.0, g.y);
  // Fill and rim have no highlights of their own: the studio's soft boxes stand for those.
  c += diffuse * (max(dot(n, fill), 0.0) * vec3(0.20, 0.22, 0.25) +
                  max(dot(n, rim), 0.0) * mix(0.5, 1.0, g.x) * vec3(0.26, 0.27, 0.29));

  vec3 sky = mix(vec3(0.36, 0.35, 0.34), vec3(0.78, 0.82, 0.88), n.z * 0.5 + 0.5);
  c += diffuse * sky * 0.62 * g.x;
  float nv = clamp(abs(dot(n, v)), 0.0, 1.0);
  vec4 r0 = roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
  float a4 = min(r0.x * r0.x, exp2(-9.28 * nv)) * r0.x + r0.y;
  vec2 ab = vec2(-1.04, 1.04) * a4 + r0.zw;
  float shade = g.x * mix(0.72, 1.0, g.y);
  c += studio(normalize(reflect(-v, n) + (world_position - target) * studio_bend), roughness * 0.6) * (f0 * ab.x + ab.y) * shade;

  c *= 1.34;
  c = c * (1.0 + c / 7.0) / (1.0 + c);
  c = pow(c, vec3(1.0 / 2.2));
  return clamp((c - 0.5) * 1.13 + 0.525, 0.0, 1.0);
}
)";

// Where a body is cut open, its inside is seen: what is shown there is the face of the cut, at the
// place where the line of sight enters it.
const char* const cut_face = R"(
uniform vec4 cut;            // the plane of the cut, world
uniform float cut_on;        // 1: back faces stand for the face of the cut
vec3 on_cut(vec3 world, vec3 from_eye) {
  return world - from_eye * ((dot(cut.xyz, world) + cut.w) / min(dot(cut.xyz, from_eye), -1e-6));
}
)";

// The depth of the cut's plane.
const char* const cut_depth_fragment = R"(uniform vec4 cut;
uniform vec2 picture;        // pixels of the tile
uniform vec4 unproject;      // scale and offset from clip to camera coordinates
uniform mat4 camera_to_world;
out vec4 color;
void main() {
  vec2 q = (gl_FragCoord.xy / picture * 2.0 - 1.0 + unproject.zw) * unproject.xy;
  // The ray advances by 1 mm of depth.
  vec3 ray = mat3(camera_to_world) * vec3(parallel > 0.5 ? vec2(0.0) : q, -1.0);
  vec4 from = camera_to_world * vec4(parallel > 0.5 ? q : vec2(0.0), 0.0, 1.0);
  color = vec4(0.0);
  gl_FragDepth = window_depth(-dot(cut, from) / min(dot(cut.xyz, ray), -1e-6));
}
)";

const char* const body_fragment = R"(in vec3 world_position;
in vec3 world_normal;
in float view_depth;
uniform vec3 base;            // linear colour
uniform float metal;
uniform float roughness;
uniform float opacity;
uniform float use_light;
uniform mat4 view;
out vec4 color;
void main() {
  vec3 n = normalize(gl_FrontFacing ? world_normal : -world_normal);
  vec3 at = world_position;
  float depth = view_depth;
  if (cut_on > 0.5) {
    n = cut.xyz;
    at = on_cut(at, parallel > 0.5 ? -back : at - eye);
    depth = -(view * vec4(at, 1.0)).z;
  }
  vec2 g = use_light > 0.5 ? gathered(depth, fwidth(depth)) : vec2(1.0);
  vec3 c = shaded(at, n, base, metal, roughness, g);
  vec3 v = parallel > 0.5 ? back : normalize(eye - world_position);
  float rim_opacity = opacity < 1.0 ? mix(0.85, opacity, smoothstep(0.0, 0.55, clamp(abs(dot(n, v)), 0.0, 1.0))) : 1.0;
  color = vec4(c, rim_opacity);
}
)";

const char* const geometry_fragment = R"(in vec3 world_position;
in vec3 world_normal;
in float view_depth;
uniform mat4 view;
uniform vec3 eye;             // world
uniform vec3 back;            // from the scene to the eye, for parallel views
out vec4 geometry;           // normal in the camera's frame, depth
void main() {
  vec3 n = normalize(gl_FrontFacing ? world_normal : -world_normal);
  float depth = view_depth;
  if (cut_on > 0.5) {
    n = cut.xyz;
    vec3 at = on_cut(world_position, parallel > 0.5 ? -back : world_position - eye);
    depth = -(view * vec4(at, 1.0)).z;
  }
  geometry = vec4(mat3(view) * n, depth);
}
)";

const char* const depth_vertex = R"(layout(location = 0) in vec3 position;
uniform mat4 transform;
uniform vec4 section;        // in the body's frame
void main() {
  gl_Position = transform * vec4(position, 1.0);
  gl_ClipDistance[0] = -dot(section, vec4(position, 1.0));
}
)";

const char* const depth_fragment = R"(void main() {}
)";

const char* const id_fragment = R"(uniform vec4 id;
out vec4 color;
void main() { color = id; }
)";

// At the far end: with a depth test it fills what nothing covers.
const char* const screen_vertex = R"(void main() {
  vec2 p = vec2(float((gl_VertexID & 1) * 4) - 1.0, float((gl_VertexID >> 1) * 4) - 1.0);
  gl_Position = vec4(p, 1.0, 1.0);
}
)";

// Ambient occlusion by the estimator of "Scalable Ambient Obscurance" (McGuire, Mara, Luebke 2012):
// samples on a spiral in the picture, each adds how far it stands above the tangent plane.
// Key light by percentage-closer soft shadows (Fernando 2005): the mean distance of what blocks the
// lamp gives the width of the penumbra. Both use a rotation that repeats every 4 x 4 pixels; the
// smoothing pass averages over just that.
const char* const light_fragment = R"(uniform sampler2D shadow_map;
uniform mat4 camera_to_world;
uniform mat4 to_shadow;      // world to shadow map, 0..1
uniform vec3 key;            // world
uniform float radius;        // of occlusion, mm
uniform float pixels_per_mm; // at depth 1, or everywhere in a parallel view
uniform float shadow_size;   // mm across the map
uniform float shadow_depth;  // mm through the map
uniform float lamp_slope;    // penumbra width per distance of the blocker
out vec4 light;


// Loops run as often as some pixel of a vector needs them: where there is nothing to do the count
// is 0. Spirals turn by the golden angle from sample to sample.
const mat2 golden = mat2(-0.73736888, 0.67549029, -0.67549029, -0.73736888);

float occlusion(vec3 p, vec3 n, ivec2 pixel, float depth, vec2 spin, int samples) {
  ivec2 last = textureSize(geometry, 0) - 1;
  float reach = radius * (parallel > 0.5 ? pixels_per_mm : pixels_per_mm / depth);
  reach = clamp(reach, 4.0, 110.0);
  float sum = 0.0;
  float rr = radius * radius;
  for (int i = 0; i < samples; ++i) {
    float t = (float(i) + 0.5) / float(samples);
    ivec2 at = clamp(pixel + ivec2(round(t * reach * spin)), ivec2(0), last);
    spin = golden * spin;
    float d = texelFetch(geometry, at, 0).w;
    vec3 v = position_at(at, d) - p;
    float vv = dot(v, v);
    float vn = dot(v, n) - 0.012 * radius;
    float f = max(rr - vv, 0.0) / rr;
    sum += d > 0.0 ? f * f * f * max(vn, 0.0) * radius / (vv + 0.02 * rr) : 0.0;
  }
  return samples == 0 ? 1.0 : clamp(1.0 - 2.6 * sum / float(samples), 0.0, 1.0);
}

float lit(vec3 world, vec3 n, vec2 spin, bool wanted) {
  float texel = shadow_size / float(textureSize(shadow_map, 0).x);
  vec3 s = (to_shadow * vec4(world + n * texel * 2.0 + key * texel, 1.0)).xyz;
  bool outside = any(lessThan(s, vec3(0.0))) || any(greaterThan(s, vec3(1.0)));
  bool facing = dot(n, key) >= 0.0;
  float search = 0.022;
  float blockers = 0.0, total = 0.0;
  int looks = wanted && facing && !outside ? 8 : 0;
  vec2 turned = spin;
  for (int i = 0; i < looks; ++i) {
    float r = sqrt((float(i) + 0.5) / 8.0) * search;
    float d = texture(shadow_map, s.xy + r * turned).x;
    turned = golden * turned;
    if (d < s.z) { blockers += 1.0; total += d; }
  }
  float gap = max(s.z - total / max(blockers, 1.0), 0.0) * shadow_depth / shadow_size;
  float width = clamp(gap * lamp_slope, 1.6 * texel / shadow_size, search);
  float open = 0.0;
  int taps = blockers > 0.5 ? 12 : 0;
  for (int i = 0; i < taps; ++i) {
    float r = sqrt((float(i) + 0.5) / 12.0) * width;
    float d = texture(shadow_map, s.xy + r * spin).x;
    spin = golden * spin;
    // A wide kernel on a slope meets the surface itself: the bias grows with the kernel.
    open += d + 0.6 * r * shadow_size / shadow_depth * 0.6 < s.z ? 0.0 : 1.0;
  }
  return !facing ? 0.0 : taps == 0 ? 1.0 : open / 12.0;
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 g = texelFetch(geometry, pixel, 0);
  bool something = g.w > 0.0;
  // 16 rotations in an order that spreads neighbours apart.
  int cell = (((pixel.x ^ pixel.y) & 1) << 3) | ((pixel.x & 1) << 2) | (((pixel.x ^ pixel.y) & 2)) | ((pixel.x & 2) >> 1);
  float turn = float(cell) * (6.2831853 / 16.0);
  vec2 spin = vec2(cos(turn), sin(turn));
  vec3 p = position_at(pixel, g.w);
  vec3 n = something ? normalize(g.xyz) : vec3(0.0, 0.0, 1.0);
  light = vec4(1.0, 1.0, g.w, 0.0);
  light.x = occlusion(p, n, pixel, g.w, spin, something ? 11 : 0);
  light.y = lit((camera_to_world * vec4(p, 1.0)).xyz, mat3(camera_to_world) * n, spin, something);
}
)";

const char* const smooth_fragment = R"(uniform sampler2D light;
uniform ivec2 along;
uniform float tolerance;     // mm off the tangent plane, at depth 1 or everywhere
out vec4 smoothed;
void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  ivec2 last = textureSize(geometry, 0) - 1;
  vec4 g = texelFetch(geometry, pixel, 0);
  vec3 p = position_at(pixel, g.w);
  float thick = tolerance * (parallel > 0.5 ? 1.0 : g.w);
  vec2 sum = texelFetch(light, pixel, 0).xy;
  float weight = 1.0;
  int end = g.w > 0.0 ? 3 : -2;
  for (int i = -2; i < end; ++i) {
    if (i == 0) continue;
    ivec2 at = clamp(pixel + i * along, ivec2(0), last);
    vec3 o = texelFetch(light, at, 0).xyz;
    float off = abs(dot(g.xyz, position_at(at, o.z) - p));
    float w = max(1.0 - off / thick, 0.0) * (abs(i) == 2 ? 0.5 : 1.0);
    sum += w * o.xy;
    weight += w;
  }
  smoothed = vec4(sum / weight, g.w, 0.0);
}
)";

const char* const backdrop = R"(
uniform vec4 frame;          // pixel to 0..1 of the whole picture: scale, offset
vec3 backdrop() {
  vec2 p = gl_FragCoord.xy * frame.xy + frame.zw;
  vec3 c = mix(vec3(0.905, 0.915, 0.925), vec3(0.795, 0.825, 0.860), smoothstep(0.25, 1.05, p.y));
  float d = length((p - vec2(0.5, 0.45)) * vec2(1.0, 0.8));
  return c * (1.0 - 0.10 * smoothstep(0.35, 0.85, d));
}
)";

const char* const background_fragment = R"(out vec4 color;
void main() { color = vec4(backdrop(), 1.0); }
)";

const char* const floor_vertex = R"(uniform mat4 view;
uniform mat4 projection;
uniform vec4 square;         // centre, height, half size; world
out vec3 world_position;
out vec3 world_normal;
out float view_depth;
void main() {
  vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * 2.0 - 1.0;
  world_position = vec3(square.xy + corner * square.w, square.z);
  world_normal = vec3(0.0, 0.0, 1.0);
  vec4 v = view * vec4(world_position, 1.0);
  view_depth = -v.z;
  gl_Position = projection * v;
}
)";

const char* const floor_geometry_fragment = R"(in vec3 world_position;
in vec3 world_normal;
in float view_depth;
uniform mat4 view;
out vec4 geometry;
void main() { geometry = vec4(mat3(view) * vec3(0.0, 0.0, 1.0), view_depth); }
)";

const char* const floor_fragment = R"(in vec3 world_position;
in vec3 world_normal;
in float view_depth;
uniform vec4 square;
uniform vec3 grid;           // origin of the grid in the render frame, xy; spacing of fine lines
uniform float fade;          // distance from the centre at which the floor is gone
uniform float pixel;         // line width in pixels
out vec4 color;
// Coverage of grid lines `step` apart; lines closer than a few pixels dissolve into their mean.
float lines(vec2 p, vec2 change, float step, float width) {
  vec2 w = change / step;
  vec2 d = abs(fract(p / step - 0.5) - 0.5) / max(w, vec2(1e-6));
  vec2 c = clamp(0.5 * width + 0.5 - d, 0.0, 1.0) * clamp(0.9 - 2.4 * w, 0.0, 1.0);
  return max(c.x, c.y);
}
void main() {
  vec2 g = gathered(view_depth, fwidth(view_depth));
  float off = length(world_position.xy - square.xy) / fade;
  float near = 1.0 - smoothstep(0.35, 1.0, off);
  vec2 p = world_position.xy - grid.xy, change = fwidth(p);
  float fine = lines(p, change, grid.z, pixel), coarse = lines(p, change, grid.z * 5.0, pixel * 1.25);
  float shade = mix(1.0, 0.60 + 0.40 * g.y, near) * mix(1.0, 0.30 + 0.70 * g.x, near);
  float ink = max(fine * 0.07, coarse * 0.17) * near;
  // Only darkens what lies behind: the floor melts into the background.
  color = vec4(mix(backdrop(), vec3(0.10, 0.12, 0.16), 1.0 - shade * (1.0 - ink)), 1.0);
}
)";

const char* const xray_fragment = R"(in vec3 world_position;
in vec3 world_normal;
in float view_depth;
uniform vec3 base;           // display colour
uniform float pixel;         // period of the hatching / 8, in pixels
out vec4 color;
void main() {
  float stripe = fract((gl_FragCoord.x + gl_FragCoord.y) / (9.0 * pixel));
  float on = smoothstep(0.0, 0.12, stripe) - smoothstep(0.5, 0.62, stripe);
  color = vec4(base, mix(0.26, 0.50, on));
}
)";

// A line is a rectangle of four corners that faces the viewer, one pixel wider than it looks; the
// fragment shader fades its sides. Both ends move towards the eye by a small part of their
// distance, which leaves them at the same place in the picture but in front of the surface that
// they lie on.
const char* const line_vertex = R"(layout(location = 0) in vec3 from;
layout(location = 1) in vec3 to;
layout(location = 2) in vec4 ink;
uniform mat4 model_view;
uniform mat4 projection;
uniform vec2 viewport;       // pixels
uniform float width;         // pixels
uniform float lift;          // part of the distance
uniform float parallel;
uniform float near;          // mm
uniform float fade_below;    // lines shorter than this many pixels fade
uniform vec4 section;        // in the frame of the line's ends
out vec4 line_ink;
out float across;
out float half_width;
void main() {
  gl_ClipDistance[0] = -dot(section, vec4((gl_VertexID & 1) == 1 ? to : from, 1.0));
  vec3 a = (model_view * vec4(from, 1.0)).xyz, b = (model_view * vec4(to, 1.0)).xyz;
  if (parallel < 0.5) {
    float limit = -near * 1.001;
    if (a.z > limit && b.z > limit) { gl_Position = vec4(0.0, 0.0, 2.0, 1.0); return; }
    if (a.z > limit) a = mix(a, b, (a.z - limit) / (a.z - b.z));
    if (b.z > limit) b = mix(b, a, (b.z - limit) / (b.z - a.z));
    a *= 1.0 - lift;
    b *= 1.0 - lift;
  } else {
    a.z += lift * abs(a.z);
    b.z += lift * abs(b.z);
  }
  vec4 ca = projection * vec4(a, 1.0), cb = projection * vec4(b, 1.0);
  vec2 pa = ca.xy / ca.w * viewport * 0.5, pb = cb.xy / cb.w * viewport * 0.5;
  vec2 d = pb - pa;
  float length_px = length(d);
  vec2 u = length_px > 1e-4 ? d / length_px : vec2(1.0, 0.0);
  vec2 side = vec2(-u.y, u.x);
  half_width = width * 0.5;
  float reach = half_width + 1.0;
  vec4 c = (gl_VertexID & 1) == 1 ? cb : ca;
  float s = (gl_VertexID & 2) == 2 ? 1.0 : -1.0;
  float end = (gl_VertexID & 1) == 1 ? 1.0 : -1.0;
  vec2 shift = side * s * reach + u * end * half_width * 0.6;
  gl_Position = c + vec4(shift / (viewport * 0.5) * c.w, 0.0, 0.0);
  across = s * reach;
  line_ink = ink;
  line_ink.a *= fade_below > 0.0 ? smoothstep(0.15 * fade_below, fade_below, length_px) : 1.0;
}
)";

const char* const line_fragment = R"(in vec4 line_ink;
in float across;
in float half_width;
uniform float opacity;
out vec4 color;
void main() {
  float coverage = clamp(half_width + 0.5 - abs(across), 0.0, 1.0) * min(1.0, half_width * 2.0);
  color = vec4(line_ink.rgb, line_ink.a * opacity * coverage);
}
)";

}  // namespace aircut::render::shaders
