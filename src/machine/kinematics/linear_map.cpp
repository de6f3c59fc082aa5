// Machines whose joints are sums of X, Y and Z:
//
//   calibrated   q = M·p with nine coefficients: axes that are not square, or not straight to scale
//   corexy       two motors move two axes by belts: q1 = u + v, q2 = u − v for the pair u v of axes
//   gantry       two drives move one axis: q1 = q2, and their difference over the span is a skew
//
// One matrix holds them, q = M·(tip + tool − offset). Forward goes by its left inverse, the mean of
// what several joints say about an axis; joints that contradict each other are refused.
#include <Eigen/LU>

#include "machine/kinematics/model.h"
#include "machine/kinematics/parameters.h"

namespace aircut::machine {

namespace {

template <int n>
struct LinearMap : BasicModel {
  static constexpr int joints = n, passives = 3;
  using Matrix = Eigen::Matrix<double, n, 3>;
  std::string_view name;
  Matrix M = Matrix::Zero();
  Eigen::Matrix<double, 3, n> back = Eigen::Matrix<double, 3, n>::Zero();
  Vec3 offset = Vec3::Zero();
  bool follows = false;               ///< the tree has couples for the axes themselves
  double span = 0, largest_skew = 0;  ///< gantry: mm between the drives (joints 1 and 2), rad

  std::string_view type() const { return name; }
  AxisSet axes() const { return axes_of("XYZ"); }
  std::vector<std::string> passive_names() const {
    if (!follows) return {};
    return {"platform_x", "platform_y", "platform_z"};
  }
  int passive_count() const { return follows ? 3 : 0; }
  void couple(JointVector& q) const {
    if (span > 0) q[1] = q[0];
  }

  template <class T>
  std::array<T, joints + passives> solve(const PoseWords<T>& tip, const Vec3& tool, int) const {
    Vector<T> p;
    std::array<T, joints + passives> q{};
    for (int i = 0; i < 3; ++i) {
      p[static_cast<std::size_t>(i)] = tip[static_cast<std::size_t>(i)] + T(tool[i] - offset[i]);
      q[static_cast<std::size_t>(joints + i)] = p[static_cast<std::size_t>(i)];
    }
    for (int j = 0; j < n; ++j) q[static_cast<std::size_t>(j)] = dot(Vec3(M.row(j)), p);
    return q;
  }

  std::optional<std::string> why_not(const PoseWords<double>&, const Vec3&, int) const {
    return std::nullopt;
  }

  tl::expected<AxisValues, ReachError> forward(const JointVector& q, const Vec3& tool) const {
    if (span > 0 && std::abs(q[0] - q[1]) > span * std::tan(largest_skew))
      return unexpected(
          ReachError{"the gantry is skewed by " +
                     fixed(std::atan2(q[0] - q[1], span) * 180 / std::numbers::pi, 4) +
                     " degrees: its drives are " + fixed(std::abs(q[0] - q[1]), 3) +
                     " mm apart from each other, " + fixed(span * std::tan(largest_skew), 3) +
                     " mm are allowed"});
    const Eigen::Matrix<double, n, 1> values = q;
    const Vec3 p = back * values + offset - tool;
    AxisValues tip;
    for (int i = 0; i < 3; ++i) tip[all_axes[static_cast<std::size_t>(i)]] = p[i];
    return tip;
  }

  void finish() { back = (M.transpose() * M).inverse() * M.transpose(); }
};

}  // namespace

std::shared_ptr<const Kinematics> read_calibrated(KinematicsInput& input) {
  Parameters p(input);
  p.joints("TTT");
  LinearMap<3> model;
  model.name = "calibrated";
  model.M = Mat3::Identity();
  if (input.table.has("matrix")) {
    const auto values = input.table.numbers("matrix", 9);
    if (!values) return nullptr;
    for (int i = 0; i < 9; ++i) model.M(i / 3, i % 3) = (*values)[static_cast<std::size_t>(i)];
  }
  const double volume = model.M.determinant();
  if (!(std::abs(volume) > 1e-6) || !(model.M.cwiseAbs().maxCoeff() < 1e6))
    p.fail("matrix", "'matrix' has the determinant " + shortest(volume) +
                         ": its axes do not reach every point");
  model.offset = p.point("offset", Vec3::Zero());
  model.follows = p.drawn("platform");
  model.finish();
  return p.good() ? make_model(model) : nullptr;
}

std::shared_ptr<const Kinematics> read_corexy(KinematicsInput& input) {
  Parameters p(input);
  p.joints("TTT");
  LinearMap<3> model;
  model.name = "corexy";
  const std::string pair = p.choice("pair", {"XY", "XZ", "YZ"});
  const int u = pair[0] - 'X', v = pair[1] - 'X';
  model.M(0, u) = model.M(0, v) = model.M(1, u) = 1;
  model.M(1, v) = -1;
  model.M(2, 3 - u - v) = 1;
  model.offset = p.point("offset", Vec3::Zero());
  model.follows = p.drawn("platform");
  model.finish();
  return p.good() ? make_model(model) : nullptr;
}

std::shared_ptr<const Kinematics> read_gantry(KinematicsInput& input) {
  Parameters p(input);
  p.joints("TTTT");
  LinearMap<4> model;
  model.name = "gantry";
  const int doubled = p.choice("axis", {"X", "Y", "Z"})[0] - 'X';
  model.M(0, doubled) = model.M(1, doubled) = 1;
  for (int axis = 0, joint = 2; axis < 3; ++axis)
    if (axis != doubled) model.M(joint++, axis) = 1;
  model.span = p.positive("span", 1000);
  model.largest_skew = p.angle("skew_max", 0.05);
  if (!(model.largest_skew > 0 && model.largest_skew < 1))
    p.fail("skew_max", "'skew_max' must be more than 0 and less than 57 degrees");
  model.offset = p.point("offset", Vec3::Zero());
  model.follows = p.drawn("platform");
  model.finish();
  return p.good() ? make_model(model) : nullptr;
}

}  // namespace aircut::machine
