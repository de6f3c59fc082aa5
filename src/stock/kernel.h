// Row kernels: what one straight sweep with an upright axis takes from the 16 rays of a row.
// Private to stock. The code is in kernel_rows.h and is compiled once per instruction set; all
// builds give the same bytes, because only +, −, ×, ÷, √ and comparisons are used.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace aircut::stock {

inline constexpr int cells = 16;  // per side of a brick
inline constexpr int quanta_per_cell = 3840;
inline constexpr int brick_quanta = cells * quanta_per_cell;

enum class Family : std::uint8_t { x, y, z };

/// Floor and Band of an outline in float (outline.h).
struct FloorF {
  float inner, outer, z, slope, arc, e, f;
};
struct BandF {
  float z0, z1, r0, r1, arc, e, f;
};

struct ShapeF {
  std::vector<FloorF> below, above;
  std::vector<BandF> bands;
  float radius, low, high, wall_low, wall_high;
  bool corners;     ///< has arcs with e > 0
  float roof_edge;  ///< height of the upper side at its edge: the lowest of it
};

/// A sweep as one brick sees it, mm. The foot is the point of the path nearest to the brick, so
/// that all numbers near the brick are small.
struct LocalSweep {
  const ShapeF* shape;
  double pitch;
  double foot[3];  ///< tip at the foot, from the brick's lowest corner
  double u[2];     ///< direction in plan, unit
  double slope;    ///< dz/ds
  double s0, s1;   ///< the path in plan from the foot: s0 ≤ 0 ≤ s1
  double rise;     ///< of a plunge: how far the upper end is above the foot
};

/// The chord of each ray, in quanta from the brick's border, clamped to the brick; a = b = 0 for
/// none. With the directions (brick.h) that the material's surface gets where it is left before a
/// and after b.
struct Chords {
  alignas(64) std::int32_t a[cells];
  alignas(64) std::int32_t b[cells];
  alignas(64) std::int32_t normal_a[cells];
  alignas(64) std::int32_t normal_b[cells];
};

/// A band of a sweep in any direction and the rays along one axis: what all of them share
/// (tilted.cpp has the formulas). Over the way τ along the ray and the share t of the path, F = A
/// τ²
/// + 2 B τ t + C t² + 2 E τ + 2 G t + H.
struct TiltedBand {
  double z0, z1, f;
  bool ball;
  bool along_ray;                 ///< on the strip's borders τ = p + q t, else t = p + q τ
  double zu, zd;                  ///< the axis · ray's direction, · travel
  double growth, radius, ru, rd;  ///< the radius is radius + growth z + ru τ − rd t
  double A, B, C, per_A, per_C;   ///< with their inverses, 0 where there is none
  double hull, per_hull;          ///< of τ² where ∂F/∂t = 0
  double q, border, per_border;   ///< on the strip's borders; 0: there are none
};

/// The 16 rays of a row as a sweep in any direction sees them. Lane i begins at rel + i pitch l,
/// seen from the path's start (l: the direction across the row); mm. Numbers with _l belong to l,
/// those with _u to the rays' direction.
struct TiltedRow {
  double pitch, quantum;
  double u, across, square;  ///< rel · rays' direction, · l, ²
  double z, z_l, z_u;        ///< · axis
  double d, d_l;             ///< · travel
  double way, way_l, way_u;  ///< · way: the travel seen along the axis
  double way2, per_way2;     ///< its square; 1 over it, 0 where there is none
  double low, high;          ///< heights of the sweep over its start
  double radius, seen;       ///< the cutter's; how long the rays' direction is, seen along the axis
};

/// What an end of a chord lies on: of a band its side, one of its flat faces, or their edge.
enum class TiltedPlace : std::uint8_t { side, low_face, high_face, low_edge, high_edge };

/// Both ends of the rays' chords: τ, t there, and band * 8 + place. Without a chord τ of the first
/// is infinite.
struct TiltedEnds {
  struct End {
    alignas(64) double tau[cells];
    alignas(64) double t[cells];
    alignas(64) std::int64_t place[cells];
  } a, b;
};

/// Lanes whose ends moved, as bits.
struct RowChange {
  std::uint32_t low = 0, high = 0;            ///< the lower (upper) end moved
  std::uint32_t split = 0;                    ///< the chord lies inside: [b, old hi) is left over
  std::uint32_t same_low = 0, same_high = 0;  ///< the chord ends where the material does
  std::int32_t lost = 0;                      ///< quanta

  bool any() const { return (low | high | split | same_low | same_high) != 0; }
};

struct Kernels {
  /// Chords of the Z rays of row j (lanes along X). With the row's intervals [lo, hi), returns
  /// false without finishing when none of them is touched; null: always finishes.
  bool (*upright)(const LocalSweep&, int row, const std::uint16_t* lo, const std::uint16_t* hi,
                  Chords&);
  /// X (Y) rays of the row at height k, lanes along Y (X).
  bool (*level)(const LocalSweep&, Family, int row, const std::uint16_t* lo,
                const std::uint16_t* hi, Chords&);
  /// Ends of the chords of a row's rays; lanes of which [lo, hi) proves that they are not touched
  /// may have none. Returns the lanes that were looked at as bits. Null: all of them.
  std::uint32_t (*tilted)(const TiltedBand* bands, std::size_t count, const TiltedRow&,
                          const std::uint16_t* lo, const std::uint16_t* hi, TiltedEnds&);
  /// Takes the chords from the row's intervals.
  void (*take)(std::uint16_t* lo, std::uint16_t* hi, const Chords&, RowChange&);
};

/// The fastest kernels of this processor, or the portable ones.
const Kernels& kernels();
const Kernels& portable_kernels();
/// Null where there is no AVX2.
const Kernels* avx2_kernels();

}  // namespace aircut::stock
