#include "tool/keys.h"

#include <algorithm>

#include "tool/cutter.h"

namespace aircut::tool {

using config::Table;

std::optional<double> Lengths::optional(const std::string& key, bool zero_allowed) {
  const auto value = table_.number(key);
  if (!value) {
    good_ = good_ && !table_.has(key);
    return std::nullopt;
  }
  const double mm = *value * unit_mm_;
  if (mm < 0 || (mm == 0 && !zero_allowed)) {
    fail(key, zero_allowed ? "'" + key + "' needs a length of 0 or more"
                           : "'" + key + "' needs a length of more than 0");
    return std::nullopt;
  }
  if (mm > largest_length) {
    fail(key, "'" + key + "' is longer than 100 m");
    return std::nullopt;
  }
  return mm;
}

double Lengths::required(const std::string& key) {
  if (!table_.has(key)) {
    table_.required_number(key);
    good_ = false;
  }
  return optional(key, false).value_or(1);
}

std::optional<double> Lengths::angle(const std::string& key, double low, double high) {
  const auto value = table_.number(key);
  if (!value) {
    good_ = good_ && !table_.has(key);
    return std::nullopt;
  }
  if (*value > low && *value < high) return *value * radians_per_degree;
  fail(key, "'" + key + "' needs an angle between " + shortest(low) + " and " + shortest(high) +
                " degrees");
  return std::nullopt;
}

double Lengths::required_angle(const std::string& key, double low, double high) {
  if (!table_.has(key)) {
    table_.required_number(key);
    good_ = false;
  }
  return angle(key, low, high).value_or(1);
}

void Lengths::fail(const std::string& key, const std::string& message) {
  table_.error(key, message);
  good_ = false;
}

std::optional<Profile> read_profile(Table& table, const std::string& key, double unit_mm) {
  if (!table.has(key)) {
    table.error(key, "'" + key + "' is missing: it needs points [[r, z], ...]");
    return std::nullopt;
  }
  const auto points = table.number_lists(key, 2);
  if (!points) return std::nullopt;
  const auto fail = [&](const std::string& message) {
    table.error(key, message);
    return std::nullopt;
  };
  if (points->size() < 2) return fail("'" + key + "' needs at least two points");
  Profile outline;
  double largest = 0;
  for (std::size_t i = 0; i < points->size(); ++i) {
    const double r = (*points)[i][0] * unit_mm, z = (*points)[i][1] * unit_mm;
    const std::string which = "point " + std::to_string(i + 1) + " of '" + key + "'";
    if (r < 0) return fail(which + " has a radius below 0");
    if (i == 0 && z != 0) return fail(which + " must have the height 0");
    if (i > 0 && z < outline.back().z) return fail(which + " lies below the point before it");
    if (r > largest_length || z > largest_length) return fail(which + " is beyond 100 m");
    largest = std::max(largest, r);
    append_point(outline, r, z);
  }
  if (largest == 0) return fail("'" + key + "' has no radius of more than 0");
  if (outline.back().z == 0) return fail("'" + key + "' has no height");
  return outline;
}

}  // namespace aircut::tool
