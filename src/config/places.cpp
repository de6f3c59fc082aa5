// toml++ counts lines by '\n' and columns in code points from 1; it does not count a byte order
// mark. A SourceSpan is a range of bytes within one line.
#include "config/places.h"

#include <algorithm>

namespace aircut::config {

namespace {

constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";

// Bytes of the UTF-8 character at `at`; toml++ has checked the text, except behind an error.
std::size_t character_width(std::string_view text, std::size_t at) {
  std::size_t end = at + 1;
  while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) ++end;
  return end - at;
}

}  // namespace

Places::Places(const SourceText& text) : text_(&text) {
  const std::string_view all = text.content();
  line_starts_.push_back(all.starts_with(byte_order_mark) ? byte_order_mark.size() : 0);
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i] == '\n') line_starts_.push_back(i + 1);
}

std::size_t Places::line_end(std::size_t from) const {
  const std::string_view all = text_->content();
  return std::min(all.find_first_of("\r\n", from), all.size());
}

std::size_t Places::byte_of(const toml::source_position& position) const {
  const std::size_t line = std::clamp<std::size_t>(position.line, 1, line_starts_.size());
  std::size_t byte = line_starts_[line - 1];
  const std::size_t end = line_end(byte);
  for (std::size_t column = 1; column < position.column && byte < end; ++column)
    byte += character_width(text_->content(), byte);
  return std::min(byte, end);
}

SourceSpan Places::make(std::size_t begin, std::size_t end, std::uint32_t line) const {
  const std::size_t last = std::min(end, line_end(begin));
  return SourceSpan{.text = text_,
                    .begin = begin,
                    .length = static_cast<std::uint32_t>(last > begin ? last - begin : 0),
                    .line = line};
}

SourceSpan Places::span(const toml::source_region& region) const {
  const std::size_t begin = byte_of(region.begin);
  const bool one_line = region.begin.line == region.end.line;
  std::size_t end = one_line ? byte_of(region.end) : line_end(begin);
  if (end <= begin && begin < text_->content().size())
    end = begin + character_width(text_->content(), begin);
  return make(begin, end, std::max<std::uint32_t>(region.begin.line, 1));
}

SourceSpan Places::at(const toml::source_position& position) const {
  return span(toml::source_region{position, position, nullptr});
}

SourceSpan Places::line_start(std::uint32_t line) const {
  const std::size_t index = std::clamp<std::size_t>(line, 1, line_starts_.size()) - 1;
  const std::string_view all = text_->content();
  std::size_t begin = line_starts_[index];
  while (begin < all.size() && (all[begin] == ' ' || all[begin] == '\t')) ++begin;
  const std::size_t end = std::min(all.find_first_of(" \t=\r\n", begin), all.size());
  return make(begin, end, static_cast<std::uint32_t>(index + 1));
}

std::optional<SourceSpan> too_deep_key(const SourceText& text) {
  // Our files nest keys three deep. Arrays and inline tables have toml++'s own limit of 256 levels,
  // each of which can hold one dotted key: 16 · 256 levels fit any stack.
  constexpr int deepest = 16;
  const std::string_view all = text.content();
  const auto is_bare = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
  };
  std::uint32_t line = 1;
  int dots = 0;        // of the dotted key that is being read
  bool piece = false;  // a piece of it stands right before this character
  for (std::size_t i = 0; i < all.size(); ++i) {
    const char c = all[i];
    if (c == '\n') ++line;
    if (is_bare(c)) {
      piece = true;
    } else if (c == '"' || c == '\'') {
      const std::size_t close = all.find_first_of(c == '"' ? "\"\n" : "'\n", i + 1);
      if (close != std::string_view::npos && all[close] == c) i = close;
      piece = true;
    } else if (c == '.' && piece) {
      piece = false;
      if (++dots >= deepest)
        return SourceSpan{.text = &text, .begin = i, .length = 1, .line = line};
    } else if (c != ' ' && c != '\t') {
      dots = 0;
      piece = false;
    }
  }
  return std::nullopt;
}

std::optional<SourceSpan> stray_character(const SourceText& text) {
  const std::string_view all = text.content();
  std::uint32_t line = 1;
  std::size_t i = all.starts_with("\xef\xbb\xbf") ? 3 : 0;  // a byte order mark is allowed
  // Skips to behind the next `close`, or to the end of the line (or the text when `lines`).
  const auto skip_string = [&](std::string_view close, bool escapes, bool lines) {
    for (i += close.size(); i < all.size(); ++i) {
      if (all[i] == '\n') {
        if (!lines) return;
        ++line;
      } else if (escapes && all[i] == '\\' && i + 1 < all.size() && all[i + 1] != '\n') {
        ++i;
      } else if (all.substr(i, close.size()) == close) {
        i += close.size();
        return;
      }
    }
  };
  while (i < all.size()) {
    const char c = all[i];
    if (c == '#') {
      while (i < all.size() && all[i] != '\n') ++i;
    } else if (all.substr(i, 3) == "\"\"\"") {
      skip_string("\"\"\"", true, true);
    } else if (all.substr(i, 3) == "'''") {
      skip_string("'''", false, true);
    } else if (c == '"') {
      skip_string("\"", true, false);
    } else if (c == '\'') {
      skip_string("'", false, false);
    } else if (static_cast<unsigned char>(c) >= 0x80) {
      std::uint32_t length = 1;
      while (i + length < all.size() &&
             (static_cast<unsigned char>(all[i + length]) & 0xc0) == 0x80)
        ++length;
      return SourceSpan{.text = &text, .begin = i, .length = length, .line = line};
    } else {
      if (c == '\n') ++line;
      ++i;
    }
  }
  return std::nullopt;
}

}  // namespace aircut::config
