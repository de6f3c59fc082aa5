// The motion that came out of the planner, judged anew (verification.md §4.2: velocity_limit,
// acceleration_limit, jerk_limit, branch_flip).
//
// Nothing of the planner's own search is used: the joints come from the inverse kinematics at both
// ends of every stretch of the speed law, and in the middle of longer ones, s(t) = s + vt + at²/2 +
// jt³/6.
//
//   q̇ = q' ṡ      q̈ = q' s̈ + q'' ṡ²      (' = d/ds)
//
// Where a joint goes farther in a stretch than its top speed allows, that is proven by the two ends
// alone; where it goes very much farther, or jumps between two moves, it has changed its branch.
// The jerk of a stretch is at least the change of the acceleration over its time, where the joints
// follow the path linearly exactly that.
#include <array>
#include <cmath>

#include "sim/checks/worst_rows.h"

namespace aircut::sim {

namespace {

constexpr double share = 1e-3;             // a limit may be passed by so much
constexpr double rounding = 1e-6;          // mm or rad
constexpr double jump = 1e-3;              // mm or rad: of a joint between two moves
constexpr double flip = 10;                // times the farthest way of a stretch
constexpr double longest_blind = 1e-3;     // s: of a stretch that is judged by its ends alone
constexpr double shortest_stretch = 1e-5;  // s: below, differences of accelerations say nothing
constexpr std::size_t most_rows = 20;

enum Measure { speed, acceleration, jerk, measures };
constexpr std::array<Kind, measures> kinds = {Kind::velocity_limit, Kind::acceleration_limit,
                                              Kind::jerk_limit};
constexpr std::array<const char*, measures> names = {"speed", "acceleration", "jerk"};
constexpr std::array<const char*, measures> units = {"/s", "/s2", "/s3"};

double limit_of(const machine::Joint& joint, Measure measure) {
  return measure == speed ? joint.vmax : measure == acceleration ? joint.amax : joint.jmax;
}

// Speed law of a stretch at one place.
struct Law {
  double t = 0, s = 0, v = 0, a = 0;
};
Law law_at(const plan::ProfileKnot& k, double t) {
  return {k.t + t, k.s + t * (k.v + t * (k.a / 2 + t * k.j / 6)), k.v + t * (k.a + t * k.j / 2),
          k.a + t * k.j};
}

class DynamicsCheck final : public Check {
 public:
  void start(const Scene&, const JointVector& joints, Findings&) override { last_ = joints; }

  void step(const Step& step, Findings&) override {
    const plan::Segment& segment = step.segment;
    // Commands that take no time are told where the corner is that the motion rounds.
    if (segment.profile.knots.size() < 2) return;
    Place here = place(step, segment.profile.knots.front().s, last_);
    if (here.reached) look_for_jump(step, here.joint.q);
    worst_.assign(static_cast<std::size_t>(last_.size()), {});
    const auto& knots = segment.profile.knots;
    for (std::size_t i = 0; i + 1 < knots.size(); ++i)
      here = look_at_stretch(step, knots[i], knots[i + 1].t - knots[i].t, here);
    if (here.reached) last_ = here.joint.q;
    if (!segment.limit_problem.empty()) return;  // told already, as dynamics_limit
    for (std::size_t j = 0; j < worst_.size(); ++j)
      for (const Measure measure : {speed, acceleration, jerk})
        if (worst_[j][measure].value > 0)
          tell(step, machine::JointId{static_cast<int>(j)}, measure, worst_[j][measure]);
  }

  void finish(Summary&, Findings& out) override {
    for (WorstRows& rows : rows_) rows.hand_over("places", out);
    flips_.hand_over("places", out);
  }

 private:
  struct Worst {
    double value = 0, t = 0;
  };
  /// The joints at a place of the path; the speed law gives their speeds.
  struct Place {
    bool reached = false, smooth = false;
    plan::JointPoint joint;
    JointVector v(const Law& law) const { return law.v * joint.dq; }
    JointVector a(const Law& law) const { return law.a * joint.dq + law.v * law.v * joint.ddq; }
  };

  static Place place(const Step& step, double s, const JointVector& near) {
    Place out;
    if (const auto* way = std::get_if<plan::JointWay>(&step.segment.path)) {
      out.reached = out.smooth = true;
      out.joint = plan::joint_point(*way, s);
      return out;
    }
    const plan::PathPoint p = plan::evaluate(step.segment.path, s);
    const machine::Target target{p.p, step.segment.tool_offset};
    const machine::Kinematics& kinematics =
        plan::kinematics_of(step.segment, step.scene.machine().kinematics());
    if (auto joint = plan::joint_point(kinematics, target, p.d, p.dd, near)) {
      out.reached = out.smooth = true;
      out.joint = std::move(*joint);
    } else if (auto q = kinematics.inverse(target, near)) {
      out.reached = true;  // a singular pose; the ways between the places still count
      out.joint.q = std::move(*q);
    }
    return out;
  }

  void look_for_jump(const Step& step, const JointVector& now) {
    for (int j = 0; j < now.size(); ++j) {
      const double way = std::abs(now[j] - last_[j]);
      if (way > jump) tell_flip(step, j, step.motion.t0(), way, 0);
    }
  }

  // From `begin` on; gives the place at its end.
  Place look_at_stretch(const Step& step, const plan::ProfileKnot& knot, double duration,
                        const Place& begin) {
    const Law first = law_at(knot, 0), last = law_at(knot, duration);
    Place end = place(step, last.s, begin.joint.q);
    if (!begin.reached || !end.reached) return end;  // told as unreachable
    const double t = step.segment.t_start + knot.t;
    const JointVector way = (end.joint.q - begin.joint.q).cwiseAbs();
    for (int j = 0; j < way.size(); ++j) {
      const machine::Joint& joint = step.scene.machine().joint(machine::JointId{j});
      const double farthest = joint.vmax * duration;
      if (joint.vmax > 0 && way[j] > flip * farthest + jump) {
        tell_flip(step, j, t, way[j], farthest);
        return end;
      }
      if (duration > 0 && way[j] > rounding + farthest * (1 + share))
        judge(step, j, speed, t, way[j] / duration);
    }
    judge_place(step, begin, first, t);
    judge_place(step, end, last, t + duration);
    if (duration > longest_blind) {
      const Law law = law_at(knot, duration / 2);
      judge_place(step, place(step, law.s, begin.joint.q), law, t + duration / 2);
    }
    if (duration > shortest_stretch && begin.smooth && end.smooth) {
      const JointVector change = (end.a(last) - begin.a(first)).cwiseAbs();
      for (int j = 0; j < change.size(); ++j) judge(step, j, jerk, t, change[j] / duration);
    }
    return end;
  }

  void judge_place(const Step& step, const Place& place, const Law& law, double t) {
    if (!place.smooth) return;
    const JointVector v = place.v(law), a = place.a(law);
    for (int j = 0; j < v.size(); ++j) {
      judge(step, j, speed, t, std::abs(v[j]));
      judge(step, j, acceleration, t, std::abs(a[j]));
    }
  }

  void judge(const Step& step, int j, Measure measure, double t, double value) {
    const double limit = limit_of(step.scene.machine().joint(machine::JointId{j}), measure);
    Worst& worst = worst_[static_cast<std::size_t>(j)][measure];
    if (limit > 0 && value > limit * (1 + share) + rounding && value > worst.value)
      worst = {value, t};
  }

  void tell(const Step& step, machine::JointId id, Measure measure, const Worst& worst) {
    const machine::Joint& joint = step.scene.machine().joint(id);
    const double limit = limit_of(joint, measure);
    WorstRows& rows = rows_[measure];
    if (!rows.wants(worst.value / limit)) return;
    const bool rotary = joint.kind == machine::JointKind::rotary;
    const double scale = rotary ? 180 / M_PI : 1;
    Finding f = finding_at(kinds[measure], step, worst.t);
    f.u_first = f.u_end = fraction_at(step, worst.t);
    f.joint = joint.name;
    f.value = worst.value * scale;
    f.limit = limit * scale;
    f.unit = (rotary ? "deg" : "mm") + std::string(units[measure]);
    f.message = std::string("the ") + names[measure] + " of `" + joint.name + "` comes to " +
                fixed(*f.value, 3) + " " + f.unit + ", its limit is " + shortest(*f.limit);
    f.remedy = "this is a fault of the planned motion: report it with the program and the machine";
    rows.add(worst.value / limit, std::move(f));
  }

  void tell_flip(const Step& step, int j, double t, double way, double farthest) {
    if (!flips_.wants(way)) return;
    const machine::Joint& joint = step.scene.machine().joint(machine::JointId{j});
    const bool rotary = joint.kind == machine::JointKind::rotary;
    const double scale = rotary ? 180 / M_PI : 1;
    Finding f = finding_at(Kind::branch_flip, step, t);
    if (step.segment.kind == plan::MotionKind::rapid) f.severity = Severity::warning;
    f.u_first = f.u_end = fraction_at(step, t);
    f.joint = joint.name;
    f.value = way * scale;
    f.limit = farthest * scale;
    f.unit = rotary ? "deg" : "mm";
    f.message = "`" + joint.name + "` jumps by " + fixed(*f.value, 3) + (rotary ? "°" : " mm") +
                " to another solution of the inverse kinematics";
    f.remedy =
        "turn the part or move it, so that the path stays clear of the pose where the solutions "
        "meet; or program the joints there";
    flips_.add(way, std::move(f));
  }

  JointVector last_;
  std::vector<std::array<Worst, measures>> worst_;  ///< of a segment, by joint
  std::array<WorstRows, measures> rows_{WorstRows{most_rows}, WorstRows{most_rows},
                                        WorstRows{most_rows}};
  WorstRows flips_{most_rows};
};

}  // namespace

std::unique_ptr<Check> make_dynamics_check() { return std::make_unique<DynamicsCheck>(); }

}  // namespace aircut::sim
