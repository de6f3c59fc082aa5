// Maps of workspaces, after the figures of papers: cells that are reached in grey tones, their
// outline, axes with round numbers, a bar that shows the scale. All planes have one scale, so that
// they can be compared.
#include <algorithm>
#include <array>
#include <cmath>

#include "logbook/canvas.h"
#include "logbook/logbook.h"
#include "logbook/scale.h"

namespace aircut::logbook {
namespace {

constexpr double margin_left = 78, margin_top = 84, between = 96, below_plane = 62, line = 18;
constexpr std::array<Colour, 2> tones = {{{0.80, 0.87, 0.93}, {0.42, 0.60, 0.75}}};
constexpr std::array<unsigned char, 2> kinds = {1, 2};
constexpr Colour ink{0.10, 0.22, 0.35}, red{0.80, 0.20, 0.10};

double width_of(const MapPlane& p) { return p.columns * p.pitch; }
double height_of(const MapPlane& p) { return p.rows * p.pitch; }

class PlaneDrawing {
 public:
  PlaneDrawing(Canvas& canvas, const MapPlane& plane, double left, double bottom, double scale)
      : canvas_(canvas), p_(plane), left_(left), bottom_(bottom), scale_(scale) {}

  void draw() {
    for (const unsigned char kind : kinds) fill(kind);
    axes();
    for (const unsigned char kind : kinds) outline(kind);
    if (p_.frame) frame(*p_.frame);
    canvas_.text(left_, bottom_ - height_of(p_) * scale_ - 12, printable(p_.title), 14, black,
                 Align::left, true);
  }

 private:
  double low_x() const { return p_.x - p_.pitch / 2; }
  double low_y() const { return p_.y - p_.pitch / 2; }
  double at_x(double x) const { return left_ + (x - low_x()) * scale_; }
  double at_y(double y) const { return bottom_ - (y - low_y()) * scale_; }
  unsigned char kind(int i, int j) const {
    if (i < 0 || j < 0 || i >= p_.columns || j >= p_.rows) return 0;
    return p_.cells[static_cast<std::size_t>(j) * static_cast<std::size_t>(p_.columns) +
                    static_cast<std::size_t>(i)];
  }
  double edge_x(int i) const { return at_x(low_x() + i * p_.pitch); }
  double edge_y(int j) const { return at_y(low_y() + j * p_.pitch); }

  // Runs of a row in one go.
  void fill(unsigned char wanted) {
    for (int j = 0; j < p_.rows; ++j)
      for (int i = 0; i < p_.columns; ++i) {
        if (kind(i, j) != wanted) continue;
        const int first = i;
        while (kind(i + 1, j) == wanted) ++i;
        canvas_.fill(edge_x(first), edge_y(j + 1), edge_x(i + 1) - edge_x(first) + 0.3,
                     edge_y(j) - edge_y(j + 1) + 0.3, tones[wanted - 1u]);
      }
  }

  // Edges between cells of at least this kind and others, as long straight lines.
  void outline(unsigned char least) {
    const auto in = [&](int i, int j) { return kind(i, j) >= least; };
    const double width = least == 2 ? 1.6 : 1.2;
    for (int j = 0; j <= p_.rows; ++j)
      for (int i = 0; i < p_.columns; ++i) {
        if (in(i, j) == in(i, j - 1)) continue;
        const int first = i;
        while (i + 1 < p_.columns && in(i + 1, j) != in(i + 1, j - 1)) ++i;
        canvas_.polyline({{edge_x(first), edge_y(j)}, {edge_x(i + 1), edge_y(j)}}, ink, width);
      }
    for (int i = 0; i <= p_.columns; ++i)
      for (int j = 0; j < p_.rows; ++j) {
        if (in(i, j) == in(i - 1, j)) continue;
        const int first = j;
        while (j + 1 < p_.rows && in(i, j + 1) != in(i - 1, j + 1)) ++j;
        canvas_.polyline({{edge_x(i), edge_y(first)}, {edge_x(i), edge_y(j + 1)}}, ink, width);
      }
  }

  void axes() {
    const double right = left_ + width_of(p_) * scale_, top = bottom_ - height_of(p_) * scale_;
    const double dx = nice_step(70 / scale_), dy = nice_step(45 / scale_);
    for (double k = std::ceil(low_x() / dx - 1e-9); at_x(k * dx) <= right + 1e-6; ++k) {
      canvas_.polyline({{at_x(k * dx), bottom_}, {at_x(k * dx), top}}, pale, 1);
      canvas_.polyline({{at_x(k * dx), bottom_}, {at_x(k * dx), bottom_ + 5}}, black, 1);
      canvas_.text(at_x(k * dx), bottom_ + 19, number(k * dx, dx), 12, black, Align::middle);
    }
    for (double k = std::ceil(low_y() / dy - 1e-9); at_y(k * dy) >= top - 1e-6; ++k) {
      canvas_.polyline({{left_, at_y(k * dy)}, {right, at_y(k * dy)}}, pale, 1);
      canvas_.polyline({{left_ - 5, at_y(k * dy)}, {left_, at_y(k * dy)}}, black, 1);
      canvas_.text(left_ - 8, at_y(k * dy) + 4, number(k * dy, dy), 12, black, Align::right);
    }
    canvas_.polyline({{left_, top}, {right, top}, {right, bottom_}, {left_, bottom_}, {left_, top}},
                     black, 1);
    canvas_.text((left_ + right) / 2, bottom_ + 38, printable(p_.x_name), 12, black, Align::middle);
    canvas_.text(left_ - 8, top - 12, printable(p_.y_name), 12, black, Align::right);
  }

  void frame(const std::array<double, 4>& f) {
    canvas_.polyline({{at_x(f[0]), at_y(f[1])},
                      {at_x(f[2]), at_y(f[1])},
                      {at_x(f[2]), at_y(f[3])},
                      {at_x(f[0]), at_y(f[3])},
                      {at_x(f[0]), at_y(f[1])}},
                     red, 2, 7);
  }

  Canvas& canvas_;
  const MapPlane& p_;
  double left_, bottom_, scale_;
};

// What the tones mean, the bar of the scale, and the notes; `y` of the first line.
void legend(Canvas& canvas, const Map& map, double scale, double y) {
  double x = margin_left;
  const auto entry = [&](const std::string& text, auto&& sign) {
    sign();
    canvas.text(x + 26, y, printable(text), 12, black);
    x += 26 + canvas.text_width(printable(text), 12) + 28;
  };
  for (std::size_t i = 0; i < std::min(map.kinds.size(), tones.size()); ++i)
    entry(map.kinds[i], [&] { canvas.fill(x, y - 10, 18, 12, tones[i]); });
  if (!map.frame.empty())
    entry(map.frame, [&] { canvas.polyline({{x, y - 4}, {x + 18, y - 4}}, red, 2, 7); });
  const double bar = nice_step(90 / scale);
  canvas.polyline({{x, y - 8}, {x, y - 4}, {x + bar * scale, y - 4}, {x + bar * scale, y - 8}},
                  black, 1.5);
  canvas.text(x + bar * scale + 8, y, number(bar, bar) + " mm", 12, black);
  for (std::size_t i = 0; i < map.notes.size(); ++i)
    canvas.text(margin_left, y + line * (static_cast<double>(i) + 1.3), printable(map.notes[i]), 12,
                grey);
}

}  // namespace

Expected<std::string> draw(const Map& map) {
  double wide = 0, high = 0;
  for (const MapPlane& p : map.planes) {
    wide += width_of(p);
    high = std::max(high, height_of(p));
  }
  if (!(wide > 0 && high > 0))
    return unexpected(make_error("input", "there is nothing to be drawn"));
  const double gaps = margin_left + between * static_cast<double>(map.planes.size());
  constexpr double highest = 900;  // pixels
  const double scale = std::min((map.width - gaps) / wide, highest / high);
  const double bottom = margin_top + high * scale;
  const double end = bottom + below_plane + line * (static_cast<double>(map.notes.size()) + 1.5);
  Canvas canvas(map.width, static_cast<int>(std::ceil(end)));
  canvas.text(margin_left, 30, printable(map.title), 16, black, Align::left, true);
  double left = margin_left;
  for (const MapPlane& p : map.planes) {
    PlaneDrawing(canvas, p, left, bottom, scale).draw();
    left += width_of(p) * scale + between;
  }
  legend(canvas, map, scale, bottom + below_plane);
  return canvas.png();
}

}  // namespace aircut::logbook
