// The distance of each logged tip from the programmed path. A row names its block; near corners and
// in merged lines it may lie on a neighbour's piece, so the search goes outwards from the piece of
// its own block until one is within the tolerance. And every piece must have been gone along: a row
// must come as near to its end as two rows are apart.
#include "logbook/path_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace aircut::logbook {
namespace {

constexpr std::size_t most_around = 120;  // a merged chord replaces up to a hundred lines
constexpr double rounding = 1e-6;         // mm
constexpr double feed_share = 1e-3;

Point add(const Point& a, double f, const Point& b) {
  return {a[0] + f * b[0], a[1] + f * b[1], a[2] + f * b[2]};
}
double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double distance(const Point& a, const Point& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

double distance_to_line(const Point& p, const Point& start, const Point& end) {
  const Point way = add(end, -1, start);
  const double square = dot(way, way);
  const double f = square > 0 ? std::clamp(dot(add(p, -1, start), way) / square, 0.0, 1.0) : 0;
  return distance(p, add(start, f, way));
}

// A helix about an axis; radius and height go linearly with the angle.
struct Helix {
  Point centre, normal, radial, side;
  double radius = 0, grow = 0, height = 0, rise = 0, angle = 0;

  explicit Helix(const IdealPiece& piece) : centre(piece.centre), normal(piece.normal) {
    const Point from = add(piece.start, -1, centre), to = add(piece.end, -1, centre);
    height = dot(from, normal);
    rise = dot(to, normal) - height;
    const Point r0 = add(from, -height, normal), r1 = add(to, -(height + rise), normal);
    radius = std::sqrt(dot(r0, r0));
    grow = std::sqrt(dot(r1, r1)) - radius;
    if (!(radius > 0)) return;
    radial = add({}, 1 / radius, r0);
    side = cross(normal, radial);
    angle = std::atan2(dot(r1, side), dot(r1, radial));
    constexpr double turn = 2 * std::numbers::pi, same = 1e-9;
    if (piece.turns > 0 && angle <= same) angle += turn;
    if (piece.turns < 0 && angle >= -same) angle -= turn;
    angle += turn * (piece.turns - (piece.turns > 0 ? 1 : -1));
  }
  Point at(double f) const {
    const double r = radius + f * grow, phi = f * angle;
    Point p = add(centre, height + f * rise, normal);
    p = add(p, r * std::cos(phi), radial);
    return add(p, r * std::sin(phi), side);
  }
  double distance_to(const Point& p) const {
    // By the angle of p there is one place per turn; the best is refined by golden section.
    const Point from = add(p, -1, centre);
    const double phi = std::atan2(dot(from, side), dot(from, radial));
    constexpr double turn = 2 * std::numbers::pi;
    double best = std::min(distance(p, at(0)), distance(p, at(1)));
    const double low = std::min(0.0, angle), high = std::max(0.0, angle);
    for (double k = std::floor((low - phi) / turn); phi + k * turn <= high + turn; ++k) {
      const double f = std::clamp((phi + k * turn) / angle, 0.0, 1.0);
      best = std::min(best, refined(p, f));
    }
    return best;
  }
  double refined(const Point& p, double f) const {
    double width = std::min(1.0, 0.2 / std::max(std::abs(angle), 1e-9));
    double low = std::max(0.0, f - width), high = std::min(1.0, f + width);
    while (high - low > 1e-10) {
      const double a = low + 0.382 * (high - low), b = low + 0.618 * (high - low);
      (distance(p, at(a)) < distance(p, at(b)) ? high : low) =
          distance(p, at(a)) < distance(p, at(b)) ? b : a;
    }
    return distance(p, at((low + high) / 2));
  }
};

double distance_to(const IdealPiece& piece, const Point& p) {
  if (piece.arc) {
    const Helix helix(piece);
    if (helix.radius > 0 && helix.angle != 0) return helix.distance_to(p);
  }
  if (piece.points.size() < 2) return distance_to_line(p, piece.start, piece.end);
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < piece.points.size(); ++i)
    best = std::min(best, distance_to_line(p, piece.points[i], piece.points[i + 1]));
  return best;
}

std::string place(const IdealPiece& piece) { return "line " + std::to_string(piece.line); }

}  // namespace

void add_problem(Check& check, std::string text) {
  constexpr std::size_t most = 20;
  if (check.problems.size() < most)
    check.problems.push_back(std::move(text));
  else
    ++check.more_problems;
}

// Holds all pieces up to `block` and some behind it.
void PathCheck::read_up_to(std::uint64_t block) {
  std::size_t behind = 0;
  for (auto piece = pieces_.rbegin(); piece != pieces_.rend() && piece->ideal.block > block;
       ++piece)
    ++behind;
  while (!ended_ && behind < most_around) {
    Piece piece;
    if (!next_(piece.ideal)) {
      ended_ = true;
      break;
    }
    const IdealPiece& ideal = piece.ideal;
    piece.length = distance(ideal.start, ideal.end);
    if (ideal.arc)
      piece.length = std::max(piece.length, std::abs(Helix(ideal).angle * Helix(ideal).radius));
    if (ideal.block > block) ++behind;
    pieces_.push_back(std::move(piece));
  }
}

void PathCheck::judge_end(const Piece& piece, Check& out) const {
  // Pieces of a few strides may lie between two rows altogether.
  if (!(piece.length > 5 * stride_) || std::isinf(piece.ideal.tolerance)) return;
  if (piece.nearest_end <= stride_ + piece.ideal.tolerance + rounding) return;
  add_problem(
      out, "the end of " + place(piece.ideal) + " is never reached: no row comes nearer than " +
               (piece.nearest_end < 1e299 ? fixed(piece.nearest_end, 4) + " mm" : "another line"));
}

void PathCheck::drop_before(std::size_t own, Check& out) {
  for (; own > most_around; --own) {
    judge_end(pieces_.front(), out);
    pieces_.pop_front();
  }
}

void PathCheck::check_feed(const Row& row, const Piece& piece, Check& out) {
  if (piece.ideal.block != row.block() || !(piece.ideal.feed > 0) || feed_told_) return;
  if (row.motion() != 2 && row.motion() != 3) return;
  for (const double factor : factors_) {
    const double feed = factor * piece.ideal.feed;
    if (std::abs(row.feed_command() - feed) <= feed_share * feed) return;
  }
  feed_told_ = true;
  add_problem(out, "the feed of " + place(piece.ideal) + " is " + shortest(60 * piece.ideal.feed) +
                       " a minute in the program and " + shortest(60 * row.feed_command()) +
                       " in the log, at t = " + fixed(row.t(), 3) + " s");
}

void PathCheck::row(const Row& row, Check& out) {
  read_up_to(row.block());
  const Point p = row.xyz();
  if (has_last_) stride_ = std::max(stride_, distance(p, last_));
  has_last_ = true;
  last_ = p;
  if (pieces_.empty()) return;
  // At rest the tip may jump without a motion: another tool length counts.
  constexpr std::array<int, 3> resting = {0, 4, 6};
  if (std::find(resting.begin(), resting.end(), row.motion()) != resting.end()) {
    for (std::size_t j = 0; j < row.joints; ++j)
      if (row.v(j) != 0 && !off_) {
        off_ = true;
        add_problem(out,
                    "at t = " + fixed(row.t(), 3) + " s a joint moves where the machine rests");
      }
    return;
  }
  auto found = std::lower_bound(pieces_.begin(), pieces_.end(), row.block(),
                                [](const Piece& a, std::uint64_t b) { return a.ideal.block < b; });
  if (found == pieces_.end()) --found;
  const auto own = static_cast<std::size_t>(found - pieces_.begin());
  double nearest = std::numeric_limits<double>::infinity(), allowed = 0;
  for (std::size_t around = 0; around <= most_around; ++around) {
    bool any = false;
    for (const std::size_t i : {own - around, own + around}) {
      if (i >= pieces_.size()) continue;  // `own − around` wraps to a large number
      any = true;
      Piece& piece = pieces_[i];
      nearest = std::min(nearest, distance_to(piece.ideal, p));
      if (around <= 1) allowed = std::max(allowed, piece.ideal.tolerance);
      piece.nearest_end = std::min(piece.nearest_end, distance(piece.ideal.end, p));
    }
    if (!any || (around >= 2 && nearest <= allowed + rounding)) break;
  }
  check_feed(row, pieces_[own], out);
  if (!std::isinf(allowed)) {
    if (nearest > out.deviation) {
      out.deviation = nearest;
      out.deviation_t = row.t();
      out.deviation_line = row.line();
    }
    const bool was_off = std::exchange(off_, nearest > allowed + rounding);
    if (off_ && !was_off)
      add_problem(out, "at t = " + fixed(row.t(), 3) + " s, line " + std::to_string(row.line()) +
                           ", the tip is " + shortest(nearest) + " mm off the programmed path, " +
                           shortest(allowed) + " mm are allowed");
  }
  drop_before(own, out);
}

void PathCheck::finish(Check& out) {
  for (const Piece& piece : pieces_) judge_end(piece, out);
  IdealPiece piece;
  if (!ended_ && next_(piece))
    add_problem(out, "the log ends before the program does: it goes on in " + place(piece));
}

}  // namespace aircut::logbook
