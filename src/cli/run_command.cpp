#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <filesystem>

#include "cli/accuracy_run.h"
#include "cli/exit_code.h"
#include "cli/job.h"
#include "cli/overrides.h"
#include "cli/print_report.h"
#include "cli/run_channels.h"
#include "cli/view.h"
#include "log/log.h"
#include "logbook/logbook.h"
#include "page/glb.h"
#include "page/page.h"
#include "report/line_times.h"
#include "report/operations.h"
#include "semantics/semantics.h"

namespace aircut::cli {

namespace fs = std::filesystem;

namespace {

// Signal that asked the run to stop; a second one ends the process at once. `timeout` and a
// terminal's Ctrl-C through a wrapper send one request twice, so a second one only counts a second
// later.
volatile std::sig_atomic_t stop_signal = 0;
volatile std::sig_atomic_t stop_second = 0;  // of the monotonic clock

extern "C" void on_signal(int number) {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);  // safe in a handler
  const auto second = static_cast<std::sig_atomic_t>(now.tv_sec);
  if (stop_signal != 0 && second > stop_second + 1) _exit(128 + number);
  if (stop_signal != 0) return;
  stop_second = second;
  stop_signal = number;
}

// A joint log as HDF5 is made of the text, when that is complete. The text is removed in any case.
class Hdf5Log {
 public:
  explicit Hdf5Log(std::string path)
      : path_(std::move(path)), text_(path_ + "." + std::to_string(::getpid()) + ".csv") {}
  ~Hdf5Log() {
    std::error_code error;
    fs::remove(text_, error);
  }
  Hdf5Log(const Hdf5Log&) = delete;
  Hdf5Log& operator=(const Hdf5Log&) = delete;
  const std::string& text() const { return text_; }
  Expected<void> finish() const {
    SourceMap sources;
    const auto text = sources.open(text_);
    if (!text) return unexpected(text.error());
    return logbook::write_hdf5(**text, path_);
  }

 private:
  std::string path_, text_;
};

// One line on stderr, only for work over a second and only on a terminal.
class Progress {
 public:
  explicit Progress(When when)
      : shown_(when == When::always || (when == When::automatic && ::isatty(STDERR_FILENO) == 1)) {}
  ~Progress() { clear(); }

  void tell(double t, const SourceSpan& at) {
    if (!shown_ || ++calls_ % 256 != 0) return;
    const auto now = std::chrono::steady_clock::now();
    if (now - start_ < std::chrono::seconds(1) || now - last_ < std::chrono::milliseconds(200))
      return;
    last_ = now;
    written_ = true;
    std::fprintf(stderr, "\r\x1b[Kline %llu   %.1f s simulated   %.1f s worked",
                 static_cast<unsigned long long>(at.line), t,
                 std::chrono::duration<double>(now - start_).count());
    std::fflush(stderr);
  }
  void clear() {
    if (written_) std::fputs("\r\x1b[K", stderr);
    written_ = false;
  }

 private:
  bool shown_, written_ = false;
  unsigned calls_ = 0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now(), last_ = start_;
};

}  // namespace

Expected<void> make_folder(const std::string& folder, bool force) {
  const auto fail = [&](const std::string& why) {
    return unexpected(
        make_error("output_failed", "can't write into '" + printable(folder) + "': " + why));
  };
  std::error_code error;
  if (fs::exists(folder, error)) {
    if (!fs::is_directory(folder, error)) return fail("it is a file, not a folder");
    if (!force && !fs::is_empty(folder, error))
      return fail(
          "the folder exists and is not empty; name another one, or use --force to replace an "
          "earlier run's files");
    if (::access(folder.c_str(), W_OK) != 0) return fail(std::strerror(errno));
    return {};
  }
  fs::create_directories(folder, error);
  if (error) return fail(error.message());
  return {};
}

// The output folder of a run: made, or emptied of what an earlier run listed in its result.json.
Expected<void> prepare_folder(const std::string& folder, bool force) {
  std::error_code error;
  const bool exists = fs::exists(folder, error);
  if (auto made = make_folder(folder, force); !made) return made;
  if (exists) {
    // Without result.json the folder is known to be incomplete.
    fs::remove(folder + "/result.json", error);
    fs::remove(folder + "/joints.csv", error);
    fs::remove(folder + "/lines.jsonl", error);
    fs::remove(folder + "/sheet.png", error);
    for (const char* file : {"report.html", "part.stl", "part.3mf", "deviation.ply",
                             "deviation.png", "accuracy.json", "accuracy.csv", "accuracy-time.png",
                             "accuracy-path.png", "accuracy-part.png", "accuracy-part.ply"})
      fs::remove(folder + "/" + file, error);
    if (fs::is_directory(folder + "/frames", error))
      for (const auto& entry : fs::directory_iterator(folder + "/frames", error))
        if (entry.path().extension() == ".png") fs::remove(entry.path(), error);
  }
  return {};
}

namespace {

// A file of its own: `--log`, `--part`, `--save-stock`.
Expected<void> may_write(const std::string& path, bool force) {
  std::error_code error;
  if (path.empty() || path == "null" || force || !fs::exists(path, error)) return {};
  return unexpected(make_error(
      "output_failed", "'" + printable(path) + "' exists; name another file, or use --force"));
}

bool is_3mf(const std::string& path) { return fs::path(path).extension() == ".3mf"; }

Expected<void> check_outputs(const RunArguments& a) {
  if (a.log == "-")
    return unexpected(
        make_error("usage", "--log - is not supported: name a file, or null for none"));
  if (!a.part.empty() && a.part != "null" && !is_3mf(a.part) &&
      fs::path(a.part).extension() != ".stl")
    return unexpected(
        make_error("usage", "--part " + printable(a.part) + ": the name must end in .stl or .3mf"));
  for (const std::string* path : {&a.log, &a.part, &a.save_stock})
    if (auto ok = may_write(*path, a.force); !ok) return ok;
  return {};
}

bool wants_frames(const RunArguments& a) {
  return !(a.frames.size() == 1 && a.frames[0] == "none");
}

bool wants_motion(const RunArguments& a, std::string_view form) {
  return std::find(a.motion.begin(), a.motion.end(), form) != a.motion.end();
}

// What is left of the stock: as a mesh, for the next job, and compared with the design.
Expected<void> write_part(const RunArguments& a, const sim::Simulator& simulator,
                          const std::optional<std::string>& saved, report::RunReport& report) {
  if (saved)
    if (auto written = write_file(a.save_stock, *saved); !written) return written;
  const bool in_folder = !a.folder.empty();
  if (a.part == "null" || (!in_folder && a.part.empty())) return {};
  const auto mesh = simulator.part();
  if (!mesh) return {};
  const auto write = [&](const std::string& path, const std::string& bytes) -> Expected<void> {
    return write_file(path, bytes);
  };
  if (!a.part.empty()) {
    if (auto ok = write(a.part, is_3mf(a.part) ? report::three_mf_bytes(*mesh) : stl_bytes(*mesh));
        !ok)
      return ok;
  }
  if (!in_folder) return {};
  const auto listed = [&](const std::string& name, const std::string& bytes) {
    report.outputs.push_back(name);
    return write(a.folder + "/" + name, bytes);
  };
  if (a.part.empty()) {
    if (auto ok = listed("part.stl", stl_bytes(*mesh)); !ok) return ok;
    if (auto ok = listed("part.3mf", report::three_mf_bytes(*mesh)); !ok) return ok;
  }
  const auto compared = simulator.deviation();
  if (!report.summary.part || !compared) return {};
  const report::DeviationScale scale(*report.summary.part);
  if (auto ok = listed("deviation.ply", report::ply_bytes(compared->mesh, compared->outside,
                                                          scale.colors(compared->outside)));
      !ok)
    return ok;
  if (!wants_frames(a)) return {};
  const auto picture = report::deviation_picture(compared->mesh, compared->outside, scale,
                                                 {.width = a.width, .height = a.height});
  if (!picture) return unexpected(picture.error());
  return listed("deviation.png", render::png_bytes(*picture));
}

// What the inputs leave open.
std::vector<std::string> unchecked_of(const Job& job, const Checks& checks) {
  std::vector<std::string> all;
  const auto add = [&](const std::vector<std::string>& more) {
    all.insert(all.end(), more.begin(), more.end());
  };
  if (job.control) add(job.control->unchecked);
  add(job.machine_unchecked);
  if (!job.imported) return all;
  if (!checks.collision && !checks.cut) return all;
  add(job.imported->undrawn);
  if (checks.collision && job.machine->bodies().empty())
    all.push_back("collisions with the machine: a set-up has no bodies");
  return all;
}

}  // namespace

report::RunReport report_of(const RunArguments& a, const Job& job, const Checks& checks,
                            sim::Simulator::Result result) {
  const machine::Machine& machine = *job.machine;
  report::RunReport report;
  report.version = AIRCUT_VERSION;
  report.fail_on = a.output.fail_on;
  report.machine = machine.name();
  report.inputs = job.inputs;
  report.folder = working_folder();
  report.checks = {"syntax"};
  if (checks.semantics) report.checks.push_back("semantics");
  if (checks.limits) report.checks.push_back("limits");
  if (checks.collision) report.checks.push_back("collision");
  if (checks.cut && machine.stock()) report.checks.push_back("cut");
  report.settings = {{"near_mm", a.near},
                     {"period_s", a.period},
                     {"resolution_mm", machine.collision_tolerance()}};
  report.summary = std::move(result.summary);
  report.findings = std::move(result.findings);
  report.diagnostics = job.diagnostics.list();
  for (const std::string& what : unchecked_of(job, checks))
    report.summary.unchecked.push_back(what);
  if (checks.collision) {
    // An open mesh is checked by its surface only; what enters through a hole is not seen.
    Diagnostics model;
    machine::check_model(machine, model);
    for (const Diagnostic& d : model.list())
      if (d.kind == "mesh_defect") {
        report.diagnostics.push_back(d);
        report.summary.unchecked.push_back(d.message);
      }
  }
  for (int j = 0; j < machine.joint_count(); ++j) {
    const machine::Joint& joint = machine.joint(machine::JointId{j});
    report.joint_names.push_back(joint.name);
    report.joint_rotary.push_back(joint.kind == machine::JointKind::rotary);
  }
  return report;
}

Expected<report::FrameOptions> frame_options(const RunArguments& a) {
  report::FrameOptions options;
  const auto view = view_of(a.view);
  if (!view) return unexpected(view.error());
  options.view = *view;
  options.size = {a.width, a.height};
  options.program = a.program.program;
  options.motion = wants_motion(a, "png");
  options.video = wants_motion(a, "mp4");
  options.stock_by_tool = a.stock_colors == "tool";
  using Path = report::FrameOptions::Path;
  options.path = a.path_colors == "none"   ? Path::none
                 : a.path_colors == "time" ? Path::time
                                           : Path::kind;
  for (const std::string& text : a.frames)
    if (text != "none")
      if (auto added = report::add_frames(options.spec, text); !added)
        return unexpected(added.error());
  if (a.frames.empty()) {
    options.spec.count = 12;
    options.spec.findings = true;
  }
  return options;
}

void listen_to_signals() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
}

int signal_that_came() { return stop_signal; }

int run_command(const RunArguments& a, RunOutcome* outcome) {
  if (!a.channels.empty()) return run_channels(a);
  const auto fail = [&](const Diagnostic& d) { return refuse(d, a.output); };
  // Everything that can be wrong is looked at before anything is written.
  const auto frames = frame_options(a);
  if (!frames) return fail(frames.error());
  if (a.folder.empty() && !a.frames.empty() && wants_frames(a))
    return fail(make_error("usage", "--frames needs -o DIR to write into"));
  if (a.folder.empty() && !a.motion.empty())
    return fail(make_error("usage", "--motion needs -o DIR to write into"));
  if ((frames->motion || frames->video) && !wants_frames(a))
    return fail(
        make_error("usage", "--motion png and mp4 show the frames: --frames none leaves none"));
  if (frames->video)
    if (const auto ready = report::video_ready(); !ready) return fail(ready.error());
  if (const auto ok = check_outputs(a); !ok) return fail(ok.error());
  const bool as_hdf5 = fs::path(a.log).extension() == ".h5";
  if (as_hdf5)
    if (auto ready = logbook::hdf5_ready(); !ready) return fail(ready.error());
  Job job;
  auto rules = rules_of(a.output, job.sources);
  if (!rules) return fail(rules.error());
  const auto program = open_program(job.sources, a.program.program);
  if (!program) return fail(program.error());
  job.inputs.push_back({"program", a.program.program, sha256(**program)});
  if (!open_inputs(job, a.program)) return refuse(job.diagnostics, a.output);
  if (!job.machine)
    return fail(
        make_error("usage",
                   "the set-up has no [KINS]KINEMATICS, so there is no machine to move: name a "
                   "package too, -m PACKAGE --ini " +
                       printable(ini_of(a.program))));
  if (!job.machine->stock() && (!a.save_stock.empty() || (!a.part.empty() && a.part != "null")))
    return fail(
        make_error("usage", std::string(a.save_stock.empty() ? "--part" : "--save-stock") +
                                " needs a stock: name a set-up with [stock], --setup FILE"));
  if (frames->stock_by_tool && (!job.machine->stock() || sim::turns_the_work(*job.machine)))
    return fail(make_error("usage", job.machine->stock()
                                        ? "--stock-colors tool is for a milled stock: of a turned "
                                          "one it is not known which tool made what"
                                        : "--stock-colors tool needs a stock: name a set-up with "
                                          "[stock], --setup FILE"));
  if (asked_for(a.checks).cut)
    if (auto fits = sim::stock_fits(*job.machine); !fits) {
      fits.error().notes.push_back({"help", "say so in [stock] of " + printable(a.program.setup) +
                                                ": pitch = …, or leave it out"});
      return fail(fits.error());
    }
  std::vector<plan::OverrideEvent> overrides;
  if (!a.overrides.empty()) {
    auto read = read_overrides(job, a.overrides);
    if (!read) return refuse(read.error(), a.output);
    overrides = std::move(*read);
  }
  AccuracyRun accuracy;
  if (!a.accuracy.empty())
    if (auto opened = accuracy.open(job, a.accuracy); !opened) return fail(opened.error());
  if (!a.folder.empty())
    if (auto ready = prepare_folder(a.folder, a.force); !ready) return fail(ready.error());

  const machine::Machine& machine = *job.machine;
  Diagnostics diagnostics;
  const interp::Options control = interpreter_options(job, a.program, **program);
  interp::Interpreter interpreter(**program, job.tools, job.parameters, control,
                                  sub_reader(job.sources), diagnostics);
  plan::Planner planner(machine, job.start, {.overrides = overrides, .period = a.period});
  const Checks checks = asked_for(a.checks);
  sim::Simulator simulator(job.machine, job.tools, job.start,
                           {.limits = checks.limits,
                            .collision = checks.collision,
                            .cut = checks.cut,
                            .keep_cuts = !a.folder.empty(),
                            .near = a.near});

  std::unique_ptr<log::CsvJointLog> log;
  std::optional<Hdf5Log> hdf5;
  if (as_hdf5) hdf5.emplace(a.log);
  std::string log_path = hdf5 ? hdf5->text() : a.log;
  if (log_path.empty() && !a.folder.empty()) log_path = a.folder + "/joints.csv";
  if (!log_path.empty() && log_path != "null") {
    std::string machine_hash;
    for (const report::Input& input : job.inputs)
      if (input.role == "machine") machine_hash = input.sha256;
    auto made = log::CsvJointLog::create(log_path, machine,
                                         {.period = a.period,
                                          .every = a.log_every,
                                          .program = a.program.program,
                                          .program_sha256 = job.inputs.front().sha256,
                                          .machine_sha256 = machine_hash,
                                          .feed_factors = plan::feed_factors(overrides)});
    if (!made) return fail(made.error());
    log = std::move(*made);
    simulator.add_observer(*log);
  }
  report::LineTimes line_times(machine);
  if (!a.folder.empty())
    if (auto ready = line_times.write_to(a.folder + "/lines.jsonl"); !ready)
      return fail(ready.error());
  simulator.add_observer(line_times);
  report::Operations operations;
  simulator.add_observer(operations);
  std::unique_ptr<report::FrameMaker> pictures;
  if (!a.folder.empty() && frames->spec.any()) {
    if (const auto ok = report::check_view(*job.machine, frames->view); !ok)
      return fail(ok.error());
    pictures = std::make_unique<report::FrameMaker>(job.machine, job.tools, *frames);
    simulator.add_observer(*pictures);
  }

  std::unique_ptr<page::Replay> replay;
  if (!a.folder.empty()) {
    replay = std::make_unique<page::Replay>(job.machine, job.tools, **program);
    simulator.add_observer(*replay);
  }

  if (auto ready = accuracy.attach(simulator, a.folder); !ready) return fail(ready.error());

  listen_to_signals();
  Progress progress(a.output.quiet ? When::never : a.output.progress);
  sim::RunOptions options;
  options.stop_requested = [] { return stop_signal != 0; };
  options.progress = [&](double t, const SourceSpan& span) { progress.tell(t, span); };
  if (a.max_time) options.max_time = *a.max_time;
  Diagnostics doubts;
  const bool offset_rows = control.dialect != interp::Dialect::linuxcnc;
  semantics::ProgramCheck meaning({job.tools, job.machine.get(), true, offset_rows}, diagnostics,
                                  doubts);
  const auto parameters = interpreter.parameters();
  std::optional<linuxcnc::TravelCheck> axis_travel;
  if (has_axis_travel(job) && checks.limits)
    axis_travel.emplace(job.control->travel, control.start);
  options.listen = [&](const canon::Command& command) {
    if (checks.semantics) meaning.see(command);
    if (axis_travel) axis_travel->see(command, diagnostics);
  };
  sim::Simulator::Result result = sim::run(interpreter, diagnostics, planner, simulator, options);
  progress.clear();
  if (checks.semantics)
    meaning.finish({.reached = interpreter.statistics().ended,
                    .before = parameters.values,
                    .after = interpreter.parameters().values});
  result.summary.unchecked.insert(result.summary.unchecked.end(), meaning.unchecked().begin(),
                                  meaning.unchecked().end());

  report::RunReport report = report_of(a, job, checks, std::move(result));
  for (const Diagnostics* list : {&diagnostics, &doubts})
    for (const Diagnostic& d : list->list())
      if (d.kind == "spindle_stopped_cut" && report.summary.stock)
        continue;  // the cut check knows better: it has looked whether there is material
      else if (checks.semantics || !semantics::is_semantic(d.kind))
        report.diagnostics.push_back(d);
  accuracy.finish(report);
  if (interpreter.statistics().limit_reached || report.summary.limit_reached)
    report.unknown_cause = "limit";
  report.held_by = line_times.held();
  report.operations = operations.list();
  report.planner = planner.statistics();
  if (log)
    if (const auto chord = log->chord_error())
      report.chord_error = {chord->value, chord->t, chord->line};
  if (log)
    for (std::size_t j = 0; j < log->peaks().size(); ++j) {
      const auto at = [&](std::size_t order) {
        const log::JointPeak::At& peak = log->peaks()[j].of[order];
        return report::JointPeak::At{peak.value, peak.t, peak.line};
      };
      report.peaks.push_back(
          {report.joint_names[j], report.joint_rotary[j] ? "deg" : "mm", at(0), at(1), at(2)});
    }
  report::Acceptance acceptance(std::move(*rules));
  acceptance.apply(a.program.program, report.diagnostics, report.findings, report.summary.unchecked,
                   report);
  acceptance.finish(report);
  const auto saved = a.save_stock.empty() ? std::nullopt : simulator.saved_stock();
  if (!saved && !a.save_stock.empty())
    report.summary.unchecked.push_back(
        "the stock for the next job (--save-stock): it is not known what is left of it");
  Diagnostics judged;
  for (const Diagnostic& d : report.diagnostics) judged.add(d);
  report.summary.verdict = sim::judge(report.findings, report.summary, judged, a.output.fail_on);
  if (!report.accuracy) {
    const auto& wrong = accuracy.file_errors();
    report.diagnostics.insert(report.diagnostics.end(), wrong.begin(), wrong.end());
  }

  if (log) {
    if (auto written = log->result(); !written) return fail(written.error());
    if (hdf5)
      if (auto written = hdf5->finish(); !written) return fail(written.error());
    if (a.log.empty()) report.outputs.push_back("joints.csv");
  }
  if (auto written = line_times.result(); !written) return fail(written.error());
  if (!a.folder.empty()) report.outputs.push_back("lines.jsonl");
  if (auto written = write_part(a, simulator, saved, report); !written)
    return fail(written.error());
  if (!a.folder.empty())
    if (auto written = accuracy.write(a.folder, report); !written) return fail(written.error());
  if (!a.folder.empty() && accuracy.on())
    if (auto written = accuracy.write_part(
            a.folder, simulator.part(),
            wants_frames(a) ? std::optional(render::FrameSize{.width = a.width, .height = a.height})
                            : std::nullopt,
            report);
        !written)
      return fail(written.error());
  if (pictures && stop_signal == 0) {
    auto history = simulator.stock_history();
    if (!history) return fail(history.error());
    pictures->set_stock(std::move(*history));
    const auto written = pictures->write(a.folder, report.findings);
    if (!written) return fail(written.error());
    report.outputs.insert(report.outputs.end(), written->begin(), written->end());
  }
  if (replay && stop_signal == 0) {
    const auto history = simulator.stock_history(page::stock_steps);
    if (!history) return fail(history.error());
    const auto stock = page::stock_stages(*replay, history->get());
    if (!stock) return fail(stock.error());
    if (wants_motion(a, "glb")) {
      if (auto written = write_file(a.folder + "/motion.glb", page::glb_bytes(*replay, *stock));
          !written)
        return fail(written.error());
      report.outputs.push_back("motion.glb");
    }
    const std::string page = page::page_html({report, *replay, a.folder, *stock});
    if (auto written = write_file(a.folder + "/report.html", page); !written)
      return fail(written.error());
    report.outputs.push_back("report.html");
  }
  if (!a.folder.empty())
    if (auto written = write_file(a.folder + "/result.json", report::to_json(report)); !written)
      return fail(written.error());

  if (!print_report(report, a.output))
    return fail(make_error("output_failed", "can't write to standard output"));
  if (!a.folder.empty() && !a.output.quiet && a.output.format == Format::human)
    std::printf("  written  %s/: result.json%s\n", printable(a.folder).c_str(),
                [&] {
                  std::string list;
                  std::size_t images = 0;
                  for (const std::string& path : report.outputs)
                    if (path.starts_with("frames/"))
                      ++images;
                    else
                      list += ", " + path;
                  if (images > 0) list += ", frames/ (" + std::to_string(images) + ")";
                  return list;
                }()
                    .c_str());
  const sim::Summary& summary = report.summary;
  const bool at_end = !summary.program_refused && !summary.interrupted && !summary.limit_reached &&
                      !interpreter.statistics().limit_reached && !simulator.stopped();
  if (outcome) *outcome = {true, saved && at_end, summary.cycle_time};
  if (stop_signal != 0) return 128 + stop_signal;
  return code(exit_code_of(report.summary.verdict));
}

}  // namespace aircut::cli
