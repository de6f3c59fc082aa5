// A piece of a segment against the segment itself: the same tip, speed and acceleration at the same
// time.
#include "plan/part.h"

#include <gtest/gtest.h>

#include "support/plan_machines.h"

namespace aircut::test {
namespace {

struct At {
  AxisValues p;
  double v = 0, a = 0, u = 0;
};

At at(const plan::Segment& segment, double t) {
  const auto state = segment.profile.at(t - segment.t_start);
  const double length = plan::length(segment.path);
  const double u = length > 0 ? state.s / length : 0;
  return {plan::evaluate(segment.path, state.s).p, state.v, state.a,
          segment.u0 + u * (segment.u1 - segment.u0)};
}

TEST(Part, MovesAsTheWholeSegmentDoesAtThatTime) {
  for (const double jerk : {std::numeric_limits<double>::infinity(), 5000.}) {
    const auto machine = identity_machine(
        "XYZC", {{200, 1000, jerk}, {200, 1000, jerk}, {200, 1000, jerk}, {360, 2000, 10 * jerk}});
    Program program;
    AxisValues end = xyz(20, 30, -4);
    end[Axis::c] = 1;
    program.feed(40).blend(0.5).line(xyz(30, 0, 0)).line(xyz(30, 20, 0));
    program.arc(xyz(10, 20, -6), 20, 20).line(end).rapid(xyz(0, 0, 0));
    const Planned planned = plan_program(*machine, zeros(*machine), program);
    ASSERT_TRUE(planned.errors.empty());
    int blends = 0, arcs = 0;
    for (const plan::Segment& segment : planned.segments) {
      if (!(segment.duration() > 0)) continue;
      blends += segment.kind == plan::MotionKind::blend;
      arcs += segment.kind == plan::MotionKind::arc;
      for (const auto& [from, to] : {std::pair(0.0, 0.4), {0.31, 0.77}, {0.5, 1.0}, {0.2, 0.2}}) {
        const double ta = segment.t_start + from * segment.duration();
        const double tb = to == 1 ? segment.t_end() : segment.t_start + to * segment.duration();
        const auto part = plan::part_of(segment, ta, tb);
        ASSERT_TRUE(part);
        EXPECT_DOUBLE_EQ(part->t_start, ta);
        EXPECT_NEAR(part->duration(), tb - ta, 1e-12);
        for (int i = 1; i < 10; ++i) {
          const double t = ta + (tb - ta) * i / 10;
          const At whole = at(segment, t), here = at(*part, t);
          for (const Axis axis : all_axes) EXPECT_NEAR(here.p[axis], whole.p[axis], 1e-9);
          if (to == from) continue;
          EXPECT_NEAR(here.v, whole.v, 1e-9);
          EXPECT_NEAR(here.a, whole.a, 1e-6);
          EXPECT_NEAR(here.u, whole.u, 1e-9);
        }
      }
    }
    EXPECT_GT(blends, 0);
    EXPECT_GT(arcs, 0);
  }
}

}  // namespace
}  // namespace aircut::test
