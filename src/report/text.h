// Text of inputs on its way out: nothing in it may break a format or drive a terminal.
#pragma once

#include <string>
#include <string_view>

namespace aircut::report {

/// Valid UTF-8 of any bytes; those that are not UTF-8 are read as Latin-1, as old programs are
/// written.
std::string utf8(std::string_view bytes);

/// Valid UTF-8 without characters that a terminal, a viewer of source text or XML acts on although
/// they are not below 0x20: C1 controls, changes of writing direction, line separators,
/// non-characters. Each is replaced by one U+FFFD, so that columns stay.
std::string harmless(std::string_view text);

/// One line for people: control characters as `^[`, and harmless.
std::string plain(std::string_view text);

}  // namespace aircut::report
