// Travel of the programmed path. Each move is laid over the machine's kinematics as a motion that
// runs along its path at unit speed, so that time stands for the way; then every joint is bounded
// as in the simulation (motion::search_maximum). There is no plan: no speeds, no rounded corners.
#include <cmath>
#include <set>
#include <tuple>

#include "base/text.h"
#include "motion/motion.h"
#include "semantics/semantics.h"
#include "semantics/words.h"

namespace aircut::semantics {

namespace {

constexpr double resolution = 1e-6;  // mm or rad: a joint may pass its limit by this much
constexpr int samples = 64;          // of a move, to name a point out of reach
constexpr std::size_t most_messages = 10'000;

}  // namespace

struct TravelCheck::State {
  const machine::Machine& machine;
  machine::JointVector joints;
  const machine::Kinematics* kinematics;  ///< in force
  Diagnostics& out;
  AxisValues tip, tool_offset;
  std::vector<double> travel;
  std::vector<std::string> unchecked;
  bool out_of_reach = false;
  std::set<std::pair<int, double>>
      outside;  ///< joints beyond a limit (sign) at the end of the last move
  std::set<std::tuple<const SourceText*, std::uint64_t, int, double>> told;

  void move(const canon::Command& command);
  void switch_kinematics(const canon::Command& command, const canon::SwitchKinematics& to);
  void spline(const canon::Command& command, const canon::SplineFeed& spline);
  void end_only(const canon::Command& command);
  bool reaches(const motion::JointMotion& motion, const canon::Command& command);
  bool inside(const machine::JointVector& q, double slack) const;
  void joint(const motion::JointMotion& motion, const canon::Command& command, machine::JointId id,
             double sign, bool& unproven);
  void tell_passed(const canon::Command& command, machine::JointId id, double sign, double worst);
  void tell_unproven(const canon::Command& command, const std::string& what);
};

TravelCheck::TravelCheck(const machine::Machine& machine, const machine::JointVector& start,
                         Diagnostics& out)
    : state_(std::make_unique<State>(
          State{machine, start, &machine.kinematics(), out, {}, {}, {}, {}, false, {}, {}})) {
  state_->travel.assign(motion::travel_count(machine), 0);
  if (const auto tip = machine.kinematics().forward(start, {})) state_->tip = *tip;
}
TravelCheck::~TravelCheck() = default;

const std::vector<std::string>& TravelCheck::unchecked() const { return state_->unchecked; }
const AxisValues& TravelCheck::tip() const { return state_->tip; }

void TravelCheck::see(const canon::Command& command) {
  State& s = *state_;
  if (const auto* offset = std::get_if<canon::ToolLengthOffset>(&command.action)) {
    s.tip += s.tool_offset - offset->offset;  // the axes stay where they are
    s.tool_offset = offset->offset;
  } else if (const auto* spline = std::get_if<canon::SplineFeed>(&command.action)) {
    s.spline(command, *spline);
  } else if (const auto* to = std::get_if<canon::SwitchKinematics>(&command.action)) {
    s.switch_kinematics(command, *to);
  } else if (canon::is_motion(command.action)) {
    const bool rapid = std::holds_alternative<canon::Rapid>(command.action);
    if (rapid && s.machine.rapid() != machine::RapidMode::coordinated)
      s.end_only(command);
    else
      s.move(command);
  }
  s.tip = canon::end_of(command.action, s.tip);
}

// All joints inside their limits by `slack` beyond, `travel` away from q.
bool TravelCheck::State::inside(const machine::JointVector& q, double slack) const {
  for (int j = 0; j < q.size(); ++j) {
    const machine::Joint& joint = machine.joint(machine::JointId{j});
    const double way = travel[static_cast<std::size_t>(j)];
    const bool good = q[j] + way <= joint.max + slack && q[j] - way >= joint.min - slack;
    if (!good) return false;  // also when it is not a number
  }
  return true;
}

void TravelCheck::State::move(const canon::Command& command) {
  auto path = plan::path_of(tip, command.action);
  if (path && std::holds_alternative<canon::Rapid>(command.action) &&
      !plan::has_straight_rapids(machine, machine.kinematics()) &&
      machine.kinematics().passive_count() == 0)
    if (auto rapid = plan::joint_rapid(machine, machine.kinematics(), joints, tip,
                                       canon::end_of(command.action, tip), tool_offset);
        rapid && !rapid->profile.knots.empty())
      path = std::move(rapid->way);
  if (!path) return tell_unproven(command, path.error().message);
  const double length = plan::length(*path);
  if (!(length > 0)) return;
  plan::Segment segment;
  segment.path = std::move(*path);
  segment.tool_offset = tool_offset;
  segment.kinematics = kinematics;
  segment.profile.knots = {{0, 0, 1, 0, 0}, {length, length, 1, 0, 0}};
  const motion::JointMotion motion(machine, segment, joints);
  if (!reaches(motion, command)) return;
  const auto middle = motion.at(length / 2);
  const bool bounded = middle && motion.travel_bound(0, length, travel);
  bool unproven = false;
  if (!bounded || !inside(*middle, 0))
    for (int j = 0; j < machine.joint_count(); ++j)
      for (const double sign : {1.0, -1.0})
        joint(motion, command, machine::JointId{j}, sign, unproven);
  else
    outside.clear();
  if (unproven)
    tell_unproven(command, "how far the joints travel within this move can't be bounded");
  if (const auto end = motion.at(length)) joints = *end;
}

// The joints stand still; the tip is where the other kinematics has it.
void TravelCheck::State::switch_kinematics(const canon::Command& command,
                                           const canon::SwitchKinematics& to) {
  const auto& models = machine.models();
  const bool known = to.model >= 0 && static_cast<std::size_t>(to.model) < models.size() &&
                     models[static_cast<std::size_t>(to.model)].kinematics && !to.with_motion;
  if (!known)
    return tell_unproven(command, "the program switches to a kinematics that is not known here");
  kinematics = models[static_cast<std::size_t>(to.model)].kinematics.get();
  if (const auto at = kinematics->forward(joints, tool_offset))
    tip = *at;
  else
    tell_unproven(command, "there is no position in the kinematics that the program switches to");
}

// Each joint goes straight to its end, so that nothing between is further out.
void TravelCheck::State::end_only(const canon::Command& command) {
  const machine::Target target{canon::end_of(command.action, tip), tool_offset};
  const auto end = kinematics->inverse(target, joints);
  if (!end) {
    plan::Segment segment;
    segment.path = plan::Hold{target.tip};
    segment.tool_offset = tool_offset;
    segment.kinematics = kinematics;
    reaches(motion::JointMotion(machine, segment, joints), command);
    return;
  }
  out_of_reach = false;
  for (int j = 0; j < machine.joint_count(); ++j) {
    const machine::Joint& limits = machine.joint(machine::JointId{j});
    if ((*end)[j] > limits.max + resolution)
      tell_passed(command, machine::JointId{j}, 1, (*end)[j]);
    if ((*end)[j] < limits.min - resolution)
      tell_passed(command, machine::JointId{j}, -1, -(*end)[j]);
  }
  joints = *end;
}

// A spline with weights above 0 stays among its control points: their box is bounded as a whole.
void TravelCheck::State::spline(const canon::Command& command, const canon::SplineFeed& spline) {
  machine::TipInterval box{tip, tip, {}, tool_offset, joints};
  const auto last = canon::end_of(command.action, tip);
  for (const auto& point : spline.points)
    for (const auto& [axis, value] : {std::pair(Axis::x, point.x), std::pair(Axis::y, point.y)}) {
      box.low[axis] = std::min(box.low[axis], value);
      box.high[axis] = std::max(box.high[axis], value);
    }
  box.travel = box.high - box.low;
  const auto q = kinematics->inverse({tip, tool_offset}, joints);
  if (!q || !kinematics->travel_bound(box, travel) || !inside(*q, resolution))
    tell_unproven(command, "how far the joints travel within this spline can't be bounded");
  if (const auto end = kinematics->inverse({last, tool_offset}, joints)) joints = *end;
}

bool TravelCheck::State::reaches(const motion::JointMotion& motion, const canon::Command& command) {
  const double length = motion.t1();
  const auto end = motion.at(length);
  const bool was_out = std::exchange(out_of_reach, !end);
  if (end && motion.at(length / 2)) return true;
  for (int i = 1; i <= samples; ++i) {
    const auto q = motion.at(length * i / samples);
    if (q) continue;
    if (!was_out && told.size() < most_messages)
      out.error("unreachable", trimmed(command.span),
                "the path leaves what the machine can reach, at " +
                    fixed(length > 0 ? 100.0 * i / samples : 100, 0) +
                    " % of this move: " + q.error().reason);
    if (end) joints = *end;
    return false;
  }
  return true;
}

void TravelCheck::State::joint(const motion::JointMotion& motion, const canon::Command& command,
                               machine::JointId id, double sign, bool& unproven) {
  const machine::Joint& limits = machine.joint(id);
  const double limit = sign * (sign > 0 ? limits.max : limits.min) + resolution;
  if (!std::isfinite(limit)) return;
  motion::JointTrack track(motion, id, sign);
  motion::Extreme worst{0, limit};
  if (!motion::search_maximum(track, motion.t0(), motion.t1(), resolution, worst)) unproven = true;
  const auto at_end = track.value(motion.t1());
  if (at_end && *at_end > worst.value) worst = {motion.t1(), *at_end};
  if (worst.value > limit) tell_passed(command, id, sign, worst.value);
  const std::pair side(index(id), sign);
  if (at_end && *at_end > limit)
    outside.insert(side);
  else
    outside.erase(side);
}

// Told when the joint goes out, not for every move until it is back.
void TravelCheck::State::tell_passed(const canon::Command& command, machine::JointId id,
                                     double sign, double worst) {
  if (outside.contains({index(id), sign}) || told.size() >= most_messages) return;
  if (!told.emplace(command.span.text, command.span.begin, index(id), sign).second) return;
  const motion::LimitText text = motion::text_of_passed_limit(machine.joint(id), sign, worst);
  out.add({Severity::error,
           "overtravel",
           text.message,
           trimmed(command.span),
           {{"help", text.remedy}},
           {}});
}

void TravelCheck::State::tell_unproven(const canon::Command& command, const std::string& what) {
  if (!told.emplace(command.span.text, command.span.begin, -1, 0.0).second) return;
  const std::string text = what + ", so their limits are not proven";
  out.warning("not_checked", trimmed(command.span), text);
  unchecked.push_back(trimmed(command.span).place() + ": " + text);
}

}  // namespace aircut::semantics
