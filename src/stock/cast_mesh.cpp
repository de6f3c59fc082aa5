// Casting a closed mesh into rays.
//
// The mesh's vertices are brought to whole quanta; the rays run through nodes, which are whole
// quanta too. So "which side of an edge is the ray on" is integer arithmetic without rounding, and
// a ray through an edge or a vertex is decided as if it had been moved by an infinitely small step
// (up, and by an infinitely smaller one to the left): every edge is looked at from its lower end
// (in x, then y) by both of its triangles, and a ray on it counts as left of it. Each ray then
// crosses a closed mesh consistently, and is inside where it entered more often than it left.
#include <algorithm>
#include <cmath>

#include "stock/solid.h"

namespace aircut::stock {
namespace {

using Int = std::int64_t;
using Point = std::array<Int, 3>;

struct Crossing {
  std::uint64_t ray;  ///< row × lanes + lane, over the whole lattice
  Int at;             ///< quanta
  int step;           ///< +1 in, −1 out
  NormalCode normal;
};

/// Whether p is left of the edge a → b, in the plane of the coordinates (u, v).
bool left_of(const Point& a, const Point& b, Int pu, Int pv, int u, int v) {
  const bool swapped = std::pair(b[u], b[v]) < std::pair(a[u], a[v]);
  const Point& from = swapped ? b : a;
  const Point& to = swapped ? a : b;
  const Int area = (to[u] - from[u]) * (pv - from[v]) - (to[v] - from[v]) * (pu - from[u]);
  return (area >= 0) != swapped;
}

struct Cast {
  const Lattice& lattice;
  int axis, u, v;  ///< the rays' direction; of the lanes; of the rows
  std::vector<Crossing> crossings;

  Cast(const Lattice& l, int a) : lattice(l), axis(a), u(a == 0 ? 1 : 0), v(a == 2 ? 1 : 2) {}

  std::uint64_t lanes() const { return static_cast<std::uint64_t>(lattice.bricks[u]) * cells; }

  /// Index of the first node at or after a coordinate.
  static Int first_node(Int q) {
    const Int half = quanta_per_cell / 2;
    return q <= half ? 0 : (q - half + quanta_per_cell - 1) / quanta_per_cell;
  }

  void add(const Point& a, const Point& b, const Point& c) {
    const Int lane_end = lattice.bricks[u] * cells, row_end = lattice.bricks[v] * cells;
    const auto [u0, u1] = std::minmax({a[u], b[u], c[u]});
    const auto [v0, v1] = std::minmax({a[v], b[v], c[v]});
    // The normal's part along the axis, as seen in the (u, v) plane: its sign says in or out.
    const Int area = (b[u] - a[u]) * (c[v] - a[v]) - (b[v] - a[v]) * (c[u] - a[u]);
    if (area == 0) return;
    const Vec3 n = normal(a, b, c);
    const NormalCode code = encode_normal(n);
    for (Int row = first_node(v0); row < row_end && node(row) <= v1; ++row)
      for (Int lane = first_node(u0); lane < lane_end && node(lane) <= u1; ++lane) {
        const Int pu = node(lane), pv = node(row);
        const bool left = left_of(a, b, pu, pv, u, v);
        if (left != (area > 0) || left_of(b, c, pu, pv, u, v) != left ||
            left_of(c, a, pu, pv, u, v) != left)
          continue;
        const double at = static_cast<double>(a[axis]) - (n[u] * static_cast<double>(pu - a[u]) +
                                                          n[v] * static_cast<double>(pv - a[v])) /
                                                             n[axis];
        const auto [low, high] = std::minmax({a[axis], b[axis], c[axis]});
        crossings.push_back(
            {static_cast<std::uint64_t>(row) * lanes() + static_cast<std::uint64_t>(lane),
             std::clamp<Int>(std::llround(at), low, high), n[axis] < 0 ? 1 : -1, code});
      }
  }

  static Int node(Int i) { return i * quanta_per_cell + quanta_per_cell / 2; }

  static Vec3 normal(const Point& a, const Point& b, const Point& c) {
    const auto d = [](const Point& p, const Point& q) {
      return Vec3(static_cast<double>(q[0] - p[0]), static_cast<double>(q[1] - p[1]),
                  static_cast<double>(q[2] - p[2]));
    };
    return d(a, b).cross(d(a, c)).normalized();
  }

  /// Calls f(ray, lo, normal_lo, hi, normal_hi) for each stretch of material.
  template <class F>
  void each_stretch(F f) {
    std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
      return std::tie(a.ray, a.at, a.step, a.normal) < std::tie(b.ray, b.at, b.step, b.normal);
    });
    int depth = 0;
    Crossing entry{};
    for (const Crossing& c : crossings) {
      if (depth == 0) entry = c;
      depth += c.step;
      if (depth == 0 && c.at > entry.at && entry.step > 0)
        f(c.ray, entry.at, entry.normal, c.at, c.normal);
    }
  }
};

}  // namespace

void cast_mesh(const TriangleMesh& mesh, const Lattice& lattice, std::vector<BrickSlot>& table) {
  const TriangleMesh closed = welded(mesh);
  std::vector<Point> points;
  points.reserve(closed.vertices.size());
  for (const Vec3& vertex : closed.vertices) {
    const Vec3 q = (vertex - lattice.origin) / lattice.quantum();
    points.push_back({std::llround(q.x()), std::llround(q.y()), std::llround(q.z())});
  }
  std::vector<std::unique_ptr<Brick>> bricks(table.size());
  const auto brick_at = [&](const std::array<int, 3>& b) -> Brick& {
    auto& brick = bricks[lattice.index(b[0], b[1], b[2])];
    if (!brick) brick = std::make_unique<Brick>();
    return *brick;
  };
  for (int axis = 0; axis < 3; ++axis) {
    Cast cast(lattice, axis);
    for (const auto& t : closed.triangles) cast.add(points[t[0]], points[t[1]], points[t[2]]);
    const auto f = static_cast<std::size_t>(axis);
    cast.each_stretch([&](std::uint64_t ray, Int lo, NormalCode n_lo, Int hi, NormalCode n_hi) {
      const int lane = static_cast<int>(ray % cast.lanes()),
                row = static_cast<int>(ray / cast.lanes());
      const int last = lattice.bricks[f] - 1;
      std::array<int, 3> b{};
      b[static_cast<std::size_t>(cast.u)] = lane / cells;
      b[static_cast<std::size_t>(cast.v)] = row / cells;
      const int local = row % cells * cells + lane % cells;
      for (Int k = std::max<Int>(lo / brick_quanta, 0); k <= last && k * brick_quanta < hi; ++k) {
        b[f] = static_cast<int>(k);
        const Int from = std::max<Int>(lo - k * brick_quanta, 0);
        const Int to = std::min<Int>(hi - k * brick_quanta, brick_quanta);
        if (from >= to) continue;
        RayFamily& family = brick_at(b).family[f];
        if (from == 0 && to == brick_quanta && !family.block) {
          auto& bits = family.full[static_cast<std::size_t>(local / cells)];
          bits = static_cast<std::uint16_t>(bits | 1u << (local % cells));
          continue;
        }
        family.make_block();
        add_interval(
            family, local,
            {static_cast<std::uint16_t>(from), static_cast<std::uint16_t>(to), n_lo, n_hi});
      }
    });
  }
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (!bricks[i]) continue;
    settle(*bricks[i]);
    bool full = true;
    for (const RayFamily& family : bricks[i]->family)
      for (const std::uint16_t row : family.full) full = full && !family.block && row == 0xffff;
    if (full)
      table[i].set(BrickSlot::full);
    else if (!bricks[i]->empty())
      table[i].set(std::move(bricks[i]));
  }
}

}  // namespace aircut::stock
