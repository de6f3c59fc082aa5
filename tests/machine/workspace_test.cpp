// Workspaces: what is read from a grid against brute force, and the published areas and boxes.
#include <gtest/gtest.h>

#include <numbers>

#include "base/random.h"
#include "machine/workspace/workspace_files.h"

namespace aircut::machine {
namespace {

constexpr double deg = std::numbers::pi / 180;

std::shared_ptr<const Machine> package(const std::string& name) {
  static SourceMap sources;
  Diagnostics out;
  const auto machine =
      read_machine(std::string(AIRCUT_SOURCE_DIR) + "/machines/" + name, sources, out);
  EXPECT_TRUE(machine) << name;
  return machine ? *machine : nullptr;
}

// Every box, point by point.
long largest_by_force(const Workspace& w) {
  const auto [nx, ny, nz] = w.count();
  long most = 0;
  const auto full = [&](int x0, int x1, int y0, int y1, int z0, int z1) {
    for (int z = z0; z <= z1; ++z)
      for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x)
          if (!w.in(x, y, z)) return false;
    return true;
  };
  for (int x0 = 0; x0 < nx; ++x0)
    for (int x1 = x0; x1 < nx; ++x1)
      for (int y0 = 0; y0 < ny; ++y0)
        for (int y1 = y0; y1 < ny; ++y1)
          for (int z0 = 0; z0 < nz; ++z0)
            for (int z1 = z0; z1 < nz; ++z1)
              if (full(x0, x1, y0, y1, z0, z1))
                most =
                    std::max(most, static_cast<long>(x1 - x0 + 1) * (y1 - y0 + 1) * (z1 - z0 + 1));
  return most;
}

TEST(Workspace, FindsTheLargestBoxThatBruteForceFinds) {
  Random random(91);
  for (int round = 0; round < 60; ++round) {
    const std::array<int, 3> count = {static_cast<int>(1 + random.next() % 6),
                                      static_cast<int>(1 + random.next() % 6),
                                      static_cast<int>(1 + random.next() % 5)};
    const double share = random.between(0.3, 0.98);
    const Workspace w =
        Workspace::by(count, [&](int, int, int) { return random.between(0, 1) < share; });
    const GridBox box = w.largest_box();
    EXPECT_EQ(box.points(), largest_by_force(w));
    for (int k = box.first[2]; k <= box.last[2]; ++k)
      for (int j = box.first[1]; j <= box.last[1]; ++j)
        for (int i = box.first[0]; i <= box.last[0]; ++i) ASSERT_TRUE(w.in(i, j, k));
  }
}

TEST(Workspace, KeepsWhatIsConnectedWithAPoint) {
  // Two halves with an empty plane between them.
  Workspace w = Workspace::by({5, 4, 3}, [](int i, int, int) { return i != 2; });
  EXPECT_EQ(w.reached(), 48);
  EXPECT_FALSE(w.keep_connected(Vec3(2, 0, 0)));
  EXPECT_TRUE(w.keep_connected(Vec3(0, 0, 0)));
  EXPECT_EQ(w.reached(), 24);
  EXPECT_EQ(w.extent().last, (std::array<int, 3>{1, 3, 2}));
}

WorkspaceQuery slice() {
  WorkspaceQuery query;
  query.low = Vec3(0, 0, -380);
  query.high = Vec3(600, 0, -74);
  query.pitch = 1;
  return query;
}

TEST(Workspace, OfTheGlideHasThePublishedAreasAndRectangles) {
  const auto crossed = Workspace::of(*package("ox-glide-crossed"), slice());
  ASSERT_TRUE(crossed);
  EXPECT_NEAR(static_cast<double>(crossed->reached()), 27730, 60);
  EXPECT_NEAR(static_cast<double>(crossed->largest_box().points()), 12150, 150);
  const GridBox extent = crossed->extent();
  EXPECT_NEAR(crossed->place(extent.first[0], 0, 0).x(), 0, 1.5);
  EXPECT_NEAR(crossed->place(extent.last[0], 0, 0).x(), 450, 1.5);
  EXPECT_NEAR(crossed->place(0, 0, extent.first[2]).z(), -358, 1.5);
  EXPECT_NEAR(crossed->place(0, 0, extent.last[2]).z(), -191.5, 1.5);
  const auto extended = Workspace::of(*package("ox-glide-extended"), slice());
  ASSERT_TRUE(extended);
  EXPECT_NEAR(static_cast<double>(extended->reached()), 4590, 30);
  EXPECT_NEAR(static_cast<double>(extended->largest_box().points()), 2100, 100);
}

TEST(Workspace, OfTheHorizontalRobotHasThePublishedNodes) {
  const auto robot = package("lola50-horizontal");
  ASSERT_TRUE(robot);
  WorkspaceQuery query;
  query.low = Vec3(-1000, -400, -2100);
  query.high = Vec3(1000, 900, -600);
  query.pitch = 100;
  query.nodes = true;
  const auto three = Workspace::of(*robot, query);
  ASSERT_TRUE(three);
  EXPECT_EQ(three->points(), 4704);
  EXPECT_NEAR(static_cast<double>(three->reached()), 3158, 5);
  const GridBox box = three->largest_box();
  EXPECT_EQ(three->place(box.first[0], box.first[1], box.first[2]), Vec3(-900, -400, -1600));
  EXPECT_EQ(three->place(box.last[0], box.last[1], box.last[2]), Vec3(900, 500, -1200));
  for (const double a : {-25.0, 0.0, 25.0})
    for (const double b : {-25.0, 0.0, 25.0}) {
      AxisValues tilt;
      tilt[Axis::a] = a * deg;
      tilt[Axis::b] = b * deg;
      query.tilts.push_back(tilt);
    }
  const auto five = Workspace::of(*robot, query);
  ASSERT_TRUE(five);
  EXPECT_NEAR(static_cast<double>(five->reached()), 1381, 5);
  const GridBox inner = five->largest_box();
  EXPECT_EQ(five->place(inner.first[0], inner.first[1], inner.first[2]), Vec3(-500, -400, -1600));
  EXPECT_EQ(five->place(inner.last[0], inner.last[1], inner.last[2]), Vec3(500, 300, -1400));
}

TEST(Workspace, TiltsOfABoxHaveItsCornersAndStepsOfAtMost5Degrees) {
  const auto tilts = tilts_of_box(-25 * deg, 25 * deg, 0, 12 * deg);
  EXPECT_EQ(tilts.size(), 11u * 4u);
  EXPECT_NEAR(tilts.front()[Axis::a], -25 * deg, 1e-15);
  EXPECT_NEAR(tilts.back()[Axis::b], 12 * deg, 1e-15);
  EXPECT_EQ(tilts_of_box(0, 0, 0, 0).size(), 1u);
}

TEST(Workspace, RefusesAGridThatIsTooFine) {
  WorkspaceQuery query = slice();
  query.pitch = 0.01;
  query.high.y() = 500;
  EXPECT_FALSE(Workspace::of(*package("mill3"), query));
}

// An L of three cells.
Workspace small_l() {
  return Workspace::by({2, 2, 1}, [](int i, int j, int) { return i == 0 || j == 0; });
}

TEST(WorkspaceFiles, HaveEveryPointXFastest) {
  EXPECT_EQ(workspace_csv(small_l()),
            "x_mm,y_mm,z_mm,reached\n0,0,0,1\n1,0,0,1\n0,1,0,1\n1,1,0,0\n");
  const std::string npy = workspace_npy(small_l());
  EXPECT_EQ(npy.substr(0, 6), "\x93NUMPY");
  EXPECT_NE(npy.find("'shape': (1, 2, 2)"), npy.npos);
  EXPECT_EQ((npy.size() - 4) % 64, 0u);
  EXPECT_EQ(npy.substr(npy.size() - 4), std::string("\1\1\1\0", 4));
}

TEST(WorkspaceFiles, SolidIsClosedAndHasTheVolumeOfItsCells) {
  const TriangleMesh solid = welded(workspace_solid(small_l()));
  EXPECT_NEAR(volume(solid), 3, 1e-12);
  for (const Shell& shell : shells(solid)) EXPECT_TRUE(shell.closed);
}

}  // namespace
}  // namespace aircut::machine
