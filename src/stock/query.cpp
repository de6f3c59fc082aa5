// Questions: what a piece would take, and whether a body that must not touch is clear.
//
// The kernels of cutting run without writing. What they would take from a ray is a stretch of one
// of its intervals. A stretch that begins or ends where the material does is measured across the
// surface there as well, because a ray that grazes a wall is long in a body that hardly touches it.
//
// Between rays the surface is known to half a pitch, so a body grown by that and touching nothing
// is clear. A shank that follows the wall which its cutter made never passes that test. So where
// all that the grown body touches is smooth, a finer bound counts. An end of a ray is on a smooth
// patch when the ends of its neighbours lie near its tangent plane and look almost the same way; a
// neighbour may also be without material there, as at a rim, but not solid. Between such ends the
// surface leaves the chord by an eighth of their second difference; twice that is the gap that the
// body is grown by.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <unordered_map>

#include "stock/impl.h"
#include "stock/row.h"

namespace aircut::stock {
namespace {

constexpr double same_way = 0.9;    // cosine between normals of neighbours on a smooth patch
constexpr double off_plane = 0.35;  // of a pitch: from the tangent plane
constexpr double safety = 1.25;     // of the surface's bend between rays
constexpr double sees_best = 0.69;  // of two families across a wall, one is at least this steep
constexpr double steep = 0.5;       // cosine: a family sees a surface well from here on

using Index3 = std::array<int, 3>;

/// A ray of the lattice by its nodes (the one along it doesn't count), and a part of it in quanta.
struct Stretch {
  Family family;
  Index3 node;
  std::int64_t from, to;
  bool at_low, at_high;  ///< begins (ends) where the material does
  Vec3 normal_low, normal_high;
  double room;  ///< mm: the body reaches at most this far beyond the ray, sideways
};

class Query {
 public:
  explicit Query(const Stock::Impl& stock) : stock_(stock), lattice_(stock.lattice) {}

  /// Calls `see` for each stretch that the piece would take, until it returns false.
  void run(const Piece& piece, const std::function<bool(const Stretch&)>& see) {
    stopped_ = false;
    for (const Outline& body : piece.cutter->bodies()) {
      const Sweep sweep = Sweep::of(body, piece, lattice_, 0);
      each_column(sweep, lattice_, [&](int i, int j) {
        if (stopped_) return;
        const ColumnSweep column = ColumnSweep::of(sweep, lattice_, i, j);
        if (column.touches()) touch_column(column, i, j, see);
      });
    }
  }

  /// `enough` is asked after every stretch and may end it: then what is told is a part of it.
  Touch touch(const Piece& piece, const std::function<bool(const Touch&)>& enough = {}) {
    std::array<std::int64_t, 3> sums{};
    std::unordered_map<std::uint64_t, std::vector<std::pair<std::int64_t, std::int64_t>>> open;
    Touch out;
    std::int64_t deepest = 0;
    const auto measured = [&]() -> const Touch& {
      out.depth = static_cast<double>(deepest) * lattice_.quantum();
      out.volume = static_cast<double>(std::max({sums[0], sums[1], sums[2]})) * lattice_.quantum() *
                   lattice_.pitch * lattice_.pitch;
      return out;
    };
    const auto offer = [&](Family f, const Index3& node, std::int64_t from, std::int64_t to) {
      if (to - from <= deepest) return;
      deepest = to - from;
      out.point = place(f, node, static_cast<double>(from + to) / 2);
    };
    run(piece, [&](const Stretch& s) {
      sums[static_cast<std::size_t>(index_of(s.family))] += s.to - s.from;
      offer(s.family, s.node, s.from, s.to);
      out.across = std::max(out.across, across(s));
      if (s.from % brick_quanta == 0 || s.to % brick_quanta == 0)
        open[ray_key(s)].emplace_back(s.from, s.to);
      return !enough || !enough(measured());
    });
    for (auto& [key, parts] : open) {  // stretches go on over the bricks' borders
      std::sort(parts.begin(), parts.end());
      std::int64_t from = 0, to = -1;
      for (const auto& [a, b] : parts) {
        from = a == to ? from : a;
        to = b;
        offer(family_of(key), node_of(key), from, to);
      }
    }
    return measured();
  }

  /// Both ends of each stretch are seen from the tip when it passes them: along its way as far as
  /// they lie along it, and beside it.
  Engagement engagement(const Piece& piece) {
    const Vec3 way = piece.end - piece.start;
    const Vec3 plan = way - way.dot(piece.axis) * piece.axis;
    const double length = plan.norm();
    const bool sideways = length > 1e-9 && length > 1e-6 * way.norm();
    const Vec3 ahead = sideways ? Vec3(plan / length) : Vec3::Zero();
    const Vec3 left = piece.axis.cross(ahead);
    double low = std::numeric_limits<double>::infinity(), high = -low;
    double to_left = -low, to_right = -low;
    std::int64_t quanta = 0;
    run(piece, [&](const Stretch& s) {
      if (s.family == Family::z) quanta += s.to - s.from;
      for (const std::int64_t at : {s.from, s.to}) {
        const Vec3 seen = place(s.family, s.node, static_cast<double>(at)) - piece.start;
        if (!sideways) continue;
        const double t = std::clamp(seen.dot(ahead) / length, 0.0, 1.0);
        const double height = (seen - t * way).dot(piece.axis);
        low = std::min(low, height);
        high = std::max(high, height);
        to_left = std::max(to_left, seen.dot(left));
        to_right = std::max(to_right, -seen.dot(left));
      }
      return true;
    });
    Engagement out;
    out.volume = static_cast<double>(quanta) * lattice_.quantum() * lattice_.pitch * lattice_.pitch;
    if (low > high) return out;
    out.depth = high - low;
    out.left = to_left;
    out.right = to_right;
    return out;
  }

  /// stock.h, Stock::deepest.
  Touch deepest(const Piece& piece, const std::function<double(const Vec3&)>& depth_at,
                double ignore, double at_surface) {
    Touch out;
    double best = ignore;
    run(piece, [&](const Stretch& s) {
      const double length = static_cast<double>(s.to - s.from) * lattice_.quantum();
      if ((s.at_low || s.at_high) && length + at_surface <= best) return true;
      // The value changes by no more than the way, so a shallow place lets the next ones go.
      for (double way = 0;;) {
        const Vec3 point =
            place(s.family, s.node, static_cast<double>(s.from) + way / lattice_.quantum());
        const double depth = depth_at(point);
        if (depth > best) {
          best = out.depth = depth;
          out.point = point;
        }
        if (way >= length) return true;
        way = std::min(length, way + std::max(lattice_.pitch, best - depth));
      }
    });
    return out;
  }

  /// The gap between the rays around a stretch, mm; nothing where the surface isn't smooth.
  std::optional<double> gap_at(const Stretch& s) {
    if (s.at_low && s.at_high) return std::nullopt;  // thin: all of an interval
    if (!s.at_low && !s.at_high) return gap_over_border(s);
    const bool high = s.at_high;
    const Vec3 n = high ? s.normal_high : s.normal_low;
    const std::int64_t at = high ? s.to : s.from;
    int best = 0;
    n.cwiseAbs().maxCoeff(&best);
    const int axis = index_of(s.family);
    if (best == axis) return gap_of_end(axis, s.node, at, n);
    // Another family sees this surface better, when it has an end nearby that agrees.
    Index3 node = s.node;
    node[static_cast<std::size_t>(axis)] = static_cast<int>(at / quanta_per_cell);
    const std::int64_t middle =
        (2 * node[static_cast<std::size_t>(best)] + 1) * (quanta_per_cell / 2);
    const auto end = end_near(best, node, middle, n[best] > 0, 1.5 * quanta_per_cell);
    if (!end || end->second.dot(n) < same_way)
      return std::abs(n[axis]) > steep ? gap_of_end(axis, s.node, at, n) : std::nullopt;
    return gap_of_end(best, node, end->first, end->second);
  }

  /// A stretch that a brick's border cut off from the end of its material.
  std::optional<double> gap_over_border(const Stretch& s) {
    const int axis = index_of(s.family);
    for (const bool up : {false, true}) {
      const std::int64_t border = up ? s.to : s.from;
      if (border % brick_quanta != 0) continue;
      const auto end = end_near(axis, s.node, border, up, 1.5 * quanta_per_cell);
      if (end && std::abs(end->second[axis]) > sees_best)
        return gap_of_end(axis, s.node, end->first, end->second);
    }
    // Along a wall, which rays across it see: here is looked at one of them, the others that are
    // touched are looked at themselves.
    Index3 node = s.node;
    node[static_cast<std::size_t>(axis)] = static_cast<int>((s.from + s.to) / 2 / quanta_per_cell);
    for (int other = 0; other < 3; ++other) {
      if (other == axis) continue;
      const std::int64_t at =
          (2 * node[static_cast<std::size_t>(other)] + 1) * (quanta_per_cell / 2);
      for (const bool up : {false, true}) {
        const auto end = end_near(other, node, at, up, 1.5 * quanta_per_cell);
        if (end && std::abs(end->second[other]) > sees_best)
          return gap_of_end(other, node, end->first, end->second);
      }
    }
    return std::nullopt;
  }

  double across(const Stretch& s) const {
    const double length = static_cast<double>(s.to - s.from) * lattice_.quantum();
    if (s.at_low == s.at_high) return std::min(length, s.room);
    const Vec3& n = s.at_low ? s.normal_low : s.normal_high;
    return std::min(length * std::abs(n[index_of(s.family)]), s.room);
  }

 private:
  std::size_t at(const Index3& b) const { return lattice_.index(b[0], b[1], b[2]); }

  bool inside_table(const Index3& b) const {
    for (std::size_t a = 0; a < 3; ++a)
      if (b[a] < 0 || b[a] >= lattice_.bricks[a]) return false;
    return true;
  }

  const Brick* brick(const Index3& b) {
    if (!inside_table(b) || stock_.table[at(b)].is(BrickSlot::empty)) return nullptr;
    const BrickSlot& slot = stock_.table[at(b)];
    if (slot.brick()) return slot.brick();
    if (slot.is(BrickSlot::full)) {
      if (!solid_) {
        solid_ = std::make_unique<Brick>();
        for (RayFamily& family : solid_->family) family.full.fill(0xffff);
      }
      return solid_.get();
    }
    auto& filled = filled_[at(b)];
    if (!filled) filled = fill(stock_.solid, lattice_, b[0], b[1], b[2]);
    return filled.get();
  }

  static std::uint64_t ray_key(const Stretch& s) {
    std::uint64_t key = static_cast<std::uint64_t>(index_of(s.family));
    for (std::size_t a = 0; a < 3; ++a)
      key =
          key << 20 |
          (static_cast<int>(a) == index_of(s.family) ? 0u : static_cast<std::uint64_t>(s.node[a]));
    return key;
  }
  static Family family_of(std::uint64_t key) { return families[key >> 60]; }
  static Index3 node_of(std::uint64_t key) {
    const auto part = [&](int shift) { return static_cast<int>(key >> shift & 0xfffff); };
    return {part(40), part(20), part(0)};
  }

  Vec3 place(Family f, const Index3& node, double quanta) const {
    Vec3 out = lattice_.pitch * (Vec3(node[0], node[1], node[2]) + Vec3::Constant(0.5));
    out[index_of(f)] = quanta * lattice_.quantum();
    return out + lattice_.origin;
  }

  void touch_column(const ColumnSweep& sweep, int i, int j,
                    const std::function<bool(const Stretch&)>& see) {
    const double size = lattice_.brick_size();
    const std::size_t column = static_cast<std::size_t>(j) * lattice_.bricks[0] + i;
    for (int k = stock_.tops[column] - 1; k >= 0 && !stopped_; --k) {
      if ((k + 1) * size < sweep.floor) break;
      if (k * size > sweep.roof || stock_.table[lattice_.index(i, j, k)].is(BrickSlot::empty))
        continue;
      const Vec3 low = size * Vec3(i, j, k);
      if (sweep.tilted && sweep.tilted->misses({low, low + Vec3::Constant(size)})) continue;
      if (const Brick* here = brick({i, j, k})) touch_brick(*here, sweep, {i, j, k}, see);
    }
  }

  void touch_brick(const Brick& here, const ColumnSweep& sweep, const Index3& b,
                   const std::function<bool(const Stretch&)>& see) {
    const LocalSweep local = sweep.in_brick(lattice_, b[2]);
    const double bottom = b[2] * lattice_.brick_size();
    const double quanta = (sweep.floor - bottom) / lattice_.quantum() - 1;
    Chords chords;
    for (const Family f : families) {
      const RayFamily& rays_here = here.family[static_cast<std::size_t>(index_of(f))];
      const bool z = f == Family::z;
      const int end = z ? sweep.end_row : here.rows[static_cast<std::size_t>(index_of(f))];
      for (int row = z ? sweep.first_row : 0; row < end && !stopped_; ++row) {
        const double height = bottom + (row + 0.5) * lattice_.pitch;
        if (z ? quanta > here.z_tops[static_cast<std::size_t>(row)]
              : height < sweep.floor || height > sweep.roof)
          continue;
        if (rays_here.row_empty(row)) continue;
        const std::uint16_t *lo = rays_here.lows(row), *hi = rays_here.highs(row);
        const bool touched = sweep.tilted
                                 ? sweep.tilted->chords(lattice_, b, f, row, lo, hi, chords)
                             : z ? kernels().upright(local, row, lo, hi, chords)
                                 : kernels().level(local, f, row, lo, hi, chords);
        if (touched) stretches(rays_here, f, row, chords, sweep, b, see);
      }
    }
  }

  /// How far the cutter of an upright sweep reaches beyond a Z ray, in plan.
  double room_around(const ColumnSweep& sweep, int lane, int row) const {
    if (sweep.tilted) return std::numeric_limits<double>::infinity();
    const LocalSweep& local = sweep.local;
    const double x = (lane + 0.5) * local.pitch - local.foot[0];
    const double y = (row + 0.5) * local.pitch - local.foot[1];
    const double s = std::clamp(x * local.u[0] + y * local.u[1], local.s0, local.s1);
    return std::max(local.shape->radius - std::hypot(x - s * local.u[0], y - s * local.u[1]), 0.0);
  }

  void stretches(const RayFamily& rays_here, Family f, int row, const Chords& chords,
                 const ColumnSweep& sweep, const Index3& b,
                 const std::function<bool(const Stretch&)>& see) {
    const auto axis = static_cast<std::size_t>(index_of(f));
    for (int lane = 0; lane < cells && !stopped_; ++lane) {
      if (chords.a[lane] >= chords.b[lane]) continue;
      rays_here.intervals(row * cells + lane, intervals_);
      for (const Interval& v : intervals_) {
        const int from = std::max<int>(chords.a[lane], v.lo),
                  to = std::min<int>(chords.b[lane], v.hi);
        if (from >= to) continue;
        Stretch s;
        s.family = f;
        s.node = {b[0] * cells, b[1] * cells, b[2] * cells};
        s.node[axis == 0 ? 1 : 0] += lane;
        s.node[axis == 2 ? 1 : 2] += row;
        const std::int64_t base = std::int64_t{b[axis]} * brick_quanta;
        s.room = f == Family::z ? room_around(sweep, lane, row)
                                : std::numeric_limits<double>::infinity();
        s.from = base + from;
        s.to = base + to;
        s.at_low = from == v.lo && !(from == 0 && goes_on(f, s.node, b, -1));
        s.at_high = to == v.hi && !(to == brick_quanta && goes_on(f, s.node, b, 1));
        s.normal_low = normal_of(v.normal_lo, static_cast<int>(axis), -1);
        s.normal_high = normal_of(v.normal_hi, static_cast<int>(axis), 1);
        if (!see(s)) {
          stopped_ = true;
          return;
        }
      }
    }
  }

  static Vec3 normal_of(NormalCode code, int axis, double sign) {
    return code != 0 ? decode_normal(code) : Vec3(sign * Vec3::Unit(axis));
  }

  /// Whether the material of a ray goes on in the next brick along it.
  bool goes_on(Family f, const Index3& node, Index3 b, int by) {
    const auto axis = static_cast<std::size_t>(index_of(f));
    b[axis] += by;
    const Brick* next = brick(b);
    if (!next) return false;
    next->family[axis].intervals(ray_of(static_cast<int>(axis), node), neighbour_);
    if (neighbour_.empty()) return false;
    return by > 0 ? neighbour_.front().lo == 0 : neighbour_.back().hi == brick_quanta;
  }

  static int ray_of(int axis, const Index3& node) {
    return node[axis == 2 ? 1 : 2] % cells * cells + node[axis == 0 ? 1 : 0] % cells;
  }

  /// The end of a ray's material next to a place, of the kind that looks up (down) the axis.
  std::optional<std::pair<std::int64_t, Vec3>> end_near(int axis, const Index3& node,
                                                        std::int64_t at, bool up, double reach) {
    std::optional<std::pair<std::int64_t, Vec3>> best;
    const auto a = static_cast<std::size_t>(axis);
    for (int d = -1; d <= 1; ++d) {
      Index3 b = {node[0] / cells, node[1] / cells, node[2] / cells};
      for (std::size_t o = 0; o < 3; ++o)
        if (node[o] < 0) return best;
      b[a] = static_cast<int>(at / brick_quanta) + d;
      const Brick* here = brick(b);
      if (!here) continue;
      here->family[a].intervals(ray_of(axis, node), intervals_near_);
      for (const Interval& v : intervals_near_) {
        const std::int64_t q = std::int64_t{b[a]} * brick_quanta + (up ? v.hi : v.lo);
        if (static_cast<double>(std::abs(q - at)) > reach) continue;
        if (best && std::abs(best->first - at) <= std::abs(q - at)) continue;
        if ((up ? v.hi == brick_quanta : v.lo == 0) && goes_on(families[a], node, b, up ? 1 : -1))
          continue;
        best = {q, normal_of(up ? v.normal_hi : v.normal_lo, axis, up ? 1 : -1)};
      }
    }
    return best;
  }

  /// Whether a ray holds material from half a pitch under the surface expected there to a pitch
  /// over it.
  bool solid_near(int axis, const Index3& node, std::int64_t at, bool up) {
    const auto a = static_cast<std::size_t>(axis);
    const int under = up ? quanta_per_cell / 2 : quanta_per_cell;
    const int over = up ? quanta_per_cell : quanta_per_cell / 2;
    for (int d = -1; d <= 1; ++d) {
      Index3 b = {node[0] / cells, node[1] / cells, node[2] / cells};
      b[a] = static_cast<int>(at / brick_quanta) + d;
      const Brick* here = brick(b);
      if (!here) continue;
      here->family[a].intervals(ray_of(axis, node), intervals_near_);
      const std::int64_t base = std::int64_t{b[a]} * brick_quanta;
      for (const Interval& v : intervals_near_)
        if (base + v.lo < at + over && base + v.hi > at - under) return true;
    }
    return false;
  }

  /// The end of a neighbour `by` rays away that goes on with the patch around an end; nothing where
  /// the patch stops. `step` when the neighbour has another surface or stays solid there.
  std::optional<std::int64_t> neighbour_end(int axis, Index3 node, int lateral, int by,
                                            std::int64_t at, const Vec3& n, bool& step) {
    const auto l = static_cast<std::size_t>(lateral);
    node[l] += by;
    if (node[l] < 0 || node[l] >= lattice_.bricks[l] * cells) return std::nullopt;
    const double rise = -by * n[lateral] / n[axis];  // of the tangent plane, in pitches
    const auto expected =
        std::max<std::int64_t>(at + static_cast<std::int64_t>(rise * quanta_per_cell), 0);
    const bool up = n[axis] > 0;
    const auto end = end_near(axis, node, expected, up, off_plane * quanta_per_cell * std::abs(by));
    if (end && end->second.dot(n) >= same_way) return end->first;
    step = step || end || solid_near(axis, node, expected, up);
    return std::nullopt;
  }

  std::optional<double> gap_of_end(int axis, const Index3& node, std::int64_t at, const Vec3& n) {
    double bends = 0;
    for (int lateral = 0; lateral < 3; ++lateral) {
      if (lateral == axis) continue;
      bool step = false;
      const auto before = neighbour_end(axis, node, lateral, -1, at, n, step);
      const auto after = neighbour_end(axis, node, lateral, 1, at, n, step);
      if (step || (!before && !after)) return std::nullopt;
      std::optional<std::int64_t> bend;  // second difference of three ends in a row
      if (before && after) {
        bend = *before + *after - 2 * at;
      } else {
        const auto next = neighbour_end(axis, node, lateral, before ? -2 : 2, at, n, step);
        if (next) bend = *next + at - 2 * (before ? *before : *after);
      }
      if (!bend) return std::nullopt;
      bends += static_cast<double>(std::abs(*bend));
    }
    return (safety * bends / 8 + 1) * lattice_.quantum() * std::abs(n[axis]);
  }

  const Stock::Impl& stock_;
  const Lattice& lattice_;
  std::unique_ptr<Brick> solid_;
  std::unordered_map<std::size_t, std::unique_ptr<Brick>> filled_;
  std::vector<Interval> intervals_, intervals_near_, neighbour_;
  bool stopped_ = false;
};

/// Whether the body grown by `by` touches anything.
bool touches(Query& query, Piece piece, double by) {
  const CutterProfile grown = piece.cutter->grown(by);
  piece.cutter = &grown;
  bool any = false;
  query.run(piece, [&](const Stretch&) { return any = true, false; });
  return any;
}

}  // namespace

Expected<Touch> Stock::touch(const Piece& piece) const {
  if (auto ok = supported({&piece, 1}); !ok) return unexpected(ok.error());
  return Query(*impl_).touch(piece);
}

Expected<bool> Stock::takes(const Piece& piece, double depth, double volume) const {
  if (auto ok = supported({&piece, 1}); !ok) return unexpected(ok.error());
  const auto more = [&](const Touch& t) { return t.depth > depth || t.volume > volume; };
  return more(Query(*impl_).touch(piece, more));
}

Expected<Touch> Stock::deepest(const Piece& piece,
                               const std::function<double(const Vec3&)>& depth_at, double ignore,
                               double at_surface) const {
  if (auto ok = supported({&piece, 1}); !ok) return unexpected(ok.error());
  return Query(*impl_).deepest(piece, depth_at, ignore, at_surface);
}

Expected<Engagement> Stock::engagement(const Piece& piece) const {
  if (auto ok = supported({&piece, 1}); !ok) return unexpected(ok.error());
  return Query(*impl_).engagement(piece);
}

Expected<ContactAnswer> Stock::would_cut(const Piece& piece, double tolerance,
                                         HowDeep how_deep) const {
  if (auto ok = supported({&piece, 1}); !ok) return unexpected(ok.error());
  Query query(*impl_);
  ContactAnswer out;
  const double half = pitch() / 2;
  if (!touches(query, piece, half)) return out;  // holds for the body itself as well
  const auto is_hit = [&](const Touch& t) { return t.across > tolerance; };
  out.touch = how_deep == HowDeep::measured ? query.touch(piece) : query.touch(piece, is_hit);
  out.least = out.touch.across;
  if (out.touch.across > tolerance) {
    out.contact = Contact::hit;
    out.most = out.touch.across + half;
    return out;
  }
  // Near or at a surface: a smooth one is known better than to half a pitch.
  std::optional<double> gap = 0.0;
  const CutterProfile grown = piece.cutter->grown(half);
  Piece larger = piece;
  larger.cutter = &grown;
  query.run(larger, [&](const Stretch& s) {
    const auto here = query.gap_at(s);
    gap = here ? std::optional(std::max(*gap, *here)) : std::nullopt;
    return gap.has_value() && *gap <= tolerance;
  });
  out.most = out.touch.across + half;
  out.contact = Contact::unresolved;
  if (!gap || *gap > tolerance) return out;
  const CutterProfile finer = piece.cutter->grown(*gap);
  larger.cutter = &finer;
  const double deep = query.touch(larger).across;
  out.most = deep;
  if (deep <= tolerance) out.contact = Contact::clear;
  return out;
}

}  // namespace aircut::stock
