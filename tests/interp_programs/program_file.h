// A program whose comments say what must come out of each line. The form is explained in README.md.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "interp/interp.h"

namespace aircut::test {

/// What one line must do. Without a list of commands anything is right but an error.
struct Expectation {
  std::optional<std::vector<std::string>> commands;  ///< to_text of each, in order
  std::vector<std::string> errors;                   ///< kinds, in order
  std::vector<std::string> warnings;
  std::string peer_accepts;  ///< why the reference program accepts a line that is refused here
};

struct ProgramFile {
  std::string name;
  std::string text;
  std::map<std::uint64_t, Expectation> lines;  ///< by line number; 0: the file as a whole

  // `;! key value` lines.
  interp::Options options;
  interp::ParameterFile parameters;
  std::string tools;       ///< lines of the tool table, in the machine unit
  std::string no_peer;     ///< why the reference program can't be asked
  std::string bad_syntax;  ///< what is wrong with the comments; empty when nothing is

  bool expects_errors() const;
};

/// Machine unit inch, program unit mm, axes XYZABC, as the reference program has them.
interp::Options reference_options();

/// Reads the comments of a program. `common_tools` is its tool table unless it brings its own.
ProgramFile read_program_file(const std::string& name, const std::string& text,
                              const std::string& common_tools);
/// All `*.ngc` of a folder in the order of their names.
std::vector<ProgramFile> read_program_folder(const std::string& folder);

/// What a run gave.
struct Outcome {
  struct Found {
    std::uint64_t line = 0;  ///< 0 when the place is in another file or nowhere
    std::string kind, text;
    Severity severity = Severity::error;
  };
  std::vector<canon::Command> commands;
  std::vector<Found> found;
  std::string rs274;  ///< the trace in the reference's form
  bool stopped_by_limit = false;
  std::map<std::string, std::uint64_t> codes;  ///< how often each code of the table acted
};

/// Sees each command of a run and says where a probing move ends.
using ProbeModel = std::function<std::optional<interp::ProbeHit>(const canon::Command&)>;

/// Runs a program. Sub files are looked for in `sub_folder`. Without a model a probe meets nothing.
Outcome run_program(const ProgramFile& program, bool keep_going, const std::string& sub_folder,
                    const ProbeModel& model = {});

/// Whether two texts of commands say the same: words are equal, numbers within 1e-4 or a millionth
/// of their size.
bool same_text(const std::string& a, const std::string& b);

}  // namespace aircut::test
