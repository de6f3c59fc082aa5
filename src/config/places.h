// Places of toml++ (line and column in characters) as byte ranges of the text.
#pragma once

// The library's own checks abort on malformed input such as `[[!x]]`, although the code behind them
// reports it well.
#define TOML_ASSERT(expression) static_cast<void>(0)
#include <toml++/toml.h>

#include <optional>
#include <vector>

#include "base/base.h"

namespace aircut::config {

class Places {
 public:
  explicit Places(const SourceText& text);
  /// The range of a region, cut off at the end of its first line; at least one character long
  /// unless the line ends there.
  SourceSpan span(const toml::source_region& region) const;
  /// One character at a position.
  SourceSpan at(const toml::source_position& position) const;
  /// The word that a line begins with, for errors about a whole line.
  SourceSpan line_start(std::uint32_t line) const;

 private:
  std::size_t byte_of(const toml::source_position& position) const;
  std::size_t line_end(std::size_t from) const;
  SourceSpan make(std::size_t begin, std::size_t end, std::uint32_t line) const;

  const SourceText* text_;
  std::vector<std::size_t> line_starts_;  ///< byte offset by line number − 1
};

/// The place of a key that is nested deeper than any file of ours, if there is one. Such keys
/// (`a.a.a.…`) would make the parser's tables so deep that freeing them overflows the stack.
std::optional<SourceSpan> too_deep_key(const SourceText& text);

/// The place of a character outside of ASCII that is in no string and no comment, if there is one.
/// TOML allows none there, and toml++ 3.3.0 has undefined behaviour for some of them.
std::optional<SourceSpan> stray_character(const SourceText& text);

}  // namespace aircut::config
