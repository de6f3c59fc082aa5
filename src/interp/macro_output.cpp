#include "interp/macro_output.h"

#include <algorithm>

#include "base/text.h"
#include "interp/macro_expression.h"
#include "interp/parameters.h"

namespace aircut::interp {
namespace {

bool is_digit_at(std::string_view text, std::size_t at) {
  return at < text.size() && text[at] >= '0' && text[at] <= '9';
}

// `#100[43]` at `at`: appends the number and advances, or stays.
bool expand_variable(std::string_view text, std::size_t& at, const Parameters& parameters,
                     std::string& out) {
  std::size_t end = at + 1;
  int number = 0;
  while (is_digit_at(text, end) && number < 1'000'000) number = number * 10 + (text[end++] - '0');
  const bool complete = end > at + 1 && end < text.size() && text[end] == '[' &&
                        is_digit_at(text, end + 1) && is_digit_at(text, end + 2) &&
                        end + 3 < text.size() && text[end + 3] == ']';
  if (!complete) return false;
  const auto width = static_cast<std::size_t>(text[end + 1] - '0');
  const int decimals = text[end + 2] - '0';
  std::optional<Fault> fault;
  const auto value = parameters.read(number, {}, fault);
  std::string digits = fixed(value && !is_vacant(*value) ? *value : 0, decimals);
  const std::size_t whole = width + 1 + (decimals > 0 ? static_cast<std::size_t>(decimals) + 1 : 0);
  out.append(whole - std::min(whole, digits.size()), ' ');
  out += digits;
  at = end + 4;
  return true;
}

}  // namespace

std::string expand_output(std::string_view text, const Parameters& parameters) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    if (text[at] == '#' && expand_variable(text, at, parameters, out)) continue;
    out += text[at] == '*' ? ' ' : text[at];
    ++at;
  }
  return out;
}

}  // namespace aircut::interp
