// The command line of `aircut job`. CLI11 stays in the files *arguments.cpp.
#pragma once

#include "cli/arguments.h"

namespace CLI {
class App;
}

namespace aircut::cli {

/// Adds the command; parsing fills the arguments.
CLI::App* add_job(CLI::App& app, JobArguments& arguments);

}  // namespace aircut::cli
