// Each shape is a signed distance d (pixels, negative inside); a pixel's coverage is 0.5 - d, cut
// to 0..1, which is the exact coverage of a straight edge along the rows and close to it otherwise.
#include "render/canvas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace aircut::render {
namespace {

struct Window {
  int x0, y0, x1, y1;
};

Window window(const Image& image, double x0, double y0, double x1, double y1) {
  const auto cut = [](double v, int limit) {
    return static_cast<int>(std::clamp(v, 0.0, static_cast<double>(limit)));
  };
  return {cut(std::floor(x0 - 1), image.width), cut(std::floor(y0 - 1), image.height),
          cut(std::ceil(x1 + 1), image.width), cut(std::ceil(y1 + 1), image.height)};
}

template <class Distance>
void fill(Image& image, const Window& w, Ink ink, const Distance& distance) {
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) {
      const double d = distance(Vec2(x + 0.5, y + 0.5));
      if (d < 0.5) blend(image, x, y, ink, std::min(1.0, 0.5 - d));
    }
}

double round_rect_distance(const Vec2& p, const Rect& r, double radius) {
  const Vec2 half(r.width / 2, r.height / 2);
  const Vec2 centre = Vec2(r.x, r.y) + half;
  const Vec2 q = (p - centre).cwiseAbs() - half + Vec2::Constant(radius);
  return std::min(q.maxCoeff(), 0.0) + q.cwiseMax(0).norm() - radius;
}

double segment_distance(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 u = b - a;
  const double length2 = u.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(u) / length2, 0.0, 1.0) : 0.0;
  return (p - a - t * u).norm();
}

unsigned char to_byte(double v) {
  return static_cast<unsigned char>(std::lround(std::clamp(v, 0.0, 255.0)));
}

}  // namespace

Image make_image(int width, int height, Ink ink) {
  Image out{width, height, {}};
  out.rgba.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4);
  for (std::size_t i = 0; i < out.rgba.size(); i += 4) {
    out.rgba[i] = ink.r;
    out.rgba[i + 1] = ink.g;
    out.rgba[i + 2] = ink.b;
    out.rgba[i + 3] = 255;
  }
  return out;
}

void blend(Image& image, int x, int y, Ink ink, double coverage) {
  if (x < 0 || y < 0 || x >= image.width || y >= image.height) return;
  const double a = ink.alpha * coverage;
  unsigned char* p =
      &image.rgba[(static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                   static_cast<std::size_t>(x)) *
                  4];
  const std::array<unsigned char, 3> colour = {ink.r, ink.g, ink.b};
  for (std::size_t c = 0; c < 3; ++c) p[c] = to_byte(p[c] + (colour[c] - p[c]) * a);
}

void fill_round_rect(Image& image, const Rect& rect, double radius, Ink ink) {
  fill(image, window(image, rect.x, rect.y, rect.x + rect.width, rect.y + rect.height), ink,
       [&](const Vec2& p) { return round_rect_distance(p, rect, radius); });
}

void fill_shadow(Image& image, const Rect& rect, double radius, double blur, Ink ink) {
  const Window w = window(image, rect.x - blur, rect.y - blur, rect.x + rect.width + blur,
                          rect.y + rect.height + blur);
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) {
      const double d = round_rect_distance(Vec2(x + 0.5, y + 0.5), rect, radius);
      const double t = std::clamp(0.5 - d / (2 * blur), 0.0, 1.0);
      if (t > 0) blend(image, x, y, ink, t * t * (3 - 2 * t));
    }
}

void draw_line(Image& image, const Vec2& a, const Vec2& b, double width, Ink ink) {
  const double half = width / 2;
  const Vec2 low = a.cwiseMin(b).array() - half, high = a.cwiseMax(b).array() + half;
  fill(image, window(image, low.x(), low.y(), high.x(), high.y()), ink,
       [&](const Vec2& p) { return segment_distance(p, a, b) - half; });
}

void draw_ring(Image& image, const Vec2& centre, double radius, double width, Ink ink) {
  const double r = radius + width;
  fill(image, window(image, centre.x() - r, centre.y() - r, centre.x() + r, centre.y() + r), ink,
       [&](const Vec2& p) { return std::abs((p - centre).norm() - radius) - width / 2; });
}

void fill_disc(Image& image, const Vec2& centre, double radius, Ink ink) {
  const double r = radius;
  fill(image, window(image, centre.x() - r, centre.y() - r, centre.x() + r, centre.y() + r), ink,
       [&](const Vec2& p) { return (p - centre).norm() - radius; });
}

void fill_triangle(Image& image, const Vec2& a, const Vec2& b, const Vec2& c, Ink ink) {
  const std::array<Vec2, 3> corner = {a, b, c};
  const Vec2 low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
  const Vec2 ab = b - a, ac = c - a;
  const double turn = ab.x() * ac.y() - ab.y() * ac.x();
  if (turn == 0) return;
  fill(image, window(image, low.x(), low.y(), high.x(), high.y()), ink, [&](const Vec2& p) {
    double nearest = 1e300, inside = 1;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec2 &from = corner[i], &to = corner[(i + 1) % 3];
      nearest = std::min(nearest, segment_distance(p, from, to));
      const Vec2 u = to - from, v = p - from;
      if ((u.x() * v.y() - u.y() * v.x()) * turn < 0) inside = -1;
    }
    return -inside * nearest;
  });
}

void paste(Image& image, const Image& part, int x, int y) {
  for (int row = 0; row < part.height; ++row)
    for (int column = 0; column < part.width; ++column) {
      const int px = x + column, py = y + row;
      if (px < 0 || py < 0 || px >= image.width || py >= image.height) continue;
      const auto from = static_cast<std::size_t>(row) * static_cast<std::size_t>(part.width) +
                        static_cast<std::size_t>(column);
      const auto to = static_cast<std::size_t>(py) * static_cast<std::size_t>(image.width) +
                      static_cast<std::size_t>(px);
      std::copy_n(&part.rgba[4 * from], 4, &image.rgba[4 * to]);
    }
}

namespace {

struct Tap {
  std::size_t index;
  double weight;
};

// Weights of the source samples for each target sample along one direction.
std::vector<std::vector<Tap>> lanczos_taps(int from, int to) {
  constexpr double lobes = 3;
  const double scale = static_cast<double>(from) / to;
  const double stretch = std::max(scale, 1.0);
  const auto sinc = [](double x) {
    const double px = std::numbers::pi * x;
    return x == 0 ? 1.0 : std::sin(px) / px;
  };
  std::vector<std::vector<Tap>> out(static_cast<std::size_t>(to));
  for (int i = 0; i < to; ++i) {
    const double centre = (i + 0.5) * scale;
    std::vector<Tap>& taps = out[static_cast<std::size_t>(i)];
    double sum = 0;
    const int first = std::max(0, static_cast<int>(std::floor(centre - lobes * stretch)));
    const int last = std::min(from - 1, static_cast<int>(std::ceil(centre + lobes * stretch)));
    for (int j = first; j <= last; ++j) {
      const double x = (j + 0.5 - centre) / stretch;
      if (std::abs(x) >= lobes) continue;
      const double weight = sinc(x) * sinc(x / lobes);
      taps.push_back({static_cast<std::size_t>(j), weight});
      sum += weight;
    }
    for (Tap& tap : taps) tap.weight /= sum;
  }
  return out;
}

// sRGB transfer function (IEC 61966-2-1) and its inverse.
double to_linear(unsigned char v) {
  const double s = v / 255.0;
  return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

unsigned char to_srgb(double v) {
  const double l = std::clamp(v, 0.0, 1.0);
  return to_byte(255 * (l <= 0.0031308 ? 12.92 * l : 1.055 * std::pow(l, 1 / 2.4) - 0.055));
}

}  // namespace

Image resampled(const Image& image, int width, int height) {
  std::array<float, 256> linear{};
  for (std::size_t v = 0; v < 256; ++v)
    linear[v] = static_cast<float>(to_linear(static_cast<unsigned char>(v)));
  const auto across = lanczos_taps(image.width, width), down = lanczos_taps(image.height, height);
  const auto w = static_cast<std::size_t>(width);
  const auto source_width = static_cast<std::size_t>(image.width);
  std::vector<float> rows(w * static_cast<std::size_t>(image.height) * 3);
  for (std::size_t y = 0; y < static_cast<std::size_t>(image.height); ++y)
    for (std::size_t x = 0; x < w; ++x)
      for (std::size_t c = 0; c < 3; ++c) {
        double sum = 0;
        for (const Tap& tap : across[x])
          sum += tap.weight * linear[image.rgba[(y * source_width + tap.index) * 4 + c]];
        rows[(y * w + x) * 3 + c] = static_cast<float>(sum);
      }
  Image out = make_image(width, height, {});
  for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y)
    for (std::size_t x = 0; x < w; ++x)
      for (std::size_t c = 0; c < 3; ++c) {
        double sum = 0;
        for (const Tap& tap : down[y]) sum += tap.weight * rows[(tap.index * w + x) * 3 + c];
        out.rgba[(y * w + x) * 4 + c] = to_srgb(sum);
      }
  return out;
}

}  // namespace aircut::render
