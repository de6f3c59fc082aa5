// Per direction, tool l moves the tip by h_l(t_l). With a_l = h_l(t) and b_l = h_l'(t), N = Σ a,
// and D = ½ Σ |b| Δt the linear model (1 + κ)(N + Σ b δ), |κ| ≤ ω/2, ω = ε + ν, has the hull
//
//   I    N ≥ D    (1 + ω/2)(N + D) … (1 − ω/2)(N − D)
//   II   N ≤ −D   (1 − ω/2)(N + D) … (1 + ω/2)(N − D)
//   III  between  (1 + ω/2)(N + D) … (1 + ω/2)(N − D)          width 2D + ω max(|N|, D)
//
// The exact field keeps the curvature of h and the quotient material/stiffness: every h_l has its
// range over its allowance, the sum of the ranges is multiplied by the quotient's own range. Tools
// are opposed when their a have both signs; nothing else decides it.
#include "accuracy/scatter.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "base/random.h"

namespace aircut::accuracy {
namespace {

double power(double t, double exponent) { return exponent == 1 ? t : std::pow(t, exponent); }

struct Limits {
  double low = 0, high = 0;
  void take(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

// Places inside (from, to) where h'(t) = 0. With the smallest exponent taken out, the derivative is
// g(t) = p0 + p1 t^d1 + p2 t^d2, which turns at most once, at a place in closed form; between such
// places g is monotone and is bisected.
std::vector<double> turning_points(const ToolShare& tool, double from, double to) {
  struct Term {
    double exponent, factor;
  };
  std::array<Term, 3> terms{};
  for (std::size_t i = 0; i < 3; ++i)
    terms[i] = {tool.exponent[i], tool.gain[i] * tool.exponent[i]};
  std::sort(terms.begin(), terms.end(),
            [](const Term& a, const Term& b) { return a.exponent < b.exponent; });
  const double d1 = terms[1].exponent - terms[0].exponent,
               d2 = terms[2].exponent - terms[0].exponent;
  const auto g = [&](double t) {
    return terms[0].factor + terms[1].factor * power(t, d1) + terms[2].factor * power(t, d2);
  };
  std::vector<double> parts = {from};
  const double quotient = -terms[1].factor * d1 / (terms[2].factor * d2);
  if (d2 > d1 && quotient > 0 && std::isfinite(quotient)) {
    const double turn = std::pow(quotient, 1 / (d2 - d1));
    if (turn > from && turn < to) parts.push_back(turn);
  }
  parts.push_back(to);
  std::vector<double> out;
  for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
    double low = parts[i], high = parts[i + 1];
    const double sign = g(low);
    if (!(sign * g(high) < 0)) continue;
    for (int step = 0; step < 200 && high - low > 1e-15 * high; ++step) {
      const double middle = 0.5 * (low + high);
      (g(middle) * sign > 0 ? low : high) = middle;
    }
    out.push_back(0.5 * (low + high));
  }
  return out;
}

Limits range(const ToolShare& tool) {
  const double from = std::max(0.0, tool.t - tool.dt / 2), to = std::max(0.0, tool.t + tool.dt / 2);
  Limits out{tool.at(from), tool.at(from)};
  out.take(tool.at(to));
  for (const double t : turning_points(tool, from, to)) out.take(tool.at(t));
  return out;
}

// The sum of the ranges times a factor inside [least, most] > 0.
ExactField scaled(const Limits& inner, double least, double most) {
  return {inner.low * (inner.low >= 0 ? least : most),
          inner.high * (inner.high >= 0 ? most : least), inner.low, inner.high};
}

}  // namespace

Vec3 DepthForce::force(double t) const {
  Vec3 out = fixed;
  if (!(t > 0)) return out;
  for (const Term& term : terms)
    if (term.factor != 0) out += term.factor * power(t, term.exponent) * term.direction;
  return out;
}

Vec3 DepthForce::slope(double t) const {
  Vec3 out = Vec3::Zero();
  if (!(t > 0)) return out;
  for (const Term& term : terms)
    if (term.factor != 0)
      out += term.factor * term.exponent * std::pow(t, term.exponent - 1) * term.direction;
  return out;
}

double ToolShare::at(double depth) const {
  double out = offset;
  if (!(depth > 0)) return out;
  for (std::size_t i = 0; i < 3; ++i)
    if (gain[i] != 0) out += gain[i] * power(depth, exponent[i]);
  return out;
}

double ToolShare::slope(double depth) const {
  double out = 0;
  if (!(depth > 0)) return out;
  for (std::size_t i = 0; i < 3; ++i)
    if (gain[i] != 0) out += gain[i] * exponent[i] * std::pow(depth, exponent[i] - 1);
  return out;
}

ToolShare tool_share(const DepthForce& force, const Vec3& row, const Vec3& moment_row, double t,
                     double dt) {
  ToolShare out;
  for (std::size_t i = 0; i < 3; ++i) {
    const DepthForce::Term& term = force.terms[i];
    out.gain[i] = row.dot(term.direction) * term.factor;
    out.exponent[i] = term.exponent;
  }
  out.offset = row.dot(force.fixed) + moment_row.dot(force.moment);
  out.t = t;
  out.dt = dt;
  return out;
}

LinearField linear_field(std::span<const double> a, std::span<const double> b,
                         std::span<const double> dt, const Bands& bands) {
  LinearField out;
  bool plus = false, minus = false;
  for (std::size_t l = 0; l < a.size(); ++l) {
    out.N += a[l];
    out.D += 0.5 * std::abs(b[l]) * dt[l];
    plus = plus || a[l] > 0;
    minus = minus || a[l] < 0;
  }
  out.opposed = plus && minus;
  out.which = out.N >= out.D    ? FieldCase::all_positive
              : out.N <= -out.D ? FieldCase::all_negative
                                : FieldCase::zero_inside;
  const double half = 0.5 * (bands.epsilon + bands.nu);
  const double high = out.N + out.D, low = out.N - out.D;
  out.high = (out.which == FieldCase::all_negative ? 1 - half : 1 + half) * high;
  out.low = (out.which == FieldCase::all_positive ? 1 - half : 1 + half) * low;
  out.width = 2 * out.D + 2 * half * std::max(std::abs(out.N), out.D);
  return out;
}

ExactField exact_field(std::span<const ToolShare> tools, const Bands& bands) {
  Limits sum;
  for (const ToolShare& tool : tools) {
    const Limits one = range(tool);
    sum.low += one.low;
    sum.high += one.high;
  }
  return scaled(sum, (1 - bands.nu / 2) / (1 + bands.epsilon / 2),
                (1 + bands.nu / 2) / (1 - bands.epsilon / 2));
}

ExactField independent_field(std::span<const BodyShare> bodies, double nu) {
  // For given stiffness factors the best depths are found tool by tool; the result is convex in the
  // factors (a maximum of linear functions), so its extremes are at their corners.
  std::vector<std::size_t> varying;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (bodies[b].epsilon > 0) varying.push_back(b);
  assert(varying.size() <= most_independent_bodies);
  const std::size_t tools = bodies.empty() ? 0 : bodies[0].tools.size();
  Limits hull, allowances;
  for (std::size_t corner = 0; corner < (std::size_t{1} << varying.size()); ++corner) {
    Limits sum;
    for (std::size_t l = 0; l < tools; ++l) {
      ToolShare all = bodies[0].tools[l];
      all.gain = {};
      all.offset = 0;
      for (std::size_t b = 0, bit = 0; b < bodies.size(); ++b) {
        double factor = 1;
        if (bodies[b].epsilon > 0)
          factor = 1 / (1 + (((corner >> bit++) & 1) != 0 ? -0.5 : 0.5) * bodies[b].epsilon);
        for (std::size_t i = 0; i < 3; ++i) all.gain[i] += factor * bodies[b].tools[l].gain[i];
        all.offset += factor * bodies[b].tools[l].offset;
      }
      const Limits one = range(all);
      sum.low += one.low;
      sum.high += one.high;
    }
    const ExactField field = scaled(sum, 1 - nu / 2, 1 + nu / 2);
    if (corner == 0) hull = {field.low, field.high}, allowances = sum;
    hull = {std::min(hull.low, field.low), std::max(hull.high, field.high)};
    allowances = {std::min(allowances.low, sum.low), std::max(allowances.high, sum.high)};
  }
  return {hull.low, hull.high, allowances.low, allowances.high};
}

Sample monte_carlo(std::span<const ToolShare> tools, const Bands& bands, const Draws& draws) {
  Random random(draws.seed);
  // Around 0 with the full width `width`; the normal shape is not cut off, as a batch is not.
  const auto draw = [&](double width) {
    if (draws.shape == Draws::Shape::uniform) return width * random.between(-0.5, 0.5);
    const double u = 1 - random.between(0, 1), v = random.between(0, 1);  // u in (0, 1]
    return width / 6 * std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
  };
  std::vector<double> values(draws.count);
  for (double& value : values) {
    const double stiffness = 1 + draw(bands.epsilon), material = 1 + draw(bands.nu);
    double sum = 0;
    for (const ToolShare& tool : tools) sum += tool.at(tool.t + draw(tool.dt));
    value = sum * material / stiffness;
  }
  Sample out;
  if (values.empty()) return out;
  for (const double value : values)
    if (!std::isfinite(value)) {  // forces far too large: there is nothing to sort
      out.mean = out.sigma = out.low = out.high = out.q_low = out.q_high = value;
      return out;
    }
  const double n = static_cast<double>(values.size());
  for (const double value : values) out.mean += value / n;
  for (const double value : values) out.sigma += (value - out.mean) * (value - out.mean);
  out.sigma = values.size() > 1 ? std::sqrt(out.sigma / (n - 1)) : 0;
  // Straight between the two neighbours of the wanted rank.
  const auto quantile = [&](double p) {
    const double rank = p * (n - 1);
    const auto below = values.begin() + static_cast<std::ptrdiff_t>(rank);
    std::nth_element(values.begin(), below, values.end());
    const double first = *below;
    if (below + 1 == values.end()) return first;
    const double second = *std::min_element(below + 1, values.end());
    return first + (rank - std::floor(rank)) * (second - first);
  };
  out.q_low = quantile(0.00135);
  out.q_high = quantile(0.99865);
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  out.low = *least;
  out.high = *most;
  return out;
}

namespace {

// ISO 286-1, µm: rows by the largest size of the range, columns IT6 … IT13.
struct ItRow {
  double up_to;
  std::array<double, 8> grades;
};
constexpr std::array<ItRow, 13> it_table = {{
    {3, {6, 10, 14, 25, 40, 60, 100, 140}},
    {6, {8, 12, 18, 30, 48, 75, 120, 180}},
    {10, {9, 15, 22, 36, 58, 90, 150, 220}},
    {18, {11, 18, 27, 43, 70, 110, 180, 270}},
    {30, {13, 21, 33, 52, 84, 130, 210, 330}},
    {50, {16, 25, 39, 62, 100, 160, 250, 390}},
    {80, {19, 30, 46, 74, 120, 190, 300, 460}},
    {120, {22, 35, 54, 87, 140, 220, 350, 540}},
    {180, {25, 40, 63, 100, 160, 250, 400, 630}},
    {250, {29, 46, 72, 115, 185, 290, 460, 720}},
    {315, {32, 52, 81, 130, 210, 320, 520, 810}},
    {400, {36, 57, 89, 140, 230, 360, 570, 890}},
    {500, {40, 63, 97, 155, 250, 400, 630, 970}},
}};

}  // namespace

std::optional<double> it_tolerance(double size, int grade) {
  if (!(size > 0) || grade < 6 || grade > 13) return std::nullopt;
  for (const ItRow& row : it_table)
    if (size <= row.up_to) return row.grades[static_cast<std::size_t>(grade - 6)] / 1000;
  return std::nullopt;
}

std::optional<int> it_grade_of(double size, double width) {
  for (int grade = 6; grade <= 13; ++grade)
    if (const auto tolerance = it_tolerance(size, grade); tolerance && width <= *tolerance)
      return grade;
  return std::nullopt;
}

Capability capability(double low, double high, double tolerance_low, double tolerance_high,
                      bool compensate) {
  if (compensate) {
    const double shift = 0.5 * (tolerance_low + tolerance_high) - 0.5 * (low + high);
    low += shift;
    high += shift;
  }
  Capability out;
  if (high > low) out.cp = (tolerance_high - tolerance_low) / (high - low);
  out.fits = low >= tolerance_low && high <= tolerance_high;
  return out;
}

}  // namespace aircut::accuracy
