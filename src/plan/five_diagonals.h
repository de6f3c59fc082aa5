// Private: linear equations whose matrix is symmetric and has five diagonals.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace aircut::plan {

/// A symmetric matrix with five diagonals.
struct FiveDiagonals {
  std::vector<double> d0, d1, d2;
  void clear(std::size_t n) {
    for (std::vector<double>* v : {&d0, &d1, &d2}) v->assign(n, 0);
  }
  /// Makes unknown i what its right side says.
  void pin(std::size_t i) {
    d0[i] = 1;
    d1[i] = d2[i] = 0;
    if (i >= 1) d1[i - 1] = 0;
    if (i >= 2) d2[i - 2] = 0;
  }
  /// By LDLᵀ, in place.
  void solve(std::vector<double>& rhs) {
    const std::size_t n = d0.size();
    for (std::size_t i = 0; i < n; ++i) {
      double pivot = d0[i], off1 = i + 1 < n ? d1[i] : 0;
      const double off2 = i + 2 < n ? d2[i] : 0;
      pivot = std::max(pivot, 1e-300);
      const double l1 = off1 / pivot, l2 = off2 / pivot;
      if (i + 1 < n) {
        d0[i + 1] -= l1 * off1;
        d1[i + 1] -= l1 * off2;
        rhs[i + 1] -= l1 * rhs[i];
      }
      if (i + 2 < n) {
        d0[i + 2] -= l2 * off2;
        rhs[i + 2] -= l2 * rhs[i];
      }
      d0[i] = pivot;
      d1[i] = l1;
      d2[i] = l2;
    }
    for (std::size_t i = n; i-- > 0;) {
      rhs[i] /= d0[i];
      if (i + 1 < n) rhs[i] -= d1[i] * rhs[i + 1];
      if (i + 2 < n) rhs[i] -= d2[i] * rhs[i + 2];
    }
  }
};

}  // namespace aircut::plan
