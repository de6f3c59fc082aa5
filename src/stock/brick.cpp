#include "stock/brick.h"

#include <algorithm>
#include <cmath>

namespace aircut::stock {

NormalCode encode_normal(const Vec3& n) {
  const double sum = std::abs(n.x()) + std::abs(n.y()) + std::abs(n.z());
  if (!(sum > 0)) return 0;
  double u = n.x() / sum, v = n.y() / sum;
  if (n.z() < 0) {  // the lower half is folded over the corners of the square
    const double fold_u = (1 - std::abs(v)) * (u < 0 ? -1 : 1);
    v = (1 - std::abs(u)) * (v < 0 ? -1 : 1);
    u = fold_u;
  }
  const auto code = [](double x) { return static_cast<unsigned>(x * 127 + 128.5); };
  return static_cast<NormalCode>(code(u) << 8 | code(v));
}

Vec3 decode_normal(NormalCode code) {
  double u = ((code >> 8) - 128) / 127.0, v = ((code & 255) - 128) / 127.0;
  const double z = 1 - std::abs(u) - std::abs(v);
  if (z < 0) {
    const double fold_u = (1 - std::abs(v)) * (u < 0 ? -1 : 1);
    v = (1 - std::abs(u)) * (v < 0 ? -1 : 1);
    u = fold_u;
  }
  return Vec3(u, v, z).normalized();
}

void RayFamily::make_block() {
  if (block) return;
  block = std::make_unique<RayBlock>();
  for (int ray = 0; ray < rays; ++ray) {
    const bool here = full[static_cast<std::size_t>(ray / cells)] >> (ray % cells) & 1;
    const auto i = static_cast<std::size_t>(ray);
    block->lo[i] = block->normal_lo[i] = block->normal_hi[i] = 0;
    block->hi[i] = here ? brick_quanta : 0;
  }
}

bool RayFamily::row_empty(int row) const {
  for (const ExtraInterval& e : extra)
    if (e.ray / cells == row) return false;
  if (!block) return full[static_cast<std::size_t>(row)] == 0;
  const auto first = static_cast<std::size_t>(row * cells);
  bool any = false;
  for (std::size_t i = first; i < first + cells; ++i) any |= block->lo[i] < block->hi[i];
  return !any;
}

bool RayFamily::empty() const {
  if (!extra.empty()) return false;
  for (int row = 0; row < cells; ++row)
    if (!row_empty(row)) return false;
  return true;
}

void RayFamily::intervals(int ray, std::vector<Interval>& out) const {
  out.clear();
  const auto i = static_cast<std::size_t>(ray);
  if (!block) {
    if (full[i / cells] >> (i % cells) & 1) out.push_back({0, brick_quanta, 0, 0});
  } else if (block->lo[i] < block->hi[i]) {
    out.push_back({block->lo[i], block->hi[i], block->normal_lo[i], block->normal_hi[i]});
  }
  for (const ExtraInterval& e : extra)
    if (e.ray == ray) out.push_back(e.interval);
  if (out.size() > 1)
    std::sort(out.begin(), out.end(),
              [](const Interval& a, const Interval& b) { return a.lo < b.lo; });
  for (Interval& interval : out) {
    if (interval.lo == 0) interval.normal_lo = 0;
    if (interval.hi == brick_quanta) interval.normal_hi = 0;
  }
}

std::int64_t RayFamily::quanta() const {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < rays; ++i) {
    if (block)
      sum += std::max(block->hi[i] - block->lo[i], 0);
    else if (full[i / cells] >> (i % cells) & 1)
      sum += brick_quanta;
  }
  for (const ExtraInterval& e : extra) sum += e.interval.hi - e.interval.lo;
  return sum;
}

std::uint16_t RayFamily::top(int row) const {
  std::uint16_t top = 0;
  if (!block) {
    top = full[static_cast<std::size_t>(row)] != 0 ? brick_quanta : 0;
  } else {
    const auto first = static_cast<std::size_t>(row * cells);
    for (std::size_t i = first; i < first + cells; ++i) {
      const std::uint16_t here = block->lo[i] < block->hi[i] ? block->hi[i] : std::uint16_t{0};
      top = top > here ? top : here;
    }
  }
  for (const ExtraInterval& e : extra)
    if (e.ray / cells == row) top = std::max(top, e.interval.hi);
  return top;
}

int Brick::z_top() const { return *std::max_element(z_tops.begin(), z_tops.end()); }

bool Brick::empty() const {
  return std::all_of(family.begin(), family.end(), [](const RayFamily& f) { return f.empty(); });
}

std::unique_ptr<Brick> Brick::clone() const {
  auto out = std::make_unique<Brick>();
  for (std::size_t f = 0; f < 3; ++f) {
    if (family[f].block) out->family[f].block = std::make_unique<RayBlock>(*family[f].block);
    out->family[f].full = family[f].full;
    out->family[f].extra = family[f].extra;
  }
  out->z_tops = z_tops;
  out->rows = rows;
  return out;
}

std::size_t Brick::bytes() const {
  std::size_t out = sizeof(Brick);
  for (const RayFamily& f : family)
    out += (f.block ? sizeof(RayBlock) : 0) + f.extra.capacity() * sizeof(ExtraInterval);
  return out;
}

}  // namespace aircut::stock
