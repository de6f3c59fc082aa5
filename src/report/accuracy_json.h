// accuracy.json: the results of `aircut accuracy`.
#pragma once

#include <string>

#include "accuracy/accuracy.h"

namespace aircut::report {

struct AccuracyReport {
  std::string version;  ///< of aircut
  std::string verdict;  ///< pass, fail, unknown
  std::string file;     ///< the set-up, as the user wrote it
  std::string sha256;
  Diagnostics diagnostics;
  bool with_influence = false;  ///< the blocks E_kl too
};

/// One document, keys in a fixed order. Lengths mm and µm, forces N, moments N·m, as keys say.
std::string accuracy_json(const AccuracyReport& report, const accuracy::Setup& setup,
                          const accuracy::Result& result);

}  // namespace aircut::report
