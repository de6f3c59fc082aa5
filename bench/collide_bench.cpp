// Cost of pair checks: single queries at several gaps, and proofs over many short steps.
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>

#include "collide/collide.h"

namespace aircut::collide {
namespace {

/// A ball of about 2·n² triangles.
TriangleMesh ball(double radius, int n) {
  Profile arc;
  for (int i = 0; i <= n; ++i) {
    const double angle = std::numbers::pi * (static_cast<double>(i) / n - 0.5);
    arc.push_back({i == 0 || i == n ? 0.0 : radius * std::cos(angle), radius * std::sin(angle)});
  }
  const double half = std::numbers::pi / (2 * n);
  return revolve(arc, radius * (1 / std::cos(half) - 1));
}

void report_triangles(benchmark::State& state, const TriangleMesh& mesh) {
  state.counters["triangles"] = static_cast<double>(mesh.triangles.size());
}

void distance_at_gap(benchmark::State& state) {
  const TriangleMesh mesh = ball(50, static_cast<int>(state.range(0)));
  const CollisionMesh a(mesh), b(mesh);
  const double gap = static_cast<double>(state.range(1)) / 1000;
  Pose X_WB = translation(Vec3(1, 2, 2).normalized() * (100 + gap));
  X_WB.rotate(Eigen::AngleAxisd(0.4, Vec3(1, -2, 0.5).normalized()));
  for (auto _ : state) benchmark::DoNotOptimize(distance(a, Pose::Identity(), b, X_WB, 1e9));
  report_triangles(state, mesh);
}
BENCHMARK(distance_at_gap)
    ->ArgNames({"rings", "gap_um"})
    ->ArgsProduct({{50, 150}, {100, 5000, 100000}});

void bounded_distance(benchmark::State& state) {
  const TriangleMesh mesh = ball(50, static_cast<int>(state.range(0)));
  const CollisionMesh a(mesh), b(mesh);
  const Pose X_WB = translation(Vec3(1, 2, 2).normalized() * 110);
  for (auto _ : state) benchmark::DoNotOptimize(distance(a, Pose::Identity(), b, X_WB, 5));
  report_triangles(state, mesh);
}
BENCHMARK(bounded_distance)->ArgName("rings")->Arg(50)->Arg(150);

void overlap_of_balls(benchmark::State& state) {
  const TriangleMesh mesh = ball(50, 50);
  const CollisionMesh a(mesh), b(mesh);
  const Pose X_WB = translation({static_cast<double>(state.range(0)), 0, 0});
  for (auto _ : state) benchmark::DoNotOptimize(overlap(a, Pose::Identity(), b, X_WB));
}
BENCHMARK(overlap_of_balls)->ArgName("offset_mm")->Arg(30)->Arg(99)->Arg(120);

/// Straight motion of B along X at 100 mm/s from `start`.
RelativeMotion straight(const Vec3& start) {
  return {.X_AB = [start](double t) -> std::optional<Pose> {
            return translation(start + 100 * t * Vec3::UnitX());
          },
          .travel = [](double ta, double tb) -> std::optional<double> { return 100 * (tb - ta); }};
}

/// Steps of 0.1 mm past a body at a gap.
void short_steps(benchmark::State& state) {
  const TriangleMesh mesh = ball(50, 50);
  const CollisionMesh a(mesh), b(mesh);
  const double gap = static_cast<double>(state.range(0)) / 1000;
  const RelativeMotion motion = straight({-100, 100 + gap, 0});
  Budget budget;
  ProofCost cost;
  double t = 0;
  for (auto _ : state) {
    if (t > 2) {
      t = 0;
      budget = {};
    }
    benchmark::DoNotOptimize(prove(a, b, motion, t, t + 0.001, {.margin = 2}, budget, cost));
    t += 0.001;
  }
  state.counters["queries/step"] =
      static_cast<double>(cost.distance_queries) / static_cast<double>(state.iterations());
}
BENCHMARK(short_steps)->ArgName("gap_um")->Arg(500)->Arg(2500)->Arg(10000)->Arg(100000);

/// One long rapid that ends in a collision.
void rapid_into_a_body(benchmark::State& state) {
  const TriangleMesh mesh = ball(50, 50);
  const CollisionMesh a(mesh), b(mesh);
  const RelativeMotion motion = straight({-500, 3, 4});
  for (auto _ : state) {
    Budget budget;
    ProofCost cost;
    benchmark::DoNotOptimize(prove(a, b, motion, 0, 10, {.margin = 2}, budget, cost));
  }
}
BENCHMARK(rapid_into_a_body);

/// 40 bodies in a row of pairs at various gaps, all moving in short steps: poses per second.
void poses_of_forty_bodies(benchmark::State& state) {
  const TriangleMesh mesh = ball(50, 50);
  const CollisionMesh shape(mesh);
  constexpr int bodies = 40;
  std::vector<RelativeMotion> motions;
  for (int i = 0; i < bodies; ++i)
    for (int k = i + 1; k < bodies; ++k)
      motions.push_back(straight({-100.0, 110.0 * (k - i), 15.0 * (i % 5)}));
  std::vector<Budget> budgets(motions.size());
  ProofCost cost;
  double t = 0;
  for (auto _ : state) {
    if (t > 2) {
      t = 0;
      budgets.assign(motions.size(), {});
    }
    for (std::size_t i = 0; i < motions.size(); ++i)
      benchmark::DoNotOptimize(
          prove(shape, shape, motions[i], t, t + 0.001, {.margin = 2}, budgets[i], cost));
    t += 0.001;
  }
  state.counters["poses/s"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
  state.counters["pairs/s"] = benchmark::Counter(
      static_cast<double>(state.iterations()) * static_cast<double>(motions.size()),
      benchmark::Counter::kIsRate);
}
BENCHMARK(poses_of_forty_bodies);

}  // namespace
}  // namespace aircut::collide
