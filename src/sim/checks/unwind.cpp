// Rotary joints that take the long way round, or wind up (verification.md §4.2, axis_unwind).
//
// A block in which a rotary joint goes more than 180° although at its end the tool points, seen
// from the work, almost as at its start: the same could have been reached without. Not told is a
// joint that turns about the tool's own direction and carries the tip along its circle over the
// work, as where a turntable draws arcs: that turn is the cut. And a joint that has an end and no
// wrap, more than two turns from where it began.
#include <cmath>

#include "sim/checks/worst_rows.h"

namespace aircut::sim {

namespace {

constexpr double degree = M_PI / 180;
constexpr double longest_turn = 180 * degree;
constexpr double same_direction = 10 * degree;
constexpr double winds_up = 720 * degree;
constexpr double rounding = 1e-6;  // rad
constexpr double same_axis = 1 * degree;
constexpr double least_turn = 1 * degree;  // of a step that the tip's way is looked at in
constexpr double least_way = 1e-3;         // mm
constexpr std::size_t most_rows = 100;
constexpr const char* turn_text = "turn";

class UnwindCheck final : public Check {
 public:
  void start(const Scene& scene, const JointVector& joints, Findings&) override {
    begin_ = block_begin_ = last_ = joints;
    wound_.assign(static_cast<std::size_t>(joints.size()), false);
    rotary_.clear();
    for (int j = 0; j < scene.machine().joint_count(); ++j)
      if (scene.machine().joint(machine::JointId{j}).kind == machine::JointKind::rotary)
        rotary_.push_back(j);
    work_ = carrier_of_work(scene.machine());
  }

  void step(const Step& step, Findings&) override {
    if (rotary_.empty()) return;
    if (step.segment.command.block != block_) {
      close();
      block_ = step.segment.command.block;
      block_begin_ = last_;
      way_ = 0;
    }
    const auto end = step.motion.at(step.motion.t1());
    if (!end) return;
    for (const int j : rotary_)
      if (std::abs((*end)[j] - last_[j]) > least_turn) {
        way_ += way_over_work(step);
        break;
      }
    last_ = *end;
    for (const int j : rotary_) look_at(step, j);
  }

  void finish(Summary&, Findings& out) override {
    close();
    rows_.hand_over("blocks", out);
  }

 private:
  void look_at(const Step& step, int j) {
    const machine::Joint& joint = step.motion.machine().joint(machine::JointId{j});
    const double turn = last_[j] - block_begin_[j];
    if (std::abs(turn) > longest_turn + rounding) {
      const Tip before = tip_at(step, block_begin_, joint), now = tip_at(step, last_, joint);
      const double apart = std::acos(std::clamp(before.direction.dot(now.direction), -1.0, 1.0));
      const bool draws = before.along && now.along && way_ > least_way &&
                         way_ > 0.5 * std::abs(turn) * std::min(before.radius, now.radius);
      std::erase_if(held_, [&](const Finding& f) {
        return f.joint == joint.name && f.quantity == turn_text;
      });
      if (apart < same_direction && !draws)
        hold(step, joint, std::abs(turn),
             "`" + joint.name + "` turns by " + fixed(std::abs(turn) / degree, 1) +
                 "° in this block, but the tool points almost as before: " +
                 fixed(apart / degree, 1) + "° apart",
             longest_turn);
    }
    const auto i = static_cast<std::size_t>(j);
    const double wound = std::abs(last_[j] - begin_[j]);
    const bool ends = std::isfinite(joint.min) || std::isfinite(joint.max);
    if (ends && joint.wrap == machine::Wrap::none && wound > winds_up + rounding && !wound_[i])
      hold(step, joint, wound,
           "`" + joint.name + "` is " + fixed(wound / degree, 1) + "° from where it began",
           winds_up);
    wound_[i] = wound > winds_up + rounding;
  }

  /// The link that the work stands on. Without a stock the last rotary table behind the link of the
  /// program's coordinates, which don't turn with it where tool centre point control is off.
  static machine::LinkId carrier_of_work(const machine::Machine& machine) {
    if (machine.stock()) return machine.stock()->link;
    const auto carries_spindle = [&](machine::LinkId link) {
      for (machine::LinkId at = machine.spindle().link; at != machine::bed_link;
           at = machine.links()[static_cast<std::size_t>(machine::index(at))].parent)
        if (at == link) return true;
      return false;
    };
    machine::LinkId work = machine.work_link();
    for (const machine::Joint& joint : machine.tree())  // parents before children
      if (joint.kind == machine::JointKind::rotary && joint.driven >= 0 && joint.parent == work &&
          !carries_spindle(joint.child))
        work = joint.child;
    return work;
  }

  /// The tool seen from the work, and from a rotary joint.
  struct Tip {
    Vec3 at, direction;
    bool along = false;  ///< the joint turns about the tool's direction
    double radius = 0;   ///< mm, of the tip from the joint's axis
  };
  Tip tip_at(const Step& step, const JointVector& joints, const machine::Joint& joint) {
    const machine::Machine& machine = step.motion.machine();
    machine::forward(machine, joints, poses_);
    const auto pose = [&](machine::LinkId id) -> const Pose& {
      return poses_.X_WL[static_cast<std::size_t>(machine::index(id))];
    };
    const machine::Spindle& spindle = machine.spindle();
    const Vec3 axis = pose(spindle.link).linear() * spindle.R_LF * Vec3::UnitZ();
    const double length = step.scene.tool() ? step.scene.tool()->gauge_length : 0;
    const Vec3 tip = pose(spindle.link) * spindle.gauge - length * axis;
    // Axis and origin are given with all joints at zero, where links have the bed's axes.
    const Pose& X_WJ = pose(joint.parent);
    const Vec3 turns_about = X_WJ.linear() * joint.direction;
    const Vec3 from = tip - X_WJ * joint.origin;
    const Pose X_SW = pose(work_).inverse(Eigen::Isometry);
    return {X_SW * tip, X_SW.linear() * axis, std::abs(turns_about.dot(axis)) > std::cos(same_axis),
            (from - from.dot(turns_about) * turns_about).norm()};
  }

  // Length of the tip's way over the work.
  double way_over_work(const Step& step) {
    constexpr int chords = 16;
    const machine::Joint& any = step.motion.machine().joint(machine::JointId{rotary_.front()});
    double way = 0;
    std::optional<Vec3> before;
    for (int i = 0; i <= chords; ++i) {
      const double t = step.motion.t0() + (step.motion.t1() - step.motion.t0()) * i / chords;
      const auto joints = step.motion.at(t);
      if (!joints) return way;
      const Vec3 at = tip_at(step, *joints, any).at;
      if (before) way += (at - *before).norm();
      before = at;
    }
    return way;
  }

  // Until the block's last segment is seen.
  void hold(const Step& step, const machine::Joint& joint, double turn, const std::string& message,
            double limit) {
    Finding f = finding_at(Kind::axis_unwind, step, step.motion.t0());
    for (Finding& other : held_)
      if (other.joint == joint.name && *other.limit == limit / degree) {
        f.t_first = other.t_first;
        f.u_first = other.u_first;
      }
    std::erase_if(held_, [&](const Finding& other) {
      return other.joint == joint.name && *other.limit == limit / degree;
    });
    f.t_worst = f.t_end = step.motion.t1();
    f.joints_worst = last_;
    f.u_end = step.segment.u1;
    f.joint = joint.name;
    f.quantity = limit == winds_up ? "wind-up" : turn_text;
    f.value = turn / degree;
    f.limit = limit / degree;
    f.unit = "deg";
    f.message = message;
    f.remedy = limit == winds_up
                   ? "turn it back with the tool clear, or say wrap = \"modulo\" for a "
                     "joint that has no cables"
                   : "choose the nearer angle, or turn with the tool clear of the work";
    held_.push_back(std::move(f));
  }

  void close() {
    for (Finding& f : held_) {
      const double badness = *f.value / *f.limit;
      if (rows_.wants(badness)) rows_.add(badness, std::move(f));
    }
    held_.clear();
  }

  WorstRows rows_{most_rows};
  std::vector<int> rotary_;
  machine::LinkId work_ = machine::bed_link;
  std::uint64_t block_ = 0;
  JointVector begin_, block_begin_, last_;
  double way_ = 0;  ///< mm, of the tip over the work in the block
  std::vector<bool> wound_;
  std::vector<Finding> held_;  ///< of the block at hand
  machine::LinkPoses poses_;
};

}  // namespace

std::unique_ptr<Check> make_unwind_check() { return std::make_unique<UnwindCheck>(); }

}  // namespace aircut::sim
