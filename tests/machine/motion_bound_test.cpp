// Judge of the motion bound: random trees, random motions, bodies as clouds of points. What the
// samples show may never exceed what the bound allows.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/random.h"
#include "machine/machine.h"

namespace aircut::machine {
namespace {

// Joints without a program: only the tree matters here. The second half of the values is passive.
class FreeValues final : public Kinematics {
 public:
  FreeValues(int driven, int passive) : driven_(driven), passive_(passive) {}
  std::string_view type() const override { return "free"; }
  AxisSet axes() const override { return {}; }
  int joint_count() const override { return driven_; }
  std::vector<std::string> passive_names() const override {
    std::vector<std::string> names;
    for (int i = 0; i < passive_; ++i) names.push_back("p" + std::to_string(i));
    return names;
  }
  tl::expected<JointVector, ReachError> inverse(const Target&, const JointVector&) const override {
    return unexpected(ReachError{"none"});
  }
  tl::expected<AxisValues, ReachError> forward(const JointVector&,
                                               const AxisValues&) const override {
    return unexpected(ReachError{"none"});
  }
  // A passive value is twice the joint of the same index plus a constant.
  void passive(const JointVector& joints, std::span<double> out) const override {
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] = 2 * joints[static_cast<Eigen::Index>(i)] + 0.1;
  }
  bool travel_bound(const TipInterval&, std::span<double>) const override { return false; }

 private:
  int driven_, passive_;
};

Vec3 random_vector(Random& random, double size) {
  return {random.between(-size, size), random.between(-size, size), random.between(-size, size)};
}

// `driven` + `passive` couples, each on the bed or on an earlier link.
Machine random_machine(Random& random, int driven, int passive) {
  Machine machine;
  for (int i = 0; i < driven + passive; ++i) {
    Joint joint;
    joint.name = "j" + std::to_string(i);
    joint.kind = random.next() % 2 ? JointKind::linear : JointKind::rotary;
    joint.parent = LinkId{static_cast<int>(random.next() % machine.links_.size())};
    joint.child = LinkId{static_cast<int>(machine.links_.size())};
    joint.origin = random_vector(random, 300);
    joint.direction = random_vector(random, 1).normalized();
    joint.sense = random.next() % 2 ? 1 : -1;
    if (i < driven) {
      joint.driven = i;
      machine.driven_.push_back(i);
    } else {
      joint.passive = "p" + std::to_string(i - driven);
    }
    machine.links_.push_back({joint.name, joint.parent, i});
    machine.tree_.push_back(joint);
  }
  machine.kinematics_ = std::make_shared<FreeValues>(driven, passive);
  return machine;
}

struct Motion {
  std::vector<LinkPoses> poses;  // at moments of the interval
  std::vector<double> travel;    // of driven joints, then of passive values
};

// Each joint swings about a random place; small ranges and whole turns.
Motion random_motion(const Machine& machine, Random& random, double size) {
  const int n = machine.joint_count();
  std::vector<double> start, amplitude, cycles;
  for (int i = 0; i < n; ++i) {
    const bool rotary = machine.joint(JointId{i}).kind == JointKind::rotary;
    start.push_back(random.between(-3, 3) * (rotary ? 1 : 50));
    amplitude.push_back(random.between(0, size) * (rotary ? 1 : 50));
    cycles.push_back(random.between(0.2, 6));
  }
  Motion motion;
  motion.travel.assign(machine.tree().size(), 0);
  JointVector before;
  constexpr int steps = 60, fine = 20;
  for (int i = 0; i <= steps * fine; ++i) {
    JointVector joints(n);
    for (int j = 0; j < n; ++j) {
      const auto k = static_cast<std::size_t>(j);
      joints[j] = start[k] + amplitude[k] * std::sin(cycles[k] * i / (steps * fine));
      if (i > 0) motion.travel[k] += std::abs(joints[j] - before[j]);
    }
    before = joints;
    if (i % fine == 0) forward(machine, joints, motion.poses.emplace_back());
  }
  for (std::size_t k = static_cast<std::size_t>(n); k < motion.travel.size(); ++k)
    motion.travel[k] = 2 * motion.travel[k - static_cast<std::size_t>(n)];
  return motion;
}

struct Cloud {
  LinkId link;
  Vec3 centre;  // in the link's frame
  double radius;
  std::vector<Vec3> points;
};

Cloud random_cloud(const Machine& machine, Random& random) {
  Cloud cloud;
  cloud.link = LinkId{static_cast<int>(random.next() % machine.links().size())};
  cloud.centre = random_vector(random, 400);
  cloud.radius = random.between(1, 100);
  for (int i = 0; i < 12; ++i)
    cloud.points.push_back(cloud.centre + random_vector(random, 1).normalized() * cloud.radius);
  return cloud;
}

const Pose& pose_of(const LinkPoses& poses, LinkId link) {
  return poses.X_WL[static_cast<std::size_t>(index(link))];
}

// Largest displacement of a point of `a` seen from `b`, between any two moments.
double displacement(const Motion& motion, const Cloud& a, LinkId b) {
  double largest = 0;
  for (const Vec3& p : a.points) {
    std::vector<Vec3> way;
    for (const LinkPoses& poses : motion.poses)
      way.push_back(pose_of(poses, b).inverse() * pose_of(poses, a.link) * p);
    for (const Vec3& from : way)
      for (const Vec3& to : way) largest = std::max(largest, (from - to).norm());
  }
  return largest;
}

double distance(const LinkPoses& poses, const Cloud& a, const Cloud& b) {
  double smallest = 1e9;
  for (const Vec3& p : a.points)
    for (const Vec3& q : b.points)
      smallest =
          std::min(smallest, (pose_of(poses, a.link) * p - pose_of(poses, b.link) * q).norm());
  return smallest;
}

TEST(MotionBound, NoSampledDisplacementExceedsIt) {
  Random random(11);
  int checked = 0;
  for (int round = 0; round < 400; ++round) {
    const int driven = 1 + static_cast<int>(random.next() % 6);
    const int passive = static_cast<int>(random.next() % static_cast<unsigned>(driven + 1));
    const Machine machine = random_machine(random, driven, passive);
    const Motion motion = random_motion(machine, random, std::pow(10.0, random.between(-4, 0.8)));
    const MotionBound bound(machine);
    for (int pair = 0; pair < 4; ++pair) {
      const Cloud a = random_cloud(machine, random), b = random_cloud(machine, random);
      const LinkPoses& now = motion.poses[random.next() % motion.poses.size()];
      const Vec3 centre_a = pose_of(now, a.link) * a.centre;
      const Vec3 centre_b = pose_of(now, b.link) * b.centre;
      const double both =
          bound.bound(a.link, centre_a, a.radius, b.link, centre_b, b.radius, now, motion.travel);
      const double moved_a = displacement(motion, a, b.link);
      const double moved_b = displacement(motion, b, a.link);
      constexpr double rounding = 1e-9;
      ASSERT_GE(both + rounding, std::min(moved_a, moved_b));
      // A huge partner leaves the bound of the other direction.
      constexpr double huge = 1e12;
      const double one =
          bound.bound(a.link, centre_a, a.radius, b.link, centre_b, huge, now, motion.travel);
      const double two =
          bound.bound(a.link, centre_a, huge, b.link, centre_b, b.radius, now, motion.travel);
      if (a.link != b.link) {
        ASSERT_GE(one + rounding, moved_a);
        ASSERT_GE(two + rounding, moved_b);
        ASSERT_LE(both, std::min(one, two) + rounding);
      }
      // What the checks conclude from it: the distance changes by no more.
      const double d = distance(now, a, b);
      for (const LinkPoses& poses : motion.poses)
        ASSERT_LE(std::abs(distance(poses, a, b) - d), both + rounding);
      ++checked;
    }
  }
  EXPECT_EQ(checked, 1600);
}

Machine one_joint(JointKind kind) {
  Machine machine;
  Joint joint;
  joint.kind = kind;
  joint.child = LinkId{1};
  joint.driven = 0;
  joint.origin = Vec3(0, 0, 50);
  machine.links_.push_back({"link", bed_link, 0});
  machine.tree_.push_back(joint);
  machine.driven_ = {0};
  machine.kinematics_ = std::make_shared<FreeValues>(1, 0);
  return machine;
}

TEST(MotionBound, OfASlidingCoupleIsItsTravel) {
  const Machine machine = one_joint(JointKind::linear);
  LinkPoses poses;
  forward(machine, JointVector::Zero(1), poses);
  const std::vector<double> travel = {0.25};
  EXPECT_EQ(MotionBound(machine).bound(LinkId{1}, Vec3(100, 0, 0), 10, bed_link, Vec3(0, 0, 0), 5,
                                       poses, travel),
            0.25);
}

TEST(MotionBound, OfARotaryCoupleUsesTheSmallerReach) {
  const Machine machine = one_joint(JointKind::rotary);
  LinkPoses poses;
  forward(machine, JointVector::Zero(1), poses);
  const std::vector<double> travel = {0.01};
  const MotionBound bound(machine);
  // The axis is Z through the origin: 100 + 10 from it, and 3 + 5 for the other body.
  EXPECT_DOUBLE_EQ(
      bound.bound(LinkId{1}, Vec3(100, 0, 7), 10, bed_link, Vec3(900, 0, 0), 5, poses, travel),
      1.1);
  EXPECT_DOUBLE_EQ(
      bound.bound(LinkId{1}, Vec3(100, 0, 7), 10, bed_link, Vec3(0, 3, 0), 5, poses, travel), 0.08);
  // However far it turns, a point is never displaced by more than the diameter.
  const std::vector<double> turns = {100};
  EXPECT_DOUBLE_EQ(
      bound.bound(LinkId{1}, Vec3(100, 0, 7), 10, bed_link, Vec3(900, 0, 0), 5, poses, turns), 220);
}

TEST(MotionBound, IsZeroForBodiesOfOneLink) {
  const Machine machine = one_joint(JointKind::rotary);
  LinkPoses poses;
  forward(machine, JointVector::Zero(1), poses);
  const std::vector<double> travel = {1};
  EXPECT_EQ(MotionBound(machine).bound(LinkId{1}, Vec3(100, 0, 7), 10, LinkId{1}, Vec3(1, 1, 1), 5,
                                       poses, travel),
            0);
}

}  // namespace
}  // namespace aircut::machine
