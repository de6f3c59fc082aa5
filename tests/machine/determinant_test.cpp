#include "machine/kinematics/determinant.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "base/random.h"

namespace aircut::machine {
namespace {

template <int N>
void compare() {
  Random random(57);
  for (int round = 0; round < 2000; ++round) {
    Eigen::Matrix<double, N, N> m;
    for (int i = 0; i < N * N; ++i) m(i / N, i % N) = random.between(-1, 1);
    EXPECT_NEAR(determinant(m), m.determinant(), 1e-13);
    m.row(N - 1) = m.row(0) - 2 * m.row(1);
    EXPECT_NEAR(determinant(m), 0, 1e-14);
  }
}

TEST(Determinant, IsThatOfAnElimination) {
  compare<5>();
  compare<6>();
}

TEST(Determinant, OfExchangedRowsChangesItsSign) {
  Eigen::Matrix<double, 6, 6> m = Eigen::Matrix<double, 6, 6>::Identity();
  EXPECT_EQ(determinant(m), 1);
  m.row(1).swap(m.row(4));
  EXPECT_EQ(determinant(m), -1);
  Eigen::Matrix<double, 5, 5> five = Eigen::Matrix<double, 5, 5>::Identity();
  EXPECT_EQ(determinant(five), 1);
  five.row(0).swap(five.row(3));
  EXPECT_EQ(determinant(five), -1);
}

}  // namespace
}  // namespace aircut::machine
