// The pieces that the material is in.
//
// The intervals on the Z rays are visited row by row, as in labelling the components of a picture:
// an interval takes the label of one that it overlaps on the ray before it or on the same ray of
// the row before; where it overlaps several, their labels are joined (union by the smaller number).
// Only two rows are kept, and a label for each new beginning.
#include <algorithm>

#include "stock/impl.h"

namespace aircut::stock {
namespace {

/// Material of a Z ray, quanta from the lattice's lower end, and its label.
struct Run {
  std::int64_t from = 0, to = 0;
  std::size_t label = 0;
};
using Ray = std::vector<Run>;

class Labels {
 public:
  std::size_t fresh() {
    parent_.push_back(parent_.size());
    sums_.emplace_back();
    return parent_.size() - 1;
  }
  std::size_t root(std::size_t label) {
    while (parent_[label] != label) label = parent_[label] = parent_[parent_[label]];
    return label;
  }
  std::size_t join(std::size_t a, std::size_t b) {
    a = root(a);
    b = root(b);
    if (a == b) return a;
    if (b < a) std::swap(a, b);
    parent_[b] = a;
    sums_[a].quanta += sums_[b].quanta;
    sums_[a].box.extend(sums_[b].box);
    return a;
  }
  Separate& sum(std::size_t label) { return sums_[root(label)]; }
  std::vector<Separate> roots() const {
    std::vector<Separate> out;
    for (std::size_t i = 0; i < parent_.size(); ++i)
      if (parent_[i] == i) out.push_back(sums_[i]);
    return out;
  }

 private:
  std::vector<std::size_t> parent_;
  std::vector<Separate> sums_;
};

/// The Z rays over one row of bricks: rays[row][i].
class BrickRow {
 public:
  BrickRow(const Stock::Impl& stock, int j) : width_(stock.lattice.bricks[0] * cells) {
    for (auto& row : rays_) row.resize(static_cast<std::size_t>(width_));
    std::vector<Interval> found;
    for (int k = 0; k < stock.lattice.bricks[2]; ++k)
      for (int i = 0; i < stock.lattice.bricks[0]; ++i) {
        const bool full = stock.table[stock.lattice.index(i, j, k)].is(BrickSlot::full);
        std::unique_ptr<Brick> scratch;
        const Brick* brick = stock.look(i, j, k, scratch);
        if (!brick && !full) continue;
        for (int ray = 0; ray < rays; ++ray) {
          found.clear();
          if (brick)
            brick->family[2].intervals(ray, found);
          else
            found.push_back({0, brick_quanta, 0, 0});
          for (const Interval& v : found)
            append(rays_[static_cast<std::size_t>(ray / cells)]
                        [static_cast<std::size_t>(i * cells + ray % cells)],
                   std::int64_t{k} * brick_quanta + v.lo, std::int64_t{k} * brick_quanta + v.hi);
        }
      }
  }
  std::vector<Ray>& row(int row) { return rays_[static_cast<std::size_t>(row)]; }

 private:
  static void append(Ray& ray, std::int64_t from, std::int64_t to) {
    if (from >= to) return;
    if (!ray.empty() && ray.back().to == from)
      ray.back().to = to;
    else
      ray.push_back({from, to, 0});
  }
  int width_;
  std::array<std::vector<Ray>, cells> rays_;
};

constexpr std::size_t none = static_cast<std::size_t>(-1);

/// Joins what a run overlaps on a neighbouring ray to its label.
void meet(const Run& run, const Ray& neighbour, std::size_t& label, Labels& labels) {
  for (const Run& other : neighbour)
    if (std::max(run.from, other.from) < std::min(run.to, other.to))
      label = label == none ? labels.root(other.label) : labels.join(label, other.label);
}

}  // namespace

std::vector<Separate> Stock::pieces(double least) const {
  const Lattice& lattice = impl_->lattice;
  Labels labels;
  std::vector<Ray> before;
  for (int j = 0; j < lattice.bricks[1]; ++j) {
    BrickRow bricks(*impl_, j);
    for (int row = 0; row < cells; ++row) {
      std::vector<Ray>& now = bricks.row(row);
      const double y = lattice.origin.y() + (j * cells + row + 0.5) * lattice.pitch;
      for (std::size_t i = 0; i < now.size(); ++i)
        for (Run& run : now[i]) {
          std::size_t label = none;
          if (i > 0) meet(run, now[i - 1], label, labels);
          if (!before.empty()) meet(run, before[i], label, labels);
          run.label = label == none ? labels.fresh() : label;
          Separate& sum = labels.sum(run.label);
          sum.quanta += run.to - run.from;
          const double x = lattice.origin.x() + (static_cast<double>(i) + 0.5) * lattice.pitch;
          for (const std::int64_t z : {run.from, run.to})
            sum.box.extend(
                Vec3(x, y, lattice.origin.z() + static_cast<double>(z) * lattice.quantum()));
        }
      before = std::move(now);
    }
  }
  std::vector<Separate> out = labels.roots();
  for (Separate& piece : out) piece.volume = volume_of(piece.quanta);
  std::erase_if(out, [&](const Separate& piece) { return piece.volume < least; });
  std::stable_sort(out.begin(), out.end(),
                   [](const Separate& a, const Separate& b) { return a.quanta > b.quanta; });
  return out;
}

}  // namespace aircut::stock
