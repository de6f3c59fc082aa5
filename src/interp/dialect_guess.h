// Looks at a line for signs of the control that it was written for.
#pragma once

#include <optional>
#include <string_view>

#include "interp/interp.h"

namespace aircut::interp {

/// A construct that only one family of controls reads.
struct DialectSign {
  std::optional<Dialect> dialect = {};
  const char* what = nullptr;  ///< null: the line has none
};
/// `first`: no line with code stands above it.
DialectSign sign_of(std::string_view line, bool first);

}  // namespace aircut::interp
