// serial: an arm of any joints, given by Denavit-Hartenberg rows, solved numerically (no closed
// form is needed).
//
//   standard  Rz(θ)·Tz(d)·Tx(a)·Rx(α)      modified  Rx(α)·Tx(a)·Rz(θ)·Tz(d)
//
// A joint value adds to θ of its row (R) or to d (T). The tool frame T is flange · `tool`, M is
// seen from {0} through `base`, and the pose is R_MT = Rx(A)·Ry(B)·Rz(C): six joints or more follow
// it all, five follow the tip and the tool's direction, three and four the tip alone. With `angles`
// = "flange" (six joints) the words are those of the flange, R_MF = Rz(C)·Ry(B)·Rx(A), and R_MT is
// that with the tool's own turn.
//
// Inverse by damped least squares (kinematics.md e.4): with the error e = [Δp; λ·rotation vector],
// λ = 300 mm/rad,   Δq = Jᵀ(J Jᵀ + μ 1)⁻¹ e,   μ falls when |e| falls and grows when not; values
// are kept inside their limits. Starts: where the arm is, home, then eight places by a fixed
// generator. Between two solutions that were found the joints' ways are bounded by arm_bound.h, for
// arms with as many joints as the pose has freedoms; more joints have no proven bound, since what
// the numeric solution does with the spare one follows no equation.
#include <Eigen/LU>

#include "base/random.h"
#include "machine/kinematics/arm_bound.h"
#include "machine/kinematics/model.h"
#include "machine/kinematics/parameters.h"
#include "machine/kinematics/robot.h"
#include "machine/rotation/rotation.h"

namespace aircut::machine {

namespace {

struct DhRow {
  double theta = 0, d = 0, a = 0, alpha = 0;  ///< mm, rad
  bool rotary = true;
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
};

template <class T>
struct Frame {
  std::array<Vector<T>, 3> axes;  ///< x, y, z
  Vector<T> p;

  explicit Frame(const Pose& X) : p(vector_of<T>(X.translation())) {
    for (int i = 0; i < 3; ++i)
      axes[static_cast<std::size_t>(i)] = vector_of<T>(Vec3(X.linear().col(i)));
  }
  void shift(std::size_t axis, const T& by) {
    for (std::size_t i = 0; i < 3; ++i) p[i] = p[i] + by * axes[axis][i];
  }
  // About its own axis u: v = u + 1, w = u + 2.
  void turn(std::size_t u, const T& c, const T& s) {
    Vector<T>&v = axes[(u + 1) % 3], &w = axes[(u + 2) % 3];
    for (std::size_t i = 0; i < 3; ++i) {
      const T old = v[i];
      v[i] = c * old + s * w[i];
      w[i] = c * w[i] - s * old;
    }
  }
};

using Matrix = ArmMatrix;
using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;
using Column6 = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;

constexpr double lambda = 300;  // mm per rad

Vec3 rotation_vector(const Mat3& R) {
  const Vec3 w = Vec3(R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1)) / 2;
  const double s = w.norm();
  if (s < 1e-12) return w;
  return w * (std::atan2(s, (R.trace() - 1) / 2) / s);
}

class Serial final : public Kinematics {
 public:
  Serial(std::vector<DhRow> rows, bool modified, const Pose& base, const Pose& tool,
         const JointVector& home, bool of_flange)
      : rows_(std::move(rows)),
        modified_(modified),
        of_flange_(of_flange),
        base_(base),
        tool_(tool),
        home_(home) {
    for (const DhRow& row : rows_) twist_.push_back({std::cos(row.alpha), std::sin(row.alpha)});
  }

  std::string_view type() const override { return "serial"; }
  AxisSet axes() const override {
    return axes_of(freedom() == 6 ? "XYZABC" : freedom() == 5 ? "XYZAB" : "XYZ");
  }
  int joint_count() const override { return static_cast<int>(rows_.size()); }

  tl::expected<JointVector, ReachError> inverse(const Target& target,
                                                const JointVector& near) const override {
    if (const auto error = wrong_offset(target.tool_offset)) return unexpected(ReachError{*error});
    for (const double word : target.tip.value)
      if (!std::isfinite(word)) return unexpected(ReachError{"the pose is no number"});
    const Pose tip_on_flange = with_tool(target.tool_offset);
    const Pose wanted = wanted_pose(target.tip);
    double least = std::numeric_limits<double>::infinity();
    Random random(0x64687265);  // any fixed seed
    for (int start = 0; start < 10; ++start) {
      JointVector q = start == 0 ? near : home_;
      if (start >= 2)
        for (Eigen::Index j = 0; j < q.size(); ++j) {
          const DhRow& row = rows_[static_cast<std::size_t>(j)];
          const double wide = row.rotary ? std::numbers::pi : 1000;
          q[j] = random.between(std::max(row.min, -wide), std::min(row.max, wide));
        }
      const double error = refine(q, wanted, tip_on_flange);
      if (error < there_mm) {
        unwind(q, near);
        return q;
      }
      least = std::min(least, error);
    }
    return unexpected(ReachError{
        "the numeric solution ends " + fixed(least, 3) +
        " mm away (a radian counts as 300 mm): out of reach, beyond a limit, or singular"});
  }

  tl::expected<AxisValues, ReachError> forward(const JointVector& q,
                                               const AxisValues& tool_offset) const override {
    if (const auto error = wrong_offset(tool_offset)) return unexpected(ReachError{*error});
    const Frame<double> f = frame<double>(q, with_tool(tool_offset));
    AxisValues tip;
    for (std::size_t i = 0; i < 3; ++i) tip[all_axes[i]] = f.p[i];
    if (freedom() < 5) return tip;
    const auto& [x, y, z] = f.axes;
    if (of_flange_) {
      Mat3 R;
      R << vec3(x), vec3(y), vec3(z);
      const Vec3 angles = angles_of({{0, 1, 2}, false}, R * tool_.linear().transpose()).angles;
      for (std::size_t i = 0; i < 3; ++i) tip[all_axes[3 + i]] = angles[static_cast<int>(i)];
      return tip;
    }
    tip[Axis::a] = std::atan2(-z[1], z[2]);
    tip[Axis::b] = std::atan2(z[0], std::hypot(z[1], z[2]));
    if (freedom() == 6) tip[Axis::c] = std::atan2(-y[0], x[0]);
    return tip;
  }

  std::optional<Vec3> tool_axis(const AxisValues& tip) const override {
    if (freedom() < 5) return std::nullopt;
    if (of_flange_) return Vec3(attitude(tip).col(2));
    return tool_direction(tip[Axis::a], tip[Axis::b]);
  }

  // With x the pose of the arm and x* the wanted one: J q' = x*', and J q'' = x*'' − (x'' that q'
  // alone brings).
  bool rates(const Target& target, const JointVector& joints, const AxisValues& d_tip,
             const AxisValues& dd_tip, JointVector& dq, JointVector& ddq) const override {
    if (wrong_offset(target.tool_offset)) return false;
    const Pose tip_on_flange = with_tool(target.tool_offset);
    Matrix J;
    const Frame<double> f = frame<double>(joints, tip_on_flange);
    jacobian(joints, f, J);
    const Square N = J * J.transpose();
    const auto solver = N.partialPivLu();
    const Motion wanted = motion_of(wanted_frame(target, d_tip, dd_tip), f);
    dq = J.transpose() * solver.solve(wanted.first);
    const Motion own = motion_of(moving_frame(joints, dq, tip_on_flange), f);
    ddq = J.transpose() * solver.solve(Column6(wanted.second - own.second));
    return true;
  }

  bool travel_bound(const TipInterval& tip, std::span<double> travel) const override {
    if (joint_count() != freedom() || wrong_offset(tip.tool_offset)) return false;
    Target centre{{}, tip.tool_offset};
    for (const Axis axis : all_axes) {
      centre.tip[axis] = 0.5 * (tip.low[axis] + tip.high[axis]);
      if (!std::isfinite(centre.tip[axis])) return false;
    }
    JointVector q = tip.near.size() == joint_count() ? tip.near : home_;
    const Pose tip_on_flange = with_tool(tip.tool_offset);
    if (!(refine(q, wanted_pose(centre.tip), tip_on_flange) < there_mm)) return false;
    return bound_arm_travel(arm_at(q, centre, tip_on_flange), tip, travel);
  }

 private:
  static constexpr double there_mm = 1e-9;

  // R_MT of the words.
  Mat3 attitude(const AxisValues& tip) const {
    const Vec3 angles(tip[Axis::a], tip[Axis::b], tip[Axis::c]);
    return of_flange_ ? Mat3(about_fixed_axes(angles) * tool_.linear())
                      : matrix_of({{0, 1, 2}, true}, angles);
  }

  Pose wanted_pose(const AxisValues& tip) const {
    Pose wanted = translation(Vec3(tip[Axis::x], tip[Axis::y], tip[Axis::z]));
    wanted.linear() = attitude(tip);
    return wanted;
  }

  ArmAt arm_at(const JointVector& q, const Target& target, const Pose& tip_on_flange) const {
    ArmAt arm;
    arm.lambda = lambda;
    const Frame<double> at = frame<double>(q, tip_on_flange);
    jacobian(q, at, arm.jacobian);
    frame<double>(q, Pose::Identity(), [&](std::size_t j, const Frame<double>& f) {
      arm.reach[j] = (vec3(at.p) - vec3(f.p)).norm();
      arm.rotary[j] = rows_[j].rotary;
    });
    arm.words.resize(freedom(), 6);
    for (std::size_t i = 0; i < 6; ++i) {
      AxisValues unit;
      unit[all_axes[i]] = 1;
      arm.words.col(static_cast<Eigen::Index>(i)) =
          motion_of(wanted_frame(target, unit, {}), at).first;
    }
    return arm;
  }

  int freedom() const { return rows_.size() >= 6 ? 6 : rows_.size() == 5 ? 5 : 3; }

  std::optional<std::string> wrong_offset(const AxisValues& offset) const {
    for (const Axis axis : all_axes)
      if (index(axis) >= 3 && offset[axis] != 0)
        return std::string("a tool offset in ") + letter(axis) +
               " is not possible on this machine: tools have lengths along X, Y and Z";
    return std::nullopt;
  }

  // The controlled point is tip + offset, so the tip is at −offset of the gauge point.
  Pose with_tool(const AxisValues& offset) const {
    return tool_ * translation(-Vec3(offset[Axis::x], offset[Axis::y], offset[Axis::z]));
  }

  template <class T, class Values>
  Frame<T> frame(const Values& q, const Pose& tip_on_flange) const {
    return frame<T>(q, tip_on_flange, [](std::size_t, const Frame<T>&) {});
  }

  // `see` gets each joint's frame, whose z is the joint's axis.
  template <class T, class Values, class See>
  Frame<T> frame(const Values& q, const Pose& tip_on_flange, See&& see) const {
    using std::cos;
    using std::sin;
    Frame<T> f(base_);
    for (std::size_t j = 0; j < rows_.size(); ++j) {
      const DhRow& row = rows_[j];
      const T value = q[static_cast<Eigen::Index>(j)];
      const T theta = row.rotary ? value + T(row.theta) : T(row.theta);
      const T d = row.rotary ? T(row.d) : value + T(row.d);
      const T ca(twist_[j][0]), sa(twist_[j][1]);
      if (modified_) {
        f.turn(0, ca, sa);
        f.shift(0, T(row.a));
      }
      see(j, f);
      f.turn(2, cos(theta), sin(theta));
      f.shift(2, d);
      if (modified_) continue;
      f.shift(0, T(row.a));
      f.turn(0, ca, sa);
    }
    return on_flange(f, tip_on_flange);
  }

  template <class T>
  static Frame<T> on_flange(const Frame<T>& f, const Pose& X) {
    Frame<T> out = f;
    const auto combine = [&](const Vec3& v) {
      Vector<T> sum{};
      for (std::size_t i = 0; i < 3; ++i)
        sum[i] = T(v[0]) * f.axes[0][i] + T(v[1]) * f.axes[1][i] + T(v[2]) * f.axes[2][i];
      return sum;
    };
    out.p = f.p + combine(X.translation());
    for (int i = 0; i < 3; ++i) out.axes[static_cast<std::size_t>(i)] = combine(X.linear().col(i));
    return out;
  }

  // Rows of a turn w: all of λ·w, or only what moves the direction z of the tool, λ·e_i·(w × z).
  void turn_rows(const Frame<double>& f, const Vec3& w, Column6& out) const {
    if (freedom() == 6) out.segment<3>(3) = lambda * w;
    if (freedom() != 5) return;
    out[3] = lambda * vec3(f.axes[0]).dot(w.cross(vec3(f.axes[2])));
    out[4] = lambda * vec3(f.axes[1]).dot(w.cross(vec3(f.axes[2])));
  }

  void jacobian(const JointVector& q, const Frame<double>& tip, Matrix& J) const {
    J.resize(freedom(), joint_count());
    frame<double>(q, Pose::Identity(), [&](std::size_t j, const Frame<double>& f) {
      const Vec3 axis = vec3(f.axes[2]);
      const bool rotary = rows_[j].rotary;
      Column6 column = Column6::Zero(freedom());
      column.head<3>() = rotary ? Vec3(axis.cross(vec3(tip.p - f.p))) : axis;
      if (rotary) turn_rows(tip, axis, column);
      J.col(static_cast<Eigen::Index>(j)) = column;
    });
  }

  Column6 error_of(const Pose& wanted, const Frame<double>& at) const {
    Column6 e = Column6::Zero(freedom());
    e.head<3>() = wanted.translation() - vec3(at.p);
    Mat3 R;
    for (int i = 0; i < 3; ++i) R.col(i) = vec3(at.axes[static_cast<std::size_t>(i)]);
    if (freedom() == 6) e.segment<3>(3) = lambda * rotation_vector(wanted.linear() * R.transpose());
    if (freedom() == 5) {
      const Vec3 z = R.col(2), aim = wanted.linear().col(2), turn = z.cross(aim);
      const double s = turn.norm(), angle = std::atan2(s, z.dot(aim));
      turn_rows(at, s > 1e-12 ? Vec3(turn * (angle / s)) : turn, e);
      // Opposite directions: any turn does.
      if (s <= 1e-12 && z.dot(aim) < 0) e[3] = lambda * std::numbers::pi;
    }
    return e;
  }

  /// Moves q to the nearest solution; returns the error that is left.
  double refine(JointVector& q, const Pose& wanted, const Pose& tip_on_flange) const {
    double mu = 1;
    Frame<double> at = frame<double>(q, tip_on_flange);
    Column6 e = error_of(wanted, at);
    double error = e.norm();
    Matrix J;
    bool fresh = true;
    for (int round = 0; round < 200 && !(error < there_mm); ++round) {
      if (fresh) jacobian(q, at, J);
      Square N = J * J.transpose();
      N.diagonal().array() += mu;
      JointVector next = q + J.transpose() * N.partialPivLu().solve(e);
      for (Eigen::Index j = 0; j < next.size(); ++j) {
        const DhRow& row = rows_[static_cast<std::size_t>(j)];
        next[j] = std::clamp(next[j], row.min, row.max);
      }
      const Frame<double> there = frame<double>(next, tip_on_flange);
      const Column6 rest = error_of(wanted, there);
      fresh = rest.norm() < error;
      if (!std::isfinite(rest.norm()) || (!fresh && mu > 1e12)) break;
      mu = fresh ? std::max(mu * 0.2, 1e-9) : mu * 5;
      if (!fresh) continue;
      q = next;
      at = there;
      e = rest;
      error = rest.norm();
    }
    return error;
  }

  void unwind(JointVector& q, const JointVector& near) const {
    constexpr double turn = 2 * std::numbers::pi;
    for (Eigen::Index j = 0; j < q.size(); ++j) {
      const DhRow& row = rows_[static_cast<std::size_t>(j)];
      if (!row.rotary) continue;
      const double other = q[j] + turn * std::round((near[j] - q[j]) / turn);
      if (other >= row.min && other <= row.max) q[j] = other;
    }
  }

  /// First and second derivative of a pose, in the rows of the Jacobian.
  struct Motion {
    Column6 first, second;
  };
  Motion motion_of(const Frame<Jet>& m, const Frame<double>& at) const {
    const auto first = [](const Vector<Jet>& v) { return Vec3(v[0].d, v[1].d, v[2].d); };
    const auto second = [](const Vector<Jet>& v) { return Vec3(v[0].dd, v[1].dd, v[2].dd); };
    Motion out{Column6::Zero(freedom()), Column6::Zero(freedom())};
    out.first.head<3>() = first(m.p);
    out.second.head<3>() = second(m.p);
    if (freedom() == 5) {
      for (const int i : {0, 1}) {
        const Vec3 e = vec3(at.axes[static_cast<std::size_t>(i)]);
        out.first[3 + i] = lambda * e.dot(first(m.axes[2]));
        out.second[3 + i] = lambda * e.dot(second(m.axes[2]));
      }
    } else if (freedom() == 6) {
      // ω = ½ Σ a × a' over the axes a, and ω' = ½ Σ a × a''.
      Vec3 w = Vec3::Zero(), dw = Vec3::Zero();
      for (const Vector<Jet>& a : m.axes) {
        const Vec3 value(a[0].v, a[1].v, a[2].v);
        w += value.cross(first(a)) / 2;
        dw += value.cross(second(a)) / 2;
      }
      out.first.segment<3>(3) = lambda * w;
      out.second.segment<3>(3) = lambda * dw;
    }
    return out;
  }

  Frame<Jet> wanted_frame(const Target& target, const AxisValues& d, const AxisValues& dd) const {
    const auto jet = [&](Axis axis) { return Jet(target.tip[axis], d[axis], dd[axis]); };
    Frame<Jet> f(Pose::Identity());
    f.p = {jet(Axis::x), jet(Axis::y), jet(Axis::z)};
    const Jet a = jet(Axis::a), b = jet(Axis::b), c = jet(Axis::c);
    if (of_flange_) {
      f.turn(2, cos(c), sin(c));
      f.turn(1, cos(b), sin(b));
      f.turn(0, cos(a), sin(a));
      Pose turned = Pose::Identity();
      turned.linear() = tool_.linear();
      return on_flange(f, turned);
    }
    f.turn(0, cos(a), sin(a));
    f.turn(1, cos(b), sin(b));
    f.turn(2, cos(c), sin(c));
    return f;
  }

  Frame<Jet> moving_frame(const JointVector& q, const JointVector& dq,
                          const Pose& tip_on_flange) const {
    Eigen::Matrix<Jet, Eigen::Dynamic, 1, 0, max_joints, 1> values(q.size());
    for (Eigen::Index j = 0; j < q.size(); ++j) values[j] = Jet(q[j], dq[j], 0);
    return frame<Jet>(values, tip_on_flange);
  }

  std::vector<DhRow> rows_;
  bool modified_, of_flange_;
  Pose base_, tool_;
  JointVector home_;
  std::vector<std::array<double, 2>> twist_;  ///< cos, sin of α
};

// The six-axis arm of many textbooks, modified rows.
std::vector<std::vector<double>> default_rows() {
  return {{0, 0, 0, 0},      {0, 0, 0, -90}, {0, 70, 300, 0},
          {0, 400, 50, -90}, {0, 0, 0, 90},  {0, 0, 0, -90}};
}

// [x, y, z, a, b, c]: degrees, turned about the fixed X, then Y, then Z axis.
Pose read_placed(Parameters& p, KinematicsInput& input, const std::string& key,
                 const std::array<double, 6>& fallback) {
  std::array<double, 6> v = fallback;
  if (const auto given = input.table.numbers(key, 6)) std::copy_n(given->begin(), 6, v.begin());
  for (const double value : v)
    if (!(std::abs(value) <= 1e6)) p.fail(key, "'" + key + "' goes up to 1 km and 1e6 degrees");
  constexpr double deg = std::numbers::pi / 180;
  Pose X = translation(Vec3(v[0], v[1], v[2]) * input.unit_mm);
  X.linear() = about_fixed_axes(Vec3(v[3], v[4], v[5]) * deg);
  return X;
}

}  // namespace

std::string serial_joints(config::Table& table) {
  const auto rows = table.has("dh") ? table.number_lists("dh", 4) : std::nullopt;
  const std::size_t count = rows ? rows->size() : default_rows().size();
  const std::string kinds = table.text("kinds", std::string(count, 'R'));
  std::string names;
  for (std::size_t i = 0; i < count; ++i)
    names +=
        (i ? " J" : "J") + std::to_string(i + 1) + (i < kinds.size() && kinds[i] == 'T' ? "" : "*");
  return names;
}

std::shared_ptr<const Kinematics> read_serial(KinematicsInput& input) {
  Parameters p(input);
  const bool given = input.table.has("dh");
  auto lists = given ? input.table.number_lists("dh", 4) : std::optional(default_rows());
  if (!given) input.table.know("dh");
  if (!lists) return nullptr;
  if (lists->size() < 3 || lists->size() > static_cast<std::size_t>(max_joints)) {
    p.fail("dh", "'dh' needs 3 to 16 rows [theta, d, a, alpha], this has " +
                     std::to_string(lists->size()));
    return nullptr;
  }
  if (given && !input.table.has("convention"))
    p.fail("convention", "'convention' is missing: \"standard\" or \"modified\" rows");
  const bool modified = p.choice("convention", {"modified", "standard"}) == "modified";
  const std::string kinds = input.table.text("kinds", std::string(lists->size(), 'R'));
  if (kinds.size() != lists->size() || kinds.find_first_not_of("RT") != kinds.npos) {
    p.fail("kinds", "'kinds' needs one letter per row, R for a turning and T for a sliding joint");
    return nullptr;
  }
  p.joints(kinds);
  std::vector<DhRow> rows;
  JointVector home(static_cast<Eigen::Index>(lists->size()));
  constexpr double deg = std::numbers::pi / 180;
  for (std::size_t i = 0; i < lists->size(); ++i) {
    const auto& r = (*lists)[i];
    for (const double value : r)
      if (!(std::abs(value) * input.unit_mm <= 1e6))
        p.fail("dh", "row " + std::to_string(i + 1) + " of 'dh' has a value beyond 1e6");
    DhRow row{r[0] * deg, r[1] * input.unit_mm, r[2] * input.unit_mm, r[3] * deg, kinds[i] == 'R'};
    if (p.good()) {
      row.min = input.driven[i].min;
      row.max = std::max(row.min, input.driven[i].max);
      home[static_cast<Eigen::Index>(i)] = input.driven[i].home;
    }
    rows.push_back(row);
  }
  const Pose base = read_placed(p, input, "base", {0, 0, 0, 0, 0, 0});
  const Pose tool = read_placed(p, input, "tool", {0, 0, 0, 180, 0, 0});
  const bool of_flange = p.choice("angles", {"tool", "flange"}) == "flange";
  if (of_flange && rows.size() < 6)
    p.fail("angles",
           "'angles' = \"flange\" needs six joints or more: with fewer the arm can't turn "
           "the flange to every attitude");
  if (!p.good()) return nullptr;
  return std::make_shared<Serial>(std::move(rows), modified, base, tool, home, of_flange);
}

}  // namespace aircut::machine
