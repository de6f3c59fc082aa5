#include "interp/lexer.h"

#include <array>
#include <charconv>
#include <cstring>
#include <limits>
#include <string>

namespace aircut::interp {
namespace {

constexpr std::array<double, 23> powers_of_ten = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                  1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                  1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

bool is_digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

bool Cursor::accept_word(std::string_view word) {
  const std::size_t start = at_;
  for (const char c : word) {
    if (peek() != c) {
      at_ = start;
      return false;
    }
    advance();
  }
  return true;
}

std::uint32_t Cursor::length_since(std::uint32_t begin) const {
  std::size_t end = at_ < line_.size() ? at_ : line_.size();
  while (end > begin && (line_[end - 1] == ' ' || line_[end - 1] == '\t')) --end;
  return static_cast<std::uint32_t>(end - begin);
}

// A decimal with up to 2^53 in its digits and up to 22 decimals is mantissa / 10^k with a single,
// correct rounding; others go the long way.
bool Cursor::read_digits(double& number) {
  const std::size_t start = at_;
  std::uint64_t mantissa = 0;
  int digits = 0;
  int decimals = 0;
  bool point = false;
  bool exact = true;
  while (at_ < line_.size()) {
    const char c = line_[at_];
    if (is_digit(c)) {
      if (mantissa > (1ULL << 53) / 10 - 1) exact = false;
      if (exact) mantissa = mantissa * 10 + static_cast<unsigned>(c - '0');
      ++digits;
      if (point) ++decimals;
      ++at_;
    } else if (c == '.' && !point) {
      point = true;
      ++at_;
    } else if (c == ' ' || c == '\t') {
      skip();
    } else {
      break;
    }
  }
  if (digits == 0) {
    at_ = start;
    return false;
  }
  if (exact && decimals <= 22) {
    number = static_cast<double>(mantissa) / powers_of_ten[static_cast<std::size_t>(decimals)];
    return true;
  }
  std::string plain;
  for (std::size_t i = start; i < at_; ++i)
    if (is_digit(line_[i]) || line_[i] == '.') plain += line_[i];
  if (plain.front() == '.') plain.insert(0, "0");
  number = std::numeric_limits<double>::infinity();  // stays when it is out of range
  std::from_chars(plain.data(), plain.data() + plain.size(), number, std::chars_format::fixed);
  return true;
}

LineExtent find_line_end(std::string_view text, std::uint64_t begin) {
  const char* first = text.data() + begin;
  const std::size_t rest = text.size() - begin;
  const void* lf = std::memchr(first, '\n', rest);
  std::size_t length = lf ? static_cast<std::size_t>(static_cast<const char*>(lf) - first) : rest;
  // A lone CR ends a line too; one in front of LF belongs to the line end.
  const void* cr = std::memchr(first, '\r', length);
  if (!cr) return {begin + length, begin + length + (lf ? 1 : 0)};
  const std::size_t at = static_cast<std::size_t>(static_cast<const char*>(cr) - first);
  const bool pair = at + 1 < rest && first[at + 1] == '\n';
  return {begin + at, begin + at + (pair ? 2 : 1)};
}

}  // namespace aircut::interp
