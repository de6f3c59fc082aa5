// `aircut log`: joint logs read back. Nothing here knows how a log was planned.
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>

#include "cli/exit_code.h"
#include "cli/ideal_path.h"

namespace aircut::cli {
namespace {

When color_of(const LogArguments& a) {
  return a.color_word == "always"  ? When::always
         : a.color_word == "never" ? When::never
                                   : When::automatic;
}

int failed(const LogArguments& a, const Diagnostic& diagnostic) {
  print_error(diagnostic, color_of(a));
  return code(ExitCode::unknown);
}

void print_header(const logbook::Header& header) {
  for (const char* key : {"program", "machine", "kinematics", "joints", "planner", "servo_period_s",
                          "every", "samples"}) {
    const auto found = header.keys.find(key);
    if (found != header.keys.end())
      std::printf("%-16s %s\n", key, printable(found->second).c_str());
  }
  std::printf("%-16s %s s\n", "cycle time", fixed(header.end_time, 3).c_str());
}

void print_peaks(const logbook::Check& check) {
  if (check.peaks.empty()) return;
  std::printf("\n%-13s %-8s %14s %9s %10s %8s\n", "limit", "joint", "value", "used", "at t (s)",
              "line");
  for (const logbook::Peak& peak : check.peaks) {
    if (std::isinf(peak.limit)) continue;
    std::printf("%-13s %-8s %14s %8.2f%% %10.3f %8llu%s\n", peak.what.c_str(),
                peak.joint.empty() ? "-" : printable(peak.joint).c_str(),
                peak.limit > 0 ? shortest(peak.limit).c_str() : "programmed", 100 * peak.share,
                peak.t, static_cast<unsigned long long>(peak.line),
                peak.rows_over > 0 ? "  PASSED" : "");
  }
}

// The programmed path of the log, when a program was named.
struct Asked {
  Job job;
  Diagnostics diagnostics;
  std::unique_ptr<interp::Interpreter> interpreter;
  std::unique_ptr<IdealPath> path;
};

bool open_path(const LogArguments& a, Asked& out) {
  const auto program = open_program(out.job.sources, a.program.program);
  if (!program) {
    print_error(program.error(), color_of(a));
    return false;
  }
  if (!open_inputs(out.job, a.program)) {
    print_errors(out.job.diagnostics, color_of(a));
    return false;
  }
  interp::Options options = interpreter_options(out.job, a.program, **program);
  const AxisValues start = options.start;
  out.interpreter =
      std::make_unique<interp::Interpreter>(**program, out.job.tools, out.job.parameters, options,
                                            sub_reader(out.job.sources), out.diagnostics);
  out.path = std::make_unique<IdealPath>(
      *out.interpreter, start,
      plan::has_straight_rapids(*out.job.machine, out.job.machine->kinematics()));
  return true;
}

int check_log(const LogArguments& a, const SourceText& text) {
  const bool asks_path = !a.program.program.empty();
  if (asks_path && a.program.machine.empty())
    return failed(a, make_error("usage", "--program needs the machine that it ran on: -m MACHINE"));
  Asked asked;
  if (asks_path && !open_path(a, asked)) return code(ExitCode::unknown);
  auto check = logbook::check(text, asks_path ? logbook::IdealPath([&](logbook::IdealPiece& p) {
                                return asked.path->next(p);
                              })
                                              : logbook::IdealPath());
  if (!check) return failed(a, check.error());
  if (asks_path) {
    print_errors(asked.diagnostics, color_of(a));
    if (asked.diagnostics.errors() > 0)
      check->unchecked.push_back("the path behind the program's first error");
    for (const std::string& what : asked.path->unchecked()) check->unchecked.push_back(what);
    if (asked.interpreter->statistics().limit_reached)
      check->unchecked.push_back("the path behind a limit on the program's length");
  }
  print_header(check->header);
  print_peaks(*check);
  if (check->has_path)
    std::printf("\npath           %s mm off at most, at t = %s s, line %llu\n",
                shortest(std::round(check->deviation * 1e9) / 1e9).c_str(),
                fixed(check->deviation_t, 3).c_str(),
                static_cast<unsigned long long>(check->deviation_line));
  else
    std::printf("\npath           not asked for; name the program with --program and -m\n");
  bool bad = !check->problems.empty();
  for (const logbook::Peak& peak : check->peaks) {
    if (peak.rows_over == 0) continue;
    bad = true;
    std::printf(
        "problem: the %s%s%s is passed in %llu rows, at worst by %s %% at t = %s s, line %llu\n",
        peak.what.c_str(), peak.joint.empty() ? "" : " limit of joint ",
        printable(peak.joint).c_str(), static_cast<unsigned long long>(peak.rows_over),
        fixed(100 * (peak.share - 1), 2).c_str(), fixed(peak.t, 3).c_str(),
        static_cast<unsigned long long>(peak.line));
  }
  for (const std::string& problem : check->problems)
    std::printf("problem: %s\n", printable(problem).c_str());
  if (check->more_problems > 0) std::printf("problem: and %zu more\n", check->more_problems);
  for (const std::string& what : check->unchecked)
    std::printf("not checked: %s\n", printable(what).c_str());
  const bool unknown = !check->unchecked.empty();
  std::printf("%s\n", bad ? "fail" : unknown ? "unknown" : "pass");
  return code(bad ? ExitCode::fail : unknown ? ExitCode::unknown : ExitCode::pass);
}

int info(const LogArguments& a, const SourceText& text) {
  const auto check = logbook::check(text, {});
  if (!check) return failed(a, check.error());
  print_header(check->header);
  print_peaks(*check);
  return code(ExitCode::pass);
}

int diff(const LogArguments& a, const SourceText& one, const SourceText& two) {
  const auto result = logbook::compare(one, two, a.tolerance);
  if (!result) return failed(a, result.error());
  std::printf("cycle time      %s s | %s s\n", fixed(result->end_a, 3).c_str(),
              fixed(result->end_b, 3).c_str());
  std::printf("rows            %llu | %llu\n", static_cast<unsigned long long>(result->rows_a),
              static_cast<unsigned long long>(result->rows_b));
  for (const std::string& line : result->headers)
    std::printf("header          %s\n", printable(line).c_str());
  if (!result->first) {
    std::printf("the motion is the same\n");
    return code(ExitCode::pass);
  }
  std::printf("the motion differs from t = %s s on\n\n%-16s %14s %10s %8s %8s\n",
              fixed(*result->first, 3).c_str(), "at equal times", "most", "at t (s)", "line A",
              "line B");
  for (const auto& d : result->differences) {
    if (!(d.most > 0)) continue;
    std::printf("%-16s %14s %10.3f %8llu %8llu\n", printable(d.what).c_str(),
                (d.unit.empty() ? "differs" : fixed(d.most, 6) + " " + d.unit).c_str(), d.t,
                static_cast<unsigned long long>(d.line_a),
                static_cast<unsigned long long>(d.line_b));
  }
  return code(ExitCode::fail);
}

int refuse_existing(const LogArguments& a) {
  std::error_code error;
  if (!a.force && std::filesystem::exists(std::filesystem::symlink_status(a.output, error)))
    return failed(a, make_error("output_failed",
                                "'" + printable(a.output) + "' exists; --force replaces it"));
  return 0;
}

int table(const LogArguments& a, const SourceText& text) {
  logbook::ExportOptions options;
  const std::string ending = std::filesystem::path(a.output).extension().string();
  if (ending == ".csv")
    options.table = logbook::Table::csv;
  else if (ending == ".json")
    options.table = logbook::Table::json;
  else if (ending == ".npy")
    options.table = logbook::Table::npy;
  else if (ending != ".h5")
    return failed(a, make_error("usage", "the ending of '" + printable(a.output) +
                                             "' says no form; take .csv, .json, .npy or .h5"));
  const bool whole = ending == ".h5" || a.header;
  if (whole && (!a.columns.empty() || a.every != 1 || a.from > 0 || a.to < 1e300))
    return failed(a, make_error("usage",
                                "a joint log has all columns and rows: leave --columns, --every, "
                                "--from and --to away, or write a plain table"));
  if (a.header && ending != ".csv" && ending != ".h5")
    return failed(a, make_error("usage", "--header is for .csv"));
  options.columns = a.columns;
  options.every = a.every;
  options.from = a.from;
  options.to = a.to;
  if (const int refused = refuse_existing(a)) return refused;
  if (ending == ".h5") {
    const auto done = logbook::write_hdf5(text, a.output);
    return done ? code(ExitCode::pass) : failed(a, done.error());
  }
  auto file = OutputFile::create(a.output);
  if (!file) return failed(a, file.error());
  if (a.header) {
    file->write(text.content());
    const auto done = file->commit();
    return done ? code(ExitCode::pass) : failed(a, done.error());
  }
  auto done = logbook::export_table(text, options, [&](std::string_view s) { file->write(s); });
  if (done) done = file->commit();
  return done ? code(ExitCode::pass) : failed(a, done.error());
}

int plot(const LogArguments& a, const SourceText& text) {
  if (const int refused = refuse_existing(a)) return refused;
  const auto png = logbook::plot(text, {.width = a.width, .from = a.from, .to = a.to});
  if (!png) return failed(a, png.error());
  const auto done = write_file(a.output, *png);
  return done ? code(ExitCode::pass) : failed(a, done.error());
}

}  // namespace

int log_command(const LogArguments& a) {
  SourceMap sources;
  const auto text = logbook::open_log(sources, a.file);
  if (!text) return failed(a, text.error());
  switch (a.action) {
    case LogArguments::Action::check:
      return check_log(a, **text);
    case LogArguments::Action::info:
      return info(a, **text);
    case LogArguments::Action::table:
      return table(a, **text);
    case LogArguments::Action::plot:
      return plot(a, **text);
    case LogArguments::Action::diff:
      break;
  }
  const auto other = logbook::open_log(sources, a.other);
  return other ? diff(a, **text, **other) : failed(a, other.error());
}

}  // namespace aircut::cli
