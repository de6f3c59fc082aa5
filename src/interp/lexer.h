// The characters of one line as the dialect sees them: blanks do not count, letters have no case,
// except inside comments.
#pragma once

#include <cstdint>
#include <string_view>

#include "base/source.h"

namespace aircut::interp {

class Cursor {
 public:
  explicit Cursor(std::string_view line) : line_(line) { skip(); }

  /// The next character that counts, in lower case; 0 at the end.
  char peek() const { return at_ < line_.size() ? lower(line_[at_]) : '\0'; }
  bool at_end() const { return at_ >= line_.size(); }
  void advance() {
    ++at_;
    skip();
  }
  bool accept(char c) {
    if (peek() != c || at_end()) return false;
    advance();
    return true;
  }
  /// Advances over `word` (lower case), or stays when the text is another one.
  bool accept_word(std::string_view word);

  std::uint32_t position() const { return static_cast<std::uint32_t>(at_); }
  void go_to(std::uint32_t position) {
    at_ = position;
    skip();
  }
  std::string_view line() const { return line_; }
  /// Bytes from `begin` to here without the blanks at the end.
  std::uint32_t length_since(std::uint32_t begin) const {
    std::size_t end = at_ < line_.size() ? at_ : line_.size();
    while (end > begin && (line_[end - 1] == ' ' || line_[end - 1] == '\t')) --end;
    return static_cast<std::uint32_t>(end - begin);
  }

  /// A number without sign: digits with at most one point. False (and no advance) when there is
  /// none.
  bool read_digits(double& number);
  /// The number of a plain word: up to 15 digits with at most one point and perhaps a minus, then
  /// the end of the line or a letter. Gives its last byte's successor in `end`. Anything else:
  /// false, and no advance.
  bool read_plain_number(double& number, std::uint32_t& end);

 private:
  bool read_long_digits(double& number);
  static char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; }
  void skip() {
    while (at_ < line_.size() && (line_[at_] == ' ' || line_[at_] == '\t')) ++at_;
  }

  std::string_view line_;
  std::size_t at_ = 0;
};

/// Where a line ends and the next one begins. LF, CRLF and CR all end a line.
struct LineExtent {
  std::uint64_t end = 0;   ///< first byte of the line end
  std::uint64_t next = 0;  ///< first byte of the next line
};
/// `reading` is told what is looked at.
LineExtent find_line_end(std::string_view text, std::uint64_t begin, Reading* reading = nullptr);

}  // namespace aircut::interp
