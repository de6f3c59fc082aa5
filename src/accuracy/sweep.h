// What-if: the same set-up with other depths, feeds, speeds, order of the tools in time, and
// carriages.
#pragma once

#include <string>
#include <vector>

#include "accuracy/setup.h"

namespace aircut::accuracy {

/// One thing that changes and the values that it takes.
struct SweepAxis {
  std::string name;  ///< `T2.t`, `2.body`, `sign_policy`, `angular`, `coupled`
  std::vector<std::string> values;
};
/// `NAME=FROM:TO:STEP` or `NAME=VALUE,VALUE,…`; the error (kind `usage`) says what is wrong.
Expected<SweepAxis> parse_sweep(const std::string& text);

struct SweepTable {
  std::vector<std::string> names;     ///< of the axes, then of the results
  std::vector<std::string> settings;  ///< axes.size() texts per row
  std::vector<std::vector<double>> results;
};
constexpr std::size_t most_sweep_rows = 100'000;

/// All combinations, the last axis fastest. Per contact its normal error (mean over its time), per
/// size its mean error and the ends of its field, µm; what is not known is NaN. Nothing is returned
/// when a combination can't be read.
std::optional<SweepTable> run_sweep(const SourceText& text, const std::vector<SweepAxis>& axes,
                                    Diagnostics& out);

std::string to_csv(const SweepTable& table);

}  // namespace aircut::accuracy
