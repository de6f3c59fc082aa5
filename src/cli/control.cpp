// The set-up file of a LinuxCNC machine as part of a job.
#include "cli/job.h"

namespace aircut::cli {

std::string ini_of(const ProgramArguments& arguments) {
  return arguments.ini.empty() && arguments.machine.ends_with(".ini") ? arguments.machine
                                                                      : arguments.ini;
}

bool open_ini(Job& job, const ProgramArguments& arguments) {
  const std::string path = ini_of(arguments);
  if (path.empty()) return true;
  auto setup = linuxcnc::read_setup(
      path, {.tools = !arguments.tools.empty(), .parameters = !arguments.parameters.empty()},
      job.sources, job.diagnostics);
  if (!setup) {
    job.diagnostics.add(setup.error());
    return false;
  }
  job.control = std::move(*setup);
  if (const auto text = job.sources.open(path))
    job.inputs.push_back({"ini", path, sha256((*text)->content())});
  return job.diagnostics.errors() == 0;
}

void note_user_code(const Job& job, const canon::Command& command, Diagnostics& out,
                    std::vector<std::string>& unchecked) {
  const auto* code = std::get_if<canon::UserCode>(&command.action);
  if (!code) return;
  if (job.machine) {
    const auto& rules = job.machine->user_codes();
    const auto rule = rules.find(code->code);
    if (rule != rules.end() && (rule->second.kind == machine::UserCodeKind::ignore ||
                                rule->second.kind == machine::UserCodeKind::time))
      return;
  }
  const bool remap = !code->remap.empty();
  const std::string name = remap ? code->remap : code->letter + std::to_string(code->code);
  const std::string said = name +
                           (remap ? " is remapped to Python" : " runs a program of the control") +
                           ", which is never run here";
  const std::string entry = command.span.place() + ": " + said;
  for (const std::string& known : unchecked)
    if (known == entry) return;
  out.warning("not_executed", command.span, said);
  unchecked.push_back(entry);
}

}  // namespace aircut::cli
