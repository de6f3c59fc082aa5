// What every kinematics promises, for every row of the table.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "machine/kinematics/kinematics_table.h"
#include "samples.h"

namespace aircut::machine {
namespace {

std::size_t values_of(const Kinematics& kinematics) {
  return static_cast<std::size_t>(kinematics.joint_count()) + kinematics.passive_names().size();
}

// Driven joints, then passive values.
std::vector<double> all_values(const Kinematics& kinematics, const JointVector& joints) {
  std::vector<double> values(joints.data(), joints.data() + joints.size());
  values.resize(values_of(kinematics));
  kinematics.passive(joints, std::span(values).subspan(static_cast<std::size_t>(joints.size())));
  return values;
}

TEST(KinematicsContract, EveryRowHasASample) {
  for (const KinematicsRow& row : kinematics_table()) {
    const auto all = samples();
    EXPECT_TRUE(std::any_of(all.begin(), all.end(), [&](const Sample& sample) {
      return sample.kinematics->type() == row.type;
    })) << row.type;
  }
}

TEST(KinematicsContract, CountsItsPassiveValues) {
  for (const Sample& sample : samples())
    EXPECT_EQ(static_cast<std::size_t>(sample.kinematics->passive_count()),
              sample.kinematics->passive_names().size());
}

TEST(KinematicsContract, ForwardUndoesInverse) {
  for (const Sample& sample : samples()) {
    Random random(1);
    const int poses = round_trips(5000);
    for (int i = 0; i < poses; ++i) {
      const Target target =
          with_tool(random_tip(sample, random), sample.tools ? random.between(0, 150) : 0);
      const JointVector near = sample.start();
      const auto joints = sample.kinematics->inverse(target, near);
      ASSERT_TRUE(joints) << sample.name << ": " << joints.error().reason;
      ASSERT_EQ(joints->size(), sample.kinematics->joint_count());
      const auto tip = sample.kinematics->forward(*joints, target.tool_offset);
      ASSERT_TRUE(tip) << sample.name << ": " << tip.error().reason;
      for (const Axis axis : {Axis::x, Axis::y, Axis::z, Axis::a, Axis::b, Axis::c})
        ASSERT_NEAR((*tip)[axis], target.tip[axis], 1e-9) << sample.name << ' ' << letter(axis);
      const auto again = sample.kinematics->inverse({*tip, target.tool_offset}, *joints);
      ASSERT_TRUE(again) << sample.name;
      ASSERT_LE((*again - *joints).cwiseAbs().maxCoeff(), 1e-6) << sample.name;
    }
  }
}

// The tip moves on a parabola p(s) = tip + s·d + s²/2·dd.
AxisValues at(const AxisValues& tip, const AxisValues& d, const AxisValues& dd, double s) {
  return tip + s * d + (s * s / 2) * dd;
}

TEST(KinematicsContract, RatesAreTheDerivativesOfInverse) {
  for (const Sample& sample : samples()) {
    Random random(2);
    for (int i = 0; i < 2000; ++i) {
      AxisValues tip = random_tip(sample, random);
      tip[Axis::z] = std::max(tip[Axis::z], sample.low[Axis::z] + 12);  // room for the difference
      AxisValues d, dd;
      for (const Axis axis : all_axes)
        if (sample.kinematics->axes().has(axis)) {
          d[axis] = random.between(-1, 1);
          dd[axis] = random.between(-1, 1);
        }
      JointVector dq, ddq;
      constexpr double h = 1e-3;
      // A numeric inverse ends within 1e-9 mm, which is 1e-6 over h, and has no singular poses to
      // keep clear of: its derivatives may be large.
      const double slack = sample.bounded ? 1e-6 : 1e-5;
      const auto size = [&](const JointVector& v) {
        return sample.bounded ? 1 : 1 + v.cwiseAbs().maxCoeff();
      };
      const JointVector near = sample.start();
      const JointVector q = *sample.kinematics->inverse({tip, {}}, near);
      ASSERT_TRUE(sample.kinematics->rates({tip, {}}, q, d, dd, dq, ddq)) << sample.name;
      // Five points: the error is of the order h⁴.
      const auto q_at = [&](double s) -> JointVector {
        return *sample.kinematics->inverse({at(tip, d, dd, s), {}}, q);
      };
      const JointVector a2 = q_at(-2 * h), a1 = q_at(-h), b1 = q_at(h), b2 = q_at(2 * h);
      const JointVector first = (8 * (b1 - a1) - (b2 - a2)) / (12 * h);
      // Its second derivative is held against differences of its first one.
      const auto dq_at = [&](double s, const JointVector& joints) {
        JointVector v, ignored;
        EXPECT_TRUE(
            sample.kinematics->rates({at(tip, d, dd, s), {}}, joints, d + s * dd, dd, v, ignored));
        return v;
      };
      const JointVector second =
          sample.bounded ? JointVector((16 * (b1 + a1) - (b2 + a2) - 30 * q) / (12 * h * h))
                         : JointVector((8 * (dq_at(h, b1) - dq_at(-h, a1)) - dq_at(2 * h, b2) +
                                        dq_at(-2 * h, a2)) /
                                       (12 * h));
      ASSERT_LE((dq - first).cwiseAbs().maxCoeff(), slack * size(dq)) << sample.name;
      ASSERT_LE((ddq - second).cwiseAbs().maxCoeff(), 10 * slack * size(ddq)) << sample.name;
    }
  }
}

struct Way {
  TipInterval interval;
  std::vector<double> travel;  // of every value, summed over the samples
};

// A path inside a small box: a sum of two sines per axis, so that it turns back now and then.
Way random_way(const Sample& sample, Random& random, double size) {
  const AxisValues start = random_tip(sample, random);
  std::array<double, 9> amplitude{}, phase{}, cycles{};
  for (const Axis axis : all_axes) {
    const double room = (sample.high[axis] - sample.low[axis]) / 2;
    amplitude[index(axis)] = random.between(0, std::min(size, room));
    phase[index(axis)] = random.between(0, 6);
    cycles[index(axis)] = random.between(0.2, 9);
  }
  Way way;
  way.interval.near = sample.start();
  way.interval.low = way.interval.high = start;
  std::vector<double> before;
  AxisValues last;
  const int steps = sample.steps;
  for (int i = 0; i <= steps; ++i) {
    AxisValues tip;
    for (const Axis axis : all_axes) {
      const std::size_t k = index(axis);
      const double wave = std::sin(phase[k] + cycles[k] * i / steps) - std::sin(phase[k]);
      tip[axis] =
          std::clamp(start[axis] + amplitude[k] * wave, sample.low[axis], sample.high[axis]);
      if (i == 0) way.interval.low[axis] = way.interval.high[axis] = tip[axis];
      way.interval.low[axis] = std::min(way.interval.low[axis], tip[axis]);
      way.interval.high[axis] = std::max(way.interval.high[axis], tip[axis]);
      if (i > 0) way.interval.travel[axis] += std::abs(tip[axis] - last[axis]);
    }
    last = tip;
    const auto joints = sample.kinematics->inverse({tip, {}}, sample.start());
    EXPECT_TRUE(joints) << sample.name;
    const std::vector<double> now = all_values(*sample.kinematics, *joints);
    way.travel.resize(now.size());
    for (std::size_t k = 0; k < now.size() && i > 0; ++k)
      way.travel[k] += std::abs(now[k] - before[k]);
    before = now;
  }
  return way;
}

TEST(KinematicsContract, TravelBoundIsNeverLessThanTheTravelOfDenseSamples) {
  for (const Sample& sample : samples()) {
    if (!sample.bounded) continue;
    Random random(3);
    for (int i = 0; i < sample.ways; ++i) {
      const Way way = random_way(sample, random, std::pow(10.0, random.between(-3, 2)));
      std::vector<double> bound(values_of(*sample.kinematics), -1);
      ASSERT_TRUE(sample.kinematics->travel_bound(way.interval, bound)) << sample.name;
      for (std::size_t k = 0; k < bound.size(); ++k)
        ASSERT_GE(bound[k], way.travel[k] - sample.rounding) << sample.name << ", value " << k;
    }
  }
}

TEST(KinematicsContract, TravelBoundOfASmallStraightMoveIsClose) {
  for (const Sample& sample : samples()) {
    if (!sample.bounded) continue;
    Random random(4);
    for (int i = 0; i < 300; ++i) {
      AxisValues a = random_tip(sample, random);
      a[Axis::z] = std::max(a[Axis::z], sample.low[Axis::z] + 5);
      // Down and along X in turn: a mixed move may be bounded by the sum of both.
      const Axis axis = i % 2 ? Axis::x : Axis::z;
      AxisValues b = a;
      b[axis] -= 0.01;
      TipInterval interval{b, a, {}, {}, sample.start()};
      interval.travel[axis] = 0.01;
      std::vector<double> bound(values_of(*sample.kinematics), -1);
      ASSERT_TRUE(sample.kinematics->travel_bound(interval, bound));
      const JointVector near = sample.start();
      const auto at_a = all_values(*sample.kinematics, *sample.kinematics->inverse({a, {}}, near));
      const auto at_b = all_values(*sample.kinematics, *sample.kinematics->inverse({b, {}}, near));
      for (std::size_t k = 0; k < bound.size(); ++k)
        ASSERT_LE(bound[k], std::abs(at_b[k] - at_a[k]) * 1.01 + sample.turning)
            << sample.name << ' ' << k;
    }
  }
}

}  // namespace
}  // namespace aircut::machine
