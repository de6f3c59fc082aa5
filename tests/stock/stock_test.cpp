#include "stock/stock.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "support/stock_judge.h"

namespace aircut::stock {
namespace {

constexpr double pi = std::numbers::pi;

Stock block(double pitch, const StockOptions& options = {}, Vec3 low = {0, 0, 0},
            Vec3 high = {30, 20, 12}) {
  auto stock = Stock::make(Box{low, high}, pitch, options);
  EXPECT_TRUE(stock) << stock.error().message;
  return std::move(*stock);
}

struct Tool {
  CutterProfile profile;
  test::CutterShape judge;
};

std::vector<Tool> tools() {
  return {{*CutterProfile::flat(6, 20), test::flat_shape(6, 20)},
          {*CutterProfile::ball(5, 20), test::bull_shape(5, 2.5, 20)},
          {*CutterProfile::bull(7, 1.2, 20), test::bull_shape(7, 1.2, 20)},
          {*CutterProfile::cone(1, 8, 3, 20), test::cone_shape(1, 8, 3, 20)},
          {*CutterProfile::flat(8, 2.5), test::flat_shape(8, 2.5)},  // shorter than its cut
          {*CutterProfile::bull(6, 2, 3), test::bull_shape(6, 2, 3)}};
}

struct Job {
  std::vector<Tool> tools;
  std::vector<Piece> pieces;
  std::vector<test::JudgedMove> judged;

  void add(const Tool& tool, const Vec3& from, const Vec3& to, const Vec3& axis = Vec3::UnitZ()) {
    Piece piece{.cutter = &tool.profile, .start = from, .end = to, .axis = axis};
    piece.move = static_cast<std::uint32_t>(pieces.size());
    pieces.push_back(piece);
    judged.push_back({tool.judge, from, to, axis});
  }
};

/// Level moves, ramps of all slopes, plunges, moves that stand still.
Job random_job(std::vector<Tool> with, int moves, unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  Job job;
  job.tools = std::move(with);
  for (int i = 0; i < moves; ++i) {
    const Vec3 from(uniform(-4, 34), uniform(-4, 24), uniform(3, 13));
    const double reach = std::pow(10, uniform(-2, 1.2));
    Vec3 to = from + Vec3(uniform(-reach, reach), uniform(-reach, reach), uniform(-3, 3));
    to.z() = std::max(to.z(), 1.0);
    switch (i % 7) {
      case 0:
        to.z() = from.z();
        break;
      case 1:
        to = {from.x(), from.y(), to.z()};
        break;
      case 2:
        to.y() = from.y();
        break;
      case 3:
        to = {from.x(), to.y(), from.z()};
        break;
      case 4:
        to.z() = from.z() + 1e-3 * (to.z() - from.z());
        break;
      default:
        break;
    }
    job.add(job.tools[static_cast<std::size_t>(i) % job.tools.size()], from,
            i % 29 == 28 ? from : to);
  }
  return job;
}

/// Tool axes of all kinds: a little off Z, level, along X or Y, upside down.
Job tilted_job(std::vector<Tool> with, int moves, unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  Job job;
  job.tools = std::move(with);
  for (int i = 0; i < moves; ++i) {
    Vec3 axis(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
    if (i % 5 == 0) axis = {uniform(-1e-3, 1e-3), uniform(-1e-3, 1e-3), 1};
    if (i % 5 == 1) axis = Vec3::Unit(i / 5 % 2) * (i % 2 ? 1 : -1);
    if (i % 5 == 2) axis.z() = 0;
    const Vec3 from(uniform(0, 30), uniform(0, 20), uniform(2, 14));
    const double reach = std::pow(10, uniform(-2, 1));
    Vec3 travel(uniform(-reach, reach), uniform(-reach, reach), uniform(-reach, reach));
    axis.normalize();
    if (i % 4 == 1) travel -= travel.dot(axis) * axis;
    if (i % 4 == 2) travel = travel.dot(axis) * axis;
    job.add(job.tools[static_cast<std::size_t>(i) % job.tools.size()], from,
            i % 13 == 12 ? from : Vec3(from + travel), axis);
  }
  return job;
}

/// The swept volume that is gone, and nothing else: every stored end lies on the judge's surface,
/// and random places are solid or not as the judge says.
void compare_with_judge(const Stock& stock, const std::vector<test::JudgedMove>& moves, int count,
                        double tolerance) {
  std::mt19937 random(7);
  const Box3 box = stock.box();
  int ends = 0;
  for (int n = 0; n < count; ++n) {
    Vec3 p;
    for (int a = 0; a < 3; ++a)
      p[a] = std::uniform_real_distribution<double>(box.min()[a], box.max()[a])(random);
    const int axis = n % 3;
    for (int a = 0; a < 3; ++a)  // onto the ray
      if (a != axis)
        p[a] = box.min()[a] +
               (std::floor((p[a] - box.min()[a]) / stock.pitch()) + 0.5) * stock.pitch();
    const auto material = stock.on_ray(axis, p);
    bool solid = false;
    for (const auto& [lo, hi] : material) {
      solid = solid || (p[axis] >= lo && p[axis] < hi);
      for (const double end : {lo, hi}) {
        Vec3 at = p;
        at[axis] = end;
        if (std::abs(end - box.min()[axis]) < 1e-4 || std::abs(end - box.max()[axis]) < 1e-4)
          continue;
        ++ends;
        EXPECT_NEAR(test::outside_all(moves, at), 0, tolerance)
            << "axis " << axis << " end at " << at.transpose();
      }
    }
    const double outside = test::outside_all(moves, p);
    if (std::abs(outside) > tolerance) {
      EXPECT_EQ(solid, outside > 0)
          << "axis " << axis << " at " << p.transpose() << ", " << outside;
    }
  }
  EXPECT_GT(ends, count / 6);
}

TEST(Stock, EveryEndOfARayLiesOnTheSweptSurface) {
  const auto all = tools();
  for (std::size_t i = 0; i < all.size(); ++i) {
    SCOPED_TRACE(i);
    Stock stock = block(0.25);
    const Job job = random_job({all[i]}, 14, 100 + static_cast<unsigned>(i));
    ASSERT_TRUE(stock.cut(job.pieces));
    compare_with_judge(stock, job.judged, 600, 5e-5);
  }
}

TEST(Stock, EveryEndOfARayLiesOnTheSweptSurfaceOfATiltedTool) {
  const auto all = tools();
  for (std::size_t i = 0; i < all.size(); ++i) {
    SCOPED_TRACE(i);
    Stock stock = block(0.25);
    const Job job = tilted_job({all[i]}, 10, 200 + static_cast<unsigned>(i));
    ASSERT_TRUE(stock.cut(job.pieces));
    // Corner arcs are cones there, within 0.0005 mm.
    compare_with_judge(stock, job.judged, 500, i == 2 || i == 5 ? 6e-4 : 5e-5);
  }
}

TEST(Stock, IsTheSameInAnyOrderBatchAndNumberOfThreads) {
  const auto all = tools();
  Job job = random_job(all, 120, 3);
  const Job tilted = tilted_job(all, 30, 4);
  for (Piece piece : tilted.pieces) {
    piece.move += 120;
    job.pieces.push_back(piece);
  }
  Stock first = block(0.3);
  const auto removed = first.cut(job.pieces);
  ASSERT_TRUE(removed);
  const std::string hash = first.hash();
  std::vector<Piece> shuffled = job.pieces;
  std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(5));
  for (const StockOptions& options :
       {StockOptions{.batch = 1}, StockOptions{.threads = 3, .batch = 17},
        StockOptions{.threads = 2, .batch = 1024}}) {
    Stock other = block(0.3, options);
    ASSERT_TRUE(other.cut(shuffled));
    EXPECT_EQ(other.hash(), hash);
    Stock same_order = block(0.3, options);
    const auto again = same_order.cut(job.pieces);
    ASSERT_TRUE(again);
    EXPECT_EQ(same_order.hash(), hash);
    ASSERT_EQ(again->size(), removed->size());
    for (std::size_t i = 0; i < again->size(); ++i)
      EXPECT_EQ((*again)[i].quanta, (*removed)[i].quanta) << i;
  }
  Stock backwards = block(0.3);
  std::vector<Piece> reversed(job.pieces.rbegin(), job.pieces.rend());
  ASSERT_TRUE(backwards.cut(reversed));
  EXPECT_EQ(backwards.hash(), hash);
}

TEST(Stock, SlicesTellHowEachPieceWasInTheMaterialAndChangeNothing) {
  // A wide cutter takes whole bricks; the second one runs along a wall 3 mm deep, 2 mm wide.
  const auto wide = *CutterProfile::flat(24, 40), narrow = *CutterProfile::flat(10, 20);
  const std::vector<Piece> pieces = {
      {.cutter = &wide, .start = {-15, 3, 5}, .end = {45, 3, 5}},
      {.cutter = &narrow, .start = {-6, 18, 2}, .end = {36, 18, 2}, .move = 1}};
  Stock plain = block(0.25), watched = block(0.25);
  const auto first = plain.engagement(pieces[0]);
  ASSERT_TRUE(plain.cut({&pieces[0], 1}));
  const auto second = plain.engagement(pieces[1]);
  ASSERT_TRUE(plain.cut({&pieces[1], 1}) && first && second);
  std::vector<Slice> slices;
  const auto removed = watched.cut(pieces, 2, slices);
  ASSERT_TRUE(removed);
  EXPECT_EQ(watched.hash(), plain.hash());
  EXPECT_EQ(watched.bytes(), plain.bytes());
  const Engagement* wanted[] = {&*first, &*second};
  for (std::size_t p = 0; p < 2; ++p) {
    Engagement sum;
    double last = -1;
    for (const Slice& slice : slices) {
      if (slice.piece != p) continue;
      EXPECT_GT(slice.from, last);
      EXPECT_LE((slice.to - slice.from) * (pieces[p].end - pieces[p].start).norm(), 2 + 1e-9);
      last = slice.from;
      sum.volume += slice.in.volume;
      sum.depth = std::max(sum.depth, slice.in.depth);
      sum.left = std::max(sum.left, slice.in.left);
      sum.right = std::max(sum.right, slice.in.right);
    }
    EXPECT_NEAR(sum.volume, (*removed)[p].volume, 1e-6) << p;
    EXPECT_NEAR(sum.depth, wanted[p]->depth, 0.25) << p;
    EXPECT_NEAR(sum.left, wanted[p]->left, 0.25) << p;
    EXPECT_NEAR(sum.right, wanted[p]->right, 0.25) << p;
  }
}

TEST(Stock, CutTwiceLosesNothingMore) {
  const Job job = random_job(tools(), 60, 9);
  Stock stock = block(0.3);
  ASSERT_TRUE(stock.cut(job.pieces));
  const std::string hash = stock.hash();
  const auto again = stock.cut(job.pieces);
  ASSERT_TRUE(again);
  for (const Removal& r : *again) EXPECT_EQ(r.quanta, 0);
  EXPECT_EQ(stock.hash(), hash);
}

TEST(Stock, SumOfWhatTheMovesTookIsWhatTheStockLost) {
  const Job job = random_job(tools(), 60, 11);
  Stock stock = block(0.3);
  const std::int64_t before = stock.z_quanta();
  const auto removed = stock.cut(job.pieces);
  ASSERT_TRUE(removed);
  std::int64_t sum = 0;
  for (const Removal& r : *removed) sum += r.quanta;
  EXPECT_GT(sum, 0);
  EXPECT_EQ(before - stock.z_quanta(), sum);
}

TEST(Stock, LineInPartsIsTheSameWithinTwoQuanta) {
  for (const Tool& tool : tools()) {
    const Vec3 from(3, 4, 8), to(25, 13, 5);
    Stock whole = block(0.25), parts = block(0.25);
    const Piece line{.cutter = &tool.profile, .start = from, .end = to};
    ASSERT_TRUE(whole.cut({&line, 1}));
    for (int i = 0; i < 9; ++i) {
      Piece part = line;
      part.start = from + (to - from) * (i / 9.0);
      part.end = from + (to - from) * ((i + 1) / 9.0);
      ASSERT_TRUE(parts.cut({&part, 1}));
    }
    for (int axis = 0; axis < 3; ++axis)
      for (double u = 0.1; u < 12; u += 0.37) {
        const Vec3 p(2.1 * u, 1.6 * u, std::fmod(3 * u, 12));
        const auto a = whole.on_ray(axis, p), b = parts.on_ray(axis, p);
        ASSERT_EQ(a.size(), b.size());
        for (std::size_t i = 0; i < a.size(); ++i) {
          EXPECT_NEAR(a[i].first, b[i].first, 2.1 * 0.25 / 3840);
          EXPECT_NEAR(a[i].second, b[i].second, 2.1 * 0.25 / 3840);
        }
      }
  }
}

struct Case {
  const char* name;
  std::function<void(Stock&)> cut;
  double volume, area;  // removed, mm³; of its surface, mm²
};

/// Analytic cases in a block of 30 × 20 × 12 with its top at 12.
std::vector<Case> analytic_cases() {
  const auto line = [](CutterProfile profile, std::vector<Vec3> path) {
    return [=](Stock& stock) {
      for (std::size_t i = 0; i + 1 < path.size(); ++i) {
        const Piece piece{.cutter = &profile, .start = path[i], .end = path[i + 1]};
        ASSERT_TRUE(stock.cut({&piece, 1}));
      }
    };
  };
  // A slot at 30 degrees, 4 deep; the ends are half discs.
  const Vec3 a(6, 5, 8), b(6 + 16 * std::cos(pi / 6), 5 + 16 * std::sin(pi / 6), 8);
  // A ball's pass at the depth of its radius: half a cylinder and half a sphere.
  return {{"slot", line(*CutterProfile::flat(6, 20), {a, b}), (16 * 6 + 9 * pi) * 4,
           16 * 6 + 9 * pi + 4 * (32 + 6 * pi)},
          {"hole", line(*CutterProfile::flat(8, 20), {{15, 10, 20}, {15, 10, 3}}), 16 * pi * 9,
           16 * pi + 8 * pi * 9},
          {"ball pass", line(*CutterProfile::ball(6, 20), {{8, 8, 9}, {21, 12, 9}}),
           13.6014705 * 4.5 * pi + 2.0 / 3 * pi * 27, 13.6014705 * 3 * pi + 2 * pi * 9}};
}

TEST(Stock, RemovedVolumeOfSlotHoleAndBallPassIsExactWithinItsBound) {
  for (const Case& c : analytic_cases()) {
    double error[2];
    for (int i = 0; i < 2; ++i) {
      const double h = i == 0 ? 0.4 : 0.2;
      Stock stock = block(h);
      const double before = stock.volume();
      EXPECT_NEAR(before, 30 * 20 * 12, 1e-3 * 7200);
      c.cut(stock);
      const double mesh_loss = before - stock.volume();
      EXPECT_NEAR(mesh_loss, c.volume, 0.5 * h * c.area) << c.name;
      EXPECT_NEAR(mesh_loss, c.volume, 0.01 * c.volume) << c.name << " at " << h;
      error[i] = std::abs(mesh_loss - c.volume);
    }
    if (std::string(c.name) == "ball pass") {
      EXPECT_LT(error[1], error[0] / 1.8);
    }
  }
}

TEST(Stock, MeshIsClosedAndItsVolumeIsThatOfTheRays) {
  const Job job = random_job(tools(), 25, 21);
  Stock stock = block(0.4);
  const double box = 30 * 20 * 12;
  const std::int64_t before = stock.z_quanta();
  ASSERT_TRUE(stock.cut(job.pieces));
  MeshStatistics statistics;
  const TriangleMesh mesh = stock.mesh(Facets::merged, &statistics);
  EXPECT_EQ(test::open_edges(mesh), 0u);
  EXPECT_EQ(test::flat_triangles(mesh), 0u);
  EXPECT_EQ(statistics.missing_ends, 0u);
  EXPECT_LT(statistics.disagreeing_nodes, 20u);
  double area = 0;
  for (const auto& t : mesh.triangles)
    area += (mesh.vertices[t[1]] - mesh.vertices[t[0]])
                .cross(mesh.vertices[t[2]] - mesh.vertices[t[0]])
                .norm() /
            2;
  const double removed = stock.volume_of(before - stock.z_quanta());
  EXPECT_NEAR(aircut::volume(mesh), box - removed, 0.1 * 0.4 * area);
}

// Distance from a point to a mesh, by all its triangles.
double distance_to(const TriangleMesh& mesh, const Vec3& p) {
  double best = 1e9;
  for (const auto& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Vec3 normal = (b - a).cross(c - a).normalized();
    bool above = true;
    for (const auto& [u, v] : {std::pair{a, b}, {b, c}, {c, a}}) {
      above = above && (v - u).cross(p - u).dot(normal) >= 0;
      const double along = std::clamp((p - u).dot(v - u) / (v - u).squaredNorm(), 0.0, 1.0);
      best = std::min(best, (u + along * (v - u) - p).norm());
    }
    if (above) best = std::min(best, std::abs(normal.dot(p - a)));
  }
  return best;
}

TEST(Stock, MergedMeshIsTheSameSurfaceInFewerTriangles) {
  // A pocket with round corners, straight walls along X and Y and a step, and random cuts.
  const auto tool = CutterProfile::flat(6, 20).value();
  std::vector<Piece> pocket;
  const std::array<Vec3, 5> corners = {Vec3{6, 6, 5}, Vec3{22, 6, 5}, Vec3{22, 14, 5},
                                       Vec3{6, 14, 5}, Vec3{6, 6, 5}};
  for (std::size_t i = 0; i + 1 < corners.size(); ++i)
    pocket.push_back({&tool, corners[i], corners[i + 1], Vec3::UnitZ(), 0});
  pocket.push_back({&tool, {14, 10, 3}, {18, 10, 3}, Vec3::UnitZ(), 0});
  const Job random = random_job(tools(), 25, 21);
  for (const bool simple : {true, false}) {
    Stock stock = block(0.4);
    ASSERT_TRUE(stock.cut(simple ? pocket : random.pieces));
    const TriangleMesh merged = stock.mesh(), lattice = stock.mesh(Facets::lattice);
    EXPECT_EQ(test::open_edges(merged), 0u);
    EXPECT_EQ(test::open_edges(lattice), 0u);
    EXPECT_EQ(test::flat_triangles(merged), 0u);
    EXPECT_NEAR(aircut::volume(merged), aircut::volume(lattice), 1e-3);
    if (simple) {
      EXPECT_LT(merged.triangles.size(), lattice.triangles.size() / 6);
    }
    for (std::size_t i = 0; i < lattice.vertices.size(); i += 97)
      EXPECT_LT(distance_to(merged, lattice.vertices[i]), 1e-3 * 0.4);
  }
}

void expect_mesh_near_surface(const Job& job) {
  double mean[2];
  for (int i = 0; i < 2; ++i) {
    const double h = i == 0 ? 0.5 : 0.25;
    Stock stock = block(h);
    ASSERT_TRUE(stock.cut(job.pieces));
    const TriangleMesh mesh = stock.mesh();
    double sum = 0;
    std::size_t looked_at = 0;
    for (std::size_t n = 0; n < mesh.vertices.size(); n += i == 0 ? 3 : 12, ++looked_at) {
      const Vec3& v = mesh.vertices[n];
      const Vec3 over = (v - stock.box().max()).cwiseMax(stock.box().min() - v);
      const double in_box = over.maxCoeff();  // < 0 inside
      const double distance = std::abs(std::max(in_box, -test::outside_all(job.judged, v)));
      EXPECT_LE(distance, 0.5 * h) << v.transpose();
      sum += distance;
    }
    mean[i] = sum / static_cast<double>(looked_at);
  }
  EXPECT_LT(mean[1], mean[0] / 1.5);
  EXPECT_LT(mean[1], 0.01 * 0.25);
}

TEST(Stock, MeshLiesOnTheSurfaceWithinHalfAPitch) {
  expect_mesh_near_surface(random_job(tools(), 8, 33));
}

TEST(Stock, MeshOfATiltedToolsCutLiesOnTheSurfaceWithinHalfAPitch) {
  expect_mesh_near_surface(tilted_job(tools(), 6, 34));
}

TEST(Stock, BarAndTubeHaveTheirVolume) {
  for (int direction = 0; direction < 3; ++direction) {
    Cylinder bar{.base = {1, 2, 3}, .direction = direction, .radius = 8, .length = 15};
    auto stock = Stock::make(bar, 0.3);
    ASSERT_TRUE(stock);
    EXPECT_NEAR(stock->volume(), pi * 64 * 15, 0.002 * pi * 64 * 15);
    bar.inner_radius = 3;
    stock = Stock::make(bar, 0.3);
    ASSERT_TRUE(stock);
    const TriangleMesh mesh = stock->mesh();
    EXPECT_EQ(test::open_edges(mesh), 0u);
    EXPECT_NEAR(aircut::volume(mesh), pi * 55 * 15, 0.002 * pi * 55 * 15);
  }
}

TEST(Stock, ClosedMeshBecomesTheSameStockAsItsBox) {
  auto mesh = std::make_shared<TriangleMesh>(make_box({0, 0, 0}, {30, 20, 12}));
  auto stock = Stock::make(MeshSolid{mesh}, 0.25);
  ASSERT_TRUE(stock);
  EXPECT_EQ(stock->hash(), block(0.25).hash());
  const Job job = random_job(tools(), 10, 5);
  Stock other = block(0.25);
  ASSERT_TRUE(other.cut(job.pieces));
  ASSERT_TRUE(stock->cut(job.pieces));
  EXPECT_EQ(stock->hash(), other.hash());
}

TEST(Stock, OpenMeshAndBadSizesAreRefused) {
  auto open = std::make_shared<TriangleMesh>(make_box({0, 0, 0}, {3, 2, 1}));
  open->triangles.pop_back();
  EXPECT_EQ(Stock::make(MeshSolid{open}, 0.25).error().kind, "stock_mesh");
  EXPECT_EQ(Stock::make(Box{{0, 0, 0}, {1, 0, 1}}, 0.1).error().kind, "stock_shape");
  EXPECT_EQ(Stock::make(Box{{0, 0, 0}, {1, 1, 1}}, 0).error().kind, "stock_shape");
  EXPECT_EQ(Stock::make(Box{{0, 0, 0}, {1, 1, 1}}, std::nan("")).error().kind, "stock_shape");
  const auto large = Stock::make(Box{{0, 0, 0}, {1000, 1000, 1000}}, 0.01);
  ASSERT_FALSE(large);
  EXPECT_EQ(large.error().kind, "stock_memory");
  EXPECT_NE(large.error().message.find("finest pitch that fits"), std::string::npos);
}

TEST(Stock, SavedStockIsReadAsTheSame) {
  const Job job = random_job(tools(), 40, 13);
  Stock stock = block(0.4);
  ASSERT_TRUE(stock.cut(job.pieces));
  const std::string bytes = stock.save();
  auto again = Stock::load(bytes, "job1.stock");
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->hash(), stock.hash());
  EXPECT_EQ(again->save(), bytes);
  EXPECT_EQ(again->z_quanta(), stock.z_quanta());
  const Job next = random_job(tools(), 20, 14);
  ASSERT_TRUE(stock.cut(next.pieces));
  ASSERT_TRUE(again->cut(next.pieces));
  EXPECT_EQ(again->hash(), stock.hash());
}

TEST(Stock, SpoiltFilesAreRefused) {
  const std::string good = block(0.5).save();
  const auto refused = [](std::string bytes, const char* why, bool mend = false) {
    if (mend) bytes.replace(bytes.size() - 64, 64, sha256(bytes.substr(0, bytes.size() - 64)));
    const auto stock = Stock::load(bytes, "a.stock");
    ASSERT_FALSE(stock) << why;
    EXPECT_EQ(stock.error().kind, "stock_file");
    EXPECT_NE(stock.error().message.find(why), std::string::npos) << stock.error().message;
  };
  refused("", "does not begin with");
  refused("aircut stock 2\n" + good.substr(15), "does not begin with");
  refused(good.substr(0, 40), "too early");
  refused(good.substr(0, good.size() - 1), "check sum");
  std::string changed = good;
  changed[100] = static_cast<char>(changed[100] + 1);
  refused(changed, "check sum");
  refused(good.substr(0, good.size() - 80) + good.substr(good.size() - 64), "too early", true);
  changed = good;
  for (std::size_t i = 15; i < 23; ++i) changed[i] = 0;  // the pitch
  refused(changed, "no size", true);
  refused(good.substr(0, good.size() - 64) + "more" + good.substr(good.size() - 64), "goes on",
          true);
}

TEST(Stock, MotionThatIsNotANumberIsAnErrorAndCutsNothing) {
  const auto flat = *CutterProfile::flat(6, 20);
  Stock stock = block(0.5);
  const std::string hash = stock.hash();
  Piece piece{.cutter = &flat, .start = {5, 5, 5}, .end = {9, 5, 5}, .axis = {0, 0, 0.9}};
  EXPECT_EQ(stock.cut({&piece, 1}).error().kind, "stock_unsupported");
  piece.axis = Vec3::UnitZ();
  piece.end.x() = std::nan("");
  EXPECT_EQ(stock.cut({&piece, 1}).error().kind, "stock_unsupported");
  EXPECT_EQ(stock.touch(piece).error().kind, "stock_unsupported");
  EXPECT_EQ(stock.hash(), hash);
}

TEST(Stock, QueryChangesNothingAndSaysHowDeep) {
  const auto flat = *CutterProfile::flat(6, 20);
  Stock stock = block(0.25);
  const std::string hash = stock.hash();
  Piece piece{.cutter = &flat, .start = {10, 10, 10}, .end = {20, 10, 10}};
  const auto deep = stock.would_cut(piece, 0.001);
  ASSERT_TRUE(deep);
  EXPECT_EQ(deep->contact, Contact::hit);
  EXPECT_NEAR(deep->touch.volume, (60 + 9 * pi) * 2, 0.02 * 176);
  piece.start.z() = piece.end.z() = 12.5;
  EXPECT_EQ(stock.would_cut(piece, 0.001)->contact, Contact::clear);
  piece.start.z() = piece.end.z() = 12.05;  // nearer than half of the pitch
  // Over a level face the surface between the rays is known, in an inner corner it isn't.
  EXPECT_EQ(stock.would_cut(piece, 0.001)->contact, Contact::clear);
  EXPECT_EQ(stock.hash(), hash);
  // The longest stretch goes on over the borders of bricks.
  piece = {.cutter = &flat, .start = {10, 10, 1}, .end = {10, 10, 1}};
  EXPECT_NEAR(stock.touch(piece)->depth, 11, 1e-3);
  piece = {.cutter = &flat, .start = {10, 10, 8}, .end = {20, 10, 8}};
  ASSERT_TRUE(stock.cut({&piece, 1}));
  const auto thinner = *CutterProfile::flat(5.95, 20);
  piece.cutter = &thinner;
  piece.start.z() = piece.end.z() = 8.05;
  EXPECT_EQ(stock.would_cut(piece, 0.001)->contact, Contact::unresolved);
}

TEST(Stock, ShankThatFollowsItsCuttersWallIsClear) {
  const auto cutter = *CutterProfile::flat(10, 3),
             thin = *CutterProfile::from_outline({{0, 3}, {4.9, 3}, {4.9, 40}, {0, 40}});
  const auto shank = *CutterProfile::from_outline({{0, 3}, {5, 3}, {5, 40}, {0, 40}});
  const auto thick = *CutterProfile::from_outline({{0, 3}, {5.01, 3}, {5.01, 40}, {0, 40}});
  Stock stock = block(0.1, {}, {0, 0, 0}, {50, 40, 12});
  for (int layer = 1; layer <= 3; ++layer) {
    const Vec3 a(15, 20, 12 - 2.5 * layer), b(35, 23, 12 - 2.5 * layer);
    Piece piece{.cutter = &cutter, .start = a, .end = b};
    ASSERT_TRUE(stock.cut({&piece, 1}));
    piece.cutter = &shank;
    EXPECT_EQ(stock.would_cut(piece, 0.001)->contact, Contact::clear) << layer;
    piece.cutter = &thin;
    EXPECT_EQ(stock.would_cut(piece, 0.001)->contact, Contact::clear) << layer;
    piece.cutter = &thick;
    const auto answer = stock.would_cut(piece, 0.001);
    EXPECT_EQ(answer->contact, layer == 1 ? Contact::clear : Contact::hit) << layer;
    if (layer > 1) {
      EXPECT_GT(answer->least, 0.008);
      EXPECT_LT(answer->least, 0.1);
    }
  }
}

TEST(Stock, BodyThatWouldTouchTheTrueSurfaceIsNeverClear) {
  // Scenes in which the judge knows the true contact: a body near or in what other moves left.
  std::mt19937 random(77);
  const auto uniform = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  const auto body = *CutterProfile::flat(4, 6);
  int clear = 0, hit = 0;
  for (int n = 0; n < 24; ++n) {
    Stock stock = block(0.4);
    const Job job = random_job(tools(), 3, 500 + static_cast<unsigned>(n));
    ASSERT_TRUE(stock.cut(job.pieces));
    const Vec3 from(uniform(4, 26), uniform(4, 16), uniform(8, 13));
    Piece piece{
        .cutter = &body, .start = from, .end = from + Vec3(uniform(-2, 2), uniform(-2, 2), 0)};
    const auto answer = stock.would_cut(piece, 0.001);
    ASSERT_TRUE(answer);
    // The deepest place of the body that is material, by random points on its sweep.
    const test::JudgedMove judged{test::flat_shape(4, 6), piece.start, piece.end};
    double deepest = 0;
    for (int k = 0; k < 500; ++k) {
      const Vec3 p = piece.start + uniform(0, 1) * (piece.end - piece.start) +
                     Vec3(uniform(-2, 2), uniform(-2, 2), uniform(0, 3));
      if (judged.outside(p) > 0 || p.z() > 12) continue;
      deepest = std::max(
          deepest, std::min({test::outside_all(job.judged, p), -judged.outside(p), 12 - p.z()}));
    }
    clear += answer->contact == Contact::clear;
    hit += answer->contact == Contact::hit;
    if (answer->contact == Contact::clear) {
      EXPECT_LT(deepest, 0.002) << n;
    }
    if (deepest > 0.4) {
      EXPECT_EQ(answer->contact, Contact::hit) << n;
    }
  }
  EXPECT_GT(clear, 1);
  EXPECT_GT(hit, 3);
}

TEST(Stock, ArcIsCutAsChordsWithinItsDeviation) {
  const Arc arc{.start = {5, 0, 1}, .end = {5, 0, 4}, .angle = 6 * pi};
  const auto pieces = arc_pieces(arc, {}, 0.01);
  EXPECT_TRUE(pieces.front().start.isApprox(arc.start));
  EXPECT_TRUE(pieces.back().end.isApprox(arc.end));
  for (const Piece& p : pieces) {
    const Vec3 middle = (p.start + p.end) / 2;
    EXPECT_LE(5 - middle.head<2>().norm(), 0.01);
    EXPECT_NEAR(p.start.head<2>().norm(), 5, 1e-9);
  }
}

}  // namespace
}  // namespace aircut::stock
