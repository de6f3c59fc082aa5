// The surface as a mesh: dual contouring over the lattice.
//
// A node of the lattice is inside when at least two of the three rays through it say so. Where two
// neighbouring nodes differ, the ray between them has an end there, with the surface's normal. Each
// cell between eight nodes gets one vertex per sheet of surface that passes through it, at the
// place that fits the planes of its ends best (least squares about their mean; directions that the
// planes say nothing about are left alone), so edges and corners come out sharp. Each such pair of
// nodes becomes a polygon through the four cells around it.
//
// The mesh is closed with exactly two triangles at each edge, whatever the nodes say: sheets are
// told apart by the faces of the cell (on a face with two crossing pairs, its inner corners are
// kept apart), and on such a face, where two sheets might share an edge of the mesh, both polygons
// get a vertex of their own. Vertices stay off the cells' faces by a thousandth of a cell, so no
// two fall together.
//
// Squares are put together where the surface is flat or straight (merged_faces.h): most of what is
// milled is, and few triangles say so as well as many.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <unordered_map>

#include "stock/impl.h"
#include "stock/merged_faces.h"

namespace aircut::stock {
namespace {

constexpr double off_face = 1e-3;        // of a cell: vertices keep this far from its faces
constexpr double flat_direction = 0.02;  // of the largest eigenvalue: says nothing
constexpr double on_line = 5e-4;         // of a cell: a vertex so near a line is on it
constexpr double end_missing = 0.05;     // of a cell

/// Nodes of a brick that are inside: a row of bits along X for each (k, j).
using NodeBits = std::array<std::uint16_t, rays>;
constexpr int window = cells + 2;  // nodes −1 … 16 of a brick
using Index3 = std::array<int, 3>;

/// An edge of a cell by number: axis · 4 + its place in the two directions that follow.
constexpr int edge_number(int axis, int b, int c) { return axis * 4 + b + 2 * c; }

NodeBits node_bits(const Brick& brick, std::size_t& disagreeing) {
  std::array<NodeBits, 3> bits{};
  std::vector<Interval> intervals;
  for (int f = 0; f < 3; ++f)
    for (int ray = 0; ray < rays; ++ray) {
      brick.family[static_cast<std::size_t>(f)].intervals(ray, intervals);
      const int row = ray / cells, lane = ray % cells;
      for (const Interval& v : intervals) {
        // Nodes n with lo ≤ 3840 n + 1920 < hi.
        const int from = (v.lo + quanta_per_cell / 2 - 1) / quanta_per_cell;
        const int to = (v.hi + quanta_per_cell / 2 - 1) / quanta_per_cell;
        for (int n = from; n < to; ++n) {
          const int i = f == 0 ? n : lane;
          const int j = f == 0 ? lane : f == 1 ? n : row;
          const int k = f == 2 ? n : row;
          auto& word = bits[static_cast<std::size_t>(f)][static_cast<std::size_t>(k * cells + j)];
          word = static_cast<std::uint16_t>(word | 1u << i);
        }
      }
    }
  NodeBits out{};
  for (std::size_t r = 0; r < rays; ++r) {
    const unsigned x = bits[0][r], y = bits[1][r], z = bits[2][r];
    out[r] = static_cast<std::uint16_t>((x & y) | (y & z) | (x & z));
    disagreeing += static_cast<std::size_t>(std::popcount((x | y | z) & ~(x & y & z)));
  }
  return out;
}

/// The vertices of a cell: which sheet each crossed edge belongs to, and where the sheets' vertices
/// begin.
struct CellVertices {
  std::uint32_t first = 0;
  std::array<std::uint8_t, 12> sheet{};
  /// Where the surface is flat, across an axis, and nothing else is in the cell.
  std::int8_t flat_axis = -1;
  std::uint16_t flat_end = 0;  ///< quanta from the brick's border
};

class Mesher {
 public:
  Mesher(const Stock::Impl& stock, Facets facets, TriangleMesh& out, MeshStatistics& statistics)
      : stock_(stock),
        lattice_(stock.lattice),
        merged_(facets == Facets::merged),
        out_(out),
        statistics_(statistics) {}

  void run() {
    for (int k = -1; k < lattice_.bricks[2]; ++k) {
      for (int j = -1; j < lattice_.bricks[1]; ++j)
        for (int i = -1; i < lattice_.bricks[0]; ++i) brick({i, j, k});
      forget_below(k);
    }
    if (merged_) faces_together_.triangulate(out_);
  }

 private:
  bool inside_table(const Index3& b) const {
    for (std::size_t a = 0; a < 3; ++a)
      if (b[a] < 0 || b[a] >= lattice_.bricks[a]) return false;
    return true;
  }
  std::size_t at(const Index3& b) const { return lattice_.index(b[0], b[1], b[2]); }

  /// A brick with rays, or null for a uniform one. Those of the initial solid are kept for a while.
  const Brick* rays_of(const Index3& b) {
    if (!inside_table(b)) return nullptr;
    const BrickSlot& slot = stock_.table[at(b)];
    if (!slot.is(BrickSlot::untouched)) return slot.brick();
    auto [it, fresh] = filled_.try_emplace(at(b));
    if (fresh) it->second = {fill(stock_.solid, lattice_, b[0], b[1], b[2]), b[2]};
    return it->second.first.get();
  }

  bool is_full(const Index3& b) const {
    return inside_table(b) && stock_.table[at(b)].is(BrickSlot::full);
  }

  /// −1 mixed, 0 empty, 1 full.
  int uniform(const Index3& b) const {
    if (!inside_table(b) || stock_.table[at(b)].is(BrickSlot::empty)) return 0;
    return stock_.table[at(b)].is(BrickSlot::full) ? 1 : -1;
  }

  const NodeBits* bits_of(const Index3& b) {
    const Brick* brick = rays_of(b);
    if (!brick) return nullptr;
    auto [it, fresh] = bits_.try_emplace(at(b));
    if (fresh) it->second = {node_bits(*brick, statistics_.disagreeing_nodes), b[2]};
    return &it->second.first;
  }

  void forget_below(int k) {
    std::erase_if(bits_, [&](const auto& e) { return e.second.second < k; });
    std::erase_if(filled_, [&](const auto& e) { return e.second.second < k; });
    std::erase_if(cells_, [&](const auto& e) { return e.second.second < k; });
    std::erase_if(faces_, [&](const auto& e) { return e.second.second < k; });
  }

  // ---- one brick's cells and polygons ----

  bool inside(int i, int j, int k) const { return (row(j, k) >> (i + 1) & 1) != 0; }
  /// Bits of the nodes −1 … 16 along X.
  unsigned row(int j, int k) const {
    return window_[static_cast<std::size_t>((k + 1) * window + j + 1)];
  }
  bool inside(const Index3& n) const { return inside(n[0], n[1], n[2]); }

  void load_window() {
    window_.fill(0);
    for (int dk = -1; dk <= 1; ++dk)
      for (int dj = -1; dj <= 1; ++dj)
        for (int di = -1; di <= 1; ++di) load_part({di, dj, dk});
  }

  void load_part(const Index3& d) {
    const Index3 b = {brick_[0] + d[0], brick_[1] + d[1], brick_[2] + d[2]};
    const NodeBits* bits = bits_of(b);
    const bool full = is_full(b);
    if (!bits && !full) return;
    const auto range = [](int o) { return std::pair(o < 0 ? cells - 1 : 0, o > 0 ? 1 : cells); };
    const auto [i0, i1] = range(d[0]);
    const auto [j0, j1] = range(d[1]);
    const auto [k0, k1] = range(d[2]);
    const unsigned in_range = (1u << i1) - (1u << i0);
    for (int k = k0; k < k1; ++k)
      for (int j = j0; j < j1; ++j) {
        const unsigned nodes = full ? 0xffffu : (*bits)[static_cast<std::size_t>(k * cells + j)];
        const int to = d[0] * cells + 1;  // of its first node
        const unsigned moved = to >= 0 ? (nodes & in_range) << to : (nodes & in_range) >> -to;
        window_[static_cast<std::size_t>((k + d[2] * cells + 1) * window + j + d[1] * cells + 1)] |=
            moved;
      }
  }

  void brick(const Index3& b) {
    const int first = uniform(b);
    bool mixed = first < 0;
    for (int n = 1; n < 8 && !mixed; ++n)
      mixed = uniform({b[0] + (n & 1), b[1] + (n >> 1 & 1), b[2] + (n >> 2)}) != first;
    if (!mixed) return;
    brick_ = b;
    load_window();
    const auto each_bit = [](unsigned bits, const auto& see) {
      for (; bits != 0; bits &= bits - 1) see(std::countr_zero(bits));
    };
    // Bit i + 1 of a row is node i; cell i is between nodes i and i + 1.
    constexpr unsigned own = 0xffffu;
    for (int k = 0; k < cells; ++k)
      for (int j = 0; j < cells; ++j) {
        const std::array<unsigned, 4> rows = {row(j, k), row(j + 1, k), row(j, k + 1),
                                              row(j + 1, k + 1)};
        const unsigned any = rows[0] | rows[1] | rows[2] | rows[3];
        const unsigned all = rows[0] & rows[1] & rows[2] & rows[3];
        each_bit(((any | any >> 1) & ~(all & all >> 1)) >> 1 & own, [&](int i) {
          cell({i, j, k});
        });
      }
    for (int k = 0; k < cells; ++k)
      for (int j = 0; j < cells; ++j) {
        const unsigned nodes = row(j, k);
        const unsigned ends =
            (nodes ^ nodes >> 1) | (nodes ^ row(j + 1, k)) | (nodes ^ row(j, k + 1));
        each_bit(ends >> 1 & own, [&](int i) { polygons({i, j, k}); });
      }
    if (!merged_) return;
    straight_.resize(out_.vertices.size());
    for (const FaceSquare& alone :
         squares_.merge(out_.vertices, straight_, on_line * lattice_.pitch, faces_together_)) {
      corners_.assign(alone.corners.begin(), alone.corners.end());
      on_faces_.clear();
      if (!alone.forward) std::reverse(corners_.begin(), corners_.end());
      triangulate();
    }
  }

  /// A number for a node or cell anywhere in the lattice, −1 included.
  std::uint64_t key(const Index3& n) const {
    std::uint64_t out = 0;
    for (std::size_t a = 0; a < 3; ++a)
      out = out << 19 | static_cast<std::uint64_t>(brick_[a] * cells + n[a] + cells);
    return out;
  }

  static Index3 step(Index3 n, int axis, int by) {
    n[static_cast<std::size_t>(axis)] += by;
    return n;
  }

  void cell(const Index3& n) {
    unsigned corners = 0;
    for (int c = 0; c < 8; ++c)
      corners |= (inside(n[0] + (c & 1), n[1] + (c >> 1 & 1), n[2] + (c >> 2)) ? 1u : 0u) << c;
    if (corners == 0 || corners == 255) return;
    const auto [it, fresh] = cells_.try_emplace(key(n));
    it->second.second = brick_[2];
    CellVertices& v = it->second.first;
    v.first = static_cast<std::uint32_t>(out_.vertices.size());
    const int sheets = find_sheets(corners, v.sheet);
    for (int s = 0; s < sheets; ++s) {
      const Ends ends = ends_of(n, corners, v.sheet, s);
      out_.vertices.push_back(place(n, ends));
      if (sheets == 1 && ends.flat()) {
        v.flat_axis = static_cast<std::int8_t>(ends.found[0].axis);
        v.flat_end = static_cast<std::uint16_t>(ends.found[0].end);
      }
      if (sheets == 1 && ends.count == 4) {
        straight_.resize(out_.vertices.size());
        straight_.back() = same_along(corners);
      }
    }
    for (std::size_t a = v.first; a < out_.vertices.size(); ++a)  // two sheets in one place: apart
      for (std::size_t b = v.first; b < a; ++b)
        if (out_.vertices[a] == out_.vertices[b])
          out_.vertices[a] += off_face * 0.5 * lattice_.pitch * Vec3(0.3, 0.5, 0.7);
  }

  /// A bit for each axis along which the corners are the same at both ends.
  static std::uint8_t same_along(unsigned corners) {
    constexpr std::array<unsigned, 3> low = {0x55, 0x33, 0x0f};
    unsigned out = 0;
    for (unsigned a = 0; a < 3; ++a)
      if ((corners & low[a]) == (corners >> (1u << a) & low[a])) out |= 1u << a;
    return static_cast<std::uint8_t>(out);
  }

  static int corner_of(int axis, int b, int c, int along) {
    int out = along << axis;
    out |= b << ((axis + 1) % 3);
    return out | c << ((axis + 2) % 3);
  }

  static bool crossed(unsigned corners, int axis, int b, int c) {
    return (corners >> corner_of(axis, b, c, 0) & 1) != (corners >> corner_of(axis, b, c, 1) & 1);
  }

  /// Numbers the sheets that the crossed edges belong to: two edges of a face are of one sheet when
  /// they are its only ones, or share an inner corner.
  static int find_sheets(unsigned corners, std::array<std::uint8_t, 12>& sheet) {
    std::array<int, 12> parent{};
    for (int e = 0; e < 12; ++e) parent[static_cast<std::size_t>(e)] = e;
    const auto root_of = [&](int e) {
      while (parent[static_cast<std::size_t>(e)] != e) e = parent[static_cast<std::size_t>(e)];
      return e;
    };
    const auto join = [&](int e, int f) {
      parent[static_cast<std::size_t>(root_of(e))] = root_of(f);
    };
    for (int axis = 0; axis < 3; ++axis) {
      const int p = (axis + 1) % 3, q = (axis + 2) % 3;
      for (int side = 0; side < 2; ++side) {
        // Edges of the face along p (at q = 0, 1) and along q (at p = 0, 1). Their other two
        // directions follow in turn: of p they are (q, axis), of q they are (axis, p).
        std::array<int, 4> found{};
        int count = 0;
        for (int o = 0; o < 2; ++o) {
          if (crossed(corners, p, o, side))
            found[static_cast<std::size_t>(count++)] = edge_number(p, o, side);
          if (crossed(corners, q, side, o))
            found[static_cast<std::size_t>(count++)] = edge_number(q, side, o);
        }
        if (count == 2) join(found[0], found[1]);
        if (count != 4) continue;
        for (int c = 0; c < 4; ++c) {  // around each inner corner
          const int at_p = c & 1, at_q = c >> 1;
          const int corner = side << axis | at_p << p | at_q << q;
          if (corners >> corner & 1) join(edge_number(p, at_q, side), edge_number(q, side, at_p));
        }
      }
    }
    std::array<int, 12> number;
    number.fill(-1);
    int sheets = 0;
    for (int axis = 0; axis < 3; ++axis)
      for (int o = 0; o < 4; ++o) {
        if (!crossed(corners, axis, o & 1, o >> 1)) continue;
        int& n = number[static_cast<std::size_t>(root_of(edge_number(axis, o & 1, o >> 1)))];
        if (n < 0) n = sheets++;
        sheet[static_cast<std::size_t>(edge_number(axis, o & 1, o >> 1))] =
            static_cast<std::uint8_t>(n);
      }
    return sheets;
  }

  Vec3 node(const Index3& n) const {
    return lattice_.pitch * (Vec3(n[0], n[1], n[2]) + Vec3::Constant(0.5) +
                             cells * Vec3(brick_[0], brick_[1], brick_[2]));
  }

  struct Crossing {
    Vec3 point;
    int axis = 0, end = 0;  ///< end: quanta from the brick's border along the axis
    NormalCode code = 0;
    bool leaving = false;

    /// Of the surface, outward; that of the ray where the end has none.
    Vec3 normal() const {
      return code != 0 ? decode_normal(code) : Vec3(Vec3::Unit(axis) * (leaving ? 1.0 : -1.0));
    }
    bool same_normal(const Crossing& o) const {
      return code != 0 ? code == o.code : o.code == 0 && axis == o.axis && leaving == o.leaving;
    }
  };

  /// The end between a node and the next along an axis.
  Crossing crossing(const Index3& n, int axis) {
    const bool leaving = inside(n);
    const auto a = static_cast<std::size_t>(axis);
    const int from = n[a] * quanta_per_cell + quanta_per_cell / 2;  // of the node, in its brick
    double best = std::numeric_limits<double>::infinity(), place_at = 0;
    NormalCode code = 0;
    const auto look = [&](int shift) {
      Index3 b = brick_, local = n;
      for (std::size_t d = 0; d < 3; ++d) {
        const int global = n[d] + (d == a ? shift : 0);
        b[d] += global >= cells ? 1 : global < 0 ? -1 : 0;
        local[d] = (global + cells) % cells;
      }
      const Brick* brick = rays_of(b);
      const int offset = (b[a] - brick_[a]) * brick_quanta;
      const int lane = axis == 0 ? local[1] : local[0], row = axis == 2 ? local[1] : local[2];
      intervals_.clear();
      if (brick)
        brick->family[a].intervals(row * cells + lane, intervals_);
      else if (is_full(b))
        intervals_.push_back({0, brick_quanta, 0, 0});
      for (const Interval& v : intervals_) {
        const int end = (leaving ? v.hi : v.lo) + offset - from;
        const double outside = std::max({-end, end - quanta_per_cell, 0});
        if (!(outside < best)) continue;
        best = outside;
        place_at = end;
        code = leaving ? v.normal_hi : v.normal_lo;
      }
    };
    look(0);
    if (n[a] + 1 >= cells || n[a] < 0) look(1);
    if (best > end_missing * quanta_per_cell) {
      ++statistics_.missing_ends;
      if (!(best < quanta_per_cell)) place_at = quanta_per_cell / 2.0;
    }
    const double along = std::clamp(place_at / quanta_per_cell, off_face, 1 - off_face);
    return {node(n) + along * lattice_.pitch * Vec3::Unit(axis), axis,
            static_cast<int>(place_at) + from, code, leaving};
  }

  /// The ends of one sheet in a cell.
  struct Ends {
    std::array<Crossing, 12> found;
    std::size_t count = 0;

    bool one_normal() const {
      for (std::size_t i = 1; i < count; ++i)
        if (!found[i].same_normal(found[0])) return false;
      return true;
    }
    /// All four ends along one axis at one height.
    bool flat() const {
      if (count != 4 || !one_normal()) return false;
      for (std::size_t i = 1; i < count; ++i)
        if (found[i].axis != found[0].axis || found[i].end != found[0].end) return false;
      return true;
    }
  };

  Ends ends_of(const Index3& n, unsigned corners, const std::array<std::uint8_t, 12>& sheet,
               int s) {
    Ends out;
    for (int axis = 0; axis < 3; ++axis)
      for (int o = 0; o < 4; ++o) {
        const int b = o & 1, c = o >> 1;
        if (!crossed(corners, axis, b, c)) continue;
        if (sheet[static_cast<std::size_t>(edge_number(axis, b, c))] != s) continue;
        const int corner = corner_of(axis, b, c, 0);
        out.found[out.count++] =
            crossing({n[0] + (corner & 1), n[1] + (corner >> 1 & 1), n[2] + (corner >> 2)}, axis);
      }
    return out;
  }

  Vec3 place(const Index3& n, const Ends& ends) const {
    const auto& [found, count] = ends;
    Vec3 mean = Vec3::Zero();
    for (std::size_t i = 0; i < count; ++i) mean += found[i].point;
    mean /= static_cast<double>(count);
    const Vec3 low = node(n), edge = Vec3::Constant(off_face * lattice_.pitch);
    const auto in_cell = [&](const Vec3& v) -> Vec3 {
      return v.cwiseMax(low + edge).cwiseMin(low + Vec3::Constant(lattice_.pitch) - edge);
    };
    if (ends.one_normal()) return in_cell(mean);  // already in the plane that fits best
    Mat3 squares = Mat3::Zero();
    Vec3 right = Vec3::Zero();
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 normal = found[i].normal();
      squares += normal * normal.transpose();
      right += normal * normal.dot(found[i].point - mean);
    }
    const Eigen::SelfAdjointEigenSolver<Mat3> eigen(squares);
    Vec3 shift = Vec3::Zero();
    for (int d = 0; d < 3; ++d) {
      const double value = eigen.eigenvalues()[d];
      if (value < flat_direction * eigen.eigenvalues()[2]) continue;
      shift += eigen.eigenvectors().col(d) * (eigen.eigenvectors().col(d).dot(right) / value);
    }
    return in_cell(mean + shift);
  }

  void polygons(const Index3& n) {
    for (int axis = 0; axis < 3; ++axis)
      if (inside(n) != inside(step(n, axis, 1))) polygon(n, axis);
  }

  /// Around the edge from node n along an axis: its four cells, counter-clockwise seen from the
  /// axis' end, and vertices on ambiguous faces between them.
  void polygon(const Index3& n, int axis) {
    const int p = (axis + 1) % 3, q = (axis + 2) % 3;
    constexpr std::array<std::array<int, 2>, 4> around = {{{-1, -1}, {0, -1}, {0, 0}, {-1, 0}}};
    corners_.clear();
    on_faces_.clear();
    std::array<const CellVertices*, 4> of{};
    for (std::size_t side = 0; side < 4; ++side) {
      const auto [dp, dq] = around[side];
      const Index3 cell = step(step(n, p, dp), q, dq);
      const CellVertices& v = cells_.at(key(cell)).first;
      of[side] = &v;
      corners_.push_back(v.first + v.sheet[static_cast<std::size_t>(edge_number(axis, -dp, -dq))]);
      // The face to the next cell holds the edge and leaves it towards −q, +p, +q, −p.
      const int away = side % 2 == 0 ? q : p;
      const int by = side == 0 || side == 3 ? -1 : 1;
      face_vertex(n, axis, away, by);
    }
    if (merged_ && corners_.size() == 4) {
      const bool flat = std::ranges::all_of(of, [&](const CellVertices* v) {
        return v->flat_axis == axis && v->flat_end == of[0]->flat_end;
      });
      squares_.add({axis,
                    n,
                    inside(n),
                    flat ? of[0]->flat_end : -1,
                    {corners_[0], corners_[1], corners_[2], corners_[3]}});
      return;
    }
    if (!inside(n)) std::reverse(corners_.begin(), corners_.end());
    triangulate();
  }

  /// Adds the vertex of an ambiguous face that spans from the edge (n, axis) by ±1 along `away`.
  void face_vertex(const Index3& n, int axis, int away, int by) {
    const Index3 end = step(n, axis, 1), far = step(n, away, by), far_end = step(end, away, by);
    if (inside(n) != inside(far_end) || inside(end) != inside(far)) return;
    // Ambiguous. The sheet is the one around the edge's inner corner.
    const bool start_inside = inside(n);
    const Index3 corner = start_inside ? n : end;
    const int normal_axis = 3 - axis - away;
    const Index3 low = by < 0 ? far : n;
    const int which =
        (corner[static_cast<std::size_t>(axis)] - low[static_cast<std::size_t>(axis)]) +
        2 * (corner[static_cast<std::size_t>(away)] - low[static_cast<std::size_t>(away)]);
    // The same number from both edges: axes in order.
    const int number = axis < away ? which : (which >> 1 | (which & 1) << 1);
    const std::uint64_t face = (key(low) * 3 + static_cast<std::uint64_t>(normal_axis)) * 4 +
                               static_cast<std::uint64_t>(number);
    const auto [it, fresh] = faces_.try_emplace(face);
    if (fresh) {
      const Index3 other =
          by < 0 ? step(corner, away, -1) : corner;  // the corner's edge along away
      const Vec3 a = crossing(n, axis).point, b = crossing(other, away).point;
      it->second = {static_cast<std::uint32_t>(out_.vertices.size()), brick_[2]};
      out_.vertices.push_back(0.5 * (a + b));
    }
    corners_.push_back(it->second.first);
    on_faces_.push_back(it->second.first);
  }

  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    out_.triangles.push_back({a, b, c});
  }

  Vec3 area(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    const Vec3& o = out_.vertices[a];
    return (out_.vertices[b] - o).cross(out_.vertices[c] - o);
  }

  /// Quads along the diagonal that bends less; larger polygons as a fan around a face's vertex:
  /// a diagonal between the two cells of an ambiguous face might be drawn by both of its polygons.
  void triangulate() {
    const std::size_t n = corners_.size();
    std::size_t best = 0;
    double best_quality = -2;
    for (std::size_t start = 0; start < (n == 4 ? 2 : n); ++start) {
      if (n > 4 && std::count(on_faces_.begin(), on_faces_.end(), at_corner(start)) == 0) continue;
      double quality = 1, smallest = std::numeric_limits<double>::infinity();
      Vec3 last = Vec3::Zero();
      for (std::size_t i = 1; i + 1 < n; ++i) {
        const Vec3 v = area(at_corner(start), at_corner(start + i), at_corner(start + i + 1));
        smallest = std::min(smallest, v.norm());
        if (i > 1) quality = std::min(quality, last.normalized().dot(v.normalized()));
        last = v;
      }
      if (!(smallest > 0)) quality = -1.5;
      if (quality > best_quality) {
        best_quality = quality;
        best = start;
      }
    }
    for (std::size_t i = 1; i + 1 < n; ++i)
      add(at_corner(best), at_corner(best + i), at_corner(best + i + 1));
  }

  std::uint32_t at_corner(std::size_t i) const { return corners_[i % corners_.size()]; }

  const Stock::Impl& stock_;
  const Lattice& lattice_;
  bool merged_;
  TriangleMesh& out_;
  MeshStatistics& statistics_;
  Index3 brick_{};
  std::array<std::uint32_t, window * window> window_{};  ///< rows of nodes along X
  // By place, with the layer of bricks that they belong to; forgotten two layers later.
  std::unordered_map<std::size_t, std::pair<NodeBits, int>> bits_;
  std::unordered_map<std::size_t, std::pair<std::unique_ptr<Brick>, int>> filled_;
  std::unordered_map<std::uint64_t, std::pair<CellVertices, int>> cells_;
  std::unordered_map<std::uint64_t, std::pair<std::uint32_t, int>> faces_;
  std::vector<Interval> intervals_;
  std::vector<std::uint32_t> corners_, on_faces_;  ///< of the polygon; those on ambiguous faces
  BrickFaces squares_;
  MergedFaces faces_together_;
  std::vector<std::uint8_t> straight_;  ///< by vertex: bits of the axes that its cell repeats along
};

}  // namespace

TriangleMesh Stock::mesh(Facets facets, MeshStatistics* statistics) const {
  TriangleMesh out;
  MeshStatistics ignored;
  Mesher(*impl_, facets, out, statistics ? *statistics : ignored).run();
  for (Vec3& v : out.vertices) v += impl_->lattice.origin;
  return out;
}

double Stock::volume() const { return aircut::volume(mesh()); }

}  // namespace aircut::stock
