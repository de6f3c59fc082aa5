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
                           const SourceText& program, SourceMap& sources, const Checks& checks,
                           Diagnostics& diagnostics, bool& refused) {
  report::Unit unit;
  const interp::Options options = interpreter_options(job, arguments, program);
  interp::Interpreter interpreter(program, job.tools, job.parameters, options, sub_reader(sources),
                                  diagnostics);
  const auto parameters = interpreter.parameters();
  const bool offset_rows = options.dialect != interp::Dialect::linuxcnc;
  semantics::ProgramCheck meaning({job.tools, job.machine.get(), false, offset_rows}, diagnostics,
                                  diagnostics);
  std::optional<semantics::TravelCheck> travel;
  if (job.machine && checks.limits) travel.emplace(*job.machine, job.start, diagnostics);
  // Where the tip is in another kinematics is asked of the machine, whatever is checked.
  Diagnostics not_told;
  std::optional<semantics::TravelCheck> follower;
  if (job.machine && !travel && job.machine->models().size() > 1)
    follower.emplace(*job.machine, job.start, not_told);
  std::optional<linuxcnc::TravelCheck> axis_travel;
  if (has_axis_travel(job) && checks.limits)
    axis_travel.emplace(job.control->travel, options.start);
  std::vector<std::string> not_run;
  std::size_t own_errors = 0;
  const auto errors_of = [&](const auto& look) {
    const std::size_t before = diagnostics.errors();
    look();
    own_errors += diagnostics.errors() - before;
  };
  while (const auto command = interpreter.next()) {
    if (canon::is_motion(command->action)) ++unit.moves;
    errors_of([&] {
      if (checks.semantics) meaning.see(*command);
      if (travel) travel->see(*command);
      if (axis_travel) axis_travel->see(*command, diagnostics);
    });
    if (follower) follower->see(*command);
    if ((travel || follower) && std::holds_alternative<canon::SwitchKinematics>(command->action))
      interpreter.synchronise(travel ? travel->tip() : follower->tip());
    if (!checks.semantics) note_user_code(job, *command, diagnostics, not_run);
    if (const auto* probe = std::get_if<canon::Probe>(&command->action))
      interpreter.resume({.tip = probe->end, .tripped = false});
  }
  errors_of([&] {
    if (checks.semantics)
      meaning.finish({.reached = interpreter.statistics().ended,
                      .before = parameters.values,
                      .after = interpreter.parameters().values,
                      .input_read = interpreter.statistics().input_read});
  });
  refused = diagnostics.errors() > own_errors;
  unit.blocks = interpreter.statistics().blocks;
  unit.unchecked = meaning.unchecked();
  unit.unchecked.insert(unit.unchecked.end(), not_run.begin(), not_run.end());
  if (travel)
    unit.unchecked.insert(unit.unchecked.end(), travel->unchecked().begin(),
                          travel->unchecked().end());
  unit.limit_reached = interpreter.statistics().limit_reached;
  if (unit.limit_reached)
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
  auto rules = rules_of(a.output, job.sources);
  if (!rules) return refuse(rules.error(), a.output);
  if (std::find(a.checks.begin(), a.checks.end(), "limits") != a.checks.end() &&
      a.program.machine.empty() && ini_of(a.program).empty())
    return refuse(make_error("usage", "--check limits needs a machine: name one with -m"),
                  a.output);
  if (!open_inputs(job, a.program)) return refuse(job.diagnostics, a.output);
  const Checks checks = asked_for(a.checks);
  report::Acceptance acceptance(std::move(*rules));
  report::RunReport report;
  report.version = AIRCUT_VERSION;
  report.inputs = job.inputs;
  report.checks = {"syntax"};
  if (checks.semantics) report.checks.push_back("semantics");
  if (job.machine && checks.limits) report.checks.push_back("limits of the programmed path");
  if (!job.machine && has_axis_travel(job) && checks.limits)
    report.checks.push_back("limits of the programmed path");
  report.fail_on = a.output.fail_on;
  report.folder = working_folder();
  report.diagnostics = job.diagnostics.list();
  if (job.machine) report.machine = job.machine->name();

  // The other formats do not name the inputs.
  const bool hashed = a.output.format == Format::json || a.output.format == Format::jsonl ||
                      a.output.format == Format::sarif;
  const bool stream = a.output.format == Format::jsonl;
  const auto stream_shared = [&](std::size_t from) {  // messages of no program
    report::RunReport shared;
    shared.diagnostics.assign(report.diagnostics.begin() + static_cast<std::ptrdiff_t>(from),
                              report.diagnostics.end());
    return print_text(report::jsonl_messages(shared, false));
  };
  bool printed = !stream || (print_text(report::jsonl_head(report)) && stream_shared(0));
  if (job.control) report.summary.unchecked = job.control->unchecked;
  report.summary.unchecked.insert(report.summary.unchecked.end(), job.machine_unchecked.begin(),
                                  job.machine_unchecked.end());
  sim::Verdict worst = sim::judge({}, report.summary, job.diagnostics, a.output.fail_on);
  std::vector<std::unique_ptr<SourceMap>> kept;
  std::size_t messages = 0;
  for (const std::string& path : a.programs) {
    auto sources = std::make_unique<SourceMap>();
    report::RunReport part;  // what this program gives
    part.folder = report.folder;
    part.fail_on = report.fail_on;
    report::Unit unit;
    const std::size_t accepted_before = report.accepted.size();
    if (const auto program = open_program(*sources, path)) {
      part.inputs.push_back({"program", path, hashed ? sha256(**program) : ""});
      Diagnostics diagnostics;
      unit = check_program(job, a.program, **program, *sources, checks, diagnostics,
                           part.summary.program_refused);
      if (unit.limit_reached) report.unknown_cause = "limit";
      for (const Diagnostic& d : diagnostics.list())
        if (checks.semantics || !semantics::is_semantic(d.kind)) part.diagnostics.push_back(d);
    } else {
      if (a.output.quiet) print_error(program.error(), a.output.color);
      unit.unchecked.push_back(program.error().message);
      report.unknown_cause = "input";
    }
    unit.program = path;
    acceptance.apply(path, part.diagnostics, part.findings, unit.unchecked, report);
    part.accepted.assign(report.accepted.begin() + static_cast<std::ptrdiff_t>(accepted_before),
                         report.accepted.end());
    Diagnostics all;
    for (const Diagnostic& d : part.diagnostics) all.add(d);
    unit.count =
        std::min(part.diagnostics.size(), most_messages - std::min(most_messages, messages));
    messages += unit.count;
    if (const std::size_t more = part.diagnostics.size() - unit.count; more > 0)
      unit.unchecked.push_back(path + ": " + std::to_string(more) +
                               " more messages were counted but not kept");
    part.diagnostics.resize(unit.count);
    part.summary.unchecked = unit.unchecked;
    unit.verdict = sim::judge({}, part.summary, all, a.output.fail_on);
    part.units = {unit};
    if (stream) printed = print_text(report::jsonl_messages(part, true)) && printed;
    if (unit.count > 0 || !part.accepted.empty()) kept.push_back(std::move(sources));

    unit.first = report.diagnostics.size();
    report.inputs.insert(report.inputs.end(), part.inputs.begin(), part.inputs.end());
    report.diagnostics.insert(report.diagnostics.end(), part.diagnostics.begin(),
                              part.diagnostics.end());
    report.summary.blocks += unit.blocks;
    report.summary.moves += unit.moves;
    report.summary.program_refused |= part.summary.program_refused;
    for (const std::string& what : unit.unchecked) report.summary.unchecked.push_back(what);
    worst = worse(worst, unit.verdict);
    report.units.push_back(std::move(unit));
  }
  const std::size_t of_programs = report.diagnostics.size();
  acceptance.finish(report);
  if (stream) printed = stream_shared(of_programs) && printed;
  if (a.output.fail_on && *a.output.fail_on <= Severity::warning)
    for (const report::Waiver& waiver : report.waivers)
      if (waiver.used == 0) worst = sim::Verdict::fail;
  report.summary.verdict = worst;
  if (stream)
    printed = print_text(report::jsonl_summary(report)) && printed;
  else
    printed = print_report(report, a.output);
  if (!printed) {
    print_error(make_error("output_failed", "can't write to standard output"), a.output.color);
    return code(ExitCode::unknown);
  }
  return code(exit_code_of(report.summary.verdict));
}

}  // namespace aircut::cli
