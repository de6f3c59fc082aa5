// Comparing a stock with the part that it is to become.
//
//   during the cut:  the part as a stock of its own. What a piece would take from it lies inside
//                    the part; how deep is the distance of that place from the part's surface.
//   in the end:      every end of a ray of the stock lies on its surface, exact to a quantum. Its
//                    distance from the part's surface is a gouge inside and excess outside.
//
// Both look at rays. A difference that no ray passes, narrower than a pitch in all directions, is
// not seen; of a wider one the deepest place may be missed by up to half a pitch sideways, so its
// true depth is at most half a pitch more. On faces along the lattice there is no such error.
//
// Points beyond a tolerance are put into cells of two pitches; cells that touch are one spot.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include "stock/impl.h"
#include "stock/mesh_distance.h"

namespace aircut::stock {
namespace {

constexpr std::size_t most_spots = 100;

class Spots {
 public:
  explicit Spots(double cell) : cell_(cell) {}

  void add(const Vec3& point, double depth) {
    const auto [at, fresh] = cells_.try_emplace(key(point));
    Spot& spot = at->second;
    spot.box.extend(point);
    // Of equal depths the place that comes first in X, Y, Z, so that the order of points is no
    // matter.
    const auto rank = [](double d, const Vec3& p) { return std::tuple(-d, p.x(), p.y(), p.z()); };
    if (!fresh && !(rank(depth, point) < rank(spot.depth, spot.point))) return;
    spot.depth = depth;
    spot.point = point;
  }

  std::vector<Spot> joined(std::size_t& dropped) {
    std::vector<Spot> out;
    while (!cells_.empty()) {
      Spot spot = cells_.begin()->second;
      std::vector<Key> open = {cells_.begin()->first};
      cells_.erase(cells_.begin());
      while (!open.empty()) {
        const Key at = open.back();
        open.pop_back();
        for (int n = 0; n < 27; ++n) {
          const auto next =
              cells_.find({at[0] + n % 3 - 1, at[1] + n / 3 % 3 - 1, at[2] + n / 9 - 1});
          if (next == cells_.end()) continue;
          const Spot& part = next->second;
          spot.box.extend(part.box);
          if (worse(part, spot)) {
            spot.depth = part.depth;
            spot.point = part.point;
          }
          open.push_back(next->first);
          cells_.erase(next);
        }
      }
      out.push_back(spot);
    }
    std::sort(out.begin(), out.end(), worse);
    if (out.size() > most_spots) {
      dropped += out.size() - most_spots;
      out.resize(most_spots);
    }
    return out;
  }

 private:
  using Key = std::array<std::int64_t, 3>;
  struct Hash {
    std::size_t operator()(const Key& k) const {
      std::uint64_t h = 0;
      for (const std::int64_t v : k)
        h = (h ^ static_cast<std::uint64_t>(v)) * 0x9e3779b97f4a7c15u ^ h >> 31;
      return h;
    }
  };
  static bool worse(const Spot& a, const Spot& b) {
    return std::tuple(-a.depth, a.point.x(), a.point.y(), a.point.z()) <
           std::tuple(-b.depth, b.point.x(), b.point.y(), b.point.z());
  }
  Key key(const Vec3& p) const {
    Key out;
    for (std::size_t a = 0; a < 3; ++a)
      out[a] = static_cast<std::int64_t>(std::floor(p[static_cast<int>(a)] / cell_));
    return out;
  }

  double cell_;
  std::unordered_map<Key, Spot, Hash> cells_;
};

}  // namespace

struct Part::Impl {
  MeshDistance surface;
  Stock left;        ///< of the part, when what went into it is taken off
  double taken = 0;  ///< mm, at least as deep as that is
};

Part::Part(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Part::Part(Part&&) noexcept = default;
Part& Part::operator=(Part&&) noexcept = default;
Part::~Part() = default;

Expected<Part> Part::make(std::shared_ptr<const TriangleMesh> mesh, double pitch,
                          const StockOptions& options) {
  auto solid = Stock::make(MeshSolid{mesh}, pitch, options);
  if (!solid) return unexpected(solid.error());
  return Part(std::make_unique<Impl>(Impl{MeshDistance(std::move(mesh)), std::move(*solid), 0}));
}

double Part::outside(const Vec3& point) const { return impl_->surface.outside(point); }

Expected<Touch> Part::cut_into(const Piece& piece, double ignore) const {
  // The rays of the part are exact to a quantum, so what they lose is inside; no need to ask.
  return impl_->left.deepest(
      piece, [&](const Vec3& p) { return impl_->surface.distance(p); }, ignore, impl_->taken);
}

Expected<void> Part::take(const Piece& piece, double depth) {
  impl_->taken = std::max(impl_->taken, depth + impl_->left.pitch());
  auto taken = impl_->left.cut({&piece, 1});
  if (!taken) return unexpected(taken.error());
  return {};
}

Spot Part::outside_of(const TriangleMesh& raw) const {
  const MeshDistance around(std::make_shared<TriangleMesh>(raw));
  Spot worst;
  for (int axis = 0; axis < 3; ++axis)
    impl_->left.each_end(axis, [&](const Vec3& p) {
      if (around.inside(p)) return;
      const double d = around.distance(p);
      if (d <= worst.depth) return;
      worst.depth = d;
      worst.point = p;
    });
  return worst;
}

namespace {

using See = std::function<void(const Vec3&)>;

/// Compares places of a surface that `each_place` gives, neighbours after one another.
Deviation compare_places(const MeshDistance& part, double pitch, const PartTolerances& tolerances,
                         const std::function<void(const See&)>& each_place) {
  Deviation out;
  Spots gouges(2 * pitch), excesses(2 * pitch);
  const double least = std::min(tolerances.gouge, tolerances.excess + tolerances.allowance);
  Vec3 last = Vec3::Constant(std::numeric_limits<double>::infinity());
  double last_distance = 0;
  each_place([&](const Vec3& p) {
    ++out.points;
    // Neighbouring ends are near to one another: that bounds the distance.
    const double distance = part.distance(p, last_distance + (p - last).norm());
    last = p;
    last_distance = distance;
    double& largest_gouge = out.gouge;
    if (distance <= std::min(least, std::min(largest_gouge, out.excess))) return;
    if (part.inside(p)) {
      largest_gouge = std::max(largest_gouge, distance);
      if (distance > tolerances.gouge) gouges.add(p, distance);
      return;
    }
    for (const Box3& box : tolerances.leave)
      if (box.contains(p)) return;
    out.excess = std::max(out.excess, distance);
    if (distance > tolerances.excess + tolerances.allowance) excesses.add(p, distance);
  });
  out.gouges = gouges.joined(out.gouges_dropped);
  out.excesses = excesses.joined(out.excesses_dropped);
  return out;
}

}  // namespace

Deviation Part::compare(const Stock& stock, const PartTolerances& tolerances) const {
  return compare_places(impl_->surface, stock.pitch(), tolerances, [&](const See& see) {
    for (int axis = 0; axis < 3; ++axis) stock.each_end(axis, see);
  });
}

Deviation Part::compare(const TurnedStock& stock, const PartTolerances& tolerances) const {
  constexpr int places = 8;
  return compare_places(impl_->surface, stock.pitch(), tolerances, [&](const See& see) {
    for (int i = 0; i < places; ++i) {
      const double angle = 2 * std::numbers::pi * i / places;
      const double x = std::cos(angle), y = std::sin(angle);
      stock.each_end([&](double r, double z) { see(Vec3(r * x, r * y, z)); });
    }
  });
}

std::vector<double> Part::outside(const TriangleMesh& mesh) const {
  std::vector<double> out;
  out.reserve(mesh.vertices.size());
  Vec3 last = Vec3::Constant(std::numeric_limits<double>::infinity());
  double last_distance = 0;
  for (const Vec3& p : mesh.vertices) {
    const double d = impl_->surface.distance(p, last_distance + (p - last).norm());
    last = p;
    last_distance = d;
    out.push_back(impl_->surface.inside(p) ? -d : d);
  }
  return out;
}

}  // namespace aircut::stock
