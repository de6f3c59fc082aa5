#include "machine/kinematics/parameters.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aircut::machine {

double Parameters::length(const std::string& key, double fallback) {
  return machine::length(input_.table, key, fallback, input_.unit_mm);
}

double Parameters::positive(const std::string& key, double fallback) {
  const double value = length(key, fallback);
  if (value > 0) return value;
  fail(key, "'" + key + "' must be more than 0, this is " + shortest(value / input_.unit_mm));
  return fallback;
}

double Parameters::angle(const std::string& key, double fallback_deg) {
  const double value = input_.table.number(key, fallback_deg);
  if (std::abs(value) <= 1e6) return value * std::numbers::pi / 180;
  fail(key, "'" + key + "' is beyond 1e6 degrees");
  return 0;
}

Vec3 Parameters::point(const std::string& key, const Vec3& fallback) {
  return machine::point(input_.table, key, fallback, input_.unit_mm);
}

std::vector<Vec3> Parameters::points(const std::string& key, const std::vector<Vec3>& fallback) {
  if (!input_.table.has(key)) {
    input_.table.know(key);
    return fallback;
  }
  const auto lists = input_.table.number_lists(key, 3);
  if (!lists) {
    good_ = false;  // told by the table
    return fallback;
  }
  if (lists->size() != fallback.size()) {
    fail(key, "'" + key + "' needs " + std::to_string(fallback.size()) +
                  " points [x, y, z], this is " + std::to_string(lists->size()));
    return fallback;
  }
  std::vector<Vec3> out;
  for (const auto& p : *lists) {
    out.push_back(Vec3(p[0], p[1], p[2]) * input_.unit_mm);
    if (!(out.back().cwiseAbs().maxCoeff() <= 1e6))
      fail(key, "'" + key + "' has a point farther than 1 km away");
  }
  return out;
}

Vec3 Parameters::direction(const std::string& key, const Vec3& fallback) {
  const auto values = input_.table.numbers(key, 3);
  if (!values) return fallback;
  const Vec3 v((*values)[0], (*values)[1], (*values)[2]);
  const double norm = v.stableNorm();
  if (std::abs(norm - 1) <= 1e-6) return v / norm;
  fail(key, "'" + key + "' has length " + shortest(norm) + ", it must be 1");
  return fallback;
}

std::string Parameters::choice(const std::string& key, const std::vector<std::string>& words) {
  return input_.table.choice(key, words, words.front());
}

void Parameters::joints(std::string_view kinds) {
  const auto kind_of = [](const Joint& joint) {
    return joint.kind == JointKind::rotary ? 'R' : 'T';
  };
  std::string given;
  for (const Joint& joint : input_.driven) given += kind_of(joint);
  if (given == kinds) return;
  const std::string type = input_.table.text("type", "");
  std::string wanted;
  for (const char kind : kinds)
    wanted += (wanted.empty() ? "" : ", ") + std::string(kind == 'R' ? "rotary" : "linear");
  fail("type", "'" + type + "' needs " + std::to_string(kinds.size()) +
                   " driven axes in this order: " + wanted + "; this machine has " +
                   std::to_string(given.size()) +
                   (given.size() == kinds.size() ? " of other kinds" : ""));
}

void Parameters::fail(const std::string& key, const std::string& message) {
  input_.table.error(key, message);
  good_ = false;
}

bool Parameters::drawn(std::string_view prefix) const {
  const auto& tree = input_.machine.tree();
  return std::any_of(tree.begin(), tree.end(),
                     [&](const Joint& joint) { return joint.passive.starts_with(prefix); });
}

}  // namespace aircut::machine
