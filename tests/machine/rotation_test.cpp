// Rotation conventions and heads against numbers made elsewhere, and against themselves: every
// convention to every other one and back, at random and at gimbal lock.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "base/random.h"
#include "machine/rotation/cycle600.h"
#include "machine/rotation/head.h"

namespace aircut::machine {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double deg = pi / 180;

nlohmann::json vectors(const std::string& name) {
  std::ifstream file(std::string(AIRCUT_SOURCE_DIR) + "/tests/data/" + name + ".json");
  return nlohmann::json::parse(file);
}

Vec3 vec(const nlohmann::json& v) {
  return {v[0].get<double>(), v[1].get<double>(), v[2].get<double>()};
}

Mat3 mat(const nlohmann::json& rows) {
  Mat3 R;
  for (int i = 0; i < 9; ++i)
    R(i / 3, i % 3) =
        rows[static_cast<std::size_t>(i / 3)][static_cast<std::size_t>(i % 3)].get<double>();
  return R;
}

RotationConvention convention(const nlohmann::json& v) {
  const auto name = v.at("order").get<std::string>() + (v.at("intrinsic") ? "-int" : "-ext");
  const auto found = convention_of_name(name);
  EXPECT_TRUE(found) << name;
  return *found;
}

double off(const Mat3& a, const Mat3& b) { return (a - b).cwiseAbs().maxCoeff(); }

double turn_off(const Vec3& a, const Vec3& b) {
  double most = 0;
  for (int i = 0; i < 3; ++i) most = std::max(most, std::abs(std::remainder(a[i] - b[i], 2 * pi)));
  return most;
}

Vec3 random_angles(Random& random) {
  return {random.between(-pi, pi), random.between(-pi, pi), random.between(-pi, pi)};
}

TEST(Rotation, GivesTheNumbersOfTheVectors) {
  const auto file = vectors("rotation_conventions");
  ASSERT_EQ(file.at("vectors").size(), 60u);
  int conversions = 0;
  for (const auto& v : file.at("vectors")) {
    const RotationConvention c = convention(v);
    EXPECT_EQ(bin_of(c), v.at("bin"));
    const Vec3 angles = vec(v.at("angles")) * deg;
    const Mat3 R = matrix_of(c, angles);
    EXPECT_LE(off(R, mat(v.at("matrix"))), 1e-9) << v;
    EXPECT_LE(turn_off(other_angles(angles), vec(v.at("flip")) * deg), 1e-5 * deg) << v;
    EXPECT_LE(off(matrix_of(c, other_angles(angles)), R), 1e-12);
    for (const auto& [name, wanted] : v.at("converted").items()) {
      const auto to = convention_of_name(name);
      ASSERT_TRUE(to) << to.error();
      EXPECT_LE(turn_off(angles_of(*to, R).angles, vec(wanted) * deg), 1e-5 * deg) << name << v;
      ++conversions;
    }
  }
  EXPECT_EQ(conversions, 720);
}

TEST(Rotation, SetsTheThirdAngleToZeroAtGimbalLock) {
  const auto file = vectors("rotation_conventions");
  ASSERT_EQ(file.at("gimbal_lock").size(), 24u);
  for (const auto& v : file.at("gimbal_lock")) {
    const RotationConvention c = convention(v);
    const Mat3 R = matrix_of(c, vec(v.at("input")) * deg);
    EXPECT_LE(off(R, mat(v.at("matrix"))), 1e-9);
    const RotationAngles out = angles_of(c, R);
    EXPECT_TRUE(out.locked);
    EXPECT_LE(turn_off(out.angles, vec(v.at("expected")) * deg), 1e-5 * deg) << v;
    EXPECT_LE(off(matrix_of(c, out.angles), R), 1e-9);
  }
}

TEST(Rotation, AgreesWithThePrintedExamples) {
  for (const auto& v : vectors("rotation_conventions").at("paper_examples")) {
    const auto& in = v.at("input");
    const Mat3 R = matrix_of(convention(in), vec(in.at("angles")) * deg);
    const Vec3 out = angles_of(convention(v.at("output")), R).angles / deg;
    EXPECT_LE((out - vec(v.at("exact"))).cwiseAbs().maxCoeff(), 1e-8);
    EXPECT_LE((out - vec(v.at("printed"))).cwiseAbs().maxCoeff(),
              v.at("tolerance_to_printed").get<double>());
  }
}

TEST(Rotation, ConvertsAHundredThousandOrientationsThereAndBack) {
  Random random(61);
  const auto& all = rotation_conventions();
  for (int i = 0; i < 100000; ++i) {
    const RotationConvention& from = all[random.next() % 12];
    const RotationConvention& to = all[random.next() % 12];
    const Mat3 R = matrix_of(from, random_angles(random));
    const RotationAngles between = angles_of(to, R);
    ASSERT_LE(off(matrix_of(to, between.angles), R), 1e-9) << name_of(to);
    ASSERT_LE(std::abs(between.angles[1]), pi / 2 + 1e-12);
    ASSERT_LE(off(matrix_of(to, other_angles(between.angles)), R), 1e-9) << name_of(to);
    ASSERT_LE(off(matrix_of(from, angles_of(from, R).angles), R), 1e-9) << name_of(from);
  }
}

// The right-hand rule, by hand: about fixed axes the last turn is the outermost.
TEST(Rotation, TurnsAboutFixedOrTurnedAxes) {
  const Vec3 half(pi / 2, 0, pi / 2);
  const Mat3 fixed_axes = matrix_of(*convention_of_name("XYZ-ext"), half);
  EXPECT_LE((fixed_axes * Vec3::UnitY() - Vec3::UnitZ()).norm(), 1e-12);
  const Mat3 turned = matrix_of(*convention_of_name("xyz-int"), half);
  EXPECT_LE((turned * Vec3::UnitX() - Vec3::UnitZ()).norm(), 1e-12);
}

TEST(Rotation, RefusesOtherNumbersAndNames) {
  for (const double bin : {0.0, 56.0, 21.0, 63.0, -27.0, 27.5})
    EXPECT_FALSE(convention_of_bin(bin, true)) << bin;
  EXPECT_NE(convention_of_bin(55, true).error().find("57 XYZ"), std::string::npos);
  for (const char* name : {"", "XYZ", "XXZ-int", "XYZ-INT", "55-int", "XYZ-intern", "-int"})
    EXPECT_FALSE(convention_of_name(name)) << name;
  EXPECT_EQ(bin_of(*convention_of_name("39-ext")), 39);
  EXPECT_TRUE(why_no_rotation(2 * Mat3::Identity()));
  EXPECT_TRUE(why_no_rotation(-Mat3::Identity()));
  EXPECT_FALSE(why_no_rotation(Mat3::Identity()));
}

TEST(RotationFrames, ShiftTurnAndShiftAlongTheTurnedAxes) {
  RotationStep step;
  step.before = Vec3(10, 0, 0);
  step.angles = Vec3(0, 0, pi / 2);
  step.after = Vec3(5, 0, 0);
  const Pose F = frame_of(step);
  EXPECT_LE((F.translation() - Vec3(10, 5, 0)).norm(), 1e-12);
  // About a point P that stays where it is: Trans(P) · R · Trans(−P).
  step.after = -step.before;
  EXPECT_LE((frame_of(step) * step.before - step.before).norm(), 1e-12);
  // On top of a frame: intrinsic along its own axes, extrinsic about the fixed ones.
  RotationStep more;
  more.before = Vec3(1, 0, 0);
  more.angles = Vec3(pi / 2, 0, 0);
  EXPECT_LE((added(F, more).translation() - Vec3(10, 6, 0)).norm(), 1e-12);
  more.convention.intrinsic = false;
  EXPECT_LE((added(F, more).translation() - Vec3(11, 5, 0)).norm(), 1e-12);
  EXPECT_LE(off(added(F, more).linear(), matrix_of(more.convention, more.angles) * F.linear()),
            1e-12);
}

TEST(Cycle600, ReadsItsCallAndGivesItsRegisters) {
  const auto call =
      read_cycle600("CYCLE600(0,\"IFVW207\",1,57, 0,0,0, 30,45,60, 0,0,0, 0,39,0,0,0)");
  ASSERT_TRUE(call) << call.error();
  EXPECT_EQ(call->head, "IFVW207");
  const Vec3 angles = run(*call, Pose::Identity()).angles.angles / deg;
  EXPECT_LE((angles - Vec3(39.639272, -16.279906, 50.360728)).cwiseAbs().maxCoeff(), 1e-6);
  const auto other = read_cycle600("0,H,1,57,0,0,0,30,45,60,0,0,0,0,39,0,1,0");
  ASSERT_TRUE(other);
  EXPECT_LE(turn_off(run(*other, Pose::Identity()).angles.angles, other_angles(angles * deg)),
            1e-12);
}

TEST(Cycle600, SaysWhichArgumentIsWrong) {
  const auto error = [](const char* text) { return read_cycle600(text).error(); };
  EXPECT_NE(error("0,H,1,57,0,0,0,30,45,60,0,0,0,0,0,39,0,0,0").find("this call has 19"),
            std::string::npos);
  EXPECT_NE(error("0,H,1,55,0,0,0,30,45,60,0,0,0,0,39,0,0,0").find("_BIN_IN: BIN 55"),
            std::string::npos);
  EXPECT_NE(error("0,H,1,57,0,0,0,30,45,60,0,0,0,2,39,0,0,0").find("_INEXOUT, is 0 or 1"),
            std::string::npos);
  EXPECT_NE(error("0,H,1,57,0,0,x,30,45,60,0,0,0,0,39,0,0,0").find("argument 7, _POS_Z"),
            std::string::npos);
  EXPECT_NE(error("0,,1,57,0,0,0,30,45,60,0,0,0,0,39,0,0,0").find("_MIHEAD"), std::string::npos);
  EXPECT_NE(error("CYCLE600 0").find("parentheses"), std::string::npos);
}

TwoAxisHead head_of(const nlohmann::json& v) {
  TwoAxisHead head;  // its defaults are the sample's
  if (v.at("head") == "nutating45") head.u2 = nutating_axis();
  return head;
}

TEST(Head, GivesTheNumbersOfTheVectors) {
  const auto file = vectors("head_two_axis");
  ASSERT_EQ(file.at("vectors").size(), 10u);
  for (const auto& v : file.at("vectors")) {
    const TwoAxisHead head = head_of(v);
    const HeadAngles at{v.at("c").get<double>() * deg, v.at("a").get<double>() * deg};
    const Pose X = tip_on_head(head, at, v.at("tool_length"));
    EXPECT_LE((X.translation() - vec(v.at("tip"))).cwiseAbs().maxCoeff(), 1e-6) << v;
    const Vec3 k = X.linear().col(2);
    EXPECT_LE((k - vec(v.at("tool_axis"))).cwiseAbs().maxCoeff(), 1e-9) << v;
    EXPECT_LE(mount_for(head, at, v.at("tool_length"), X.translation()).norm(), 1e-9);
    const auto found = head_angles(head, k);
    ASSERT_EQ(found.size(), v.at("ik_solutions").size());
    for (const auto& wanted : v.at("ik_solutions")) {
      double nearest = 9;
      for (const HeadAngles& h : found)
        nearest = std::min(
            nearest, turn_off(Vec3(h.c, h.a, 0),
                              Vec3(wanted[0].get<double>(), wanted[1].get<double>(), 0) * deg));
      EXPECT_LE(nearest, 1e-5 * deg) << v;
    }
  }
}

TEST(Head, ComesBackFromAHundredThousandDirections) {
  Random random(62);
  for (int i = 0; i < 100000; ++i) {
    TwoAxisHead head;
    if (i % 2) head.u2 = nutating_axis();
    const HeadAngles at{random.between(-pi, pi), random.between(-pi, pi)};
    const Mat3 R = tip_on_head(head, at, 0).linear();
    const auto found = head_angles(head, R.col(2), at);
    ASSERT_FALSE(found.empty());
    double nearest = 9;
    for (const HeadAngles& h : found) {
      const Mat3 back = tip_on_head(head, h, 0).linear();
      ASSERT_LE((back.col(2) - R.col(2)).norm(), 1e-7);
      nearest = std::min(nearest, turn_off(Vec3(h.c, h.a, 0), Vec3(at.c, at.a, 0)));
      // What is left between the two is a turn about the tool.
      const Mat3 rolled = back * Eigen::AngleAxisd(residual_roll(R, back), Vec3::UnitZ());
      ASSERT_LE(off(rolled, R), 1e-6);
    }
    // Near a double solution both angles are open to the square root of the rounding.
    if (found.size() == 2) {
      ASSERT_LE(nearest, 1e-5);
    }
  }
}

TEST(Head, At45DegreesTiltsTheToolToTheLevelAndNoFarther) {
  TwoAxisHead head;
  head.u2 = nutating_axis();
  EXPECT_FALSE(head_angles(head, Vec3(0, 0.8, 0.6)).empty());
  EXPECT_EQ(head_angles(head, Vec3::UnitY()).size(), 1u);
  EXPECT_TRUE(head_angles(head, Vec3(0, 0.8, -0.6)).empty());
}

TEST(Head, ThatIndexesTakesTheNearestStepsAndSaysWhatIsLeft) {
  TwoAxisHead head;
  head.step1 = head.step2 = 2.5 * deg;
  const Indexed out = indexed(head, {31 * deg, 44 * deg});
  EXPECT_NEAR(out.at.c, 30 * deg, 1e-12);
  EXPECT_NEAR(out.at.a, 45 * deg, 1e-12);
  EXPECT_GT(out.error, 0.9 * deg);
  EXPECT_LT(out.error, 1.5 * deg);
  const Vec3 wanted = tip_on_head(head, {31 * deg, 44 * deg}, 0).linear().col(2);
  const Vec3 reached = tip_on_head(head, out.at, 0).linear().col(2);
  EXPECT_LE((out.correction * wanted - reached).norm(), 1e-12);
}

Vec3 seen(const TableAndHead& m, const TableAndHeadAngles& at) {
  return Eigen::AngleAxisd(at.t, m.table) * tip_on_head(m.head, at.head, 0).linear().col(2);
}

TEST(TableAndHead, PointTheToolInEveryMode) {
  Random random(63);
  TableAndHead m;
  for (int i = 0; i < 300; ++i) {
    const Vec3 k =
        Vec3(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)).normalized();
    const TableAndHeadAngles near{random.between(-1, 1),
                                  {random.between(-1, 1), random.between(-1, 1)}};
    const auto head = turn_head(m, k, near);
    ASSERT_TRUE(head);
    EXPECT_EQ(head->t, near.t);
    EXPECT_LE((seen(m, *head) - k).norm(), 1e-9);
    // A direction that the table can bring to the head: turned about the table's axis.
    const Vec3 on_cone = seen(m, {random.between(-3, 3), near.head});
    const auto table = turn_table(m, on_cone, near);
    ASSERT_TRUE(table);
    EXPECT_LE((seen(m, *table) - on_cone).norm(), 1e-9);
    EXPECT_FALSE(turn_table(m, k, near));
    const auto least = turn_least(m, k, near);
    ASSERT_TRUE(least);
    EXPECT_LE((seen(m, *least) - k).norm(), 1e-9);
    const auto cost = [&](const TableAndHeadAngles& at) {
      return std::abs(at.t - near.t) + std::abs(at.head.c - near.head.c) +
             std::abs(at.head.a - near.head.a);
    };
    EXPECT_LE(cost(*least), cost(*head) + 1e-9);
    for (double t = -3; t < 3; t += 0.01) {
      TableAndHeadAngles other = near;
      other.t = near.t + t;
      if (const auto there = turn_head(m, k, other)) {
        // turn_head starts from `other`; count its travel from `near`.
        EXPECT_GE(cost(*there), cost(*least) - 1e-3);
      }
    }
  }
}

TEST(TableAndHead, KeepsToTheLimits) {
  TableAndHead m;
  m.table_min = m.table_max = 0;
  m.a_min = -30 * deg;
  m.a_max = 30 * deg;
  EXPECT_TRUE(turn_least(m, Vec3(0.3, 0, 0.95).normalized(), {}));
  EXPECT_FALSE(turn_least(m, Vec3(1, 0, 0.1).normalized(), {}));
  EXPECT_LE((work_point(m, 90 * deg, Vec3(10, 0, 0)) - Vec3(0, -10, 0)).norm(), 1e-12);
}

}  // namespace
}  // namespace aircut::machine
