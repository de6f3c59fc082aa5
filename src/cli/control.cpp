// The set-up file of a LinuxCNC machine as part of a job.
#include <filesystem>

#include "cli/job.h"

namespace aircut::cli {

namespace {

// The file of `FILE.ini` or `FILE.ini:CHANNEL`.
std::string ini_machine(const ProgramArguments& arguments) {
  const std::string file = machine::split_channel(arguments.machine).first;
  return file.ends_with(".ini") ? file : std::string();
}

}  // namespace

std::string ini_of(const ProgramArguments& arguments) {
  return arguments.ini.empty() ? ini_machine(arguments) : arguments.ini;
}

bool import_ini(Job& job, const ProgramArguments& arguments) {
  const std::string path = ini_machine(arguments);
  auto imported = linuxcnc::import_machine(path, job.sources, job.diagnostics);
  if (!imported) {
    if (job.diagnostics.errors() == 0) job.diagnostics.add(imported.error());
    return false;
  }
  if (!*imported) {
    if (arguments.ini_use == ProgramArguments::IniUse::both) return true;
    job.diagnostics.error(
        "ini_kinematics", {},
        "'" + printable(path) + "' has no [KINS]KINEMATICS, so there is no machine to ask");
    return false;
  }
  const SourceText& text = job.sources.add(path + " as machine.toml", (*imported)->toml);
  const std::string folder = std::filesystem::path(path).parent_path().string();
  const auto machine =
      machine::read_machine(text, folder.empty() ? "." : folder, job.sources, job.diagnostics,
                            machine::split_channel(arguments.machine).second);
  if (!machine) return false;
  job.machine = *machine;
  job.machine_unchecked = (*imported)->unchecked;
  job.imported = std::move(*imported);
  job.switches = job.imported;
  job.start = job.machine->home();
  job.inputs.push_back({"machine", arguments.machine, sha256(text.content())});
  return true;
}

void read_switches(Job& job, const ProgramArguments& arguments) {
  if (arguments.ini.empty() || !job.control) return;
  Diagnostics about_the_machine;  // which is the package and not this one
  auto imported = linuxcnc::import_machine(arguments.ini, job.sources, about_the_machine);
  if (!imported || !*imported || !(*imported)->switch_output) return;
  job.switches = std::move(*imported);
  const std::string& first = job.switches->models.front();
  if (job.switches->models.size() > 1 && job.machine->channel() != first)
    job.machine_unchecked.push_back("the set-up starts in the kinematics '" + first +
                                    "', the machine in '" + job.machine->channel() +
                                    "': name it with -m PACKAGE:" + first);
}

bool has_axis_travel(const Job& job) {
  if (!job.control || job.control->travel.empty()) return false;
  return !job.machine || (job.imported && !job.imported->axes_are_joints);
}

bool open_ini(Job& job, const ProgramArguments& arguments) {
  const std::string path = ini_of(arguments);
  if (path.empty() || arguments.ini_use == ProgramArguments::IniUse::machine) return true;
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
