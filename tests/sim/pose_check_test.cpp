// Positions without a motion: what touches, and workspaces free of collision.
#include "sim/pose_check.h"

#include "machine/workspace/workspace.h"
#include "support/box_machine.h"

namespace aircut::sim {
namespace {

using testing::BoxMachine;

// The post is 10 x 10 x 20 above the tip; the plate is from X 50 to 50.02, Y ±50, Z 0 to 50.
bool is_free(double x, double y, double z) {
  const bool apart = x + 5 < 50 || x - 5 > 50.02 || std::abs(y) > 55 || z > 50 || z + 20 < 0;
  return apart;
}

TEST(PoseCheck, SaysWhichPositionsAreFree) {
  BoxMachine box;
  const PoseCheck check(Scene(box.machine(), {}), box.machine()->home());
  EXPECT_EQ(check.pairs(), 1u);
  EXPECT_TRUE(check.left_out().empty());
  JointVector q(3);
  for (double x = 30.5; x < 70; x += 3)
    for (double y = -70.5; y < 70; y += 20)
      for (double z = -30.5; z < 60; z += 10) {
        q << x, y, z;
        EXPECT_EQ(check.is_free(q), is_free(x, y, z)) << x << " " << y << " " << z;
      }
}

TEST(PoseCheck, LeavesOutWhatTouchesAtHomeAndNamesIt) {
  BoxMachine box;
  JointVector inside(3);
  inside << 50, 0, 10;
  const PoseCheck check(Scene(box.machine(), {}), inside);
  EXPECT_EQ(check.pairs(), 0u);
  EXPECT_EQ(check.left_out(), std::vector<std::string>{"post – plate"});
  EXPECT_TRUE(check.is_free(inside));
}

TEST(PoseCheck, MakesTheSameWorkspaceWithAnyNumberOfThreads) {
  BoxMachine box;
  const PoseCheck check(Scene(box.machine(), {}), box.machine()->home());
  machine::WorkspaceQuery query;
  query.low = Vec3(-230, -60, -35);
  query.high = Vec3(230, 60, 65);
  query.pitch = 5;
  query.is_free = [&](const JointVector& q) { return check.is_free(q); };
  std::optional<machine::Workspace> first;
  for (const int threads : {1, 2, 3, 7}) {
    query.threads = threads;
    const auto w = machine::Workspace::of(*box.machine(), query);
    ASSERT_TRUE(w);
    if (!first) first = w;
    EXPECT_EQ(w->failures(), first->failures()) << threads;
    long differ = 0;
    for (int k = 0; k < w->count()[2]; ++k)
      for (int j = 0; j < w->count()[1]; ++j)
        for (int i = 0; i < w->count()[0]; ++i) differ += w->in(i, j, k) != first->in(i, j, k);
    EXPECT_EQ(differ, 0) << threads;
  }
  // Beyond the travel of X, no solution, in the way.
  long beyond = 0, blocked = 0;
  for (int k = 0; k < first->count()[2]; ++k)
    for (int j = 0; j < first->count()[1]; ++j)
      for (int i = 0; i < first->count()[0]; ++i) {
        const Vec3 p = first->place(i, j, k);
        const bool out = std::abs(p.x()) > 200, in_the_way = !is_free(p.x(), p.y(), p.z());
        beyond += out;
        blocked += !out && in_the_way;
        EXPECT_EQ(first->in(i, j, k), !out && !in_the_way);
      }
  EXPECT_GT(blocked, 0);
  EXPECT_EQ(first->failures(), (std::vector<long>{beyond, 0, 0, 0, blocked}));
}

}  // namespace
}  // namespace aircut::sim
