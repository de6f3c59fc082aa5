#include "plan/override.h"

#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace aircut::plan {

double Overrides::next() const {
  return next_ < events_.size() ? events_[next_].t : std::numeric_limits<double>::infinity();
}

void Overrides::apply(double t) {
  for (; next_ < events_.size() && events_[next_].t <= t; ++next_) {
    const OverrideEvent& event = events_[next_];
    switch (event.what) {
      case OverrideEvent::What::feed:
        feed_ = event.factor;
        break;
      case OverrideEvent::What::rapid:
        rapid_ = event.factor;
        break;
      case OverrideEvent::What::spindle:
        spindle_ = event.factor;
        break;
      case OverrideEvent::What::adaptive:
        adaptive_ = event.factor;
        break;
      case OverrideEvent::What::hold:
        held_ = true;
        break;
      case OverrideEvent::What::resume:
        held_ = false;
        break;
    }
  }
}

std::vector<double> feed_factors(const std::vector<OverrideEvent>& events) {
  if (events.empty()) return {};
  using What = OverrideEvent::What;
  std::set<double> out = {1};
  for (const What what : {What::feed, What::adaptive, What::spindle}) {
    const std::set<double> before = out;
    for (const OverrideEvent& event : events)
      if (event.what == what && event.factor > 0)
        for (const double factor : before) out.insert(factor * event.factor);
  }
  return {out.begin(), out.end()};
}

std::string wrong_overrides(const std::vector<OverrideEvent>& events) {
  using What = OverrideEvent::What;
  double last = 0;
  std::map<What, double> held;  // what waits for a later event, since when
  for (const OverrideEvent& event : events) {
    if (!std::isfinite(event.t) || event.t < 0 || !std::isfinite(event.factor) || event.factor < 0)
      return "an override needs a time and a factor of 0 or more";
    if (event.t < last)
      return "the override at " + shortest(event.t) + " s stands behind one at " + shortest(last) +
             " s; they must be in order of time";
    last = event.t;
    const bool to_hold =
        event.what == What::hold || (event.what != What::resume && event.factor == 0);
    const What what = event.what == What::resume ? What::hold : event.what;
    if (what == What::spindle) {
      if (event.factor == 0) return "a spindle's override must be above 0";
      continue;
    }
    if (to_hold)
      held.try_emplace(what, event.t);
    else
      held.erase(what);
  }
  if (held.empty()) return {};
  return "the motion that is held at " + shortest(held.begin()->second) +
         " s never goes on; a later event must let it go";
}

double Overrides::factor(const Segment& segment) const {
  const Overridable& may = segment.overridable;
  if (held_ && may.hold) return 0;
  double out = 1;
  if (may.feed) out *= segment.feed > 0 ? feed_ : rapid_;
  if (may.adaptive) out *= adaptive_;
  if (may.per_revolution && may.spindle) out *= spindle_;
  return out;
}

double Overrides::spindle(const Segment& segment) const {
  return segment.overridable.spindle ? spindle_ : 1;
}

}  // namespace aircut::plan
