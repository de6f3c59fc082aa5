// Runs a text through the interpreter and keeps what comes out.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "interp/interp.h"

namespace aircut::test {

struct Ran {
  std::vector<canon::Command> commands;  ///< without the start state
  std::vector<canon::Command> start;
  Diagnostics diagnostics;
  interp::Interpreter::Statistics statistics;
  interp::ParameterFile parameters;
  std::vector<std::string> texts;  ///< of `commands`

  std::vector<std::string> kinds(Severity severity = Severity::error) const {
    std::vector<std::string> found;
    for (const Diagnostic& d : diagnostics.list())
      if (d.severity == severity) found.push_back(d.kind);
    return found;
  }
  std::string last_text() const { return texts.empty() ? "" : texts.back(); }
};

struct Setting {
  interp::Options options;
  tool::ToolTable tools;
  interp::ParameterFile parameters;
  std::map<std::string, std::string> files;  ///< path → text, for called subs
};

/// Keeps the texts alive: spans of `Ran` point into them.
inline Ran run_program(SourceMap& sources, const std::string& program,
                       const Setting& setting = {}) {
  Ran ran;
  const SourceText& text = sources.add("folder/main.ngc", program);
  const SourceReader reader = [&](const std::string& path) -> Expected<const SourceText*> {
    const auto found = setting.files.find(path);
    if (found == setting.files.end()) return unexpected(make_error("input", "no such file"));
    return &sources.add(path, found->second);
  };
  interp::Interpreter interpreter(text, setting.tools, setting.parameters, setting.options, reader,
                                  ran.diagnostics);
  while (auto command = interpreter.next()) {
    if (command->block == 0) {
      ran.start.push_back(std::move(*command));
      continue;
    }
    ran.texts.push_back(canon::to_text(command->action));
    ran.commands.push_back(std::move(*command));
  }
  ran.statistics = interpreter.statistics();
  ran.parameters = interpreter.parameters();
  return ran;
}

/// The tip at the end of the program.
inline AxisValues end_tip(const Ran& ran, AxisValues tip = {}) {
  for (const canon::Command& command : ran.commands) tip = canon::end_of(command.action, tip);
  return tip;
}

}  // namespace aircut::test
