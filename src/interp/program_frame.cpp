// The order of the three steps is that of the controls' manuals: words are mirrored first, then
// scaled, then turned. A centre is a program coordinate too, so the steps before it act on it: the
// centre of a rotation is mirrored and scaled, and behind a mirror of one axis the rotation runs
// the other way round.
//
//   M p = m ∘ (p − cm) + cm      m = ±1 per axis
//   S p = k ∘ (p − cs) + cs      k = factor per axis
//   R p = Q (p − cr) + cr        Q turns the plane by the angle
#include "interp/program_frame.h"

#include <cmath>

namespace aircut::interp {
namespace {

Vec3 signs(const ProgramFrame& frame) {
  Vec3 sign = Vec3::Ones();
  for (int i = 0; i < 3; ++i)
    if (frame.mirrored[static_cast<std::size_t>(i)]) sign[i] = -1;
  return sign;
}

int first_of(canon::Plane plane) {
  return plane == canon::Plane::xy ? 0 : plane == canon::Plane::zx ? 2 : 1;
}

// A quarter turn is exact.
double snapped(double value) { return std::fabs(value) < 1e-15 ? 0 : value; }

Mat3 turn_about(canon::Plane plane, double angle) {
  const int first = first_of(plane), second = (first + 1) % 3;
  const double c = snapped(std::cos(angle)), s = snapped(std::sin(angle));
  Mat3 turn = Mat3::Identity();
  turn(first, first) = turn(second, second) = c;
  turn(first, second) = -s;
  turn(second, first) = s;
  return turn;
}

}  // namespace

Vec3 ProgramFrame::behind_mirror(const Vec3& program) const {
  return signs(*this).cwiseProduct(program - mirror_at) + mirror_at;
}

Vec3 ProgramFrame::behind_scaling(const Vec3& program) const {
  const Vec3 p = behind_mirror(program);
  return scaled ? Vec3(factors.cwiseProduct(p - scale_at) + scale_at) : p;
}

bool ProgramFrame::swaps_sides(int first, int second) const {
  const Vec3 sign = signs(*this).cwiseProduct(factors);
  return sign[first] * sign[second] < 0;
}

void ProgramFrame::update() {
  active_ = any_mirror() || scaled || turned;
  // A mirror of one axis of the plane lets the rotation run the other way round.
  const int first = first_of(plane), second = (first + 1) % 3;
  const bool reversed =
      mirrored[static_cast<std::size_t>(first)] != mirrored[static_cast<std::size_t>(second)];
  const Mat3 turn = turned ? turn_about(plane, reversed ? -angle : angle) : Mat3::Identity();
  const Vec3 factor = signs(*this).cwiseProduct(scaled ? factors : Vec3::Ones());
  linear_ = turn * factor.asDiagonal();
  inverse_ = factor.cwiseInverse().asDiagonal() * turn.transpose();
  const Vec3 centre = turned ? turn_at : Vec3::Zero();
  shift_ = turn * (behind_scaling(Vec3::Zero()) - centre) + centre;
}

}  // namespace aircut::interp
