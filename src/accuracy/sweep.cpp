#include "accuracy/sweep.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "accuracy/evaluate.h"
#include "accuracy/text.h"

namespace aircut::accuracy {
namespace {

std::vector<std::string> split(const std::string& text, char by) {
  std::vector<std::string> out(1);
  for (const char c : text)
    if (c == by)
      out.emplace_back();
    else
      out.back() += c;
  return out;
}

Diagnostic usage(const std::string& text) { return make_error("usage", text); }

// Adds a value of an axis to the changes; false when the axis can't take it.
bool set(WhatIf& what_if, const std::string& name, const std::string& value) {
  const std::size_t dot = name.rfind('.');
  const bool truth = value == "true";
  if (dot == name.npos) {
    if (name == "sign_policy") {
      what_if.sign_policy = value;
      return value == "check" || value == "as_given" || value == "row_flip" ||
             value == "column_flip" || value == "abs_diagonal";
    }
    if (name == "angular") what_if.angular = truth;
    if (name == "coupled") what_if.coupled = truth;
    return (name == "angular" || name == "coupled") && (truth || value == "false");
  }
  const std::string of = name.substr(0, dot), key = name.substr(dot + 1);
  if (key == "body") {
    const auto id = parse_number(of);
    if (!id || std::abs(*id) > 1e9) return false;
    what_if.tool_bodies[std::lround(*id)] = value;
    return true;
  }
  const auto number = parse_number(value);
  if (!number || (key != "t" && key != "S" && key != "V" && key != "dt" && key != "start"))
    return false;
  what_if.contacts[{of, key}] = *number;
  return true;
}

double mean_delta(const Result& result, std::size_t contact) {
  double sum = 0, time = 0;
  for (const SegmentResult& segment : result.segments)
    for (const ContactResult& c : segment.contacts) {
      if (c.contact != contact || !c.delta) continue;
      const double duration = segment.span ? segment.span->to - segment.span->from : 1;
      sum += *c.delta * duration;
      time += duration;
    }
  return time > 0 ? sum / time * 1e3 : std::numeric_limits<double>::quiet_NaN();
}

std::vector<double> results_of(const Setup& setup, const Result& result) {
  std::vector<double> out;
  for (std::size_t k = 0; k < setup.contacts.size(); ++k) out.push_back(mean_delta(result, k));
  for (const DimensionResult& d : result.dimensions)
    for (const double value : {d.mean, d.field.low, d.field.high})
      out.push_back(d.unchecked.empty() ? value * 1e3 : std::numeric_limits<double>::quiet_NaN());
  return out;
}

}  // namespace

Expected<SweepAxis> parse_sweep(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::string shown = "'" + printable(text) + "'";
  if (equals == text.npos || equals == 0 || equals + 1 == text.size())
    return unexpected(usage("a sweep is NAME=FROM:TO:STEP or NAME=VALUE,VALUE, this is " + shown));
  SweepAxis axis{text.substr(0, equals), {}};
  const std::string values = text.substr(equals + 1);
  if (const auto parts = split(values, ':'); parts.size() == 3) {
    const auto from = parse_number(parts[0]), to = parse_number(parts[1]),
               step = parse_number(parts[2]);
    if (!from || !to || !step || !(*step > 0) || !(*to >= *from) ||
        (*to - *from) / *step > static_cast<double>(most_sweep_rows))
      return unexpected(usage("a sweep FROM:TO:STEP goes up in steps above 0, at most " +
                              std::to_string(most_sweep_rows) + " of them; this is " + shown));
    const int steps = static_cast<int>(std::floor((*to - *from) / *step + 1e-9));
    for (int i = 0; i <= steps; ++i)
      axis.values.push_back(shortest(std::round((*from + i * *step) * 1e12) / 1e12));
  } else {
    axis.values = split(values, ',');
  }
  for (const std::string& value : axis.values) {
    WhatIf unused;
    if (!set(unused, axis.name, value))
      return unexpected(usage(
          "'" + printable(axis.name) + "' can't be '" + printable(value) +
          "'. What changes is CONTACT.t, .S, .V, .dt or .start (numbers), TOOL.body (a body), "
          "sign_policy, angular or coupled (true, false)"));
  }
  return axis;
}

std::optional<SweepTable> run_sweep(const SourceText& text, const std::vector<SweepAxis>& axes,
                                    Diagnostics& out) {
  std::size_t rows = 1;
  for (const SweepAxis& axis : axes) {
    rows *= axis.values.size();
    if (rows > most_sweep_rows) {
      out.add(usage("the sweep has more than " + std::to_string(most_sweep_rows) + " rows"));
      return std::nullopt;
    }
  }
  SweepTable table;
  for (const SweepAxis& axis : axes) table.names.push_back(axis.name);
  for (std::size_t row = 0; row < rows; ++row) {
    WhatIf what_if;
    std::size_t rest = row;
    std::vector<std::string> values(axes.size());
    for (std::size_t a = axes.size(); a-- > 0; rest /= axes[a].values.size()) {
      values[a] = axes[a].values[rest % axes[a].values.size()];
      set(what_if, axes[a].name, values[a]);
    }
    Diagnostics found, findings;
    const auto setup = read_setup(text, found, what_if);
    if (!setup) {
      for (const Diagnostic& d : found.list()) out.add(d);
      return std::nullopt;
    }
    table.settings.insert(table.settings.end(), values.begin(), values.end());
    table.results.push_back(results_of(*setup, evaluate(*setup, findings)));
    if (row > 0) continue;
    for (const ContactEntry& c : setup->contacts) table.names.push_back(c.name + ".delta_um");
    for (const Dimension& d : setup->dimensions)
      for (const char* end : {".error_um", ".low_um", ".high_um"})
        table.names.push_back(d.name + end);
  }
  return table;
}

std::string to_csv(const SweepTable& table) {
  std::string out;
  for (std::size_t i = 0; i < table.names.size(); ++i)
    out += (i > 0 ? "," : "") + csv_cell(table.names[i]);
  out += "\n";
  const std::size_t axes = table.results.empty() ? 0 : table.settings.size() / table.results.size();
  for (std::size_t row = 0; row < table.results.size(); ++row) {
    for (std::size_t a = 0; a < axes; ++a)
      out += (a > 0 ? "," : "") + csv_cell(table.settings[row * axes + a]);
    for (const double value : table.results[row])
      out += "," + (std::isnan(value) ? std::string() : significant(value, 6));
    out += "\n";
  }
  return out;
}

}  // namespace aircut::accuracy
