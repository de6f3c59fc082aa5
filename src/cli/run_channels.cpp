// `run --channel NAME=PROGRAM …`: several channels of one machine at once (docs/channels.md).
#include "cli/run_channels.h"

#include <algorithm>
#include <cstdio>
#include <deque>

#include "cli/accuracy_run.h"
#include "cli/exit_code.h"
#include "cli/job.h"
#include "cli/print_report.h"
#include "log/log.h"
#include "report/line_times.h"
#include "semantics/semantics.h"
#include "sim/channels.h"

namespace aircut::cli {

namespace {

// One channel's program with all that carries it out. It stays where it is.
struct Running {
  std::string name, program;
  const SourceText* text = nullptr;
  std::size_t input = 0;  ///< among the report's inputs
  Diagnostics diagnostics, doubts;
  std::optional<interp::Interpreter> interpreter;
  std::optional<plan::Planner> planner;
  std::optional<semantics::ProgramCheck> meaning;
  interp::ParameterFile before;
  std::optional<report::LineTimes> lines;
  std::unique_ptr<log::CsvJointLog> log;
};

// Options that are for a run of one channel only; empty: none is there.
std::string not_with_channels(const RunArguments& a) {
  if (!a.overrides.empty()) return "--overrides";
  if (!a.save_stock.empty()) return "--save-stock";
  if (!a.part.empty() && a.part != "null") return "--part";
  if (!a.log.empty() && a.log != "null") return "--log";
  if (!a.program.ini.empty() || a.program.machine.ends_with(".ini")) return "--ini";
  if (a.stock_colors != "plain") return "--stock-colors";
  if (std::find(a.motion.begin(), a.motion.end(), "glb") != a.motion.end()) return "--motion glb";
  if (machine::split_channel(a.program.machine).second != "") return "-m MACHINE:CHANNEL";
  return {};
}

bool open_programs(const RunArguments& a, Job& job, std::deque<Running>& running) {
  for (const std::string& given : a.channels) {
    const std::size_t equals = given.find('=');
    Running& r = running.emplace_back();
    if (equals == std::string::npos || equals == 0 || equals + 1 == given.size()) {
      job.diagnostics.add(make_error(
          "usage", "--channel " + printable(given) + ": write NAME=PROGRAM, like upper=upper.ngc"));
      return false;
    }
    r.name = given.substr(0, equals);
    r.program = given.substr(equals + 1);
    const auto text = open_program(job.sources, r.program);
    if (!text) {
      job.diagnostics.add(text.error());
      return false;
    }
    r.text = *text;
    r.input = job.inputs.size();
    job.inputs.push_back({"program", r.program, sha256(r.text->content())});
  }
  return true;
}

// Interpreter and planner of a channel, which has its own view of the machine.
sim::ChannelJob prepare(Running& r, const machine::ChannelView& view, Job& job,
                        const RunArguments& a, const Checks& checks) {
  const machine::JointVector whole_start = job.start;
  const auto whole = job.machine;
  job.start.resize(static_cast<Eigen::Index>(view.joints.size()));
  for (std::size_t j = 0; j < view.joints.size(); ++j)
    job.start[static_cast<Eigen::Index>(j)] = whole_start[view.joints[j]];
  job.machine = view.machine;
  const interp::Options options = interpreter_options(job, a.program, *r.text);
  r.interpreter.emplace(*r.text, job.tools, job.parameters, options, sub_reader(job.sources),
                        r.diagnostics);
  r.planner.emplace(*view.machine, job.start, plan::Options{.period = a.period});
  const bool offset_rows = options.dialect != interp::Dialect::linuxcnc;
  r.meaning.emplace(semantics::Context{job.tools, view.machine.get(), true, offset_rows},
                    r.diagnostics, r.doubts);
  r.before = r.interpreter->parameters();
  job.machine = whole;
  job.start = whole_start;
  sim::ChannelJob out;
  out.name = r.name = view.name;
  const auto& names = whole->channels();
  out.number =
      1 + static_cast<int>(std::find(names.begin(), names.end(), view.name) - names.begin());
  out.machine = view.machine;
  out.joints = view.joints;
  out.interpreter = &*r.interpreter;
  out.diagnostics = &r.diagnostics;
  out.planner = &*r.planner;
  if (checks.semantics)
    out.listen = [&r](const canon::Command& command) { r.meaning->see(command); };
  return out;
}

Expected<std::unique_ptr<log::CsvJointLog>> open_log(const std::string& path, const Job& job,
                                                     const machine::Machine& machine,
                                                     const Running& r, const RunArguments& a) {
  std::string hash;
  for (const report::Input& input : job.inputs)
    if (input.role == "machine") hash = input.sha256;
  return log::CsvJointLog::create(path, machine,
                                  {.period = a.period,
                                   .every = a.log_every,
                                   .program = r.program,
                                   .program_sha256 = job.inputs[r.input].sha256,
                                   .machine_sha256 = hash});
}

// What was found in a program's text.
void add_diagnostics(const Running& r, const sim::ChannelTimes& times, const Checks& checks,
                     report::RunReport& report) {
  for (const Diagnostics* list : {&r.diagnostics, &r.doubts})
    for (const Diagnostic& d : list->list()) {
      // Known better, or turned by another channel.
      if (d.kind == "spindle_stopped_cut" && (report.summary.stock || times.turned_by_other))
        continue;
      if (checks.semantics || !semantics::is_semantic(d.kind)) report.diagnostics.push_back(d);
    }
}

}  // namespace

int run_channels(const RunArguments& a) {
  const auto fail = [&](const Diagnostic& d) { return refuse(d, a.output); };
  if (const std::string option = not_with_channels(a); !option.empty())
    return fail(make_error("usage", option + " is for a run of one channel, not with --channel"));
  RunArguments shown = a;
  for (const std::string& channel : a.channels)
    shown.program.program += (shown.program.program.empty() ? "" : "  ") + channel;
  const auto frames = frame_options(shown);
  if (!frames) return fail(frames.error());
  const bool in_folder = !a.folder.empty();
  if (!in_folder && (!a.frames.empty() || !a.motion.empty()))
    return fail(make_error("usage", "--frames and --motion need -o DIR to write into"));
  Job job;
  auto rules = rules_of(a.output, job.sources);
  if (!rules) return fail(rules.error());
  std::deque<Running> running;
  machine::ChannelMachines machines;
  std::vector<std::string> names;
  if (!open_programs(a, job, running)) return refuse(job.diagnostics, a.output);
  for (const Running& r : running) names.push_back(r.name);
  if (!open_channels(job, a.program, names, machines)) return refuse(job.diagnostics, a.output);
  if (asked_for(a.checks).cut)
    if (auto fits = sim::stock_fits(*job.machine); !fits) return fail(fits.error());
  AccuracyRun accuracy;
  if (!a.accuracy.empty())
    if (auto opened = accuracy.open(job, a.accuracy); !opened) return fail(opened.error());
  if (in_folder)
    if (auto ready = prepare_folder(a.folder, a.force); !ready) return fail(ready.error());

  const Checks checks = asked_for(a.checks);
  std::vector<sim::ChannelJob> jobs;
  for (std::size_t i = 0; i < running.size(); ++i)
    jobs.push_back(prepare(running[i], machines.channels[i], job, a, checks));
  sim::ChannelRun run(job.machine, job.tools, job.start,
                      {.limits = checks.limits,
                       .collision = checks.collision,
                       .cut = checks.cut,
                       .keep_cuts = in_folder,
                       .near = a.near},
                      machines.wait, jobs);
  std::vector<std::string> outputs;
  std::unique_ptr<log::CsvJointLog> log;
  std::unique_ptr<report::FrameMaker> pictures;
  if (in_folder) {
    const bool logs = a.log != "null";
    if (logs) {
      auto made = open_log(a.folder + "/joints.csv", job, *job.machine, running.front(), a);
      if (!made) return fail(made.error());
      log = std::move(*made);
      run.add_observer(*log);
      outputs.push_back("joints.csv");
    }
    for (std::size_t i = 0; i < running.size(); ++i) {
      Running& r = running[i];
      r.lines.emplace(*machines.channels[i].machine);
      const std::string lines = "lines-" + r.name + ".jsonl";
      if (auto ready = r.lines->write_to(a.folder + "/" + lines); !ready)
        return fail(ready.error());
      run.add_observer(i, *r.lines);
      outputs.push_back(lines);
      if (!logs) continue;
      const std::string name = "joints-" + r.name + ".csv";
      auto own = open_log(a.folder + "/" + name, job, *machines.channels[i].machine, r, a);
      if (!own) return fail(own.error());
      r.log = std::move(*own);
      run.add_observer(i, *r.log);
      outputs.push_back(name);
    }
    if (frames->spec.any()) {
      if (const auto ok = report::check_view(*job.machine, frames->view); !ok)
        return fail(ok.error());
      pictures = std::make_unique<report::FrameMaker>(job.machine, job.tools, *frames, run.seats());
      run.add_observer(*pictures);
    }
  }
  if (auto ready = accuracy.attach(run, a.folder); !ready) return fail(ready.error());
  listen_to_signals();
  sim::RunOptions options;
  options.stop_requested = [] { return signal_that_came() != 0; };
  if (a.max_time) options.max_time = *a.max_time;
  sim::Simulator::Result result = run.run(options);

  for (Running& r : running) {
    if (!checks.semantics) break;
    r.meaning->finish({.reached = r.interpreter->statistics().ended,
                       .before = r.before.values,
                       .after = r.interpreter->parameters().values});
    result.summary.unchecked.insert(result.summary.unchecked.end(), r.meaning->unchecked().begin(),
                                    r.meaning->unchecked().end());
  }
  report::RunReport report = report_of(a, job, checks, std::move(result));
  accuracy.finish(report);
  for (std::size_t i = 0; i < running.size(); ++i) {
    const sim::ChannelTimes& times = run.times()[i];
    add_diagnostics(running[i], times, checks, report);
    if (running[i].interpreter->statistics().limit_reached) report.unknown_cause = "limit";
    report.channels.push_back(
        {times.name, running[i].program, times.end, times.waiting, times.blocks, times.moves});
  }
  if (report.summary.limit_reached) report.unknown_cause = "limit";
  report::Acceptance acceptance(std::move(*rules));
  acceptance.apply(running.front().program, report.diagnostics, report.findings,
                   report.summary.unchecked, report);
  acceptance.finish(report);
  Diagnostics judged;
  for (const Diagnostic& d : report.diagnostics) judged.add(d);
  report.summary.verdict = sim::judge(report.findings, report.summary, judged, a.output.fail_on);
  if (!report.accuracy) {
    const auto& wrong = accuracy.file_errors();
    report.diagnostics.insert(report.diagnostics.end(), wrong.begin(), wrong.end());
  }

  if (in_folder) {
    if (log)
      if (auto written = log->result(); !written) return fail(written.error());
    for (const Running& r : running) {
      if (auto written = r.lines->result(); !written) return fail(written.error());
      if (r.log)
        if (auto written = r.log->result(); !written) return fail(written.error());
    }
    report.outputs = outputs;
    if (const auto mesh = run.part(); mesh && a.part != "null") {
      if (auto ok = write_file(a.folder + "/part.stl", stl_bytes(*mesh)); !ok)
        return fail(ok.error());
      report.outputs.push_back("part.stl");
    }
    if (auto ok = accuracy.write(a.folder, report); !ok) return fail(ok.error());
    if (auto ok = accuracy.write_part(
            a.folder, run.part(), pictures ? std::optional(frames->size) : std::nullopt, report);
        !ok)
      return fail(ok.error());
    if (pictures && signal_that_came() == 0) {
      auto history = run.stock_history();
      if (!history) return fail(history.error());
      pictures->set_stock(std::move(*history));
      const auto written = pictures->write(a.folder, report.findings);
      if (!written) return fail(written.error());
      report.outputs.insert(report.outputs.end(), written->begin(), written->end());
    }
    if (auto ok = write_file(a.folder + "/result.json", report::to_json(report)); !ok)
      return fail(ok.error());
  }
  if (!print_report(report, a.output))
    return fail(make_error("output_failed", "can't write to standard output"));
  if (!a.output.quiet && a.output.format == Format::human) {
    for (const report::ChannelRow& row : report.channels)
      std::printf("  channel  %s: %.1f s, of which it waits %.1f s\n", printable(row.name).c_str(),
                  row.time, row.waiting);
    if (in_folder)
      std::printf("  written  %s/ (report.html is written for one channel only)\n",
                  printable(a.folder).c_str());
  }
  if (const int number = signal_that_came(); number != 0) return 128 + number;
  return code(exit_code_of(report.summary.verdict));
}

}  // namespace aircut::cli
