// Programs of LinuxCNC, each started for one question: what they read at their start differs.
#pragma once

#include <string>
#include <vector>

#include "peer/reference.h"

namespace aircut::test {

struct Said {
  int status = -1;
  std::string out, err;
};

/// Runs a program at most ten seconds. `folder` is its working, scratch and home folder.
Said run_linuxcnc(std::vector<std::string> words, const std::string& folder);

/// What rs274 makes of a program with the set-up `machine.ini` of the folder.
Trace run_with_ini(const ProgramFile& program, const std::string& folder);

}  // namespace aircut::test
