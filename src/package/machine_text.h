// package: a machine.toml that is put together couple by couple (docs/machine-package.md). Lengths
// mm, angles degrees.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace aircut::package {

/// Limits of a driven couple.
struct CoupleLimits {
  std::optional<double> min, max;
  double vmax = 1, amax = 1, home = 0;
};

struct Couple {
  std::string name;
  bool rotary = false;
  std::string parent = "bed";
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  double sense = 1;
  CoupleLimits limits;
};

/// How the couples move the tool: a channel when there is more than one.
struct DriveText {
  std::string name = {};
  std::vector<std::string> axes = {};  ///< names of its couples
  std::string kinematics;              ///< lines of `[kinematics]`
  std::string work = "bed";            ///< link
  Eigen::Vector3d work_angles = Eigen::Vector3d::Zero();
  std::string spindle = "bed";  ///< link
  Eigen::Vector3d gauge = Eigen::Vector3d::Zero();
  Eigen::Vector3d spindle_angles = Eigen::Vector3d::Zero();
};

/// Something to draw and to collide with; its mesh is in bed axes with every joint at zero.
struct BodyText {
  std::string name, link, mesh;
};

std::string quoted(const std::string& text);
std::string list_of(const Eigen::Vector3d& v);
std::string list_of(const std::vector<Eigen::Vector3d>& points);
/// R as turns about the fixed X, then Y, then Z axis, degrees.
Eigen::Vector3d fixed_angles(const Eigen::Matrix3d& R);

class MachineText {
 public:
  explicit MachineText(std::string name) : name_(std::move(name)) {}
  /// Its link has its name.
  void add(const Couple& couple);
  /// A couple that a passive value moves; its link has the value's name.
  void passive(const std::string& value, const std::string& parent,
               const Eigen::Vector3d& direction);
  /// platform_x, _y, _z and then the angles, one on the other; the last link.
  std::string platform(const std::string& angles);
  void body(const BodyText& body);
  void drive(DriveText drive) { drives_.push_back(std::move(drive)); }
  const std::vector<DriveText>& drives() const { return drives_; }
  void spindle_speed(double low, double high) { rpm_ = {low, high}; }
  std::string text() const;

 private:
  void couple_head(const std::string& name, bool rotary, const std::string& parent,
                   const Eigen::Vector3d& direction, const Eigen::Vector3d& origin, double sense);
  std::string name_, couples_;
  std::vector<DriveText> drives_;
  std::optional<std::pair<double, double>> rpm_;
};

}  // namespace aircut::package
