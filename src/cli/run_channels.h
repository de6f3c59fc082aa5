// `run` with several channels, and what it shares with a run of one.
#pragma once

#include "cli/arguments.h"
#include "cli/job.h"
#include "report/report.h"

namespace aircut::cli {

/// `run --channel NAME=PROGRAM …`.
int run_channels(const RunArguments& arguments);

/// The output folder of a run: made, or emptied of what an earlier run left. Error `output_failed`.
Expected<void> prepare_folder(const std::string& folder, bool force);
/// What the arguments ask of the pictures. Error kind `usage`.
Expected<report::FrameOptions> frame_options(const RunArguments& arguments);
/// What a run has found, with its inputs and the state of the machine's meshes; the diagnostics of
/// its programs are still to come.
report::RunReport report_of(const RunArguments& arguments, const Job& job, const Checks& checks,
                            sim::Simulator::Result result);
/// From now on the first SIGINT or SIGTERM is noted, the second one ends the process.
void listen_to_signals();
/// 0: none came.
int signal_that_came();

}  // namespace aircut::cli
