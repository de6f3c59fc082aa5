// `aircut accuracy`: a set-up without a program, and what-ifs about it.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "accuracy/accuracy.h"
#include "cli/exit_code.h"
#include "cli/job.h"
#include "cli/print_report.h"
#include "logbook/logbook.h"
#include "report/accuracy_json.h"

namespace aircut::cli {
namespace {

int failed(const AccuracyArguments& a, const Diagnostic& diagnostic) {
  print_error(diagnostic, a.color);
  return code(ExitCode::unknown);
}

int wrote(const AccuracyArguments& a, const Expected<void>& done, ExitCode otherwise) {
  return done ? code(otherwise) : failed(a, done.error());
}

sim::Verdict verdict_of(const accuracy::Result& result, const Diagnostics& found) {
  if (found.errors() > 0) return sim::Verdict::fail;
  const bool open = std::any_of(result.dimensions.begin(), result.dimensions.end(),
                                [](const auto& d) { return !d.unchecked.empty(); });
  return open || result.segments.empty() ? sim::Verdict::unknown : sim::Verdict::pass;
}

std::string word(sim::Verdict verdict) {
  return verdict == sim::Verdict::pass   ? "pass"
         : verdict == sim::Verdict::fail ? "fail"
                                         : "unknown";
}

Expected<void> write_files(const std::string& folder,
                           const std::vector<std::pair<std::string, std::string>>& files) {
  for (const auto& [name, text] : files)
    if (auto done = write_file((std::filesystem::path(folder) / name).string(), text); !done)
      return done;
  return {};
}

int answer(const AccuracyArguments& a, const SourceText& text) {
  report::AccuracyReport report;
  const auto setup = accuracy::read_setup(text, report.diagnostics);
  if (!setup) {
    print_errors(report.diagnostics, a.color);
    return code(ExitCode::unknown);
  }
  const accuracy::Result result = accuracy::evaluate(*setup, report.diagnostics);
  const sim::Verdict verdict = verdict_of(result, report.diagnostics);
  report.version = AIRCUT_VERSION;
  report.verdict = word(verdict);
  report.file = text.name();
  report.sha256 = sha256(text);
  report.with_influence = a.influence;
  const std::string json = report::accuracy_json(report, *setup, result);
  print_errors(report.diagnostics, a.color);
  std::string page = accuracy::to_human(*setup, result);
  if (result.segments.empty()) page += "nothing cuts: the set-up has no [[contacts]]\n";
  if (!print_text(a.format == Format::json ? json : page + "\n" + report.verdict + "\n"))
    return failed(a, make_error("output_failed", "can't write to standard output"));
  if (!a.folder.empty())
    if (auto done = write_files(a.folder, {{"accuracy.csv", accuracy::to_csv(*setup, result)},
                                           {"accuracy.json", json}});
        !done)
      return failed(a, done.error());
  return code(exit_code_of(verdict));
}

// One curve per combination of the axes other than the first.
Expected<std::string> picture(const AccuracyArguments& a, const accuracy::SweepTable& table,
                              const std::vector<accuracy::SweepAxis>& axes) {
  const std::vector<std::string> columns(
      table.names.begin() + static_cast<std::ptrdiff_t>(axes.size()), table.names.end());
  const auto found =
      a.of.empty() ? columns.begin() : std::find(columns.begin(), columns.end(), a.of);
  if (found == columns.end())
    return unexpected(make_error("usage", "--of: the sweep has no column '" + printable(a.of) +
                                              "'." + did_you_mean(a.of, columns)));
  const auto column = static_cast<std::size_t>(found - columns.begin());
  logbook::Diagram diagram;
  diagram.title = std::filesystem::path(a.setup).filename().string();
  diagram.x_name = axes[0].name;
  diagram.y_name = *found;
  std::vector<std::string> names;
  for (std::size_t row = 0; row < table.results.size(); ++row) {
    const std::string* values = &table.settings[row * axes.size()];
    const auto x = parse_number(values[0]);
    if (!x)
      return unexpected(make_error("usage", "--plot needs numbers in the first --sweep, '" +
                                                printable(values[0]) + "' is none"));
    std::string name;
    for (std::size_t i = 1; i < axes.size(); ++i)
      name += (i > 1 ? ", " : "") + axes[i].name + " " + values[i];
    auto at = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
    if (at == names.size()) {
      names.push_back(name);
      diagram.curves.push_back({name, {}});
    }
    if (const double y = table.results[row][column]; !std::isnan(y))
      diagram.curves[at].points.emplace_back(*x, y);
  }
  for (logbook::Curve& curve : diagram.curves)
    std::stable_sort(curve.points.begin(), curve.points.end(),
                     [](const auto& p, const auto& q) { return p.first < q.first; });
  return logbook::draw(diagram);
}

int sweep(const AccuracyArguments& a, const SourceText& text) {
  std::vector<accuracy::SweepAxis> axes;
  for (const std::string& one : a.sweep) {
    const auto axis = accuracy::parse_sweep(one);
    if (!axis) return failed(a, axis.error());
    axes.push_back(*axis);
  }
  if (a.format == Format::json)
    return failed(a, make_error("usage", "a sweep is a table: leave --format json away"));
  Diagnostics found;
  const auto table = accuracy::run_sweep(text, axes, found);
  print_errors(found, a.color);
  if (!table) return code(ExitCode::unknown);
  const std::string csv = accuracy::to_csv(*table);
  if (!print_text(csv))
    return failed(a, make_error("output_failed", "can't write to standard output"));
  if (!a.plot.empty()) {
    const auto png = picture(a, *table, axes);
    if (!png) return failed(a, png.error());
    if (auto done = write_file(a.plot, *png); !done) return failed(a, done.error());
  }
  if (a.folder.empty()) return code(ExitCode::pass);
  return wrote(a, write_files(a.folder, {{"sweep.csv", csv}}), ExitCode::pass);
}

}  // namespace

int accuracy_command(const AccuracyArguments& a) {
  SourceMap sources;
  const auto text = open_program(sources, a.setup);
  if (!text) return failed(a, text.error());
  std::error_code error;
  if (!a.plot.empty() && !a.force && std::filesystem::exists(a.plot, error))
    return failed(
        a, make_error("output_failed", "'" + printable(a.plot) + "' exists; --force replaces it"));
  if (!a.folder.empty())
    if (auto made = make_folder(a.folder, a.force); !made) return failed(a, made.error());
  return a.sweep.empty() ? answer(a, **text) : sweep(a, **text);
}

}  // namespace aircut::cli
