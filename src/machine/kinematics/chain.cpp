// A point fixed to the tool at rest, carried to M by the couples in turn:
//
//   p_M = X_LM⁻¹ · E_wm⁻¹ ⋯ E_w1⁻¹ · E_t1 ⋯ E_tn · p        E: Trans(sense q u) or a turn by sense
//   q
//
// With the rotary joints known this is affine in the linear ones, p_M = p_0 + Σ c_i q_i: p_0 is the
// point with the linear joints at zero, c_i the direction of couple i turned by the couples behind
// it. The three q_i follow by Cramer's rule. The rotary joints are the program's words. Everything
// is written once for doubles, for Jet (rates) and for Slope (travel bounds), see derivatives.h.
//
// Travel. When the linear couples follow each other (no rotary one between them), let z be the tip
// seen from behind the linear couples: forwards it is the tool's tip turned by the rotary couples
// before them, plus Σ u_i q_i with constant u_i; backwards it is the tip in M turned back by those
// after them. So q' = U⁻¹ (z' from behind − z' from before), where every z' is a sum of terms
// (direction turned by an angle) · tip' and (u_j × lever) · angle'. Evaluated with intervals this
// is finite for any box. Other chains take the derivatives of the inverse (slope_bound.h).
//
// The tip at rest is gauge − X_LM.R · tool offset: the tool is fixed to the spindle, whose axes are
// those of M with all joints at zero.
#include "machine/kinematics/chain.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "machine/kinematics/kinematics_table.h"
#include "machine/kinematics/slope_bound.h"
#include "machine/kinematics/vectors.h"
#include "machine/rotation/two_turns.h"

namespace aircut::machine {

namespace {

/// What the rotary joints leave to the linear ones: p_M = p + Σ c[i] · q[linear i].
template <class T>
struct Affine {
  Vector<T> p;
  std::array<Vector<T>, 3> c;
};

// Smallest |det c| of a position that counts as solvable; the columns are unit vectors.
constexpr double least_determinant = 1e-6;

class Chain final : public Kinematics {
 public:
  explicit Chain(const ChainGeometry& g) : g_(g) {
    for (std::size_t j = 0; j < g.words.size(); ++j) {
      axes_.add(g.words[j]);
      (is_rotary(g.words[j]) ? rotary_ : linear_).push_back(static_cast<int>(j));
    }
    // In the order in which a point goes from the tool to the work.
    for (auto couple = g.tool.rbegin(); couple != g.tool.rend(); ++couple) way_.push_back(*couple);
    for (ChainCouple couple : g.work) {
      couple.sense = -couple.sense;
      way_.push_back(couple);
    }
    while (linear_begin_ < way_.size() && way_[linear_begin_].kind != JointKind::linear)
      ++linear_begin_;
    linear_end_ = linear_begin_;
    while (linear_end_ < way_.size() && way_[linear_end_].kind == JointKind::linear) ++linear_end_;
  }

  std::string_view type() const override { return g_.type; }
  AxisSet axes() const override { return axes_; }
  int joint_count() const override { return static_cast<int>(g_.words.size()); }

  tl::expected<JointVector, ReachError> inverse(const Target& target,
                                                const JointVector&) const override {
    if (const auto error = wrong_offset(target.tool_offset)) return unexpected(ReachError{*error});
    JointVector joints(joint_count());
    if (std::abs(determinant(affine<double>(words(target.tip), target.tool_offset).c)) <
        least_determinant)
      return unexpected(ReachError{"the linear axes lie in one plane at these angles"});
    const auto q = solve<double>(words(target.tip), target.tool_offset);
    for (Eigen::Index j = 0; j < joints.size(); ++j) {
      joints[j] = q[static_cast<std::size_t>(j)];
      if (!std::isfinite(joints[j])) return unexpected(ReachError{"the pose is no number"});
    }
    return joints;
  }

  tl::expected<AxisValues, ReachError> forward(const JointVector& joints,
                                               const AxisValues& tool_offset) const override {
    if (const auto error = wrong_offset(tool_offset)) return unexpected(ReachError{*error});
    PoseWords<double> pose{};
    AxisValues tip;
    for (const int j : rotary_) {
      tip[word(j)] = joints[j];
      pose[index(word(j))] = joints[j];
    }
    const Affine<double> a = affine<double>(pose, tool_offset);
    for (std::size_t i = 0; i < 3; ++i) {
      double sum = a.p[i];
      for (std::size_t l = 0; l < 3; ++l) sum += a.c[l][i] * joints[linear_[l]];
      tip[all_axes[i]] = sum;
    }
    return tip;
  }

  std::optional<Vec3> tool_axis(const AxisValues& tip) const override {
    return carried(Vec3::UnitZ(), words(tip));
  }

  bool rates(const Target& target, const JointVector&, const AxisValues& d_tip,
             const AxisValues& dd_tip, JointVector& dq, JointVector& ddq) const override {
    if (wrong_offset(target.tool_offset)) return false;
    PoseWords<Jet> pose;
    for (std::size_t i = 0; i < pose.size(); ++i)
      pose[i] = {target.tip[all_axes[i]], d_tip[all_axes[i]], dd_tip[all_axes[i]]};
    const auto q = solve<Jet>(pose, target.tool_offset);
    dq.resize(joint_count());
    ddq.resize(joint_count());
    for (Eigen::Index j = 0; j < dq.size(); ++j) {
      dq[j] = q[static_cast<std::size_t>(j)].d;
      ddq[j] = q[static_cast<std::size_t>(j)].dd;
    }
    return true;
  }

  bool travel_bound(const TipInterval& tip, std::span<double> travel) const override {
    if (wrong_offset(tip.tool_offset)) return false;
    PoseWords<Interval> box;
    PoseWords<double> way{};
    bool turns = false;
    for (std::size_t i = 0; i < box.size(); ++i) {
      box[i] = {tip.low[all_axes[i]], tip.high[all_axes[i]]};
      way[i] = tip.travel[all_axes[i]];
      if (!box[i].finite()) return false;
      if (i >= 3 && (way[i] != 0 || box[i].low != box[i].high)) turns = true;
    }
    std::fill_n(travel.begin(), joint_count(), 0.0);
    if (!turns) return straight_bound(tip.low, way, travel);
    if (linear_couples_follow_each_other()) {
      lever_bound(box, way, tip.tool_offset, travel);
      return true;
    }
    return raise_travel(
        box, way, splits, travel.first(static_cast<std::size_t>(joint_count())),
        [&](const PoseWords<Slope>& pose) { return solve<Slope>(pose, tip.tool_offset); });
  }

  std::vector<JointVector> positions(const Vec3& tip, const Vec3& axis,
                                     const AxisValues& tool_offset, const JointVector& near) const;

 private:
  static constexpr int splits = 9;

  Axis word(int joint) const { return g_.words[static_cast<std::size_t>(joint)]; }

  static Vec3 vec_of(const AxisValues& v) { return {v[Axis::x], v[Axis::y], v[Axis::z]}; }

  static PoseWords<double> words(const AxisValues& tip) {
    PoseWords<double> pose;
    for (std::size_t i = 0; i < pose.size(); ++i) pose[i] = tip[all_axes[i]];
    return pose;
  }

  static std::optional<std::string> wrong_offset(const AxisValues& offset) {
    for (const Axis axis : all_axes)
      if (index(axis) >= 3 && offset[axis] != 0)
        return std::string("a tool offset in ") + letter(axis) +
               " is not possible on this machine: tools have lengths along X, Y and Z";
    return std::nullopt;
  }

  // A direction fixed to M with all joints at zero and to the tool, seen from M.
  Vec3 carried(const Vec3& v, const PoseWords<double>& pose) const {
    Vec3 d = g_.X_LM.linear() * v;
    for (const ChainCouple& couple : way_)
      if (couple.kind == JointKind::rotary)
        d = Eigen::AngleAxisd(couple.sense * pose[index(word(couple.driven))], couple.direction) *
            d;
    return g_.X_LM.linear().transpose() * d;
  }

  template <class T>
  Affine<T> affine(const PoseWords<T>& pose, const AxisValues& offset) const {
    Vector<T> p = vector_of<T>(g_.gauge - g_.X_LM.linear() * vec_of(offset));
    std::array<Vector<T>, 3> c{};
    std::array<bool, 3> seen{};
    for (const ChainCouple& couple : way_) {
      if (couple.kind == JointKind::linear) {
        const std::size_t l = place_of(couple.driven);
        c[l] = vector_of<T>(couple.sense * couple.direction);
        seen[l] = true;
        continue;
      }
      const Turn<T> turn(couple.direction, T(couple.sense) * pose[index(word(couple.driven))]);
      for (std::size_t i = 0; i < 3; ++i) p[i] = p[i] - T(couple.origin[static_cast<int>(i)]);
      p = turn(p);
      for (std::size_t i = 0; i < 3; ++i) p[i] = p[i] + T(couple.origin[static_cast<int>(i)]);
      for (std::size_t l = 0; l < 3; ++l)
        if (seen[l]) c[l] = turn(c[l]);
    }
    const Mat3& R = g_.X_LM.linear();
    const Vec3& o = g_.X_LM.translation();
    for (std::size_t i = 0; i < 3; ++i) p[i] = p[i] - T(o[static_cast<int>(i)]);
    Affine<T> out;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 row = R.col(static_cast<int>(i));
      out.p[i] = dot(row, p);
      for (std::size_t l = 0; l < 3; ++l) out.c[l][i] = dot(row, c[l]);
    }
    return out;
  }

  template <class T>
  static T determinant(const std::array<Vector<T>, 3>& c) {
    return dot(c[0], cross(c[1], c[2]));
  }

  template <class T>
  PoseWords<T> solve(const PoseWords<T>& pose, const AxisValues& offset) const {
    const Affine<T> a = affine<T>(pose, offset);
    const Vector<T> r = {pose[0] - a.p[0], pose[1] - a.p[1], pose[2] - a.p[2]};
    const T d = determinant(a.c);
    PoseWords<T> q{};
    for (std::size_t l = 0; l < 3; ++l)
      q[static_cast<std::size_t>(linear_[l])] =
          dot(r, cross(a.c[(l + 1) % 3], a.c[(l + 2) % 3])) / d;
    for (const int j : rotary_) q[static_cast<std::size_t>(j)] = pose[index(word(j))];
    return q;
  }

  // The rotary axes stand still: the linear joints go with the tip by a constant matrix.
  bool straight_bound(const AxisValues& at, const PoseWords<double>& way,
                      std::span<double> travel) const {
    const auto c = affine<double>(words(at), {}).c;
    const double d = std::abs(determinant(c));
    if (!(d >= least_determinant)) return false;
    constexpr double slack = 1 + 1e-12;  // rounding of some dozen operations
    for (std::size_t l = 0; l < 3; ++l) {
      const Vector<double> row = cross(c[(l + 1) % 3], c[(l + 2) % 3]);
      double sum = 0;
      for (std::size_t i = 0; i < 3; ++i) sum += (std::abs(row[i]) + 1e-15) * way[i];
      travel[static_cast<std::size_t>(linear_[l])] = sum / d * slack;
    }
    return true;
  }

  bool linear_couples_follow_each_other() const { return linear_end_ - linear_begin_ == 3; }

  // What moves with the tip: the place seen from here, and what it changes by per pose word.
  struct Lever {
    Vector<Interval> at;
    PoseWords<Vector<Interval>> by{};  // ∂ at / ∂ pose word

    void turn(const ChainCouple& couple, const Interval& angle, std::size_t angle_word) {
      const Turn<Interval> R(couple.direction, angle);
      const Vector<Interval> o = vector_of<Interval>(couple.origin);
      for (std::size_t i = 0; i < 3; ++i) at[i] = at[i] - o[i];
      at = R(at);
      for (Vector<Interval>& d : by) d = R(d);
      by[angle_word] = cross(vector_of<Interval>(couple.direction), at);
      for (std::size_t i = 0; i < 3; ++i) at[i] = at[i] + o[i];
    }
  };

  void lever_bound(const PoseWords<Interval>& box, const PoseWords<double>& way,
                   const AxisValues& offset, std::span<double> travel) const {
    const auto angle_word = [&](const ChainCouple& c) { return index(word(c.driven)); };
    Lever before;
    before.at = vector_of<Interval>(g_.gauge - g_.X_LM.linear() * vec_of(offset));
    for (std::size_t k = 0; k < linear_begin_; ++k) {
      const Interval sense(way_[k].sense);
      before.turn(way_[k], sense * box[angle_word(way_[k])], angle_word(way_[k]));
    }
    Lever behind;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 row = g_.X_LM.linear().row(static_cast<int>(i)).transpose();
      behind.at[i] = dot(row, Vector<Interval>{box[0], box[1], box[2]}) +
                     Interval(g_.X_LM.translation()[static_cast<int>(i)]);
      for (std::size_t w = 0; w < 3; ++w) behind.by[w][i] = Interval(row[static_cast<int>(w)]);
    }
    for (std::size_t k = way_.size(); k-- > linear_end_;) {
      const Interval back(-way_[k].sense);
      behind.turn(way_[k], back * box[angle_word(way_[k])], angle_word(way_[k]));
    }
    Mat3 U;
    for (std::size_t k = linear_begin_; k < linear_end_; ++k)
      U.col(static_cast<int>(place_of(way_[k].driven))) = way_[k].sense * way_[k].direction;
    const Mat3 inverse_U = U.inverse();
    for (std::size_t l = 0; l < 3; ++l) {
      const Vec3 row = inverse_U.row(static_cast<int>(l)).transpose();
      Interval sum(0);
      for (std::size_t w = 0; w < way.size(); ++w) {
        if (way[w] == 0) continue;
        const Interval slope = dot(row, behind.by[w]) + dot(row, before.by[w]);
        sum = sum + Interval(slope.magnitude()) * Interval(way[w]);
      }
      travel[static_cast<std::size_t>(linear_[l])] = sum.high * (1 + 1e-12);  // rounding of U⁻¹
    }
    for (const int j : rotary_) travel[static_cast<std::size_t>(j)] = way[index(word(j))];
  }

  // Place of a linear joint among the linear ones.
  std::size_t place_of(int joint) const {
    return static_cast<std::size_t>(std::find(linear_.begin(), linear_.end(), joint) -
                                    linear_.begin());
  }

  ChainGeometry g_;
  AxisSet axes_;
  std::vector<int> linear_, rotary_;
  std::vector<ChainCouple> way_;
  std::size_t linear_begin_ = 0, linear_end_ = 0;  ///< the first linear couples of way_
};

std::vector<JointVector> Chain::positions(const Vec3& tip, const Vec3& axis,
                                          const AxisValues& tool_offset,
                                          const JointVector& near) const {
  std::vector<const ChainCouple*> turns;  // in the order in which a point goes to the work
  for (const ChainCouple& couple : way_)
    if (couple.kind == JointKind::rotary) turns.push_back(&couple);
  if (turns.size() != 2) return {};
  const Mat3& R = g_.X_LM.linear();
  std::vector<JointVector> out;
  for (const auto& [outer, inner] :
       two_turns(turns[1]->direction, turns[0]->direction, R * Vec3::UnitZ(), R * axis)) {
    Target target;
    target.tool_offset = tool_offset;
    for (int i = 0; i < 3; ++i) target.tip[all_axes[static_cast<std::size_t>(i)]] = tip[i];
    const auto set = [&](const ChainCouple& couple, const std::optional<double>& angle) {
      target.tip[word(couple.driven)] =
          angle ? *angle / couple.sense : near[couple.driven];  // sense is ±1
    };
    set(*turns[1], outer);
    set(*turns[0], inner);
    if (const auto joints = inverse(target, near)) out.push_back(*joints);
  }
  return out;
}

std::string words_of(const std::vector<Axis>& words) {
  std::string text;
  for (const Axis axis : words) text += letter(axis);
  return text;
}

}  // namespace

std::shared_ptr<const Kinematics> make_chain(const ChainGeometry& g, std::string& reason) {
  const auto count = [&](Axis axis) { return std::count(g.words.begin(), g.words.end(), axis); };
  const std::size_t couples = g.work.size() + g.tool.size();
  for (const Axis axis : all_axes) {
    const bool needed = index(axis) < 3, possible = index(axis) < 6;
    if (count(axis) <= (possible ? 1 : 0) && count(axis) >= (needed ? 1 : 0)) continue;
    reason =
        "the kinematics 'chain' takes the axes X, Y, Z once each and any of A, B, C; the "
        "driven joints are " +
        words_of(g.words);
    return nullptr;
  }
  if (couples != g.words.size()) {
    reason = std::to_string(g.words.size() - std::min(couples, g.words.size())) +
             " of the driven joints are not on the way from the work to the tool";
    return nullptr;
  }
  auto chain = std::make_shared<Chain>(g);
  JointVector zero = JointVector::Zero(chain->joint_count());
  const auto tip = chain->forward(zero, {});
  if (!tip || !chain->inverse({*tip, {}}, zero)) {
    reason = "the directions of the linear axes lie in one plane: they can't reach every point";
    return nullptr;
  }
  return chain;
}

bool turns_in_two_axes(const Kinematics& kinematics) {
  const auto* chain = dynamic_cast<const Chain*>(&kinematics);
  return chain && chain->joint_count() == 5;
}

std::vector<JointVector> chain_positions(const Kinematics& chain, const Vec3& tip, const Vec3& axis,
                                         const AxisValues& tool_offset, const JointVector& near) {
  const auto* self = dynamic_cast<const Chain*>(&chain);
  return self ? self->positions(tip, axis.normalized(), tool_offset, near)
              : std::vector<JointVector>{};
}

// Of the couples between the bed and a link, those that are driven.
namespace {

std::vector<ChainCouple> couples_to(const Machine& machine, LinkId link, config::Table& table) {
  std::vector<ChainCouple> couples;
  while (link != bed_link) {
    const Link& l = machine.links()[static_cast<std::size_t>(index(link))];
    const Joint& joint = machine.tree()[static_cast<std::size_t>(l.joint)];
    if (joint.driven < 0)
      table.error("type", "axis '" + joint.name +
                              "' between work and tool is passive; 'chain' has no passive values");
    else
      couples.push_back({joint.kind, joint.origin, joint.direction, joint.sense, joint.driven});
    link = l.parent;
  }
  std::reverse(couples.begin(), couples.end());
  return couples;
}

}  // namespace

std::shared_ptr<const Kinematics> read_chain(KinematicsInput& input) {
  const Machine& machine = input.machine;
  ChainGeometry g;
  g.work = couples_to(machine, machine.work_link(), input.table);
  g.tool = couples_to(machine, machine.spindle().link, input.table);
  g.X_LM = machine.X_LM();
  g.gauge = machine.spindle().gauge;
  for (const Joint& joint : input.driven) {
    const auto axis = joint.name.size() == 1 ? axis_of_letter(joint.name[0]) : std::nullopt;
    if (!axis || is_rotary(*axis) != (joint.kind == JointKind::rotary)) {
      input.table.error("type", "joint '" + joint.name +
                                    "' has no axis letter of its kind as its name; 'chain' needs "
                                    "X, Y, Z for linear and A, B, C for rotary axes");
      return nullptr;
    }
    g.words.push_back(*axis);
  }
  std::string reason;
  auto chain = make_chain(g, reason);
  if (!chain) input.table.error("type", reason);
  return chain;
}

}  // namespace aircut::machine
