// What several commands need: opening the program and the machine, and saying what went wrong.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/arguments.h"
#include "linuxcnc/linuxcnc.h"
#include "machine/channels.h"
#include "report/accept.h"
#include "report/report.h"
#include "sim/sim.h"

namespace aircut::cli {

/// Inputs of a run, opened and read.
struct Job {
  SourceMap sources;
  std::vector<report::Input> inputs;
  Diagnostics diagnostics;                          ///< of inputs other than the program
  std::shared_ptr<const machine::Machine> machine;  ///< null when none was named
  std::optional<linuxcnc::Setup> control;           ///< --ini
  std::optional<linuxcnc::MachineImport> imported;  ///< `machine` is that of a set-up
  /// How the programs of a set-up switch the kinematics; also when the machine is a package.
  std::optional<linuxcnc::MachineImport> switches;
  std::vector<std::string> machine_unchecked;  ///< of a machine of another format
  machine::JointVector start;
  tool::ToolTable tools;
  interp::ParameterFile parameters;
};

/// Opens machine, set-up, tools and parameter file. Returns false when something can't be read or
/// is invalid; the reasons are in job.diagnostics. `table_unit_mm`: the unit of the tool table when
/// it is not the control's.
bool open_inputs(Job& job, const ProgramArguments& arguments,
                 std::optional<double> table_unit_mm = {});

/// Likewise for a machine whose channels run at once; job.machine is the whole machine.
bool open_channels(Job& job, const ProgramArguments& arguments,
                   const std::vector<std::string>& channels, machine::ChannelMachines& machines);

/// The LinuxCNC set-up that was named, with --ini or as the machine; empty without.
std::string ini_of(const ProgramArguments& arguments);
/// Reads it into job.control; false with errors in job.diagnostics.
bool open_ini(Job& job, const ProgramArguments& arguments);
/// The machine of a set-up (`FILE.ini`, `FILE.ini:CHANNEL`) into job.machine, which stays empty
/// when the set-up names no kinematics; false with errors in job.diagnostics.
bool import_ini(Job& job, const ProgramArguments& arguments);
/// For a package that is run with a set-up: how the set-up's programs switch the kinematics.
void read_switches(Job& job, const ProgramArguments& arguments);
/// `FILE.urdf`, `FILE.urdf:LINK`: likewise.
bool import_urdf(Job& job, const std::string& what);
/// Has the set-up travel of axes that the machine's joints do not have?
bool has_axis_travel(const Job& job);
/// Tells a code whose program of the control was not run, once per place.
void note_user_code(const Job& job, const canon::Command& command, Diagnostics& out,
                    std::vector<std::string>& unchecked);

/// Opens a program; `-` is standard input. Refuses what is not text (kinds `input`, `encoding`).
Expected<const SourceText*> open_program(SourceMap& sources, const std::string& path);

/// Folders in which packages are looked for by name.
std::vector<std::string> package_folders();

/// What --check asks for. Syntax is always looked at.
struct Checks {
  bool semantics = true, limits = true, collision = true, cut = true;
};
Checks asked_for(const std::vector<std::string>& words);

/// --waive, --raise, --baseline, --strict. Errors: a kind that does not exist, a file that can't be
/// read.
Expected<report::Rules> rules_of(const OutputArguments& output, SourceMap& sources);

/// Ends a command that could not begin: the messages on stderr, and as a document on stdout when
/// one was asked for.
int refuse(const Diagnostics& diagnostics, const OutputArguments& output);
int refuse(const Diagnostic& diagnostic, const OutputArguments& output);

/// Interpreter options for a job; `rs274` takes the reference's units.
interp::Options interpreter_options(const Job& job, const ProgramArguments& arguments,
                                    const SourceText& program);

/// Opens called sub files.
SourceReader sub_reader(SourceMap& sources);

/// Makes an output folder, or takes an empty one; with `force` any. Error kind `output_failed`.
Expected<void> make_folder(const std::string& folder, bool force);

bool use_color(When when, int descriptor);
/// Prints diagnostics on stderr.
void print_errors(const Diagnostics& diagnostics, When color);
void print_error(const Diagnostic& diagnostic, When color);

/// What a run tells whoever goes on with it.
struct RunOutcome {
  bool finished = false;     ///< false: its inputs can't be read, or an output can't be written
  bool stock_saved = false;  ///< of a program that reached its end
  double cycle_time = 0;     ///< s
};
int run_command(const RunArguments& arguments, RunOutcome* outcome = nullptr);
int job_command(const JobArguments& arguments);
int check_command(const CheckArguments& arguments);
int trace_command(const TraceArguments& arguments);
int machine_command(const MachineArguments& arguments);
int import_command(const MachineArguments& arguments);
int new_command(const MachineArguments& arguments);
int kin_command(const KinArguments& arguments);
int workspace_command(const WorkspaceArguments& arguments);
int accuracy_command(const AccuracyArguments& arguments);
int rot_command(const KinArguments& arguments);
int log_command(const LogArguments& arguments);
int diff_command(const DiffArguments& arguments);
int explain_command(const ExplainArguments& arguments);
int doctor_command();

}  // namespace aircut::cli
