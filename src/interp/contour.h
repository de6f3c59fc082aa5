// Contours of lines and arcs in a plane, and how a lathe takes the stock off them: the geometry of
// G70-G73, without words, units or commands.
//
// u runs along the passes, v is the level that they go down. A contour in working orientation has
// its stock at larger v and runs towards smaller u:
//
//        v ▲      ◄── u
//          │  end ●
//          │       ╲___  ▓▓▓▓▓▓▓▓▓▓▓▓● start        a pass keeps v
//          │           ╲_________●   first point    the approach: start → first point
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace aircut::interp {

struct PlanePoint {
  double u = 0, v = 0;
};

/// A line or an arc; `turn` is +1 for an arc that turns from u to v, −1 for the other way, 0 for a
/// line.
struct ContourPiece {
  PlanePoint start, end;
  PlanePoint centre;
  int turn = 0;
  double feed = 0;     ///< of its F word, 0 without
  bool rapid = false;  ///< programmed with G0
};

using Contour = std::vector<ContourPiece>;

/// Which quantities were mirrored to bring a contour into working orientation.
struct Mirror {
  bool u = false, v = false;
};
PlanePoint mirrored(PlanePoint point, Mirror mirror);
ContourPiece mirrored(ContourPiece piece, Mirror mirror);
/// How this contour has to be mirrored: it shall end at smaller u and at larger v than it begins.
Mirror working_orientation(const Contour& contour);

/// Arcs cut where v, or u, has its extremes.
Contour split_at_v_extremes(const Contour& contour);
Contour split_at_u_extremes(const Contour& contour);
/// Index of the first piece that goes back along u, or against v where `v_too`.
std::optional<std::size_t> first_going_back(const Contour& contour, bool v_too);

/// Where the piece has that v, each u once; lines along the level give both ends.
std::vector<double> crossings(const ContourPiece& piece, double v);
/// The nearest crossing of the contour from piece `first` on with u below `u`.
std::optional<double> next_crossing(const Contour& contour, std::size_t first, double u, double v);

/// The curve at `distance` towards the stock (negative: away from it), convex corners rounded;
/// those whose arc would be shorter than `narrow` along u are left sharp. Empty when nothing is
/// left of it.
Contour offset(const Contour& contour, double distance, double narrow = 0);
/// Moved by (du, dv).
Contour shifted(Contour contour, double du, double dv);

/// A line to `end`, rapid or at the feed, or an arc about `centre`.
struct CutterMove {
  bool rapid = false;
  PlanePoint end;
  PlanePoint centre;
  int turn = 0;
  double feed = 0;
  const char* what = "";
};

struct Roughing {
  enum class Pockets { cut, leave, only } pockets = Pockets::cut;
  double depth = 1;   ///< of a pass, > 0
  double escape = 0;  ///< way out of the cut in u and in v
};

/// LinuxCNC's G71 and G72. The contour's first piece is the approach from the start point. Nothing
/// with a message when there would be more moves than `max_moves`, or no end.
std::optional<std::vector<CutterMove>> rough(const Contour& contour, const Roughing& options,
                                             std::size_t max_moves, std::string& problem);

struct PocketRoughing {
  PlanePoint start;         ///< the first level lies `depth` below it; outside of the stock
  double depth = 1;         ///< of a pass, > 0
  double escape = 0;        ///< way up out of the cut, >= 0
  bool rapid_down = false;  ///< to depth at the start point
  std::size_t max_moves = 1'000'000;
};

/// Type II of Fanuc's G71 and G72: a contour that may dip, but does not go back along u. The last
/// move ends above the contour at the start's level or higher. Nothing with a message when there
/// would be more moves than the limit.
std::optional<std::vector<CutterMove>> rough_pockets(const Contour& contour,
                                                     const PocketRoughing& options,
                                                     std::string& problem);

}  // namespace aircut::interp
