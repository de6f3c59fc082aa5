#include <clocale>
#include <csignal>
#include <cstdio>
#include <exception>

#include "cli/exit_code.h"
#include "cli/job.h"

int main(int argc, char** argv) {
  using namespace aircut;
  using namespace aircut::cli;
  std::signal(SIGPIPE, SIG_DFL);
  try {
    const auto parsed = parse(argc, argv);
    if (const int* answered = std::get_if<int>(&parsed)) return *answered;
    const int outcome =
        std::visit(overloaded{
                       [](const RunArguments& a) { return run_command(a); },
                       [](const JobArguments& a) { return job_command(a); },
                       [](const CheckArguments& a) { return check_command(a); },
                       [](const TraceArguments& a) { return trace_command(a); },
                       [](const MachineArguments& a) { return machine_command(a); },
                       [](const KinArguments& a) { return kin_command(a); },
                       [](const WorkspaceArguments& a) { return workspace_command(a); },
                       [](const AccuracyArguments& a) { return accuracy_command(a); },
                       [](const LogArguments& a) { return log_command(a); },
                       [](const DiffArguments& a) { return diff_command(a); },
                       [](const ExplainArguments& a) { return explain_command(a); },
                       [](const DoctorArguments&) { return doctor_command(); },
                   },
                   std::get<Arguments>(parsed));
    if (outcome == code(ExitCode::pass) && (std::fflush(stdout) != 0 || std::ferror(stdout))) {
      print_error(make_error("output_failed", "can't write to standard output"), When::automatic);
      return code(ExitCode::unknown);
    }
    return outcome;
  } catch (const std::exception& e) {
    std::fprintf(stderr,
                 "aircut: internal error: %s\nThis is a bug in aircut. Please report it with the "
                 "command, the "
                 "program and the machine that led here.\n",
                 e.what());
    return code(ExitCode::internal);
  }
}
