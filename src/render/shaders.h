// The GLSL programs, version 3.30 core. Frames: `world` is the render frame of camera.h, Z up.
#pragma once

namespace aircut::render::shaders {

// First line of every shader, and functions that some share.
extern const char* const version;
extern const char* const gather_light;
extern const char* const half_position;
extern const char* const parallel_view;
extern const char* const surface;
extern const char* const depth_of;
extern const char* const small_texel;

// Surfaces of bodies, lit; faces of cuts.
extern const char* const body_vertex;
extern const char* const cut_face;
extern const char* const cut_depth_fragment;
extern const char* const body_fragment;
// Normals and depth of opaque surfaces in half resolution; shadow map; numbers of bodies.
extern const char* const geometry_fragment;
extern const char* const depth_vertex;
extern const char* const depth_fragment;
extern const char* const id_fragment;
// Full-frame passes over the half-resolution picture.
extern const char* const screen_vertex;
extern const char* const light_fragment;
extern const char* const smooth_fragment;
extern const char* const backdrop;
extern const char* const background_fragment;
// The floor catches shadows and carries the grid.
extern const char* const floor_vertex;
extern const char* const floor_fragment;
extern const char* const floor_geometry_fragment;
// Bodies of small triangles, from pixels.
extern const char* const small_geometry_fragment;
extern const char* const small_fragment;
// What covered bodies in alarm look like through their covers.
extern const char* const xray_fragment;
// Straight lines of constant width in pixels.
extern const char* const line_vertex;
extern const char* const line_fragment;

}  // namespace aircut::render::shaders
