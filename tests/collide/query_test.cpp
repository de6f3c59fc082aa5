#include <gtest/gtest.h>

#include "collide/collide.h"
#include "collide/scenes.h"
#include "support/brute_force.h"

namespace aircut::collide {
namespace {

const Pose origin = Pose::Identity();
TriangleMesh cube(double size) {
  return make_box(Vec3::Constant(-size / 2), Vec3::Constant(size / 2));
}

TEST(Distance, OfTwoCubesIsTheirGap) {
  const CollisionMesh a(cube(2));
  const Distance d = distance(a, origin, a, translation({2.5, 0.3, 0}), 100);
  EXPECT_NEAR(d.value, 0.5, 1e-12);
  EXPECT_NEAR(d.on_a.x(), 1, 1e-12);
  EXPECT_NEAR(d.on_b.x(), 1.5, 1e-12);
  EXPECT_FALSE(d.capped);
}

TEST(Distance, StopsAtItsBound) {
  const CollisionMesh a(cube(2));
  const Distance d = distance(a, origin, a, translation({5, 0, 0}), 2);
  EXPECT_TRUE(d.capped);
  EXPECT_EQ(d.value, 2);
}

TEST(Distance, IsZeroForABodyInsideAnother) {
  const CollisionMesh large(cube(10)), small(cube(1));
  EXPECT_EQ(distance(large, origin, small, origin, 100).value, 0);
  EXPECT_EQ(distance(small, origin, large, translation({1, 0, 0}), 100).value, 0);
  EXPECT_TRUE(overlap(large, origin, small, origin));
  EXPECT_TRUE(overlap(small, origin, large, origin));
}

TEST(Distance, OfABodyInACavityIsItsGap) {
  TriangleMesh hollow = cube(10);
  TriangleMesh cavity = cube(8);
  for (auto& t : cavity.triangles) std::swap(t[1], t[2]);
  append(hollow, cavity);
  const CollisionMesh outer(hollow), inner(cube(1));
  EXPECT_TRUE(outer.all_closed());
  EXPECT_NEAR(distance(outer, origin, inner, origin, 100).value, 3.5, 1e-12);
  EXPECT_FALSE(overlap(outer, origin, inner, origin));
}

TEST(Distance, SeesABodyWhereShellsOfTheOtherOverlap) {
  TriangleMesh cross = make_box({-10, -3, -3}, {10, 3, 3});
  append(cross, make_box({-3.5, -10, -3.5}, {3.5, 10, 3.5}));
  const CollisionMesh outer(cross), inner(cube(1));
  EXPECT_TRUE(overlap(outer, origin, inner, origin));
  EXPECT_TRUE(overlap(outer, origin, inner, translation({8, 0, 0})));
  EXPECT_FALSE(overlap(outer, origin, inner, translation({8, 8, 0})));
}

TEST(Distance, DoesNotCountTheInsideOfAnOpenMesh) {
  TriangleMesh open = cube(10);
  open.triangles.pop_back();
  const CollisionMesh outer(open), inner(cube(1));
  EXPECT_FALSE(outer.all_closed());
  EXPECT_NEAR(distance(outer, origin, inner, origin, 100).value, 4.5, 1e-12);
}

TEST(Distance, OfAMeshWithoutTrianglesIsTheBound) {
  const CollisionMesh nothing{TriangleMesh{}}, something(cube(1));
  EXPECT_TRUE(distance(nothing, origin, something, origin, 7).capped);
  EXPECT_FALSE(overlap(nothing, origin, something, origin));
}

TEST(Distance, IsRightForEdgesThatAreParallelUpToRounding) {
  Random random(7);
  const TriangleMesh bar = make_box({-5, -1, -1}, {5, 1, 1});
  const CollisionMesh mesh(bar);
  for (int i = 0; i < 3000; ++i) {
    const Pose turn = random.turned();
    const Vec3 gap = random.in_box(3);
    const Vec3 shift(gap.x(), 2 + 0.5 * std::abs(gap.y()), gap.z());
    const double got = distance(mesh, turn, mesh, turn * translation(shift), 1e9).value;
    const double wanted = Vec3(std::max(0.0, std::abs(shift.x()) - 10), shift.y() - 2,
                               std::max(0.0, std::abs(shift.z()) - 2))
                              .norm();
    ASSERT_NEAR(got, wanted, 1e-9) << i;
  }
}

TEST(Distance, IsRightForTurnedTrianglesInParallelPlanes) {
  Random random(13);
  const auto triangle = [](const Vec3& at) {
    return TriangleMesh{{at, at + Vec3(4, 0, 0), at + Vec3(0, 3, 0)}, {{0, 1, 2}}};
  };
  for (int i = 0; i < 3000; ++i) {
    const Pose turn = random.turned();
    const double height = random.uniform(0.1, 1);
    const TriangleMesh a = transformed(triangle(Vec3::Zero()), turn);
    // Shifted along an edge by less than its length, so that the faces are over each other.
    const TriangleMesh b =
        transformed(triangle({random.uniform(-1, 1), random.uniform(-0.5, 0.5), height}), turn);
    const CollisionMesh ca(a), cb(b);
    ASSERT_NEAR(distance(ca, origin, cb, origin, 1e9).value, height, 1e-9) << i;
  }
}

TEST(Distance, AgreesWithAllTrianglePairsOnRandomPoses) {
  Random random(11);
  int met = 0;
  for (int i = 0; i < 1500; ++i) {
    const TriangleMesh a = random_body(random), b = random_body(random);
    const Pose X_WA = translation(random.in_box(2)) * random.turned();
    const Pose X_WB = translation(random.in_box(5)) * random.turned();
    const CollisionMesh ca(a), cb(b);
    const bool meets = brute_force::overlap(a, X_WA, b, X_WB);
    const double wanted = meets ? 0 : brute_force::surface_distance(a, X_WA, b, X_WB);
    const Distance got = distance(ca, X_WA, cb, X_WB, 1e9);
    ASSERT_NEAR(got.value, wanted, 1e-7) << i;
    ASSERT_NEAR((got.on_a - got.on_b).norm(), got.value, 1e-9) << i;
    ASSERT_EQ(overlap(ca, X_WA, cb, X_WB), meets) << i;
    met += meets ? 1 : 0;
    const Distance bounded = distance(ca, X_WA, cb, X_WB, 0.5);
    ASSERT_NEAR(bounded.value, std::min(wanted, 0.5), 1e-7) << i;
  }
  EXPECT_GT(met, 100);
  EXPECT_LT(met, 1400);
}

TEST(Judge, PassesOverNothingThatMatters) {
  Random random(12);
  for (int i = 0; i < 200; ++i) {
    const TriangleMesh a = i % 4 == 0 ? bumpy_ball(random, 200) : random_body(random);
    const TriangleMesh b = random_body(random);
    const Pose X_AB = translation(random.in_box(4)) * random.turned();
    const bool meets = brute_force::overlap(a, origin, b, X_AB);
    const double wanted = meets ? 0 : brute_force::surface_distance(a, origin, b, X_AB);
    brute_force::Nearest nearest;
    const double got =
        brute_force::distance(brute_force::Solid(a), brute_force::Solid(b), X_AB, nearest);
    ASSERT_NEAR(got, wanted, 1e-9) << i;
  }
}

TEST(Penetration, OfCubesIsTheOverlapAlongTheShallowAxis) {
  const CollisionMesh a(cube(2));
  const Penetration p = penetration(a, origin, a, translation({1.9, 0.2, 0.1}), {}, 1e-4);
  EXPECT_NEAR(p.depth, 0.1, 2e-4);
  EXPECT_GE(p.depth, 0.1 - 1e-9);
  EXPECT_NEAR(p.direction.x(), -1, 1e-6);
}

TEST(Penetration, IsZeroWithoutOverlap) {
  const CollisionMesh a(cube(2));
  EXPECT_EQ(penetration(a, origin, a, translation({3, 0, 0}), {}, 1e-4).depth, 0);
}

TEST(Penetration, OfAnEnclosedBodyBringsItOut) {
  const CollisionMesh large(cube(10)), small(cube(1));
  const Penetration p = penetration(small, translation({3, 0, 0}), large, origin, {}, 1e-4);
  EXPECT_NEAR(p.depth, 2.5, 2e-4);
  EXPECT_NEAR(p.direction.x(), 1, 1e-6);
}

TEST(Penetration, SeparatesRandomBodies) {
  Random random(5);
  int overlaps = 0;
  for (int i = 0; i < 150; ++i) {
    const TriangleMesh a = random_body(random), b = random_body(random);
    const Pose X_WA = random.turned(), X_WB = translation(random.in_box(2)) * random.turned();
    const CollisionMesh ca(a), cb(b);
    const Penetration p = penetration(ca, X_WA, cb, X_WB, {Vec3::UnitZ()}, 1e-4);
    if (!brute_force::overlap(a, X_WA, b, X_WB)) {
      ASSERT_EQ(p.depth, 0) << i;
      continue;
    }
    ++overlaps;
    ASSERT_GT(p.depth, 0) << i;
    ASSERT_FALSE(brute_force::overlap(a, translation(p.depth * p.direction) * X_WA, b, X_WB)) << i;
    ASSERT_GE(p.depth, brute_force::corner_depth(a, X_WA, b, X_WB) - 1e-6) << i;
  }
  EXPECT_GT(overlaps, 30);
}

}  // namespace
}  // namespace aircut::collide
