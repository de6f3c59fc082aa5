// Flat drawing on a finished picture: antialiased shapes by their distance fields, no state.
// Pixel coordinates: x to the right, y down, the centre of the first pixel at (0.5, 0.5).
#pragma once

#include <Eigen/Core>
#include <span>

#include "render/render.h"

namespace aircut::render {

using Vec2 = Eigen::Vector2d;

struct Ink {
  unsigned char r = 0, g = 0, b = 0;
  double alpha = 1;
};

struct Rect {
  double x = 0, y = 0, width = 0, height = 0;
};

Image make_image(int width, int height, Ink ink);
/// Lays ink on one pixel; outside the picture nothing happens.
void blend(Image& image, int x, int y, Ink ink, double coverage);
void fill_round_rect(Image& image, const Rect& rect, double radius, Ink ink);
/// A soft shadow under a rectangle, fading over `blur` pixels.
void fill_shadow(Image& image, const Rect& rect, double radius, double blur, Ink ink);
void draw_line(Image& image, const Vec2& a, const Vec2& b, double width, Ink ink);
void draw_ring(Image& image, const Vec2& centre, double radius, double width, Ink ink);
void fill_disc(Image& image, const Vec2& centre, double radius, Ink ink);
void fill_triangle(Image& image, const Vec2& a, const Vec2& b, const Vec2& c, Ink ink);
/// Copies `part` with its top left corner at (x, y).
void paste(Image& image, const Image& part, int x, int y);
/// Picture of another size: Lanczos over three lobes, in linear light.
Image resampled(const Image& image, int width, int height);

}  // namespace aircut::render
