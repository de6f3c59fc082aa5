// A second reader of macro B for tests: it works on the text itself, with grammar rules as
// functions and a map of variables, and shares no code with the interpreter. It knows settings, IF,
// GOTO, WHILE … DO … END, and DPRNT of one variable.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace aircut::test {

/// A number, or nothing for a vacant variable.
using MacroValue = std::optional<double>;

struct MacroResult {
  std::vector<std::string> output;  ///< of DPRNT[#n[86]]: the number with 6 decimals
  std::map<int, double> variables;  ///< those that are not vacant
  std::vector<int> failed_lines;    ///< from 1: a division by 0 and the like
  bool too_long = false;            ///< more than the allowed steps
};

MacroResult run_macro_reference(const std::string& program, int most_steps);

}  // namespace aircut::test
