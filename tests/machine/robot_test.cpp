// The three robots: the numbers of the vectors, round trips over the whole travel, all branches,
// and what is said where there is no solution (kinematics.md c).
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "samples.h"

namespace aircut::machine {
namespace {

constexpr double deg = std::numbers::pi / 180;

struct Robot {
  std::string name;
  std::shared_ptr<const Kinematics> kinematics;
  nlohmann::json file;
  std::vector<double> low, high;  // limits, rad
};

Robot robot(const std::string& name) {
  std::ifstream in(std::string(AIRCUT_SOURCE_DIR) + "/tests/data/robot_" + name + ".json");
  Robot out{name, nullptr, nlohmann::json::parse(in), {}, {}};
  const auto& p = out.file.at("parameters");
  RobotArm arm;
  arm.d1 = p.at("d1");
  arm.a1 = p.at("a1");
  arm.b = p.at("b");
  arm.a2 = p.at("a2");
  arm.a3 = p.at("a3");
  arm.d4 = p.at("d4");
  arm.d6 = p.at("d6");
  arm.dt = p.at("dt");
  if (p.contains("at")) arm.at = p.at("at");
  out.kinematics = name == "6r"                    ? make_robot_6r(arm)
                   : name == "vertical_t6_blocked" ? make_robot_vertical(arm)
                                                   : make_robot_horizontal(arm);
  for (int j = 1; j <= out.kinematics->joint_count(); ++j) {
    const auto& limits = p.at("limits").at("t" + std::to_string(j));
    out.low.push_back(limits[0].get<double>() * deg);
    out.high.push_back(limits[1].get<double>() * deg);
  }
  return out;
}

std::vector<Robot> robots() {
  return {robot("horizontal_t4_blocked"), robot("vertical_t6_blocked"), robot("6r")};
}

AxisValues tip_of(const nlohmann::json& pose) {
  return axis_values(pose.at("x"), pose.at("y"), pose.at("z"), pose.at("A").get<double>() * deg,
                     pose.at("B").get<double>() * deg, pose.value("C", 0.0) * deg);
}

JointVector joints_of(const nlohmann::json& joints) {
  JointVector q(static_cast<Eigen::Index>(joints.size()));
  for (Eigen::Index j = 0; j < q.size(); ++j)
    q[j] = joints.at("t" + std::to_string(j + 1)).get<double>() * deg;
  return q;
}

JointVector anywhere(const Robot& robot, Random& random) {
  JointVector q(robot.kinematics->joint_count());
  for (Eigen::Index j = 0; j < q.size(); ++j) {
    const auto k = static_cast<std::size_t>(j);
    q[j] = random.between(robot.low[k], robot.high[k]);
  }
  return q;
}

double largest_turn(const JointVector& a, const JointVector& b) {
  double most = 0;
  for (Eigen::Index j = 0; j < a.size(); ++j)
    most = std::max(most, std::abs(std::remainder(a[j] - b[j], 2 * std::numbers::pi)));
  return most;
}

TEST(Robots, GiveTheNumbersOfTheVectors) {
  for (const Robot& r : robots()) {
    SCOPED_TRACE(r.name);
    ASSERT_EQ(r.file.at("vectors").size(), 10u);
    for (const auto& v : r.file.at("vectors")) {
      const JointVector q = joints_of(v.at("joints"));
      const AxisValues wanted = tip_of(v.at("pose"));
      const auto tip = r.kinematics->forward(q, {});
      ASSERT_TRUE(tip);
      for (const Axis axis : {Axis::x, Axis::y, Axis::z})
        EXPECT_NEAR((*tip)[axis], wanted[axis], 1e-6) << v;
      for (const Axis axis : {Axis::a, Axis::b, Axis::c})
        EXPECT_NEAR((*tip)[axis], wanted[axis], 1e-6 * deg) << v;
      const auto axis = r.kinematics->tool_axis(*tip);
      ASSERT_TRUE(axis);
      for (const int i : {0, 1, 2})
        EXPECT_NEAR((*axis)[i], v.at("tool_axis")[static_cast<std::size_t>(i)].get<double>(), 1e-9);
      // From home, so the branch is the vectors' (front, normal elbow, wrist not flipped).
      const auto back = r.kinematics->inverse({wanted, {}}, JointVector::Zero(q.size()));
      ASSERT_TRUE(back) << v << back.error().reason;
      EXPECT_LE(largest_turn(*back, q), 1e-5 * deg) << v;
    }
  }
}

TEST(Robots, ComeBackFromAHundredThousandPoses) {
  for (const Robot& r : robots()) {
    SCOPED_TRACE(r.name);
    Random random(31);
    int compared = 0, refused = 0;
    for (int i = 0; compared + refused < 100000; ++i) {
      ASSERT_LT(i, 100100);
      const JointVector q = anywhere(r, random);
      const auto tip = r.kinematics->forward(q, {});
      if (!tip) {  // the interface is behind the axis of joint 1
        ASSERT_EQ(r.kinematics->type(), "robot-horizontal") << tip.error().reason;
        ++refused;
        continue;
      }
      const auto back = r.kinematics->inverse({*tip, {}}, q);
      ASSERT_TRUE(back) << q.transpose() << back.error().reason;
      const auto again = r.kinematics->forward(*back, {});
      ASSERT_TRUE(again);
      for (const Axis axis : {Axis::x, Axis::y, Axis::z})
        ASSERT_NEAR((*again)[axis], (*tip)[axis], 1e-6) << q.transpose();
      ASSERT_LE((*r.kinematics->tool_axis(*again) - *r.kinematics->tool_axis(*tip)).norm(), 1e-8);
      // Close to a singular pose (here: the wrist of joints 4 and 5, the axis of joint 1) the
      // joints are less certain than the pose.
      if ((*back - q).cwiseAbs().maxCoeff() <= 1e-6) ++compared;
    }
    EXPECT_LT(refused, 20000);
  }
}

// Frame of the tool for a tip, R = Rx(A)·Ry(B)·Rz(C).
Pose pose_of(const AxisValues& tip) {
  Pose X = translation(Vec3(tip[Axis::x], tip[Axis::y], tip[Axis::z]));
  X.linear() = (Eigen::AngleAxisd(tip[Axis::a], Vec3::UnitX()) *
                Eigen::AngleAxisd(tip[Axis::b], Vec3::UnitY()) *
                Eigen::AngleAxisd(tip[Axis::c], Vec3::UnitZ()))
                   .toRotationMatrix();
  return X;
}

TEST(Robots, TheSixAxisArmHasTheFramesOfTheVectors) {
  const Robot r = robot("6r");
  for (const auto& v : r.file.at("vectors")) {
    const Pose X = pose_of(*r.kinematics->forward(joints_of(v.at("joints")), {}));
    for (const int i : {0, 1, 2})
      for (const int j : {0, 1, 2, 3})
        EXPECT_NEAR(
            X.matrix()(i, j),
            v.at("T_M_T")[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)].get<double>(),
            j == 3 ? 1e-6 : 1e-9);
  }
}

TEST(Robots, KeepEachOfTheEightBranches) {
  for (const Sample& sample : samples()) {
    if (sample.kinematics->type() != "robot-6r") continue;
    Random random(8);
    int branches = 0;
    const AxisValues tip = random_tip(sample, random);
    std::vector<JointVector> found;
    for (int i = 0; i < 20000; ++i) {
      JointVector near(6);
      for (int j = 0; j < 6; ++j) near[j] = random.between(-3.1, 3.1);
      const auto other = sample.kinematics->inverse({tip, {}}, near);
      if (!other) continue;
      const auto again = sample.kinematics->forward(*other, {});
      ASSERT_TRUE(again);
      ASSERT_LE((pose_of(*again).matrix() - pose_of(tip).matrix()).cwiseAbs().maxCoeff(), 1e-8);
      // From the solution itself the branch stays.
      ASSERT_LE((*sample.kinematics->inverse({tip, {}}, *other) - *other).cwiseAbs().maxCoeff(),
                1e-9);
      bool known = false;
      for (const JointVector& k : found) known = known || largest_turn(k, *other) < 1e-6;
      if (!known) found.push_back(*other);
    }
    branches = static_cast<int>(found.size());
    EXPECT_EQ(branches, 8) << sample.name;
  }
}

TEST(Robots, StayInTheTurnThatIsNear) {
  const Robot r = robot("6r");
  JointVector q(6);
  q << 0.3, -0.2, 0.1, 0.4, 0.5, 0.6;
  const AxisValues tip = *r.kinematics->forward(q, {});
  JointVector near = q;
  near[5] += 2 * std::numbers::pi - 0.3;
  const auto joints = r.kinematics->inverse({tip, {}}, near);
  ASSERT_TRUE(joints);
  EXPECT_NEAR((*joints)[5], q[5] + 2 * std::numbers::pi, 1e-9);
  EXPECT_NEAR((*joints)[0], q[0], 1e-9);
}

// |det ∂(p, k) / ∂θ| of the horizontal machine is a2 d4 c3 rI c5; here by the inverse's rates.
TEST(Robots, HaveThePublishedDeterminant) {
  const Robot r = robot("horizontal_t4_blocked");
  Random random(5);
  int compared = 0;
  for (int i = 0; i < 200; ++i) {
    JointVector q = anywhere(r, random);
    q *= 0.8;  // away from the singular poses
    const auto position = r.kinematics->forward(q, {});
    if (!position) continue;
    ++compared;
    const AxisValues tip = *position;
    Eigen::Matrix<double, 5, 5> J;
    const std::array<Axis, 5> axes = {Axis::x, Axis::y, Axis::z, Axis::a, Axis::b};
    for (int c = 0; c < 5; ++c) {
      AxisValues d;
      d[axes[static_cast<std::size_t>(c)]] = 1;
      JointVector dq, ddq;
      ASSERT_TRUE(r.kinematics->rates({tip, {}}, q, d, {}, dq, ddq));
      J.col(c) = dq;
    }
    const Vec3 k = *r.kinematics->tool_axis(tip);
    const double rI = std::hypot(tip[Axis::x] + 250 * k.x(), tip[Axis::z] + 250 * k.z());
    // dk/d(A, B) has the area cos B.
    const double wanted = 900 * 950 * std::cos(q[2]) * rI * std::cos(q[4]);
    EXPECT_NEAR(std::abs(J.determinant()) * wanted / std::cos(tip[Axis::b]), 1, 1e-6);
  }
  EXPECT_GT(compared, 100);
}

std::string reason(const Kinematics& kinematics, const AxisValues& tip, AxisValues offset = {}) {
  const auto joints =
      kinematics.inverse({tip, offset}, JointVector::Zero(kinematics.joint_count()));
  return joints ? "" : joints.error().reason;
}

TEST(Robots, SayWhyAPoseHasNoJoints) {
  RobotArm arm;
  const auto horizontal = make_robot_horizontal(arm);
  arm.dt = 350;
  const auto vertical = make_robot_vertical(arm);
  const auto six = make_robot_6r(arm);
  // Wrist 1850 from the shoulder when stretched: at Z 1000 + 500, 550 is left of 2400 − 1850.
  EXPECT_EQ(reason(*vertical, axis_values(0, -2400, -500)),
            "the centre of the wrist is 550.000 mm beyond the reach of the arm, 1850.000 mm");
  EXPECT_EQ(reason(*six, axis_values(0, -20, -500)),
            "the centre of the wrist is 30.000 mm nearer to the shoulder than the folded arm gets");
  EXPECT_EQ(reason(*vertical, axis_values(0, 0, 500)),
            "the centre of the wrist is 0.000 mm from the axis of joint 1, where joint 1 can turn "
            "freely (a singular pose)");
  EXPECT_EQ(reason(*vertical, axis_values(0, -1850, -500)),
            "the arm is stretched: joint 3 would need an infinite speed there (a singular pose)");
  EXPECT_EQ(reason(*horizontal, axis_values(0, 550, -3000)),
            "the wrist is 1043.527 mm beyond the reach of the arm, 1850.000 mm");
  EXPECT_EQ(reason(*horizontal, axis_values(0, 550, -250)),
            "the spindle's interface is on the axis of joint 1, which can turn freely there (a "
            "singular pose)");
  EXPECT_EQ(reason(*horizontal, axis_values(-250, 550, -1200, 0, 90 * deg)),
            "the tool is parallel to the axes of joints 2 to 4, which can turn freely there (a "
            "singular pose)");
  AxisValues offset;
  offset[Axis::x] = 1;
  EXPECT_EQ(reason(*six, axis_values(0, -950, 400), offset),
            "a tool offset in X is not possible on this machine: tools are along the spindle (Z)");
  EXPECT_NE(reason(*vertical, axis_values(0, std::nan(""), 400)), "");
  EXPECT_NE(reason(*horizontal, axis_values(0, 550, -1200, std::nan(""))), "");
}

TEST(Robots, HaveNoTravelBoundWherePartOfTheBoxIsOutOfReach) {
  for (const Robot& r : robots()) {
    const AxisValues home =
        *r.kinematics->forward(JointVector::Zero(r.kinematics->joint_count()), {});
    std::array<double, 6> travel{};
    TipInterval interval{home, home, {}, {}};
    interval.high[Axis::x] += 1;
    interval.travel[Axis::x] = 1;
    EXPECT_TRUE(r.kinematics->travel_bound(interval, travel)) << r.name;
    EXPECT_LT(travel[0], 0.002) << r.name;
    interval.high[Axis::x] += 3000;
    EXPECT_FALSE(r.kinematics->travel_bound(interval, travel)) << r.name;
    interval.high[Axis::x] = std::nan("");
    EXPECT_FALSE(r.kinematics->travel_bound(interval, travel)) << r.name;
  }
}

}  // namespace
}  // namespace aircut::machine
