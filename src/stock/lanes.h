// Sixteen floats at once, in as many registers as the instruction set needs. Private to stock;
// included only by the files that compile kernel_rows.h, inside of their own namespace.
#if defined(__AVX2__)
#define AIRCUT_LANE_BYTES 32
#else
#define AIRCUT_LANE_BYTES 16
#endif

typedef float V __attribute__((vector_size(AIRCUT_LANE_BYTES)));
typedef std::int32_t W __attribute__((vector_size(AIRCUT_LANE_BYTES)));
constexpr int per_vector = AIRCUT_LANE_BYTES / 4;
constexpr int vectors = cells / per_vector;

/// All bits of a lane are set, or none.
struct Mask {
  W v[vectors];
};
struct Lanes {
  V v[vectors];

  static Lanes all(float value) {
    Lanes out;
    for (V& v : out.v) v = V{} + value;
    return out;
  }
  /// first, first + step, … with one rounding each.
  static Lanes steps(float offset, float step) {
    Lanes out;
    for (int i = 0; i < cells; ++i)
      out.v[i / per_vector][i % per_vector] = (static_cast<float>(i) + 0.5f) * step + offset;
    return out;
  }
};

#define AIRCUT_LANES_OPERATOR(op)                                  \
  inline Lanes operator op(const Lanes& a, const Lanes& b) {       \
    Lanes out;                                                     \
    for (int i = 0; i < vectors; ++i) out.v[i] = a.v[i] op b.v[i]; \
    return out;                                                    \
  }                                                                \
  inline Lanes operator op(const Lanes& a, float b) {              \
    Lanes out;                                                     \
    for (int i = 0; i < vectors; ++i) out.v[i] = a.v[i] op b;      \
    return out;                                                    \
  }                                                                \
  inline Lanes operator op(float a, const Lanes& b) {              \
    Lanes out;                                                     \
    for (int i = 0; i < vectors; ++i) out.v[i] = a op b.v[i];      \
    return out;                                                    \
  }
AIRCUT_LANES_OPERATOR(+)
AIRCUT_LANES_OPERATOR(-)
AIRCUT_LANES_OPERATOR(*)
AIRCUT_LANES_OPERATOR(/)
#undef AIRCUT_LANES_OPERATOR

#define AIRCUT_LANES_COMPARE(op)                                   \
  inline Mask operator op(const Lanes& a, const Lanes& b) {        \
    Mask out;                                                      \
    for (int i = 0; i < vectors; ++i) out.v[i] = a.v[i] op b.v[i]; \
    return out;                                                    \
  }                                                                \
  inline Mask operator op(const Lanes& a, float b) { return a op Lanes::all(b); }
AIRCUT_LANES_COMPARE(<)
AIRCUT_LANES_COMPARE(<=)
AIRCUT_LANES_COMPARE(>)
AIRCUT_LANES_COMPARE(>=)
#undef AIRCUT_LANES_COMPARE

inline Mask operator&(const Mask& a, const Mask& b) {
  Mask out;
  for (int i = 0; i < vectors; ++i) out.v[i] = a.v[i] & b.v[i];
  return out;
}
inline Mask operator|(const Mask& a, const Mask& b) {
  Mask out;
  for (int i = 0; i < vectors; ++i) out.v[i] = a.v[i] | b.v[i];
  return out;
}

inline Lanes select(const Mask& m, const Lanes& a, const Lanes& b) {
  Lanes out;
  for (int i = 0; i < vectors; ++i) out.v[i] = m.v[i] ? a.v[i] : b.v[i];
  return out;
}
inline Lanes min(const Lanes& a, const Lanes& b) { return select(a < b, a, b); }
inline Lanes max(const Lanes& a, const Lanes& b) { return select(a > b, a, b); }
inline Lanes min(const Lanes& a, float b) { return min(a, Lanes::all(b)); }
inline Lanes max(const Lanes& a, float b) { return max(a, Lanes::all(b)); }
inline Lanes clamp(const Lanes& a, float low, float high) { return min(max(a, low), high); }
inline Lanes abs(const Lanes& a) { return max(a, 0.0f - a); }

inline Lanes sqrt(const Lanes& a) {
  Lanes out;
  for (int i = 0; i < vectors; ++i) {
#if defined(__AVX2__)
    out.v[i] = (V)_mm256_sqrt_ps((__m256)a.v[i]);
#elif defined(__SSE2__)
    out.v[i] = (V)_mm_sqrt_ps((__m128)a.v[i]);
#else
    for (int k = 0; k < per_vector; ++k) out.v[i][k] = __builtin_sqrtf(a.v[i][k]);
#endif
  }
  return out;
}
/// √ of what rounding may have made a little negative.
inline Lanes root(const Lanes& a) { return sqrt(max(a, 0.0f)); }
/// √(r² − x²), 0 where x is beyond r.
inline Lanes leg(float r, const Lanes& x) { return root((r - x) * (r + x)); }

/// 8 + 8 bits of a direction of any length (brick.h): its octahedral image, each coordinate from
/// −127 … 127 as 1 … 255.
inline void store_direction(const Lanes& x, const Lanes& y, const Lanes& z, std::int32_t* out) {
  const Lanes one = Lanes::all(1), minus = Lanes::all(-1);
  const Lanes sum = max(abs(x) + abs(y) + abs(z), 1e-30f);
  Lanes u = x / sum, v = y / sum;
  const Mask folded = z < 0.0f;
  const Lanes fold_u = (1.0f - abs(v)) * select(u < 0.0f, minus, one);
  const Lanes fold_v = (1.0f - abs(u)) * select(v < 0.0f, minus, one);
  u = select(folded, fold_u, u) * 127.0f + 128.5f;
  v = select(folded, fold_v, v) * 127.0f + 128.5f;
  for (int i = 0; i < vectors; ++i) {
    const W code = __builtin_convertvector(u.v[i], W) << 8 | __builtin_convertvector(v.v[i], W);
    __builtin_memcpy(out + i * per_vector, &code, sizeof(W));
  }
}

/// Whole numbers in lanes.
inline W load16(const std::uint16_t* from, int vector) {
  typedef std::uint16_t H __attribute__((vector_size(AIRCUT_LANE_BYTES / 2)));
  H half;
  __builtin_memcpy(&half, from + vector * per_vector, sizeof half);
  return __builtin_convertvector(half, W);
}
inline void store16(const W& value, std::uint16_t* to, int vector) {
  typedef std::uint16_t H __attribute__((vector_size(AIRCUT_LANE_BYTES / 2)));
  const H half = __builtin_convertvector(value, H);
  __builtin_memcpy(to + vector * per_vector, &half, sizeof half);
}
inline W load32(const std::int32_t* from, int vector) {
  W out;
  __builtin_memcpy(&out, from + vector * per_vector, sizeof out);
  return out;
}

/// A bit per lane.
inline std::uint32_t bits(const W& mask) {
#if defined(__AVX2__)
  return static_cast<std::uint32_t>(_mm256_movemask_ps((__m256)mask));
#elif defined(__SSE2__)
  return static_cast<std::uint32_t>(_mm_movemask_ps((__m128)mask));
#else
  std::uint32_t out = 0;
  for (int i = 0; i < per_vector; ++i) out |= (mask[i] != 0 ? 1u : 0u) << i;
  return out;
#endif
}
