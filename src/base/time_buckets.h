// What happened when, in a bounded number of equal stretches of time.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace aircut {

/// Stretches of equal width from t = 0 on; where the time outgrows `most` of them, two and two
/// become one. `Value` is default constructible and has merge(const Value&). Times in s, >= 0.
template <class Value>
class TimeBuckets {
 public:
  explicit TimeBuckets(std::size_t most = 2000, double width = 0.01)
      : most_(std::max<std::size_t>(most, 2)), width_(width) {}

  /// Calls add(value, share) for the stretches that [t0, t1] meets; the shares of [t0, t1] in them
  /// add up to 1.
  template <class Add>
  void over(double t0, double t1, const Add& add) {
    while (t1 / width_ >= static_cast<double>(most_)) halve();
    const auto first = static_cast<std::size_t>(std::max(0.0, t0) / width_);
    const auto last = std::max(first, static_cast<std::size_t>(std::max(0.0, t1) / width_));
    if (last >= values_.size()) values_.resize(last + 1);
    for (std::size_t i = first; i <= last; ++i) {
      const double from = std::max(t0, static_cast<double>(i) * width_);
      const double to = std::min(t1, static_cast<double>(i + 1) * width_);
      add(values_[i], first == last ? 1 : std::max(0.0, to - from) / (t1 - t0));
    }
  }

  double width() const { return width_; }  ///< s
  const std::vector<Value>& values() const { return values_; }

 private:
  void halve() {
    for (std::size_t i = 1; i < values_.size(); ++i)
      if (i % 2 == 0)
        values_[i / 2] = std::move(values_[i]);
      else
        values_[i / 2].merge(values_[i]);
    values_.resize((values_.size() + 1) / 2);
    width_ *= 2;
  }

  std::size_t most_;
  double width_;
  std::vector<Value> values_;
};

}  // namespace aircut
