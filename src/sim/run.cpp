// The whole data flow in one loop: program text → commands → segments → machine, checks, observers.

#include "sim/sim.h"

namespace aircut::sim {

namespace {

std::string from_line_on(const SourceSpan& span, const std::string& why) {
  return (span ? "everything from " + span.place() + " on: " : "the whole program: ") + why;
}

}  // namespace

Simulator::Result run(interp::Interpreter& interpreter, const Diagnostics& diagnostics,
                      plan::Planner& planner, Simulator& simulator, const RunOptions& options) {
  bool moving = true;  // false once nothing can follow; then only the text is checked on
  SourceSpan last;
  bool interrupted = false, out_of_time = false;

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
    if (auto accepted = planner.push(*command); !accepted) {
      planner.flush();
      drain();
      if (moving) simulator.not_checked(from_line_on(command->span, accepted.error().message));
      moving = false;
      continue;
    }
    if (std::holds_alternative<canon::Probe>(command->action)) planner.flush();
    drain();
    if (const auto* probe = std::get_if<canon::Probe>(&command->action))
      interpreter.resume({.tip = probe->end, .tripped = false});
  }
  planner.flush();
  drain();
  if (interrupted) simulator.not_checked(from_line_on(last, "the run was interrupted"));
  if (interpreter.statistics().limit_reached)
    simulator.not_checked("the rest of the program: the interpreter stopped at a limit");

  Simulator::Result result = simulator.finish();
  result.summary.interrupted = interrupted;
  result.summary.limit_reached = out_of_time;
  result.summary.program_refused = diagnostics.errors() > 0;
  result.summary.blocks = interpreter.statistics().blocks;
  return result;
}

}  // namespace aircut::sim
