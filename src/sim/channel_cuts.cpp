#include "sim/channel_cuts.h"

#include <algorithm>
#include <cmath>

namespace aircut::sim {

void ChannelCuts::come_from(std::size_t channel, const machine::Machine& view,
                            const std::vector<int>& joints, const JointVector& now) {
  channel_ = channel;
  joints_ = joints;
  now_ = now;
  X_MC_ = whole_.X_LM().inverse(Eigen::Isometry) * view.X_LM();  // joints at zero: both from W
}

void ChannelCuts::on_cut(const Cut& seen) {
  Cut& cut = waiting_.emplace_back(seen);
  cut.channel = static_cast<int>(channel_);
  cut.joints = now_;
  for (std::size_t j = 0; j < joints_.size(); ++j)
    if (joints_[j] >= 0 && static_cast<Eigen::Index>(j) < seen.joints.size())
      cut.joints[joints_[j]] = seen.joints[static_cast<Eigen::Index>(j)];
  cut.point = X_MC_ * seen.point;
  for (Vec3 Cut::*direction : {&Cut::feed, &Cut::axis, &Cut::normal})
    cut.*direction = X_MC_.linear() * seen.*direction;
}

void ChannelCuts::bridge(Cut& cut) {
  const auto channel = static_cast<std::size_t>(cut.channel);
  if (ends_.size() <= channel) ends_.resize(channel + 1, -1);
  const double end = std::max(ends_[channel], last_begin_), pause = cut.t0 - end;
  if (ends_[channel] >= 0 && pause > 0 && pause * std::abs(cut.rpm) < 60) {
    cut.way *= (cut.t1 - end) / (cut.t1 - cut.t0);  // at the same feed
    cut.t0 = end;
  }
  ends_[channel] = cut.t1;
}

void ChannelCuts::hand_over() {
  for (Cut& cut : waiting_) bridge(cut);
  std::stable_sort(waiting_.begin(), waiting_.end(),
                   [](const Cut& a, const Cut& b) { return a.t0 < b.t0; });
  for (const Cut& cut : waiting_) to_.on_cut(cut);
  if (!waiting_.empty()) last_begin_ = waiting_.back().t0;
  waiting_.clear();
}

}  // namespace aircut::sim
