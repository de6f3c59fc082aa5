#include "interp/lexer.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <limits>
#include <string>

namespace aircut::interp {
namespace {

constexpr std::array<double, 16> powers_of_ten = {1e0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                  1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};

constexpr int most_digits = 15;

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

// A decimal of up to 15 digits (so below 2^53) is mantissa / 10^k with a single,
// correct rounding; others go the long way.
bool Cursor::read_digits(double& number) {
  const std::size_t start = at_;
  std::uint64_t mantissa = 0;
  int digits = 0;
  int decimals = 0;
  bool point = false;
  while (at_ < line_.size()) {
    const char c = line_[at_];
    if (is_digit(c)) {
      if (digits < most_digits) mantissa = mantissa * 10 + static_cast<unsigned>(c - '0');
      ++digits;
      decimals += point ? 1 : 0;
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
  if (digits <= most_digits) {
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

// A lone CR ends a line too; one in front of LF belongs to the line end. The text is gone through
// in parts: looking for an LF far ahead would take a text that has only CRs a square of its length.
LineExtent find_line_end(std::string_view text, std::uint64_t begin, Reading* reading) {
  constexpr std::size_t part = 1024;
  std::uint64_t from = begin;
  while (from < text.size()) {
    const char* first = text.data() + from;
    std::size_t length = std::min<std::size_t>(text.size() - from, part);
    const void* lf = std::memchr(first, '\n', length);
    if (lf) length = static_cast<std::size_t>(static_cast<const char*>(lf) - first);
    const void* cr = std::memchr(first, '\r', length);
    if (cr) length = static_cast<std::size_t>(static_cast<const char*>(cr) - first);
    const std::uint64_t end = from + length;
    if (lf || cr) {
      const bool pair = cr && end + 1 < text.size() && text[end + 1] == '\n';
      const std::uint64_t next = end + (pair ? 2 : 1);
      if (reading) reading->at(from, next);
      return {end, next};
    }
    if (reading) reading->at(from, end);
    from = end;
  }
  return {text.size(), text.size()};
}

}  // namespace aircut::interp
