#include "cli/workspace_picture.h"

#include <cmath>

#include "logbook/logbook.h"

namespace aircut::cli {

namespace {

using Place = std::array<int, 3>;

std::string axis_name(std::size_t axis) { return std::string(1, "XYZ"[axis]) + ", mm"; }

// The plane of axes u (to the right) and v (up) through `at`.
logbook::MapPlane plane_of(const machine::Workspace& w,
                           const std::optional<machine::Workspace>& upright,
                           const machine::GridBox& box, const Place& at, std::size_t u,
                           std::size_t v) {
  const std::size_t across = 3 - u - v;
  logbook::MapPlane out;
  const Vec3 first = w.place(0, 0, 0), here = w.place(at[0], at[1], at[2]);
  const auto of = [](const Vec3& p, std::size_t axis) { return p[static_cast<int>(axis)]; };
  out.title = std::string(1, "XYZ"[across]) + " = " +
              shortest(std::round(of(here, across) * 1000) / 1000) + " mm";
  out.x_name = axis_name(u);
  out.y_name = axis_name(v);
  out.x = of(first, u);
  out.y = of(first, v);
  out.pitch = w.pitch();
  out.columns = w.count()[u];
  out.rows = w.count()[v];
  Place p = at;
  for (p[v] = 0; p[v] < out.rows; ++p[v])
    for (p[u] = 0; p[u] < out.columns; ++p[u]) {
      const bool in = w.in(p[0], p[1], p[2]);
      const bool at_all = upright && upright->in(p[0], p[1], p[2]);
      out.cells.push_back(!upright ? (in ? 1 : 0) : in ? 2 : at_all ? 1 : 0);
    }
  if (box.points() > 0) {
    const double half = w.pitch() / 2;
    const Vec3 low = w.place(box.first[0], box.first[1], box.first[2]);
    const Vec3 high = w.place(box.last[0], box.last[1], box.last[2]);
    out.frame = {of(low, u) - half, of(low, v) - half, of(high, u) + half, of(high, v) + half};
  }
  return out;
}

}  // namespace

Expected<std::string> workspace_picture(const machine::Machine& machine,
                                        const machine::Workspace& w,
                                        const std::optional<machine::Workspace>& upright,
                                        const std::vector<std::string>& notes) {
  logbook::Map map;
  map.title = "Workspace of " + machine.name();
  map.kinds = {upright ? "reached without a tilt" : "reached"};
  if (upright) map.kinds.push_back("reached with every tilt");
  map.notes = notes;
  const machine::GridBox box = w.largest_box();
  if (box.points() > 0) map.frame = "largest box";
  Place middle;
  for (std::size_t a = 0; a < 3; ++a)
    middle[a] = box.points() > 0 ? (box.first[a] + box.last[a]) / 2 : w.count()[a] / 2;
  // X to the right and Z up, as the machines' drawings are; X and Y from above; Y and Z.
  for (const auto& [u, v] : {std::pair<std::size_t, std::size_t>(0, 2), {1, 2}, {0, 1}})
    if (w.count()[u] > 1 && w.count()[v] > 1)
      map.planes.push_back(plane_of(w, upright, box, middle, u, v));
  if (map.planes.empty())
    return unexpected(make_error(
        "usage", "a picture needs ranges of at least two of --x, --y and --z, not points"));
  return logbook::draw(map);
}

}  // namespace aircut::cli
