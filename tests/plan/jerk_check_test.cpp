// What keeps a jerk limit where the solver alone does not: the look at the log's samples, and time.
#include "plan/jerk_check.h"

#include <gtest/gtest.h>

#include "plan/s_curve.h"
#include "support/plan_machines.h"

namespace aircut::plan {
namespace {

using namespace test;

struct StraightRide : ::testing::Test {
  std::shared_ptr<machine::Machine> machine = identity_machine("X", {{100, 1000, 20000}});
  JointLimits limits{machine::JointVector::Constant(1, 100),
                     machine::JointVector::Constant(1, 1000),
                     machine::JointVector::Constant(1, 20000)};
  LogSamples samples{machine->kinematics(), limits, machine::JointVector::Zero(1), 0.001};
  std::deque<WayItem> items;
  double length = 30;

  void SetUp() override {
    WayItem item;
    Line line;
    line.end = xyz(length, 0, 0);
    line.length = length;
    item.segment.path = line;
    item.grid.at = {{}, {length, 0, 1, {}}};
    items.push_back(std::move(item));
  }
  std::vector<LawKnot> law(double a, double j) const {
    std::vector<LawKnot> out;
    for (const ProfileKnot& k : s_curve(length, {100, a, j}).knots)
      out.push_back({k.t, k.s, k.v, k.a, k.j, LimitedBy::none});
    return out;
  }
  double worst(const std::vector<LawKnot>& knots, double clock = 0.0123) const {
    double share = 0;
    for (const Excess& e : samples.excess({items, {}, knots, clock, 0}, 1e9))
      share = std::max(share, e.share);
    return share;
  }
};

TEST_F(StraightRide, WithinTheLimitsShowsNoExcess) { EXPECT_EQ(worst(law(1000, 20000)), 0); }

TEST_F(StraightRide, ShowsHowFarALimitIsPassed) {
  EXPECT_NEAR(worst(law(1000, 30000)), 1.5, 1e-3);
  EXPECT_NEAR(worst(law(1100, 20000)), 1.1, 1e-3);
}

TEST_F(StraightRide, CarriedOutInMoreTimeKeepsTheLimit) {
  std::vector<LawKnot> knots = law(1000, 40000);
  const double before = knots.back().t;
  slow_down(knots, std::cbrt(2.0));
  EXPECT_NEAR(knots.back().t, std::cbrt(2.0) * before, 1e-12);
  EXPECT_EQ(knots.back().x, length);
  EXPECT_EQ(worst(knots), 0);
  for (std::size_t i = 0; i + 1 < knots.size(); ++i)
    EXPECT_NEAR(knots[i].way(knots[i + 1].t - knots[i].t), knots[i + 1].x, 1e-9);
}

TEST_F(StraightRide, CountsWhatWentOutBeforeIt) {
  // A motion that still runs at 100 mm/s when it ends makes a jump for the samples behind it.
  Segment segment;
  Line line;
  line.end = xyz(10, 0, 0);
  line.length = 10;
  segment.path = line;
  segment.profile.knots = {{0, 0, 100, 0, 0}, {0.1, 10, 100, 0, 0}};
  EXPECT_EQ(worst(law(1000, 20000)), 0);
  samples.pass(segment, 0);
  items.front().segment.path = Line{line.end, xyz(40, 0, 0), length};
  EXPECT_GT(worst(law(1000, 20000), 0.1), 50);
}

}  // namespace
}  // namespace aircut::plan
