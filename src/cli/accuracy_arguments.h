// The command line of `aircut accuracy`. CLI11 stays in the files *arguments.cpp.
#pragma once

#include "cli/arguments.h"

namespace CLI {
class App;
}

namespace aircut::cli {

/// Adds the command; parsing fills the arguments.
CLI::App* add_accuracy(CLI::App& app, AccuracyArguments& arguments);

}  // namespace aircut::cli
