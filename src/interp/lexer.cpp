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

constexpr std::size_t most_digits = 15;

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return c >= 'a' && c <= 'z'; }

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

// A decimal of up to 15 digits (so below 2^53) is mantissa / 10^k with a single, correct rounding;
// others, and those with blanks inside, go the long way.
bool Cursor::read_digits(double& number) {
  const char* const begin = line_.data() + at_;
  const char* const end = line_.data() + line_.size();
  const char* at = begin;
  std::uint64_t mantissa = 0;  // of too many digits nothing is used
  const auto take_digits = [&] {
    const char* const first = at;
    for (; at != end && is_digit(*at); ++at)
      mantissa = mantissa * 10 + static_cast<unsigned>(*at - '0');
    return static_cast<std::size_t>(at - first);
  };
  std::size_t digits = take_digits(), decimals = 0;
  const bool point = at != end && *at == '.';
  if (point) {
    ++at;
    decimals = take_digits();
    digits += decimals;
  }
  const char* next = at;
  while (next != end && (*next == ' ' || *next == '\t')) ++next;
  const bool goes_on = next != at && next != end && (is_digit(*next) || (*next == '.' && !point));
  if (goes_on || digits > most_digits) return read_long_digits(number);
  if (digits == 0) return false;
  at_ = static_cast<std::size_t>(next - line_.data());
  number = static_cast<double>(mantissa);
  if (decimals > 0) number /= powers_of_ten[decimals];
  return true;
}

bool Cursor::read_plain_number(double& number, std::uint32_t& end_of_number) {
  const char* const text = line_.data();
  const char* const end = text + line_.size();
  const char* at = text + at_;
  const bool minus = at != end && *at == '-';
  if (minus) ++at;             // a blank behind it is not for us
  std::uint64_t mantissa = 0;  // of too many digits nothing is used
  const auto take_digits = [&] {
    const char* const first = at;
    for (; at != end; ++at) {
      const auto digit = static_cast<std::uint64_t>(static_cast<unsigned char>(*at)) - '0';
      if (digit > 9) break;
      mantissa = mantissa * 10 + digit;
    }
    return static_cast<std::size_t>(at - first);
  };
  std::size_t digits = take_digits(), decimals = 0;
  if (at != end && *at == '.') {
    ++at;
    decimals = take_digits();
    digits += decimals;
  }
  if (digits == 0 || digits > most_digits) return false;
  end_of_number = static_cast<std::uint32_t>(at - text);
  while (at != end && (*at == ' ' || *at == '\t')) ++at;
  if (at != end && !is_letter(lower(*at))) return false;
  number = static_cast<double>(static_cast<std::int64_t>(mantissa));
  if (decimals > 0) number /= powers_of_ten[decimals];
  if (minus) number = -number;
  at_ = static_cast<std::size_t>(at - text);
  return true;
}

bool Cursor::read_long_digits(double& number) {
  const std::size_t start = at_;
  std::string plain;
  bool point = false;
  for (; at_ < line_.size(); advance()) {
    const char c = line_[at_];
    if (!is_digit(c) && (c != '.' || point)) break;
    point = point || c == '.';
    plain += c;
  }
  if (plain.empty() || plain == ".") {
    at_ = start;
    return false;
  }
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
