// The planner's front: keeps the modal state, turns commands into moves or stand-still segments,
// and says which commands the motion waits for. Barriers (the motion comes to rest) are commands
// that a control carries out only at rest: dwell, spindle, coolant, I/O that is not tied to motion,
// tool change, tool length, program stop and end. All other state rides along at speed.
#include <cmath>
#include <limits>
#include <numbers>

#include "plan/merger.h"

namespace aircut::plan {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

class Planner::Impl {
 public:
  Impl(const machine::Machine& machine, const machine::JointVector& start, Options options);

  Expected<void> push(const canon::Command& command);
  void flush() { merger_.stop(); }
  std::optional<Segment> take() { return shaper_.take(); }

 private:
  Expected<void> move(const canon::Command& command, Path path, MotionKind kind, double feed);
  Expected<void> feed_move(const canon::Command& command, Path path, MotionKind kind);
  Expected<double> feed_of(Metric metric, double way) const;
  Segment segment(const canon::Command& command, MotionKind kind) const;
  /// A segment without way that takes `seconds`, or rides along when it takes none.
  Expected<void> still(const canon::Command& command);
  Expected<void> barrier(const canon::Command& command, double seconds = 0,
                         MotionKind kind = MotionKind::idle);
  Expected<void> no_model(const canon::Command& command, const char* what) const;
  double rpm() const;

  const machine::Machine& machine_;
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
};

namespace {

Diagnostic at(const canon::Command& command, std::string kind, std::string message) {
  return make_error(std::move(kind), command.span, std::move(message));
}

}  // namespace

Planner::Impl::Impl(const machine::Machine& machine, const machine::JointVector& start,
                    Options options)
    : machine_(machine),
      options_(options),
      shaper_(machine, start, options.period, options.max_nodes),
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
                                   double feed) {
  Move out;
  out.segment = segment(command, kind);
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

Expected<void> Planner::Impl::push(const canon::Command& command) {
  if (broken_) return unexpected(*broken_);
  return std::visit(
      overloaded{
          [&](const canon::Rapid& c) -> Expected<void> {
            if (machine_.rapid() != machine::RapidMode::coordinated)
              return no_model(command, "a rapid that is not coordinated (machine key `rapid`)");
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
          [&](const canon::SplineFeed&) { return no_model(command, "a spline (G5.2)"); },
          [&](const canon::SyncFeed&) {
            return no_model(command, "spindle-synchronised motion (G33, G33.1)");
          },
          [&](const canon::Probe&) { return no_model(command, "probing (G38)"); },
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
            if (const auto axis = machine_.kinematics().tool_axis(tip_);
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
            merger_.stop();
            if (c.spindle == 0) spindle_speed_ = c.value;
            return barrier(command);
          },
          [&](const canon::TurnSpindle& c) {
            merger_.stop();
            if (c.spindle == 0) spindle_turn_ = c.turn;
            return barrier(command);
          },
          [&](const canon::OrientSpindle& c) {
            merger_.stop();
            if (c.spindle == 0) spindle_turn_ = canon::SpindleTurn::stop;
            return barrier(command);
          },
          [&](const canon::SelectTool&) { return still(command); },
          [&](const canon::ChangeTool& c) {
            merger_.stop();
            tool_ = c.number;
            return barrier(command, machine_.tool_change().seconds, MotionKind::tool_change);
          },
          [&](const canon::SetToolNumber& c) {
            merger_.stop();
            tool_ = c.number;
            return barrier(command);
          },
          [&](const canon::Coolant&) { return barrier(command); },
          [&](const canon::Override&) { return still(command); },
          [&](const canon::DigitalOutput& c) {
            return c.with_motion ? still(command) : barrier(command);
          },
          [&](const canon::AnalogOutput& c) {
            return c.with_motion ? still(command) : barrier(command);
          },
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
void Planner::flush() { impl_->flush(); }
std::optional<Segment> Planner::take() { return impl_->take(); }

}  // namespace aircut::plan
