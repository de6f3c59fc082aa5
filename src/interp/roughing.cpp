// The passes of G71 and G72 as LinuxCNC makes them.
//
// The contour is walked once from the start point. Where it climbs or is level it is followed.
// Where it dives, it is cut down level by level: from the point of the dive at that level straight
// to the next crossing of the contour, out of the cut by the escape, back over the cut and down
// again. The approach dives in rapid from the start point to the first point; that takes off
// everything above the first point. Later dives are pockets: they are cut in the same way, left
// (their mouth is crossed at its level), or are the only thing that is cut.
#include <algorithm>
#include <cmath>
#include <limits>

#include "interp/contour.h"

namespace aircut::interp {
namespace {

constexpr double band = 1e-7;  // mm, levels that close are the same

bool falls(const ContourPiece& part) { return part.end.v < part.start.v - band; }
double distance(PlanePoint a, PlanePoint b) { return std::hypot(a.u - b.u, a.v - b.v); }

class Rougher {
 public:
  Rougher(const Contour& contour, const Roughing& options, std::size_t max_moves)
      : contour_(contour), options_(options), max_moves_(max_moves) {}

  std::optional<std::vector<CutterMove>> run(std::string& problem);

 private:
  void follow(std::size_t at);
  void follow_without_pockets(std::size_t at);
  void dive(std::size_t at, Contour& rest, bool fast);
  void pass(std::size_t at, const Contour& rest, bool fast);
  void along(const ContourPiece& piece, PlanePoint end, bool fast, const char* what);
  void go(bool fast, PlanePoint end, const char* what);
  bool full() const { return moves_.size() > max_moves_; }

  const Contour& contour_;
  const Roughing& options_;
  std::size_t max_moves_;
  std::vector<CutterMove> moves_;
  PlanePoint at_;
  double level_ = 0;
  bool climbed_ = false;  // the way down to the contour lies behind
  double mouth_ = -std::numeric_limits<double>::infinity();  // the highest of the pockets so far
};

void Rougher::go(bool fast, PlanePoint end, const char* what) {
  CutterMove move;
  move.rapid = fast;
  move.end = end;
  move.what = what;
  moves_.push_back(move);
  at_ = end;
}

void Rougher::along(const ContourPiece& piece, PlanePoint end, bool fast, const char* what) {
  if (piece.turn == 0) return go(fast, end, what);
  // An arc to where it starts would be a full circle.
  if (distance(end, at_) < band) return;
  CutterMove move;
  move.end = end;
  move.centre = piece.centre;
  move.turn = piece.turn;
  move.what = what;
  moves_.push_back(move);
  at_ = end;
}

// One cut at the level in force; `rest` is what is left of the diving piece.
void Rougher::pass(std::size_t at, const Contour& rest, bool fast) {
  const PlanePoint start = at_;
  auto end = next_crossing(rest, 0, start.u, level_);
  const auto later = next_crossing(contour_, at + 1, start.u, level_);
  if (!end || (later && *later > *end)) end = later;
  if (!end) return;
  const double e = std::min(options_.escape, (start.u - *end) / 2);  // stays inside a pocket
  go(false, {*end, level_}, "pass");
  go(true, {*end + e, level_ + e}, "out of the cut");
  go(true, {start.u - e, level_ + e}, "back");
  go(fast, start, "to the start of the pass");
}

// The first part of `rest` descends; it is used up level by level.
void Rougher::dive(std::size_t at, Contour& rest, bool fast) {
  ContourPiece& part = rest.front();
  level_ += std::ceil((part.start.v - level_ - band) / options_.depth) * options_.depth;
  if (level_ > part.start.v + band) level_ -= options_.depth;
  while (level_ > part.end.v + band && !full()) {
    const auto where = crossings(part, level_);
    if (where.empty()) break;
    along(part, {where.back(), level_}, fast, "down");
    part.start = at_;
    pass(at, rest, fast);
    level_ -= options_.depth;
  }
}

void Rougher::follow(std::size_t at) {
  const bool approach = at == 0;
  const char* what = approach ? "approach" : "along the contour";
  Contour rest = split_at_v_extremes({contour_[at]});
  while (!rest.empty()) {
    const bool dives = falls(rest.front());
    // Pockets alone: the way down to the contour is not cut, and the levels begin anew at each
    // mouth that is higher than those before.
    const bool skip = dives && options_.pockets == Roughing::Pockets::only && !climbed_;
    if (dives && !skip) {
      if (options_.pockets == Roughing::Pockets::only && at_.v > mouth_ + band)
        level_ = mouth_ = at_.v;
      dive(at, rest, approach);
    }
    const bool climbs_out = dives && rest.size() > 1;  // the rest of an arc in one move
    if (climbs_out) rest.erase(rest.begin());
    along(rest.front(), rest.front().end, dives && approach, what);
    rest.erase(rest.begin());
  }
}

// A dive is left out: the next piece is met where it comes up to the level again.
void Rougher::follow_without_pockets(std::size_t at) {
  for (ContourPiece part : split_at_v_extremes({contour_[at]})) {
    if (part.end.v < at_.v - band || falls(part)) continue;
    if (part.start.v < at_.v - band) {
      const auto up = crossings(part, at_.v);
      if (up.empty()) continue;
      part.start = {up.front(), at_.v};
    }
    go(false, part.start, "over a pocket");
    along(part, part.end, false, "along the contour");
  }
}

std::optional<std::vector<CutterMove>> Rougher::run(std::string& problem) {
  at_ = contour_.front().start;
  level_ = at_.v;
  go(true, at_, "to the start");
  for (std::size_t at = 0; at < contour_.size() && !full(); ++at) {
    const ContourPiece first = split_at_v_extremes({contour_[at]}).front();
    climbed_ = climbed_ || (at > 0 && first.end.v >= first.start.v - band);
    if (climbed_ && options_.pockets == Roughing::Pockets::leave)
      follow_without_pockets(at);
    else
      follow(at);
  }
  if (!full()) return std::move(moves_);
  problem = "it would take more than " + std::to_string(max_moves_) + " moves";
  return std::nullopt;
}

}  // namespace

std::optional<std::vector<CutterMove>> rough(const Contour& contour, const Roughing& options,
                                             std::size_t max_moves, std::string& problem) {
  return Rougher(contour, options, max_moves).run(problem);
}

}  // namespace aircut::interp
