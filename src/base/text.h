// Text of numbers and words, independent of the locale.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace aircut {

/// Shortest text that reads back to the same double: `0.1`, `-3`, `1e-09`; -0 is written `0`.
std::string shortest(double value);
/// Appends shortest(value) without an allocation of its own.
void append_shortest(std::string& out, double value);
/// Fixed decimals; a result of minus zero loses its sign.
std::string fixed(double value, int decimals);

/// A plain decimal number, the whole of `text` (no exponent, no inf or nan).
std::optional<double> parse_number(std::string_view text);

/// The candidate that `word` most likely meant, or nothing when none is near (edit distance at
/// most a third of the length, at least 1).
std::optional<std::string> nearest_word(std::string_view word, std::span<const std::string> known);

/// ` Did you mean 'x'?`, or an empty text.
std::string did_you_mean(std::string_view word, std::span<const std::string> known);

/// Valid UTF-8 of any bytes; those that are not UTF-8 are read as Latin-1, as old programs are
/// written.
std::string utf8(std::string_view bytes);
/// Valid UTF-8 in which characters that act on a terminal or on the order of a text (C1 controls,
/// directions, separators) are replaced by U+FFFD; line ends and tabs stay.
std::string harmless(std::string_view text);
/// harmless(), with control characters shown as `^[`, `^I` …: one line that can't drive a terminal.
std::string printable(std::string_view text);

/// Characters (UTF-8 code points) of a text; a broken sequence counts a character per byte.
std::size_t count_characters(std::string_view text);

}  // namespace aircut
