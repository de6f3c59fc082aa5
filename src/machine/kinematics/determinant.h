// Determinants of 5 × 5 and 6 × 6 matrices without a division or a choice of pivots, so that they
// cost a fraction of an elimination:
//
//   det M = Σ ± |rows 0 … k−1, columns S| · |the last three rows, the other columns|
//
// over all sets S of k columns (Laplace's expansion), k = 2 or 3; the sign is that of the sum of
// the columns in S and 0 + 1 + … + (k − 1). Minors of three rows are made of those of two.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

namespace aircut::machine {

/// Minors of three rows: by the bits of their three columns.
template <int N>
class MinorsOf3 {
 public:
  template <class Matrix>
  MinorsOf3(const Matrix& m, int row) {
    const auto at = [&](int r, int c) { return m(row + r, c); };
    std::array<std::array<double, N>, N> pair{};
    for (int i = 0; i < N; ++i)
      for (int j = i + 1; j < N; ++j)
        pair[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] =
            at(1, i) * at(2, j) - at(1, j) * at(2, i);
    const auto of = [&](int i, int j) {
      return pair[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
    };
    for (int a = 0; a < N; ++a)
      for (int b = a + 1; b < N; ++b)
        for (int c = b + 1; c < N; ++c)
          minor_[(1u << a) | (1u << b) | (1u << c)] =
              at(0, a) * of(b, c) - at(0, b) * of(a, c) + at(0, c) * of(a, b);
  }
  double operator[](unsigned columns) const { return minor_[columns]; }

 private:
  std::array<double, 1u << N> minor_;  // only those of three columns are filled in
};

inline double determinant(const Eigen::Matrix<double, 5, 5>& m) {
  const MinorsOf3<5> lower(m, 2);
  double sum = 0;
  for (int a = 0; a < 5; ++a)
    for (int b = a + 1; b < 5; ++b) {
      const double upper = m(0, a) * m(1, b) - m(0, b) * m(1, a);
      const double sign = (1 + a + b) % 2 ? -1 : 1;
      sum += sign * upper * lower[31u & ~((1u << a) | (1u << b))];
    }
  return sum;
}

inline double determinant(const Eigen::Matrix<double, 6, 6>& m) {
  const MinorsOf3<6> upper(m, 0), lower(m, 3);
  double sum = 0;
  for (int a = 0; a < 6; ++a)
    for (int b = a + 1; b < 6; ++b)
      for (int c = b + 1; c < 6; ++c) {
        const unsigned columns = (1u << a) | (1u << b) | (1u << c);
        const double sign = (3 + a + b + c) % 2 ? -1 : 1;
        sum += sign * upper[columns] * lower[63u & ~columns];
      }
  return sum;
}

}  // namespace aircut::machine
