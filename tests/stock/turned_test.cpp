// Turning against closed forms: tapers, faces, bores, grooves, fillets. The bar has a radius of 20
// and is 60 mm long.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "stock/stock.h"

namespace aircut::stock {
namespace {

constexpr double pi = std::numbers::pi, h = 0.05;

// Outside turning: the tip at (0, 0), the body away from the axis.
const TurningSection pointed{{{0, 0, 0}, {15, 0, 0}, {15, 5, 0}}};
const TurningSection facing{{{0, 0, 0}, {15, 0, 0}, {15, 10, 0}, {0, 10, 0}}};
const TurningSection boring{{{0, 0, 0}, {-5, 0, 0}, {-5, 50, 0}, {0, 50, 0}}};
const TurningSection grooving{{{0, 0, 0}, {0, 3, 0}, {15, 3, 0}, {15, 0, 0}}};
// A nose of 0.8 whose left and lower sides touch (0, 0).
const TurningSection rounded{{{0.8, 0.8, 0.8}, {15, 0, 0}, {15, 15, 0}, {0.8, 15, 0}}};

TurnedStock bar(double bore = 0) { return *TurnedStock::make(20, bore, 60, h); }

bool closed(const TriangleMesh& mesh) {
  const TriangleMesh one = welded(mesh);
  const auto parts = shells(one);
  return !parts.empty() &&
         std::all_of(parts.begin(), parts.end(), [](const Shell& shell) { return shell.closed; });
}

TEST(TurnedStock, IsABarOrATubeAtFirst) {
  EXPECT_NEAR(bar().volume(), pi * 400 * 60, 1e-3);
  EXPECT_NEAR(bar(9).volume(), pi * (400 - 81) * 60, 1e-3);
  for (const double bore : {0.0, 9.0}) {
    const TriangleMesh mesh = bar(bore).mesh(0.001);
    EXPECT_TRUE(closed(mesh));
    EXPECT_NEAR(volume(mesh), pi * (400 - bore * bore) * 60, 30);  // facets lie inside
    EXPECT_NEAR(bounds(mesh).max().z(), 60, 1e-6);
  }
}

TEST(TurnedStock, TurnsATaperOfItsExactVolume) {
  TurnedStock stock = bar();
  // From radius 10 at the free end to 20 at the chuck.
  const double taken = stock.cut({&pointed, 10 - 1, 66, 20 + 1, -6});
  const double frustum = pi * 60 / 3 * (100 + 200 + 400);
  EXPECT_NEAR(stock.volume(), frustum, 1e-5 * frustum);
  EXPECT_NEAR(taken, pi * 400 * 60 - frustum, 0.1);
  EXPECT_NEAR(stock.radii_at(30)[0].second, 15, h / 6);  // at the nearest ray
  const TriangleMesh mesh = stock.mesh(0.001);
  EXPECT_TRUE(closed(mesh));
  EXPECT_NEAR(volume(mesh), frustum, 1e-4 * frustum + 30);
}

TEST(TurnedStock, FacesBeyondTheAxis) {
  TurnedStock stock = bar();
  stock.cut({&facing, 25, 58, -0.5, 58});
  for (const double r : {0.01, 7.0, 19.9}) {
    const auto heights = stock.heights_at(r);
    ASSERT_EQ(heights.size(), 1u) << r;
    EXPECT_NEAR(heights[0].second, 58, 1e-6);
  }
  EXPECT_NEAR(volume(stock.mesh(0.001)), pi * 400 * 58, 30);
}

TEST(TurnedStock, LeavesAPipWhenATurningToolStopsShortOfTheAxis) {
  TurnedStock stock = bar();
  stock.cut({&facing, 25, 58, 0.5, 58});
  EXPECT_NEAR(stock.heights_at(0.3)[0].second, 60, 1e-6);
  EXPECT_NEAR(stock.volume(), pi * (400 * 58 + 0.25 * 2), 0.1);
}

TEST(TurnedStock, BoresAndGrooves) {
  TurnedStock tube = bar(9);
  tube.cut({&boring, 12, 70, 12, 20});
  EXPECT_NEAR(tube.volume(), pi * (400 - 81) * 60 - pi * (144 - 81) * 40, 0.5);
  TurnedStock stock = bar();
  EXPECT_NEAR(stock.cut({&grooving, 22, 30, 15, 30}), pi * (400 - 225) * 3, 1e-3);
  EXPECT_EQ(stock.radii_at(31)[0].second, 15);
  EXPECT_TRUE(closed(stock.mesh(0.001)));
}

TEST(TurnedStock, LeavesTheFilletOfTheNose) {
  TurnedStock stock = bar();
  // Along the bar to a shoulder at z = 20, radius 18.
  const double taken = stock.cut({&rounded, 18, 70, 18, 20});
  // A ring of 2 x 40 less a corner of (1 − π/4) r², whose middle is (5/6 − π/4)/(1 − π/4) r away
  // from the sides that the nose does not reach (Pappus).
  const double r = 0.8, corner = (1 - pi / 4) * r * r;
  const double middle = r - (5.0 / 6 - pi / 4) / (1 - pi / 4) * r;
  const double exact = pi * (400 - 324) * 40 - 2 * pi * (18 + (r - middle)) * corner;
  EXPECT_NEAR(taken, exact,
              0.15);  // where the fillet meets the shoulder it is steeper than its rays
}

TEST(TurnedStock, IsTheSameInAnyOrderAndCutTwice) {
  const std::vector<TurningMove> moves = {{&pointed, 9, 66, 21, -6},
                                          {&facing, 25, 55.03, -1, 55.03},
                                          {&grooving, 22, 30, 11.1, 30},
                                          {&rounded, 17, 70, 17, 33.3}};
  TurnedStock forward = bar(), back = bar();
  double taken = 0;
  for (const TurningMove& move : moves) taken += forward.cut(move);
  for (auto move = moves.rbegin(); move != moves.rend(); ++move) back.cut(*move);
  EXPECT_EQ(forward.hash(), back.hash());
  EXPECT_NEAR(bar().volume() - forward.volume(), taken, 1e-6);
  for (const TurningMove& move : moves) EXPECT_EQ(forward.cut(move), 0);
  EXPECT_EQ(forward.hash(), back.hash());
}

TEST(TurnedStock, AsksWithoutCutting) {
  const TurnedStock stock = bar();
  const TurningTouch deep = stock.touch({&grooving, 22, 30, 15, 30});
  EXPECT_NEAR(deep.depth, 5, 1e-6);
  EXPECT_NEAR(deep.volume, pi * (400 - 225) * 3, 2);
  EXPECT_NEAR(deep.r, 17.5, 1e-6);
  EXPECT_EQ(stock.touch({&grooving, 25, 30, 20, 30}).depth, 0);
  EXPECT_GT(stock.touch({&grooving, 25, 30, 19.99, 30}).depth, 0);
}

TEST(TurnedStock, FollowsACoarserLatticeLessExactly) {
  const double frustum = pi * 60 / 3 * (100 + 200 + 400);
  double last = 1e9;
  for (const double pitch : {0.8, 0.4, 0.2}) {
    TurnedStock stock = *TurnedStock::make(20, 0, 60, pitch);
    stock.cut({&pointed, 9, 66, 21, -6});
    const double error = std::abs(stock.volume() - frustum);
    EXPECT_LT(error, last / 1.8);
    last = error;
  }
}

TEST(TurnedStock, SavedStockIsReadAsTheSameAndCutsOnAlike) {
  TurnedStock stock = bar(9);
  stock.cut({&rounded, 15, 66, 15, 20});
  stock.cut({&grooving, 12, 30, 30, 30});
  const std::string bytes = stock.save();
  auto again = TurnedStock::load(bytes, "bar.stock");
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->save(), bytes);
  EXPECT_EQ(again->hash(), stock.hash());
  EXPECT_EQ(again->radius(), 20);
  EXPECT_EQ(again->length(), 60);
  EXPECT_EQ(stock.cut({&boring, 10, 20, 10, 10}), again->cut({&boring, 10, 20, 10, 10}));
  EXPECT_EQ(again->hash(), stock.hash());
  EXPECT_EQ(again->volume(), stock.volume());
}

TEST(TurnedStock, SpoiltFilesAndMilledStocksAreRefused) {
  const std::string good = bar().save();
  constexpr std::size_t heading = 22, pitch = 8;
  const auto refused = [](std::string bytes, const char* why, bool mend = false) {
    if (mend) bytes.replace(bytes.size() - 64, 64, sha256(bytes.substr(0, bytes.size() - 64)));
    const auto stock = TurnedStock::load(bytes, "a.stock");
    ASSERT_FALSE(stock) << why;
    EXPECT_EQ(stock.error().kind, "stock_file");
    EXPECT_NE(stock.error().message.find(why), std::string::npos) << stock.error().message;
  };
  refused("", "does not begin with 'aircut turned stock 1'");
  refused(good.substr(0, 50), "too early");
  refused(good.substr(0, good.size() - 1), "check sum");
  std::string changed = good;
  changed[100] = static_cast<char>(changed[100] ^ 1);
  refused(changed, "check sum");
  refused(good.substr(0, good.size() - 80) + good.substr(good.size() - 64), "too early", true);
  refused(good.substr(0, good.size() - 64) + "more" + good.substr(good.size() - 64), "goes on",
          true);
  changed = good;
  changed.replace(heading, pitch, pitch, '\0');
  refused(changed, "pitch must be", true);
  changed = good;
  changed[heading + 3 * 8 + 4 + 15] = 1;  // the high byte of where the first ray ends
  refused(changed, "outside of the bar (at byte", true);
  const auto milled = Stock::make(Box{Vec3::Zero(), Vec3::Constant(10)}, 1);
  ASSERT_TRUE(milled);
  refused(milled->save(), "whose spindle turns the tool");
  const auto turned = Stock::load(good, "a.stock");
  ASSERT_FALSE(turned);
  EXPECT_EQ(turned.error().kind, "stock_file");
  EXPECT_NE(turned.error().message.find("whose spindle turns the work"), std::string::npos);
}

TEST(TurnedStock, RefusesWhatIsNoBar) {
  EXPECT_EQ(TurnedStock::make(20, 20, 60, h).error().kind, "stock_shape");
  EXPECT_EQ(TurnedStock::make(20, 0, 60, 100).error().kind, "stock_shape");
  EXPECT_EQ(TurnedStock::make(2000, 0, 60000, 1e-4).error().kind, "stock_memory");
}

}  // namespace
}  // namespace aircut::stock
