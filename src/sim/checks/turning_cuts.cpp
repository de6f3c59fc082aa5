#include "sim/checks/turning_cuts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "sim/checks/tool_way.h"

namespace aircut::sim {
namespace {

constexpr double least_depth = 1e-4;  // mm: less is a touch
constexpr double same_depth = 0.1;    // of the first one's, …
constexpr double little = 0.01;       // … or in mm
constexpr double same_way = 0.996;    // cosine of 5 degrees
constexpr double goes_on = 0.85;      // cosine between moves that belong together

struct Extent {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void offer(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

}  // namespace

Pose stock_at_rest(const machine::Machine& machine, const machine::RawStock& raw,
                   const JointVector& joints) {
  thread_local machine::LinkPoses poses;
  machine::forward(machine, joints, poses);
  const Pose& X_WL = poses.X_WL[static_cast<std::size_t>(machine::index(raw.link))];
  return machine.X_LM().inverse(Eigen::Isometry) * X_WL * raw.X_LS;
}

Cut cut_at(const Step& step) {
  Cut out;
  out.span = step.segment.command.span;
  out.block = step.segment.command.block;
  out.tool = step.scene.loaded_tool();
  out.rpm = step.segment.spindle_rpm;
  out.threads = step.segment.sync.has_value();
  return out;
}

// Forgets what belongs to another pass.
void TurningCuts::begin(const stock::TurningMove& move, double fr, double fz) {
  const bool on = std::hypot(move.r0 - r_, move.z0 - z_) < 1e-6 && fr * fr_ + fz * fz_ > goes_on;
  if (!on)
    for (auto& family : rays_) family.clear();
  r_ = move.r1;
  z_ = move.z1;
  fr_ = fr;
  fz_ = fz;
}

void TurningCuts::look(const stock::TurnedStock& stock, const stock::TurningMove& move, double s0,
                       double s1) {
  const double dr = move.r1 - move.r0, dz = move.z1 - move.z0, way = std::hypot(dr, dz);
  if (!(way > 1e-9)) return;
  const double fr = dr / way, fz = dz / way;
  begin(move, fr, fz);
  const bool radial = std::abs(fz) >= std::abs(fr);  // the rays that stand most across the way
  const double mr = -fz, mz = fr;                    // across it, on either side
  Extent tool, taken;
  for (const auto& disc : move.section->discs)
    for (const double side : {-1.0, 1.0})
      tool.offer(mr * (disc.r + move.r0) + mz * (disc.z + move.z0) + side * disc.radius);
  // What is beyond the axis only counts for tools that come from there.
  const bool beyond = move.r0 + move.r1 < 0;
  const double sign = beyond ? -1 : 1;
  stock.each_stretch(move, [&](const stock::TurningStretch& s) {
    if (s.beyond != beyond) return;
    const double length = s.to - s.from;
    const double low = s.along_r ? s.from : s.at, high = s.along_r ? s.to : s.at;
    const auto [place, fresh] = rays_[s.along_r ? 1 : 0].try_emplace(s.at, Ray{0, 0, low, high});
    Ray& ray = place->second;
    ray.length += length;
    ray.low = std::min(ray.low, low);
    ray.high = std::max(ray.high, high);
    ray.volume +=
        std::numbers::pi * stock.pitch() * length * (s.along_r ? s.to + s.from : 2 * s.at);
    for (const double end : {s.from, s.to})
      taken.offer(mr * sign * (s.along_r ? end : s.at) + mz * (s.along_r ? s.at : end));
  });
  if (taken.low > taken.high) return;
  const double under = taken.low - tool.low, over = tool.high - taken.high;
  const double side = under <= over ? 1 : -1;  // of the strip, seen from the new surface
  const double nr = side * mr, nz = side * mz;
  const bool plunge = std::max(under, over) < stock.pitch();
  // The tool's point that makes the surface, at the start of the move.
  double r = 0, z = 0, deepest = std::numeric_limits<double>::infinity();
  for (const auto& disc : move.section->discs) {
    const double reach = nr * disc.r + nz * disc.z - disc.radius;
    if (reach >= deepest) continue;
    deepest = reach;
    r = move.r0 + disc.r - disc.radius * nr;
    z = move.z0 + disc.z - disc.radius * nz;
  }
  const double across = std::abs(radial ? nr : nz), along = std::abs(radial ? fz : fr);
  const std::size_t first = samples_.size();
  for (const bool along_r : {false, true}) {
    const double speed = along_r ? fz : fr;
    if (std::abs(speed) < 1e-3) continue;
    std::erase_if(rays_[along_r ? 1 : 0], [&](const auto& entry) {
      const auto& [at, ray] = entry;
      const double gone = along_r ? (at - z) / speed : (sign * at - r) / speed;
      if (gone > way) return false;
      const double depth = ray.length * across;
      if (along_r == radial && gone >= 0 && depth >= least_depth)
        samples_.push_back({s0 + (s1 - s0) * gone / way, stock.pitch() / along, depth, ray.volume,
                            r + gone * fr, z + gone * fz, fr, fz, nr, nz, ray.low, ray.high,
                            plunge});
      return true;
    });
  }
  std::stable_sort(samples_.begin() + static_cast<std::ptrdiff_t>(first), samples_.end(),
                   [](const Sample& a, const Sample& b) { return a.s < b.s; });
}

bool TurningCuts::together(const Sample& first, const Sample& last, const Sample& next) const {
  return next.plunge == first.plunge &&
         std::abs(next.depth - first.depth) <= std::max(little, same_depth * first.depth) &&
         next.fr * first.fr + next.fz * first.fz >= same_way &&
         next.nr * first.nr + next.nz * first.nz > 0 && next.s - last.s <= 2 * next.length &&
         next.s - first.s < longest_cut;
}

void TurningCuts::hand_over(const Step& step, const machine::RawStock& raw, const Vec3& across,
                            double pitch, CutListener& out) {
  Cut pattern = cut_at(step);
  pattern.turned = true;
  pattern.pitch = pitch;
  const auto place = [&](double r, double z) { return Vec3(r * across + z * Vec3::UnitZ()); };
  const double end = plan::length(step.segment.path);
  for (std::size_t from = 0; from < samples_.size();) {
    std::size_t to = from + 1;
    while (to < samples_.size() && together(samples_[from], samples_[to - 1], samples_[to])) ++to;
    const Sample &first = samples_[from], &last = samples_[to - 1];
    const Sample& middle = samples_[(from + to) / 2];
    Cut cut = pattern;
    Extent radii;
    double sum = 0, count = 0;
    for (std::size_t i = from; i < to; ++i) {
      sum += samples_[i].depth;
      cut.volume += samples_[i].volume;
      radii.offer(samples_[i].low);
      radii.offer(samples_[i].high);
      ++count;
    }
    cut.depth = sum / count;
    cut.plunge = first.plunge;
    const double s0 = std::clamp(first.s - first.length / 2, 0.0, end);
    const double s1 = std::clamp(last.s + last.length / 2, s0, end);
    cut.way = s1 - s0;
    cut.t0 = time_at(step, s0);
    cut.t1 = time_at(step, s1);
    if (const auto joints = step.motion.at(0.5 * (cut.t0 + cut.t1))) cut.joints = *joints;
    const Pose X_MS = stock_at_rest(step.scene.machine(), raw, cut.joints);
    cut.point_part = place(middle.r, middle.z);
    cut.point = X_MS * cut.point_part;
    cut.feed = X_MS.linear() * place(middle.fr, middle.fz);
    cut.normal = X_MS.linear() * place(middle.nr, middle.nz);
    cut.outer = 2 * radii.high;
    cut.mean = radii.low + radii.high;
    from = to;
    if (cut.t1 > cut.t0) out.on_cut(cut);
  }
  samples_.clear();
}

}  // namespace aircut::sim
