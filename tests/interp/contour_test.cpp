// Roughing judged by brute force: where the tool has been is compared with the contour, point by
// point along Z.
#include "interp/contour.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "run_program.h"

namespace aircut::interp {
namespace {

struct Point {
  double z = 0, x = 0;
};

// The radius of a polyline that falls in z, at z; infinite outside.
double radius_at(const std::vector<Point>& line, double z) {
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Point a = line[i - 1], b = line[i];
    if (z > a.z || z < b.z || a.z == b.z) continue;
    return a.x + (b.x - a.x) * (a.z - z) / (a.z - b.z);
  }
  return std::numeric_limits<double>::infinity();
}

std::string number(double value) { return std::to_string(value); }

// A contour that rises in X and falls in Z, as points with three decimals.
std::vector<Point> shaft(std::mt19937& random) {
  std::uniform_int_distribution<int> step(0, 6000);
  std::vector<Point> points = {{2, 5}};
  while (points.size() < 8) {
    Point next = points.back();
    next.z -= (500 + step(random)) / 1000.0;
    if (points.size() > 1) next.x += step(random) / 2000.0;
    points.push_back(next);
  }
  return points;
}

TEST(Roughing, OfFanucLeavesTheAllowanceAndNothingElse) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937 random(seed);
    const std::vector<Point> points = shaft(random);
    const double stock = points.back().x + 1, left_x = 0.4, left_z = 0.1;
    std::string program = "G97 S500 M3\nG0 X" + number(2 * stock) + " Z2.\nG71 U1.5 R0.5\n" +
                          "G71 P10 Q20 U" + number(2 * left_x) + " W" + number(left_z) +
                          " F0.2\nN10 G0 X" + number(2 * points[0].x) + "\nG1\n";
    for (std::size_t i = 1; i < points.size(); ++i)
      program += "X" + number(2 * points[i].x) + " Z" + number(points[i].z) + "\n";
    program += "N20 X" + number(2 * stock) + "\nM30\n";
    test::Setting setting;
    setting.options.dialect = Dialect::fanuc;
    setting.options.lathe = true;
    SourceMap sources;
    const test::Ran ran = run_program(sources, program, setting);
    ASSERT_TRUE(ran.kinds().empty()) << program << ran.kinds().front();

    std::vector<Point> wanted = points;
    for (Point& point : wanted) point = {point.z + left_z, point.x + left_x};
    std::vector<double> lowest(400, std::numeric_limits<double>::infinity());
    const double far = wanted.back().z, way = (wanted.front().z - far) / 400;
    AxisValues tip;
    for (const canon::Command& command : ran.commands) {
      const AxisValues end = canon::end_of(command.action, tip);
      if (std::holds_alternative<canon::LinearFeed>(command.action))
        for (std::size_t i = 0; i < lowest.size(); ++i) {
          const double z = far + (static_cast<double>(i) + 0.5) * way;
          const double from = tip[Axis::z], to = end[Axis::z];
          if (z > std::max(from, to) || z < std::min(from, to) || from == to) continue;
          const double x = tip[Axis::x] + (end[Axis::x] - tip[Axis::x]) * (z - from) / (to - from);
          lowest[i] = std::min(lowest[i], x);
        }
      tip = end;
    }
    for (std::size_t i = 0; i < lowest.size(); ++i) {
      const double z = far + (static_cast<double>(i) + 0.5) * way;
      EXPECT_NEAR(lowest[i], radius_at(wanted, z), 1e-5) << "seed " << seed << " z " << z;
    }
  }
}

// Every point of the offset lies at the distance from the contour, on the stock's side.
TEST(Offset, KeepsItsDistance) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937 random(seed);
    Contour contour;
    const std::vector<Point> points = shaft(random);
    for (std::size_t i = 1; i < points.size(); ++i) {
      ContourPiece piece;
      piece.start = {points[i - 1].z, points[i - 1].x};
      piece.end = {points[i].z, points[i].x};
      contour.push_back(piece);
    }
    const Contour moved = offset(contour, 0.7);
    ASSERT_FALSE(moved.empty());
    for (const ContourPiece& piece : moved) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const ContourPiece& original : contour)
        for (int k = 0; k <= 2000; ++k) {
          const double s = k / 2000.0;
          const double u = original.start.u + s * (original.end.u - original.start.u);
          const double v = original.start.v + s * (original.end.v - original.start.v);
          nearest = std::min(nearest, std::hypot(piece.end.u - u, piece.end.v - v));
        }
      EXPECT_NEAR(nearest, 0.7, 1e-5) << "seed " << seed;
    }
    EXPECT_GT(moved.front().start.v, contour.front().start.v);
  }
}

// Two lines, the second one turned by `angle` outwards, in front of a stock at larger v.
Contour bent(double angle) {
  Contour contour(2);
  contour[0].start = {0, 0};
  contour[0].end = contour[1].start = {-10, 0};
  contour[1].end = {-10 - 10 * std::cos(angle), -10 * std::sin(angle)};
  return contour;
}

TEST(Offset, LeavesNarrowCornersSharp) {
  constexpr double d = 2, narrow = 0.01;
  const Contour sharp = offset(bent(0.004), d, narrow);
  ASSERT_EQ(sharp.size(), 2);
  // The bisector of the corner: prolonged by d tan(angle / 2).
  EXPECT_NEAR(sharp[0].end.u, -10 - d * std::tan(0.002), 1e-9);
  EXPECT_NEAR(sharp[0].end.v, d, 1e-9);
  const Contour round = offset(bent(0.006), d, narrow);
  ASSERT_EQ(round.size(), 3);
  EXPECT_NE(round[1].turn, 0);
}

// Its end stays off the arc by so little that the line behind it passes the circle: the nearest
// point of the line then is the corner.
TEST(Offset, JoinsALineThatOnlyJustMissesTheArc) {
  Contour contour(2);
  contour[0] = {.start = {0, -3}, .end = {-2.1215, -2.1215}, .centre = {0, 0}, .turn = -1};
  contour[1] = {.start = {-2.1215, -2.1215}, .end = {-4.1215, -0.1215}, .centre = {}};
  const Contour joined = offset(contour, -1, 0.01);
  ASSERT_EQ(joined.size(), 2);
  EXPECT_NEAR(joined[0].end.u, joined[0].end.v, 1e-4);
  EXPECT_NEAR(std::hypot(joined[0].end.u, joined[0].end.v), 4, 1e-3);
}

}  // namespace
}  // namespace aircut::interp
