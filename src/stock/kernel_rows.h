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

/// Height of the side over the radius d.
inline Lanes height_at(const std::vector<FloorF>& floors, const Lanes& d) {
  Lanes z = Lanes::all(0);
  for (std::size_t i = 0; i < floors.size(); ++i) {
    const FloorF& floor = floors[i];
    const Lanes here = floor.arc > 0 ? floor.f - leg(floor.arc, d - floor.e)
                                     : floor.z + floor.slope * (d - floor.inner);
    z = i == 0 ? here : select(d > floor.inner, here, z);
  }
  return z;
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
  Lanes z, s;
  Mask there;
};

/// Lowest point of a side over the path, for rays at (s, w) of the plan frame.
inline Lowest lowest(const std::vector<FloorF>& floors, float m, float s0, float s1, const Lanes& s,
                     const Lanes& w) {
  const float radius = floors.back().outer;
  const Lanes across = abs(w), c = leg(radius, across);
  Lowest out;
  out.there = (across < radius) & (s + c >= Lanes::all(s0)) & (s - c <= Lanes::all(s1));
  const auto height = [&](const Lanes& t) {
    const Lanes along = s - t;
    return m * t + height_at(floors, sqrt(along * along + w * w));
  };
  if (m == 0) {
    out.s = clamp(s, s0, s1);
    out.z = height(out.s);
    return out;
  }
  const float steep = m < 0 ? -m : m;
  out.z = Lanes::all(far_away);
  out.s = s;
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
    const Lanes t = clamp(m > 0 ? s - e : s + e, s0, s1), z = height(t);
    const Mask better = (z < out.z) & (across < floor.outer);
    out.z = select(better, z, out.z);
    out.s = select(better, t, out.s);
  }
  return out;
}

/// Millimetres from the brick's border to quanta, clamped to the brick; chords without length or
/// outside of `there` become a = b = 0.
inline void finish(const LocalSweep& sweep, Lanes a, Lanes b, const Mask& there, Chords& out) {
  const float scale = static_cast<float>(quanta_per_cell / sweep.pitch);
  const float most = static_cast<float>(brick_quanta);
  a = select(there, clamp(a * scale, 0, most), Lanes::all(0));
  b = select(there, clamp(b * scale, 0, most), Lanes::all(0));
  store_rounded(a, out.a);
  store_rounded(b, out.b);
  for (int i = 0; i < cells; ++i) {
    const bool none = out.a[i] >= out.b[i];
    out.a[i] = none ? 0 : out.a[i];
    out.b[i] = none ? 0 : out.b[i];
  }
}

void upright(const LocalSweep& sweep, int row, Chords& out) {
  const ShapeF& shape = *sweep.shape;
  const auto f = [](double value) { return static_cast<float>(value); };
  const float ux = f(sweep.u[0]), uy = f(sweep.u[1]), slope = f(sweep.slope);
  const float s0 = f(sweep.s0), s1 = f(sweep.s1);
  const Lanes x = Lanes::steps(f(-sweep.foot[0]), f(sweep.pitch));
  const float y = f((row + 0.5) * sweep.pitch - sweep.foot[1]);
  const Lanes s = x * ux + y * uy, w = y * ux - x * uy;
  const Lowest below = lowest(shape.below, slope, s0, s1, s, w);
  const Lanes a = below.z + f(sweep.foot[2]);
  store(below.s, out.ta);
  // The upper side only matters when some of it is below the brick's top.
  const double low_end = sweep.slope > 0 ? sweep.s0 : sweep.s1;
  const double roof = sweep.foot[2] + sweep.rise + sweep.slope * low_end + shape.roof_edge;
  if (roof > cells * sweep.pitch + 1e-4) {
    store(below.s, out.tb);
    finish(sweep, a, Lanes::all(far_away), below.there, out);
    return;
  }
  const Lowest above = lowest(shape.above, -slope, s0, s1, s, w);
  store(above.s, out.tb);
  finish(sweep, a, f(sweep.foot[2] + sweep.rise) - above.z, below.there & above.there, out);
}

/// The hull of the chords found so far, of rays across.
struct Hull {
  Lanes a = Lanes::all(far_away), b = Lanes::all(-far_away), ta = Lanes::all(0), tb = Lanes::all(0);

  void exit(const Lanes& x, const Lanes& t, const Mask& there) {
    const Mask better = (x > b) & there;
    b = select(better, x, b);
    tb = select(better, t, tb);
  }
  void entry(const Lanes& x, const Lanes& t, const Mask& there) {
    const Mask better = (x < a) & there;
    a = select(better, x, a);
    ta = select(better, t, ta);
  }
};

/// Plan frame of rays across: y is the lane's coordinate from the foot, (ur, ul) the path's
/// direction along the ray and along the lanes.
struct Across {
  Lanes y;
  float ur, ul;
};

/// Discs of one radius over [t0, t1].
inline void stadium(const Across& ray, float radius, float t0, float t1, Hull& hull) {
  if (!(radius > 0)) return;
  // On the straight side where x grows outwards: t* = y/ul ± radius ur/|ul|.
  const float tiny = 1e-20f, ul = ray.ul < tiny && ray.ul > -tiny ? tiny : ray.ul;
  const float side = radius * ray.ur / (ul < 0 ? -ul : ul);
  const Lanes middle = ray.y * (1 / ul);
  const auto chord = [&](const Lanes& t, Mask& there) {
    const Lanes v = abs(ray.y - t * ray.ul);
    there = v < radius;
    return leg(radius, v);
  };
  Mask there;
  const Lanes t_out = clamp(middle + side, t0, t1), half_out = chord(t_out, there);
  hull.exit(t_out * ray.ur + half_out, t_out, there);
  const Lanes t_in = clamp(middle - side, t0, t1), half_in = chord(t_in, there);
  hull.entry(t_in * ray.ur - half_in, t_in, there);
}

/// Discs of radius r0 − k t over [t0, t1]. The plan outline is their hull: two circles and the
/// tangents that they share, whose normals n have n·u = k.
inline void cone(const Across& ray, float r0, float k, float t0, float t1, Hull& hull) {
  const auto candidate = [&](const Lanes& t) {
    const Lanes v = abs(ray.y - t * ray.ul), radius = r0 - k * t;
    const Mask there = v < radius;
    const Lanes half = root((radius - v) * (radius + v));
    hull.exit(t * ray.ur + half, t, there);
    hull.entry(t * ray.ur - half, t, there);
  };
  candidate(Lanes::all(t0));
  candidate(Lanes::all(t1));
  if (!(k < 1 && k > -1)) return;
  const float across = __builtin_sqrtf((1 - k) * (1 + k));
  for (const float sign : {1.0f, -1.0f}) {
    const float n = k * ray.ul + sign * across * ray.ur;
    candidate(clamp((ray.y - r0 * n) / (ray.ul - k * n), t0, t1));
  }
}

/// Slices of a sphere whose middle is z − m t below the ray, over [t0, t1].
inline void sphere(const Across& ray, float radius, float z, float m, float t0, float t1,
                   Hull& hull) {
  // Q(t) = r² − (y − t ul)² − (z − m t)² = q − g² (t − tc)²; stationary where ur √Q = g² (t − tc).
  const float g2 = ray.ul * ray.ul + m * m, g = __builtin_sqrtf(g2);
  const Lanes tc = (ray.y * ray.ul + z * m) / g2;
  const Lanes off = (ray.y * m - z * ray.ul) / g;
  const Lanes reach = leg(radius, abs(off)) * (ray.ur / (g * __builtin_sqrtf(1 + m * m)));
  const auto half = [&](const Lanes& t, Mask& there) {
    const Lanes v = ray.y - t * ray.ul, v_z = z - m * t;
    const Lanes q = (radius - v_z) * (radius + v_z) - v * v;
    there = q > 0.0f;
    return root(q);
  };
  Mask there;
  const Lanes t_out = clamp(tc + reach, t0, t1), half_out = half(t_out, there);
  hull.exit(t_out * ray.ur + half_out, t_out, there);
  const Lanes t_in = clamp(tc - reach, t0, t1), half_in = half(t_in, there);
  hull.entry(t_in * ray.ur - half_in, t_in, there);
}

/// Slices of a corner: radius e + √(r² − (z − m t)²), z from the corner's middle, over [t0, t1].
inline void corner(const Across& ray, const BandF& band, float z, float m, float t0, float t1,
                   Hull& hull) {
  constexpr int halvings = 22;
  struct Slice {
    Lanes radius, rate;  // and its derivative by t
  };
  const auto slice = [&](const Lanes& t) {
    const Lanes v_z = z - m * t, q = max(leg(band.arc, v_z), 1e-6f);
    return Slice{band.e + q, m * v_z / q};
  };
  // First the place that lies deepest inside, by the sign of the derivative of ρ − |y − t ul|.
  Lanes low = Lanes::all(t0), high = Lanes::all(t1);
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
    low = Lanes::all(t0);
    high = Lanes::all(t1);
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
    const Lanes half = root((disc.radius - v) * (disc.radius + v));
    if (sign > 0)
      hull.exit(t * ray.ur + half, t, there);
    else
      hull.entry(t * ray.ur - half, t, there);
  }
}

/// Radius of the shape at height z (inside of it).
inline float radius_at(const ShapeF& shape, float z) {
  for (const BandF& b : shape.bands) {
    if (z > b.z1) continue;
    if (b.arc > 0) {
      const float q = (b.arc - (z - b.f)) * (b.arc + (z - b.f));
      return b.e + __builtin_sqrtf(q > 0 ? q : 0);
    }
    return b.r0 + (b.r1 - b.r0) * ((z - b.z0) / (b.z1 - b.z0));
  }
  return shape.bands.back().r1;
}

/// Largest radius between two heights; −1 where the shape isn't.
inline float widest_between(const ShapeF& shape, float z0, float z1) {
  if (z1 < shape.low || z0 > shape.high) return -1;
  if (z0 > shape.wall_high) return radius_at(shape, z0);
  if (z1 < shape.wall_low) return radius_at(shape, z1);
  return shape.radius;
}

void level(const LocalSweep& sweep, Family family, int row, Chords& out) {
  const ShapeF& shape = *sweep.shape;
  const auto f = [](double value) { return static_cast<float>(value); };
  const int ray_axis = family == Family::x ? 0 : 1, lane_axis = 1 - ray_axis;
  const Across ray{Lanes::steps(f(-sweep.foot[lane_axis]), f(sweep.pitch)), f(sweep.u[ray_axis]),
                   f(sweep.u[lane_axis])};
  // Heights and clipping in double: on a shallow ramp they are divided by its slope.
  const double z = (row + 0.5) * sweep.pitch - sweep.foot[2], m = sweep.slope;
  const double za = z - m * sweep.s0, zb = z - m * sweep.s1;
  const float s0 = f(sweep.s0), s1 = f(sweep.s1);
  Hull hull;
  if (m == 0) {
    stadium(ray, widest_between(shape, f(z - sweep.rise), f(z)), s0, s1, hull);
  } else if ((za < zb ? za : zb) >= shape.wall_low && (za < zb ? zb : za) <= shape.wall_high) {
    stadium(ray, shape.radius, s0, s1, hull);
  } else {
    for (const BandF& band : shape.bands) {
      const double p = (z - band.z0) / m, q = (z - band.z1) / m;
      double from = p < q ? p : q, to = p < q ? q : p;
      from = from > sweep.s0 ? from : sweep.s0;
      to = to < sweep.s1 ? to : sweep.s1;
      if (!(from <= to)) continue;
      const float t0 = f(from), t1 = f(to), growth = (band.r1 - band.r0) / (band.z1 - band.z0);
      if (band.arc > 0 && band.e == 0)
        sphere(ray, band.arc, f(z - band.f), f(m), t0, t1, hull);
      else if (band.arc > 0)
        corner(ray, band, f(z - band.f), f(m), t0, t1, hull);
      else if (growth == 0)
        stadium(ray, band.r0, t0, t1, hull);
      else
        cone(ray, f(band.r0 + growth * (z - band.z0)), f(growth * m), t0, t1, hull);
    }
  }
  store(hull.ta, out.ta);
  store(hull.tb, out.tb);
  const float foot = f(sweep.foot[ray_axis]);
  finish(sweep, hull.a + foot, hull.b + foot, hull.a < hull.b, out);
}

void take(std::uint16_t* lo, std::uint16_t* hi, const Chords& chords, RowChange& out) {
  out = {};
  for (int i = 0; i < cells; ++i) {
    const std::int32_t l = lo[i], h = hi[i], a = chords.a[i], b = chords.b[i];
    if (l >= h || a >= b || a > h || b < l) continue;
    const std::uint32_t bit = 1u << i;
    if (a == h || b == l) {
      (a == h ? out.same_high : out.same_low) |= bit;
      continue;
    }
    const std::int32_t from = a > l ? a : l, to = b < h ? b : h;
    out.lost += to - from;
    if (to - from > out.deepest) {
      out.deepest = to - from;
      out.deepest_lane = i;
    }
    if (a <= l && b >= h) {
      lo[i] = hi[i] = 0;
      out.low |= bit;
      out.high |= bit;
    } else if (a <= l) {
      lo[i] = static_cast<std::uint16_t>(b);
      out.low |= bit;
    } else {
      hi[i] = static_cast<std::uint16_t>(a);
      out.high |= bit;
      if (b < h) out.split |= bit;
    }
  }
}
