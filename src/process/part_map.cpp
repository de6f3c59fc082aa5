// Each place of the surface (the middle of a triangle) asks which stretch of a tool's way has it on
// the surface that the tool sweeps, within the pitch of the stock's lattice: of those that are as
// near as the nearest, the last in time made it. Milled, the error is how far the tool was moved
// along the place's own normal; turned, the stretch's error holds all around, and places are
// compared by radius and height. A grid over the places says which ones a stretch may have made.
#include "process/part_map.h"

#include <algorithm>
#include <cmath>

namespace aircut::process {

namespace {

constexpr double same = 0.25;   // of the pitch: distances that do not tell stretches apart
constexpr double facing = 0.5;  // cosine: a turned surface looks the way its stretch says

Vec3 in_half_plane(const Vec3& place) { return {std::hypot(place.x(), place.y()), 0, place.z()}; }

}  // namespace

class PartMap::Grid {
 public:
  explicit Grid(const std::vector<Vec3>& places) {
    for (const Vec3& place : places) box_.extend(place);
    if (places.empty()) return;
    cell_ = std::max(box_.sizes().maxCoeff() / 96, 1e-3);
    for (int a = 0; a < 3; ++a) count_[a] = static_cast<int>(box_.sizes()[a] / cell_) + 1;
    starts_.assign(static_cast<std::size_t>(count_[0] * count_[1] * count_[2]) + 1, 0);
    std::vector<std::size_t> of;
    for (const Vec3& place : places) {
      of.push_back(index(cell(place, 0), cell(place, 1), cell(place, 2)));
      ++starts_[of.back() + 1];
    }
    for (std::size_t i = 1; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
    entries_.resize(places.size());
    auto next = starts_;
    for (std::size_t i = 0; i < places.size(); ++i) entries_[next[of[i]]++] = i;
  }

  template <typename Visit>
  void visit(const Box3& where, const Visit& take) const {
    if (entries_.empty() || !box_.intersects(where)) return;
    for (int x = cell(where.min(), 0); x <= cell(where.max(), 0); ++x)
      for (int y = cell(where.min(), 1); y <= cell(where.max(), 1); ++y)
        for (int z = cell(where.min(), 2); z <= cell(where.max(), 2); ++z)
          for (std::size_t i = starts_[index(x, y, z)]; i < starts_[index(x, y, z) + 1]; ++i)
            take(entries_[i]);
  }

 private:
  int cell(const Vec3& place, int a) const {
    return static_cast<int>(
        std::clamp((place[a] - box_.min()[a]) / cell_, 0.0, static_cast<double>(count_[a] - 1)));
  }
  std::size_t index(int x, int y, int z) const {
    return static_cast<std::size_t>((x * count_[1] + y) * count_[2] + z);
  }

  Box3 box_;
  double cell_ = 1;
  std::array<int, 3> count_{};
  std::vector<std::size_t> starts_, entries_;
};

void PartMap::add(const machine::Machine& machine, const Engaged& engaged, const Answer& found) {
  const sim::Cut& cut = *engaged.cut;
  if (!keeps_ || !machine.stock() || cut.joints.size() == 0) return;
  const Mat3 R_SM = sim::stock_at_rest(machine, *machine.stock(), cut.joints).linear().transpose();
  const Vec3 half = R_SM * cut.feed * (cut.way / 2);
  Mark mark;
  mark.from = cut.point_part - half;
  mark.to = cut.point_part + half;
  mark.reach = cut.pitch;
  mark.turned = cut.turned;
  if (cut.turned) {
    mark.from = in_half_plane(mark.from);
    mark.to = in_half_plane(mark.to);
    // A tool on the other side of the axis turns the same surface.
    Vec3 normal = R_SM * engaged.contact.normal;
    const Vec3 radial = Vec3(cut.point_part.x(), cut.point_part.y(), 0).normalized();
    mark.moved = {normal.dot(radial), 0, normal.z()};
    mark.error = found.delta;
  } else {
    const accuracy::Cutter* cutter = engaged.cutter;
    mark.axis = R_SM * cut.axis;
    mark.moved = R_SM * found.moved.displacement;
    mark.radius = engaged.contact.diameter / 2;
    mark.height = engaged.contact.t;
    mark.ball = cutter && cutter->shape == accuracy::Cutter::Shape::ball;
    if (cutter && cutter->shape == accuracy::Cutter::Shape::taper)
      mark.slope = std::tan(cutter->half_angle);
  }
  marks_.push_back(mark);
}

std::optional<double> PartMap::away(const Mark& mark, const Vec3& place) {
  const auto near = [&](double distance) {
    return distance <= mark.reach ? std::optional(distance) : std::nullopt;
  };
  const Vec3 way = mark.to - mark.from;
  const double length2 = way.squaredNorm();
  const auto nearest = [&](const Vec3& p) {
    const double s = length2 > 0 ? std::clamp((p - mark.from).dot(way) / length2, 0.0, 1.0) : 0;
    return Vec3(mark.from + s * way);
  };
  if (mark.turned) return near((place - nearest(place)).norm());
  if (mark.ball) {
    const Vec3 centre = nearest(place - mark.radius * mark.axis) + mark.radius * mark.axis;
    const Vec3 r = place - centre;
    const double above = r.dot(mark.axis);
    if (above > mark.height - mark.radius + mark.reach) return std::nullopt;
    return near(std::abs((above > 0 ? Vec3(r - above * mark.axis) : r).norm() - mark.radius));
  }
  // The tip's place nearest across the axis; down its way the height changes as well.
  const Vec3 flat = way - mark.axis.dot(way) * mark.axis;
  const double flat2 = flat.squaredNorm();
  const double s = flat2 > 1e-12 ? std::clamp((place - mark.from).dot(flat) / flat2, 0.0, 1.0) : 1;
  const Vec3 r = place - (mark.from + s * way);
  const double above = r.dot(mark.axis), out = (r - above * mark.axis).norm();
  if (above < -mark.reach || above > mark.height + mark.reach) return std::nullopt;
  const double wall =
      std::abs(out - mark.radius - mark.slope * std::max(above, 0.0)) / std::hypot(1, mark.slope);
  const double floor = out <= mark.radius + mark.reach ? std::abs(above) : mark.reach * 2;
  return near(std::min(wall, floor));
}

std::optional<double> PartMap::error_at(const Mark& mark, const Vec3& place, const Vec3& normal) {
  if (!mark.turned) return normal.dot(mark.moved);
  const double radius = std::hypot(place.x(), place.y());
  const double radial = radius > 0 ? (normal.x() * place.x() + normal.y() * place.y()) / radius : 0;
  if (radial * mark.moved.x() + normal.z() * mark.moved.z() < facing) return std::nullopt;
  return mark.error;
}

std::vector<std::optional<double>> PartMap::on(const TriangleMesh& mesh) const {
  std::vector<Vec3> places, turned, normals;
  for (const auto& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    places.push_back((a + b + c) / 3);
    turned.push_back(in_half_plane(places.back()));
    normals.push_back((b - a).cross(c - a).normalized());
  }
  const Grid around(places), revolved(turned);
  std::vector<std::optional<double>> out(places.size());
  std::vector<double> best(places.size(), 1e9);
  for (const Mark& mark : marks_) {
    Box3 box(mark.from.cwiseMin(mark.to), mark.from.cwiseMax(mark.to));
    const double wide =
        mark.turned ? 0
                    : mark.radius + mark.slope * mark.height + std::max(mark.height, mark.radius);
    box.min().array() -= wide + mark.reach;
    box.max().array() += wide + mark.reach;
    const std::vector<Vec3>& of = mark.turned ? turned : places;
    (mark.turned ? revolved : around).visit(box, [&](std::size_t i) {
      const auto distance = away(mark, of[i]);
      if (!distance || *distance > best[i] + same * mark.reach) return;
      const auto error = error_at(mark, places[i], normals[i]);
      if (!error) return;
      out[i] = error;
      best[i] = std::min(best[i], *distance);
    });
  }
  return out;
}

}  // namespace aircut::process
