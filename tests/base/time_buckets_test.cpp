#include "base/time_buckets.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

namespace aircut {
namespace {

struct Sum {
  double value = 0;
  void merge(const Sum& other) { value += other.value; }
};

double total(const TimeBuckets<Sum>& buckets) {
  return std::accumulate(buckets.values().begin(), buckets.values().end(), 0.0,
                         [](double sum, const Sum& s) { return sum + s.value; });
}

TEST(TimeBuckets, ShareOutWhatALongStretchDid) {
  TimeBuckets<Sum> buckets(100, 1);
  buckets.over(0.5, 2.5, [](Sum& s, double share) { s.value += 8 * share; });
  ASSERT_EQ(buckets.values().size(), 3u);
  EXPECT_DOUBLE_EQ(buckets.values()[0].value, 2);
  EXPECT_DOUBLE_EQ(buckets.values()[1].value, 4);
  EXPECT_DOUBLE_EQ(buckets.values()[2].value, 2);
}

TEST(TimeBuckets, TakeAMomentWithoutAnyTime) {
  TimeBuckets<Sum> buckets(100, 1);
  buckets.over(3, 3, [](Sum& s, double share) { s.value += share; });
  ASSERT_EQ(buckets.values().size(), 4u);
  EXPECT_EQ(buckets.values()[3].value, 1);
}

TEST(TimeBuckets, BecomeWiderAndLoseNothing) {
  // Against the same events put into the final stretches at once.
  std::mt19937 random(7);
  std::uniform_real_distribution<double> some(0, 1);
  TimeBuckets<Sum> buckets(64, 0.01);
  std::vector<std::pair<double, double>> events;
  for (double t = 0; t < 500; t += some(random)) events.emplace_back(t, some(random));
  for (const auto& [t, value] : events)
    buckets.over(t, t, [v = value](Sum& s, double share) { s.value += v * share; });
  ASSERT_LE(buckets.values().size(), 64u);
  std::vector<double> expected(buckets.values().size(), 0.0);
  double sum = 0;
  for (const auto& [t, value] : events) {
    expected[static_cast<std::size_t>(t / buckets.width())] += value;
    sum += value;
  }
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_NEAR(buckets.values()[i].value, expected[i], 1e-9);
  EXPECT_NEAR(total(buckets), sum, 1e-9);
}

}  // namespace
}  // namespace aircut
