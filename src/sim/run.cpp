// The whole data flow in one loop: program text → commands → segments → machine, checks, observers.

#include <algorithm>

#include "sim/sim.h"

namespace aircut::sim {

namespace {

std::string from_line_on(const SourceSpan& span, const std::string& why) {
  return (span ? "everything from " + span.place() + " on: " : "the whole program: ") + why;
}

}  // namespace

interp::KinematicsSwitch kinematics_switch(const machine::Machine& machine) {
  interp::KinematicsSwitch out;
  out.start = machine.model();
  for (const auto& [code, rule] : machine.user_codes())
    if (rule.kind == machine::UserCodeKind::kinematics) out.codes[code] = rule.model;
  out.tcp_on = machine.tcp_on();
  out.tcp_off = machine.tcp_off();
  return out;
}

void use_tool_change(const machine::Machine& machine, interp::Options& options) {
  const machine::ToolChange& change = machine.tool_change();
  if (change.position && !options.tool_change_position)
    options.tool_change_position = change.position;
  const auto of_tool_change = [](const interp::Remap& remap) { return remap.name == "M6"; };
  if (change.program.empty() ||
      std::any_of(options.remaps.begin(), options.remaps.end(), of_tool_change))
    return;
  interp::Remap remap;
  remap.code = 6;
  remap.modal_group = 6;
  remap.ngc = change.program;
  remap.name = "M6";
  remap.span = change.program_span;
  options.remaps.push_back(std::move(remap));
}

Simulator::Result run(interp::Interpreter& interpreter, const Diagnostics& diagnostics,
                      plan::Planner& planner, Simulator& simulator, const RunOptions& options) {
  bool moving = true;  // false once nothing can follow; then only the text is checked on
  SourceSpan last;
  bool interrupted = false, out_of_time = false;
  bool unsynchronised = false;  // M68 has switched the kinematics and no M66 came yet

  const auto drain = [&] {
    while (auto segment = planner.take()) {
      if (!moving) return;
      last = segment->command.span;
      if (segment->t_end() > options.max_time) {
        simulator.not_checked(from_line_on(
            last, "the limit of simulated time is reached (" + shortest(options.max_time) + " s)"));
        moving = false;
        out_of_time = true;
        return;
      }
      simulator.step(*segment);
      if (simulator.stopped()) {
        simulator.not_checked(from_line_on(last, "the machine can't get past this point"));
        moving = false;
      }
      if (options.progress) options.progress(segment->t_end(), last);
    }
  };

  // Where a probing move ends depends on what the machine meets on it.
  const auto probe = [&](const canon::Command& command) -> Expected<void> {
    planner.flush();
    drain();
    if (!moving) return {};
    const auto& action = std::get<canon::Probe>(command.action);
    const plan::Segment way = planner.straight_way(command);
    const ProbeResult met = simulator.look_ahead(way);
    const bool tripped = met.what == ProbeResult::What::tripped;
    const bool starts_wrong = met.what == ProbeResult::What::wrong_start;
    if (auto accepted =
            tripped || starts_wrong ? planner.push_probe(command, met.way) : planner.push(command);
        !accepted)
      return accepted;
    planner.flush();
    drain();
    const AxisValues tip = tripped ? plan::evaluate(way.path, met.way).p : action.end;
    interpreter.resume({.tip = tip, .tripped = tripped});
    interpreter.synchronise(planner.tip());  // it rests a little farther on
    const bool refused =
        starts_wrong || (met.what == ProbeResult::What::missed && action.error_if_missed);
    if (moving && refused) {
      simulator.not_checked(from_line_on(command.span, "the control stops at this probing move"));
      moving = false;
    }
    return {};
  };

  simulator.start();
  while (auto command = interpreter.next()) {
    if (options.stop_requested && options.stop_requested()) {
      interrupted = true;
      break;
    }
    if (options.listen) options.listen(*command);
    if (moving && diagnostics.errors() > 0) {
      planner.flush();
      drain();
      simulator.not_checked(
          from_line_on(diagnostics.list().front().span, "the control would refuse this block"));
      moving = false;
    }
    if (!moving) continue;
    const bool probes = std::holds_alternative<canon::Probe>(command->action);
    if (auto accepted = probes ? probe(*command) : planner.push(*command); !accepted) {
      planner.flush();
      drain();
      if (moving) simulator.not_checked(from_line_on(command->span, accepted.error().message));
      moving = false;
      continue;
    }
    const auto* switched = std::get_if<canon::SwitchKinematics>(&command->action);
    if (switched) planner.flush();
    drain();
    if (switched) {
      interpreter.synchronise(planner.tip());
      unsynchronised = switched->unsynchronised;
    }
    if (std::holds_alternative<canon::WaitInput>(command->action)) unsynchronised = false;
    if (unsynchronised && canon::is_motion(command->action)) {
      simulator.not_checked(from_line_on(
          command->span,
          "M68 has switched the kinematics and no M66 waits for it, so a control may still plan "
          "from the position before"));
      unsynchronised = false;
    }
  }
  planner.flush();
  drain();
  if (interrupted) simulator.not_checked(from_line_on(last, "the run was interrupted"));
  if (interpreter.statistics().limit_reached)
    simulator.not_checked("the rest of the program: the interpreter stopped at a limit");

  if (interpreter.statistics().input_read) simulator.inputs_are_used();
  Simulator::Result result = simulator.finish();
  result.summary.interrupted = interrupted;
  result.summary.limit_reached = out_of_time;
  result.summary.program_refused = diagnostics.errors() > 0;
  result.summary.blocks = interpreter.statistics().blocks;
  return result;
}

}  // namespace aircut::sim
