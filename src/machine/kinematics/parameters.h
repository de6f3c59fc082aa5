// Reads the parameters of a kinematics: defaults for what is not given, an error at the key for
// what can't be.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "machine/kinematics/kinematics_table.h"

namespace aircut::machine {

class Parameters {
 public:
  explicit Parameters(KinematicsInput& input) : input_(input) {}

  /// mm.
  double length(const std::string& key, double fallback);
  double positive(const std::string& key, double fallback);
  /// Given in degrees; rad.
  double angle(const std::string& key, double fallback_deg);
  Vec3 point(const std::string& key, const Vec3& fallback);
  /// As many points as `fallback` has.
  std::vector<Vec3> points(const std::string& key, const std::vector<Vec3>& fallback);
  /// A unit vector.
  Vec3 direction(const std::string& key, const Vec3& fallback);
  std::string choice(const std::string& key, const std::vector<std::string>& words);
  /// Kinds of the driven axes in order: T slides, R turns. Anything else is an error.
  void joints(std::string_view kinds);
  void fail(const std::string& key, const std::string& message);
  /// Does the tree have a couple for a passive value whose name begins so?
  bool drawn(std::string_view prefix) const;
  bool good() const { return good_; }

 private:
  KinematicsInput& input_;
  bool good_ = true;
};

}  // namespace aircut::machine
