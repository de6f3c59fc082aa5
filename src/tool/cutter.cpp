// Outlines of cutters.
//
// A cutter by APT parameters (CUTTER/ d, r, e, f, a, b, h) is: the lower line from the tip (0, 0)
// rising by a; a corner circle of radius r about C = (e, f); the upper line leaning by b from the
// axis, up to the height h. With P = (d/2, d/2 tan a), where the lines meet, and the inner normals
//   n_low = (−sin a, cos a)     n_up = (−cos b, sin b)
// both lines touch the circle when
//   C · n_low = r               (C − P) · n_up = r,
// at the points C − r n_low and C − r n_up. The arc between them runs from the angle a − 90° to −b;
// it is replaced by the chain of tangents around it, so that the outline contains the tool.
#include "tool/cutter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/base.h"

namespace aircut::tool {
namespace {

constexpr double right_angle = std::numbers::pi / 2;
constexpr double tangent_tolerance = 1e-6;  // mm

std::string degrees(double angle) { return fixed(angle * 180 / std::numbers::pi, 3); }

}  // namespace

void append_point(Profile& outline, double r, double z) {
  r = std::max(r, 0.0);
  if (!outline.empty()) {
    z = std::max(z, outline.back().z);
    if (outline.back().r == r && outline.back().z == z) return;
  }
  outline.push_back({r, z});
}

void append_arc(Profile& outline, double centre_r, double centre_z, double radius, double from,
                double to) {
  const auto add = [&](double angle, double distance) {
    append_point(outline, centre_r + distance * std::cos(angle),
                 centre_z + distance * std::sin(angle));
  };
  // Corners of tangents that are δ apart lie at radius / cos(δ/2).
  const double half = std::acos(radius / (radius + arc_tolerance));
  const int count = std::max(1, static_cast<int>(std::ceil((to - from) / (2 * half) - 1e-9)));
  const double step = (to - from) / count;
  add(from, radius);
  for (int i = 0; i < count; ++i) add(from + (i + 0.5) * step, radius / std::cos(step / 2));
  add(to, radius);
}

Apt apt_with_corner(double d, double corner_radius, double a, double b, double h) {
  // Both tangency conditions, solved for C: it lies on the bisector of the lines.
  //   −e sin a + f cos a = r,   −(e − d/2) cos b + (f − d/2 tan a) sin b = r
  const double p_r = d / 2, p_z = d / 2 * std::tan(a);
  const double k = corner_radius + std::sin(b) * p_z - std::cos(b) * p_r;
  const double determinant = -std::sin(a) * std::sin(b) + std::cos(a) * std::cos(b);
  Apt out{.d = d, .r = corner_radius, .a = a, .b = b, .h = h};
  out.e = (corner_radius * std::sin(b) - k * std::cos(a)) / determinant;
  out.f = (-std::sin(a) * k + std::cos(b) * corner_radius) / determinant;
  if (std::abs(out.e) < 1e-9) out.e = 0;  // a ball's centre lies on the axis
  return out;
}

tl::expected<Profile, ShapeError> apt_outline(const Apt& c) {
  const auto fail = [](const char* key, std::string message) {
    return tl::unexpected(ShapeError{key, std::move(message)});
  };
  if (!(c.d > 0)) return fail("d", "the diameter must be more than 0");
  if (!(c.r >= 0)) return fail("r", "the corner radius must be 0 or more");
  if (!(c.e >= 0)) return fail("e", "the corner's centre can't lie beyond the axis");
  if (!(c.a >= 0 && c.a < right_angle))
    return fail("a", "the lower angle must be from 0 to less than 90 degrees");
  if (!(std::abs(c.b) < right_angle))
    return fail("b", "the upper angle must be between -90 and 90 degrees");
  if (!(c.a + c.b < right_angle))
    return fail("b", "the upper line never meets the lower one: the angles " + degrees(c.a) +
                         " and " + degrees(c.b) + " add up to 90 degrees or more");

  const double p_r = c.d / 2, p_z = c.d / 2 * std::tan(c.a);
  const double low = -c.e * std::sin(c.a) + c.f * std::cos(c.a);
  const double up = -(c.e - p_r) * std::cos(c.b) + (c.f - p_z) * std::sin(c.b);
  if (std::abs(low - c.r) > tangent_tolerance)
    return fail("f", "the lower line does not touch the corner circle: it passes its centre at " +
                         fixed(low, 6) + " mm, the corner radius is " + fixed(c.r, 6));
  if (std::abs(up - c.r) > tangent_tolerance)
    return fail("e", "the upper line does not touch the corner circle: it passes its centre at " +
                         fixed(up, 6) + " mm, the corner radius is " + fixed(c.r, 6));

  const double low_r = c.e + c.r * std::sin(c.a);
  const double up_z = c.f - c.r * std::sin(c.b);
  if (low_r < -tangent_tolerance)
    return fail("r", "the corner circle touches the lower line beyond the axis");
  if (!(c.h >= up_z))
    return fail("h", "the height " + fixed(c.h, 3) + " mm ends inside the corner, which needs " +
                         fixed(up_z, 3));
  const double up_r = c.e + c.r * std::cos(c.b);
  const double top_r = up_r + (c.h - up_z) * std::tan(c.b);
  if (top_r < 0) return fail("h", "the upper line reaches the axis below the height");

  Profile outline;
  append_point(outline, 0, 0);
  if (c.r > 0)
    append_arc(outline, c.e, c.f, c.r, c.a - right_angle, -c.b);
  else
    append_point(outline, p_r, p_z);
  append_point(outline, top_r, c.h);
  return outline;
}

}  // namespace aircut::tool
