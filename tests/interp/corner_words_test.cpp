// `,R` and `,C` of Fanuc-like controls on random chains of lines and arcs. The judge knows nothing
// of offset curves: it looks at the path that comes out, and asks of each corner what its drawing
// says: a fillet has its radius and touches both moves, a chamfer's ends lie at the same distance
// from the corner, and what is left of the moves lies where they were.
#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "interp/run_program.h"

namespace aircut::test {
namespace {

struct Point {
  double x = 0, y = 0;
};
double far(Point a, Point b) { return std::hypot(a.x - b.x, a.y - b.y); }

/// A move as the program has it; `turn` +1 is G3, −1 is G2.
struct Move {
  Point from, to, centre;
  int turn = 0;
};

Move move_of(const canon::Command& command, Point from) {
  Move move;
  move.from = from;
  const AxisValues end = canon::end_of(command.action, {});
  move.to = {end[Axis::x], end[Axis::y]};
  if (const auto* arc = std::get_if<canon::ArcFeed>(&command.action)) {
    move.turn = arc->turns > 0 ? 1 : -1;
    move.centre = {arc->centre[0], arc->centre[1]};
  }
  return move;
}

/// How far the point lies from the line or circle of the move.
double off_carrier(const Move& move, Point p) {
  if (move.turn != 0) return std::fabs(far(p, move.centre) - far(move.from, move.centre));
  const double dx = move.to.x - move.from.x, dy = move.to.y - move.from.y;
  return std::fabs((p.x - move.from.x) * dy - (p.y - move.from.y) * dx) / std::hypot(dx, dy);
}

/// The way to a point of the move, as a share of the whole.
double share(const Move& move, Point p) {
  if (move.turn == 0) return far(move.from, p) / far(move.from, move.to);
  const auto angle = [&](Point q) {
    const double turned =
        move.turn * (std::atan2(q.y - move.centre.y, q.x - move.centre.x) -
                     std::atan2(move.from.y - move.centre.y, move.from.x - move.centre.x));
    return turned - 2 * std::numbers::pi * std::floor(turned / (2 * std::numbers::pi) + 1e-9);
  };
  return angle(p) / angle(move.to);
}

/// Unit direction of travel.
Point heading(const Move& move, Point at) {
  double dx = move.to.x - move.from.x, dy = move.to.y - move.from.y;
  if (move.turn != 0) {
    dx = -move.turn * (at.y - move.centre.y);
    dy = move.turn * (at.x - move.centre.x);
  }
  const double length = std::hypot(dx, dy);
  return {dx / length, dy / length};
}

Setting fanuc() {
  Setting setting;
  setting.options.dialect = interp::Dialect::fanuc;
  for (const Axis axis : {Axis::x, Axis::y, Axis::z}) setting.options.axes.add(axis);
  return setting;
}

class Chain {
 public:
  explicit Chain(unsigned seed) : random_(seed) {}

  /// The text of one more move from where the last one ended, and the move.
  std::string add(std::vector<Move>& moves, const std::string& corner) {
    Move move;
    move.from = moves.empty() ? Point{} : moves.back().to;
    const double way = from(20, 40), angle = from(0, 6.28);
    move.to = {rounded(move.from.x + way * std::cos(angle)),
               rounded(move.from.y + way * std::sin(angle))};
    std::string text = "G1";
    if (from(0, 1) < 0.5) {
      const double radius = rounded(way * from(0.6, 2));
      move.turn = from(0, 1) < 0.5 ? 1 : -1;
      const double chord = far(move.from, move.to);
      const double side = move.turn * std::sqrt(radius * radius - chord * chord / 4) / chord;
      move.centre = {(move.from.x + move.to.x) / 2 - side * (move.to.y - move.from.y),
                     (move.from.y + move.to.y) / 2 + side * (move.to.x - move.from.x)};
      text = (move.turn > 0 ? "G3 R" : "G2 R") + fixed(radius, 6);
    }
    moves.push_back(move);
    return text + " X" + fixed(move.to.x, 6) + " Y" + fixed(move.to.y, 6) + corner + "\n";
  }
  double from(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  static double rounded(double value) { return std::round(value * 1e6) / 1e6; }

 private:
  std::mt19937 random_;
};

TEST(CornerWords, RoundAndCutOffCornersOfRandomChains) {
  int corners = 0, refused = 0, straight = 0;
  for (unsigned seed = 1; seed <= 400; ++seed) {
    Chain chain(seed);
    std::vector<Move> moves;
    const bool round = seed % 2 == 0;
    const double size = Chain::rounded(chain.from(0.2, 4));
    std::string program = "G21 G90 G17 F1000\n";
    for (int i = 0; i < 3; ++i)
      program += chain.add(moves, i == 2 ? "" : (round ? " ,R" : " ,C") + fixed(size, 6));
    SourceMap sources;
    const Ran ran = run_program(sources, program + "M30\n", fanuc());
    if (!ran.kinds().empty()) {
      // Too large, or the ends of two cuts pass each other.
      for (const std::string& kind : ran.kinds()) EXPECT_EQ(kind, "corner_error") << program;
      ++refused;
      continue;
    }
    std::vector<Move> path;
    std::vector<std::uint64_t> lines;
    Point at;
    for (const canon::Command& command : ran.commands) {
      if (!canon::is_motion(command.action)) continue;
      path.push_back(move_of(command, at));
      lines.push_back(command.span.line);
      at = path.back().to;
    }
    ASSERT_GE(path.size(), 3u) << program;
    EXPECT_LT(far(path.back().to, moves.back().to), 1e-5) << program;
    std::size_t next = 0;
    for (std::size_t i = 0; i < moves.size(); ++i) {
      SCOPED_TRACE(program + "move " + std::to_string(i));
      const Move& left = path.at(next);
      // What is left of the move lies on it and runs the same way.
      EXPECT_LT(off_carrier(moves[i], left.from), 1e-5);
      EXPECT_LT(off_carrier(moves[i], left.to), 1e-5);
      EXPECT_EQ(left.turn, moves[i].turn);
      EXPECT_LE(share(moves[i], left.from), share(moves[i], left.to) + 1e-6);
      ++next;
      if (i + 1 == moves.size()) break;
      if (next >= path.size() || lines[next] != lines[next - 1]) {  // no corner was made
        const Point in = heading(moves[i], moves[i].to);
        const Point out = heading(moves[i + 1], moves[i + 1].from);
        EXPECT_GT(in.x * out.x + in.y * out.y, std::cos(1.001 * std::numbers::pi / 180));
        ++straight;
        continue;
      }
      const Move& cut = path.at(next++);
      ++corners;
      EXPECT_LT(off_carrier(moves[i], cut.from), 1e-5);
      EXPECT_LT(off_carrier(moves[i + 1], cut.to), 1e-5);
      if (!round) {
        EXPECT_EQ(cut.turn, 0);
        EXPECT_NEAR(far(cut.from, moves[i].to), size, 1e-5);
        EXPECT_NEAR(far(cut.to, moves[i].to), size, 1e-5);
        continue;
      }
      EXPECT_NEAR(far(cut.from, cut.centre), size, 1e-5);
      EXPECT_NEAR(far(cut.to, cut.centre), size, 1e-5);
      const Point in = heading(moves[i], cut.from), start = heading(cut, cut.from);
      const Point end = heading(cut, cut.to), out = heading(moves[i + 1], cut.to);
      EXPECT_GT(in.x * start.x + in.y * start.y, 1 - 1e-9);
      EXPECT_GT(end.x * out.x + end.y * out.y, 1 - 1e-9);
    }
    EXPECT_EQ(next, path.size()) << program;
  }
  EXPECT_GT(corners, 300);
  EXPECT_LT(refused, 200);
  RecordProperty("corners", corners);
  RecordProperty("refused", refused);
  RecordProperty("straight", straight);
}

/// Two lines by their angles against their cross product solved by hand (Cramer).
TEST(CornerWords, LetTwoLinesByTheirAnglesMeet) {
  Setting lathe = fanuc();
  lathe.options.lathe = true;
  lathe.options.axes = {};
  lathe.options.axes.add(Axis::x);
  lathe.options.axes.add(Axis::z);
  std::mt19937 random(3);
  const auto from = [&](double low, double high) {
    return Chain::rounded(std::uniform_real_distribution<double>(low, high)(random));
  };
  for (int i = 0; i < 100; ++i) {
    const double x = from(0, 50), z = from(-50, 0), a = from(10, 80), b = from(100, 170);
    const std::string program = "G98 G0 X0 Z0\nG1 ,A" + fixed(a, 6) + " F100\nX" + fixed(2 * x, 6) +
                                " Z" + fixed(z, 6) + " ,A" + fixed(b, 6) + "\nM30\n";
    SourceMap sources;
    const Ran ran = run_program(sources, program, lathe);
    ASSERT_TRUE(ran.kinds().empty()) << program;
    // The first end (w, u): u = w tan a, and x − u = (z − w) tan b.
    const double ta = std::tan(a * std::numbers::pi / 180),
                 tb = std::tan(b * std::numbers::pi / 180);
    const double w = (x - z * tb) / (ta - tb), u = w * ta;
    const auto first = std::find_if(ran.commands.begin(), ran.commands.end(), [](const auto& c) {
      return std::holds_alternative<canon::LinearFeed>(c.action);
    });
    ASSERT_NE(first, ran.commands.end());
    const AxisValues end = canon::end_of(first->action, {});
    EXPECT_NEAR(end[Axis::x], u, 1e-4) << program;
    EXPECT_NEAR(end[Axis::z], w, 1e-4) << program;
  }
}

}  // namespace
}  // namespace aircut::test
