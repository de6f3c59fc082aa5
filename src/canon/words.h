// Numbers and words that the text, JSON and rs274 forms share. Private to canon.
#pragma once

#include <numbers>
#include <string>

#include "canon/canon.h"

namespace aircut::canon {

inline constexpr double degrees_per_radian = 180 / std::numbers::pi;
inline constexpr double seconds_per_minute = 60;
inline constexpr double mm_per_inch = 25.4;
inline constexpr double mm_per_foot = 304.8;
inline constexpr double mm_per_metre = 1000;

/// An axis value as people read it: mm, or degrees.
inline double shown(Axis axis, double value) {
  return is_rotary(axis) ? value * degrees_per_radian : value;
}

/// At most six decimals without trailing zeros: hides the last bits of a sum, keeps a nanometre.
inline std::string tidy(double value) {
  std::string out = fixed(value, 6);
  const auto last = out.find_last_not_of('0');
  out.erase(out[last] == '.' ? last : last + 1);
  return out == "-0" ? "0" : out;
}

/// G96 with a highest speed: without D the control has none, which is written as 1e30.
inline bool has_limit(const SetSpindleMode& mode) {
  return mode.css_max_rpm != 0 && mode.css_max_rpm < 1e9;
}

/// The Nth of a list of words; enumerators and words stand in the same order.
template <class Enum, std::size_t N>
constexpr const char* word(Enum value, const char* const (&words)[N]) {
  return words[static_cast<std::size_t>(value)];
}

inline constexpr const char* plane_words[] = {"xy", "zx", "yz", "uv", "wu", "vw"};
inline constexpr const char* feed_mode_words[] = {"per_minute", "inverse_time", "per_revolution"};
inline constexpr const char* unit_words[] = {"inch", "mm"};
inline constexpr const char* path_words[] = {"exact_path", "exact_stop", "continuous"};
inline constexpr const char* turn_words[] = {"stop", "cw", "ccw"};
inline constexpr const char* coolant_words[] = {"mist", "flood"};
inline constexpr const char* override_words[] = {"feed", "speed", "adaptive_feed", "feed_hold"};
inline constexpr const char* message_words[] = {"message", "debug", "print", "comment"};
inline constexpr const char* log_words[] = {"log_open",  "log_append", "log",
                                            "log_close", "probe_open", "probe_close"};

}  // namespace aircut::canon
