// q(t): derivatives against differences, travel bounds against sampling.
#include "motion/motion.h"

#include <gtest/gtest.h>

#include <random>

#include "support/plan_machines.h"

namespace aircut::motion {
namespace {

using namespace test;

// The O-X glide without its analytic rates: what a new kinematics starts with.
class WithoutRates final : public machine::Kinematics {
 public:
  std::string_view type() const override { return "without-rates"; }
  AxisSet axes() const override { return inner_->axes(); }
  int joint_count() const override { return inner_->joint_count(); }
  tl::expected<JointVector, machine::ReachError> inverse(const machine::Target& target,
                                                         const JointVector& near) const override {
    return inner_->inverse(target, near);
  }
  tl::expected<AxisValues, machine::ReachError> forward(const JointVector& joints,
                                                        const AxisValues& o) const override {
    return inner_->forward(joints, o);
  }
  bool travel_bound(const machine::TipInterval&, std::span<double>) const override { return false; }

 private:
  std::shared_ptr<const machine::Kinematics> inner_ = machine::make_ox_glide({});
};

struct Case {
  std::shared_ptr<machine::Machine> machine;
  AxisValues start;
  Program program;
  int fewest = 20;  ///< places that must be compared
};

Case on_mill() {
  Case out{mill(), {}, {}};
  out.program.blend(0.5).feed(40).line(xyz(20, 5, 1)).arc(xyz(30, 5, -4), 25, 5, -2);
  out.program.rapid(xyz(0, 0, 10)).dwell(0.05);
  return out;
}
Case on_ox() {
  Case out{ox_machine({200, 2000}), xyz(250, 0, -300), {}};
  out.program.blend(0.5).feed(40).line(xyz(270, 10, -340)).arc(xyz(250, 10, -340), 260, 10, 2);
  out.program.rapid(xyz(240, -20, -310)).dwell(0.05);
  return out;
}
Case without_rates() {
  Case out = on_ox();
  out.machine->kinematics_ = std::make_shared<WithoutRates>();
  return out;
}

Case dogleg() {
  Case out{mill(), {}, {}};
  out.machine->rapid_ = machine::RapidMode::dogleg;
  out.program.feed(40).line(xyz(5, 5, 1)).rapid(xyz(60, -20, 8)).rapid(xyz(0, 0, 10));
  out.fewest = 2;
  return out;
}
// Six rotary joints in step.
Case joint_rapids() {
  Case out{std::make_shared<machine::Machine>(), {}, {}};
  for (const char* name : {"1", "2", "3", "4", "5", "6"})
    add_joint(*out.machine, name, true, {180, 720});
  out.machine->kinematics_ = machine::make_robot_6r({});
  out.machine->rapid_ = machine::RapidMode::joint;
  out.start = *out.machine->kinematics().forward(zeros(*out.machine), {});
  out.program.rapid(out.start + xyz(-100, 80, -60)).rapid(out.start + xyz(-20, -90, 0));
  out.fewest = 1;
  return out;
}

class EveryMachine : public testing::TestWithParam<Case (*)()> {};

template <class Visit>
void each_segment(const Case& setup, Visit visit) {
  JointVector joints = joints_at(*setup.machine, setup.start);
  const Planned planned = plan_program(*setup.machine, joints, setup.program);
  ASSERT_TRUE(planned.errors.empty());
  ASSERT_FALSE(planned.segments.back().failure);
  for (const plan::Segment& segment : planned.segments) {
    const JointMotion motion(*setup.machine, segment, joints);
    visit(motion);
    joints = *motion.at(motion.t1());
  }
}

TEST_P(EveryMachine, HasTheSpeedsThatDifferencesGive) {
  const Case setup = GetParam()();
  int compared = 0;
  each_segment(setup, [&](const JointMotion& motion) {
    const auto& knots = motion.segment().profile.knots;
    for (std::size_t i = 0; i + 1 < knots.size(); i += 3) {
      // Inside a piece of the profile, where the acceleration is smooth.
      const double span = knots[i + 1].t - knots[i].t;
      const double t = motion.t0() + knots[i].t + span / 2, h = std::min(span / 4, 1e-4);
      if (h < 1e-6) continue;
      const JointVector a = *motion.at(t - h), m = *motion.at(t), b = *motion.at(t + h);
      const JointState state = *motion.state_at(t);
      EXPECT_LT((state.q - m).norm(), 1e-12);
      EXPECT_LT((state.v - (b - a) / (2 * h)).norm(), 1e-4 * (1 + state.v.norm()));
      EXPECT_LT((state.a - (b - 2 * m + a) / (h * h)).norm(),
                2e-3 * (10 + state.a.norm()) + 4e-13 / (h * h));
      ++compared;
    }
  });
  EXPECT_GT(compared, setup.fewest);
}

TEST_P(EveryMachine, GoesOnWhereTheLastSegmentEnded) {
  const Case setup = GetParam()();
  std::optional<JointState> last;
  each_segment(setup, [&](const JointMotion& motion) {
    const JointState start = *motion.state_at(motion.t0());
    if (last && motion.segment().duration() > 0) {
      EXPECT_LT((start.q - last->q).norm(), 1e-9);
      // Within the jump that a nearly tangent joint may have.
      EXPECT_LT((start.v - last->v).norm(), 4e-3);
    }
    if (motion.segment().duration() > 0) last = *motion.state_at(motion.t1());
  });
  EXPECT_LT(last->v.norm(), 1e-9);
}

TEST_P(EveryMachine, TravelsNoFurtherThanTheBound) {
  const Case setup = GetParam()();
  const bool bounded = setup.machine->kinematics().type() != "without-rates";
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<double> travel(16);
  each_segment(setup, [&](const JointMotion& motion) {
    for (int i = 0; i < 20; ++i) {
      double ta = motion.t0() + uniform(random) * motion.segment().duration();
      double tb = motion.t0() + uniform(random) * motion.segment().duration();
      if (ta > tb) std::swap(ta, tb);
      const bool known = motion.travel_bound(ta, tb, travel);
      const bool moves = !std::holds_alternative<plan::Hold>(motion.segment().path) && tb > ta;
      EXPECT_EQ(known, bounded || !moves);
      if (!known) continue;
      JointVector last = *motion.at(ta), way = JointVector::Zero(last.size());
      for (int k = 1; k <= 200; ++k) {
        const JointVector q = *motion.at(ta + (tb - ta) * k / 200);
        way += (q - last).cwiseAbs();
        last = q;
      }
      for (Eigen::Index j = 0; j < way.size(); ++j)
        EXPECT_LE(way[j], travel[static_cast<std::size_t>(j)] + 1e-9);
    }
  });
}

std::string machine_name(const testing::TestParamInfo<Case (*)()>& info) {
  return std::array{"Mill", "OxGlide", "WithoutRates", "Dogleg", "JointRapids"}[info.index];
}
INSTANTIATE_TEST_SUITE_P(Motion, EveryMachine,
                         testing::Values(on_mill, on_ox, without_rates, dogleg, joint_rapids),
                         machine_name);

TEST(Motion, OfADwellStandsStill) {
  const auto machine = mill();
  Program program;
  program.dwell(2);
  const Planned planned = plan_program(*machine, zeros(*machine), program);
  const JointMotion motion(*machine, planned.segments.back(), zeros(*machine));
  std::vector<double> travel(3, 7.0);
  EXPECT_TRUE(motion.travel_bound(0, 2, travel));
  EXPECT_EQ(travel, std::vector<double>(3, 0.0));
  EXPECT_EQ(motion.state_at(1)->v.norm(), 0);
}

TEST(Motion, TellsTheFeedAlongTheMetric) {
  const auto machine = identity_machine("XC", {{100, 1000}, {360, 3600}});
  Program program;
  program.feed(10).line(at({{Axis::x, 10}, {Axis::c, 90 * rad}}));
  program.add(canon::SetFeedRate{0, 30 * rad}).line(at({{Axis::x, 10}, {Axis::c, 0}}));
  const Planned planned = plan_program(*machine, zeros(*machine), program);
  const plan::Segment& first = planned.segments[1];
  const JointMotion both(*machine, first, zeros(*machine));
  EXPECT_NEAR(both.state_at((both.t0() + both.t1()) / 2)->path_speed, 10, 1e-9);
  const JointMotion rotary(*machine, planned.segments[3], *both.at(both.t1()));
  EXPECT_NEAR(rotary.state_at((rotary.t0() + rotary.t1()) / 2)->path_speed, 30 * rad, 1e-9);
}

}  // namespace
}  // namespace aircut::motion
