// With the order i j k of the axes, ε = +1 when it is an even permutation of X Y Z, else −1:
//
//   intrinsic   R = R_i(θ1) · R_j(θ2) · R_k(θ3)        extrinsic   R = R_k(θ3) · R_j(θ2) · R_i(θ1)
//
// so the extrinsic angles of i j k are the intrinsic ones of k j i in reverse, and one formula
// reads both:
//
//   θ2 = atan2(ε R_ik, hypot(R_ii, R_ij)),  θ1 = atan2(−ε R_jk, R_kk),  θ3 = atan2(−ε R_ij, R_ii)
//
// (kinematics.md d.2). At θ2 = ±90° the first and the third turn are about one line: the angle that
// is listed third becomes zero and the one listed first takes the whole turn.
#include "machine/rotation/rotation.h"

#include <cmath>
#include <numbers>

namespace aircut::machine {

namespace {

constexpr double pi = std::numbers::pi;

constexpr std::array<std::array<int, 3>, 6> orders = {
    {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};

double parity(const std::array<int, 3>& axes) { return (axes[1] - axes[0] + 3) % 3 == 1 ? 1 : -1; }

Mat3 turn(int axis, double angle) {
  return Eigen::AngleAxisd(angle, Vec3::Unit(axis)).toRotationMatrix();
}

double wrapped(double angle) {
  const double w = std::remainder(angle, 2 * pi);
  return w <= -pi ? pi : w;
}

}  // namespace

const std::array<RotationConvention, 12>& rotation_conventions() {
  static const std::array<RotationConvention, 12> all = [] {
    std::array<RotationConvention, 12> list;
    for (std::size_t i = 0; i < orders.size(); ++i) {
      list[2 * i] = {orders[i], true};
      list[2 * i + 1] = {orders[i], false};
    }
    return list;
  }();
  return all;
}

std::string name_of(const RotationConvention& convention) {
  std::string name;
  for (const int axis : convention.axes) name += "XYZ"[axis];
  return name + (convention.intrinsic ? "-int" : "-ext");
}

int bin_of(const RotationConvention& convention) {
  const auto& a = convention.axes;
  return a[0] + 1 + 4 * (a[1] + 1) + 16 * (a[2] + 1);
}

tl::expected<RotationConvention, std::string> convention_of_bin(double bin, bool intrinsic) {
  std::string known;
  for (const RotationConvention& c : rotation_conventions()) {
    if (c.intrinsic != intrinsic) continue;
    if (bin_of(c) == bin) return c;
    known +=
        (known.empty() ? "" : ", ") + std::to_string(bin_of(c)) + " " + name_of(c).substr(0, 3);
  }
  return unexpected("BIN " + shortest(bin) + " is no order of three axes; there are " + known);
}

tl::expected<RotationConvention, std::string> convention_of_name(std::string_view name) {
  const std::size_t dash = name.find('-');
  std::string order, kind;
  for (const char c : name.substr(0, dash))
    order += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  if (dash != name.npos) kind = name.substr(dash + 1);
  if (kind == "int" || kind == "ext") {
    if (const auto bin = parse_number(order)) return convention_of_bin(*bin, kind == "int");
    for (const RotationConvention& c : rotation_conventions())
      if (name_of(c) == order + "-" + kind) return c;
  }
  std::vector<std::string> names;
  for (const RotationConvention& c : rotation_conventions()) names.push_back(name_of(c));
  return unexpected("'" + printable(name) +
                    "' is no rotation convention: it is an order of the axes or its BIN number, "
                    "and 'int' or 'ext', like XYZ-int or 57-ext." +
                    did_you_mean(order + "-" + kind, names));
}

Mat3 matrix_of(const RotationConvention& convention, const Vec3& angles) {
  const auto& a = convention.axes;
  const Mat3 first = turn(a[0], angles[0]), second = turn(a[1], angles[1]),
             third = turn(a[2], angles[2]);
  return convention.intrinsic ? Mat3(first * second * third) : Mat3(third * second * first);
}

Mat3 about_fixed_axes(const Vec3& angles) { return matrix_of({{0, 1, 2}, false}, angles); }

RotationAngles angles_of(const RotationConvention& convention, const Mat3& R) {
  std::array<int, 3> axes = convention.axes;
  if (!convention.intrinsic) std::swap(axes[0], axes[2]);
  const auto [i, j, k] = axes;
  const double e = parity(axes);
  const double flat = std::hypot(R(i, i), R(i, j));
  RotationAngles out;
  double outer, inner;
  constexpr double lock = 1e-9;
  if (flat < lock) {
    out.locked = true;
    outer = convention.intrinsic ? std::atan2(e * R(k, j), R(j, j)) : 0;
    inner = convention.intrinsic ? 0 : std::atan2(e * R(j, i), R(j, j));
  } else {
    outer = std::atan2(-e * R(j, k), R(k, k));
    inner = std::atan2(-e * R(i, j), R(i, i));
  }
  const double middle = std::atan2(e * R(i, k), flat);
  out.angles = convention.intrinsic ? Vec3(outer, middle, inner) : Vec3(inner, middle, outer);
  return out;
}

Vec3 other_angles(const Vec3& angles) {
  return {wrapped(angles[0] + pi), wrapped(pi - angles[1]), wrapped(angles[2] + pi)};
}

std::optional<std::string> why_no_rotation(const Mat3& R) {
  constexpr double slack = 1e-6;
  const double off = (R.transpose() * R - Mat3::Identity()).cwiseAbs().maxCoeff();
  if (!(off <= slack))
    return "the nine numbers are no rotation: rows and columns must be unit vectors at right "
           "angles to each other (they miss by " +
           shortest(off) + ")";
  if (R.determinant() < 0)
    return std::string("the nine numbers mirror: their determinant is -1, that of a rotation is 1");
  return std::nullopt;
}

Pose frame_of(const RotationStep& step) {
  Pose F = Pose::Identity();
  F.linear() = matrix_of(step.convention, step.angles);
  F.translation() = step.before + F.linear() * step.after;
  return F;
}

Pose added(const Pose& frame, const RotationStep& step) {
  if (step.convention.intrinsic) return frame * frame_of(step);
  Pose F = Pose::Identity();
  F.linear() = matrix_of(step.convention, step.angles) * frame.linear();
  F.translation() = frame.translation() + step.before + F.linear() * step.after;
  return F;
}

double residual_roll(const Mat3& R, const Mat3& R_head) {
  return std::atan2(R_head.col(1).dot(R.col(0)), R_head.col(0).dot(R.col(0)));
}

}  // namespace aircut::machine
