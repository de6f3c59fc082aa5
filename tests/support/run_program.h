// Runs a program's text on a machine, all in memory, and gives back what a user would get.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "sim/sim.h"

namespace aircut::testing {

struct RunResult {
  std::vector<sim::Finding> findings;
  sim::Summary summary;
  Diagnostics diagnostics;
  sim::Verdict verdict = sim::Verdict::unknown;

  int count(sim::Kind kind) const {
    int n = 0;
    for (const sim::Finding& f : findings) n += f.kind == kind ? 1 : 0;
    return n;
  }
  /// The only finding of a kind.
  const sim::Finding& only(sim::Kind kind) const {
    const sim::Finding* found = nullptr;
    for (const sim::Finding& f : findings)
      if (f.kind == kind) {
        if (found) ADD_FAILURE() << "more than one " << sim::to_string(kind);
        found = &f;
      }
    if (!found) {
      ADD_FAILURE() << "no " << sim::to_string(kind);
      static const sim::Finding none;
      return none;
    }
    return *found;
  }
};

inline RunResult run_program(const std::string& text,
                             std::shared_ptr<const machine::Machine> machine,
                             const tool::ToolTable& tools, SourceMap& sources,
                             const sim::CheckOptions& checks = {}, double max_time = 360'000,
                             sim::Observer* observer = nullptr, const SourceText* given = nullptr,
                             interp::Dialect dialect = interp::Dialect::linuxcnc) {
  RunResult out;
  const SourceText& program = given ? *given : sources.add("test.ngc", text);
  interp::Options options;
  options.axes = machine->kinematics().axes();
  const machine::JointVector start = machine->home();
  if (const auto tip = machine->kinematics().forward(start, {})) options.start = *tip;
  options.dialect = dialect;
  options.kinematics = sim::kinematics_switch(*machine);
  sim::use_tool_change(*machine, options);
  interp::Interpreter interpreter(
      program, tools, {}, options, [&](const std::string& path) { return sources.open(path); },
      out.diagnostics);
  plan::Planner planner(*machine, start, {});
  sim::Simulator simulator(machine, tools, start, checks);
  if (observer) simulator.add_observer(*observer);
  sim::RunOptions run_options;
  run_options.max_time = max_time;
  auto result = sim::run(interpreter, out.diagnostics, planner, simulator, run_options);
  out.findings = std::move(result.findings);
  out.summary = result.summary;
  out.verdict = sim::judge(out.findings, out.summary, out.diagnostics, Severity::error);
  return out;
}

}  // namespace aircut::testing
