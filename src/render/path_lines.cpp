#include "render/path_lines.h"

#include <algorithm>
#include <cmath>

namespace aircut::render {
namespace {

constexpr double dash_share = 0.62;     // of a period
constexpr double period_pixels = 13;    // at the camera's target
constexpr double most_dashes = 20'000;  // of one line; longer ones get longer dashes

std::array<float, 3> to_float(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

double length(const std::vector<Vec3>& points) {
  double sum = 0;
  for (std::size_t i = 1; i < points.size(); ++i) sum += (points[i] - points[i - 1]).norm();
  return sum;
}

class Emitter {
 public:
  Emitter(std::vector<LineVertex>& out, const Vec3& centre, std::array<float, 3> colour)
      : out_(&out), centre_(centre), ink_{colour[0], colour[1], colour[2], 1} {}

  void solid(const Vec3& a, const Vec3& b) const {
    out_->push_back({to_float(a - centre_), to_float(b - centre_), ink_});
  }
  // `at` is the way so far; dashes run on around corners.
  void dashed(const Vec3& a, const Vec3& b, double at, double period) const {
    const double size = (b - a).norm();
    if (!(size > 0)) return;
    double s = 0;
    while (s < size) {
      const double phase = std::fmod(at + s, period);
      const bool on = phase < dash_share * period;
      const double end =
          std::min(size, s + (on ? dash_share * period : period) - phase + 1e-9 * period);
      if (on) solid(a + (b - a) * (s / size), a + (b - a) * (end / size));
      s = end;
    }
  }

 private:
  std::vector<LineVertex>* out_;
  Vec3 centre_;
  std::array<float, 4> ink_;
};

}  // namespace

std::array<float, 3> path_colour(LineKind kind) {
  switch (kind) {
    case LineKind::rapid:
      return {0.93f, 0.58f, 0.02f};
    case LineKind::feed:
      return {0.07f, 0.36f, 0.90f};
    case LineKind::arc:
      return {0.04f, 0.60f, 0.32f};
    case LineKind::done:
      return {0.34f, 0.38f, 0.44f};
  }
  return {};
}

std::array<float, 3> path_colour(const DrawLine& line) {
  if (!line.color) return path_colour(line.kind);
  const auto share = [](unsigned char v) { return static_cast<float>(v) / 255; };
  return {share(line.color->r), share(line.color->g), share(line.color->b)};
}

std::vector<LineVertex> path_lines(const std::vector<DrawLine>& lines, const Vec3& centre,
                                   double mm_per_pixel) {
  std::vector<LineVertex> out;
  for (const DrawLine& line : lines) {
    if (!std::all_of(line.points.begin(), line.points.end(),
                     [](const Vec3& p) { return p.allFinite(); }))
      continue;
    const Emitter emit(out, centre, path_colour(line));
    const double period =
        std::max({period_pixels * mm_per_pixel, length(line.points) / most_dashes, 1e-6});
    double at = 0;
    for (std::size_t i = 1; i < line.points.size(); ++i) {
      const Vec3 &a = line.points[i - 1], &b = line.points[i];
      if (line.kind == LineKind::rapid)
        emit.dashed(a, b, at, period);
      else
        emit.solid(a, b);
      at += (b - a).norm();
    }
  }
  return out;
}

}  // namespace aircut::render
