// The loops of jerk_rows.h, four places at a time. Included by the files that compile it, inside of
// their own namespace.

// NOLINTNEXTLINE(modernize-use-using): `using` can't carry the attribute
typedef double Lanes __attribute__((vector_size(row_lanes * sizeof(double))));

inline Lanes load(const double* from) {
  Lanes out;
  __builtin_memcpy(&out, from, sizeof out);
  return out;
}
inline void store(double* to, const Lanes& value) { __builtin_memcpy(to, &value, sizeof value); }
inline void add(double* to, const Lanes& value) { store(to, load(to) + value); }
inline Lanes larger(const Lanes& a, const Lanes& b) { return a > b ? a : b; }

// What a row touches at four places: l, R, and their derivatives by the nodes k − 1, k, k + 1.
template <bool jerk>
struct RowGroup {
  Lanes l, limit, l0, l1, l2, g0, g1, g2;

  RowGroup(const Rows& rows, const CellRates& cells, const NodeValues& nodes, std::size_t k) {
    const double *p = cells.p + k, *r = cells.r + k, *q = cells.q + k;
    if constexpr (jerk) {
      l = load(q) - load(q - 1);
      limit = rows.limit * load(nodes.time + k);
      l0 = -load(p - 1);
      l1 = load(p) - load(r - 1);
      l2 = load(r);
      g0 = rows.limit * load(nodes.t0 + k);
      g1 = rows.limit * load(nodes.t1 + k);
      g2 = rows.limit * load(nodes.t2 + k);
    } else {
      l = load(q);
      limit = Lanes{} + rows.limit;
      l1 = load(p);
      l2 = load(r);
      l0 = g0 = g1 = g2 = Lanes{};
    }
  }
};

template <bool jerk>
void move_rows(const Rows& rows, const CellRates& cells, const NodeValues& nodes, double primal,
               double dual, double least, RowTotals& totals) {
  Lanes product = load(totals.product), violation = load(totals.violation);
  for (std::size_t k = 0; k < rows.count; k += row_lanes) {
    if constexpr (!jerk)
      store(cells.q + k,
            load(cells.p + k) * load(nodes.b + k) + load(cells.r + k) * load(nodes.b + k + 1));
    const RowGroup<jerk> row(rows, cells, nodes, k);
    const Lanes over = 1 / row.limit;
    for (std::size_t side = 0; side < 2; ++side) {
      const Lanes left = side == 0 ? row.limit - row.l : row.limit + row.l;
      double *s = rows.s[side] + k, *m = rows.m[side] + k;
      const Lanes slack =
          larger(larger(load(s) + primal * load(rows.ds[side] + k), left), least * row.limit);
      const Lanes multiplier = load(m) + dual * load(rows.dm[side] + k);
      violation = larger(-left * over, violation);
      product += slack * multiplier;
      store(s, slack);
      store(m, multiplier);
    }
  }
  store(totals.product, product);
  store(totals.violation, violation);
}

template <bool jerk>
void sum_rows(const Rows& rows, const CellRates& cells, const NodeValues& nodes, double mu,
              const RowSums& sums) {
  for (std::size_t k = 0; k < rows.count; k += row_lanes) {
    const RowGroup<jerk> row(rows, cells, nodes, k);
    const Lanes s0 = load(rows.s[0] + k), s1 = load(rows.s[1] + k);
    const Lanes over0 = 1 / s0, over1 = 1 / s1;
    const Lanes w0 = load(rows.m[0] + k) * over0, w1 = load(rows.m[1] + k) * over1;
    const Lanes z0 = mu * over0 + w0 * (row.l - row.limit + s0);
    const Lanes z1 = mu * over1 + w1 * (s1 - row.l - row.limit);
    const Lanes w = w0 + w1, skew = w0 - w1, push = z0 - z1, pull = z0 + z1;
    if constexpr (jerk) {
      const Lanes wl0 = w * row.l0 - skew * row.g0, wg0 = w * row.g0 - skew * row.l0;
      const Lanes wl1 = w * row.l1 - skew * row.g1, wg1 = w * row.g1 - skew * row.l1;
      const Lanes wl2 = w * row.l2 - skew * row.g2, wg2 = w * row.g2 - skew * row.l2;
      add(sums.of[0] + k, wl0 * row.l0 + wg0 * row.g0);
      add(sums.of[1] + k, wl1 * row.l1 + wg1 * row.g1);
      add(sums.of[2] + k, wl2 * row.l2 + wg2 * row.g2);
      add(sums.of[3] + k, wl0 * row.l1 + wg0 * row.g1);
      add(sums.of[4] + k, wl1 * row.l2 + wg1 * row.g2);
      add(sums.of[5] + k, wl0 * row.l2 + wg0 * row.g2);
      add(sums.of[6] + k, push * row.l0 - pull * row.g0);
      add(sums.of[7] + k, push * row.l1 - pull * row.g1);
      add(sums.of[8] + k, push * row.l2 - pull * row.g2);
    } else {
      add(sums.of[1] + k, w * row.l1 * row.l1);
      add(sums.of[2] + k, w * row.l2 * row.l2);
      add(sums.of[4] + k, w * row.l1 * row.l2);
      add(sums.of[7] + k, push * row.l1);
      add(sums.of[8] + k, push * row.l2);
    }
  }
}

template <bool jerk>
void aim_rows(const Rows& rows, const CellRates& cells, const NodeValues& nodes, double mu,
              RowReach& reach) {
  Lanes primal = load(reach.primal), dual = load(reach.dual);
  for (std::size_t k = 0; k < rows.count; k += row_lanes) {
    const RowGroup<jerk> row(rows, cells, nodes, k);
    const double* step = nodes.step + k;
    Lanes change = row.l1 * load(step) + row.l2 * load(step + 1), widen{};
    if constexpr (jerk) {
      change += row.l0 * load(step - 1);
      widen = row.g0 * load(step - 1) + row.g1 * load(step) + row.g2 * load(step + 1);
    }
    for (std::size_t side = 0; side < 2; ++side) {
      const Lanes s = load(rows.s[side] + k), m = load(rows.m[side] + k);
      const Lanes left = side == 0 ? row.limit - row.l - change : row.limit + row.l + change;
      const Lanes over = 1 / s;
      const Lanes ds = left + widen - s;
      const Lanes dm = (mu - m * ds) * over - m;
      primal = larger(-ds * over, primal);
      dual = larger(-dm / m, dual);
      store(rows.ds[side] + k, ds);
      store(rows.dm[side] + k, dm);
    }
  }
  store(reach.primal, primal);
  store(reach.dual, dual);
  // The places behind the last one are no rows.
  for (double* dm : rows.dm)
    for (std::size_t k = rows.count; k % row_lanes != 0; ++k) dm[k] = 0;
}

constexpr RowKernels row_kernels = {move_rows<false>, move_rows<true>, sum_rows<false>,
                                    sum_rows<true>,   aim_rows<false>, aim_rows<true>};
