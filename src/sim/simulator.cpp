#include <cmath>

#include "sim/checks/cutting.h"
#include "sim/checks/turning.h"
#include "sim/probing.h"
#include "sim/sim.h"
#include "tool/insert.h"

namespace aircut::sim {

Simulator::Simulator(std::shared_ptr<const machine::Machine> machine, const tool::ToolTable& tools,
                     const JointVector& start, const CheckOptions& options)
    : scene_(std::move(machine), tools), joints_(start) {
  if (options.limits) {
    checks_.push_back(make_travel_check());
    checks_.push_back(make_unwind_check());
    checks_.push_back(make_feed_check());
    checks_.push_back(make_dynamics_check());
    checks_.push_back(make_deviation_check());
  }
  if (options.collision) checks_.push_back(make_collision_check(options));
  if (options.cut && turns_the_work(scene_.machine())) {
    auto turning = std::make_unique<TurningCheck>(options);
    turning_ = turning.get();
    checks_.push_back(std::move(turning));
  } else if (options.cut) {
    auto cutting = std::make_unique<CuttingCheck>(options);
    cutting_ = cutting.get();
    checks_.push_back(std::move(cutting));
  } else if (scene_.machine().stock()) {
    not_checked("the tool against the stock (--check without `cut`)");
  }
}

void Simulator::listen_to_cuts(CutListener& listener) {
  if (turning_) turning_->listen(listener);
  if (cutting_) cutting_->listen(listener);
}

std::optional<TriangleMesh> Simulator::part() const {
  if (turning_) return turning_->part();
  if (!cutting_ || !cutting_->stock()) return std::nullopt;
  return cutting_->stock()->mesh();
}

std::optional<std::string> Simulator::saved_stock() const {
  if (turning_ && turning_->stock()) return turning_->stock()->save();
  if (!cutting_ || !cutting_->stock()) return std::nullopt;
  return cutting_->stock()->save();
}

std::optional<Simulator::ComparedPart> Simulator::deviation() const {
  if (turning_ && turning_->design() && turning_->part()) {
    ComparedPart turned{*turning_->part(), {}};
    turned.outside = turning_->design()->outside(turned.mesh);
    return turned;
  }
  if (!cutting_ || !cutting_->stock() || !cutting_->part()) return std::nullopt;
  ComparedPart out{cutting_->stock()->mesh(stock::Facets::lattice), {}};
  out.outside = cutting_->part()->outside(out.mesh);
  return out;
}

Expected<std::unique_ptr<StockHistory>> Simulator::stock_history(double steps) {
  if (turning_) return turning_->history();
  if (!cutting_ || !cutting_->stock() || !cutting_->tape()) return nullptr;
  return cutting_->tape()->play(*scene_.machine().stock(), steps);
}

void Simulator::not_checked(const std::string& what) { summary_.unchecked.push_back(what); }

void Simulator::start() {
  for (const auto& check : checks_) check->start(scene_, joints_, findings_);
  for (Observer* observer : observers_) observer->on_start(scene_, joints_);
}

void Simulator::step(const plan::Segment& segment) {
  if (const auto* length = std::get_if<canon::ToolLengthOffset>(&segment.command.action))
    scene_.use_length_offset(length->tool);
  const motion::JointMotion motion(scene_.machine(), segment, joints_);
  const Step step{scene_, motion, segment};
  count(segment);

  for (const auto& check : checks_) check->step(step, findings_);
  for (Observer* observer : observers_) observer->on_step(step);
  if (const auto end = motion.at(motion.t1())) joints_ = *end;

  if (segment.failure) {
    Finding f = finding_at(segment.failure->kind == "singular" ? Kind::singular : Kind::unreachable,
                           step, segment.t_end());
    f.message = "the path leaves what the machine can reach: " + segment.failure->message;
    f.u_first = f.u_end = segment.failure->fraction;
    f.tip = segment.failure->pose;
    findings_.add(f);
    stopped_ = true;
    return;
  }
  feed_without_tool(step);
  int tool = -1;
  if (const auto* change = std::get_if<canon::ChangeTool>(&segment.command.action))
    tool = change->number;
  if (const auto* number = std::get_if<canon::SetToolNumber>(&segment.command.action))
    tool = number->number;
  if (tool >= 0) {
    scene_.load_tool(tool);
    const tool::Tool* loaded = scene_.tool();
    if (tool > 0 && !loaded) {
      Finding f = finding_at(Kind::tool_missing, step, segment.t_end());
      f.message = "tool T" + std::to_string(tool) + " is not in the tool table";
      f.remedy = "add it to the tool file, or name another file with --tools";
      findings_.add(f);
    } else if (loaded && !tool::has_body(*loaded)) {
      Finding f = finding_at(Kind::not_checked, step, segment.t_end());
      f.message = "tool T" + std::to_string(tool) +
                  " has no geometry, so collisions of tool and holder can't be checked";
      f.remedy = "describe cutter, shank and holder in a tools.toml";
      f.makes_unknown = true;
      findings_.add(f);
    }
    if (loaded && !loaded->unknown.empty()) {
      Finding f = finding_at(Kind::not_checked, step, segment.t_end());
      f.message = "of tool T" + std::to_string(tool) + " the tool file does not tell " +
                  loaded->unknown + ", so its collisions can't be checked";
      f.remedy = "describe it whole in a tools.toml";
      f.makes_unknown = true;
      findings_.add(f);
    }
    for (const auto& check : checks_) check->scene_changed(step, joints_, findings_);
  }
  if (const auto* wait = std::get_if<canon::WaitInput>(&segment.command.action)) {
    Finding f = finding_at(Kind::not_checked, step, segment.t_end());
    f.message = std::string("M66 reads ") + (wait->analog ? "analog" : "digital") + " input " +
                std::to_string(wait->index) + ", which has no model here: it is taken as 0";
    f.remedy = "what follows was checked for that value only";
    f.makes_unknown = true;
    // M66 L0 does not wait: all that it changes is #5399.
    constexpr std::size_t most = 1000;  // in a loop it comes again and again
    if (wait->mode == 0 && inputs_.size() < most)
      inputs_.push_back(std::move(f));
    else
      findings_.add(f);
  }
  if (std::holds_alternative<canon::Probe>(segment.command.action)) probed(step);
  if (!segment.sync_problem.empty()) {
    Finding f = finding_at(Kind::sync_limit, step, segment.t_start);
    f.message = segment.sync_problem;
    f.remedy = "use a lower spindle speed, or begin farther away";
    findings_.add(f);
  }
  if (!segment.limit_problem.empty()) {
    Finding f = finding_at(Kind::dynamics_limit, step, segment.t_start);
    f.message = segment.limit_problem;
    f.remedy = "report this with the program and the machine; a lower feed may avoid it";
    findings_.add(f);
  }
  if (const auto* code = std::get_if<canon::UserCode>(&segment.command.action))
    user_code(step, *code);
}

ProbeResult Simulator::look_ahead(const plan::Segment& way) {
  const machine::Machine& machine = scene_.machine();
  const auto unknown = [&](std::string why) {
    probing_ = ProbeResult{ProbeResult::What::unknown, 0, std::move(why)};
    return *probing_;
  };
  std::shared_ptr<const collide::CollisionMesh> stock;
  if (machine.stock()) {
    if (!cutting_) return unknown("what is left of the stock is not known to it");
    auto now = cutting_->surface();
    if (!now) return unknown(now.error().message);
    stock = std::move(*now);
  }
  const machine::MotionBound bound(machine);
  const bool away = std::get<canon::Probe>(way.command.action).away;
  probing_ = find_trip({scene_, bound, joints_, way, away, std::move(stock)});
  return *probing_;
}

// What is to be said of a probing move that was carried out.
void Simulator::probed(const Step& step) {
  if (!probing_) return;  // the rest of one that was told of
  const ProbeResult result = std::move(*probing_);
  probing_.reset();
  const auto& probe = std::get<canon::Probe>(step.segment.command.action);
  if (result.what == ProbeResult::What::tripped) {
    if (cutting_) cutting_->probed();
    return;
  }
  if (result.what == ProbeResult::What::missed && !probe.error_if_missed) return;
  const bool known = result.what != ProbeResult::What::unknown;
  Finding f =
      finding_at(known ? Kind::probe_missed : Kind::not_checked, step, step.segment.t_end());
  if (result.what == ProbeResult::What::missed) {
    f.message = probe.away ? "the probing move ends while the probe still touches " + result.text
                           : "the probing move ends without touching anything";
    f.remedy = "let it go farther, or look at the work offset and the set-up";
  } else if (result.what == ProbeResult::What::wrong_start) {
    f.message = probe.away ? "the probe touches nothing where the probing move away begins"
                           : "the probe touches " + result.text + " where the probing move begins";
    f.remedy = probe.away ? "touch something first (G38.3)" : "retract first";
  } else {
    f.message = "what the probing move touches is not known: " + result.text +
                "; it runs to its end and trips nothing";
    f.remedy = "what follows was checked for that case only";
    f.makes_unknown = true;
  }
  findings_.add(f);
}

// Feed moves with a turning spindle and no tool: some control may have one in it that the program
// does not name, and nothing of that tool is checked.
void Simulator::feed_without_tool(const Step& step) {
  const plan::Segment& segment = step.segment;
  const bool feeds =
      segment.kind == plan::MotionKind::feed || segment.kind == plan::MotionKind::arc;
  if (told_no_tool_ || !feeds || segment.spindle_rpm == 0 || scene_.loaded_tool() != 0) return;
  told_no_tool_ = true;
  Finding f = finding_at(Kind::not_checked, step, segment.t_start);
  f.message = "the spindle turns and the program feeds, but no tool is in the spindle";
  f.remedy = "load one (T, M6) before; nothing of the tool that is meant was checked";
  f.makes_unknown = true;
  findings_.add(f);
}

void Simulator::user_code(const Step& step, const canon::UserCode& code) {
  const auto& rules = scene_.machine().user_codes();
  const auto rule = rules.find(code.code);
  if (code.letter != 'M') {
    Finding f = finding_at(Kind::not_executed, step, step.segment.t_end());
    f.message = "the lines from here to G11 set data of the control, which is never done here";
    f.remedy = "take them out of the program, and give the control's data in the machine";
    f.makes_unknown = true;
    findings_.add(f);
    return;
  }
  if (rule != rules.end() && (rule->second.kind == machine::UserCodeKind::ignore ||
                              rule->second.kind == machine::UserCodeKind::time))
    return;
  Finding f = finding_at(Kind::not_executed, step, step.segment.t_end());
  if (!code.remap.empty()) {
    f.message = code.remap + " is remapped to Python, which is never run here";
    f.remedy = "what follows was checked as if the remap did nothing more than the code itself";
    f.makes_unknown = true;
    return findings_.add(f);
  }
  f.message =
      "M" + std::to_string(code.code) + " runs a program of the control, which is never run here";
  f.remedy = "say in the machine's [mcodes] that it can be ignored: M" + std::to_string(code.code) +
             " = { kind = \"ignore\" }";
  f.makes_unknown = true;
  findings_.add(f);
}

void Simulator::count(const plan::Segment& segment) {
  const double time = segment.duration();
  summary_.cycle_time = std::max(summary_.cycle_time, segment.t_end());
  if (canon::is_motion(segment.command.action)) ++summary_.moves;
  if (segment.kind == plan::MotionKind::blend) summary_.blend_time += time;
  switch (plan::time_use(segment)) {
    case plan::TimeUse::rapid:
      summary_.rapid_time += time;
      break;
    case plan::TimeUse::feed:
      summary_.feed_time += time;
      break;
    case plan::TimeUse::tool_change:
      summary_.tool_change_time += time;
      break;
    case plan::TimeUse::spindle_wait:
      summary_.spindle_wait_time += time;
      break;
    case plan::TimeUse::rest:
      summary_.dwell_time += time;
      break;
  }
}

void Simulator::place(Finding& f) const {
  const machine::Machine& machine = scene_.machine();
  if (f.joints_worst.size() != machine.joint_count()) return;
  machine::LinkPoses poses;
  machine::forward(machine, f.joints_worst, poses);
  const auto pose = [&](machine::LinkId id) -> const Pose& {
    return poses.X_WL[static_cast<std::size_t>(machine::index(id))];
  };
  const machine::Spindle& spindle = machine.spindle();
  f.tool_axis = pose(spindle.link).linear() * spindle.R_LF * Vec3::UnitZ();
  if (!machine.stock()) return;
  const Pose X_SW = (pose(machine.stock()->link) * machine.stock()->X_LS).inverse(Eigen::Isometry);
  const tool::Tool* tool = scene_.tools().find(f.tool);
  const double length = tool ? tool->gauge_length : 0;
  f.tip_part = X_SW * (pose(spindle.link) * spindle.gauge - length * f.tool_axis);
  for (const Vec3& point : f.points) f.points_part.push_back(X_SW * point);
}

Simulator::Result Simulator::finish() {
  if (inputs_used_)
    for (Finding& f : inputs_) findings_.add(std::move(f));
  for (const auto& check : checks_) check->finish(summary_, findings_);
  summary_.findings_dropped = findings_.dropped();
  Result result{findings_.finish(), summary_};
  for (Finding& f : result.findings) place(f);
  for (Observer* observer : observers_) observer->on_finish(result.summary);
  return result;
}

}  // namespace aircut::sim
