// Speeds and accelerations are looked at just inside both ends of a stretch, where they are largest
// on a straight way, and the stretches are short where the way bends; the jerk is the change of the
// acceleration between them over the time.
#include "page/rates.h"

#include <algorithm>
#include <cmath>

namespace aircut::page {
namespace {

constexpr double inside = 1e-3;            // of the stretch
constexpr double shortest_stretch = 1e-5;  // s: below, differences of accelerations say nothing

}  // namespace

void Rates::Peaks::merge(const Peaks& other) {
  if (of.size() < other.of.size()) of.resize(other.of.size());
  for (std::size_t i = 0; i < other.of.size(); ++i) of[i] = std::max(of[i], other.of[i]);
}

void Rates::look(const sim::Step& step, double t0, double t1) {
  const double span = t1 - t0;
  const auto first = step.motion.state_at(t0 + inside * span);
  const auto last = step.motion.state_at(t1 - inside * span);
  if (!first || !last) return;  // the run tells why
  here_.of.clear();
  const Eigen::Index joints = first->q.size();
  for (Eigen::Index j = 0; j < joints; ++j) {
    const double change = std::abs(last->a[j] - first->a[j]) / (span * (1 - 2 * inside));
    here_.of.push_back(static_cast<float>(std::max(std::abs(first->v[j]), std::abs(last->v[j]))));
    here_.of.push_back(static_cast<float>(std::max(std::abs(first->a[j]), std::abs(last->a[j]))));
    here_.of.push_back(span > shortest_stretch ? static_cast<float>(change) : 0.f);
  }
  peaks_.over(t0, t1, [&](Peaks& peaks, double) { peaks.merge(here_); });
}

}  // namespace aircut::page
