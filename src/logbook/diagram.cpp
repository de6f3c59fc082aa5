// Curves over one pair of axes: gridlines at round numbers, a colour per curve, names on the right.
#include <algorithm>
#include <cmath>

#include "logbook/canvas.h"
#include "logbook/logbook.h"
#include "logbook/scale.h"

namespace aircut::logbook {
namespace {

constexpr double left = 76, top = 52, bottom = 56;

struct Axis {
  double low = 0, high = 1;
  double from = 0, to = 1;  // pixels
  double at(double value) const { return from + (to - from) * (value - low) / (high - low); }
  double step(double pixels) const {
    return nice_step((high - low) * pixels / std::abs(to - from));
  }
};

// A range that holds all values with some room.
Axis axis_of(const Diagram& diagram, bool x, double room) {
  Axis axis{1e300, -1e300, 0, 1};
  for (const Curve& curve : diagram.curves)
    for (const auto& point : curve.points) {
      const double value = x ? point.first : point.second;
      axis.low = std::min(axis.low, value);
      axis.high = std::max(axis.high, value);
    }
  const double span = axis.high - axis.low;
  const double more = span > 0 ? room * span : std::max(1e-6, 0.1 * std::abs(axis.low));
  axis.low -= more;
  axis.high += more;
  return axis;
}

void grid(Canvas& canvas, const Axis& x, const Axis& y) {
  const double dx = x.step(80), dy = y.step(50);
  for (double k = std::ceil(x.low / dx - 1e-9); k * dx <= x.high + 1e-9 * dx; ++k) {
    canvas.polyline({{x.at(k * dx), y.from}, {x.at(k * dx), y.to}}, pale, 1);
    canvas.text(x.at(k * dx), y.from + 18, number(k * dx, dx), 12, grey, Align::middle);
  }
  for (double k = std::ceil(y.low / dy - 1e-9); k * dy <= y.high + 1e-9 * dy; ++k) {
    canvas.polyline({{x.from, y.at(k * dy)}, {x.to, y.at(k * dy)}}, k == 0 ? grey : pale, 1);
    canvas.text(x.from - 8, y.at(k * dy) + 4, number(k * dy, dy), 12, grey, Align::right);
  }
  canvas.polyline({{x.from, y.to}, {x.from, y.from}, {x.to, y.from}}, grey, 1);
}

}  // namespace

Expected<std::string> draw(const Diagram& diagram) {
  const bool empty = std::all_of(diagram.curves.begin(), diagram.curves.end(),
                                 [](const Curve& c) { return c.points.empty(); });
  if (empty) return unexpected(make_error("input", "there is nothing to be drawn"));
  Canvas canvas(diagram.width, diagram.height);
  Axis x = axis_of(diagram, true, 0), y = axis_of(diagram, false, 0.06);
  double names = 30;
  for (const Curve& curve : diagram.curves)
    names = std::max(names, canvas.text_width(printable(curve.name), 11) + 20);
  x.from = left;
  x.to = std::max(left + 100, diagram.width - names);
  y.from = diagram.height - bottom;
  y.to = top;
  canvas.text(left, 24, printable(diagram.title), 15, black, Align::left, true);
  canvas.text(left, 42, printable(diagram.y_name), 12, black);
  canvas.text((x.from + x.to) / 2, diagram.height - 16, printable(diagram.x_name), 12, black,
              Align::middle);
  grid(canvas, x, y);
  // Names stand where their curve ends, or below the one before.
  std::vector<std::pair<double, std::size_t>> ends;
  for (std::size_t i = 0; i < diagram.curves.size(); ++i) {
    const Curve& curve = diagram.curves[i];
    if (curve.points.empty()) continue;
    std::vector<Spot> spots;
    for (const auto& [px, py] : curve.points) spots.push_back({x.at(px), y.at(py)});
    const Colour colour = colours[i % colours.size()];
    // The eighth curve begins the colours again, dashed.
    canvas.polyline(spots, colour, 2, i / colours.size() % 2 == 0 ? 0 : 6);
    if (spots.size() <= 40)
      for (const Spot& spot : spots) canvas.fill(spot.x - 2.5, spot.y - 2.5, 5, 5, colour);
    ends.emplace_back(spots.back().y, i);
  }
  std::sort(ends.begin(), ends.end());
  double last = -1e300;
  for (const auto& [end, i] : ends) {
    last = std::max(end, last + 15);
    canvas.text(x.to + 10, last + 4, printable(diagram.curves[i].name), 11,
                colours[i % colours.size()]);
  }
  return canvas.png();
}

}  // namespace aircut::logbook
