// The operations of macro B on numbers that may be vacant.
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "interp/expression.h"

namespace aircut::interp {

class Parameters;

/// What a variable holds that was never set. It is never handed on as a number.
constexpr double vacant_value = std::numeric_limits<double>::quiet_NaN();
inline bool is_vacant(double value) { return std::isnan(value); }

/// The result of an operation on `a` (and `b`), or nothing with what is wrong.
std::optional<double> macro_operation(Op op, double a, double b, const Parameters& parameters,
                                      std::string& problem);

/// Half away from zero to a multiple of 1/`per_unit`.
double rounded_to(double value, double per_unit);

}  // namespace aircut::interp
