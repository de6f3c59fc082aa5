// Cutter radius compensation (G41, G42). See compensation.cpp for the geometry.
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "canon/canon.h"
#include "canon/way.h"
#include "interp/state.h"

namespace aircut::interp {

class BlockRun;

/// A straight move or an arc as programmed, before compensation.
struct PlannedMove {
  enum class Kind : unsigned char { rapid, feed, arc } kind = Kind::feed;
  AxisValues end;      ///< tip, machine coordinates
  canon::ArcFeed arc;  ///< of an arc; its `end` is the same
  double rate = 0;     ///< inverse time: mm/s, or rad/s, along the programmed way; else 0
};

/// Holds back the last compensated move until the next one says where it really ends.
class Compensator {
 public:
  bool holds() const { return !held_.empty(); }
  void hold(canon::Command command) { held_.push_back(std::move(command)); }

  /// Compensates the move and emits what has become final. The state's tip is updated. Errors go
  /// to the run.
  void move(BlockRun& run, const PlannedMove& planned);
  /// Emits everything that is held back (G40, program end).
  void flush(BlockRun& run);
  /// Does the same where no move follows, unless the last one has no room.
  void finish(BlockRun& run);
  /// A held move that has no room, which has been told, makes no further errors. False without one.
  bool excuse_held();
  /// What parameters tell of the position.
  AxisValues told_position(const ModalState& state) const;
  /// Forgets everything: G41 or G42 was given.
  void start();

 private:
  struct Point {
    double a = 0, b = 0;
    Point operator+(Point o) const { return {a + o.a, b + o.b}; }
    Point operator-(Point o) const { return {a - o.a, b - o.b}; }
    friend Point operator*(double f, Point p) { return {f * p.a, f * p.b}; }
  };
  /// A move of the tool's centre in the plane.
  struct Path {
    bool is_arc = false;
    bool entry = false;    ///< the move that begins compensation
    bool excused = false;  ///< it runs backwards, and that has been told
    Point start, end;
    Point centre;       ///< arcs only
    double radius = 0;  ///< arcs only
    bool left_turn = false;
    double sweep = 0;                ///< arcs only: the angle before corners cut it
    Point direction;                 ///< lines only: of the contour
    Point start_normal, end_normal;  ///< unit, from the contour to the tool's centre
  };

  static double dot(Point p, Point q) { return p.a * q.a + p.b * q.b; }
  static double cross(Point p, Point q) { return p.a * q.b - p.b * q.a; }
  static double norm(Point p) { return std::hypot(p.a, p.b); }

  void leave(BlockRun& run, const PlannedMove& planned);
  std::optional<Path> entry_path(BlockRun& run, const PlannedMove& planned, Point from, Point to);
  std::optional<Path> next_path(BlockRun& run, const PlannedMove& planned, Point from, Point to);
  bool join(BlockRun& run, const PlannedMove& planned, Path& next, Point corner);
  void end_held_at(BlockRun& run, Point at);
  bool meet_inside(BlockRun& run, Path& next, Point corner);
  std::vector<Point> intersections(const Path& first, const Path& second) const;
  double sweep_of(const Path& arc) const;
  bool still_forward(const Path& path) const;
  bool runs_back(const Path& path) const;
  std::optional<canon::SetFeedRate> pace(const PlannedMove& planned, canon::Way way) const;
  void emit_path(BlockRun& run, const PlannedMove& planned, const Path& path);
  void plain(BlockRun& run, const PlannedMove& planned);
  void stay(BlockRun& run, const PlannedMove& planned);

  Point point_of(const ModalState& state, const AxisValues& tip) const;
  AxisValues tip_of(const ModalState& state, const AxisValues& like, Point centre) const;
  Point nose_shift(const ModalState& state) const;
  double side_sign(const ModalState& state) const;

  std::vector<canon::Command> held_;  ///< first the move whose end is not final, and its pace
  AxisValues held_start_;             ///< of that move
  double held_rate_ = 0;              ///< of that move: PlannedMove::rate
  std::optional<Path> last_;          ///< of held_[0], or of the last move that was emitted
};

}  // namespace aircut::interp
