// Words of the cycles of Fanuc-like turning centres. Lengths in mm, X as radius.
#pragma once

#include <optional>

#include "interp/contour.h"
#include "interp/run.h"

namespace aircut::interp {

/// Where X or U, and Z or W, lead from a point; without a word its coordinate stays.
PlanePoint lathe_target(const BlockRun& run, PlanePoint from);
/// P, Q or D that count least increments when they have no decimal point.
double increments(const BlockRun& run, char letter);
/// The point of the tool: u = Z, v = X.
PlanePoint lathe_position(const BlockRun& run);
/// An error unless X or U, and Z or W where `both`, are there.
bool lathe_words_given(BlockRun& run, const CodeRule& rule, bool x, bool z);

}  // namespace aircut::interp
