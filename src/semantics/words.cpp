// Finds a word in a line again. The stream of commands knows the block; a message shall underline
// the word. Only lines that the interpreter has accepted come here, so their form is right.
#include "semantics/words.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "base/text.h"

namespace aircut::semantics {

namespace {

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }
bool is_blank(char c) { return c == ' ' || c == '\t'; }

// Behind the bracket, name or comment that begins at `at`; `at` + 1 for anything else.
std::size_t skip(std::string_view line, std::size_t at) {
  const char open = line[at];
  if (open == ';') return line.size();
  const char close = open == '(' ? ')' : open == '[' ? ']' : open == '<' ? '>' : '\0';
  if (close == '\0') return at + 1;
  int depth = 0;
  for (; at < line.size(); ++at) {
    if (line[at] == open && (open == '[' || depth == 0)) ++depth;
    if (line[at] == close && --depth == 0) return at + 1;
  }
  return line.size();
}

// Behind the value that begins at `at`: a number, #…, […], or a function with its arguments.
std::size_t value_end(std::string_view line, std::size_t at) {
  while (at < line.size() && (is_blank(line[at]) || line[at] == '-' || line[at] == '+')) ++at;
  // A name of more than one letter before a bracket is a function.
  std::size_t name = at;
  while (name < line.size() && is_letter(line[name])) ++name;
  if (name > at && name < line.size() && line[name] == '[') at = skip(line, name);
  std::size_t end = at;
  while (at < line.size() && !is_letter(line[at]) && line[at] != '(' && line[at] != ';' &&
         line[at] != '%') {
    const bool blank = is_blank(line[at]);
    at = line[at] == '#' || line[at] == '/' ? at + 1 : skip(line, at);
    if (!blank) end = at;
  }
  return end;
}

std::optional<double> plain_number(std::string_view text) {
  std::string digits;
  for (const char c : text)
    if (!is_blank(c)) digits += c;
  return parse_number(digits);
}

}  // namespace

std::optional<SourceSpan> find_word(const SourceSpan& block, char letter,
                                    std::optional<double> number) {
  if (!block) return std::nullopt;
  const std::string_view line = block.covered();
  for (std::size_t at = 0; at < line.size();) {
    if (!is_letter(line[at])) {
      at = skip(line, at);
      continue;
    }
    const std::size_t end = std::max(value_end(line, at + 1), at + 1);
    if (std::toupper(static_cast<unsigned char>(line[at])) == letter) {
      const auto value = plain_number(line.substr(at + 1, end - at - 1));
      if (!number || (value && std::abs(*value - *number) < 1e-4)) {
        SourceSpan word = block;
        word.begin += at;
        word.length = static_cast<std::uint32_t>(end - at);
        return word;
      }
    }
    at = end;
  }
  return std::nullopt;
}

SourceSpan word_in(const SourceSpan& block, char letter, std::optional<double> number) {
  return find_word(block, letter, number).value_or(block);
}

SourceSpan trimmed(const SourceSpan& place) {
  SourceSpan out = place;
  const std::string_view text = place ? place.covered() : std::string_view();
  const std::size_t blanks = std::min(text.find_first_not_of(" \t"), text.size());
  out.begin += blanks;
  out.length -= static_cast<std::uint32_t>(blanks);
  return out;
}

SourceSpan line_of(const SourceSpan& place) {
  if (!place) return place;
  const std::string_view line = place.line_text();
  SourceSpan whole = place;
  whole.begin = static_cast<std::uint64_t>(line.data() - place.text->content().data());
  whole.length = static_cast<std::uint32_t>(line.size());
  return whole;
}

}  // namespace aircut::semantics
