#include "accuracy/size.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace aircut::accuracy {

double size_error(SizeKind kind, double delta) {
  switch (kind) {
    case SizeKind::outside_diameter:
      return 2 * delta;
    case SizeKind::bore_diameter:
      return -2 * delta;
    case SizeKind::length:
    case SizeKind::width:
    case SizeKind::profile:
      break;
  }
  return delta;
}

double normal_error(const Vec3& normal, const Vec3& w) { return normal.dot(w); }

double normal_error_exact(const Vec3& normal, const Vec3& axis, const Vec3& arm, const Vec3& w) {
  const Vec3 radial = arm - axis * axis.dot(arm);
  const double R = radial.norm();
  if (!(R > 0)) return normal.dot(w);
  const Vec3 out = radial / R;
  const double w_r = out.dot(w), w_t = axis.cross(out).dot(w);
  return normal.dot(w) + normal.dot(out) * (std::hypot(R + w_r, w_t) - (R + w_r));
}

std::vector<ActiveSegment> active_segments(std::span<const Span> contacts) {
  std::set<double> cuts;
  for (const Span& span : contacts) {
    cuts.insert(span.from);
    cuts.insert(span.to);
  }
  std::vector<ActiveSegment> out;
  for (auto it = cuts.begin(); it != cuts.end() && std::next(it) != cuts.end(); ++it) {
    ActiveSegment segment{*it, *std::next(it), {}};
    for (std::size_t k = 0; k < contacts.size(); ++k)
      if (contacts[k].from <= segment.from && contacts[k].to >= segment.to)
        segment.active.push_back(k);
    if (!segment.active.empty()) out.push_back(std::move(segment));
  }
  return out;
}

std::vector<ErrorShare> error_shares(const Structure& structure, std::span<const Contact> contacts,
                                     std::span<const Load> loads, std::size_t k,
                                     const Vec3& normal) {
  std::vector<std::vector<int>> sides;
  for (const Contact& contact : contacts) sides.push_back(structure.signs(contact));
  std::vector<ErrorShare> out;
  for (std::size_t b = 0; b < structure.bodies().size(); ++b)
    for (std::size_t l = 0; l < contacts.size(); ++l) {
      const int sign = sides[k][b] * sides[l][b];
      if (sign == 0) continue;
      const Mat6 B =
          sign * body_influence(structure.bodies()[b], contacts[k].point, contacts[l].point);
      const double delta = normal.dot(B.topLeftCorner<3, 3>() * loads[l].force +
                                      B.topRightCorner<3, 3>() * loads[l].moment);
      if (delta != 0) out.push_back({b, l, delta});
    }
  return out;
}

}  // namespace aircut::accuracy
