// Roughing of a contour with pockets (type II of G71 and G72 on Fanuc-like controls).
//
// The stock lies above the contour. A pass runs at one level from wall to wall; below a peak of the
// contour the level falls apart into intervals, and each of them is cut to its bottom before the
// next one to its left: first the one that is open to the start point, then the pockets.
//
//          ▓▓▓▓▓▓▓▓▓▓▓▓▓▓▓▓▓▓▓▓● start            1 ◄──────────────────
//     ●──╮ ▓▓▓▓▓ 1 ▓▓▓▓▓▓▓▓▓▓▓▓                  2     ◄───────────────
//        │▓▓▓▓▓▓ 2 ▓▓▓▓▓▓▓▓▓▓▓▓                  3               ◄─────  (open)
//        ╰──╮▓4▓╭────╮▓▓▓▓ 3 ▓▓                  4     ◄───              (pocket)
//           ╰───╯    ╰─────────●
//
// At the end of a pass the tool goes up along the wall to the level of the pass before, so that no
// steps stay, and out by the escape. It enters a pocket along its right-hand wall. Between passes
// it moves above what has been cut: up, aside, down.
#include <algorithm>
#include <cmath>

#include "interp/contour.h"

namespace aircut::interp {
namespace {

constexpr double band = 1e-7;  // mm, levels that close are the same

/// A point of the contour on one of its parts.
struct Spot {
  std::size_t part = 0;
  PlanePoint point;
};

/// A stretch of a level that lies above the contour.
struct Interval {
  int level = 0;
  bool open = false;  ///< to the start point, where there is no wall
  bool ends = false;  ///< with the contour, where there is no wall either
  Spot high, low;     ///< its walls, at larger and at smaller u
};

class PocketRougher {
 public:
  PocketRougher(const Contour& contour, const PocketRoughing& options)
      : parts_(split_at_v_extremes(contour)), options_(options), at_(options.start) {}
  std::optional<std::vector<CutterMove>> run(std::string& problem);

 private:
  double level(int n) const { return options_.start.v - n * options_.depth; }
  std::vector<Interval> intervals(int n) const;
  Spot crossing(std::size_t part, double v) const;
  Spot up_from(Spot spot, double cap) const;
  Spot down_to(Spot spot, double cap) const;
  void pass(const Interval& interval);
  void enter(const Interval& interval);
  void follow(const Spot& from, const Spot& to);
  void go(bool rapid, PlanePoint end, const char* what);

  Contour parts_;  // each of them rises or falls all along
  const PocketRoughing& options_;
  PlanePoint at_;
  std::vector<CutterMove> moves_;
};

void PocketRougher::go(bool rapid, PlanePoint end, const char* what) {
  if (std::hypot(end.u - at_.u, end.v - at_.v) < band) return;
  CutterMove move;
  move.rapid = rapid;
  move.end = end;
  move.what = what;
  moves_.push_back(move);
  at_ = end;
}

Spot PocketRougher::crossing(std::size_t part, double v) const {
  const auto found = crossings(parts_[part], v);
  const ContourPiece& piece = parts_[part];
  if (found.empty()) return {part, piece.end};
  // A part that rises or falls all along crosses a level once.
  return {part, {found.front(), v}};
}

// Walks along the contour and notes where it goes below the level and comes up to it again.
std::vector<Interval> PocketRougher::intervals(int n) const {
  const double v = level(n);
  std::vector<Interval> found;
  Interval now;
  now.level = n;
  bool below = parts_.front().start.v < v - band;
  now.open = below;
  now.high = {0, parts_.front().start};
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const bool ends_below = parts_[i].end.v < v - band;
    if (ends_below == below) continue;
    const Spot where = crossing(i, v);
    if (below) {
      now.low = where;
      found.push_back(now);
    } else {
      now = Interval{};
      now.level = n;
      now.high = where;
    }
    below = ends_below;
  }
  if (below) {
    now.ends = true;
    now.low = {parts_.size() - 1, parts_.back().end};
    found.push_back(now);
  }
  return found;
}

// Up along the wall to the cap, or to the top of the wall.
Spot PocketRougher::up_from(Spot spot, double cap) const {
  for (std::size_t i = spot.part; i < parts_.size(); ++i) {
    if (parts_[i].end.v < parts_[i].start.v + band && i != spot.part) return spot;
    if (parts_[i].end.v > cap) return crossing(i, cap);
    spot = {i, parts_[i].end};
  }
  return spot;
}

// The same on the wall that leads down to the spot.
Spot PocketRougher::down_to(Spot spot, double cap) const {
  for (std::size_t i = spot.part + 1; i-- > 0;) {
    if (parts_[i].end.v > parts_[i].start.v - band && i != spot.part) return spot;
    if (parts_[i].start.v > cap) return crossing(i, cap);
    spot = {i, parts_[i].start};
  }
  return spot;
}

void PocketRougher::follow(const Spot& from, const Spot& to) {
  for (std::size_t i = from.part; i <= to.part; ++i) {
    const ContourPiece& part = parts_[i];
    const PlanePoint end = i == to.part ? to.point : part.end;
    if (part.turn == 0) {
      go(false, end, "along the contour");
      continue;
    }
    // An arc to where it starts would be a full circle.
    if (std::hypot(end.u - at_.u, end.v - at_.v) < band) continue;
    CutterMove move;
    move.end = end;
    move.centre = part.centre;
    move.turn = part.turn;
    move.what = "along the contour";
    moves_.push_back(move);
    at_ = end;
  }
}

// To the begin of the pass: above all that is not cut yet, then down.
void PocketRougher::enter(const Interval& interval) {
  const double cap = level(interval.level - 1);
  // Above the first level nothing is cut, but the start point's level lies outside of the stock.
  const double above = interval.level == 1 ? cap : cap + options_.escape;
  const double clear = std::max(at_.v, above);
  const double v = level(interval.level);
  go(true, {at_.u, clear}, "out of the cut");
  if (interval.open) {
    go(true, {options_.start.u, clear}, "back");
    return go(options_.rapid_down, {options_.start.u, v}, "to depth");
  }
  const Spot wall = down_to(interval.high, cap);
  go(true, {wall.point.u, clear}, "to the pocket");
  go(true, {wall.point.u, above}, "to the pocket");
  go(false, wall.point, "to the wall");
  follow(wall, interval.high);
}

void PocketRougher::pass(const Interval& interval) {
  const double cap = level(interval.level - 1);
  enter(interval);
  go(false, {interval.low.point.u, level(interval.level)}, "pass");
  if (!interval.ends) follow(interval.low, up_from(interval.low, cap));
  go(true, {at_.u, at_.v + options_.escape}, "out of the cut");
}

std::optional<std::vector<CutterMove>> PocketRougher::run(std::string& problem) {
  double lowest = options_.start.v;
  for (const ContourPiece& part : parts_) lowest = std::min({lowest, part.start.v, part.end.v});
  const double levels = (options_.start.v - lowest) / options_.depth;
  if (levels > static_cast<double>(options_.max_moves)) {
    problem = "it would take more than " + std::to_string(options_.max_moves) + " moves";
    return std::nullopt;
  }
  // The intervals of the next level inside one that has been cut; the last one is cut next.
  std::vector<Interval> rest = intervals(1);
  std::reverse(rest.begin(), rest.end());
  while (!rest.empty()) {
    const Interval now = rest.back();
    rest.pop_back();
    pass(now);
    if (moves_.size() > options_.max_moves) {
      problem = "it would take more than " + std::to_string(options_.max_moves) + " moves";
      return std::nullopt;
    }
    std::vector<Interval> inside = intervals(now.level + 1);
    std::reverse(inside.begin(), inside.end());
    for (const Interval& next : inside)
      if (next.high.part >= now.high.part && next.low.part <= now.low.part) rest.push_back(next);
  }
  go(true, {at_.u, std::max(at_.v, options_.start.v)}, "out of the cut");
  return std::move(moves_);
}

}  // namespace

std::optional<std::vector<CutterMove>> rough_pockets(const Contour& contour,
                                                     const PocketRoughing& options,
                                                     std::string& problem) {
  return PocketRougher(contour, options).run(problem);
}

}  // namespace aircut::interp
