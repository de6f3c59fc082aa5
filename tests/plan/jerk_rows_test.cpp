// The loops over the jerk solver's rows are compiled for several instruction sets: the same bits.
#include "plan/jerk_rows.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <vector>

namespace aircut::plan {
namespace {

constexpr std::size_t cells = 23, stride = cells + 1 + 3 * row_lanes, arrays = 3 + 16 + 6 + 9;

// All arrays of one joint, filled at random.
struct Arrays {
  std::vector<double> values = std::vector<double>(arrays * stride);
  Rows acceleration{}, jerk{};
  CellRates rates{};
  NodeValues nodes{};
  RowSums sums{};
  RowTotals totals{};
  RowReach reach{};

  explicit Arrays(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0.1, 1);
    for (double& v : values) v = uniform(random);
    double* at = values.data() + row_lanes;
    const auto next = [&] { return std::exchange(at, at + stride); };
    rates = {next(), next(), next()};
    acceleration = {cells,           0.998, {next(), next()}, {next(), next()}, {next(), next()},
                    {next(), next()}};
    jerk = {cells + 1, 20, {next(), next()}, {next(), next()}, {next(), next()}, {next(), next()}};
    nodes = {next(), next(), next(), next(), next(), next()};
    for (double*& sum : sums.of) sum = next();
  }

  void run(const RowKernels& kernels) {
    kernels.move_acceleration(acceleration, rates, nodes, 0.7, 0.6, 0.1, totals);
    kernels.move_jerk(jerk, rates, nodes, 0.7, 0.6, 0.1, totals);
    kernels.sum_acceleration(acceleration, rates, nodes, 1e-3, sums);
    kernels.sum_jerk(jerk, rates, nodes, 1e-3, sums);
    kernels.aim_acceleration(acceleration, rates, nodes, 1e-3, reach);
    kernels.aim_jerk(jerk, rates, nodes, 1e-3, reach);
  }
};

TEST(JerkRows, AreTheSameBitsWithEveryInstructionSet) {
  const RowKernels* fast = avx2_row_kernels();
  if (!fast) GTEST_SKIP() << "this processor has no AVX2";
  for (unsigned seed = 0; seed < 20; ++seed) {
    Arrays a(seed), b(seed);
    const std::vector<double> before = a.values;
    a.run(portable_row_kernels());
    b.run(*fast);
    EXPECT_NE(a.values, before);
    EXPECT_EQ(std::memcmp(a.values.data(), b.values.data(), a.values.size() * sizeof(double)), 0);
    EXPECT_EQ(std::memcmp(&a.totals, &b.totals, sizeof a.totals), 0);
    EXPECT_EQ(std::memcmp(&a.reach, &b.reach, sizeof a.reach), 0);
  }
}

}  // namespace
}  // namespace aircut::plan
