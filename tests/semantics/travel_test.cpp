// Joint travel along the programmed path. Judges: closed forms, and dense sampling of the inverse.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "semantics/semantics.h"
#include "support/plan_machines.h"

namespace aircut::semantics {
namespace {

using test::xyz;

class Travel : public ::testing::Test {
 protected:
  Travel() : machine_(test::mill()) {
    for (machine::Joint& joint : machine_->tree_) {
      joint.min = -100;
      joint.max = 200;
    }
  }

  Diagnostics run(const std::vector<canon::Action>& actions) {
    Diagnostics out;
    TravelCheck check(*machine_, machine_->home(), out);
    for (const canon::Action& action : actions) check.see(command(action));
    unchecked_ = check.unchecked();
    return out;
  }
  // Each on a line of its own.
  canon::Command command(const canon::Action& action) {
    canon::Command c;
    c.action = action;
    c.span = {.text = &text_, .begin = 2ull * line_, .length = 1, .line = ++line_};
    return c;
  }

  SourceText text_{"a.ngc", std::string("x\nx\nx\nx\nx\nx\nx\nx\nx\nx\nx\nx\n")};
  std::uint32_t line_ = 0;
  std::shared_ptr<machine::Machine> machine_;
  std::vector<std::string> unchecked_;
};

TEST_F(Travel, AllowsAJointToGoRightToItsLimitAndNoMicrometreFurther) {
  EXPECT_TRUE(
      run({canon::Rapid{xyz(200, -100, 0)}, canon::LinearFeed{xyz(0, 0, 0)}}).list().empty());
  const Diagnostics out = run({canon::Rapid{xyz(200.001, 0, 0)}});
  ASSERT_EQ(out.list().size(), 1u);
  EXPECT_EQ(out.list()[0].kind, "overtravel");
  EXPECT_EQ(out.list()[0].message,
            "joint X passes its upper limit by 0.001 mm: it reaches 200.001 mm, the limit is "
            "200.000 mm");
}

TEST_F(Travel, FindsTheBulgeOfAnArcWhoseEndsAreInside) {
  canon::ArcFeed arc;
  arc.end = xyz(190, 30, 0);
  arc.centre = Vec3(190, 0, 0);
  const Diagnostics out = run({canon::Rapid{xyz(190, -30, 0)}, arc});
  ASSERT_EQ(out.list().size(), 1u);
  EXPECT_EQ(out.list()[0].span.line, 2u);
  EXPECT_NE(out.list()[0].message.find("reaches 220.000 mm"), std::string::npos);
  arc.turns = -1;  // the other way round, it bulges inwards
  EXPECT_TRUE(run({canon::Rapid{xyz(190, -30, 0)}, arc}).list().empty());
}

TEST_F(Travel, TellsAJointThatStaysOutsideOnce) {
  const Diagnostics out = run({canon::Rapid{xyz(210, 0, 0)}, canon::LinearFeed{xyz(220, 0, 0)},
                               canon::LinearFeed{xyz(0, 0, 0)}, canon::LinearFeed{xyz(0, 0, -101)},
                               canon::LinearFeed{xyz(210, 0, 0)}});
  ASSERT_EQ(out.list().size(), 3u);
  EXPECT_EQ(out.list()[0].span.line, 1u);
  EXPECT_EQ(out.list()[1].span.line, 4u);
  EXPECT_EQ(out.list()[2].span.line, 5u);
}

TEST_F(Travel, CountsTheLengthOfTheTool) {
  // The axes are 60 above the tip.
  EXPECT_TRUE(run({canon::Rapid{xyz(0, 0, 200)}}).list().empty());
  EXPECT_EQ(run({canon::ToolLengthOffset{xyz(0, 0, 60), 1}, canon::Rapid{xyz(0, 0, 140)},
                 canon::Rapid{xyz(0, 0, 140.1)}})
                .list()
                .size(),
            1u);
  // Switching it on moves nothing.
  EXPECT_TRUE(run({canon::Rapid{xyz(0, 0, 190)}, canon::ToolLengthOffset{xyz(0, 0, 60), 1},
                   canon::Rapid{xyz(50, 0, 130)}})
                  .list()
                  .empty());
}

TEST_F(Travel, FollowsARigidTapToItsBottom) {
  canon::SyncFeed tap;
  tap.end = xyz(0, 0, -120);
  tap.rigid_tap = true;
  EXPECT_EQ(run({tap}).list().size(), 1u);
}

TEST_F(Travel, BoundsASplineByItsControlPoints) {
  canon::SplineFeed spline;
  spline.points = {{0, 0, 1}, {90, 30, 1}, {50, 0, 1}};
  EXPECT_TRUE(run({spline}).list().empty());
  EXPECT_TRUE(unchecked_.empty());
  spline.points[1].x = 250;  // the curve itself may stay inside: that is not known
  EXPECT_EQ(run({spline}).list().at(0).kind, "not_checked");
  EXPECT_EQ(unchecked_.size(), 1u);
}

// On a machine whose joints are not its axes: what the check finds is what a thousand points find.
TEST_F(Travel, AgreesWithDenseSamplingOnAParallelMachine) {
  const auto ox = test::ox_machine();
  const machine::JointVector home =
      *ox->kinematics().inverse({xyz(250, 0, -320), {}}, machine::JointVector::Zero(3));
  for (machine::Joint& joint : ox->tree_)
    if (joint.driven >= 0) {
      joint.min = home[joint.driven] - 60;
      joint.max = home[joint.driven] + 60;
    }
  std::mt19937 random(7);
  std::uniform_real_distribution<double> xy(-55, 55), z(-345, -270);
  int found = 0, missed = 0, clear = 0;
  for (int n = 0; n < 300; ++n) {
    const AxisValues a = xyz(250 + xy(random), xy(random), z(random));
    const AxisValues b = xyz(250 + xy(random), xy(random), z(random));
    double worst = -1e9;
    for (int i = 0; i <= 1000; ++i) {
      const AxisValues p = a + (i / 1000.0) * (b - a);
      const auto q = ox->kinematics().inverse({p, {}}, home);
      ASSERT_TRUE(q);
      for (int j = 0; j < 3; ++j) worst = std::max(worst, std::abs((*q)[j] - home[j]) - 60);
    }
    Diagnostics out;
    TravelCheck check(*ox, home, out);
    check.see(command(canon::LinearFeed{a}));
    Diagnostics line;
    TravelCheck second(*ox, *ox->kinematics().inverse({a, {}}, home), line);
    second.see({canon::LinearFeed{b}, {}, 1, {}});
    EXPECT_TRUE(second.unchecked().empty());
    const bool told = line.errors() > 0;
    if (worst > 1e-5) {
      ++found;
      missed += told ? 0 : 1;
    } else if (worst < -0.05) {
      ++clear;
      EXPECT_FALSE(told) << n << " " << worst;
    }
  }
  EXPECT_EQ(missed, 0);
  EXPECT_GT(found, 20);
  EXPECT_GT(clear, 20);
}

TEST_F(Travel, TellsTheFirstPointOutOfReachAndGoesOn) {
  const auto ox = test::ox_machine();
  const machine::JointVector home =
      *ox->kinematics().inverse({xyz(250, 0, -320), {}}, machine::JointVector::Zero(3));
  Diagnostics out;
  TravelCheck check(*ox, home, out);
  check.see(command(canon::LinearFeed{xyz(250, 0, -500)}));
  check.see(command(canon::LinearFeed{xyz(260, 0, -500)}));
  check.see(command(canon::LinearFeed{xyz(250, 0, -320)}));
  check.see(command(canon::LinearFeed{xyz(250, 0, -500)}));
  ASSERT_EQ(out.list().size(), 2u);
  EXPECT_EQ(out.list()[0].kind, "unreachable");
  EXPECT_EQ(out.list()[1].span.line, 4u);
}

}  // namespace
}  // namespace aircut::semantics
