// With one channel each stretch begins where the one before ends, and passes as it came. With
// several a stretch stays open until a later one begins: what lies before that can no longer
// change. Times that differ by less than a nanosecond are rounding.
#include "process/together.h"

#include <algorithm>

namespace aircut::process {

namespace {

constexpr double little = 1e-9;     // s
constexpr double tolerated = 1e-6;  // s: so much a cut may begin early

sim::Cut piece_of(const sim::Cut& cut, double from, double to) {
  sim::Cut out = cut;
  const double whole = cut.t1 - cut.t0;
  if (from - cut.t0 < little && cut.t1 - to < little) return out;
  out.t0 = from;
  out.t1 = to;
  out.way *= (to - from) / whole;
  out.volume *= (to - from) / whole;
  return out;
}

}  // namespace

bool Together::add(const sim::Cut& cut) {
  if (cut.t0 < now_ - tolerated) return false;
  const bool alone = std::all_of(open_.begin(), open_.end(), [&](const sim::Cut& one) {
    return one.channel == cut.channel && one.t0 >= now_ - tolerated;
  });
  if (alone) {
    if (!open_.empty()) now_ = std::max(now_, std::min(open_.back().t1, cut.t0));
    for (sim::Cut& one : open_) {
      piece_.clear();
      piece_.push_back(std::move(one));
      take_(piece_);
    }
    open_.clear();
  } else {
    hand_over(cut.t0);
  }
  open_.push_back(cut);
  return true;
}

void Together::hand_over(double until) {
  while (!open_.empty()) {
    double from = until, to = until;
    for (const sim::Cut& cut : open_) from = std::min(from, std::max(cut.t0, now_));
    for (const sim::Cut& cut : open_) {
      if (cut.t0 > from + little) to = std::min(to, cut.t0);
      to = std::min(to, cut.t1);
    }
    if (to <= from + little && until <= from + little) return;
    if (to > from + little) {
      piece_.clear();
      for (const sim::Cut& cut : open_)
        if (cut.t0 <= from + little && cut.t1 > from + little) {
          std::erase_if(piece_, [&](const sim::Cut& one) { return one.channel == cut.channel; });
          piece_.push_back(piece_of(cut, std::max(from, cut.t0), to));
        }
      take_(piece_);
    }
    now_ = std::max(now_, to);
    std::erase_if(open_, [&](const sim::Cut& cut) { return cut.t1 <= now_ + little; });
  }
}

void Together::finish() {
  double last = now_;
  for (const sim::Cut& cut : open_) last = std::max(last, cut.t1);
  hand_over(last + 1);
}

}  // namespace aircut::process
