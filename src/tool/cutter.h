// Outlines of cutters, from the words people use for them. Private to tool.
#pragma once

#include <string>

#include "geometry/geometry.h"

namespace aircut::tool {

/// How far, mm, an outline may lie outside of the arc that it stands for.
inline constexpr double arc_tolerance = 0.002;

/// The seven parameters of APT's CUTTER statement. Lengths mm, angles rad.
///
///        z            upper line, leaning outwards by b
///        |           /
///        |          /
///        |     C   |      C = (e, f): centre of the corner circle, radius r
///        |         /
///        |      _-´       lower line, rising by a from the tip
///        |__--´           d/2: where the two lines, extended, meet
///        +------------- r
struct Apt {
  double d = 0, r = 0, e = 0, f = 0, a = 0, b = 0, h = 0;
};

/// What is wrong with a shape, and which parameter says so.
struct ShapeError {
  std::string key;
  std::string message;
};

/// Outline of an APT cutter from the tip to its height h. Checks that both lines touch the corner
/// circle within 1e-6 mm and that the outline doesn't cross itself.
tl::expected<Profile, ShapeError> apt_outline(const Apt& cutter);

/// Outline of an APT cutter of which diameter, corner radius and angles are known: e and f follow
/// from the lines being tangent. `d` is twice the radius at which the lines meet.
Apt apt_with_corner(double d, double corner_radius, double a, double b, double h);

/// Adds pieces that lie outside of an arc by at most arc_tolerance: tangents of the circle at
/// equal angles. The angles (rad, 0 along +r, growing counter-clockwise) must grow.
void append_arc(Profile& outline, double centre_r, double centre_z, double radius, double from,
                double to);

/// Adds a point; z never goes down, and a repeated point is left out.
void append_point(Profile& outline, double r, double z);

}  // namespace aircut::tool
