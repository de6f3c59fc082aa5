// Geometry: derivatives against differences, bounds against dense sampling.
#include <gtest/gtest.h>

#include <random>

#include "plan/blend.h"
#include "support/plan_machines.h"

namespace aircut::plan {
namespace {

using test::xyz;

AxisValues random_point(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> uniform(-size, size);
  AxisValues out;
  for (const Axis axis : all_axes) out[axis] = uniform(random);
  return out;
}

// A helix or spiral about a random axis, of up to three turns.
Arc random_arc(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  canon::ArcFeed command;
  command.centre = 20 * Vec3(uniform(random), uniform(random), uniform(random));
  command.normal = Vec3(uniform(random), uniform(random), uniform(random)).normalized();
  command.turns = static_cast<int>(random() % 3) + 1;
  if (random() % 2) command.turns = -command.turns;
  const Vec3 e1 = command.normal.unitOrthogonal();
  const Vec3 e2 = command.normal.cross(e1);
  const double angle = 3 * uniform(random), r = 5 + 4 * uniform(random);
  const double r2 = r + (random() % 2 ? 2 * uniform(random) : 0);
  AxisValues start = random_point(random, 30);
  command.end = random_point(random, 30);
  const Vec3 p0 = command.centre + r * e1 + 3 * command.normal;
  const Vec3 p1 = command.centre + r2 * (std::cos(angle) * e1 + std::sin(angle) * e2) -
                  5 * uniform(random) * command.normal;
  for (const auto& [axis, i] : {std::pair{Axis::x, 0}, {Axis::y, 1}, {Axis::z, 2}}) {
    start[axis] = p0[i];
    command.end[axis] = p1[i];
  }
  return *make_arc(start, command);
}

Path random_path(std::mt19937& random, int kind) {
  if (kind == 0) return make_line(random_point(random, 50), random_point(random, 50));
  if (kind == 1) return random_arc(random);
  std::array<AxisValues, 6> control;
  for (AxisValues& p : control) p = random_point(random, 5);
  return make_curve(control);
}

class EveryPath : public testing::TestWithParam<int> {};

TEST_P(EveryPath, HasTheDerivativesThatDifferencesGive) {
  std::mt19937 random(7);
  for (int i = 0; i < 40; ++i) {
    const Path path = random_path(random, GetParam());
    const double length_ = length(path), h = 1e-4 * length_;
    const double s = (0.1 + 0.02 * i) * length_;
    const PathPoint a = evaluate(path, s - h), m = evaluate(path, s), b = evaluate(path, s + h);
    for (const Axis axis : all_axes) {
      const double third = (b.dd[axis] - a.dd[axis]) / (2 * h);
      const double size = 1e-5 * (1 + std::abs(m.d[axis]) + std::abs(m.dd[axis]) + std::abs(third));
      EXPECT_NEAR((b.p[axis] - a.p[axis]) / (2 * h), m.d[axis], size);
      EXPECT_NEAR((b.d[axis] - a.d[axis]) / (2 * h), m.dd[axis], size);
    }
  }
}

TEST_P(EveryPath, StaysInItsBoundsAndTravelsNoFurther) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int i = 0; i < 200; ++i) {
    const Path path = random_path(random, GetParam());
    double s0 = uniform(random) * length(path), s1 = uniform(random) * length(path);
    if (s0 > s1) std::swap(s0, s1);
    const machine::TipInterval box = bounds(path, s0, s1);
    AxisValues way, last = evaluate(path, s0).p;
    AxisValues low = last, high = last;
    constexpr int n = 2000;
    for (int k = 0; k <= n; ++k) {
      const AxisValues p = evaluate(path, std::min(s0 + (s1 - s0) * k / n, s1)).p;
      for (const Axis axis : all_axes) {
        EXPECT_GE(p[axis], box.low[axis]) << "axis " << letter(axis) << " s " << s0 << ".." << s1;
        EXPECT_LE(p[axis], box.high[axis]);
        way[axis] += std::abs(p[axis] - last[axis]);
        low[axis] = std::min(low[axis], p[axis]);
        high[axis] = std::max(high[axis], p[axis]);
      }
      last = p;
    }
    for (const Axis axis : all_axes) {
      EXPECT_LE(way[axis], box.travel[axis] + 1e-11);
      // Not uselessly large either.
      EXPECT_LE(box.travel[axis], 3 * way[axis] + 40 * (s1 - s0) / length(path) + 1e-9);
      if (GetParam() == 0) {
        EXPECT_NEAR(box.high[axis] - box.low[axis], high[axis] - low[axis], 1e-12);
        EXPECT_NEAR(box.travel[axis], way[axis], 1e-9);
      }
    }
  }
}

TEST_P(EveryPath, KeepsItsPointsWhenItIsCut) {
  std::mt19937 random(13);
  for (int i = 0; i < 50; ++i) {
    const Path path = random_path(random, GetParam());
    const double s0 = 0.3 * length(path), s1 = 0.8 * length(path);
    const Path part = sub_path(path, s0, s1);
    EXPECT_NEAR(length(part), s1 - s0, 1e-12 * length(path));
    for (int k = 0; k <= 10; ++k) {
      const double f = k / 10.0;
      const PathPoint whole = evaluate(path, s0 + f * (s1 - s0));
      const PathPoint cut = evaluate(part, f * length(part));
      for (const Axis axis : all_axes) {
        EXPECT_NEAR(whole.p[axis], cut.p[axis], 1e-11);
        EXPECT_NEAR(whole.d[axis], cut.d[axis], 1e-9 * (1 + std::abs(whole.d[axis])));
      }
    }
  }
}

std::string path_name(const testing::TestParamInfo<int>& info) {
  return std::array{"Line", "Arc", "Blend"}[static_cast<std::size_t>(info.param)];
}
INSTANTIATE_TEST_SUITE_P(Path, EveryPath, testing::Values(0, 1, 2), path_name);

TEST(Blend, RunsAlmostAtUnitSpeed) {
  for (const double turn : {0.001, 0.5, 1.5, 2.5, 3.0}) {
    const Line left = make_line(xyz(-10, 0, 0), xyz(0, 0, 0));
    const Line right = make_line(xyz(0, 0, 0), xyz(10 * std::cos(turn), 10 * std::sin(turn), 0));
    const Path in = left, out = right;
    const auto made = make_blend({in, out, 5, 5, 0.02}, {[](const Blend&) { return 1.0; }, {}});
    ASSERT_TRUE(made);
    double worst = 0;
    for (int k = 0; k <= 200; ++k) {
      const PathPoint p = evaluate(made->blend, made->blend.length * k / 200);
      const double speed = metric_length(Metric::xyz, p.d);
      worst = std::max(worst, std::abs(speed - 1));
    }
    EXPECT_LT(worst, turn < 2.6 ? 1e-3 : 1e-2) << turn;
  }
}

TEST(Blend, BetweenLinesIsBuiltOfTheirDirectionsAsItsRatesSay) {
  for (const double turn : {0.0025, 0.3, 1.1, 1.7, 2.5}) {
    AxisValues in = xyz(-10, 0, 0), out = xyz(7 * std::cos(turn), 7 * std::sin(turn), 0);
    in[Axis::b] = 0.001;
    out[Axis::c] = 0.002;
    const Path left = make_line(in, {}), right = make_line({}, out);
    CornerRates rates;
    double cut = 0;
    Demand demand{[](const Blend&) { return 1.0; },
                  [&](const CornerRates& r, double c) {
                    rates = r;
                    cut = c;
                    return 1.0;
                  }};
    const auto made = make_blend({left, right, 3, 3, 0.02}, demand);
    ASSERT_TRUE(made);
    EXPECT_EQ(cut, made->cut);
    EXPECT_NEAR(rates.length * cut, made->blend.length, 1e-9);
    const auto last = static_cast<double>(rates.at.size() - 1);
    const AxisValues d_in = evaluate(left, 1).d, d_out = evaluate(right, 1).d;
    for (std::size_t k = 0; k < rates.at.size(); ++k) {
      const auto& [d, dd] = rates.at[k];
      const PathPoint p = evaluate(made->blend, made->blend.length * static_cast<double>(k) / last);
      for (const Axis axis : all_axes) {
        EXPECT_NEAR(d[0] * d_in[axis] + d[1] * d_out[axis], p.d[axis], 1e-4) << turn;
        EXPECT_NEAR((dd[0] * d_in[axis] + dd[1] * d_out[axis]) / cut, p.dd[axis], 1e-2 * turn / cut)
            << turn << " place " << k;
      }
    }
  }
}

TEST(Arc, TurnsCounterClockwiseForPositiveTurns) {
  canon::ArcFeed command{xyz(0, 10, 0), Vec3::Zero(), Vec3::UnitZ(), 1, canon::Plane::xy};
  const Arc quarter = *make_arc(xyz(10, 0, 0), command);
  EXPECT_NEAR(quarter.length, 5 * std::numbers::pi, 1e-12);
  EXPECT_NEAR(evaluate(quarter, quarter.length / 2).p[Axis::x], 10 / std::sqrt(2), 1e-12);
  command.turns = -1;
  EXPECT_NEAR(make_arc(xyz(10, 0, 0), command)->length, 15 * std::numbers::pi, 1e-12);
  command.turns = 3;
  EXPECT_NEAR(make_arc(xyz(10, 0, 0), command)->length, 45 * std::numbers::pi, 1e-12);
}

TEST(Arc, GoesFullyRoundWhenItEndsWhereItStarted) {
  const canon::ArcFeed command{xyz(10, 0, 3), Vec3::Zero(), Vec3::UnitZ(), -1, canon::Plane::xy};
  const Arc helix = *make_arc(xyz(10, 0, 0), command);
  EXPECT_NEAR(helix.angle, -2 * std::numbers::pi, 1e-12);
  EXPECT_NEAR(helix.length, std::hypot(20 * std::numbers::pi, 3), 1e-10);
}

TEST(Arc, MeasuresASpiralAsSamplingDoes) {
  const canon::ArcFeed command{xyz(-7, 0, 2), Vec3::Zero(), Vec3::UnitZ(), 2, canon::Plane::xy};
  const Arc spiral = *make_arc(xyz(10, 0, 0), command);
  double sum = 0;
  AxisValues last = spiral.start;
  constexpr int n = 200000;
  for (int k = 1; k <= n; ++k) {
    const AxisValues p = evaluate(spiral, spiral.length * k / n).p;
    sum += metric_length(Metric::xyz, p - last);
    last = p;
  }
  EXPECT_NEAR(spiral.length, sum, 1e-7);
}

TEST(Arc, OfZeroRadiusIsAnError) {
  const canon::ArcFeed command{xyz(1, 0, 0), Vec3::Zero(), Vec3::UnitZ(), 1, canon::Plane::xy};
  const auto arc = make_arc(xyz(0, 0, 0), command);
  ASSERT_FALSE(arc);
  EXPECT_EQ(arc.error().kind, "arc_error");
}

TEST(FeedLength, CountsXyzThenUvwThenAbc) {
  const AxisValues zero;
  using test::at;
  EXPECT_EQ(make_line(zero, at({{Axis::x, 3}, {Axis::y, 4}, {Axis::u, 9}, {Axis::c, 7}})).length,
            5);
  EXPECT_EQ(make_line(zero, at({{Axis::u, 3}, {Axis::w, 4}, {Axis::c, 7}})).length, 5);
  EXPECT_EQ(make_line(zero, at({{Axis::a, 3}, {Axis::c, 4}})).length, 5);
  // A hair of X must not make a huge feed of a large turn.
  EXPECT_EQ(make_line(zero, at({{Axis::x, 5e-9}, {Axis::c, 2}})).length, 2);
  EXPECT_EQ(make_line(zero, zero).length, 0);
}

}  // namespace
}  // namespace aircut::plan
