#include <unistd.h>

#include <cstdio>

#include "cli/exit_code.h"
#include "cli/job.h"
#include "semantics/semantics.h"

namespace aircut::cli {

int trace_command(const TraceArguments& a) {
  Job job;
  const auto program = open_program(job.sources, a.program.program);
  if (!program) {
    print_error(program.error(), a.color);
    return code(ExitCode::unknown);
  }
  interp::Options options;
  const bool reference = a.format == TraceFormat::rs274;
  const bool reference_units =
      reference && (a.program.machine.empty() || a.program.machine == ini_of(a.program));
  // The reference program takes the inch as machine unit, so its tool table is read in inches.
  ProgramArguments inputs = a.program;
  inputs.ini_use = ProgramArguments::IniUse::control;
  open_inputs(job, inputs, reference_units ? std::optional(25.4) : std::nullopt);
  print_errors(job.diagnostics, a.color);
  if (job.diagnostics.errors() > 0) return code(ExitCode::unknown);

  options = interpreter_options(job, a.program, **program);
  if (reference_units) {
    options.machine_unit = canon::Unit::inch;
    options.start_unit = canon::Unit::millimetre;
    options.startup = nullptr;
    options.tool_change_position.reset();
    options.axes = {};
    for (const Axis axis : {Axis::x, Axis::y, Axis::z, Axis::a, Axis::b, Axis::c})
      options.axes.add(axis);
  }
  options.keep_going = !reference;  // the reference stops at its first error
  Diagnostics diagnostics;
  interp::Interpreter interpreter(**program, job.tools, job.parameters, options,
                                  sub_reader(job.sources), diagnostics);
  // Tells where the tip is when a program switches the kinematics.
  Diagnostics not_told;
  std::optional<semantics::TravelCheck> follower;
  if (job.machine && job.machine->models().size() > 1)
    follower.emplace(*job.machine, job.start, not_told);
  canon::Rs274Writer writer(options.start_unit);
  std::string out;
  constexpr std::size_t flush_at = 1 << 16;
  std::vector<std::string> unchecked =
      job.control ? job.control->unchecked : std::vector<std::string>();
  while (const auto command = interpreter.next()) {
    switch (a.format) {
      case TraceFormat::text:
        out += canon::to_text(command->action) + "\n";
        break;
      case TraceFormat::jsonl:
        out += canon::to_json(*command) + "\n";
        break;
      case TraceFormat::rs274:
        out += writer.write(*command);
        break;
    }
    if (follower) follower->see(*command);
    if (follower && std::holds_alternative<canon::SwitchKinematics>(command->action))
      interpreter.synchronise(follower->tip());
    if (const auto* probe = std::get_if<canon::Probe>(&command->action))
      interpreter.resume({.tip = probe->end, .tripped = false});
    note_user_code(job, *command, diagnostics, unchecked);
    if (out.size() >= flush_at) {
      std::fwrite(out.data(), 1, out.size(), stdout);
      out.clear();
    }
  }
  if (reference) out += writer.finish();
  const bool written =
      std::fwrite(out.data(), 1, out.size(), stdout) == out.size() && std::fflush(stdout) == 0;
  if (!written) {
    print_error(make_error("output_failed", "can't write to standard output"), a.color);
    return code(ExitCode::unknown);
  }
  print_errors(diagnostics, a.color);
  if (diagnostics.errors() > 0) return code(ExitCode::fail);
  const bool unknown = interpreter.statistics().limit_reached || !unchecked.empty();
  return code(unknown ? ExitCode::unknown : ExitCode::pass);
}

}  // namespace aircut::cli
