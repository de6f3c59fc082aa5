#include "cli/print_report.h"

#include <unistd.h>

#include <cstdio>
#include <filesystem>

#include "cli/job.h"

namespace aircut::cli {

namespace {

std::string text_of(const report::RunReport& report, const OutputArguments& output) {
  switch (output.format) {
    case Format::human:
      return report::to_human(report, {.style = {use_color(output.color, STDOUT_FILENO)},
                                       .most = output.max_findings,
                                       .quiet = output.quiet});
    case Format::json:
      return report::to_json(report);
    case Format::jsonl:
      return report::to_jsonl(report);
    case Format::gcc:
      return report::to_gcc(report);
    case Format::sarif:
      return report::to_sarif(report, {.kinds = all_kinds(), .folder = working_folder()});
    case Format::junit:
      return report::to_junit(report);
    case Format::github:
      return report::to_github(report);
  }
  return {};
}

}  // namespace

std::string working_folder() {
  std::error_code error;
  return std::filesystem::current_path(error).generic_string();
}

bool print_report(const report::RunReport& report, const OutputArguments& output) {
  return print_text(text_of(report, output));
}

bool print_text(const std::string& text) {
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  return std::fflush(stdout) == 0 && written;
}

}  // namespace aircut::cli
