// What the words of a block mean on Fanuc-like controls, and settings of their variables.
#pragma once

#include "interp/run.h"

namespace aircut::interp {

/// Least increments in a unit of the letter's words: 1000 per mm and degree, 10000 per inch.
double increments_of(char letter, bool inch);

/// The number that a word with this value stands for: a whole number without a point counts least
/// increments (with a warning), the value of an expression is rounded as the control does it.
double word_number(BlockRun& run, const Word& word, double value);

/// Sets a system variable (#1000…) from a program; an error when it can't be set.
void write_system_variable(BlockRun& run, int n, double value, Place place);

}  // namespace aircut::interp
