#include "stock/kernel.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "stock/outline.h"

namespace aircut::stock {
namespace {

LocalSweep random_sweep(const ShapeF& shape, std::mt19937& random, int kind) {
  const auto uniform = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  LocalSweep out{};
  out.shape = &shape;
  out.pitch = 0.1;
  for (double& f : out.foot) f = uniform(-3, 4);
  const double angle = kind % 5 == 0 ? 0 : uniform(-3.2, 3.2);
  out.u[0] = std::cos(angle);
  out.u[1] = std::sin(angle);
  if (kind % 3 == 0) {
    out.rise = uniform(0, 2);
  } else {
    out.slope = kind % 3 == 1 ? 0 : std::pow(10, uniform(-6, 1)) * (kind % 2 ? 1 : -1);
    out.s0 = uniform(-5, 0);
    out.s1 = uniform(0, 5);
  }
  return out;
}

TEST(Kernels, GiveTheSameBytesWithEveryInstructionSet) {
  const Kernels* fast = avx2_kernels();
  if (!fast) GTEST_SKIP() << "this processor has no AVX2";
  std::mt19937 random(1);
  for (const CutterProfile& cutter :
       {*CutterProfile::flat(6, 2), *CutterProfile::ball(5, 4), *CutterProfile::bull(7, 1.2, 5),
        *CutterProfile::cone(1, 8, 3, 20)}) {
    const ShapeF& shape = cutter.bodies().front().floats();
    for (int n = 0; n < 300; ++n) {
      const LocalSweep sweep = random_sweep(shape, random, n);
      const int row = n % cells;
      std::uint16_t lo[cells], hi[cells];
      for (int i = 0; i < cells; ++i) {
        lo[i] = static_cast<std::uint16_t>(random() % 61440);
        hi[i] = static_cast<std::uint16_t>(random() % 61441);
      }
      Chords a[2], b[2];
      std::memset(a, 0, sizeof a);
      std::memset(b, 0, sizeof b);
      const Family f = n % 2 ? Family::x : Family::y;
      EXPECT_EQ(portable_kernels().upright(sweep, row, lo, hi, a[0]),
                fast->upright(sweep, row, lo, hi, b[0]));
      EXPECT_EQ(portable_kernels().level(sweep, f, row, lo, hi, a[1]),
                fast->level(sweep, f, row, lo, hi, b[1]));
      EXPECT_EQ(std::memcmp(a, b, sizeof a), 0) << n;
      std::uint16_t lo2[cells], hi2[cells];
      std::memcpy(lo2, lo, sizeof lo);
      std::memcpy(hi2, hi, sizeof hi);
      RowChange p, q;
      portable_kernels().take(lo, hi, a[n % 2], p);
      fast->take(lo2, hi2, a[n % 2], q);
      EXPECT_EQ(std::memcmp(lo, lo2, sizeof lo), 0);
      EXPECT_EQ(std::memcmp(hi, hi2, sizeof hi), 0);
      EXPECT_EQ(std::memcmp(&p, &q, sizeof p), 0);
    }
  }
}

TEST(Kernels, GiveTheSameEndsInAnyDirectionWithEveryInstructionSet) {
  if (!avx2_kernels()) GTEST_SKIP() << "this processor has no AVX2";
  std::mt19937 random(2);
  std::uniform_real_distribution<double> number(-1, 1);
  for (int n = 0; n < 2000; ++n) {
    TiltedBand band{};
    for (double* const x : {&band.zu, &band.zd, &band.growth, &band.radius, &band.ru, &band.rd})
      *x = number(random);
    band.z0 = -1 + number(random);
    band.z1 = 1 + number(random);
    band.ball = n % 3 == 0;
    band.along_ray = n % 2 == 0;
    band.A = 0.5 + 0.4 * number(random);
    band.B = number(random);
    band.C = n % 5 == 0 ? 0 : 0.5 + 0.4 * number(random);
    band.per_A = 1 / band.A;
    if (band.C != 0) {
      band.per_C = 1 / band.C;
      band.hull = band.A - band.B * band.B * band.per_C;
      band.per_hull = 1 / band.hull;
    }
    band.q = number(random);
    band.border = number(random);
    band.per_border = 1 / band.border;
    TiltedRow row{};
    row.pitch = 0.1;
    row.quantum = 0.1 / quanta_per_cell;
    row.u = number(random);
    row.across = number(random);
    row.square = 2 + number(random);
    row.z = number(random);
    row.z_l = 0.3 * number(random);
    row.z_u = 0.3 * number(random);
    row.d = number(random);
    row.d_l = number(random);
    row.low = -3;
    row.high = 3;
    row.radius = 2 + number(random);
    row.seen = 0.9;
    std::uint16_t lo[cells], hi[cells];
    for (int i = 0; i < cells; ++i) {
      lo[i] = static_cast<std::uint16_t>(random() % 61440);
      hi[i] = static_cast<std::uint16_t>(random() % 61441);
    }
    TiltedEnds a, b;
    std::memset(&a, 0, sizeof a);
    std::memset(&b, 0, sizeof b);
    const std::uint32_t lanes = portable_kernels().tilted(&band, 1, row, lo, hi, a);
    ASSERT_EQ(lanes, avx2_kernels()->tilted(&band, 1, row, lo, hi, b)) << n;
    for (int i = 0; i < cells; ++i) {
      if ((lanes >> i & 1) == 0) continue;
      for (const auto end : {&TiltedEnds::a, &TiltedEnds::b}) {
        EXPECT_EQ(std::memcmp(&(a.*end).tau[i], &(b.*end).tau[i], sizeof(double)), 0) << n;
        EXPECT_EQ(std::memcmp(&(a.*end).t[i], &(b.*end).t[i], sizeof(double)), 0) << n;
        EXPECT_EQ((a.*end).place[i], (b.*end).place[i]) << n;
      }
    }
  }
}

}  // namespace
}  // namespace aircut::stock
