// Any mixture of table and head: the vectors of ten machines, all solutions of a tool direction,
// and chains that are refused.
#include "machine/kinematics/chain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "samples.h"

namespace aircut::machine {
namespace {

constexpr double degree = std::numbers::pi / 180;

Vec3 vec(const nlohmann::json& j) {
  return Vec3(j.at(0).get<double>(), j.at(1).get<double>(), j.at(2).get<double>());
}

ChainGeometry geometry_of(const nlohmann::json& machine) {
  ChainGeometry g;
  for (const auto& j : machine.at("joints")) {
    ChainCouple couple;
    couple.kind = j.at("kind") == "T" ? JointKind::linear : JointKind::rotary;
    couple.origin = vec(j.at("point"));
    couple.direction = vec(j.at("axis")).normalized();
    couple.sense = j.at("sense");
    couple.driven = static_cast<int>(g.words.size());
    (j.at("branch") == "W" ? g.work : g.tool).push_back(couple);
    g.words.push_back(*axis_of_letter(j.at("name").get<std::string>()[0]));
  }
  g.X_LM.translation() = vec(machine.at("W0_translation"));
  g.gauge = vec(machine.at("T0_translation"));
  return g;
}

JointVector joints_of(const ChainGeometry& g, const nlohmann::json& values) {
  JointVector q(static_cast<Eigen::Index>(g.words.size()));
  for (std::size_t j = 0; j < g.words.size(); ++j)
    q[static_cast<Eigen::Index>(j)] = values.at(std::string(1, letter(g.words[j]))).get<double>() *
                                      (is_rotary(g.words[j]) ? degree : 1);
  return q;
}

// The largest difference of two positions: mm, and degrees modulo a turn.
double difference(const ChainGeometry& g, const JointVector& a, const JointVector& b) {
  double worst = 0;
  for (std::size_t j = 0; j < g.words.size(); ++j) {
    const double d = a[static_cast<Eigen::Index>(j)] - b[static_cast<Eigen::Index>(j)];
    worst = std::max(worst, is_rotary(g.words[j])
                                ? std::abs(std::remainder(d, 2 * std::numbers::pi)) / degree
                                : std::abs(d));
  }
  return worst;
}

TEST(Chain, AgreesWithTheVectorsOfFiveAxisMachines) {
  std::ifstream file(std::string(AIRCUT_SOURCE_DIR) + "/tests/data/five_axis.json");
  const auto data = nlohmann::json::parse(file);
  ASSERT_GE(data.at("machines").size(), 8u);
  for (const auto& m : data.at("machines")) {
    const ChainGeometry g = geometry_of(m);
    std::string reason;
    const auto chain = make_chain(g, reason);
    ASSERT_TRUE(chain) << m.at("name") << ": " << reason;
    for (const auto& v : m.at("vectors")) {
      const JointVector q = joints_of(g, v.at("joints"));
      const auto tip = chain->forward(q, {});
      ASSERT_TRUE(tip);
      const Vec3 point((*tip)[Axis::x], (*tip)[Axis::y], (*tip)[Axis::z]);
      const Vec3 axis = vec(v.at("pose").at("tool_axis"));
      EXPECT_LE((point - vec(v.at("pose").at("tip"))).norm(), 1e-6) << m.at("name") << v;
      EXPECT_LE((*chain->tool_axis(*tip) - axis).norm(), 1e-9) << m.at("name") << v;

      const auto found = chain_positions(*chain, point, axis, {}, q);
      EXPECT_EQ(found.size(), v.at("ik_solutions").size()) << m.at("name") << v;
      for (const auto& wanted : v.at("ik_solutions")) {
        double best = 1e9;
        for (const JointVector& f : found)
          best = std::min(best, difference(g, f, joints_of(g, wanted)));
        EXPECT_LE(best, 1e-4) << m.at("name") << wanted;
      }
    }
  }
}

// The offset of a tool is fixed to the spindle: it is the same as a gauge point that is farther
// out.
TEST(Chain, TakesAToolOffsetAsALongerSpindle) {
  for (const Sample& sample : samples()) {
    if (sample.kinematics->type() != "chain") continue;
    Random random(4);
    for (int i = 0; i < 100; ++i) {
      const AxisValues tip = random_tip(sample, random);
      const AxisValues offset = axis_values(0, 0, random.between(10, 200));
      const auto joints = sample.kinematics->inverse({tip, offset}, {});
      ASSERT_TRUE(joints);
      const auto gauge = sample.kinematics->forward(*joints, {});
      ASSERT_TRUE(gauge);
      const Vec3 wanted = Vec3(tip[Axis::x], tip[Axis::y], tip[Axis::z]) +
                          *sample.kinematics->tool_axis(tip) * offset[Axis::z];
      EXPECT_LE((Vec3((*gauge)[Axis::x], (*gauge)[Axis::y], (*gauge)[Axis::z]) - wanted).norm(),
                1e-9);
    }
  }
}

ChainGeometry three_axes() {
  ChainGeometry g;
  g.tool = {{JointKind::linear, Vec3::Zero(), Vec3::UnitX(), 1, 0},
            {JointKind::linear, Vec3::Zero(), Vec3::UnitY(), 1, 1},
            {JointKind::linear, Vec3::Zero(), Vec3::UnitZ(), 1, 2}};
  g.words = {Axis::x, Axis::y, Axis::z};
  return g;
}

TEST(Chain, RefusesWhatItCannotSolve) {
  std::string reason;
  EXPECT_TRUE(make_chain(three_axes(), reason)) << reason;

  ChainGeometry flat = three_axes();
  flat.tool[2].direction = Vec3(1, 1, 0).normalized();
  EXPECT_FALSE(make_chain(flat, reason));
  EXPECT_NE(reason.find("one plane"), std::string::npos) << reason;

  ChainGeometry twice = three_axes();
  twice.words[2] = Axis::y;
  EXPECT_FALSE(make_chain(twice, reason));
  EXPECT_NE(reason.find("XYY"), std::string::npos) << reason;

  ChainGeometry loose = three_axes();
  loose.tool.pop_back();
  EXPECT_FALSE(make_chain(loose, reason));
  EXPECT_NE(reason.find("not on the way"), std::string::npos) << reason;
}

// Where an angle is open because the tool is along the first rotary axis, it stays as it is.
TEST(Chain, KeepsAnAngleThatTheDirectionLeavesOpen) {
  ChainGeometry g = three_axes();
  g.work = {{JointKind::rotary, Vec3(0, 0, 50), Vec3::UnitX(), -1, 3},
            {JointKind::rotary, Vec3::Zero(), Vec3::UnitZ(), -1, 4}};
  g.words.push_back(Axis::a);
  g.words.push_back(Axis::c);
  std::string reason;
  const auto chain = make_chain(g, reason);
  ASSERT_TRUE(chain) << reason;
  JointVector near = JointVector::Zero(5);
  near[4] = 0.7;
  const auto found = chain_positions(*chain, Vec3(1, 2, 3), Vec3::UnitZ(), {}, near);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0][3], 0, 1e-12);
  EXPECT_EQ(found[0][4], 0.7);
}

}  // namespace
}  // namespace aircut::machine
