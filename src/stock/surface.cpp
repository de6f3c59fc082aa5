// The ends of all rays of one direction: a line of bricks along that direction at a time, so that
// intervals are joined over the bricks' borders and each brick is looked at once.
#include "stock/impl.h"

namespace aircut::stock {

void Stock::each_end(int axis, const std::function<void(const Vec3&)>& see) const {
  const Lattice& lattice = impl_->lattice;
  const auto along = static_cast<std::size_t>(axis);
  const std::size_t u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;  // of lanes, of rows
  std::vector<std::unique_ptr<Brick>> scratch(static_cast<std::size_t>(lattice.bricks[along]));
  std::vector<const Brick*> line(scratch.size());
  std::vector<bool> full(scratch.size());
  std::vector<Interval> intervals;
  std::array<int, 3> b{};
  const auto run_ray = [&](int row, int lane) {
    Vec3 point;
    const auto centre = [&](std::size_t a, int cell) {
      return lattice.origin[static_cast<int>(a)] + (b[a] * cells + cell + 0.5) * lattice.pitch;
    };
    point[static_cast<int>(u)] = centre(u, lane);
    point[static_cast<int>(v)] = centre(v, row);
    const auto tell = [&](std::int64_t at) {
      point[axis] = lattice.origin[axis] + static_cast<double>(at) * lattice.quantum();
      see(point);
    };
    std::int64_t end = -1;  // of the material so far; −1: none is open
    for (std::size_t n = 0; n < line.size(); ++n) {
      intervals.clear();
      if (line[n])
        line[n]->family[along].intervals(row * cells + lane, intervals);
      else if (full[n])
        intervals.push_back({0, brick_quanta, 0, 0});
      const std::int64_t base = static_cast<std::int64_t>(n) * brick_quanta;
      for (const Interval& part : intervals) {
        if (end != base + part.lo) {
          if (end >= 0) tell(end);
          tell(base + part.lo);
        }
        end = base + part.hi;
      }
    }
    if (end >= 0) tell(end);
  };
  for (b[v] = 0; b[v] < lattice.bricks[v]; ++b[v])
    for (b[u] = 0; b[u] < lattice.bricks[u]; ++b[u]) {
      for (std::size_t n = 0; n < line.size(); ++n) {
        b[along] = static_cast<int>(n);
        line[n] = impl_->look(b[0], b[1], b[2], scratch[n]);
        full[n] = impl_->table[lattice.index(b[0], b[1], b[2])].is(BrickSlot::full);
      }
      for (int row = 0; row < cells; ++row)
        for (int lane = 0; lane < cells; ++lane) run_ray(row, lane);
    }
}

}  // namespace aircut::stock
