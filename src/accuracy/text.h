// Results as text: a page for people, and a table for programs.
#pragma once

#include <string>

#include "accuracy/evaluate.h"

namespace aircut::accuracy {

/// µm, N, kW; shares of the bodies, sizes with their scatter.
std::string to_human(const Setup& setup, const Result& result);
/// A row per segment and contact, numbers with 6 significant digits.
std::string to_csv(const Setup& setup, const Result& result);

std::string name_of(SizeKind kind);
std::string name_of(FieldCase which);  ///< I, II, III
/// In quotes where the text would break a row of a table.
std::string csv_cell(const std::string& text);
/// A number with `digits` significant digits, the same in every locale.
std::string significant(double value, int digits);

}  // namespace aircut::accuracy
