// The frame that a program puts between its words and the work system on Fanuc-like controls:
// mirror image (G51.1), scaling (G51) and rotation (G68).
#pragma once

#include <array>

#include "canon/canon.h"

namespace aircut::interp {

/// work = turn(scale(mirror(program))), each about its own point; X Y Z in mm. The members say what
/// the program has asked for; update() makes the map of them.
struct ProgramFrame {
  std::array<bool, 3> mirrored{};
  Vec3 mirror_at = Vec3::Zero();  ///< program coordinates; only of mirrored axes
  bool scaled = false;
  Vec3 factors = Vec3::Ones();   ///< below 0: mirrored too
  Vec3 scale_at = Vec3::Zero();  ///< behind the mirror
  bool turned = false;
  double angle = 0;  ///< rad, counter-clockwise seen from the tip of the plane's normal
  canon::Plane plane = canon::Plane::xy;
  Vec3 turn_at = Vec3::Zero();  ///< behind mirror and scaling

  /// To be called after a change of the members above.
  void update();

  bool active() const { return active_; }
  const Mat3& linear() const { return linear_; }
  const Vec3& shift() const { return shift_; }
  Vec3 apply(const Vec3& program) const { return linear_ * program + shift_; }
  /// The exact inverse of apply().
  Vec3 undo(const Vec3& work) const { return inverse_ * (work - shift_); }

  bool any_mirror() const { return mirrored[0] || mirrored[1] || mirrored[2]; }
  /// Where mirror, or mirror and scaling, put a point.
  Vec3 behind_mirror(const Vec3& program) const;
  Vec3 behind_scaling(const Vec3& program) const;
  /// Whether an odd number of the plane's axes is mirrored, so that left becomes right.
  bool swaps_sides(int first, int second) const;

 private:
  bool active_ = false;
  Mat3 linear_ = Mat3::Identity();
  Mat3 inverse_ = Mat3::Identity();
  Vec3 shift_ = Vec3::Zero();
};

}  // namespace aircut::interp
