#include "interp_programs/program_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace aircut::test {
namespace {

std::string trimmed(std::string text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.back())) text.pop_back();
  while (!text.empty() && blank(text.front())) text.erase(0, 1);
  return text;
}

std::vector<std::string> split(const std::string& text, const std::string& separator) {
  std::vector<std::string> parts;
  std::size_t from = 0;
  for (std::size_t at; (at = text.find(separator, from)) != std::string::npos;
       from = at + separator.size())
    parts.push_back(trimmed(text.substr(from, at - from)));
  parts.push_back(trimmed(text.substr(from)));
  return parts;
}

/// The text behind `; word:` in a line, or inside `( word: )`, if it is there.
std::optional<std::string> remark(const std::string& line, const std::string& word) {
  const std::string mark = "; " + word + ":";
  if (const std::size_t at = line.find(mark); at != std::string::npos)
    return trimmed(line.substr(at + mark.size()));
  const std::string inside = "( " + word + ":";
  const std::size_t at = line.find(inside);
  if (at == std::string::npos) return std::nullopt;
  const std::size_t begin = at + inside.size();
  return trimmed(line.substr(begin, line.find(')', begin) - begin));
}

/// Takes `; error: …` and `; warning: …` off the end of an expectation on the same line.
std::string without_remarks(std::string text) {
  for (const char* mark : {"; error:", "; warning:", "; peer-accepts:"})
    if (const auto at = text.find(mark); at != std::string::npos) text.erase(at);
  return trimmed(text);
}

void read_setting(ProgramFile& program, const std::string& setting) {
  std::istringstream in(setting);
  std::string key, rest;
  in >> key;
  std::getline(in, rest);
  rest = trimmed(rest);
  const auto unit = [&] { return rest == "mm" ? canon::Unit::millimetre : canon::Unit::inch; };
  if (key == "axes") {
    program.options.axes = {};
    for (const char c : rest)
      if (const auto axis = axis_of_letter(c)) program.options.axes.add(*axis);
  } else if (key == "machine-unit") {
    program.options.machine_unit = unit();
  } else if (key == "start-unit") {
    program.options.start_unit = unit();
  } else if (key == "dialect") {
    program.options.dialect = rest == "haas" ? interp::Dialect::haas : interp::Dialect::fanuc;
    if (rest == "auto") interp::choose_dialect(program.options, program.text);
    program.options.machine_unit = canon::Unit::millimetre;
  } else if (key == "lathe") {
    program.options.lathe = true;
  } else if (key == "whole-units") {
    program.options.whole_units = true;
  } else if (key == "block-delete") {
    program.options.block_delete = true;
  } else if (key == "tool") {
    program.tools += rest + "\n";
  } else if (key == "no-tools") {
    program.tools = "\n";
  } else if (key == "parameter") {
    std::istringstream numbers(rest);
    int number = 0;
    double value = 0;
    numbers >> number >> value;
    program.parameters.values[number] = value;
  } else if (key == "ini") {
    const auto parts = split(rest, " ");
    program.options.ini[parts.front()] = parse_number(parts.back()).value_or(0);
  } else if (key == "set") {
    const auto parts = split(rest, "=");
    program.options.set.emplace_back(parts.front(), parse_number(parts.back()).value_or(0));
  } else if (key == "wrapped" || key == "indexers") {
    AxisSet& axes = key == "wrapped" ? program.options.wrapped : program.options.indexers;
    for (const char c : rest)
      if (const auto axis = axis_of_letter(c)) axes.add(*axis);
  } else if (key == "no-fanuc-subs") {
    program.options.fanuc_subs = false;
  } else if (key == "retain-length-offset") {
    program.options.retain_length_offset = true;
  } else if (key == "remap-m") {
    interp::Remap remap;
    std::istringstream words(rest);
    words >> remap.code >> remap.argspec >> remap.ngc;
    remap.modal_group = 10;
    remap.name = "M" + std::to_string(remap.code);
    program.options.remaps.push_back(remap);
  } else if (key == "tcp") {
    program.options.kinematics.start = program.options.kinematics.tcp_off.emplace(0);
    program.options.kinematics.tcp_on = 1;
  } else if (key == "max-idle-blocks") {
    program.options.limits.max_idle_blocks = std::stoull(rest);
  } else if (key == "no-peer") {
    program.no_peer = rest;
  } else {
    program.bad_syntax = "unknown setting '" + key + "'";
  }
}

void read_remarks(ProgramFile& program, const std::string& line, std::uint64_t number,
                  std::uint64_t& last_expecting) {
  if (const auto expected = remark(line, "expect")) {
    last_expecting = number;
    const std::string list = without_remarks(*expected);
    auto& commands = program.lines[number].commands;
    commands = list == "nothing" ? std::vector<std::string>() : split(list, " | ");
  }
  if (const auto more = remark(line, "then")) {
    if (last_expecting == 0) program.bad_syntax = "'; then:' without '; expect:' before it";
    for (const std::string& text : split(*more, " | "))
      program.lines[last_expecting].commands->push_back(text);
  }
  if (const auto errors = remark(line, "error"))
    program.lines[number].errors = split(without_remarks(*errors), ",");
  if (const auto why = remark(line, "peer-accepts")) program.lines[number].peer_accepts = *why;
  if (const auto errors = remark(line, "file-error")) program.lines[0].errors = split(*errors, ",");
  if (const auto warnings = remark(line, "warning"))
    program.lines[number].warnings = split(without_remarks(*warnings), ",");
}

std::string content_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

}  // namespace

bool ProgramFile::expects_errors() const {
  return std::any_of(lines.begin(), lines.end(),
                     [](const auto& line) { return !line.second.errors.empty(); });
}

interp::Options reference_options() {
  interp::Options options;
  options.machine_unit = canon::Unit::inch;
  options.start_unit = canon::Unit::millimetre;
  for (const Axis axis : {Axis::x, Axis::y, Axis::z, Axis::a, Axis::b, Axis::c})
    options.axes.add(axis);
  return options;
}

ProgramFile read_program_file(const std::string& name, const std::string& text,
                              const std::string& common_tools) {
  ProgramFile program;
  program.name = name;
  program.text = text;
  program.options = reference_options();
  std::uint64_t number = 0, last_expecting = 0;
  for (const std::string& line : split(text, "\n")) {
    ++number;
    if (const auto at = line.find(";! "); at != std::string::npos)
      read_setting(program, line.substr(at + 3));
    if (const auto at = line.find("(! "); at != std::string::npos)
      read_setting(program, trimmed(line.substr(at + 3, line.find(')', at) - at - 3)));
    read_remarks(program, line, number, last_expecting);
  }
  if (program.tools.empty()) program.tools = common_tools;
  return program;
}

std::vector<ProgramFile> read_program_folder(const std::string& folder) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".ngc") paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  const std::string tools = content_of(std::filesystem::path(folder) / "tool.tbl");
  std::vector<ProgramFile> programs;
  for (const auto& path : paths)
    programs.push_back(read_program_file(path.stem().string(), content_of(path), tools));
  return programs;
}

Outcome run_program(const ProgramFile& program, bool keep_going, const std::string& sub_folder,
                    const ProbeModel& model) {
  Outcome outcome;
  SourceMap sources;
  const SourceText& text = sources.add(program.name + ".ngc", program.text);
  Diagnostics diagnostics;
  const double unit_mm = program.options.machine_unit == canon::Unit::inch ? 25.4 : 1;
  const auto tools = tool::read_tbl(sources.add("tool.tbl", program.tools), unit_mm, diagnostics);
  interp::Options options = program.options;
  options.keep_going = keep_going;
  options.sub_path.push_back(sub_folder);
  const SourceReader reader = [&](const std::string& path) { return sources.open(path); };
  interp::Interpreter interpreter(text, tools ? *tools : tool::ToolTable(), program.parameters,
                                  options, reader, diagnostics);
  canon::Rs274Writer writer(options.start_unit);
  while (auto command = interpreter.next()) {
    outcome.rs274 += writer.write(*command);
    auto hit = model ? model(*command) : std::nullopt;
    if (const auto* probe = std::get_if<canon::Probe>(&command->action))
      interpreter.resume(hit ? *hit : interp::ProbeHit{probe->end, false});
    outcome.commands.push_back(std::move(*command));
  }
  outcome.rs274 += writer.finish();
  outcome.stopped_by_limit = interpreter.statistics().limit_reached;
  for (const auto& [code, count] : interpreter.code_counts()) outcome.codes[code] += count;
  for (const Diagnostic& d : diagnostics.list())
    outcome.found.push_back(
        {d.span.text == &text ? d.span.line : 0, d.kind, format_gcc(d), d.severity});
  // The texts end with this function; no command may point into them.
  for (canon::Command& command : outcome.commands) {
    if (command.span.text != &text) command.span.line = 0;
    command.span.text = nullptr;
    command.span.calls = nullptr;
  }
  return outcome;
}

bool same_text(const std::string& a, const std::string& b) {
  const auto number_at = [](const std::string& word) {
    return std::min(word.find_first_of("+-.0123456789"), word.size());
  };
  const auto words = [](const std::string& text) {
    std::vector<std::string> parts = split(text, " ");
    std::erase(parts, "");
    return parts;
  };
  const auto wa = words(a), wb = words(b);
  if (wa.size() != wb.size()) return false;
  for (std::size_t i = 0; i < wa.size(); ++i) {
    if (wa[i] == wb[i]) continue;
    const std::size_t at = number_at(wa[i]);
    if (number_at(wb[i]) != at || wa[i].substr(0, at) != wb[i].substr(0, at)) return false;
    const auto na = parse_number(wa[i].substr(at)), nb = parse_number(wb[i].substr(at));
    if (!na || !nb) return false;
    if (std::abs(*na - *nb) > std::max(1e-4, 1e-6 * std::abs(*na))) return false;
  }
  return true;
}

}  // namespace aircut::test
