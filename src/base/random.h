// Random numbers that are the same with every compiler (the standard's distributions are not).
#pragma once

#include <cstdint>

namespace aircut {

/// Splitmix64: one addition and three mixing steps per number.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  /// Even in [low, high].
  double between(double low, double high) {
    constexpr double step = 1.0 / 9007199254740992.0;  // 2⁻⁵³
    return low + (high - low) * (static_cast<double>(next() >> 11) * step);
  }

 private:
  std::uint64_t state_;
};

}  // namespace aircut
