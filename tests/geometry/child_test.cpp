#include "geometry/child.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace aircut::geometry {
namespace {

TEST(Child, SendsItsResult) {
  const std::string large(3'000'000, 'x');
  EXPECT_EQ(run_in_child([&] { return large + "y"; }, {}).value(), large + "y");
}

TEST(Child, CanCrashWithoutHarm) {
  const auto result = run_in_child([]() -> std::string { std::abort(); }, {});
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().find("crashed"), std::string::npos);
}

TEST(Child, IsEndedWhenItRunsTooLong) {
  const auto endless = []() -> std::string {
    volatile bool go = true;
    while (go) {
    }
    return {};
  };
  const auto result = run_in_child(endless, {.cpu_seconds = 1});
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().find("more than 1 s"), std::string::npos);
}

}  // namespace
}  // namespace aircut::geometry
