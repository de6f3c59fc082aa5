#include <unistd.h>

#include <cstdio>

#include "cli/exit_code.h"
#include "cli/job.h"

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
  const bool reference_units = reference && a.program.machine.empty();
  if (reference_units && !a.program.tools.empty()) {
    // The reference program takes the inch as machine unit, so its tool table is read in inches.
    ProgramArguments without_tools = a.program;
    without_tools.tools.clear();
    if (open_inputs(job, without_tools)) {
      const auto table = tool::read_tools(a.program.tools, 25.4, job.sources, job.diagnostics);
      if (table)
        job.tools = *table;
      else if (job.diagnostics.errors() == 0)
        job.diagnostics.add(table.error());
    }
  } else {
    open_inputs(job, a.program);
  }
  print_errors(job.diagnostics, a.color);
  if (job.diagnostics.errors() > 0) return code(ExitCode::unknown);

  options = interpreter_options(job, a.program, **program);
  if (reference_units) {
    options.machine_unit = canon::Unit::inch;
    options.axes = {};
    for (const Axis axis : {Axis::x, Axis::y, Axis::z, Axis::a, Axis::b, Axis::c})
      options.axes.add(axis);
  }
  options.keep_going = !reference;  // the reference stops at its first error
  Diagnostics diagnostics;
  interp::Interpreter interpreter(**program, job.tools, job.parameters, options,
                                  sub_reader(job.sources), diagnostics);
  canon::Rs274Writer writer(options.start_unit);
  std::string out;
  constexpr std::size_t flush_at = 1 << 16;
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
    if (const auto* probe = std::get_if<canon::Probe>(&command->action))
      interpreter.resume({.tip = probe->end, .tripped = false});
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
  return code(interpreter.statistics().limit_reached ? ExitCode::unknown : ExitCode::pass);
}

}  // namespace aircut::cli
