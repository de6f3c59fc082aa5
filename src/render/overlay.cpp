#include "render/overlay.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "render/path_lines.h"

namespace aircut::render {
namespace {

constexpr Ink dark{32, 38, 48, 1};
constexpr Ink soft{92, 101, 114, 1};
constexpr Ink white{255, 255, 255, 1};
constexpr Ink alarm_red{196, 18, 28, 1};

Ink with_alpha(Ink ink, double alpha) {
  ink.alpha = alpha;
  return ink;
}

struct Layout {
  double unit;  // pixels
  int text;     // pixels per em
  double px(double units) const { return unit * units; }
};

Layout layout_of(const Image& image) {
  const double unit = layout_scale(image.width, image.height);
  return {unit, std::max(8, static_cast<int>(std::lround(14 * unit)))};
}

// Text with a light rim, to be read on any ground.
void draw_rimmed(Image& image, const Fonts& fonts, double x, double y, std::string_view text,
                 Face face, int size, Ink ink) {
  for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}})
    fonts.draw(image, x + dx, y + dy, text, face, size, with_alpha(white, 0.65));
  fonts.draw(image, x, y, text, face, size, ink);
}

void draw_marker(Image& image, const Vec2& at, const Layout& layout) {
  const double r = layout.px(15), w = std::max(1.5, layout.px(2.4));
  const auto cross = [&](double width, Ink ink) {
    for (const Vec2& u : {Vec2(1, 0), Vec2(-1, 0), Vec2(0, 1), Vec2(0, -1)})
      draw_line(image, at + u * r * 0.62, at + u * r * 1.55, width, ink);
    draw_ring(image, at, r, width, ink);
    fill_disc(image, at, width * 0.9, ink);
  };
  cross(w + layout.px(2.6), with_alpha(white, 0.9));
  cross(w, alarm_red);
}

// Arrows along the world's axes as the camera sees them; those that point away are drawn first.
void draw_triad(Image& image, const View& view, const Fonts& fonts, const Layout& layout) {
  struct Arrow {
    const char* letter;
    Vec3 direction;  // camera frame
    Ink ink;
  };
  std::array<Arrow, 3> arrows = {{{"X", view.axes.col(0), {200, 40, 44, 1}},
                                  {"Y", view.axes.col(1), {38, 142, 60, 1}},
                                  {"Z", view.axes.col(2), {36, 92, 208, 1}}}};
  std::stable_sort(arrows.begin(), arrows.end(), [](const Arrow& a, const Arrow& b) {
    return a.direction.z() < b.direction.z();
  });
  const double reach = layout.px(44);
  const Vec2 origin(layout.px(66), image.height - layout.px(66));
  fill_disc(image, origin, reach * 1.32, with_alpha(white, 0.42));
  for (const Arrow& arrow : arrows) {
    const Vec2 tip = origin + reach * Vec2(arrow.direction.x(), -arrow.direction.y());
    const Vec2 along = tip - origin;
    const int size = static_cast<int>(std::lround(layout.text * 1.05));
    Vec2 letter_at = origin;
    if (along.norm() > layout.px(6)) {
      const Vec2 u = along.normalized(), side(-u.y(), u.x());
      const double head = std::min(layout.px(11), along.norm() * 0.6);
      draw_line(image, origin, tip - u * head * 0.8, layout.px(3), arrow.ink);
      fill_triangle(image, tip, tip - u * head + side * head * 0.42,
                    tip - u * head - side * head * 0.42, arrow.ink);
      letter_at = tip + u * layout.px(10);
    } else {
      letter_at = origin + Vec2(layout.px(10), layout.px(10));
      fill_disc(image, origin, layout.px(4), arrow.ink);
    }
    const double width = fonts.width(arrow.letter, Face::bold, size);
    draw_rimmed(image, fonts, letter_at.x() - width / 2, letter_at.y() + size * 0.36, arrow.letter,
                Face::bold, size, arrow.ink);
  }
  fill_disc(image, origin, layout.px(2.6), dark);
}

std::string length_text(double mm) { return fmt::format("{} mm", shortest(mm)); }

// The strip along the lower edge: a light ground for small print, at any picture's bottom.
constexpr double strip_height = 40, strip_bottom = 14, strip_inset = 12;

constexpr double triad_room = 138;  // at the left end

// Base line of its text; `raised` for a second strip above the first one.
double strip_base(const Image& image, const Layout& layout, double raised = 0) {
  return image.height - raised - layout.px(strip_bottom + 13);
}

void draw_strip(Image& image, double x, double width, const Layout& layout, double raised = 0) {
  fill_round_rect(image,
                  {x, image.height - raised - layout.px(strip_bottom + strip_height), width,
                   layout.px(strip_height)},
                  layout.px(6), with_alpha(white, 0.62));
}

int small_text(const Layout& layout) {
  return std::max(7, static_cast<int>(std::lround(layout.text - layout.px(2))));
}

// A ruler in black and white whose length is right at the camera's target, and the floor's grid as
// far as there is room. Returns the left end of what was drawn.
double draw_scale(Image& image, const Stage& stage, const Fonts& fonts, const Layout& layout) {
  const double mm = round_down_125(stage.view.mm_per_pixel * layout.px(190));
  const double length = mm / stage.view.mm_per_pixel;
  const double inset = layout.px(strip_inset), base = strip_base(image, layout);
  const double right = image.width - layout.px(16) - inset;
  const double room = right - inset - layout.px(triad_room);
  const int small = small_text(layout);
  std::string grid;
  if (stage.floor)
    grid = fmt::format("floor grid {} / {}", shortest(stage.floor->step),
                       length_text(stage.floor->step * 5));
  double grid_width = grid.empty() ? 0 : fonts.width(grid, Face::sans, small) + inset;
  if (length + grid_width > room) grid_width = 0;
  if (length > room) return image.width;
  const double left = right - length - grid_width;
  draw_strip(image, left - inset, right - left + 2 * inset, layout);
  const double height = std::max(3.0, std::round(layout.px(5))), y = std::round(base - height + 3);
  fill_round_rect(image, {right - length - 1, y - 1, length + 2, height + 2}, 1, dark);
  for (int i = 0; i < 4; i += 2)
    fill_round_rect(image, {right - length * (4 - i) / 4.0, y, length / 4, height}, 0, white);
  const std::string text = length_text(mm);
  fonts.draw(image, right - length / 2 - fonts.width(text, Face::sans, small) / 2, y - layout.px(5),
             text, Face::sans, small, dark);
  if (grid_width > 0) fonts.draw(image, left, base, grid, Face::sans, small, soft);
  return left - inset;
}

void draw_sample(Image& image, LineKind kind, double x, double y, double width,
                 const Layout& layout) {
  const auto c = path_colour(kind);
  const auto byte = [](float v) { return static_cast<unsigned char>(std::lround(v * 255)); };
  const Ink ink{byte(c[0]), byte(c[1]), byte(c[2]), 1};
  const auto stroke = [&](double from, double to) {
    draw_line(image, Vec2(x + from * width, y), Vec2(x + to * width, y), layout.px(2.2), ink);
  };
  if (kind != LineKind::rapid) return stroke(0, 1);
  stroke(0, 0.22);
  stroke(0.42, 0.62);
  stroke(0.82, 1);
}

// What the colours mean: of the kinds of lines that occur, and the scene's own rows; left of
// `limit`, or above it.
void draw_legend(Image& image, const Scene& scene, const Fonts& fonts, const Layout& layout,
                 double limit) {
  struct Row {
    LineKind kind;
    std::string text;
    std::optional<machine::Color> color = {};
  };
  const std::array<Row, 4> kinds = {{{LineKind::rapid, "rapid"},
                                     {LineKind::feed, "feed"},
                                     {LineKind::arc, "arc"},
                                     {LineKind::done, "done"}}};
  const int small = small_text(layout);
  const double sample = layout.px(26), patch = layout.px(12), gap = layout.px(7);
  const double space = layout.px(16);
  std::vector<Row> used;
  for (const Row& row : kinds)
    if (std::any_of(scene.lines.begin(), scene.lines.end(), [&](const DrawLine& line) {
          return line.kind == row.kind && !line.color && line.points.size() > 1;
        }))
      used.push_back(row);
  for (const LegendRow& row : scene.legend) used.push_back({LineKind::feed, row.text, row.color});
  if (used.empty()) return;
  double width = -space;
  for (const Row& row : used)
    width += (row.color ? patch : sample) + gap + fonts.width(row.text, Face::sans, small) + space;
  const double inset = layout.px(strip_inset);
  double x = layout.px(scene.triad ? triad_room + 8 : 16) + inset;
  const double raised = x + width + 2 * inset > limit ? layout.px(strip_height + 6) : 0;
  const double base = strip_base(image, layout, raised);
  draw_strip(image, x - inset, width + 2 * inset, layout, raised);
  for (const Row& row : used) {
    if (row.color)
      fill_round_rect(image, {x, base - patch * 0.85, patch, patch}, layout.px(2),
                      {row.color->r, row.color->g, row.color->b, 1});
    else
      draw_sample(image, row.kind, x, base - small * 0.36, sample, layout);
    x += (row.color ? patch : sample) + gap;
    x += fonts.draw(image, x, base, row.text, Face::sans, small, dark) + space;
  }
}

// A white plate with lines of text; the first one is bold.
struct Plate {
  std::vector<std::string> lines;
  double width = 0, height = 0;
};

constexpr double plate_inset = 12, line_height = 20;

Face face_of(std::size_t line) { return line == 0 ? Face::bold : Face::mono; }

Plate make_plate(const std::vector<std::string>& lines, const Fonts& fonts, const Layout& layout,
                 double most) {
  Plate out;
  if (lines.empty()) return out;
  const double room = most - 2 * layout.px(plate_inset);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    out.lines.push_back(fonts.fitted(lines[i], face_of(i), layout.text, room));
    out.width = std::max(out.width, fonts.width(out.lines.back(), face_of(i), layout.text));
  }
  out.width += 2 * layout.px(plate_inset);
  out.height = layout.px(line_height) * static_cast<double>(lines.size()) + layout.px(14);
  return out;
}

void draw_plate_ground(Image& image, const Rect& rect, const Layout& layout, Ink ink) {
  const Rect below{rect.x, rect.y + layout.px(2), rect.width, rect.height};
  fill_shadow(image, below, layout.px(6), layout.px(9), with_alpha(dark, 0.22));
  fill_round_rect(image, rect, layout.px(6), ink);
}

void draw_plate(Image& image, const Plate& plate, double x, double y, const Fonts& fonts,
                const Layout& layout) {
  if (plate.lines.empty()) return;
  draw_plate_ground(image, {x, y, plate.width, plate.height}, layout, with_alpha(white, 0.88));
  for (std::size_t i = 0; i < plate.lines.size(); ++i)
    fonts.draw(image, x + layout.px(plate_inset),
               y + layout.px(7) + layout.px(line_height) * (static_cast<double>(i) + 0.74),
               plate.lines[i], face_of(i), layout.text, dark);
}

void draw_caption(Image& image, const Caption& caption, const Fonts& fonts, const Layout& layout) {
  const double edge = layout.px(16);
  const double room = image.width - 3 * edge;
  // The right plate, mostly numbers, takes what it needs up to two fifths.
  const Plate right =
      make_plate(caption.right, fonts, layout, room * (caption.left.empty() ? 1 : 0.4));
  const Plate left = make_plate(caption.left, fonts, layout, room - right.width);
  draw_plate(image, left, edge, edge, fonts, layout);
  draw_plate(image, right, image.width - edge - right.width, edge, fonts, layout);
  if (caption.alarm.empty()) return;
  const double y = edge + (left.height > 0 ? left.height + layout.px(8) : 0);
  const bool beside = right.height + edge > y;
  const double most = room - (beside ? right.width : -edge);
  const int size = static_cast<int>(std::lround(layout.text * 1.07));
  const std::string text =
      fonts.fitted(caption.alarm, Face::bold, size, most - 2 * layout.px(plate_inset));
  const double width = fonts.width(text, Face::bold, size) + 2 * layout.px(plate_inset);
  draw_plate_ground(image, {edge, y, width, layout.px(32)}, layout, with_alpha(alarm_red, 0.94));
  fonts.draw(image, edge + layout.px(plate_inset), y + layout.px(21), text, Face::bold, size,
             white);
}

}  // namespace

double layout_scale(int width, int height) {
  return std::clamp(std::min(width / 1280.0, height / 800.0), 0.5, 16.0);
}

void draw_overlay(Image& image, const Scene& scene, const Stage& stage, const Fonts& fonts) {
  const Layout layout = layout_of(image);
  for (const DrawMarker& marker : scene.markers)
    if (marker.at.allFinite())
      if (const auto at = stage.view.pixel(marker.at)) draw_marker(image, *at, layout);
  double limit = image.width;
  if (scene.triad) {
    draw_triad(image, stage.view, fonts, layout);
    limit = draw_scale(image, stage, fonts, layout);
  }
  draw_legend(image, scene, fonts, layout, limit);
  draw_caption(image, scene.caption, fonts, layout);
}

}  // namespace aircut::render
