// The planner's front: keeps the modal state, turns commands into moves or stand-still segments,
// and says which commands the motion waits for. Barriers (the motion comes to rest) are commands
// that a control carries out only at rest: dwell, spindle, coolant, I/O that is not tied to motion,
// tool change, tool length, program stop and end. All other state rides along at speed.
#include <cmath>
#include <limits>
#include <numbers>

#include "plan/merger.h"
#include "plan/override.h"
#include "plan/spline.h"
#include "plan/sync.h"

namespace aircut::plan {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

class Planner::Impl {
 public:
  Impl(const machine::Machine& machine, const machine::JointVector& start, const Options& options);

  Expected<void> push(const canon::Command& command);
  void flush() { merger_.stop(); }
  std::optional<Segment> take() { return shaper_.take(); }
  Expected<void> probe(const canon::Command& command, std::optional<double> trip);
  const AxisValues& tip() const { return tip_; }
  Statistics statistics() const { return shaper_.statistics(); }
  Segment straight_way(const canon::Command& command) const;

 private:
  /// Where a probe trips (s), and the share of the programmed way that is gone.
  struct Trip {
    double s, share;
  };
  Expected<void> move(const canon::Command& command, Path path, MotionKind kind, double feed,
                      std::optional<Trip> trip = {});
  Expected<void> feed_move(const canon::Command& command, Path path, MotionKind kind);
  Expected<void> rapid(const canon::Command& command, const AxisValues& end);
  Expected<void> spline(const canon::Command& command, const canon::SplineFeed& spline);
  Expected<void> sync(const canon::Command& command, const canon::SyncFeed& sync);
  void push_sync(const canon::Command& command, const Line& line, const canon::SyncFeed& sync,
                 const Shaper::StraightRun& run, SyncLaw law);
  Expected<double> feed_of(Metric metric, double way) const;
  Segment segment(const canon::Command& command, MotionKind kind) const;
  /// A segment without way that takes `seconds`, or rides along when it takes none.
  Expected<void> still(const canon::Command& command);
  Expected<void> barrier(const canon::Command& command, double seconds = 0,
                         MotionKind kind = MotionKind::idle);
  Expected<void> switch_kinematics(const canon::Command& command,
                                   const canon::SwitchKinematics& to);
  Expected<void> spindle(const canon::Command& command, double before);
  Expected<void> no_model(const canon::Command& command, const char* what) const;
  double rpm() const;

  const machine::Machine& machine_;
  const machine::Kinematics* kinematics_;  ///< in force
  Options options_;
  std::optional<Diagnostic> broken_;  ///< why no program can be planned
  Shaper shaper_;
  Merger merger_;
  AxisValues tip_;  ///< at the end of everything pushed
  AxisValues tool_offset_;
  canon::FeedMode feed_mode_ = canon::FeedMode::per_minute;
  canon::SetFeedRate feed_rate_;
  canon::PathMode path_mode_ = canon::PathMode::continuous;
  double path_tolerance_ = 0;
  double merge_tolerance_ = 0;
  double spindle_speed_ = 0;
  bool css_ = false;
  canon::SpindleTurn spindle_turn_ = canon::SpindleTurn::stop;
  int tool_ = 0;
  int work_system_ = 1;
  Overridable overridable_;
};

namespace {

Diagnostic at(const canon::Command& command, std::string kind, std::string message) {
  return make_error(std::move(kind), command.span, std::move(message));
}

// Way of the hardest braking from the speed that is reached `way` after a rest.
double braking_way(double way, double feed, StraightLimits limits) {
  limits.v = std::min(limits.v, feed);
  double v = 0;
  for (const ProfileKnot& knot : s_curve(2 * way, limits).knots) v = std::max(v, knot.v);
  const double ramp = limits.a * limits.a / limits.j;  // change of speed that reaches a
  const double t = v >= ramp ? v / limits.a + limits.a / limits.j : 2 * std::sqrt(v / limits.j);
  return v * t / 2;
}

}  // namespace

Planner::Impl::Impl(const machine::Machine& machine, const machine::JointVector& start,
                    const Options& options)
    : machine_(machine),
      kinematics_(&machine.kinematics()),
      options_(options),
      shaper_(machine, start, options),
      merger_(shaper_),
      tool_(options.tool) {
  if (start.size() != machine.joint_count()) {
    broken_ = make_error("setup_invalid", "the start has " + std::to_string(start.size()) +
                                              " joint values, the machine " +
                                              std::to_string(machine.joint_count()) + " joints");
    return;
  }
  for (int j = 0; j < machine.joint_count(); ++j) {
    const machine::Joint& joint = machine.joint(machine::JointId{j});
    if (!(joint.vmax > 0) || !(joint.amax > 0))
      broken_ = make_error("machine_invalid",
                           "joint " + joint.name + " needs vmax and amax above 0 to be moved");
  }
  if (std::isfinite(machine.tip_acceleration()))
    for (int j = 0; j < machine.joint_count(); ++j)
      if (std::isfinite(machine.joint(machine::JointId{j}).jmax))
        broken_ =
            make_error("machine_invalid",
                       "a limit of the tip's acceleration (a_tcp) together with limits of the "
                       "joints' jerk (jmax) can't be planned; take one of them out");
  if (const auto wrong = wrong_overrides(options.overrides); !wrong.empty())
    broken_ = make_error("overrides_invalid", wrong);
  auto tip = machine.kinematics().forward(start, tool_offset_);
  if (tip)
    tip_ = *tip;
  else
    broken_ = make_error("unreachable", "the start joints are no position: " + tip.error().reason);
}

double Planner::Impl::rpm() const {
  switch (spindle_turn_) {
    case canon::SpindleTurn::stop:
      return 0;
    case canon::SpindleTurn::clockwise:
      return spindle_speed_;
    case canon::SpindleTurn::counterclockwise:
      return -spindle_speed_;
  }
  return 0;
}

Segment Planner::Impl::segment(const canon::Command& command, MotionKind kind) const {
  Segment out;
  out.command = command;
  out.kind = kind;
  out.path = Hold{tip_};
  out.tool_offset = tool_offset_;
  out.tool = tool_;
  out.spindle_rpm = rpm();
  out.work_system = work_system_;
  out.overridable = overridable_;
  out.overridable.per_revolution = feed_mode_ == canon::FeedMode::per_revolution;
  if (kinematics_ != &machine_.kinematics()) out.kinematics = kinematics_;
  return out;
}

Expected<void> Planner::Impl::still(const canon::Command& command) {
  merger_.push_still(segment(command, MotionKind::idle));
  return {};
}

Expected<void> Planner::Impl::barrier(const canon::Command& command, double seconds,
                                      MotionKind kind) {
  merger_.stop();
  Segment out = segment(command, kind);
  if (seconds > 0) out.profile.knots = {{0, 0, 0, 0, 0}, {seconds, 0, 0, 0, 0}};
  merger_.push_still(std::move(out));
  return {};
}

// The motion waits until the spindle has the new speed. One that is stopped runs down by itself.
Expected<void> Planner::Impl::spindle(const canon::Command& command, double before) {
  const double acceleration = machine_.spindle().acceleration, change = rpm() - before;
  if (!(acceleration > 0) || rpm() == 0 || change == 0 || css_) return barrier(command);
  Segment out = segment(command, MotionKind::idle);
  out.spindle_from = before;
  out.profile.knots = {{0, 0, 0, 0, 0}, {std::abs(change) / 60 / acceleration, 0, 0, 0, 0}};
  merger_.stop();
  merger_.push_still(std::move(out));
  return {};
}

Expected<void> Planner::Impl::no_model(const canon::Command& command, const char* what) const {
  return unexpected(at(command, "unsupported_code",
                       std::string(what) + " has no motion model, so the program can't be planned "
                                           "over it; take it out of the program"));
}

// Speed along the metric that F asks for (planner rule of G93, G94, G95).
Expected<double> Planner::Impl::feed_of(Metric metric, double way) const {
  double feed = 0;
  switch (feed_mode_) {
    case canon::FeedMode::per_minute:
      feed = metric == Metric::abc ? feed_rate_.rotary : feed_rate_.value;
      break;
    case canon::FeedMode::inverse_time:
      feed = way * feed_rate_.value;
      break;
    case canon::FeedMode::per_revolution:
      if (css_ || metric == Metric::abc)
        return unexpected(make_error(
            "unsupported_code",
            css_ ? "feed per revolution (G95) under constant surface speed (G96) has no model; use "
                   "G94 or G97"
                 : "feed per revolution (G95) needs a linear axis in the move; use G94 or G93"));
      feed = feed_rate_.value * std::abs(rpm()) / 60;
      break;
  }
  if (!(feed > 0))
    return unexpected(make_error(
        "feed_missing", feed_mode_ == canon::FeedMode::per_revolution && rpm() == 0
                            ? "feed per revolution (G95) needs a turning spindle (S and M3 or M4)"
                            : "the move has no feed; it needs an F above 0"));
  return feed;
}

Expected<void> Planner::Impl::move(const canon::Command& command, Path path, MotionKind kind,
                                   double feed, std::optional<Trip> trip) {
  Move out;
  out.segment = segment(command, kind);
  if (trip) {
    out.segment.trip = trip->s;
    out.segment.u1 = trip->share;
  }
  out.metric = metric_of(path);
  if (out.metric == Metric::none) {
    // Nothing moves: no motion, but the command still reaches the listeners.
    merger_.push_still(std::move(out.segment));
    return {};
  }
  tip_ = evaluate(path, length(path)).p;
  out.segment.path = std::move(path);
  out.segment.feed = feed == infinity ? 0 : feed;
  out.feed = feed;
  out.mode = path_mode_;
  out.tolerance = path_tolerance_;
  out.merge = merge_tolerance_;
  merger_.push(std::move(out));
  return {};
}

Expected<void> Planner::Impl::feed_move(const canon::Command& command, Path path, MotionKind kind) {
  const Metric metric = metric_of(path);
  if (metric == Metric::none) return move(command, std::move(path), kind, infinity);
  const auto feed = feed_of(metric, length(path));
  if (!feed) return unexpected(at(command, feed.error().kind, feed.error().message));
  return move(command, std::move(path), kind, *feed);
}

// A curve is a chain of moves that touch; it is one command.
Expected<void> Planner::Impl::spline(const canon::Command& command,
                                     const canon::SplineFeed& spline) {
  const std::vector<Blend> pieces = spline_pieces(tip_, spline);
  double whole = 0;
  for (const Blend& piece : pieces) whole += piece.length;
  if (pieces.empty()) return still(command);
  const auto feed = feed_of(Metric::xyz, whole);
  if (!feed) return unexpected(at(command, feed.error().kind, feed.error().message));
  double done = 0;
  for (const Blend& piece : pieces) {
    Move out;
    out.segment = segment(command, MotionKind::feed);
    out.segment.path = piece;
    out.segment.feed = *feed;
    out.segment.u0 = done / whole;
    done += piece.length;
    out.segment.u1 = done / whole;
    out.metric = Metric::xyz;
    out.feed = *feed;
    out.mode = path_mode_;
    out.tolerance = path_tolerance_;
    tip_ = piece.control.back();
    merger_.push(std::move(out));
  }
  return {};
}

// Straight in the joints. Only where all joints are driven: what follows from them by the closing
// of a mechanism has no proven bound on such a way.
Expected<void> Planner::Impl::rapid(const canon::Command& command, const AxisValues& end) {
  if (kinematics_->passive_count() > 0)
    return no_model(command,
                    "a rapid that is not coordinated, on a machine with passive joints "
                    "(machine key `rapid`)");
  merger_.stop();
  auto found = joint_rapid(machine_, *kinematics_, shaper_.joints(), tip_, end, tool_offset_);
  // What can't be reached is told by the straight way.
  if (!found) return move(command, make_line(tip_, end), MotionKind::rapid, infinity);
  if (found->profile.knots.empty()) return still(command);
  Segment out = segment(command, MotionKind::rapid);
  const machine::JointVector joints = found->way.to;
  out.limited_by = {LimitedBy::velocity, -1};
  out.profile = std::move(found->profile);
  out.path = std::move(found->way);
  shaper_.push_planned(std::move(out), joints);
  tip_ = end;
  return {};
}

// To the end of the move, where it comes to rest; or to where it rests after the probe has tripped.
Expected<void> Planner::Impl::probe(const canon::Command& command, std::optional<double> trip) {
  if (broken_) return unexpected(*broken_);
  merger_.stop();
  const Line whole = make_line(tip_, std::get<canon::Probe>(command.action).end);
  const Metric metric = metric_of(whole);
  if (metric == Metric::none) return move(command, whole, MotionKind::probe, infinity);
  const auto feed = feed_of(metric, whole.length);
  if (!feed) return unexpected(at(command, feed.error().kind, feed.error().message));
  double rest = whole.length;
  if (trip) {
    // A way that can't be gone to its end has no known limits: it ends at the trip.
    const auto run = shaper_.straight_run(whole, tool_offset_);
    const double braking = run ? braking_way(*trip, *feed, run->limits) : 0;
    rest = std::min(rest, *trip + braking);
  }
  auto done = trip ? move(command, sub_path(whole, 0, rest), MotionKind::probe, *feed,
                          Trip{*trip, rest / whole.length})
                   : move(command, whole, MotionKind::probe, *feed);
  merger_.stop();
  return done;
}

Segment Planner::Impl::straight_way(const canon::Command& command) const {
  Segment out = segment(command, MotionKind::probe);
  const Line line = make_line(tip_, canon::end_of(command.action, tip_));
  out.path = line;
  if (line.length > 0) out.profile.knots = {{0, 0, 1, 0, 0}, {line.length, line.length, 1, 0, 0}};
  return out;
}

// G33 and G33.1. The motion rests before, waits for the spindle's index, and rests afterwards.
Expected<void> Planner::Impl::sync(const canon::Command& command, const canon::SyncFeed& sync) {
  if (css_ || sync.spindle != 0)
    return no_model(command, css_ ? "synchronised motion under constant surface speed (G96)"
                                  : "motion synchronised to a second spindle");
  const double speed = sync.per_revolution * std::abs(rpm()) / 60;
  if (!(speed > 0))
    return unexpected(at(command, "feed_missing",
                         "synchronised motion needs a turning spindle (S and M3 or M4) and a way "
                         "per revolution K above 0"));
  const Line line = make_line(tip_, sync.end);
  if (metric_of(line) == Metric::none) return still(command);
  merger_.stop();
  auto run = shaper_.straight_run(line, tool_offset_);
  // A tap's axis and the spindle slow down and turn round together.
  if (const double spindle = machine_.spindle().acceleration; run && sync.rigid_tap && spindle > 0)
    run->limits.a = std::min(run->limits.a, sync.per_revolution * spindle);
  auto law = run ? sync_law(line.length, speed, run->limits) : std::nullopt;
  if (law) {
    push_sync(command, line, sync, *run, std::move(*law));
    if (!sync.rigid_tap) tip_ = line.end;
    return {};
  }
  // As fast as it goes, with what is wrong; a way that can't be reached fails there.
  std::string problem;
  if (run)
    problem = run->limits.v > speed
                  ? "the way of " + shortest(line.length) +
                        " mm is too short for the axis to catch up with the spindle"
                  : "the spindle asks for " + shortest(speed * 60) + " mm/min, the axis can do " +
                        shortest(run->limits.v * 60);
  const AxisValues start = tip_;
  const auto go = [&](const AxisValues& end, double u0, double u1) {
    Move out;
    out.segment = segment(command, MotionKind::sync);
    out.segment.overridable = {false, false, false, false, false};
    out.segment.path = make_line(tip_, end);
    out.segment.feed = speed;
    out.segment.sync_problem = u0 == 0 ? problem : std::string{};
    out.segment.u0 = u0;
    out.segment.u1 = u1;
    out.metric = metric_of(out.segment.path);
    out.feed = speed;
    out.mode = canon::PathMode::exact_stop;
    tip_ = end;
    merger_.push(std::move(out));
    merger_.stop();
  };
  go(line.end, 0, sync.rigid_tap ? 0.5 : 1);
  if (sync.rigid_tap) go(start, 0.5, 1);
  return {};
}

// The wait for the index, the locked way, the stop; a tap's spindle slows down with the axis, turns
// round and brings it back.
void Planner::Impl::push_sync(const canon::Command& command, const Line& line,
                              const canon::SyncFeed& sync, const Shaper::StraightRun& run,
                              SyncLaw law) {
  const double turns = std::abs(shaper_.spindle_turns());
  const double wait = (std::ceil(turns - 1e-9) - turns) * 60 / std::abs(rpm());
  const double down = sync.rigid_tap ? 0.5 : 1, sense = rpm() > 0 ? 1 : -1;
  const double speed = sync.per_revolution * std::abs(rpm()) / 60;
  machine::JointVector start = shaper_.joints();
  Segment index = segment(command, MotionKind::sync);
  if (wait > 0) index.profile.knots = {{0, 0, 0, 0, 0}, {wait, 0, 0, 0, 0}};
  index.u1 = 0;
  shaper_.push_planned(std::move(index), start);
  const auto piece = [&](const Line& path, double s0, double s1, SpeedProfile profile,
                         std::optional<Sync> with, double u0, double u1) {
    Segment out = segment(command, MotionKind::sync);
    out.path = sub_path(path, s0, s1);
    profile.knots.back().s = s1 - s0;
    out.profile = std::move(profile);
    out.feed = speed;
    out.sync = with;
    out.u0 = u0;
    out.u1 = u1;
    return out;
  };
  const double cut = law.lock.knots.back().s, share = down * cut / line.length;
  const Sync locked{sync.per_revolution, false, sense}, follows{sync.per_revolution, true, sense};
  shaper_.push_planned(piece(line, 0, cut, std::move(law.lock), locked, 0, share), run.end);
  shaper_.push_planned(piece(line, cut, line.length, std::move(law.stop),
                             sync.rigid_tap ? std::optional(follows) : std::nullopt, share, down),
                       run.end);
  if (!sync.rigid_tap) return;
  StraightLimits limits = run.limits;
  limits.v = std::min(limits.v, speed * sync.return_factor);
  const Line back = make_line(line.end, line.start);
  const Sync reversed{sync.per_revolution, true, -sense};
  shaper_.push_planned(piece(back, 0, back.length, s_curve(back.length, limits), reversed, 0.5, 1),
                       start);
}

// The joints stay where they are, and the tip is where the other kinematics has it for them.
Expected<void> Planner::Impl::switch_kinematics(const canon::Command& command,
                                                const canon::SwitchKinematics& to) {
  const auto fail = [&](const std::string& message) {
    return unexpected(at(command, "unsupported_code", message));
  };
  if (to.with_motion)
    return fail("a switch of the kinematics within the motion (M67) has no model; use M68 and M66");
  const auto& models = machine_.models();
  if (to.model < 0 || static_cast<std::size_t>(to.model) >= models.size())
    return fail("the program switches to kinematics " + std::to_string(to.model) +
                ", which this machine has not: " +
                (models.empty() ? "there is just one"
                                : "its channels are 0 to " + std::to_string(models.size() - 1)));
  const machine::KinematicsModel& model = models[static_cast<std::size_t>(to.model)];
  if (!model.kinematics) return fail("the program switches the kinematics, but " + model.reason);
  merger_.stop();
  if (shaper_.failed()) return {};
  const machine::JointVector& joints = shaper_.joints();
  const auto tip = model.kinematics->forward(joints, tool_offset_);
  if (!tip)
    return fail("where the machine stands there is no position in the kinematics of '" +
                model.channel + "': " + tip.error().reason);
  const auto back = model.kinematics->inverse({*tip, tool_offset_}, joints);
  constexpr double still = 1e-6;  // mm or rad
  if (!back || !((*back - joints).cwiseAbs().maxCoeff() <= still))
    return fail("the joints would not stand still when the program switches to '" + model.channel +
                "'" + (back ? "" : ": " + back.error().reason));
  kinematics_ = model.kinematics.get();
  shaper_.switch_to(*kinematics_);
  tip_ = *tip;
  return barrier(command);
}

Expected<void> Planner::Impl::push(const canon::Command& command) {
  if (broken_) return unexpected(*broken_);
  return std::visit(
      overloaded{
          [&](const canon::Rapid& c) -> Expected<void> {
            if (!has_straight_rapids(machine_, *kinematics_)) return rapid(command, c.end);
            return move(command, make_line(tip_, c.end), MotionKind::rapid, infinity);
          },
          [&](const canon::LinearFeed& c) {
            return feed_move(command, make_line(tip_, c.end), MotionKind::feed);
          },
          [&](const canon::ArcFeed& c) -> Expected<void> {
            if (c.turns == 0) return feed_move(command, make_line(tip_, c.end), MotionKind::feed);
            auto arc = make_arc(tip_, c);
            if (!arc) return unexpected(at(command, arc.error().kind, arc.error().message));
            return feed_move(command, std::move(*arc), MotionKind::arc);
          },
          [&](const canon::SplineFeed& c) { return spline(command, c); },
          [&](const canon::SyncFeed& c) { return sync(command, c); },
          [&](const canon::Probe&) { return probe(command, std::nullopt); },
          [&](const canon::Dwell& c) { return barrier(command, c.seconds, MotionKind::dwell); },
          [&](const canon::SetFeedMode& c) {
            feed_mode_ = c.mode;
            return still(command);
          },
          [&](const canon::SetFeedRate& c) {
            feed_rate_ = c;
            return still(command);
          },
          [&](const canon::SelectPlane&) { return still(command); },
          [&](const canon::UseUnit&) { return still(command); },
          [&](const canon::WorkOffset& c) {
            work_system_ = c.system;
            return still(command);
          },
          [&](const canon::WorkRotation&) { return still(command); },
          [&](const canon::G92Offset&) { return still(command); },
          [&](const canon::ProgramMap&) { return still(command); },
          [&](const canon::ToolLengthOffset& c) {
            merger_.stop();
            // The machine stands still; what changes is where the tip is: along Z, as long as the
            // tool stands upright in M. The interpreter knows no other direction.
            if (const auto axis = kinematics_->tool_axis(tip_);
                axis && !((*axis - Vec3::UnitZ()).norm() < 1e-9) &&
                (tool_offset_ - c.offset).value != AxisValues{}.value)
              return no_model(command,
                              "a change of the tool length offset while the tool is tilted");
            tip_ = tip_ + tool_offset_ - c.offset;
            tool_offset_ = c.offset;
            return barrier(command);
          },
          [&](const canon::SetPathMode& c) {
            path_mode_ = c.mode;
            path_tolerance_ = c.tolerance;
            return still(command);
          },
          [&](const canon::SetNaiveCam& c) {
            merge_tolerance_ = c.tolerance;
            return still(command);
          },
          [&](const canon::SetSpindleMode& c) {
            if (c.spindle == 0) css_ = c.css_max_rpm > 0;
            return still(command);
          },
          [&](const canon::SetSpindleSpeed& c) {
            const double before = rpm();
            if (c.spindle == 0) spindle_speed_ = c.value;
            return spindle(command, before);
          },
          [&](const canon::TurnSpindle& c) {
            const double before = rpm();
            if (c.spindle == 0) spindle_turn_ = c.turn;
            return spindle(command, before);
          },
          [&](const canon::OrientSpindle& c) {
            merger_.stop();
            if (c.spindle == 0) spindle_turn_ = canon::SpindleTurn::stop;
            return barrier(command);
          },
          [&](const canon::SelectTool&) { return still(command); },
          [&](const canon::ChangeTool& c) {
            auto done = barrier(command, machine_.tool_change().seconds, MotionKind::tool_change);
            tool_ = c.number;
            return done;
          },
          [&](const canon::SetToolNumber& c) {
            auto done = barrier(command);
            tool_ = c.number;
            return done;
          },
          [&](const canon::Coolant&) { return barrier(command); },
          [&](const canon::Override& c) {
            using Kind = canon::Override::Kind;
            if (c.kind == Kind::feed) overridable_.feed = c.enabled;
            if (c.kind == Kind::speed && c.spindle == 0) overridable_.spindle = c.enabled;
            if (c.kind == Kind::feed_hold) overridable_.hold = c.enabled;
            if (c.kind == Kind::adaptive_feed) overridable_.adaptive = c.enabled;
            return still(command);
          },
          [&](const canon::DigitalOutput& c) {
            return c.with_motion ? still(command) : barrier(command);
          },
          [&](const canon::AnalogOutput& c) {
            return c.with_motion ? still(command) : barrier(command);
          },
          [&](const canon::SwitchKinematics& c) { return switch_kinematics(command, c); },
          [&](const canon::WaitInput&) { return barrier(command); },
          [&](const canon::UserCode& c) {
            const auto rule = machine_.user_codes().find(c.code);
            const bool timed = c.letter == 'M' && rule != machine_.user_codes().end() &&
                               rule->second.kind == machine::UserCodeKind::time;
            return barrier(command, timed ? rule->second.seconds : 0);
          },
          [&](const canon::ProgramStop& c) {
            return barrier(command, c.optional ? options_.optional_stop : 0);
          },
          [&](const canon::PalletChange&) { return barrier(command); },
          [&](const canon::ProgramEnd&) { return barrier(command); },
          [&](const canon::Message&) { return still(command); },
          [&](const canon::LogFile&) { return still(command); },
      },
      command.action);
}

Planner::Planner(const machine::Machine& machine, const machine::JointVector& start,
                 Options options)
    : impl_(std::make_unique<Impl>(machine, start, options)) {}
Planner::~Planner() = default;
Expected<void> Planner::push(const canon::Command& command) { return impl_->push(command); }
Expected<void> Planner::push_probe(const canon::Command& command, double trip) {
  return impl_->probe(command, trip);
}
const AxisValues& Planner::tip() const { return impl_->tip(); }
Segment Planner::straight_way(const canon::Command& command) const {
  return impl_->straight_way(command);
}
void Planner::flush() { impl_->flush(); }
Statistics Planner::statistics() const { return impl_->statistics(); }
std::optional<Segment> Planner::take() { return impl_->take(); }

}  // namespace aircut::plan
