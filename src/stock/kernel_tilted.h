// The ends of chords through a sweep in any direction, several rays at once, in double precision.
// Private to stock; included only by the files that compile lanes.h, inside of their own namespace.
// The formulas are told in tilted.cpp.

typedef double D __attribute__((vector_size(AIRCUT_LANE_BYTES)));
typedef std::int64_t L __attribute__((vector_size(AIRCUT_LANE_BYTES)));
constexpr int per_double = AIRCUT_LANE_BYTES / 8;
constexpr double same_height = 1e-9;  // mm, of comparisons
constexpr double no_square = 1e-14;   // a coefficient below is none

inline D every(double value) { return D{} + value; }
/// Quanta of the vector's lanes, as numbers.
inline D load_quanta(const std::uint16_t* from) {
  D out;
  for (int i = 0; i < per_double; ++i) out[i] = from[i];
  return out;
}
inline std::uint32_t bits_of(const L& mask) {
#if defined(__AVX2__)
  return static_cast<std::uint32_t>(_mm256_movemask_pd((__m256d)mask));
#elif defined(__SSE2__)
  return static_cast<std::uint32_t>(_mm_movemask_pd((__m128d)mask));
#else
  std::uint32_t out = 0;
  for (int i = 0; i < per_double; ++i) out |= (mask[i] != 0 ? 1u : 0u) << i;
  return out;
#endif
}
inline bool any(const L& mask) { return bits_of(mask) != 0; }
inline D square_root(const D& a) {
#if defined(__AVX2__)
  return (D)_mm256_sqrt_pd((__m256d)a);
#elif defined(__SSE2__)
  return (D)_mm_sqrt_pd((__m128d)a);
#else
  D out;
  for (int i = 0; i < per_double; ++i) out[i] = __builtin_sqrt(a[i]);
  return out;
#endif
}

/// Roots of a x² + 2 b x + c with 1/a known; masks of those that there are.
struct Roots {
  D x[2];
  L is[2];
};
inline Roots roots(double a, double per_a, const D& b, const D& c) {
  Roots out;
  if (__builtin_fabs(a) < no_square) {
    const D size = b < 0 ? -b : b;
    out.x[0] = out.x[1] = -c / (2 * b);
    out.is[0] = size >= no_square;
    out.is[1] = L{};
    return out;
  }
  const D q = b * b - a * c;
  out.is[0] = q >= 0;
  const D r = square_root(out.is[0] ? q : D{});
  const D s = b < 0 ? r - b : -r - b;  // no cancellation
  out.x[0] = s * per_a;
  out.x[1] = c / s;
  out.is[1] = out.is[0] & (s != 0);
  return out;
}

struct TiltedVector {
  D z, u, d, square;  ///< of the rays, of the rays' origins
  D a, a_t, b, b_t;   ///< the ends so far
  L a_place = L{}, b_place = L{};

  void offer(const D& tau, const D& t, std::int64_t place, const L& is) {
    const L first = is & (tau < a), last = is & (tau > b);
    const L here = L{} + place;
    a = first ? tau : a;
    a_t = first ? t : a_t;
    a_place = first ? here : a_place;
    b = last ? tau : b;
    b_t = last ? t : b_t;
    b_place = last ? here : b_place;
  }

  void look_at(const TiltedBand& band, std::int64_t number) {
    const auto place = [&](TiltedPlace p) { return number * 8 + static_cast<std::int64_t>(p); };
    const double A = band.A, B = band.B, C = band.C;
    D E, G, H;
    if (band.ball) {
      E = u - band.f * band.zu;
      G = band.f * band.zd - d;
      H = square - 2 * band.f * z + band.f * band.f - band.radius * band.radius;
    } else {
      const D r = band.radius + band.growth * z;
      E = u - band.zu * z - r * band.ru;
      G = r * band.rd - (d - band.zd * z);
      H = square - z * z - r * r;
    }
    const auto in_strip = [&](const D& tau, const D& t) {
      const D height = z + band.zu * tau - band.zd * t;
      return (height >= band.z0 - same_height) & (height <= band.z1 + same_height);
    };
    if (band.per_C != 0) {
      const Roots x =
          roots(band.hull, band.per_hull, E - (B * band.per_C) * G, H - G * G * band.per_C);
      if (any(x.is[0] | x.is[1]))
        for (int i = 2; i-- > 0;) {
          const D t = (B * x.x[i] + G) * -band.per_C;
          offer(x.x[i], t, place(TiltedPlace::side),
                x.is[i] & (t >= 0) & (t <= 1) & in_strip(x.x[i], t));
        }
    }
    for (const double end : {0.0, 1.0}) {
      const D t = every(end), b_half = B * end + E, c = C * end * end + 2 * end * G + H;
      const Roots x = roots(A, band.per_A, b_half, c);
      if (any(x.is[0] | x.is[1]))
        for (int i = 2; i-- > 0;)
          offer(x.x[i], t, place(TiltedPlace::side), x.is[i] & in_strip(x.x[i], t));
      if (__builtin_fabs(band.zu) <= 1e-12) continue;
      for (const TiltedPlace face : {TiltedPlace::low_face, TiltedPlace::high_face}) {
        const double height = (face == TiltedPlace::low_face ? band.z0 : band.z1) + band.zd * end;
        const D tau = (height - z) * (1 / band.zu);
        offer(tau, t, place(face), (A * tau + 2 * b_half) * tau + c <= same_height);
      }
    }
    if (band.border == 0) return;
    for (const TiltedPlace edge : {TiltedPlace::low_edge, TiltedPlace::high_edge}) {
      const double height = edge == TiltedPlace::low_edge ? band.z0 : band.z1;
      if (band.along_ray) {
        const D p = (height - z) * (1 / band.zu);
        const Roots x = roots(band.border, band.per_border, (A * band.q + B) * p + band.q * E + G,
                              (A * p + 2 * E) * p + H);
        if (!any(x.is[0] | x.is[1])) continue;
        for (int i = 2; i-- > 0;)
          offer(p + band.q * x.x[i], x.x[i], place(edge), x.is[i] & (x.x[i] >= 0) & (x.x[i] <= 1));
      } else {
        const D p = (z - height) * (1 / band.zd);
        const Roots x = roots(band.border, band.per_border, (B + C * band.q) * p + E + band.q * G,
                              (C * p + 2 * G) * p + H);
        if (!any(x.is[0] | x.is[1])) continue;
        for (int i = 2; i-- > 0;) {
          const D t = p + band.q * x.x[i];
          offer(x.x[i], t, place(edge), x.is[i] & (t >= 0) & (t <= 1));
        }
      }
    }
  }
};

/// Lanes of which nothing between two heights over their origins is touched; the bound keeps more
/// margin than rounding.
inline L misses(const TiltedRow& row, const D& z, const D& way, const D& square, const D& from,
                const D& to) {
  constexpr double margin = 1e-5;  // mm
  const D z0 = z + from * row.z_u, z1 = z + to * row.z_u;
  const D top = z0 > z1 ? z0 : z1, bottom = z0 > z1 ? z1 : z0;
  // The middle's distance from the path, seen along the axis.
  const D m = (from + to) * 0.5, height = z + m * row.z_u;
  const D flat = square + m * (2 * row.u + m) - height * height;
  const D along = way + m * row.way_u;
  D t = along * row.per_way2;
  t = t < 0 ? D{} : t;
  t = t > 1 ? every(1) : t;
  const D apart = (to - from) * (0.5 * row.seen) + (row.radius + margin);
  return (top < row.low - margin) | (bottom > row.high + margin) |
         (flat - t * (2 * along - t * row.way2) > apart * apart);
}

std::uint32_t tilted(const TiltedBand* bands, std::size_t count, const TiltedRow& row,
                     const std::uint16_t* lo, const std::uint16_t* hi, TiltedEnds& out) {
  std::uint32_t looked_at = 0;
  for (int first = 0; first < cells; first += per_double) {
    D lane;
    for (int i = 0; i < per_double; ++i) lane[i] = first + i;
    lane *= row.pitch;
    TiltedVector v;
    v.z = row.z + lane * row.z_l;
    v.u = every(row.u);
    v.d = row.d + lane * row.d_l;
    v.square = row.square + lane * (2 * row.across + lane);
    const D way = row.way + lane * row.way_l;
    L active = L{} - 1;
    D from = D{}, to = every(brick_quanta * row.quantum);
    if (lo) {
      from = load_quanta(lo + first) * row.quantum;
      to = load_quanta(hi + first) * row.quantum;
      active = from < to;
      if (!any(active)) continue;
    }
    active &= ~misses(row, v.z, way, v.square, from, to);
    if (!any(active)) continue;
    looked_at |= bits_of(active) << first;
    v.a = every(__builtin_inf());
    v.b = every(-__builtin_inf());
    v.a_t = v.b_t = D{};
    for (std::size_t i = 0; i < count; ++i) v.look_at(bands[i], static_cast<std::int64_t>(i));
    __builtin_memcpy(out.a.tau + first, &v.a, sizeof v.a);
    __builtin_memcpy(out.a.t + first, &v.a_t, sizeof v.a_t);
    __builtin_memcpy(out.a.place + first, &v.a_place, sizeof v.a_place);
    __builtin_memcpy(out.b.tau + first, &v.b, sizeof v.b);
    __builtin_memcpy(out.b.t + first, &v.b_t, sizeof v.b_t);
    __builtin_memcpy(out.b.place + first, &v.b_place, sizeof v.b_place);
  }
  return looked_at;
}
