// What is wrong with a command line, in words of ours.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "base/diagnostic.h"

namespace aircut::cli {

/// The command that was named last; the program itself when none was.
const CLI::App* active_command(const CLI::App& app);
/// Its name with those before it, "kin fk"; empty for the program itself.
std::string full_name(const CLI::App* command);

/// The error kind `usage` for what the parser refused.
Diagnostic usage_diagnostic(const CLI::App& app, const CLI::ParseError& error);

/// Prints it and where help is; gives the exit code.
int usage_error(const Diagnostic& error, const CLI::App* command);

}  // namespace aircut::cli
