// The command line of `aircut log` and `aircut diff`. CLI11 stays in the files *arguments.cpp.
#pragma once

#include "cli/arguments.h"

namespace CLI {
class App;
}

namespace aircut::cli {

/// Adds the command; parsing fills the arguments.
CLI::App* add_log(CLI::App& app, LogArguments& arguments);
CLI::App* add_diff(CLI::App& app, DiffArguments& arguments);

}  // namespace aircut::cli
