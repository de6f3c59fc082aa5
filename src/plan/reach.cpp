// A finite bound of the joints' travel over a box of tips (Kinematics::travel_bound) says that
// every tip in the box can be reached. The piece is halved until each part has such a bound; a part
// that has none and is shorter than 1e-6 of the piece is decided by the inverse at its end. Parts
// are taken from left to right, so the first bad one is the first bad place.
//
// Dense programs ask for thousands of tiny parts side by side: a box that is proven is made larger
// than the piece, and what lies inside is not asked again (ProvenBox).
//
// A kinematics whose bounds are never finite would need a million parts: after `budget` questions
// the rest is looked at in 4096 places instead. (The simulator asks for bounds again and reports
// what it can't prove, so nothing becomes "fine" by this.)
#include "plan/reach.h"

namespace aircut::plan {
namespace {

using machine::JointVector;
using machine::Target;

class Search {
 public:
  Search(const machine::Kinematics& kinematics, const Path& path, const AxisValues& tool_offset,
         JointVector near, std::span<double> scratch)
      : kinematics_(kinematics),
        path_(path),
        tool_offset_(tool_offset),
        near_(std::move(near)),
        scratch_(scratch),
        smallest_(1e-6 * length(path)) {}

  std::optional<ReachLimit> run() {
    if (const auto reason = look(0)) return ReachLimit{0, 0, *reason};
    auto limit = split(0, length(path_));
    if (limit) limit->reason = reason_beyond(*limit);
    return limit;
  }

 private:
  // At the border the reason would speak of micrometres; in the middle of the stretch that can't be
  // reached it says how much is missing.
  std::string reason_beyond(const ReachLimit& limit) {
    constexpr int places = 64;
    const double end = length(path_);
    std::vector<std::string> reasons = {limit.reason};
    for (int i = 1; i <= places; ++i) {
      const auto reason = look(limit.bad + (end - limit.bad) * i / places);
      if (!reason) break;
      reasons.push_back(*reason);
    }
    const bool comes_back = reasons.size() <= places;
    return reasons[comes_back ? reasons.size() / 2 : reasons.size() - 1];
  }

  // Why s can't be reached; nothing when it can.
  std::optional<std::string> look(double s) {
    auto q = kinematics_.inverse(Target{evaluate(path_, s).p, tool_offset_}, near_);
    if (!q) return q.error().reason;
    near_ = std::move(*q);
    return std::nullopt;
  }

  bool proven(double s0, double s1) {
    if (budget_ == 0) return false;
    --budget_;
    machine::TipInterval tip = bounds(path_, s0, s1);
    tip.tool_offset = tool_offset_;
    tip.near = near_;
    return kinematics_.travel_bound(tip, scratch_);
  }

  // s0 is known to be good.
  std::optional<ReachLimit> split(double s0, double s1) {
    if (proven(s0, s1)) return std::nullopt;
    const bool coarse = budget_ == 0 && s1 - s0 <= length(path_) / 4096;
    if (s1 - s0 <= smallest_ || coarse) {
      const auto reason = look(s1);
      if (!reason) return std::nullopt;
      return s1 - s0 <= smallest_ ? ReachLimit{s0, s1, *reason} : bisect(s0, s1, *reason);
    }
    const double middle = s0 + (s1 - s0) / 2;
    if (auto bad = split(s0, middle)) return bad;
    return split(middle, s1);
  }

  ReachLimit bisect(double good, double bad, std::string reason) {
    while (bad - good > smallest_) {
      const double middle = good + (bad - good) / 2;
      if (auto why = look(middle)) {
        bad = middle;
        reason = std::move(*why);
      } else {
        good = middle;
      }
    }
    return {good, bad, std::move(reason)};
  }

  const machine::Kinematics& kinematics_;
  const Path& path_;
  const AxisValues& tool_offset_;
  JointVector near_;
  std::span<double> scratch_;
  double smallest_;
  int budget_ = 4096;
};

}  // namespace

bool ProvenBox::holds(const machine::TipInterval& tip) const {
  if (!known_) return false;
  for (std::size_t k = 0; k < tip.low.value.size(); ++k)
    if (tip.low.value[k] < box_.low.value[k] || tip.high.value[k] > box_.high.value[k] ||
        tip.tool_offset.value[k] != box_.tool_offset.value[k])
      return false;
  return true;
}

bool ProvenBox::widen(const machine::Kinematics& kinematics, const machine::TipInterval& tip,
                      std::span<double> scratch) {
  constexpr double most = 2, per_rad = 100;
  // Only the axes that move have room, and only small pieces are worth it.
  machine::TipInterval box = tip;
  double size = 0;
  for (const Axis axis : all_axes) {
    const double way = tip.high[axis] - tip.low[axis], unit = is_rotary(axis) ? per_rad : 1;
    if (!(way > 0)) continue;
    size = std::max(size, way * unit);
    box.low[axis] -= margin_ / unit;
    box.high[axis] += margin_ / unit;
    box.travel[axis] = box.high[axis] - box.low[axis];
  }
  if (size > margin_ / 2) {
    margin_ = std::min(2 * margin_, most);  // after a box that was not proven
    return false;
  }
  if (!kinematics.travel_bound(box, scratch)) {
    margin_ /= 2;
    return false;
  }
  margin_ = std::min(2 * margin_, most);
  box_ = std::move(box);
  known_ = true;
  return true;
}

std::optional<ReachLimit> find_reach_limit(const machine::Kinematics& kinematics, const Path& path,
                                           const AxisValues& tool_offset,
                                           const machine::JointVector& near,
                                           std::span<double> scratch, ProvenBox& proven) {
  // Where each joint is an axis there is no tip without joints.
  if (kinematics.type() == "identity") return std::nullopt;
  machine::TipInterval whole = bounds(path, 0, length(path));
  whole.tool_offset = tool_offset;
  if (proven.holds(whole)) return std::nullopt;
  whole.near = near;
  if (proven.widen(kinematics, whole, scratch)) return std::nullopt;
  return Search(kinematics, path, tool_offset, near, scratch).run();
}

}  // namespace aircut::plan
