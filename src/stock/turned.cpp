// Turning. What a section sweeps along a straight line is convex again: the hull of its discs at
// the start and at the end. So a ray has one chord, whose ends lie on one of the discs or on a line
// that touches two of them from outside:
//
//        __-----__            the hull of discs is bounded by arcs of them and by such lines; every
//      (   )      \\          pair's lines lie inside of it, so the least and the greatest place
//       \\______( )          where any of them meets the ray are the ends of the chord
//
// While the stock turns, everything at the same radius and height goes with it: cutting the section
// is all there is. A part of the sweep beyond the axis takes the same radii from the other side.
//
// Volume: a ray along the radius stands for a ring of height `pitch`, π (r₂² − r₁²) each.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "stock/stock.h"

namespace aircut::stock {
namespace {

constexpr double nm = 1e6;  // in a millimetre

struct Disc {
  double u, v, radius;  // along the ray, across it
};

struct Span {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void offer(double u) {
    low = std::min(low, u);
    high = std::max(high, u);
  }
};

/// Where the line at `v` meets the hull of the discs; low > high: nowhere.
Span chord(const std::vector<Disc>& discs, double v) {
  Span out;
  for (std::size_t i = 0; i < discs.size(); ++i) {
    const Disc& a = discs[i];
    const double h2 = a.radius * a.radius - (v - a.v) * (v - a.v);
    if (h2 >= 0) {
      out.offer(a.u - std::sqrt(h2));
      out.offer(a.u + std::sqrt(h2));
    }
    for (std::size_t j = i + 1; j < discs.size(); ++j) {
      const Disc& b = discs[j];
      const double du = b.u - a.u, dv = b.v - a.v, length = std::hypot(du, dv);
      if (length <= std::abs(a.radius - b.radius)) continue;  // one lies in the other
      const double along = (a.radius - b.radius) / length;
      const double across = std::sqrt(std::max(0.0, 1 - along * along));
      for (const double side : {-1.0, 1.0}) {
        const double nu = (along * du - side * across * dv) / length;
        const double nv = (along * dv + side * across * du) / length;
        const double pu = a.u + a.radius * nu, pv = a.v + a.radius * nv;
        const double qu = b.u + b.radius * nu, qv = b.v + b.radius * nv;
        if ((pv - v) * (qv - v) > 0) continue;
        if (pv == qv) {
          out.offer(pu);
          out.offer(qu);
        } else {
          out.offer(pu + (qu - pu) * (v - pv) / (qv - pv));
        }
      }
    }
  }
  return out;
}

std::int64_t rounded(double mm) { return std::llround(std::clamp(mm, -1e9, 1e9) * nm); }

using Ray = std::vector<std::pair<std::int64_t, std::int64_t>>;

/// Calls see(from, to) for what [a, b) and the ray have in common.
template <class See>
void common(const Ray& ray, std::int64_t a, std::int64_t b, See see) {
  for (const auto& [lo, hi] : ray)
    if (const auto from = std::max(lo, a), to = std::min(hi, b); from < to) see(from, to);
}

void take(Ray& ray, std::int64_t a, std::int64_t b) {
  Ray out;
  for (const auto& [lo, hi] : ray) {
    if (b <= lo || a >= hi) {
      out.emplace_back(lo, hi);
      continue;
    }
    if (lo < a) out.emplace_back(lo, a);
    if (b < hi) out.emplace_back(b, hi);
  }
  ray = std::move(out);
}

double ring(std::int64_t from, std::int64_t to, double pitch) {
  const double a = static_cast<double>(from) / nm, b = static_cast<double>(to) / nm;
  return std::numbers::pi * (b - a) * (b + a) * pitch;
}

/// How far p is from the line from a to b.
double off_line(const std::pair<double, double>& p, const std::pair<double, double>& a,
                const std::pair<double, double>& b) {
  const double u = b.first - a.first, v = b.second - a.second, length = std::hypot(u, v);
  if (!(length > 0)) return std::hypot(p.first - a.first, p.second - a.second);
  return std::abs((p.first - a.first) * v - (p.second - a.second) * u) / length;
}

using Loop = std::vector<std::pair<double, double>>;

/// The points of an open chain that are needed for it to stay within `tolerance`.
void thin(const Loop& chain, std::size_t from, std::size_t to, double tolerance,
          std::vector<bool>& keep) {
  std::vector<std::pair<std::size_t, std::size_t>> open = {{from, to}};
  while (!open.empty()) {
    const auto [a, b] = open.back();
    open.pop_back();
    double worst = tolerance;
    std::size_t at = 0;
    for (std::size_t i = a + 1; i < b; ++i)
      if (const double off = off_line(chain[i], chain[a], chain[b]); off > worst) {
        worst = off;
        at = i;
      }
    if (at == 0) continue;
    keep[at] = true;
    open.emplace_back(a, at);
    open.emplace_back(at, b);
  }
}

Loop thinned(const Loop& loop, double tolerance) {
  // From a point that surely stays (the one farthest from the first) back to it.
  std::size_t far = 0;
  const auto away = [&](std::size_t i) {
    return std::hypot(loop[i].first - loop[0].first, loop[i].second - loop[0].second);
  };
  for (std::size_t i = 1; i < loop.size(); ++i)
    if (away(i) > away(far)) far = i;
  Loop chain(loop.begin() + static_cast<std::ptrdiff_t>(far), loop.end());
  chain.insert(chain.end(), loop.begin(), loop.begin() + static_cast<std::ptrdiff_t>(far) + 1);
  std::size_t half = 0;
  const auto from_far = [&](std::size_t i) {
    return std::hypot(chain[i].first - chain[0].first, chain[i].second - chain[0].second);
  };
  for (std::size_t i = 1; i < chain.size(); ++i)
    if (from_far(i) > from_far(half)) half = i;
  std::vector<bool> keep(chain.size(), false);
  keep[0] = keep[half] = true;
  thin(chain, 0, half, tolerance, keep);
  thin(chain, half, chain.size() - 1, tolerance, keep);
  Loop out;
  for (std::size_t i = 0; i + 1 < chain.size(); ++i)
    if (keep[i]) out.push_back(chain[i]);
  return out;
}

}  // namespace

Expected<TurnedStock> TurnedStock::make(double radius, double bore, double length, double pitch,
                                        const StockOptions& options) {
  if (!(radius > 0 && bore >= 0 && bore < radius && length > 0 && radius < 1e5 && length < 1e5))
    return unexpected(make_error("stock_shape", "a bar to be turned needs sizes above 0"));
  if (!(pitch >= 1e-4) || pitch > std::min(radius - bore, length))
    return unexpected(make_error("stock_shape",
                                 "the stock's pitch must be at least 0.0001 mm and at most its "
                                 "smallest size"));
  const double rays = (radius + length) / pitch, bytes = rays * 64;
  if (bytes > static_cast<double>(options.memory_limit))
    return unexpected(make_error(
        "stock_memory",
        "the section of the stock does not fit into " + std::to_string(options.memory_limit >> 20) +
            " MiB at a pitch of " + shortest(pitch) + " mm; it takes " +
            shortest(std::ceil(bytes / static_cast<double>(options.memory_limit) * pitch * 1e4) /
                     1e4) +
            " mm"));
  TurnedStock out;
  out.pitch_ = pitch;
  out.radius_ = radius;
  out.length_ = length;
  const auto count = [&](double size) {
    return static_cast<std::size_t>(std::ceil(size / pitch - 1e-9));
  };
  for (std::size_t k = 0; k < count(length); ++k) {
    const double z = (static_cast<double>(k) + 0.5) * pitch;
    out.along_r_.push_back(z < length ? Ray{{rounded(bore), rounded(radius)}} : Ray{});
  }
  for (std::size_t i = 0; i < count(radius); ++i) {
    const double r = (static_cast<double>(i) + 0.5) * pitch;
    out.along_z_.push_back(r > bore && r < radius ? Ray{{0, rounded(length)}} : Ray{});
  }
  return out;
}

// Calls see(along_r, index, from, to, beyond) for the parts of rays, in nanometres, that the move
// sweeps; all of them lie at radii of 0 or more, `beyond`: the tool is on the axis' other side.
template <class See>
void TurnedStock::each_chord(const TurningMove& move, See see) const {
  std::vector<Disc> level, upright;
  Span r, z;
  for (const TurningSection::Disc& d : move.section->discs)
    for (const bool end : {false, true}) {
      const double at_r = d.r + (end ? move.r1 : move.r0), at_z = d.z + (end ? move.z1 : move.z0);
      level.push_back({at_r, at_z, d.radius});
      upright.push_back({at_z, at_r, d.radius});
      for (const double by : {-d.radius, d.radius}) {
        r.offer(at_r + by);
        z.offer(at_z + by);
      }
    }
  const auto first = [&](double mm) {
    return static_cast<std::size_t>(std::max(0.0, std::ceil(mm / pitch_ - 0.5)));
  };
  const auto at = [&](std::size_t n) { return (static_cast<double>(n) + 0.5) * pitch_; };
  for (std::size_t k = first(z.low); k < along_r_.size() && at(k) <= z.high; ++k) {
    if (along_r_[k].empty()) continue;
    const Span c = chord(level, at(k));
    if (!(c.low < c.high)) continue;
    if (c.high > 0) see(true, k, rounded(std::max(c.low, 0.0)), rounded(c.high), false);
    if (c.low < 0) see(true, k, rounded(std::max(-c.high, 0.0)), rounded(-c.low), true);
  }
  // Radii on both sides of the axis.
  const double least = std::max({0.0, r.low, -r.high}), most = std::max(r.high, -r.low);
  for (std::size_t i = first(least); i < along_z_.size() && at(i) <= most; ++i)
    for (const double side : {1.0, -1.0}) {
      if (along_z_[i].empty()) continue;
      const Span c = chord(upright, side * at(i));
      if (c.low < c.high) see(false, i, rounded(c.low), rounded(c.high), side < 0);
    }
}

double TurnedStock::cut(const TurningMove& move) {
  double volume = 0;
  each_chord(move, [&](bool radial, std::size_t n, Nanometres from, Nanometres to, bool) {
    Ray& ray = radial ? along_r_[n] : along_z_[n];
    bool any = false;
    common(ray, from, to, [&](Nanometres a, Nanometres b) {
      any = true;
      if (radial) volume += ring(a, b, pitch_);
    });
    if (any) take(ray, from, to);
  });
  return volume;
}

TurningTouch TurnedStock::touch(const TurningMove& move) const {
  TurningTouch out;
  double volume_z = 0;
  each_chord(move, [&](bool radial, std::size_t n, Nanometres from, Nanometres to, bool) {
    const double across = (static_cast<double>(n) + 0.5) * pitch_;
    common(radial ? along_r_[n] : along_z_[n], from, to, [&](Nanometres a, Nanometres b) {
      const double depth = static_cast<double>(b - a) / nm;
      if (radial)
        out.volume += ring(a, b, pitch_);
      else
        volume_z += 2 * std::numbers::pi * across * pitch_ * depth;
      if (depth <= out.depth) return;
      const double middle = static_cast<double>(a + b) / 2 / nm;
      out.depth = depth;
      out.r = radial ? middle : across;
      out.z = radial ? across : middle;
    });
  });
  out.volume = std::max(out.volume, volume_z);
  return out;
}

void TurnedStock::each_stretch(const TurningMove& move,
                               const std::function<void(const TurningStretch&)>& see) const {
  each_chord(move, [&](bool radial, std::size_t n, Nanometres from, Nanometres to, bool beyond) {
    const double at = (static_cast<double>(n) + 0.5) * pitch_;
    common(radial ? along_r_[n] : along_z_[n], from, to, [&](Nanometres a, Nanometres b) {
      see({radial, beyond, at, static_cast<double>(a) / nm, static_cast<double>(b) / nm});
    });
  });
}

double TurnedStock::volume() const {
  double out = 0;
  for (const Ray& ray : along_r_)
    for (const auto& [lo, hi] : ray) out += ring(lo, hi, pitch_);
  return out;
}

std::size_t TurnedStock::bytes() const {
  std::size_t out = (along_r_.size() + along_z_.size()) * sizeof(Ray);
  for (const auto* family : {&along_r_, &along_z_})
    for (const Ray& ray : *family) out += ray.capacity() * sizeof(ray[0]);
  return out;
}

namespace {

std::vector<std::pair<double, double>> in_mm(const std::vector<Ray>& rays, double at,
                                             double pitch) {
  std::vector<std::pair<double, double>> out;
  const auto n = static_cast<std::size_t>(
      std::clamp(std::floor(at / pitch), 0.0, static_cast<double>(rays.size() - 1)));
  for (const auto& [lo, hi] : rays[n])
    out.emplace_back(static_cast<double>(lo) / nm, static_cast<double>(hi) / nm);
  return out;
}

}  // namespace

std::vector<std::pair<double, double>> TurnedStock::radii_at(double z) const {
  return in_mm(along_r_, z, pitch_);
}

std::vector<std::pair<double, double>> TurnedStock::heights_at(double r) const {
  return in_mm(along_z_, r, pitch_);
}

void TurnedStock::each_end(const std::function<void(double, double)>& see) const {
  const auto mm = [](Nanometres value) { return static_cast<double>(value) * 1e-6; };
  for (std::size_t k = 0; k < along_r_.size(); ++k)
    for (const auto& [from, to] : along_r_[k]) {
      const double z = (static_cast<double>(k) + 0.5) * pitch_;
      if (from > 0) see(mm(from), z);  // the axis is no surface
      see(mm(to), z);
    }
  for (std::size_t i = 0; i < along_z_.size(); ++i)
    for (const auto& [from, to] : along_z_[i]) {
      const double r = (static_cast<double>(i) + 0.5) * pitch_;
      see(r, mm(from));
      see(r, mm(to));
    }
}

std::string TurnedStock::hash() const {
  std::string bytes;
  const auto put = [&](std::int64_t v) {
    for (int b = 0; b < 8; ++b) bytes += static_cast<char>(v >> (8 * b) & 255);
  };
  for (const auto* family : {&along_r_, &along_z_})
    for (const Ray& ray : *family) {
      put(static_cast<std::int64_t>(ray.size()));
      for (const auto& [lo, hi] : ray) {
        put(lo);
        put(hi);
      }
    }
  return sha256(bytes);
}

// Marching squares over the nodes ((i + ½) pitch, (k + ½) pitch): between two neighbours of which
// one is material lies an end of the ray through them. The nodes are mirrored at the axis (column
// −1 is column 0), so loops that reach it end on it.
//
// A cell's outline goes from edge to edge with the material on its left. Where the ends are on
// lines that meet in the cell (the corner of a step) the meeting point would be lost; it is
// restored from the ends of the next rays on both sides.
std::vector<Loop> TurnedStock::outlines() const {
  const int nr = static_cast<int>(along_z_.size()), nz = static_cast<int>(along_r_.size());
  const auto place = [&](int n) { return (n + 0.5) * pitch_; };
  // Material by the rays along the radius; the others agree but for rounding.
  const auto inside = [&](int i, int k) {
    if (i < 0) i = 0;
    if (i >= nr || k < 0 || k >= nz) return false;
    const auto at = rounded(place(i));
    for (const auto& [lo, hi] : along_r_[static_cast<std::size_t>(k)])
      if (at >= lo && at < hi) return true;
    return false;
  };
  // The end of material between two nodes of a ray, nearest to their middle.
  const auto end_on = [&](const Ray* ray, int from) {
    const double low = place(from), middle = low + pitch_ / 2;
    double best = middle, off = pitch_;
    if (ray)
      for (const auto& [lo, hi] : *ray)
        for (const auto v : {lo, hi}) {
          const double u = static_cast<double>(v) / nm;
          if (std::abs(u - middle) < off) {
            off = std::abs(u - middle);
            best = u;
          }
        }
    return std::clamp(best, low, low + pitch_);
  };
  const auto ray_r = [&](int k) {
    return k >= 0 && k < nz ? &along_r_[static_cast<std::size_t>(k)] : nullptr;
  };
  const auto ray_z = [&](int i) {
    return i < nr ? &along_z_[static_cast<std::size_t>(std::max(i, 0))] : nullptr;
  };
  // An edge of a cell: (i, k, 0) along r from node (i, k), (i, k, 1) along z.
  using Edge = std::array<int, 3>;
  const auto point_of = [&](const Edge& e) {
    return e[2] == 0 ? std::pair(end_on(ray_r(e[1]), e[0]), place(e[1]))
                     : std::pair(std::max(place(e[0]), 0.0), end_on(ray_z(e[0]), e[1]));
  };
  std::map<Edge, Edge> next;
  for (int k = -1; k < nz; ++k)
    for (int i = -1; i < nr; ++i) {
      const std::array<bool, 4> in = {inside(i, k), inside(i + 1, k), inside(i + 1, k + 1),
                                      inside(i, k + 1)};
      const std::array<Edge, 4> edges = {Edge{i, k, 0}, Edge{i + 1, k, 1}, Edge{i, k + 1, 0},
                                         Edge{i, k, 1}};
      // Around the cell counter-clockwise (r to the right, z up). An outline with the material on
      // its left comes in where material begins and leaves where it ends.
      for (std::size_t e = 0; e < 4; ++e) {
        if (in[e] || !in[(e + 1) % 4]) continue;  // begins on edge e …
        for (std::size_t f = 1; f < 4; ++f) {
          const std::size_t g = (e + f) % 4;
          if (!(in[g] && !in[(g + 1) % 4])) continue;  // … and ends on edge g
          next[edges[g]] = edges[e];
          break;
        }
      }
    }
  std::vector<Loop> out;
  while (!next.empty()) {
    Loop loop;
    // Outlines that begin and end at the axis come first, from their beginning: nothing leads
    // there.
    const Edge start = next.begin()->first;
    Edge at = start;
    while (true) {
      const auto step = next.find(at);
      if (step == next.end()) {
        // Back at the beginning, or at the axis, where the loop is closed by a line on it.
        if (at != start) loop.push_back(point_of(at));
        break;
      }
      loop.push_back(point_of(at));
      at = step->second;
      next.erase(step);
    }
    if (loop.size() < 3) continue;
    // Corners: where two straight stretches meet inside of a cell.
    Loop sharp;
    const std::size_t n = loop.size();
    for (std::size_t i = 0; i < n; ++i) {
      const auto &a = loop[(i + n - 1) % n], &b = loop[i], &c = loop[(i + 1) % n],
                 &d = loop[(i + 2) % n];
      sharp.push_back(b);
      const double u1 = b.first - a.first, v1 = b.second - a.second;
      const double u2 = c.first - d.first, v2 = c.second - d.second;
      const double det = u1 * v2 - v1 * u2;
      if (std::abs(det) < 0.1 * std::hypot(u1, v1) * std::hypot(u2, v2)) continue;
      const double t = ((c.first - b.first) * v2 - (c.second - b.second) * u2) / det;
      const double s = ((c.first - b.first) * v1 - (c.second - b.second) * u1) / det;
      if (t <= 0 || s <= 0) continue;
      const std::pair corner(b.first + t * u1, b.second + t * v1);
      if (std::hypot(corner.first - b.first, corner.second - b.second) > 1.5 * pitch_) continue;
      if (std::hypot(corner.first - c.first, corner.second - c.second) > 1.5 * pitch_) continue;
      sharp.emplace_back(std::max(corner.first, 0.0), corner.second);
    }
    out.push_back(thinned(sharp, pitch_ / 100));
  }
  return out;
}

TriangleMesh TurnedStock::mesh(double facets) const {
  TriangleMesh out;
  const std::vector<Loop> loops = outlines();
  double largest = 0;
  for (const Loop& loop : loops)
    for (const auto& p : loop) largest = std::max(largest, p.first);
  if (!(largest > 0)) return out;
  const double half = std::acos(std::clamp(1 - facets / largest, 0.5, 1.0 - 1e-7));
  const auto count = static_cast<std::uint32_t>(
      (static_cast<int>(std::ceil(std::numbers::pi / half)) + 3) / 4 * 4);
  for (const Loop& loop : loops) {
    // A ring of vertices for each point, one vertex for a point on the axis.
    std::vector<std::uint32_t> first;
    for (const auto& [r, z] : loop) {
      first.push_back(static_cast<std::uint32_t>(out.vertices.size()));
      for (std::uint32_t i = 0; i < (r > 0 ? count : 1); ++i) {
        const double a = 2 * std::numbers::pi * i / count;
        out.vertices.emplace_back(r * std::cos(a), r * std::sin(a), z);
      }
    }
    for (std::size_t p = 0; p < loop.size(); ++p) {
      const std::size_t q = (p + 1) % loop.size();
      const bool ring_p = loop[p].first > 0, ring_q = loop[q].first > 0;
      for (std::uint32_t i = 0; i < count && (ring_p || ring_q); ++i) {
        const std::uint32_t j = (i + 1) % count;
        const auto at = [&](std::size_t n, bool wide, std::uint32_t k) {
          return first[n] + (wide ? k : 0);
        };
        const std::uint32_t a = at(p, ring_p, i), b = at(p, ring_p, j);
        const std::uint32_t c = at(q, ring_q, j), d = at(q, ring_q, i);
        // Seen from outside: up the left side of the material, turning with the angle.
        if (ring_p) out.triangles.push_back({a, b, c});
        if (ring_q) out.triangles.push_back({a, c, d});
      }
    }
  }
  return out;
}

}  // namespace aircut::stock
