// A job of several operations: each is a run of its own, and the stock that one leaves is what the
// next one's set-up begins with. One verdict over all.
#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "cli/exit_code.h"
#include "cli/job.h"
#include "cli/job_arguments.h"
#include "config/config.h"
#include "report/job_json.h"

namespace aircut::cli {

namespace fs = std::filesystem;

namespace {

struct Operation {
  std::string name;
  RunArguments run;
};

// A path of the job's file, which is relative to the folder of that file.
std::string beside(const std::string& folder, const std::string& path) {
  return path.empty() || fs::path(path).is_absolute() ? path
                                                      : (fs::path(folder) / path).generic_string();
}

// A shipped package has a bare name; everything else is a path.
std::string machine_path(const std::string& folder, const std::string& machine) {
  const bool named = machine.find('/') == std::string::npos && !machine.ends_with(".ini") &&
                     !machine.ends_with(".urdf") && !machine.ends_with(".toml");
  return named ? machine : beside(folder, machine);
}

std::string folder_name(std::size_t number, const std::string& name) {
  std::string out = std::to_string(number) + "-";
  for (const char c : name)
    out += (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ? c : '-';
  return out;
}

Operation read_operation(config::Table& table, const JobArguments& a, const std::string& folder,
                         std::size_t number) {
  Operation out;
  RunArguments& run = out.run;
  out.name = table.required_text("name");
  run.program.program = beside(folder, table.required_text("program"));
  run.program.machine = machine_path(folder, table.required_text("machine"));
  run.program.setup = beside(folder, table.text("setup", ""));
  run.program.tools = beside(folder, table.text("tools", ""));
  run.program.dialect = table.text("dialect", "");
  run.save_stock = beside(folder, table.text("save_stock", ""));
  if (!run.save_stock.empty() && run.program.setup.empty())
    table.error("save_stock", "'save_stock' needs a set-up with a [stock]: add 'setup'");
  run.output = a.output;
  run.force = a.force;
  run.frames = a.frames;
  if (!a.folder.empty()) run.folder = a.folder + "/" + folder_name(number, out.name);
  return out;
}

tl::expected<std::vector<Operation>, Diagnostics> read_job(const JobArguments& a,
                                                           SourceMap& sources) {
  Diagnostics problems;
  const auto text = sources.open(a.file);
  if (!text) {
    problems.add(text.error());
    return tl::unexpected(std::move(problems));
  }
  const std::string parent = fs::path(a.file).parent_path().generic_string();
  config::Reader reader(**text, "job_invalid");
  config::Table top = reader.top();
  if (top.integer("schema").value_or(0) != 1)
    top.error("schema", "'schema = 1' is missing: the version of this file's keys");
  std::vector<Operation> out;
  for (config::Table& table : top.tables("operation")) {
    out.push_back(read_operation(table, a, parent.empty() ? "." : parent, out.size() + 1));
    const auto same = [&](const Operation& other) { return other.name == out.back().name; };
    if (std::count_if(out.begin(), out.end(), same) > 1)
      table.error("name", "there are two operations named '" + printable(out.back().name) + "'");
  }
  if (out.empty()) top.error("operation", "a job has at least one [[operation]]");
  problems = reader.finish();
  if (problems.errors() > 0) return tl::unexpected(std::move(problems));
  return out;
}

}  // namespace

int job_command(const JobArguments& a) {
  SourceMap sources;
  const auto operations = read_job(a, sources);
  if (!operations) return refuse(operations.error(), a.output);
  if (!a.folder.empty())
    if (auto made = make_folder(a.folder, a.force); !made) return refuse(made.error(), a.output);

  std::vector<report::JobOperation> done;
  bool lost = false;  // the stock that a later operation begins with
  for (const Operation& operation : *operations) {
    report::JobOperation row;
    row.name = operation.name;
    row.program = operation.run.program.program;
    row.folder = fs::path(operation.run.folder).filename().generic_string();
    if (!a.output.quiet)
      std::printf("%soperation %zu of %zu, %s: %s\n\n", done.empty() ? "" : "\n", done.size() + 1,
                  operations->size(), printable(row.name).c_str(), printable(row.program).c_str());
    std::fflush(stdout);
    if (lost) {
      row.reason =
          "not run: an operation before it did not reach its end, or its stock is not known";
      if (!a.output.quiet) std::printf("%s\n", row.reason.c_str());
    } else {
      RunOutcome outcome;
      const int exit = run_command(operation.run, &outcome);
      if (exit != code(ExitCode::pass) && exit != code(ExitCode::fail) &&
          exit != code(ExitCode::unknown))
        return exit;
      row.verdict = exit == code(ExitCode::pass)   ? sim::Verdict::pass
                    : exit == code(ExitCode::fail) ? sim::Verdict::fail
                                                   : sim::Verdict::unknown;
      row.run = outcome.finished;
      row.cycle_time = outcome.cycle_time;
      if (!outcome.finished) row.reason = "not run: its inputs can't be read";
      lost = !operation.run.save_stock.empty() && !outcome.stock_saved;
    }
    done.push_back(std::move(row));
  }
  const sim::Verdict verdict = report::verdict_of(done);
  if (!a.folder.empty())
    if (auto written = write_file(a.folder + "/result.json", report::to_json(done)); !written)
      return refuse(written.error(), a.output);
  std::printf("\njob: %s\n", std::string(sim::to_string(verdict)).c_str());
  for (const report::JobOperation& row : done)
    std::printf("  %-8s %s%s%s\n", std::string(sim::to_string(row.verdict)).c_str(),
                printable(row.name).c_str(), row.reason.empty() ? "" : ": ",
                printable(row.reason).c_str());
  return code(exit_code_of(verdict));
}

}  // namespace aircut::cli
