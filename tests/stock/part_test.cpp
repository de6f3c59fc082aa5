// A stock against the part that it is to become. Closed forms: boxes, a slotted block.
#include <gtest/gtest.h>

#include <random>

#include "stock/stock.h"
#include "support/slot_part.h"

namespace aircut::stock {
namespace {

constexpr double h = 0.5;

// 40 x 30 x 20 mm about X0 Y0; the part has a slot 10 mm wide and 5 mm deep.
struct Job {
  std::shared_ptr<const TriangleMesh> mesh =
      std::make_shared<TriangleMesh>(testing::slotted_block(Vec3(40, 30, 20), 10, 5));
  Part part = *Part::make(mesh, h);
  Stock stock = *Stock::make(Box{Vec3(-20, -15, 0), Vec3(20, 15, 20)}, h);
  CutterProfile cutter = *CutterProfile::flat(10, 20);

  Piece slot(double floor, double y = 0) const {
    return {&cutter, Vec3(-30, y, floor), Vec3(30, y, floor), Vec3::UnitZ(), 0};
  }
  Deviation cut_to(double floor, const PartTolerances& tolerances = {}) {
    const Piece piece = slot(floor);
    EXPECT_TRUE(stock.cut({&piece, 1}));
    return part.compare(stock, tolerances);
  }
};

TEST(Part, MeasuresDistancesAsTheClosedFormOfABox) {
  const Vec3 low(-3, -4, -5), high(6, 5, 4);
  const Part part = *Part::make(std::make_shared<TriangleMesh>(make_box(low, high)), 1);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> in(-12, 12);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p(in(random), in(random), in(random));
    const Vec3 beyond = (low - p).cwiseMax(p - high);
    const double expected = beyond.maxCoeff() > 0 ? beyond.cwiseMax(0).norm() : beyond.maxCoeff();
    EXPECT_NEAR(part.outside(p), expected, 1e-9);
  }
}

TEST(Part, FindsNothingWrongWithWhatIsAsDesigned) {
  Job job;
  const Deviation d = job.cut_to(15);
  EXPECT_LT(d.gouge, 1e-4);
  EXPECT_LT(d.excess, 1e-4);
  EXPECT_TRUE(d.gouges.empty());
  EXPECT_TRUE(d.excesses.empty());
  EXPECT_GT(d.points, 5'000u);
}

TEST(Part, FindsASlotThatIsTooDeepWithItsDepthAndPlace) {
  Job job;
  const Deviation d = job.cut_to(14.8);
  EXPECT_NEAR(d.gouge, 0.2, 1e-4);
  ASSERT_EQ(d.gouges.size(), 1u);
  EXPECT_NEAR(d.gouges[0].depth, 0.2, 1e-4);
  EXPECT_NEAR(d.gouges[0].point.z(), 14.8, 1e-4);
  EXPECT_LE(std::abs(d.gouges[0].point.y()), 5 + 1e-4);
  EXPECT_TRUE(d.excesses.empty());
}

TEST(Part, KeepsToItsTolerances) {
  EXPECT_TRUE(Job().cut_to(14.981).gouges.empty());
  EXPECT_EQ(Job().cut_to(14.979).gouges.size(), 1u);
  EXPECT_TRUE(Job().cut_to(15.049).excesses.empty());
  EXPECT_EQ(Job().cut_to(15.051).excesses.size(), 1u);
  EXPECT_TRUE(Job().cut_to(15.1, {.allowance = 0.1}).excesses.empty());
  EXPECT_EQ(Job().cut_to(15.2, {.allowance = 0.1}).excesses.size(), 1u);
}

TEST(Part, TellsPlacesApartAndLeavesWhatShallStay) {
  Job job;
  const CutterProfile drill = *CutterProfile::flat(3, 30);
  std::vector<Piece> holes;
  for (const double x : {-12.0, 12.0})
    holes.push_back({&drill, Vec3(x, 10, 30), Vec3(x, 10, 19), Vec3::UnitZ(), 0});
  ASSERT_TRUE(job.stock.cut(holes));
  const Deviation d = job.cut_to(16, {.leave = {Box3(Vec3(-30, -6, 10), Vec3(30, 6, 25))}});
  EXPECT_EQ(d.gouges.size(), 2u);
  EXPECT_NEAR(d.gouge, 1, 1e-4);
  EXPECT_TRUE(d.excesses.empty());  // a whole millimetre in the slot, which may stay
}

TEST(Part, SeesAPieceGoIntoItOnceForEachDepth) {
  Job job;
  EXPECT_EQ(job.part.cut_into(job.slot(15), 0.02)->depth, 0);
  EXPECT_NEAR(job.part.cut_into(job.slot(14.8), 0.02)->depth, 0.2, 1e-4);
  ASSERT_TRUE(job.part.take(job.slot(14.8), 0.2));
  EXPECT_EQ(job.part.cut_into(job.slot(14.8), 0.02)->depth, 0);
  EXPECT_NEAR(job.part.cut_into(job.slot(14.5), 0.02)->depth, 0.5, 1e-4);
  // Beside the slot: 0.3 mm into a wall is no deeper than 0.3 mm, however long the way along it.
  EXPECT_NEAR(job.part.cut_into(job.slot(15, 0.3), 0.02)->depth, 0.3, 1e-4);
}

TEST(Part, KnowsWhenItDoesNotFitIntoTheRawPiece) {
  const Job job;
  EXPECT_LT(job.part.outside_of(make_box(Vec3(-20, -15, 0), Vec3(20, 15, 20))).depth, 1e-3);
  const Spot out = job.part.outside_of(make_box(Vec3(-20, -15, 0), Vec3(19, 15, 20)));
  EXPECT_NEAR(out.depth, 1, 1e-3);
  EXPECT_NEAR(out.point.x(), 20, 1e-3);
}

}  // namespace
}  // namespace aircut::stock
