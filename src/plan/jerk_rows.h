// Private: the rows of the jerk solver, joint after joint, as loops over plain arrays. The code is
// in jerk_row_loops.h and is compiled once per instruction set; all builds give the same bytes,
// because only +, −, ×, ÷ and comparisons are used, and sums are made in four lanes everywhere.
#pragma once

#include <cstddef>

namespace aircut::plan {

inline constexpr std::size_t row_lanes = 4;

// Arrays have places 0 … n − 1; place −1, and a group of lanes behind the last place, can be read
// and written too. Plain pointers, so that no inline function of a library is compiled for one
// instruction set only.

/// |l| ≤ R at `count` places for one joint: slacks s and multipliers m of both sides (+l ≤ R and
/// −l ≤ R), and their steps. Acceleration: l = Q, R = `limit`. Jerk: l = Q_k − Q_{k−1}, R = `limit`
/// times the row's time.
struct Rows {
  std::size_t count;
  double limit;
  double *s[2], *m[2], *ds[2], *dm[2];
};

/// Q = p b_k + r b_{k+1} of one joint in cell k.
struct CellRates {
  double *p, *r, *q;
};

/// What the rows of all joints share, by node; `time` of the jerk rows with its derivatives by the
/// nodes k − 1, k, k + 1.
struct NodeValues {
  double *b, *step, *time, *t0, *t1, *t2;
};

/// Sums over all rows at place k: of the matrix' elements (k−1, k−1), (k, k), (k+1, k+1),
/// (k−1, k), (k, k+1), (k−1, k+1), and of the right side's k − 1, k, k + 1.
struct RowSums {
  double* of[9];
};

struct RowTotals {
  double product[row_lanes];    ///< Σ s m
  double violation[row_lanes];  ///< largest (l − R) / R
};
/// Largest −ds / s and −dm / m.
struct RowReach {
  double primal[row_lanes], dual[row_lanes];
};

struct RowKernels {
  /// Takes the steps times `primal` and `dual`; then no slack is below what the row leaves, nor
  /// below `least` R. Those of acceleration also find Q.
  void (*move_acceleration)(const Rows&, const CellRates&, const NodeValues&, double primal,
                            double dual, double least, RowTotals&);
  void (*move_jerk)(const Rows&, const CellRates&, const NodeValues&, double primal, double dual,
                    double least, RowTotals&);
  void (*sum_acceleration)(const Rows&, const CellRates&, const NodeValues&, double mu,
                           const RowSums&);
  void (*sum_jerk)(const Rows&, const CellRates&, const NodeValues&, double mu, const RowSums&);
  /// Steps of slacks and multipliers from the nodes' steps.
  void (*aim_acceleration)(const Rows&, const CellRates&, const NodeValues&, double mu, RowReach&);
  void (*aim_jerk)(const Rows&, const CellRates&, const NodeValues&, double mu, RowReach&);
};

const RowKernels& portable_row_kernels();
/// Null where the processor can't run them.
const RowKernels* avx2_row_kernels();

}  // namespace aircut::plan
