// Private: the tool path for the pictures, as a polyline of bounded size.
#pragma once

#include <vector>

#include "render/render.h"
#include "sim/sim.h"

namespace aircut::report {

/// When it is full, every second point goes and the spacing doubles.
class PathRecorder {
 public:
  void add(const sim::Step& step);
  /// Runs of one kind in world coordinates, split at time `now` into done and to come.
  std::vector<render::DrawLine> lines(const Pose& X_WM, double now) const;
  /// The same in colours of the time at which they are gone, from violet to yellow.
  std::vector<render::DrawLine> lines_by_time(const Pose& X_WM) const;
  /// What these colours mean.
  std::vector<render::LegendRow> legend_of_times() const;
  /// Of the feed moves, world; of all moves when there are none.
  Box3 box(const Pose& X_WM) const;

 private:
  struct Point {
    Vec3 p;  ///< M coordinates, mm
    double t = 0;
    plan::MotionKind kind = plan::MotionKind::idle;
  };
  void push(const Point& point);

  std::vector<Point> points_;
  double spacing_ = 0.01;  ///< mm
};

}  // namespace aircut::report
