// Roughing of random contours with pockets against a height map: the stock is a row of columns
// whose height each move lowers. Nothing of the contour may be cut, no rapid may touch what is
// left, no pass may take more than its depth, and what stays must be less than one depth.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "interp/contour.h"

namespace aircut::interp {
namespace {

constexpr double cell = 0.05, width = 60;
constexpr int cells = static_cast<int>(width / cell);

double u_of(int i) { return (i + 0.5) * cell; }

/// Height of the contour over u; the contour is a function of u.
double height(const Contour& contour, double u) {
  double highest = -1e9;
  for (const ContourPiece& p : contour) {
    const double low = std::min(p.start.u, p.end.u), high = std::max(p.start.u, p.end.u);
    if (u < low || u > high || high - low < 1e-12) continue;
    if (p.turn == 0) {
      const double s = (u - p.start.u) / (p.end.u - p.start.u);
      highest = std::max(highest, p.start.v + s * (p.end.v - p.start.v));
      continue;
    }
    const double r = std::hypot(p.start.u - p.centre.u, p.start.v - p.centre.v);
    const double half = std::sqrt(std::max(0.0, r * r - std::pow(u - p.centre.u, 2)));
    // Travel is towards smaller u: an arc that turns from u to v has its centre below.
    highest = std::max(highest, p.centre.v + (p.turn > 0 ? half : -half));
  }
  return highest;
}

struct Numbers {
  std::mt19937 random;
  double from(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  }
};

/// From u = 60 to 0 with dips, walls and arcs; it ends at v = 20, from where it never came higher.
Contour random_contour(Numbers& r) {
  Contour contour;
  PlanePoint at{width, r.from(0, 10)};
  while (at.u > 1) {
    ContourPiece piece;
    piece.start = at;
    const double step = std::min(at.u, r.from(2, 9));
    piece.end = {at.u - step, r.from(0, 18)};
    if (piece.end.u < 1) piece.end = {0, 19};
    const double kind = r.from(0, 1);
    if (kind < 0.25) {  // a wall, then a level
      ContourPiece wall = piece;
      wall.end = {at.u, piece.end.v};
      contour.push_back(wall);
      piece.start = wall.end;
    } else if (kind < 0.55) {
      // A quarter of a circle at most, so that it stays a function of u.
      const double chord = std::hypot(piece.end.u - at.u, piece.end.v - at.v);
      const double radius = chord * r.from(2, 5);
      piece.turn = r.from(0, 1) < 0.5 ? 1 : -1;
      const double side = piece.turn * std::sqrt(radius * radius - chord * chord / 4) / chord;
      piece.centre = {(at.u + piece.end.u) / 2 - side * (piece.end.v - at.v),
                      (at.v + piece.end.v) / 2 + side * (piece.end.u - at.u)};
      const auto leans = [&](PlanePoint p) {
        return piece.turn * (p.v - piece.centre.v) <= 0.05 * radius;
      };
      if (leans(piece.start) || leans(piece.end)) piece.turn = 0;
    }
    contour.push_back(piece);
    at = piece.end;
  }
  return contour;
}

std::string text_of(const Contour& contour) {
  std::string text;
  for (const ContourPiece& p : contour)
    text += "\n" + std::to_string(p.start.u) + " " + std::to_string(p.start.v) + " to " +
            std::to_string(p.end.u) + " " + std::to_string(p.end.v) + " about " +
            std::to_string(p.centre.u) + " " + std::to_string(p.centre.v) + " turn " +
            std::to_string(p.turn);
  return text;
}

/// Points of a move, a fifth of a cell apart.
std::vector<PlanePoint> points_of(PlanePoint from, const CutterMove& move) {
  std::vector<PlanePoint> points;
  double sweep = 0, radius = 0, first = 0;
  double way = std::hypot(move.end.u - from.u, move.end.v - from.v);
  if (move.turn != 0) {
    radius = std::hypot(from.u - move.centre.u, from.v - move.centre.v);
    first = std::atan2(from.v - move.centre.v, from.u - move.centre.u);
    sweep =
        move.turn * (std::atan2(move.end.v - move.centre.v, move.end.u - move.centre.u) - first);
    while (sweep < 0) sweep += 2 * std::acos(-1.0);
    way = sweep * radius;
  }
  const int count = static_cast<int>(way / (cell / 5)) + 1;
  for (int i = 0; i <= count; ++i) {
    const double s = static_cast<double>(i) / count;
    if (move.turn == 0)
      points.push_back({from.u + s * (move.end.u - from.u), from.v + s * (move.end.v - from.v)});
    else
      points.push_back({move.centre.u + radius * std::cos(first + move.turn * s * sweep),
                        move.centre.v + radius * std::sin(first + move.turn * s * sweep)});
  }
  return points;
}

TEST(PocketRoughing, LeavesTheContourAndLessThanOneDepth) {
  int pockets = 0;
  for (unsigned seed = 1; seed <= 80; ++seed) {
    Numbers r{std::mt19937(seed)};
    const Contour contour = random_contour(r);
    SCOPED_TRACE("seed " + std::to_string(seed) + text_of(contour));
    pockets += first_going_back(contour, true).has_value();
    PocketRoughing options;
    options.start = {width + 2, 20};
    options.depth = r.from(0.7, 5);
    options.escape = seed % 3 == 0 ? 0 : r.from(0.1, 1);
    options.rapid_down = true;
    std::string problem;
    const auto moves = rough_pockets(contour, options, problem);
    ASSERT_TRUE(moves) << problem;
    std::vector<double> shape(cells), stock(cells, options.start.v);
    for (int i = 0; i < cells; ++i) shape[static_cast<std::size_t>(i)] = height(contour, u_of(i));
    PlanePoint at = options.start;
    for (const CutterMove& move : *moves) {
      // A pass; what follows a wall cuts less, but runs down the stock's side.
      const bool pass = std::string_view(move.what) == "pass";
      for (const PlanePoint p : points_of(at, move)) {
        const int i = static_cast<int>(std::floor(p.u / cell));
        if (i < 0 || i >= cells) continue;
        double& left = stock[static_cast<std::size_t>(i)];
        // Beside a wall both heights are right.
        ASSERT_GT(p.v, std::min(height(contour, p.u - 1e-6), height(contour, p.u + 1e-6)) - 1e-5)
            << move.what << " at " << p.u << " " << p.v;
        if (move.rapid) {
          ASSERT_GT(p.v, left - 1e-6)
              << move.what << " at " << p.u << " " << p.v << " stock " << left;
        }
        if (pass) {
          ASSERT_LT(left - p.v, options.depth + 1e-6) << p.u << " " << p.v;
        }
        if (!move.rapid) left = std::min(left, p.v);
      }
      at = move.end;
    }
    EXPECT_GE(at.v, options.start.v - 1e-9);
    for (int i = 0; i < cells; ++i) {
      const std::size_t k = static_cast<std::size_t>(i);
      EXPECT_LT(stock[k] - shape[k], options.depth + 1e-3) << u_of(i);
    }
  }
  EXPECT_GT(pockets, 50);
}

}  // namespace
}  // namespace aircut::interp
