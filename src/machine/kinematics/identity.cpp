// identity: every joint is an axis of the program.
//
//   q_i = tip[axis_i] + tool_offset[axis_i] − offset[axis_i]
//
// `offset` (X Y Z only) is the gauge point in M coordinates with all joints at zero. The formula is
// linear, so forward, rates and travel bounds are exact. A letter may stand several times when
// `skew_max` says how far its joints may be apart: they all move together, and the first one
// counts.
#include <algorithm>
#include <numbers>

#include "machine/kinematics/kinematics_table.h"

namespace aircut::machine {

namespace {

class Identity final : public Kinematics {
 public:
  Identity(std::vector<Axis> axes, const Vec3& offset, double skew_max)
      : axis_of_joint_(std::move(axes)), skew_max_(skew_max) {
    for (std::size_t i = 0; i < axis_of_joint_.size(); ++i) {
      const auto first = std::find(axis_of_joint_.begin(), axis_of_joint_.end(), axis_of_joint_[i]);
      leader_.push_back(static_cast<Eigen::Index>(first - axis_of_joint_.begin()));
      axes_.add(axis_of_joint_[i]);
    }
    offset_[Axis::x] = offset.x();
    offset_[Axis::y] = offset.y();
    offset_[Axis::z] = offset.z();
  }

  std::string_view type() const override { return "identity"; }
  AxisSet axes() const override { return axes_; }
  int joint_count() const override { return static_cast<int>(axis_of_joint_.size()); }

  tl::expected<JointVector, ReachError> inverse(const Target& target,
                                                const JointVector&) const override {
    return joints_of(target.tip + target.tool_offset - offset_);
  }

  tl::expected<AxisValues, ReachError> forward(const JointVector& joints,
                                               const AxisValues& tool_offset) const override {
    AxisValues tip;
    for (std::size_t i = 0; i < axis_of_joint_.size(); ++i) {
      const Axis axis = axis_of_joint_[i];
      const double apart = std::abs(joints[static_cast<Eigen::Index>(i)] - joints[leader_[i]]);
      if (apart > skew_max_)
        return unexpected(ReachError{std::string("the joints of axis ") + letter(axis) + " are " +
                                     fixed(apart * (is_rotary(axis) ? degrees : 1), 3) +
                                     (is_rotary(axis) ? " degrees" : " mm") +
                                     " apart from each other"});
      tip[axis] = joints[leader_[i]] + offset_[axis] - tool_offset[axis];
    }
    // An axis without a joint stays where the offset puts it.
    for (const Axis axis : {Axis::x, Axis::y, Axis::z})
      if (!axes_.has(axis)) tip[axis] = offset_[axis] - tool_offset[axis];
    return tip;
  }

  void couple(JointVector& joints) const override {
    for (std::size_t i = 0; i < leader_.size(); ++i)
      joints[static_cast<Eigen::Index>(i)] = joints[leader_[i]];
  }

  bool rates(const Target&, const JointVector&, const AxisValues& d_tip, const AxisValues& dd_tip,
             JointVector& dq, JointVector& ddq) const override {
    dq = joints_of(d_tip);
    ddq = joints_of(dd_tip);
    return true;
  }

  bool travel_bound(const TipInterval& tip, std::span<double> travel) const override {
    for (std::size_t i = 0; i < axis_of_joint_.size(); ++i)
      travel[i] = tip.travel[axis_of_joint_[i]];
    return true;
  }

 private:
  JointVector joints_of(const AxisValues& values) const {
    JointVector joints(joint_count());
    for (std::size_t i = 0; i < axis_of_joint_.size(); ++i)
      joints[static_cast<Eigen::Index>(i)] = values[axis_of_joint_[i]];
    return joints;
  }

  static constexpr double degrees = 180 / std::numbers::pi;

  std::vector<Axis> axis_of_joint_;
  std::vector<Eigen::Index> leader_;  ///< first joint of the same axis
  double skew_max_;                   ///< mm or rad
  AxisSet axes_;
  AxisValues offset_;
};

// One axis letter per joint; nothing if the text has another form.
std::optional<std::vector<Axis>> axes_of_letters(const std::string& letters) {
  std::vector<Axis> axes;
  for (const char c : letters) {
    const auto axis = axis_of_letter(c);
    if (!axis) return std::nullopt;
    axes.push_back(*axis);
  }
  return axes;
}

bool check_kinds(KinematicsInput& input, const std::string& key, const std::vector<Axis>& axes,
                 bool twice) {
  bool good = true;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const std::string name(1, letter(axes[i]));
    if (!twice && std::count(axes.begin(), axes.end(), axes[i]) > 1 &&
        std::find(axes.begin(), axes.end(), axes[i]) == axes.begin() + static_cast<long>(i)) {
      input.table.error(key,
                        "two joints for axis " + name +
                            " need 'skew_max', how far they may be apart, or type = \"gantry\"");
      good = false;
    }
    const bool rotary = input.driven[i].kind == JointKind::rotary;
    if (rotary == is_rotary(axes[i])) continue;
    input.table.error(key, "axis " + name + " needs a " +
                               (is_rotary(axes[i]) ? "rotary" : "linear") + " joint, '" +
                               input.driven[i].name + "' is " + (rotary ? "rotary" : "linear"));
    good = false;
  }
  return good;
}

}  // namespace

std::shared_ptr<const Kinematics> make_identity(const std::vector<Axis>& axes, const Vec3& offset) {
  return std::make_shared<Identity>(axes, offset, std::numeric_limits<double>::infinity());
}

std::string identity_joints(config::Table& table) {
  std::string names;
  for (const char c : table.text("coordinates", "XYZ")) {
    const auto axis = axis_of_letter(c);
    if (!axis) continue;  // told by the reader
    names +=
        (names.empty() ? "" : " ") + std::string(1, letter(*axis)) + (is_rotary(*axis) ? "*" : "");
  }
  return names;
}

std::shared_ptr<const Kinematics> read_identity(KinematicsInput& input) {
  const Vec3 offset = point(input.table, "offset", Vec3::Zero(), input.unit_mm);
  const bool given = input.table.has("coordinates");
  const std::string key = given ? "coordinates" : "type";
  std::string letters = input.table.text("coordinates", "");
  if (!given)
    for (const Joint& joint : input.driven) {
      if (joint.name.size() != 1 || !axis_of_letter(joint.name[0])) {
        input.table.error(key, "joint '" + joint.name +
                                   "' is not named by an axis letter; say with 'coordinates' which "
                                   "axis each joint moves, like coordinates = \"XYZ\"");
        return nullptr;
      }
      letters += joint.name;
    }
  const auto axes = axes_of_letters(letters);
  if (!axes || axes->size() != input.driven.size()) {
    input.table.error(key, "'coordinates' needs one letter of XYZABCUVW for each of the " +
                               std::to_string(input.driven.size()) + " driven axes, this is '" +
                               letters + "'");
    return nullptr;
  }
  const bool twice = input.table.has("skew_max");
  const double skew_max = length(input.table, "skew_max", 0, input.unit_mm);
  if (twice && !(skew_max > 0)) {
    input.table.error("skew_max", "'skew_max' must be more than 0");
    return nullptr;
  }
  if (!check_kinds(input, key, *axes, twice)) return nullptr;
  return std::make_shared<Identity>(*axes, offset, skew_max);
}

}  // namespace aircut::machine
