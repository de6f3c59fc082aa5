// How far a size scatters over a batch: stiffness, strength of the material and each tool's
// allowance vary inside their bands. Linear field, exact field, each body with a band of its own,
// and random draws. Also IT grades and capability.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "geometry/geometry.h"

namespace aircut::accuracy {

/// A cutting force on the tool as a function of the depth t: a sum of powers of t with fixed
/// directions, and a part that does not know the depth.
struct DepthForce {
  struct Term {
    Vec3 direction = Vec3::Zero();
    double factor = 0;  ///< N at t = 1 mm
    double exponent = 1;
  };
  std::array<Term, 3> terms;
  Vec3 fixed = Vec3::Zero();   ///< N
  Vec3 moment = Vec3::Zero();  ///< free moment, N·mm

  Vec3 force(double t) const;  ///< 0 for the terms when t ≤ 0
  Vec3 slope(double t) const;  ///< ∂F/∂t
};

/// The displacement in one direction that one tool causes: h(t) = Σ gain t^exponent + offset, with
/// its allowance.
struct ToolShare {
  std::array<double, 3> gain{};
  std::array<double, 3> exponent{};
  double offset = 0;
  double t = 0, dt = 0;  ///< depth, full width of the allowance

  double at(double depth) const;
  double slope(double depth) const;
};
/// `row`: displacement per force, `moment_row`: per free moment.
ToolShare tool_share(const DepthForce& force, const Vec3& row, const Vec3& moment_row, double t,
                     double dt);

/// Full widths of the relative bands.
struct Bands {
  double epsilon = 0;  ///< of the stiffness
  double nu = 0;       ///< of the material's strength
};

enum class FieldCase { all_positive, all_negative, zero_inside };  // I, II, III

struct LinearField {
  bool opposed = false;  ///< tools of both signs
  FieldCase which = FieldCase::all_positive;
  double N = 0, D = 0;
  double low = 0, high = 0, width = 0;
};
/// `a`: nominal parts of the tools, `b`: their slopes, `dt`: their allowances.
LinearField linear_field(std::span<const double> a, std::span<const double> b,
                         std::span<const double> dt, const Bands& bands);

struct ExactField {
  double low = 0, high = 0;
  double inner_low = 0, inner_high = 0;  ///< from the allowances alone
  double width() const { return high - low; }
};
/// The attained hull, without linearising.
ExactField exact_field(std::span<const ToolShare> tools, const Bands& bands);

/// The part of one body in every tool's share, and the band of its own stiffness.
struct BodyShare {
  std::vector<ToolShare> tools;
  double epsilon = 0;
};
constexpr std::size_t most_independent_bodies = 16;
/// The hull when every body's stiffness varies by itself. At most `most_independent_bodies` bodies
/// may have an epsilon above 0.
ExactField independent_field(std::span<const BodyShare> bodies, double nu);

struct Draws {
  enum class Shape { uniform, normal } shape = Shape::uniform;  ///< normal: σ = width / 6
  std::uint64_t seed = 1;
  std::size_t count = 10000;
};
struct Sample {
  double mean = 0, sigma = 0;
  double low = 0, high = 0;      ///< of all draws
  double q_low = 0, q_high = 0;  ///< 0.135 % and 99.865 %
};
/// The same seed gives the same numbers: each draw takes stiffness, material, then the tools in
/// order.
Sample monte_carlo(std::span<const ToolShare> tools, const Bands& bands, const Draws& draws);

/// Tolerance of an IT grade (6 … 13) for a size (0 … 500 mm), mm; nothing outside.
std::optional<double> it_tolerance(double size, int grade);
/// The finest grade whose tolerance holds `width`, mm.
std::optional<int> it_grade_of(double size, double width);

struct Capability {
  double cp = 0;  ///< tolerance / field; 0 when the field has no width
  bool fits = false;
};
/// `low`, `high` of the error and of the tolerance; `compensate` first moves the field's middle to
/// the tolerance's.
Capability capability(double low, double high, double tolerance_low, double tolerance_high,
                      bool compensate);

}  // namespace aircut::accuracy
