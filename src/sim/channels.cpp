// Several channels on one clock.
//
// Each channel plans alone, as on its control, and gives timed segments. The clock goes from event
// to event: the next event is the earliest end of a segment that is under way. In between every
// channel follows one piece of one segment, or rests, so the interval is one motion of the whole
// machine: its joints are those of all channels together (motion::PartMotion). The checks of the
// machine see these intervals; the checks of a program (limits, feed, accuracy) see each channel's
// whole segments when they are done.
//
// A channel that comes to a wait code rests until all that the code names rest at the same one;
// then all of them go on at that instant. When nothing moves and somebody waits, nobody ever comes.
//
// Held at any time: the planners' windows and one segment of each channel.
#include "sim/channels.h"

#include <algorithm>
#include <cmath>

#include "plan/part.h"
#include "sim/channel_cuts.h"
#include "sim/channel_parts.h"
#include "sim/checks/turning.h"

namespace aircut::sim {

namespace {

constexpr double longest_common_cut = 1;  // mm of way while two channels cut, for their order

std::string code_of(const canon::Command& mark) {
  const auto& code = std::get<canon::UserCode>(mark.action);
  return "M" + std::to_string(code.code);
}

// Joints between a link and the bed, as indices into the tree.
std::set<int> way_to_bed(const machine::Machine& machine, machine::LinkId link) {
  std::set<int> out;
  while (link != machine::bed_link) {
    const machine::Link& at = machine.links()[static_cast<std::size_t>(machine::index(link))];
    out.insert(at.joint);
    link = at.parent;
  }
  return out;
}

// Whether the work of both turns about the same axis on the same link, looking the same way.
bool same_spindle(const machine::Machine& a, const machine::Machine& b) {
  if (a.work_link() != b.work_link()) return false;
  const Vec3 z = a.X_LM().linear() * Vec3::UnitZ();
  const Vec3 apart = b.X_LM().translation() - a.X_LM().translation();
  return z.dot(b.X_LM().linear() * Vec3::UnitZ()) > 1 - 1e-9 && z.cross(apart).norm() < 1e-6;
}

plan::Segment rest_segment(const canon::Command& last, const AxisValues& tip,
                           const AxisValues& tool_offset, double rpm, double t0, double t1) {
  plan::Segment out;
  out.command = last;
  out.command.action = canon::Dwell{t1 - t0};
  out.kind = plan::MotionKind::dwell;
  out.path = plan::Hold{tip};
  out.profile.knots = {{}, {.t = t1 - t0}};
  out.t_start = t0;
  out.tool_offset = tool_offset;
  out.spindle_rpm = rpm;
  return out;
}

}  // namespace

ChannelRun::ChannelRun(std::shared_ptr<const machine::Machine> whole, const tool::ToolTable& tools,
                       const JointVector& start, const CheckOptions& options,
                       std::optional<std::pair<int, int>> wait, std::vector<ChannelJob> jobs)
    : scene_(whole, tools,
             [&] {
               std::vector<Seat> seats;
               for (const ChannelJob& job : jobs)
                 seats.push_back({job.name, job.machine->spindle()});
               return seats;
             }()),
      options_(options),
      wait_(wait),
      joints_(start) {
  CheckOptions own = options;
  own.collision = own.cut = own.keep_cuts = false;
  users_.resize(static_cast<std::size_t>(whole->joint_count()));
  for (ChannelJob& job : jobs) {
    auto c = std::make_unique<Channel>();
    c->index = channels_.size();
    c->joints.resize(static_cast<Eigen::Index>(job.joints.size()));
    for (std::size_t j = 0; j < job.joints.size(); ++j) {
      c->joints[static_cast<Eigen::Index>(j)] = start[job.joints[j]];
      users_[static_cast<std::size_t>(job.joints[j])].push_back(c->index);
    }
    c->simulator = std::make_unique<Simulator>(job.machine, tools, c->joints, own);
    if (const auto tip = job.machine->kinematics().forward(c->joints, {})) c->tip = *tip;
    names_.push_back(job.name);
    c->job = std::move(job);
    channels_.push_back(std::move(c));
  }
  for (std::size_t link = 0; link < whole->links().size(); ++link) {
    std::set<std::size_t> movers;
    for (const int joint : way_to_bed(*whole, machine::LinkId{static_cast<int>(link)}))
      for (const std::size_t user : users_[static_cast<std::size_t>(joint)]) movers.insert(user);
    moved_by_.emplace_back(movers.begin(), movers.end());
  }
  if (options.collision) collision_ = make_collision_check(options);
}

ChannelRun::~ChannelRun() = default;

void ChannelRun::add_observer(std::size_t channel, Observer& observer) {
  channels_[channel]->simulator->add_observer(observer);
}

void ChannelRun::listen_to_cuts(CutListener& listener) {
  cuts_ = std::make_unique<ChannelCuts>(listener, scene_.machine());
}

std::vector<Seat> ChannelRun::seats() const { return scene_.seats(); }

std::optional<TriangleMesh> ChannelRun::part() const {
  return turning_ ? turning_->part() : std::nullopt;
}

Expected<std::unique_ptr<StockHistory>> ChannelRun::stock_history() {
  if (!turning_) return nullptr;
  return turning_->history();
}

// ---- a channel's program -----------------------------------------------------------------------

std::optional<plan::Segment> ChannelRun::next(Channel& c) {
  const auto give_up = [&](const SourceSpan& span, const std::string& why) {
    c.job.planner->flush();
    c.problem = (span ? "everything from " + span.place() + " on: " : "the whole program: ") + why;
  };
  for (;;) {
    if (auto segment = c.job.planner->take()) return segment;
    if (c.mark || c.ended) return std::nullopt;
    const canon::Command* command = c.job.interpreter->next();
    if (!command) {
      c.ended = c.flushed;
      c.flushed = true;
      if (!c.ended) c.job.planner->flush();
      continue;
    }
    if (!c.problem.empty()) continue;  // only the text is checked on
    if (c.job.diagnostics->errors() > 0) {
      give_up(c.job.diagnostics->list().front().span, "the control would refuse this block");
      continue;
    }
    if (const auto* code = std::get_if<canon::UserCode>(&command->action);
        code && code->letter == 'M' && code->remap.empty() && wait_ && code->code >= wait_->first &&
        code->code <= wait_->second) {
      c.job.planner->flush();
      c.mark = *command;
      continue;
    }
    if (c.job.listen) c.job.listen(*command);
    if (std::holds_alternative<canon::Probe>(command->action)) {
      give_up(command->span, "a probing move has no model where channels run at once");
    } else if (std::holds_alternative<canon::SwitchKinematics>(command->action)) {
      give_up(command->span, "the kinematics can't be switched where channels run at once");
    } else if (auto accepted = c.job.planner->push(*command); !accepted) {
      give_up(command->span, accepted.error().message);
    }
  }
}

// Goes on until the channel does something that lasts.
void ChannelRun::fetch(Channel& c) {
  while (!stopped_ && !c.active && !c.waits) {
    auto segment = next(c);
    if (!segment) break;
    segment->t_start = now_;
    if (segment->duration() > 0)
      c.active = std::move(segment);
    else
      complete(c, *segment);
  }
  if (stopped_ || c.active || c.waits) return;
  if (!c.problem.empty()) return stop(c, c.problem);
  if (c.mark) {
    c.waits = true;
    c.since = now_;
  }
}

void ChannelRun::complete(Channel& c, const plan::Segment& segment) {
  c.last = segment.command;
  c.tip = plan::evaluate(segment.path, plan::length(segment.path)).p;
  c.tool_offset = segment.tool_offset;
  c.work_system = segment.work_system;
  c.rpm = segment.spindle_rpm;
  c.turned = c.turned || c.rpm != 0;
  c.end = now_;
  c.simulator->step(segment);
  c.joints = c.simulator->joints();
  const canon::Action& action = segment.command.action;
  if (std::holds_alternative<canon::ChangeTool>(action) ||
      std::holds_alternative<canon::SetToolNumber>(action))
    change_tool(c);
  if (c.simulator->stopped())
    stop(c, "everything from " + segment.command.span.place() +
                " on: the machine can't get past this point");
}

void ChannelRun::change_tool(Channel& c) {
  scene_.load_tool(c.simulator->scene().loaded_tool(), c.index);
  const auto here = interval(now_, now_);
  if (collision_) collision_->scene_changed(here->steps.of[c.index], joints_, findings_);
  const Step own{c.simulator->scene(), here->own[c.index], here->segments[c.index]};
  if (turning_) turning_->scene_changed(own, c.joints, findings_);
}

// An error of one channel stops them all.
void ChannelRun::stop(Channel& c, const std::string& why) {
  if (stopped_) return;
  stopped_ = true;
  unchecked_.push_back("channel " + c.job.name + ": " + why);
  for (const auto& other : channels_)
    if (other.get() != &c && (other->active || other->waits || !other->ended))
      unchecked_.push_back("channel " + other->job.name + ": everything from t = " +
                           fixed(now_, 3) + " s on: channel " + c.job.name + " has stopped");
}

// ---- waiting -----------------------------------------------------------------------------------

// Whom a channel waits for, itself too: the digits of P, or all that run.
std::set<int> ChannelRun::partners(const Channel& c) const {
  const auto& code = std::get<canon::UserCode>(c.mark->action);
  std::set<int> out{c.job.number};
  if (!code.has_p) {
    for (const auto& other : channels_) out.insert(other->job.number);
    return out;
  }
  for (const char digit : shortest(std::abs(code.p)))
    if (digit >= '0' && digit <= '9') out.insert(digit - '0');
  return out;
}

// Lets those go on who all have come to the same mark; true when there were some.
bool ChannelRun::meet() {
  for (const auto& c : channels_) {
    if (!c->waits) continue;
    const std::set<int> wanted = partners(*c);
    std::vector<Channel*> there;
    for (const auto& other : channels_)
      if (other->waits && wanted.contains(other->job.number) &&
          code_of(*other->mark) == code_of(*c->mark) && partners(*other) == wanted)
        there.push_back(other.get());
    if (there.size() != wanted.size()) continue;
    for (Channel* other : there) release(*other);
    return true;
  }
  return false;
}

void ChannelRun::release(Channel& c) {
  const canon::Command mark = *c.mark;
  c.mark.reset();
  c.waits = false;
  c.waiting += now_ - c.since;
  complete(c, rest_segment(mark, c.tip, c.tool_offset, c.rpm, c.since, now_));
}

Finding ChannelRun::finding(Kind kind, const Channel& c, const canon::Command& command) const {
  Finding f;
  f.kind = kind;
  f.severity = severity_of(kind);
  f.span = command.span;
  f.expanded = command.expanded;
  f.block = command.block;
  f.channel = c.job.name;
  f.tools = scene_.loaded_tools();
  f.tool = scene_.loaded_tool(c.index);
  if (const tool::Tool* tool = scene_.tool(c.index)) f.tool_name = tool->name;
  f.work_system = work_system_name(c.work_system);
  f.t_block = f.t_block_end = f.t_first = f.t_worst = f.t_end = now_;
  f.joints_first = f.joints_worst = joints_;
  f.tip = c.tip;
  f.spindle_rpm = c.rpm;
  return f;
}

void ChannelRun::tell_deadlock() {
  for (const auto& c : channels_) {
    if (!c->waits) continue;
    Finding f = finding(Kind::wait_deadlock, *c, *c->mark);
    f.message = "channel " + c->job.name + " waits at " + code_of(*c->mark) + " for ever";
    for (const int number : partners(*c)) {
      if (number == c->job.number) continue;
      const auto other = std::find_if(channels_.begin(), channels_.end(),
                                      [&](const auto& o) { return o->job.number == number; });
      if (other == channels_.end()) {
        f.message += "; channel " + std::to_string(number) + " does not run";
        continue;
      }
      const Channel& o = **other;
      f.message += "; channel " + o.job.name;
      if (o.waits)
        f.message += " waits at " + code_of(*o.mark) + " (" + o.mark->span.place() + ")";
      else
        f.message += " has ended" + (o.last.span ? " after " + o.last.span.place() : "");
      f.other_channel = o.job.name;
      f.other_span = o.waits ? o.mark->span : o.last.span;
    }
    f.remedy = "every channel that a wait code names must come to the same code with the same P";
    f.makes_unknown = true;
    findings_.add(f);
    unchecked_.push_back("channel " + c->job.name + ": everything from " + c->mark->span.place() +
                         " on: it waits for ever");
  }
}

// ---- the clock ---------------------------------------------------------------------------------

void ChannelRun::start() {
  const machine::Machine& whole = scene_.machine();
  const std::set<int> to_stock =
      whole.stock() ? way_to_bed(whole, whole.stock()->link) : std::set<int>{};
  for (const auto& c : channels_) {
    c->simulator->start();
    if (!whole.stock()) continue;
    c->cuts_stock = same_spindle(whole, *c->job.machine) && turns_the_work(*c->job.machine);
    std::set<int> between;
    const std::set<int> to_tool = way_to_bed(whole, c->job.machine->spindle().link);
    std::set_symmetric_difference(to_tool.begin(), to_tool.end(), to_stock.begin(), to_stock.end(),
                                  std::inserter(between, between.end()));
    for (const int joint : between)
      if (std::find(c->job.joints.begin(), c->job.joints.end(), joint) == c->job.joints.end())
        c->foreign.push_back(joint);
    if (!c->cuts_stock)
      unchecked_.push_back("the tools of channel " + c->job.name +
                           " against the stock: they work on another spindle");
  }
  if (options_.cut && whole.stock()) {
    turning_ = std::make_unique<TurningCheck>(options_);
    if (cuts_) turning_->listen(*cuts_);
    turning_->start(scene_, joints_, findings_);
  } else if (whole.stock()) {
    unchecked_.push_back("the tools against the stock (--check without `cut`)");
  }
  if (collision_) collision_->start(scene_, joints_, findings_);
  for (Observer* observer : observers_) observer->on_start(scene_, joints_);
}

double ChannelRun::next_event() const {
  double t1 = INFINITY, fastest = 0;
  int cutting = 0;
  for (const auto& c : channels_) {
    if (!c->active) continue;
    t1 = std::min(t1, c->active->t_end());
    const bool feeds =
        c->active->kind == plan::MotionKind::feed || c->active->kind == plan::MotionKind::arc;
    if (!feeds || !c->cuts_stock) continue;
    ++cutting;
    fastest = std::max(fastest, c->active->feed);
  }
  if (turning_ && cutting > 1 && fastest > 0)
    t1 = std::min(t1, now_ + longest_common_cut / fastest);
  return t1;
}

std::unique_ptr<ChannelRun::Interval> ChannelRun::interval(double t0, double t1) {
  auto out = std::make_unique<Interval>();
  out->t0 = t0;
  out->t1 = t1;
  const std::size_t n = channels_.size();
  out->segments.reserve(n);
  out->own.reserve(n);
  out->whole.reserve(n);
  for (const auto& c : channels_) {
    auto piece = c->active ? plan::part_of(*c->active, t0, t1) : std::nullopt;
    out->segments.push_back(piece ? std::move(*piece)
                                  : rest_segment(c->last, c->tip, c->tool_offset, c->rpm, t0, t1));
    plan::Segment& segment = out->segments.back();
    segment.t_start = t0;
    out->own.emplace_back(*c->job.machine, segment, c->joints);
  }
  share_joints(*out);
  for (std::size_t i = 0; i < n; ++i)
    out->whole.emplace_back(scene_.machine(), out->own[i], out->parts, joints_);
  out->steps.names = names_;
  out->steps.moved_by = moved_by_;
  for (std::size_t i = 0; i < n; ++i)
    out->steps.of.push_back({scene_, out->whole[i], out->segments[i], i, &out->steps});
  return out;
}

// A joint that several channels drive goes with the one that moves it.
void ChannelRun::share_joints(Interval& at) {
  constexpr double none = 1e-9, jump = 1e-6;  // mm or rad
  std::vector<std::vector<double>> travel(channels_.size());
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const auto& joints = channels_[i]->job.joints;
    at.parts.push_back({&at.own[i], joints});
    travel[i].assign(scene_.machine().tree().size(), 0);
    if (!at.own[i].travel_bound(at.t0, at.t1, travel[i]))
      std::fill(travel[i].begin(), travel[i].end(), INFINITY);
  }
  for (std::size_t g = 0; g < users_.size(); ++g) {
    if (users_[g].size() < 2) continue;
    std::optional<std::size_t> mover;
    for (const std::size_t i : users_[g]) {
      const Channel& c = *channels_[i];
      const auto own = static_cast<std::size_t>(
          std::find(c.job.joints.begin(), c.job.joints.end(), static_cast<int>(g)) -
          c.job.joints.begin());
      if (mover || travel[i][own] <= none) at.parts[i].joints[own] = -1;
      if (travel[i][own] <= none) continue;
      const double off =
          c.joints[static_cast<Eigen::Index>(own)] - joints_[static_cast<Eigen::Index>(g)];
      if (!mover && std::abs(off) <= jump) {
        mover = i;
        continue;
      }
      const machine::Joint& joint = scene_.machine().joint(machine::JointId{static_cast<int>(g)});
      Finding f = finding(Kind::axis_conflict, c, at.segments[i].command);
      f.joint = joint.name;
      f.t_end = at.t1;
      const std::size_t first = mover.value_or(users_[g][0] == i ? users_[g][1] : users_[g][0]);
      const Channel& other = *channels_[first];
      f.other_channel = other.job.name;
      f.other_span = at.segments[first].command.span;
      f.message = mover ? "the channels " + other.job.name + " and " + c.job.name +
                              " move the axis " + joint.name + " at the same time"
                        : "channel " + c.job.name + " moves the axis " + joint.name +
                              " from where it is not: channel " + other.job.name + " has moved it";
      f.remedy = "let one channel move it, and the other wait until it is back";
      findings_.add(f);
      if (!mover) mover = i;
    }
  }
}

// The speed at which a channel's spindle turns, whoever has started it.
double ChannelRun::shared_rpm(std::size_t channel) const {
  const auto rpm = [](const Channel& c) { return c.active ? c.active->spindle_rpm : c.rpm; };
  const Channel& c = *channels_[channel];
  if (rpm(c) != 0 || c.turned) return rpm(c);
  for (const auto& other : channels_)
    if (other->index != channel && same_spindle(*c.job.machine, *other->job.machine) &&
        rpm(*other) != 0)
      return rpm(*other);
  return 0;
}

void ChannelRun::look_at_spindles(const Interval& at) {
  constexpr double none = 1e-6;  // rev/min
  for (const auto& a : channels_)
    for (const auto& b : channels_) {
      if (a->index >= b->index || !same_spindle(*a->job.machine, *b->job.machine)) continue;
      const std::pair<double, double> rpm{at.segments[a->index].spindle_rpm,
                                          at.segments[b->index].spindle_rpm};
      const bool both = (a->turned || rpm.first != 0) && (b->turned || rpm.second != 0);
      const bool over = (a->ended && !a->active) || (b->ended && !b->active);
      if (!both || over || std::abs(rpm.first - rpm.second) <= none) {
        a->told_rpm.erase(b->index);
        continue;
      }
      if (const auto told = a->told_rpm.find(b->index);
          told != a->told_rpm.end() && told->second == rpm)
        continue;
      a->told_rpm[b->index] = rpm;
      Finding f = finding(Kind::spindle_conflict, *a, at.segments[a->index].command);
      f.other_channel = b->job.name;
      f.other_span = at.segments[b->index].command.span;
      f.spindle_rpm = rpm.first;
      f.value = rpm.first;
      f.limit = rpm.second;
      f.unit = "rev/min";
      f.message = "channel " + a->job.name + " wants its spindle at " + fixed(rpm.first, 0) +
                  " rev/min, and channel " + b->job.name + " the same spindle at " +
                  fixed(rpm.second, 0);
      f.remedy =
          "command it in one channel, or the same speed in both; put a wait code before a "
          "change";
      findings_.add(f);
    }
}

bool ChannelRun::work_is_moved(std::size_t channel, const Interval& at) const {
  const Channel& c = *channels_[channel];
  const JointVector home = scene_.machine().home();
  const auto end = at.whole.front().at(at.t1);
  for (const int joint : c.foreign)
    if (std::abs(joints_[joint] - home[joint]) > 1e-6 || !end ||
        std::abs((*end)[joint] - home[joint]) > 1e-6)
      return true;
  return false;
}

void ChannelRun::cut(const Interval& at) {
  for (const auto& c : channels_) {
    const std::size_t i = c->index;
    if (at.rests(i) || !c->cuts_stock) continue;
    plan::Segment segment = at.segments[i];
    segment.spindle_rpm = shared_rpm(i);
    if (work_is_moved(i, at))
      turning_->lose("another channel moves the work or the tool of channel " + c->job.name +
                     " away from where its program has it");
    const motion::JointMotion own(*c->job.machine, segment, c->joints);
    Findings found;
    if (cuts_) cuts_->come_from(i, *c->job.machine, c->job.joints, joints_);
    turning_->step({c->simulator->scene(), own, segment}, found);
    for (Finding& f : found.finish()) {
      f.channel = c->job.name;
      f.tools = scene_.loaded_tools();
      if (const auto q = at.whole[i].at(std::clamp(f.t_first, at.t0, at.t1))) f.joints_first = *q;
      if (const auto q = at.whole[i].at(std::clamp(f.t_worst, at.t0, at.t1))) f.joints_worst = *q;
      if (f.kind != Kind::air_cut) findings_.add(std::move(f));  // a piece says nothing of the move
    }
  }
  if (cuts_) cuts_->hand_over();
}

void ChannelRun::advance(double t1) {
  const auto at = interval(now_, t1);
  look_at_spindles(*at);
  if (collision_) collision_->step(at->lead(), findings_);
  if (turning_) cut(*at);
  for (Observer* observer : observers_) observer->on_step(at->steps.of.front());
  if (const auto q = at->whole.front().at(t1)) joints_ = *q;
  for (std::size_t i = 0; i < channels_.size(); ++i)
    if (const auto q = at->own[i].at(t1)) channels_[i]->joints = *q;
  now_ = t1;
  for (const auto& c : channels_) {
    if (!c->active || c->active->t_end() > now_) continue;
    const plan::Segment done = std::move(*c->active);
    c->active.reset();
    complete(*c, done);
  }
}

Simulator::Result ChannelRun::run(const RunOptions& options) {
  start();
  while (!stopped_) {
    if (options.stop_requested && options.stop_requested()) {
      interrupted_ = true;
      unchecked_.push_back("everything from t = " + fixed(now_, 3) +
                           " s on: the run was interrupted");
      break;
    }
    for (const auto& c : channels_) fetch(*c);
    if (stopped_) break;
    if (meet()) continue;
    const double t1 = next_event();
    if (std::isinf(t1)) {
      tell_deadlock();
      break;
    }
    if (t1 > options.max_time) {
      out_of_time_ = true;
      unchecked_.push_back("everything from t = " + fixed(now_, 3) +
                           " s on: the limit of simulated time is reached (" +
                           shortest(options.max_time) + " s)");
      break;
    }
    advance(t1);
    if (options.progress) options.progress(now_, channels_.front()->last.span);
  }
  return finish();
}

Simulator::Result ChannelRun::finish() {
  Simulator::Result out;
  Summary& sum = out.summary;
  if (collision_) collision_->finish(sum, findings_);
  if (turning_) {
    Findings found;
    turning_->finish(sum, found);
    for (Finding& f : found.finish()) {
      f.joints_first = f.joints_worst = joints_;
      f.tools = scene_.loaded_tools();
      findings_.add(std::move(f));
    }
  }
  std::map<std::string, Summary::Joint> reached;
  for (const auto& c : channels_) {
    if (!interrupted_ && !c->ended)
      while (c->job.interpreter->next() != nullptr) {
      }  // after a stop the texts are still checked
    const interp::Interpreter::Statistics statistics = c->job.interpreter->statistics();
    if (statistics.limit_reached)
      unchecked_.push_back("channel " + c->job.name +
                           ": the rest of the program: the interpreter stopped at a limit");
    if (statistics.input_read) c->simulator->inputs_are_used();
    Simulator::Result own = c->simulator->finish();
    for (Finding& f : own.findings) {
      f.channel = c->job.name;
      // Of a channel's own checks only its own joints are known.
      f.joints_first.resize(0);
      f.joints_worst.resize(0);
      findings_.add(std::move(f));
    }
    for (const std::string& what : own.summary.unchecked)
      unchecked_.push_back("channel " + c->job.name + ": " + what);
    for (const Summary::Joint& joint : own.summary.joints) {
      const auto [place, fresh] = reached.try_emplace(joint.name, joint);
      place->second.low = std::min(place->second.low, joint.low);
      place->second.high = std::max(place->second.high, joint.high);
    }
    sum.feed_time += own.summary.feed_time;
    sum.rapid_time += own.summary.rapid_time;
    sum.dwell_time += own.summary.dwell_time;
    sum.tool_change_time += own.summary.tool_change_time;
    sum.spindle_wait_time += own.summary.spindle_wait_time;
    sum.blend_time += own.summary.blend_time;
    sum.moves += own.summary.moves;
    sum.blocks += statistics.blocks;
    sum.findings_dropped += own.summary.findings_dropped;
    sum.program_refused = sum.program_refused || c->job.diagnostics->errors() > 0;
    const bool turned_by_other =
        std::any_of(channels_.begin(), channels_.end(), [&](const auto& other) {
          return other != c && other->turned && same_spindle(*c->job.machine, *other->job.machine);
        });
    times_.push_back(
        {c->job.name, c->end, c->waiting, statistics.blocks, own.summary.moves, turned_by_other});
  }
  const machine::Machine& whole = scene_.machine();
  for (int j = 0; j < whole.joint_count(); ++j)
    if (const auto at = reached.find(whole.joint(machine::JointId{j}).name); at != reached.end())
      sum.joints.push_back(at->second);
  sum.cycle_time = now_;
  sum.interrupted = interrupted_;
  sum.limit_reached = out_of_time_;
  sum.findings_dropped += findings_.dropped();
  sum.unchecked.insert(sum.unchecked.end(), unchecked_.begin(), unchecked_.end());
  out.findings = findings_.finish();
  for (Observer* observer : observers_) observer->on_finish(sum);
  return out;
}

}  // namespace aircut::sim
