#include "stock/solid.h"

#include <algorithm>
#include <cmath>

namespace aircut::stock {
namespace {

struct Chord {
  double lo, hi;
  Vec3 normal_lo, normal_hi;  // outward
};

Diagnostic shape_error(std::string message) {
  return make_error("stock_shape", std::move(message));
}

/// Chords of the line through `point` along `axis`.
void chords(const Box& box, const Vec3& point, int axis, std::vector<Chord>& out) {
  for (int a = 0; a < 3; ++a)
    if (a != axis && !(point[a] >= box.low[a] && point[a] < box.high[a])) return;
  out.push_back({box.low[axis], box.high[axis], -Vec3::Unit(axis), Vec3::Unit(axis)});
}

void chords(const Cylinder& bar, const Vec3& point, int axis, std::vector<Chord>& out) {
  const int d = bar.direction, p = (d + 1) % 3, q = (d + 2) % 3;
  const Vec3 rel = point - bar.base;
  if (axis == d) {
    const double r2 = rel[p] * rel[p] + rel[q] * rel[q];
    if (r2 >= bar.radius * bar.radius || r2 < bar.inner_radius * bar.inner_radius) return;
    out.push_back({bar.base[d], bar.base[d] + bar.length, -Vec3::Unit(d), Vec3::Unit(d)});
    return;
  }
  if (!(rel[d] >= 0 && rel[d] < bar.length)) return;
  const int other = axis == p ? q : p;
  const auto half = [&](double r) {
    return std::sqrt(std::max(r * r - rel[other] * rel[other], 0.0));
  };
  const double outer = half(bar.radius), inner = half(bar.inner_radius);
  if (!(outer > 0)) return;
  const auto normal = [&](double along, double sign) {
    Vec3 n = Vec3::Zero();
    n[axis] = along;
    n[other] = rel[other];
    return Vec3(sign * n.normalized());
  };
  const double c = bar.base[axis];
  if (!(inner > 0)) {
    out.push_back({c - outer, c + outer, normal(-outer, 1), normal(outer, 1)});
  } else {
    out.push_back({c - outer, c - inner, normal(-outer, 1), normal(-inner, -1)});
    out.push_back({c + inner, c + outer, normal(inner, -1), normal(outer, 1)});
  }
}

void chords(const MeshSolid&, const Vec3&, int, std::vector<Chord>&) {}

std::uint16_t quantised(double mm, const Lattice& lattice) {
  return static_cast<std::uint16_t>(
      std::lround(std::clamp(mm / lattice.quantum(), 0.0, double{brick_quanta})));
}

Expected<Box3> box_of(const Box& box) {
  for (int a = 0; a < 3; ++a)
    if (!(box.high[a] > box.low[a]) || !std::isfinite(box.high[a] - box.low[a]))
      return unexpected(
          shape_error("the stock's box has no volume: each high coordinate must be "
                      "more than the low one"));
  return Box3(box.low, box.high);
}

Expected<Box3> box_of(const Cylinder& bar) {
  if (bar.direction < 0 || bar.direction > 2)
    return unexpected(shape_error("the stock bar's direction must be 0, 1 or 2"));
  if (!(bar.radius > bar.inner_radius) || !(bar.inner_radius >= 0) || !(bar.length > 0) ||
      !std::isfinite(bar.radius + bar.length) || !bar.base.allFinite())
    return unexpected(
        shape_error("the stock bar needs a length and a radius of more than 0, and an "
                    "inner radius less than the radius"));
  Vec3 low = bar.base - Vec3::Constant(bar.radius), high = bar.base + Vec3::Constant(bar.radius);
  low[bar.direction] = bar.base[bar.direction];
  high[bar.direction] = bar.base[bar.direction] + bar.length;
  return Box3(low, high);
}

Expected<Box3> box_of(const MeshSolid& solid) {
  if (!solid.mesh || solid.mesh->empty())
    return unexpected(make_error("stock_mesh", "the stock's mesh has no triangles"));
  for (const Vec3& v : solid.mesh->vertices)
    if (!v.allFinite())
      return unexpected(make_error("stock_mesh", "a vertex of the stock's mesh is not a number"));
  const TriangleMesh mesh = welded(*solid.mesh);
  for (const Shell& shell : shells(mesh))
    if (!shell.closed)
      return unexpected(
          make_error("stock_mesh",
                     "the stock's mesh is not closed, so its inside is not defined: each edge "
                     "must belong to two triangles that run along it in opposite directions"));
  if (!(aircut::volume(mesh) > 0))
    return unexpected(make_error("stock_mesh",
                                 "the stock's mesh is inside out: seen from outside, "
                                 "corners must run counter-clockwise"));
  return bounds(mesh);
}

BrickSlot::State classify_box(const Box& box, const Vec3& low, const Vec3& high) {
  bool inside = true;
  for (int a = 0; a < 3; ++a) {
    if (high[a] <= box.low[a] || low[a] >= box.high[a]) return BrickSlot::empty;
    inside = inside && low[a] >= box.low[a] && high[a] <= box.high[a];
  }
  return inside ? BrickSlot::full : BrickSlot::untouched;
}

BrickSlot::State classify_bar(const Cylinder& bar, const Vec3& low, const Vec3& high) {
  const int d = bar.direction, p = (d + 1) % 3, q = (d + 2) % 3;
  const double end = bar.base[d] + bar.length;
  if (high[d] <= bar.base[d] || low[d] >= end) return BrickSlot::empty;
  double far2 = 0, near2 = 0;
  for (const int a : {p, q}) {
    const double l = low[a] - bar.base[a], h = high[a] - bar.base[a];
    far2 += std::max(l * l, h * h);
    near2 += l > 0 ? l * l : h < 0 ? h * h : 0;
  }
  const double margin = 1e-6, r = bar.radius, inner = bar.inner_radius;
  if (near2 > (r + margin) * (r + margin)) return BrickSlot::empty;
  if (inner > margin && far2 < (inner - margin) * (inner - margin)) return BrickSlot::empty;
  const bool within = r > margin && far2 < (r - margin) * (r - margin) &&
                      (inner == 0 || near2 > (inner + margin) * (inner + margin));
  return within && low[d] >= bar.base[d] && high[d] <= end ? BrickSlot::full : BrickSlot::untouched;
}

}  // namespace

Expected<Box3> solid_box(const Solid& solid) {
  return std::visit([](const auto& s) { return box_of(s); }, solid);
}

BrickSlot::State classify(const Solid& solid, const Lattice& lattice, int i, int j, int k) {
  // From integers, so that neighbours and the box's lowest corner meet exactly.
  const Vec3 low = lattice.origin + lattice.brick_size() * Vec3(i, j, k);
  const Vec3 high = lattice.origin + lattice.brick_size() * Vec3(i + 1, j + 1, k + 1);
  return std::visit(overloaded{[&](const Box& box) { return classify_box(box, low, high); },
                               [&](const Cylinder& bar) { return classify_bar(bar, low, high); },
                               [](const MeshSolid&) { return BrickSlot::empty; }},
                    solid);
}

void add_interval(RayFamily& family, int ray, const Interval& interval) {
  RayBlock& block = *family.block;
  const auto i = static_cast<std::size_t>(ray);
  if (block.lo[i] < block.hi[i]) {
    family.extra.push_back({static_cast<std::uint16_t>(ray), interval});
    return;
  }
  block.lo[i] = interval.lo;
  block.hi[i] = interval.hi;
  block.normal_lo[i] = interval.normal_lo;
  block.normal_hi[i] = interval.normal_hi;
}

void settle(Brick& brick) {
  for (RayFamily& family : brick.family) {
    if (!family.block || !family.extra.empty()) continue;
    std::array<std::uint16_t, cells> full{};
    bool trivial = true;
    for (std::size_t i = 0; i < rays && trivial; ++i) {
      const std::uint16_t lo = family.block->lo[i], hi = family.block->hi[i];
      if (lo >= hi) continue;
      trivial = lo == 0 && hi == brick_quanta;
      full[i / cells] = static_cast<std::uint16_t>(full[i / cells] | 1u << (i % cells));
    }
    if (!trivial) continue;
    family.block.reset();
    family.full = full;
  }
  for (int row = 0; row < cells; ++row)
    brick.z_tops[static_cast<std::size_t>(row)] = brick.family[2].top(row);
  for (std::size_t f = 0; f < 2; ++f) {
    int& rows = brick.rows[f];
    rows = cells;
    while (rows > 0 && brick.family[f].row_empty(rows - 1)) --rows;
  }
}

std::unique_ptr<Brick> fill(const Solid& solid, const Lattice& lattice, int i, int j, int k) {
  auto brick = std::make_unique<Brick>();
  const Vec3 low = lattice.origin + lattice.brick_size() * Vec3(i, j, k);
  std::vector<Chord> found;
  for (const Family family : families) {
    RayFamily& rays_here = brick->family[static_cast<std::size_t>(index_of(family))];
    rays_here.make_block();
    const int axis = index_of(family);
    const int lane_axis = axis == 0 ? 1 : 0, row_axis = axis == 2 ? 1 : 2;
    for (int ray = 0; ray < rays; ++ray) {
      Vec3 point = low;
      point[lane_axis] += (ray % cells + 0.5) * lattice.pitch;
      point[row_axis] += (ray / cells + 0.5) * lattice.pitch;
      found.clear();
      std::visit([&](const auto& s) { chords(s, point, axis, found); }, solid);
      for (const Chord& c : found) {
        const Interval interval{quantised(c.lo - low[axis], lattice),
                                quantised(c.hi - low[axis], lattice), encode_normal(c.normal_lo),
                                encode_normal(c.normal_hi)};
        if (interval.lo < interval.hi) add_interval(rays_here, ray, interval);
      }
    }
  }
  settle(*brick);
  return brick;
}

}  // namespace aircut::stock
