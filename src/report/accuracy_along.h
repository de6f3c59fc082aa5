// What the cutting forces did along a program: for result.json, accuracy.json, the text.
#pragma once

#include <string>

#include "process/process.h"

namespace aircut::report {

struct AccuracyAlong {
  std::string file;     ///< as the user wrote it
  std::string verdict;  ///< pass, fail, unknown
  accuracy::Setup setup;
  process::Summary summary;
};

/// The line of each tool and size, for people; ends with a line end.
std::string along_text(const AccuracyAlong& along);

/// accuracy.json of a run.
std::string along_json(const AccuracyAlong& along, const std::string& version,
                       const std::string& sha256, const std::vector<Diagnostic>& diagnostics);

}  // namespace aircut::report
