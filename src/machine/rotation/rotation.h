// Orientations given by three turns, in all twelve conventions, and frames made of them: what a
// rotation cycle like CYCLE600 computes. Angles rad, lengths mm.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "base/base.h"
#include "geometry/geometry.h"

namespace aircut::machine {

/// The axes of three turns in the order in which their angles are listed, and what they turn with:
/// the axes that the turns before have moved (intrinsic), or the fixed ones (extrinsic).
struct RotationConvention {
  std::array<int, 3> axes = {0, 1, 2};  ///< a permutation; 0 is X
  bool intrinsic = true;
  bool operator==(const RotationConvention&) const = default;
};

/// All twelve: XYZ XZY YXZ YZX ZXY ZYX, each intrinsic and extrinsic.
const std::array<RotationConvention, 12>& rotation_conventions();
/// `XYZ-int`, `ZXY-ext`.
std::string name_of(const RotationConvention& convention);
/// Number of an order: first axis + 4 · second + 16 · third, X = 1, Y = 2, Z = 3.
int bin_of(const RotationConvention& convention);
/// The order of a number; the error lists those that exist.
tl::expected<RotationConvention, std::string> convention_of_bin(double bin, bool intrinsic);
/// `XYZ-int`, `57-ext`, in either case.
tl::expected<RotationConvention, std::string> convention_of_name(std::string_view name);

/// Columns are the turned axes seen from the fixed ones.
Mat3 matrix_of(const RotationConvention& convention, const Vec3& angles);

/// XYZ-ext, the convention of our files: about the fixed X, then Y, then Z axis.
Mat3 about_fixed_axes(const Vec3& angles);

struct RotationAngles {
  Vec3 angles = Vec3::Zero();  ///< in the order of the axes; the second within ±90°
  bool locked = false;  ///< the second is ±90°: only the sum or difference of the others counts,
                        ///< and the third is set to zero
};
RotationAngles angles_of(const RotationConvention& convention, const Mat3& R);
/// The other three angles of the same matrix: (θ1 ± 180, 180 − θ2, θ3 ± 180), each in (−180, 180].
Vec3 other_angles(const Vec3& angles);
/// What keeps a matrix from being a rotation (1e-6); nothing when it is one.
std::optional<std::string> why_no_rotation(const Mat3& R);

/// One use of a rotation cycle: shift to the reference point, turn, shift along the turned axes.
struct RotationStep {
  Vec3 before = Vec3::Zero();
  Vec3 angles = Vec3::Zero();
  Vec3 after = Vec3::Zero();
  RotationConvention convention;
};
/// The new frame seen from the old one: Trans(before) · R · Trans(after).
Pose frame_of(const RotationStep& step);
/// A step on top of a frame. Intrinsic: along and about the frame's own axes. Extrinsic: about the
/// fixed axes, with the frame's origin kept.
Pose added(const Pose& frame, const RotationStep& step);

/// The angle by which a tool that reached R_head must be rolled about its axis to be in R: positive
/// about +z. Both have the same z.
double residual_roll(const Mat3& R, const Mat3& R_head);

}  // namespace aircut::machine
