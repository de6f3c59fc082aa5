// No kinematics asks for memory while it solves: counted by an operator new of this test program.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "samples.h"

namespace {
std::atomic<long> allocations{0};  // this program's, all threads

void* counted(std::size_t size) {
  ++allocations;
  if (void* p = std::malloc(size > 0 ? size : 1)) return p;
  throw std::bad_alloc();
}
}  // namespace

void* operator new(std::size_t size) { return counted(size); }
void* operator new[](std::size_t size) { return counted(size); }
void operator delete(void* p) noexcept { std::free(p); }
void operator delete[](void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t) noexcept { std::free(p); }

namespace aircut::machine {
namespace {

TEST(Allocations, AreCounted) {
  const long before = allocations;
  const auto something = std::make_unique<int>(1);
  EXPECT_EQ(allocations, before + 1);
}

TEST(Allocations, NoKinematicsMakesAnyWhenItSolves) {
  for (const Sample& sample : samples()) {
    SCOPED_TRACE(sample.name);
    const Kinematics& kinematics = *sample.kinematics;
    Random random(5);
    std::vector<double> passive(static_cast<std::size_t>(kinematics.passive_count()));
    for (int i = 0; i < 20; ++i) {
      const Target target = with_tool(random_tip(sample, random), sample.tools ? 40 : 0);
      const JointVector near = sample.start();
      AxisValues d;
      d[Axis::x] = 1;
      JointVector dq, ddq;
      const long before = allocations;
      const auto q = kinematics.inverse(target, near);
      const long inverse = allocations - before;
      ASSERT_TRUE(q);
      const auto tip = kinematics.forward(*q, target.tool_offset);
      const long forward = allocations - before - inverse;
      ASSERT_TRUE(tip);
      kinematics.rates(target, *q, d, {}, dq, ddq);
      if (!passive.empty()) kinematics.passive(*q, passive);
      const long rest = allocations - before - inverse - forward;
      EXPECT_EQ(inverse, 0) << "inverse";
      EXPECT_EQ(forward, 0) << "forward";
      EXPECT_EQ(rest, 0) << "rates and passive values";
    }
  }
}

}  // namespace
}  // namespace aircut::machine
