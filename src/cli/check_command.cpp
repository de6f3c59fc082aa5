// Many programs in one go. Each is a unit of its own: it has its own interpreter, verdict and
// texts. The texts of a program stay only while a message points into them, so memory grows with
// what is said and not with what was read.

#include <algorithm>
#include <memory>

#include "cli/exit_code.h"
#include "cli/job.h"
#include "cli/print_report.h"
#include "semantics/semantics.h"

namespace aircut::cli {

namespace {

// Messages kept over all programs; about a kilobyte each in the longest format. The rest are
// counted.
constexpr std::size_t most_messages = 100'000;

// Reads a program to its end; moves nothing. What it says is added to `diagnostics`; sets
// `refused` when the control would refuse a block.
report::Unit check_program(const Job& job, const ProgramArguments& arguments,
                           const SourceText& program, SourceMap& sources, Diagnostics& diagnostics,
                           bool& refused) {
  report::Unit unit;
  interp::Interpreter interpreter(program, job.tools, job.parameters,
                                  interpreter_options(job, arguments, program), sub_reader(sources),
                                  diagnostics);
  const auto parameters = interpreter.parameters();
  semantics::ProgramCheck meaning({job.tools, job.machine.get()}, diagnostics, diagnostics);
  std::optional<semantics::TravelCheck> travel;
  if (job.machine) travel.emplace(*job.machine, job.start, diagnostics);
  std::size_t own_errors = 0;
  const auto errors_of = [&](const auto& look) {
    const std::size_t before = diagnostics.errors();
    look();
    own_errors += diagnostics.errors() - before;
  };
  while (const auto command = interpreter.next()) {
    if (canon::is_motion(command->action)) ++unit.moves;
    errors_of([&] {
      meaning.see(*command);
      if (travel) travel->see(*command);
    });
    if (const auto* probe = std::get_if<canon::Probe>(&command->action))
      interpreter.resume({.tip = probe->end, .tripped = false});
  }
  errors_of([&] {
    meaning.finish({.reached = interpreter.statistics().ended,
                    .before = parameters.values,
                    .after = interpreter.parameters().values});
  });
  refused = diagnostics.errors() > own_errors;
  unit.blocks = interpreter.statistics().blocks;
  unit.unchecked = meaning.unchecked();
  if (travel)
    unit.unchecked.insert(unit.unchecked.end(), travel->unchecked().begin(),
                          travel->unchecked().end());
  if (interpreter.statistics().limit_reached)
    unit.unchecked.push_back(program.name() + ": a limit on its length was reached");
  return unit;
}

// fail before unknown before pass: one failing program makes the gate fail.
sim::Verdict worse(sim::Verdict a, sim::Verdict b) {
  for (const sim::Verdict v : {sim::Verdict::fail, sim::Verdict::unknown})
    if (a == v || b == v) return v;
  return sim::Verdict::pass;
}

}  // namespace

int check_command(const CheckArguments& a) {
  Job job;
  if (!open_inputs(job, a.program)) {
    print_errors(job.diagnostics, a.output.color);
    return code(ExitCode::unknown);
  }
  report::RunReport report;
  report.version = AIRCUT_VERSION;
  report.inputs = job.inputs;
  report.checks = {"syntax", "semantics"};
  if (job.machine) report.checks.push_back("limits of the programmed path");
  report.fail_on = a.output.fail_on;
  report.diagnostics = job.diagnostics.list();
  if (job.machine) report.machine = job.machine->name();

  sim::Verdict worst = sim::judge({}, {}, job.diagnostics, a.output.fail_on);
  std::vector<std::unique_ptr<SourceMap>> kept;
  for (const std::string& path : a.programs) {
    auto sources = std::make_unique<SourceMap>();
    Diagnostics diagnostics;
    sim::Summary summary;
    report::Unit unit;
    if (const auto program = open_program(*sources, path)) {
      report.inputs.push_back({"program", path, sha256((*program)->content())});
      unit =
          check_program(job, a.program, **program, *sources, diagnostics, summary.program_refused);
    } else {
      if (a.output.quiet) print_error(program.error(), a.output.color);
      unit.unchecked.push_back(program.error().message);
    }
    unit.program = path;
    unit.first = report.diagnostics.size();
    unit.count =
        std::min(diagnostics.list().size(), most_messages - std::min(most_messages, unit.first));
    if (const std::size_t more = diagnostics.list().size() - unit.count; more > 0)
      unit.unchecked.push_back(path + ": " + std::to_string(more) +
                               " more messages were counted but not kept");
    summary.unchecked = unit.unchecked;
    unit.verdict = sim::judge({}, summary, diagnostics, a.output.fail_on);
    for (std::size_t i = 0; i < unit.count; ++i)
      report.diagnostics.push_back(diagnostics.list()[i]);
    if (unit.count > 0) kept.push_back(std::move(sources));

    report.summary.blocks += unit.blocks;
    report.summary.moves += unit.moves;
    report.summary.program_refused |= summary.program_refused;
    for (const std::string& what : unit.unchecked) report.summary.unchecked.push_back(what);
    worst = worse(worst, unit.verdict);
    report.units.push_back(std::move(unit));
  }
  report.summary.verdict = worst;
  if (!print_report(report, a.output)) {
    print_error(make_error("output_failed", "can't write to standard output"), a.output.color);
    return code(ExitCode::unknown);
  }
  return code(exit_code_of(report.summary.verdict));
}

}  // namespace aircut::cli
