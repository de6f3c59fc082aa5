// Travel bounds of arms that are solved numerically: never less than dense samples of a way, close
// to them on ordinary pieces, none where there is no proof.
#include <gtest/gtest.h>

#include <cmath>

#include "samples.h"

namespace aircut::machine {
namespace {

struct Arm {
  std::shared_ptr<const Kinematics> kinematics;
  int joints = 6;
};

// Rows at random: links of 50 to 400 mm, twists in steps of 90° or any, one joint in ten slides.
Arm random_arm(Random& random, int joints) {
  const auto list = [&](double theta, double d, double a, double alpha) {
    return "[" + fixed(theta, 6) + ", " + fixed(d, 6) + ", " + fixed(a, 6) + ", " +
           fixed(alpha, 6) + "]";
  };
  std::string rows, kinds;
  for (int j = 0; j < joints; ++j) {
    const double alpha = random.between(0, 1) < 0.5 ? 90 * std::round(random.between(-1.4, 1.4))
                                                    : random.between(-120, 120);
    rows += (j ? ", " : "") + list(random.between(-90, 90), random.between(-200, 200),
                                   random.between(-400, 400), alpha);
    kinds += random.between(0, 1) < 0.1 ? 'T' : 'R';
  }
  const std::string convention = random.between(0, 1) < 0.5 ? "standard" : "modified";
  return {of_type("serial", {"dh = [" + rows + "]", "kinds = \"" + kinds + "\"",
                             "convention = \"" + convention + "\""}),
          joints};
}

JointVector random_joints(Random& random, int count) {
  JointVector q(count);
  for (int j = 0; j < count; ++j) q[j] = random.between(-2, 2);
  return q;
}

TipInterval around(const AxisValues& tip, const JointVector& near) {
  return {tip, tip, {}, {}, near};
}

// The ways of the joints along a wave through the words, summed over 400 samples; nothing where
// the next sample can't be found.
std::optional<std::vector<double>> sampled_way(const Kinematics& k, const AxisValues& tip,
                                               Random& random, double size, TipInterval& box) {
  constexpr int steps = 400;
  AxisValues amplitude, cycles, last = tip;
  for (const Axis axis : all_axes) {
    if (!k.axes().has(axis)) continue;
    amplitude[axis] = size * random.between(0, 1) / (is_rotary(axis) ? 300 : 1);
    cycles[axis] = random.between(0.2, 9);
  }
  std::vector<double> way(static_cast<std::size_t>(k.joint_count()));
  JointVector before = box.near;
  for (int i = 0; i <= steps; ++i) {
    AxisValues now = tip;
    for (const Axis axis : all_axes) {
      now[axis] += amplitude[axis] * std::sin(cycles[axis] * i / steps);
      box.low[axis] = std::min(box.low[axis], now[axis]);
      box.high[axis] = std::max(box.high[axis], now[axis]);
      box.travel[axis] += std::abs(now[axis] - last[axis]);
    }
    last = now;
    const auto q = k.inverse({now, {}}, before);
    if (!q) return std::nullopt;
    for (std::size_t j = 0; j < way.size(); ++j) {
      const auto at = static_cast<Eigen::Index>(j);
      way[j] += std::abs((*q)[at] - before[at]);
    }
    before = *q;
  }
  return way;
}

TEST(ArmBound, IsNeverLessThanTheTravelOfDenseSamples) {
  Random random(91);
  int proven = 0;
  for (int i = 0; i < 600; ++i) {
    const Arm arm = random_arm(random, std::array{3, 5, 6}[static_cast<std::size_t>(i % 3)]);
    const JointVector q = random_joints(random, arm.joints);
    const AxisValues tip = *arm.kinematics->forward(q, {});
    TipInterval box = around(tip, q);
    const double size = std::pow(10.0, random.between(-3, 0.5));
    const auto way = sampled_way(*arm.kinematics, tip, random, size, box);
    std::vector<double> bound(static_cast<std::size_t>(arm.joints), -1);
    if (!arm.kinematics->travel_bound(box, bound)) continue;
    ++proven;
    ASSERT_TRUE(way) << "the proof says that there are joints, " << i;
    for (std::size_t j = 0; j < bound.size(); ++j)
      ASSERT_GE(bound[j], (*way)[j] - 1e-8) << i << ", joint " << j + 1;
  }
  EXPECT_GT(proven, 200);
}

TEST(ArmBound, OfAStraightMoveIsWithinThreeTimesTheWay) {
  Random random(92);
  int close = 0, proven = 0, moved = 0;
  for (const Sample& sample : catalogue()) {
    if (sample.bounded) continue;
    for (int i = 0; i < 200; ++i) {
      const AxisValues tip = random_tip(sample, random);
      const auto q = sample.kinematics->inverse({tip, {}}, sample.start());
      ASSERT_TRUE(q) << sample.name;
      TipInterval box = around(tip, *q);
      const Axis axis = i % 2 ? Axis::x : Axis::z;
      box.high[axis] += 0.05;
      box.travel[axis] = 0.05;
      std::vector<double> bound(static_cast<std::size_t>(q->size()), -1);
      if (!sample.kinematics->travel_bound(box, bound)) continue;
      ++proven;
      const auto there = sample.kinematics->inverse({box.high, {}}, *q);
      ASSERT_TRUE(there) << sample.name;
      for (std::size_t j = 0; j < bound.size(); ++j) {
        const auto at = static_cast<Eigen::Index>(j);
        const double way = std::abs((*there)[at] - (*q)[at]);
        ASSERT_GE(bound[j], way - 1e-9) << sample.name;
        if (way < 2e-5) continue;  // rad or mm: a joint that hardly moves has no ratio
        ++moved;
        close += bound[j] <= 3 * way;
      }
    }
  }
  EXPECT_GE(proven, 500);  // of 600
  EXPECT_GT(moved, 1000);
  EXPECT_GE(close, moved * 99 / 100) << moved;
}

TEST(ArmBound, IsNotGivenWithoutAProof) {
  const auto arm = of_type("serial");
  JointVector q(6);
  q << 0.4, -1, 0.4, 0.1, 0.7, 0.1;
  const AxisValues tip = *arm->forward(q, {});
  std::vector<double> bound(6, -1);
  TipInterval box = around(tip, q);
  box.high[Axis::x] += 0.1;
  box.travel[Axis::x] = 0.1;
  EXPECT_TRUE(arm->travel_bound(box, bound));
  // A box that is too large, a wrist that is straight, an offset that is not possible, no number.
  TipInterval large = box;
  large.high[Axis::x] += 3000;
  EXPECT_FALSE(arm->travel_bound(large, bound));
  JointVector straight = q;
  straight[4] = 0;
  TipInterval singular = around(*arm->forward(straight, {}), straight);
  singular.high[Axis::y] += 0.1;
  EXPECT_FALSE(arm->travel_bound(singular, bound));
  TipInterval tilted = box;
  tilted.tool_offset[Axis::b] = 1;
  EXPECT_FALSE(arm->travel_bound(tilted, bound));
  TipInterval nothing = box;
  nothing.high[Axis::y] = std::nan("");
  EXPECT_FALSE(arm->travel_bound(nothing, bound));
  // Seven joints for six words.
  Random random(93);
  const Arm spare = random_arm(random, 7);
  const JointVector seven = random_joints(random, 7);
  std::vector<double> ways(7, -1);
  const AxisValues at = *spare.kinematics->forward(seven, {});
  EXPECT_FALSE(spare.kinematics->travel_bound(around(at, seven), ways));
}

}  // namespace
}  // namespace aircut::machine
