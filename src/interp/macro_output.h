// The text of DPRNT[…].
#pragma once

#include <string>
#include <string_view>

namespace aircut::interp {

class Parameters;

/// `X#100[43]` is the letter and the variable with 4 digits before and 3 behind the point; `*` is a
/// blank. What can't be read is written as it is.
std::string expand_output(std::string_view text, const Parameters& parameters);

}  // namespace aircut::interp
