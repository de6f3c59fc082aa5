// The examples and the interpreter's programs: what is told about them is told with reason.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "interp/interp.h"
#include "semantics/semantics.h"

namespace aircut::semantics {
namespace {

namespace fs = std::filesystem;
const fs::path root = AIRCUT_SOURCE_DIR;

std::vector<fs::path> programs_in(const fs::path& folder) {
  std::vector<fs::path> out;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".ngc") out.push_back(entry.path());
  std::sort(out.begin(), out.end());
  return out;
}

// `; machine: mill3, as delivered` → mill3; `word` may also be `dialect: `.
std::string header_of(const fs::path& program, const std::string& word) {
  std::ifstream in(program);
  for (std::string line; std::getline(in, line);)
    if (const auto at = line.find(word); at != std::string::npos) {
      const std::string rest = line.substr(at + word.size());
      return rest.substr(0, rest.find_first_of("), "));
    }
  return {};
}

// All kinds that are told, with their lines.
std::multiset<std::string> told(const fs::path& program, const tool::ToolTable& tools,
                                const machine::Machine* machine, const interp::Options& options,
                                const interp::ParameterFile& parameters = {}) {
  SourceMap sources;
  Diagnostics refusals, out;
  const auto text = sources.open(program.string());
  const auto reader = [&](const std::string& path) { return sources.open(path); };
  interp::Interpreter interpreter(**text, tools, parameters, options, reader, refusals);
  const auto before = interpreter.parameters();
  const bool offset_rows = options.dialect != interp::Dialect::linuxcnc;
  ProgramCheck check({tools, machine, false, offset_rows}, refusals, out);
  std::optional<TravelCheck> travel;
  if (machine) travel.emplace(*machine, machine->home(), out);
  while (const auto command = interpreter.next()) {
    check.see(*command);
    if (travel) travel->see(*command);
    if (const auto* probe = std::get_if<canon::Probe>(&command->action))
      interpreter.resume({.tip = probe->end, .tripped = false});
  }
  check.finish({interpreter.statistics().ended, before.values, interpreter.parameters().values});
  std::multiset<std::string> kinds;
  for (const Diagnostics* list : {&refusals, &out})
    for (const Diagnostic& d : list->list())
      if (list == &out || d.severity == Severity::warning)
        kinds.insert(d.kind + " " + std::to_string(d.span.line));
  return kinds;
}

TEST(Programs, OfTheExamplesOnlyThoseAreToldAboutThatAreMeantTo) {
  const std::map<std::string, std::multiset<std::string>> expected = {
      {"overtravel.ngc", {"overtravel 13"}},
      {"ox-line-overtravel.ngc", {"overtravel 15"}},
      {"ox-unreachable.ngc", {"unreachable 18"}}};
  int seen = 0;
  for (const fs::path& program : programs_in(root / "programs")) {
    SourceMap sources;
    Diagnostics out;
    const std::string name = header_of(program, "machine: ");
    interp::Options options;
    if (header_of(program, "dialect: ") == "fanuc") options.dialect = interp::Dialect::fanuc;
    if (name == "none") {  // a lathe's, with a tool table of its own
      options.lathe = true;
      fs::path table = program;
      const auto own = tool::read_tools(table.replace_extension(".tbl").string(), 1, sources, out);
      ASSERT_TRUE(own) << table;
      EXPECT_EQ(told(program, *own, nullptr, options), std::multiset<std::string>()) << program;
      ++seen;
      continue;
    }
    const auto [package, channel] = machine::split_channel(name);
    const auto machine =
        machine::read_machine((root / "machines" / package).string(), sources, out, channel);
    ASSERT_TRUE(machine) << program << " " << name;
    const auto tools = tool::read_tools((*machine)->default_tools_, 1, sources, out);
    ASSERT_TRUE(tools);
    options.axes = (*machine)->kinematics().axes();
    options.start = *(*machine)->kinematics().forward((*machine)->home(), {});
    interp::ParameterFile parameters;  // with the machine's work offsets
    if (const auto file = sources.open((*machine)->default_parameters_))
      parameters = interp::read_var(**file, out);
    const auto found = expected.find(program.filename().string());
    EXPECT_EQ(told(program, *tools, machine->get(), options, parameters),
              found == expected.end() ? std::multiset<std::string>() : found->second)
        << program;
    ++seen;
  }
  EXPECT_GE(seen, 13);
}

// Looked at one by one: these programs try codes and cut nothing, so each of these is right. Tool 1
// is one long in their table, and they move at the feed without G43.
TEST(Programs, OfTheInterpretersTestsEachDoubtIsRight) {
  const std::set<std::string> expected = {
      "axes_uvw.ngc offset_left_on 9",  // G92 V0, not taken back
      "comp_arcs.ngc comp_rapid 12",    // G40, then G0
      "comp_arcs.ngc length_offset_missing 6",
      "comp_entry.ngc length_offset_missing 6",
      "comp_errors.ngc length_offset_missing 8",
      "comp_inside.ngc comp_rapid 12",  // G40 G0 X20 Y10
      "comp_inside.ngc length_offset_missing 6",
      "comp_lathe.ngc comp_rapid 11",
      "comp_lathe.ngc length_offset_missing 7",
      "comp_left.ngc comp_rapid 9",
      "comp_left.ngc offset_left_on 8",
      "comp_nose.ngc comp_rapid 13",
      "comp_outside.ngc comp_rapid 11",
      "comp_outside.ngc length_offset_missing 6",
      "comp_short_end.ngc comp_rapid 12",       // G40, then a rapid
      "coolant_overrides_io.ngc wait_code 21",  // M66 L3
      "cycles_all.ngc cycle_modal_change 14",   // G18 and G19 in a group of cycles
      "cycles_all.ngc cycle_modal_change 16",
      "offsets_g92.ngc offset_left_on 21",
      "warnings.ngc comp_rapid 16",
      "warnings.ngc comp_rapid 19",
      "warnings.ngc cycle_modal_change 22",
      "warnings.ngc length_offset_missing 11",
      "warnings.ngc tool_change_spindle_on 7",
      "warnings.ngc wrong_offset 15"};
  const fs::path folder = root / "tests/interp_programs/programs";
  SourceMap sources;
  Diagnostics out;
  const auto tools = tool::read_tools((folder / "tool.tbl").string(), 1, sources, out);
  ASSERT_TRUE(tools);
  std::set<std::string> found;
  for (const fs::path& program : programs_in(folder)) {
    interp::Options options;
    options.sub_path = {(folder / "subs").string()};
    options.limits.max_idle_blocks = 10'000;
    for (const std::string& what : told(program, *tools, nullptr, options)) {
      const std::string kind = what.substr(0, what.find(' '));
      // None of them cuts, so hardly any turns the spindle on; what has no model is not known.
      if (kind == "spindle_stopped_cut" || kind == "not_checked" || kind == "not_executed")
        continue;
      for (const KindText& row : semantic_kinds())
        if (kind == row.kind) found.insert(program.filename().string() + " " + what);
      if (kind.starts_with("comp_r") || kind.starts_with("cycle_m") || kind == "wrong_offset")
        found.insert(program.filename().string() + " " + what);
    }
  }
  EXPECT_EQ(found, expected);
}

}  // namespace
}  // namespace aircut::semantics
