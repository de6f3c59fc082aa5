// The row kernels (kernel.h). Included by one source file per instruction set.
//
// A convex cutter on a straight path sweeps a convex solid, so each ray has one chord. Its end is
// the largest exit of the cutter's slices over the path (its start the smallest entry), and as a
// function of the path parameter s the exit is concave. So it is enough to evaluate it where it is
// stationary, if that is on the path, or else at the nearest end of the path:
//   * a place s* at which the exit exists and is stationary, clamped to the part of the path that
//     counts, gives the exact value; when the clamped place has no chord, no other place has.
//
// Plan frame of a path: s along, w across; the foot is s = 0. Z rays see the cutter's lower side,
// p(d) over the radius d: the lowest point on the ray is the minimum of m s + p(d(s)), convex in s.
// Rays across see, at height z, discs of radius ρ around the path: constant (stadium), linear in s
// (cone), of a sphere, or of a corner with e > 0 (by bisection of the derivative's sign).

constexpr float far_away = 1e30f;

/// Height p of the side over the radius d, and p'(d).
struct Side {
  Lanes height, rate;
};
inline Side side_at(const std::vector<FloorF>& floors, const Lanes& d) {
  Side out{Lanes::all(0), Lanes::all(0)};
  for (std::size_t i = 0; i < floors.size(); ++i) {
    const FloorF& floor = floors[i];
    Side here{floor.z + floor.slope * (d - floor.inner), Lanes::all(floor.slope)};
    if (floor.arc > 0) {
      const Lanes below = leg(floor.arc, d - floor.e);
      here = {floor.f - below, (d - floor.e) / max(below, 1e-6f)};
    }
    if (i == 0) {
      out = here;
    } else {
      const Mask beyond = d > floor.inner;
      out = {select(beyond, here.height, out.height), select(beyond, here.rate, out.rate)};
    }
  }
  return out;
}

/// Where the derivative of m s + p(d) vanishes on a corner arc with e > 0, as a distance from s:
/// the root of (d − E) e = m d √(r² − (d − E)²) in [low, high]. Both sides are monotone.
inline Lanes corner_distance(const FloorF& floor, float m, const Lanes& w, Lanes low, Lanes high) {
  const auto excess = [&](const Lanes& e) {
    const Lanes d = sqrt(e * e + w * w);
    return (d - floor.e) * e - m * (d * leg(floor.arc, d - floor.e));
  };
  Lanes f_low = excess(low), f_high = excess(high);
  for (int i = 0; i < 3; ++i) {
    const Lanes middle = 0.5f * (low + high), f = excess(middle);
    const Mask above = f > 0.0f;
    high = select(above, middle, high);
    f_high = select(above, f, f_high);
    low = select(above, low, middle);
    f_low = select(above, f_low, f);
  }
  // Regula falsi that halves the value at the end which stays (Illinois).
  for (int i = 0; i < 4; ++i) {
    const Lanes span = max(f_high - f_low, 1e-30f);
    const Lanes middle = min(max(low - f_low * (high - low) / span, low), high), f = excess(middle);
    const Mask above = f > 0.0f;
    f_low = select(above, 0.5f * f_low, f);
    f_high = select(above, f, 0.5f * f_high);
    high = select(above, middle, high);
    low = select(above, low, middle);
  }
  return 0.5f * (low + high);
}

struct Lowest {
  Lanes z, along, across;  ///< height, and how it rises with s and w: the slope of what is left
  Mask there;
};

/// Lowest point of a side over the path, for rays at (s, w) of the plan frame.
inline Lowest lowest(const std::vector<FloorF>& floors, float m, float s0, float s1, const Lanes& s,
                     const Lanes& w) {
  const float radius = floors.back().outer;
  const Lanes across = abs(w), c = leg(radius, across);
  Lowest out;
  out.there = (across < radius) & (s + c >= Lanes::all(s0)) & (s - c <= Lanes::all(s1));
  // The slope is that of the side at this radius.
  const auto candidate = [&](const Lanes& t) {
    const Lanes off = s - t, d = sqrt(off * off + w * w);
    const Side side = side_at(floors, d);
    const Lanes per_d = side.rate / max(d, 1e-12f);
    return Lowest{m * t + side.height, per_d * off, per_d * w, {}};
  };
  if (m == 0) {
    const Mask there = out.there;
    out = candidate(clamp(s, s0, s1));
    out.there = there;
    return out;
  }
  const float steep = m < 0 ? -m : m;
  out.z = Lanes::all(far_away);
  out.along = out.across = Lanes::all(0);
  for (const FloorF& floor : floors) {
    const Lanes outer = leg(floor.outer, across);
    const Lanes inner = floor.inner > 0 ? leg(floor.inner, across) : Lanes::all(0);
    Lanes e = outer;
    if (floor.arc > 0 && floor.e == 0) {
      e = leg(floor.arc, across) * (steep / __builtin_sqrtf(1 + steep * steep));
    } else if (floor.arc > 0) {
      e = corner_distance(floor, steep, w, inner, outer);
    } else if (floor.slope > steep) {
      e = across * (steep / __builtin_sqrtf(floor.slope * floor.slope - steep * steep));
    }
    e = min(max(e, inner), outer);
    const Lanes free = m > 0 ? s - e : s + e, t = clamp(free, s0, s1);
    Lowest here = candidate(t);
    // An edge of the cutter in the middle of the path: the surface rises by m along the path, and
    // its contour lines are the edge's circle.
    const Mask at_edge =
        ((e >= outer) | ((e <= inner) & (inner > 0.0f))) & (t >= free) & (t <= free) & (e > 1e-9f);
    const Lanes off = m > 0 ? e : 0.0f - e;
    here.along = select(at_edge, Lanes::all(m), here.along);
    here.across = select(at_edge, m * w / select(at_edge, off, Lanes::all(1)), here.across);
    const Mask better = (here.z < out.z) & (across < floor.outer);
    out.z = select(better, here.z, out.z);
    out.along = select(better, here.along, out.along);
    out.across = select(better, here.across, out.across);
  }
  return out;
}

/// Millimetres from the brick's border to quanta, clamped to the brick; chords without length or
/// outside of `there` become a = b = 0. False when no interval [lo, hi) is touched.
inline bool finish(const LocalSweep& sweep, const Lanes& a, const Lanes& b, const Mask& there,
                   const std::uint16_t* lo, const std::uint16_t* hi, Chords& out) {
  const float scale = static_cast<float>(quanta_per_cell / sweep.pitch);
  const float most = static_cast<float>(brick_quanta);
  const Lanes from = clamp(a * scale, 0, most) + 0.5f, to = clamp(b * scale, 0, most) + 0.5f;
  std::uint32_t touched = lo ? 0 : 1;
  for (int i = 0; i < vectors; ++i) {
    W q = __builtin_convertvector(from.v[i], W), r = __builtin_convertvector(to.v[i], W);
    const W some = there.v[i] & (q < r);
    q &= some;
    r &= some;
    __builtin_memcpy(out.a + i * per_vector, &q, sizeof q);
    __builtin_memcpy(out.b + i * per_vector, &r, sizeof r);
    if (!lo) continue;
    const W l = load16(lo, i), h = load16(hi, i);
    touched |= bits(some & (l < h) & (q <= h) & (r >= l));
  }
  return touched != 0;
}

/// Whether no Z ray of the row can be touched, because even the cutter's lowest tip at the ray's
/// distance from the path would stay above the material. Only looked at where exact chords are
/// dear.
inline bool stays_above(const LocalSweep& sweep, float s0, float s1, const Lanes& s, const Lanes& w,
                        const std::uint16_t* lo, const std::uint16_t* hi) {
  const Lanes off = s - clamp(s, s0, s1), d = sqrt(off * off + w * w);
  const double rise0 = sweep.slope * sweep.s0, rise1 = sweep.slope * sweep.s1;
  const double tip = sweep.foot[2] + (rise0 < rise1 ? rise0 : rise1);
  const float scale = static_cast<float>(quanta_per_cell / sweep.pitch);
  // 1e-5 mm for rounding here and there, one quantum for the rounding to quanta.
  const Lanes floor =
      (side_at(sweep.shape->below, d).height + static_cast<float>(tip - 1e-5)) * scale;
  const Lanes quanta = clamp(floor, 0, 65535.0f);
  std::uint32_t below = 0;
  for (int i = 0; i < vectors; ++i) {
    const W l = load16(lo, i), h = load16(hi, i);
    const W floor_here = __builtin_convertvector(quanta.v[i], W) - 1;
    below |= bits((l < h) & (h >= floor_here) & (d.v[i] <= sweep.shape->radius));
  }
  return below == 0;
}

bool upright(const LocalSweep& sweep, int row, const std::uint16_t* lo, const std::uint16_t* hi,
             Chords& out) {
  const ShapeF& shape = *sweep.shape;
  const auto f = [](double value) { return static_cast<float>(value); };
  const float ux = f(sweep.u[0]), uy = f(sweep.u[1]), slope = f(sweep.slope);
  const float s0 = f(sweep.s0), s1 = f(sweep.s1);
  const Lanes x = Lanes::steps(f(-sweep.foot[0]), f(sweep.pitch));
  const float y = f((row + 0.5) * sweep.pitch - sweep.foot[1]);
  const Lanes s = x * ux + y * uy, w = y * ux - x * uy, one = Lanes::all(1);
  const bool dear = slope != 0 && shape.below.back().arc > 0 && shape.below.back().e > 0;
  if (dear && lo && stays_above(sweep, s0, s1, s, w, lo, hi)) return false;
  const Lowest below = lowest(shape.below, slope, s0, s1, s, w);
  const Lanes a = below.z + f(sweep.foot[2]);
  // The upper side only matters when some of it is below the brick's top.
  const double low_end = sweep.slope > 0 ? sweep.s0 : sweep.s1;
  const double roof = sweep.foot[2] + sweep.rise + sweep.slope * low_end + shape.roof_edge;
  if (roof > cells * sweep.pitch + 1e-4) {
    if (!finish(sweep, a, Lanes::all(far_away), below.there, lo, hi, out)) return false;
  } else {
    const Lowest above = lowest(shape.above, -slope, s0, s1, s, w);
    const Lanes b = f(sweep.foot[2] + sweep.rise) - above.z;
    if (!finish(sweep, a, b, below.there & above.there, lo, hi, out)) return false;
    store_direction(above.across * uy - above.along * ux,
                    0.0f - (above.along * uy + above.across * ux), 0.0f - one, out.normal_b);
  }
  store_direction(below.across * uy - below.along * ux,
                  0.0f - (below.along * uy + below.across * ux), one, out.normal_a);
  return true;
}

/// The hull of the chords found so far, of rays across: its ends, and the cutter's outward normal
/// there as (along the ray, along the lanes, up), of any length.
struct Hull {
  Lanes a = Lanes::all(far_away), b = Lanes::all(-far_away);
  Lanes a_ray = Lanes::all(0), a_lane = a_ray, a_up = a_ray, b_ray = a_ray, b_lane = a_ray,
        b_up = a_ray;

  void exit(const Lanes& x, const Lanes& ray, const Lanes& lane, const Lanes& up,
            const Mask& there) {
    const Mask better = (x > b) & there;
    b = select(better, x, b);
    b_ray = select(better, ray, b_ray);
    b_lane = select(better, lane, b_lane);
    b_up = select(better, up, b_up);
  }
  void entry(const Lanes& x, const Lanes& ray, const Lanes& lane, const Lanes& up,
             const Mask& there) {
    const Mask better = (x < a) & there;
    a = select(better, x, a);
    a_ray = select(better, ray, a_ray);
    a_lane = select(better, lane, a_lane);
    a_up = select(better, up, a_up);
  }
};

/// Plan frame of rays across: y is the lane's coordinate from the foot, (ur, ul) the path's
/// direction along the ray and along the lanes.
struct Across {
  Lanes y;
  float ur, ul, m;
};

/// The part of the path that counts for a band of the cutter. An end that is not the path's own
/// lies at an edge of the band: there, the normal is the one across the travel.
struct Part {
  float t0, t1;
  bool edge0 = false, edge1 = false;

  /// The normal's part upwards, `up` where no edge is touched.
  Lanes up_at(const Across& ray, const Lanes& t, const Lanes& n_ray, const Lanes& n_lane,
              const Lanes& up) const {
    if (!edge0 && !edge1) return up;
    Mask at_edge = t > far_away;
    if (edge0) at_edge = at_edge | (t <= t0);
    if (edge1) at_edge = at_edge | (t >= t1);
    return select(at_edge, (n_ray * ray.ur + n_lane * ray.ul) * (-1 / ray.m), up);
  }
};

/// Discs of one radius; `up` is the normal's part upwards for a horizontal part of the radius'
/// length.
inline void stadium(const Across& ray, float radius, float up, const Part& part, Hull& hull) {
  if (!(radius > 0)) return;
  // On the straight side where x grows outwards: t* = y/ul ± radius ur/|ul|.
  const float tiny = 1e-20f, ul = ray.ul < tiny && ray.ul > -tiny ? tiny : ray.ul;
  const float side = radius * ray.ur / (ul < 0 ? -ul : ul);
  const Lanes middle = ray.y * (1 / ul), rise = Lanes::all(up);
  {
    const Lanes t = clamp(middle + side, part.t0, part.t1), v = ray.y - t * ray.ul;
    const Lanes half = leg(radius, v);
    hull.exit(t * ray.ur + half, half, v, part.up_at(ray, t, half, v, rise), abs(v) < radius);
  }
  const Lanes t = clamp(middle - side, part.t0, part.t1), v = ray.y - t * ray.ul;
  const Lanes half = 0.0f - leg(radius, v);
  hull.entry(t * ray.ur + half, half, v, part.up_at(ray, t, half, v, rise), abs(v) < radius);
}

/// Discs of radius r0 − k t, of a side that widens by `growth` per height. The plan outline is
/// their hull: two circles and the tangents that they share, whose normals n have n·u = k.
inline void cone(const Across& ray, float r0, float k, float growth, const Part& part, Hull& hull) {
  const auto candidate = [&](const Lanes& t) {
    const Lanes v = ray.y - t * ray.ul, radius = r0 - k * t;
    const Mask there = abs(v) < radius;
    const Lanes half = root((radius - v) * (radius + v)), minus = 0.0f - half;
    const Lanes up = -growth * radius;
    hull.exit(t * ray.ur + half, half, v, part.up_at(ray, t, half, v, up), there);
    hull.entry(t * ray.ur - half, minus, v, part.up_at(ray, t, minus, v, up), there);
  };
  if (k < 1 && k > -1) {
    const float across = __builtin_sqrtf((1 - k) * (1 + k));
    for (const float sign : {1.0f, -1.0f}) {
      const float n = k * ray.ul + sign * across * ray.ur;
      candidate(clamp((ray.y - r0 * n) / (ray.ul - k * n), part.t0, part.t1));
    }
  }
  candidate(Lanes::all(part.t0));
  candidate(Lanes::all(part.t1));
}

/// Slices of a sphere whose middle is z − m t below the ray.
inline void sphere(const Across& ray, float radius, float z, const Part& part, Hull& hull) {
  // Q(t) = r² − (y − t ul)² − (z − m t)² = q − g² (t − tc)²; stationary where ur √Q = g² (t − tc).
  const float m = ray.m, g2 = ray.ul * ray.ul + m * m, g = __builtin_sqrtf(g2);
  const Lanes tc = (ray.y * ray.ul + z * m) / g2;
  const Lanes off = (ray.y * m - z * ray.ul) / g;
  const Lanes reach = leg(radius, off) * (ray.ur / (g * __builtin_sqrtf(1 + m * m)));
  const auto slice = [&](const Lanes& t, bool exit) {
    const Lanes v = ray.y - t * ray.ul, up = z - m * t;
    const Lanes q = (radius - up) * (radius + up) - v * v, half = root(q), minus = 0.0f - half;
    if (exit)
      hull.exit(t * ray.ur + half, half, v, up, q > 0.0f);
    else
      hull.entry(t * ray.ur - half, minus, v, up, q > 0.0f);
  };
  slice(clamp(tc + reach, part.t0, part.t1), true);
  slice(clamp(tc - reach, part.t0, part.t1), false);
}

/// Slices of a corner: radius e + √(r² − (z − m t)²), z from the corner's middle.
inline void corner(const Across& ray, const BandF& band, float z, float reach, Part part,
                   Hull& hull) {
  // What is farther along the path doesn't come into this brick; 18 halvings of some 20 mm leave
  // 1e-4 mm, and where the derivative vanishes the chord is wrong by the square of that.
  constexpr int halvings = 18;
  part.t0 = part.t0 > -reach ? part.t0 : -reach;
  part.t1 = part.t1 < reach ? part.t1 : reach;
  if (!(part.t0 <= part.t1)) return;
  const float m = ray.m;
  struct Slice {
    Lanes radius, rate, up;  // and its derivative by t; height over the corner's middle
    Lanes q;
  };
  const auto slice = [&](const Lanes& t) {
    const Lanes up = z - m * t, q = max(leg(band.arc, up), 1e-6f);
    return Slice{band.e + q, m * up / q, up, q};
  };
  // First the place that lies deepest inside, by the sign of the derivative of ρ − |y − t ul|.
  Lanes low = Lanes::all(part.t0), high = Lanes::all(part.t1);
  for (int i = 0; i < halvings; ++i) {
    const Lanes t = 0.5f * (low + high);
    const Lanes side =
        select(ray.y - t * ray.ul > Lanes::all(0), Lanes::all(ray.ul), Lanes::all(-ray.ul));
    const Mask rising = slice(t).rate + side > Lanes::all(0);
    low = select(rising, t, low);
    high = select(rising, high, t);
  }
  const Lanes inside = 0.5f * (low + high);
  const Mask there = slice(inside).radius > abs(ray.y - inside * ray.ul);
  for (const float sign : {1.0f, -1.0f}) {  // exit, entry
    low = Lanes::all(part.t0);
    high = Lanes::all(part.t1);
    for (int i = 0; i < halvings; ++i) {
      const Lanes t = 0.5f * (low + high);
      const Slice disc = slice(t);
      const Lanes v = ray.y - t * ray.ul, q = (disc.radius - v) * (disc.radius + v);
      const Lanes rate = disc.radius * disc.rate + v * ray.ul + (sign * ray.ur) * root(q);
      const Mask rising = ((q > 0.0f) & (rate > 0.0f)) | ((q <= 0.0f) & (t < inside));
      low = select(rising, t, low);
      high = select(rising, high, t);
    }
    const Lanes t = 0.5f * (low + high), v = ray.y - t * ray.ul;
    const Slice disc = slice(t);
    const Lanes half = sign * root((disc.radius - v) * (disc.radius + v));
    const Lanes up = disc.up * disc.radius / disc.q;
    if (sign > 0)
      hull.exit(t * ray.ur + half, half, v, up, there);
    else
      hull.entry(t * ray.ur + half, half, v, up, there);
  }
}

/// Radius of the shape at height z (inside of it), and the part upwards of the normal there, for a
/// horizontal part of the radius' length.
struct Rim {
  float radius, up;
};
inline Rim rim_at(const ShapeF& shape, float z) {
  for (const BandF& b : shape.bands) {
    if (z > b.z1) continue;
    if (b.arc > 0) {
      const float q2 = (b.arc - (z - b.f)) * (b.arc + (z - b.f));
      const float q = __builtin_sqrtf(q2 > 1e-12f ? q2 : 1e-12f);
      return {b.e + q, (z - b.f) * (b.e + q) / q};
    }
    const float growth = (b.r1 - b.r0) / (b.z1 - b.z0), radius = b.r0 + growth * (z - b.z0);
    return {radius, -growth * radius};
  }
  return {shape.bands.back().r1, 0};
}

/// The widest rim between two heights; radius −1 where the shape isn't.
inline Rim widest_between(const ShapeF& shape, float z0, float z1) {
  if (z1 < shape.low || z0 > shape.high) return {-1, 0};
  if (z0 > shape.wall_high) return rim_at(shape, z0);
  if (z1 < shape.wall_low) return rim_at(shape, z1);
  return {shape.radius, 0};
}

/// How exactly corners are followed: chords that lie inside of the true ones, outside, or are them.
enum class Corners { inner, exact, outer };

/// The chords of all bands of a sloped move at a row of height z above the foot's tip.
inline void sloped(const LocalSweep& sweep, const Across& ray, double z, Corners corners,
                   Hull& hull) {
  const auto f = [](double value) { return static_cast<float>(value); };
  const double m = sweep.slope;
  const float reach = sweep.shape->radius + f(1.5 * cells * sweep.pitch);
  for (const BandF& band : sweep.shape->bands) {
    const double p = (z - band.z0) / m, q = (z - band.z1) / m;
    double from = p < q ? p : q, to = p < q ? q : p;
    Part part{};
    part.edge0 = from > sweep.s0;
    part.edge1 = to < sweep.s1;
    from = part.edge0 ? from : sweep.s0;
    to = part.edge1 ? to : sweep.s1;
    if (!(from <= to)) continue;
    part.t0 = f(from);
    part.t1 = f(to);
    const float growth = (band.r1 - band.r0) / (band.z1 - band.z0);
    if (band.arc > 0 && band.e == 0) {
      sphere(ray, band.arc, f(z - band.f), part, hull);
    } else if (band.arc > 0 && corners == Corners::exact) {
      corner(ray, band, f(z - band.f), reach, part, hull);
    } else if (band.arc > 0) {
      // The radius changes one way over the part: its smallest or largest one for all of it.
      const auto radius = [&](double t) {
        const double v = z - m * t - band.f, q2 = (band.arc - v) * (band.arc + v);
        return band.e + __builtin_sqrt(q2 > 0 ? q2 : 0);
      };
      const double r0 = radius(from), r1 = radius(to);
      const double r = (corners == Corners::inner) == (r0 < r1) ? r0 : r1;
      stadium(ray, f(corners == Corners::inner ? r - 1e-5 : r + 1e-5), 0, part, hull);
    } else if (growth == 0) {
      stadium(ray, band.r0, 0, part, hull);
    } else {
      cone(ray, f(band.r0 + growth * (z - band.z0)), f(growth * m), growth, part, hull);
    }
  }
}

/// Whether the chords take all of each interval that the outer ones touch.
inline bool takes_all_of(const Chords& inner, const Chords& outer, const std::uint16_t* lo,
                         const std::uint16_t* hi) {
  std::uint32_t left = 0;
  for (int i = 0; i < vectors; ++i) {
    const W l = load16(lo, i), h = load16(hi, i);
    const W a = load32(inner.a, i), b = load32(inner.b, i);
    const W touched = (l < h) & (load32(outer.a, i) <= h) & (load32(outer.b, i) >= l);
    left |= bits(touched & ((a > l) | (b < h) | (a >= b)));
  }
  return left == 0;
}

bool level(const LocalSweep& sweep, Family family, int row, const std::uint16_t* lo,
           const std::uint16_t* hi, Chords& out) {
  const ShapeF& shape = *sweep.shape;
  const auto f = [](double value) { return static_cast<float>(value); };
  const int ray_axis = family == Family::x ? 0 : 1, lane_axis = 1 - ray_axis;
  const Across ray{Lanes::steps(f(-sweep.foot[lane_axis]), f(sweep.pitch)), f(sweep.u[ray_axis]),
                   f(sweep.u[lane_axis]), f(sweep.slope)};
  // Heights and clipping in double: on a shallow ramp they are divided by its slope.
  const double z = (row + 0.5) * sweep.pitch - sweep.foot[2], m = sweep.slope;
  const double za = z - m * sweep.s0, zb = z - m * sweep.s1;
  const Part whole{f(sweep.s0), f(sweep.s1)};
  const float foot = f(sweep.foot[ray_axis]);
  const auto finished = [&](const Hull& hull, Chords& to) {
    return finish(sweep, hull.a + foot, hull.b + foot, hull.a < hull.b, lo, hi, to);
  };
  Hull hull;
  if (m == 0) {
    const Rim rim = widest_between(shape, f(z - sweep.rise), f(z));
    stadium(ray, rim.radius, rim.up, whole, hull);
  } else if ((za < zb ? za : zb) >= shape.wall_low && (za < zb ? zb : za) <= shape.wall_high) {
    stadium(ray, shape.radius, 0, whole, hull);
  } else if (shape.corners && lo) {
    // Corners are dear: most rows are decided by chords that are surely too long, or too short.
    Chords outer;
    Hull bound;
    sloped(sweep, ray, z, Corners::outer, bound);
    if (!finished(bound, outer)) return false;
    sloped(sweep, ray, z, Corners::inner, hull);
    if (finished(hull, out) && takes_all_of(out, outer, lo, hi)) return true;
    hull = {};
    sloped(sweep, ray, z, Corners::exact, hull);
  } else {
    sloped(sweep, ray, z, Corners::exact, hull);
  }
  if (!finished(hull, out)) return false;
  // The material's surface looks the other way than the cutter's.
  const auto directions = [&](const Lanes& n_ray, const Lanes& n_lane, const Lanes& up,
                              std::int32_t* to) {
    const Lanes r = 0.0f - n_ray, l = 0.0f - n_lane;
    store_direction(ray_axis == 0 ? r : l, ray_axis == 0 ? l : r, 0.0f - up, to);
  };
  directions(hull.a_ray, hull.a_lane, hull.a_up, out.normal_a);
  directions(hull.b_ray, hull.b_lane, hull.b_up, out.normal_b);
  return true;
}

void take(std::uint16_t* lo, std::uint16_t* hi, const Chords& chords, RowChange& out) {
  out = {};
  W lost = {};
  for (int i = 0; i < vectors; ++i) {
    const W l = load16(lo, i), h = load16(hi, i);
    const W a = load32(chords.a, i), b = load32(chords.b, i), zero = {};
    const W touched = (l < h) & (a < b) & (a <= h) & (b >= l);
    const W inside = touched & (a < h) & (b > l);
    const int shift = i * per_vector;
    const W low = inside & (a <= l), high = inside & (b >= h), all = low & high;
    out.low |= bits(low) << shift;
    out.high |= bits((inside & (a > l)) | all) << shift;
    out.split |= bits(inside & (a > l) & (b < h)) << shift;
    out.same_low |= bits(touched & (b == l)) << shift;
    out.same_high |= bits(touched & (a == h)) << shift;
    const W from = a > l ? a : l, to = b < h ? b : h;
    lost += inside & (to - from);
    store16(all ? zero : (low ? b : l), lo, i);
    store16(all ? zero : ((inside & (a > l)) ? a : h), hi, i);
  }
  for (int i = 0; i < per_vector; ++i) out.lost += lost[i];
}
