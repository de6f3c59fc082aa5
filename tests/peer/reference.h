// The reference program, rs274 of LinuxCNC, as a judge: runs it and compares its trace with ours.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "interp_programs/program_file.h"
#include "peer/server.h"

namespace aircut::test {

/// One line of a trace: `NAME(arguments)`, or what the program printed to the console.
struct Call {
  std::string text;
  std::string n;  ///< the block's N field
};

struct Trace {
  std::vector<Call> calls;
  bool error = false;
  bool timed_out = false;
  std::string error_text;
  std::string error_line;  ///< own: the text of the line that is refused, when it is the program's
  std::uint64_t error_at = 0;                  ///< own: that line's number
  std::map<std::string, std::uint64_t> codes;  ///< own: how often each code acted
};

/// Whether rs274 can be started.
bool reference_is_installed();

class Reference {
 public:
  /// `folder` is scratch space; called files are looked for in `sub_folder`.
  Reference(std::string folder, std::string sub_folder);
  Trace run(const ProgramFile& program);

 private:
  std::string folder_;
  std::string tools_;
  bool block_delete_ = false;
  std::optional<Server> server_;  ///< started with these tools and this switch
};

/// Calls of the text of a trace.
std::vector<Call> parse_trace(const std::string& text);

/// The trace of this project's interpreter, stopped at the first error as the reference is.
Trace own_trace(const ProgramFile& program, const std::string& sub_folder);

/// What the comparison ignores (docs/peer.md): the start and end states, a stand-in's remarks.
std::vector<Call> comparable(const Trace& trace);

/// Says where two traces differ, or nothing when they agree.
std::optional<std::string> difference(const Trace& own, const Trace& reference);

/// The program with lines removed as long as `differs` stays true; asks at most `budget` times.
std::string shrink(const std::string& program,
                   const std::function<bool(const std::string&)>& differs, int budget);

}  // namespace aircut::test
