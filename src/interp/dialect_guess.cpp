// Which control a text was written for, from constructs that only one family reads. A line is seen
// without blanks and comments, in upper case; the first sign decides, unless a later line
// contradicts it: then the more frequent one does.
#include "interp/dialect_guess.h"

#include <array>
#include <cstdint>
#include <string>

#include "interp/dialect.h"
#include "interp/lexer.h"

namespace aircut::interp {
namespace {

constexpr std::uint64_t most_bytes = 1 << 20;  // a program shows its dialect early

bool is_digit_at(std::string_view text, std::size_t at) {
  return at < text.size() && text[at] >= '0' && text[at] <= '9';
}

bool is_letter_at(std::string_view text, std::size_t at) {
  return at < text.size() && text[at] >= 'A' && text[at] <= 'Z';
}

// Without comments, blanks, block skip and the N word at the begin.
std::string essence(std::string_view line) {
  std::string code;
  for (std::size_t at = 0; at < line.size(); ++at) {
    const char c = line[at];
    if (c == ';') break;
    if (c == '(') {
      at = line.find(')', at);
      if (at == std::string_view::npos) break;
      continue;
    }
    if (c == ' ' || c == '\t' || c == '\r') continue;
    code += c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c;
  }
  std::size_t begin = 0;
  if (begin < code.size() && code[begin] == '/') ++begin;
  if (begin < code.size() && code[begin] == 'N' && is_digit_at(code, begin + 1)) {
    ++begin;
    while (is_digit_at(code, begin)) ++begin;
  }
  return code.substr(begin);
}

// `word` with something else than a digit behind it, such as the G65 of G65P9000.
bool has_code(std::string_view code, std::string_view word) {
  for (std::size_t at = code.find(word); at != std::string_view::npos;
       at = code.find(word, at + 1)) {
    const bool whole = !is_digit_at(code, at + word.size()) && !is_letter_at(code, at - 1);
    if (whole && (at + word.size() >= code.size() || code[at + word.size()] != '.')) return true;
  }
  return false;
}

// `#1=#2+3`: an operator outside of brackets.
bool has_bare_expression(std::string_view code) {
  const std::size_t equals = code.find('=');
  if (code.empty() || code[0] != '#' || equals == std::string_view::npos) return false;
  int depth = 0;
  for (std::size_t at = equals + 1; at < code.size(); ++at) {
    const char c = code[at];
    depth += c == '[' ? 1 : c == ']' ? -1 : 0;
    const bool is_operator = c == '+' || c == '*' || c == '/' || c == '-';
    const bool sign_of_value = code[at - 1] == '=' || code[at - 1] == '[';
    if (depth == 0 && is_operator && !sign_of_value &&
        code.substr(0, at).find("ATAN") == std::string_view::npos)
      return true;
  }
  return false;
}

bool is_program_number(std::string_view code) {
  if (code.size() < 2 || (code[0] != 'O' && code[0] != ':') || !is_digit_at(code, 1)) return false;
  std::size_t at = 1;
  while (is_digit_at(code, at)) ++at;
  return at == code.size();
}

}  // namespace

DialectSign sign_of(std::string_view line, bool first) {
  const std::string code = essence(line);
  if (code.empty()) return {};
  const auto has = [&](std::string_view text) { return code.find(text) != std::string::npos; };
  if (has("#<")) return {Dialect::linuxcnc, "a named parameter (#<…>)"};
  if (code[0] == 'O' && code.size() > 1) {
    std::size_t at = 1;
    while (is_digit_at(code, at)) ++at;
    if (code[1] == '<' || code[1] == '[' || (at > 1 && is_letter_at(code, at)))
      return {Dialect::linuxcnc, "an O-word with a keyword"};
  }
  for (const char* word : {"M97", "G154", "G187", "G150"})
    if (has_code(code, word)) return {Dialect::haas, word};
  if (code[0] == ':' && is_program_number(code)) return {Dialect::fanuc, "a program number"};
  if (first && is_program_number(code)) return {Dialect::fanuc, "a program number at the top"};
  if (has("GOTO")) return {Dialect::fanuc, "GOTO"};
  if (code.starts_with("IF[")) return {Dialect::fanuc, "IF [condition]"};
  if (code.starts_with("WHILE[")) return {Dialect::fanuc, "WHILE [condition] DO"};
  for (const char* word : {"DPRNT[", "POPEN", "PCLOS", "SETVN"})
    if (code.starts_with(word)) return {Dialect::fanuc, word};
  for (const char* word : {"G65", "G66", "G67"})
    if (has_code(code, word)) return {Dialect::fanuc, word};
  if (has("G54.1P")) return {Dialect::fanuc, "G54.1 P"};
  if (has_bare_expression(code)) return {Dialect::fanuc, "an expression without brackets"};
  return {};
}

DialectGuess guess_dialect(std::string_view text) {
  struct Count {
    int signs = 0;
    std::uint32_t line = 0;
    const char* what = nullptr;
  };
  std::array<Count, 3> counts;
  std::uint32_t number = 0;
  bool first = true;
  for (std::uint64_t at = 0; at < text.size() && at < most_bytes;) {
    const LineExtent extent = find_line_end(text, at);
    const std::string_view line = text.substr(at, extent.end - at);
    at = extent.next;
    ++number;
    const DialectSign sign = sign_of(line, first);
    const std::size_t code = line.find_first_not_of(" \t\r");
    if (code != std::string_view::npos && line[code] != '(' && line[code] != '%' &&
        line[code] != ';')
      first = false;
    if (!sign.what) continue;
    Count& count = counts[static_cast<std::size_t>(*sign.dialect)];
    if (count.signs++ == 0) {
      count.line = number;
      count.what = sign.what;
    }
  }
  const Count& linuxcnc = counts[static_cast<std::size_t>(Dialect::linuxcnc)];
  const Count& fanuc = counts[static_cast<std::size_t>(Dialect::fanuc)];
  const Count& haas = counts[static_cast<std::size_t>(Dialect::haas)];
  DialectGuess guess;
  const bool macro_b = fanuc.signs + haas.signs > linuxcnc.signs;
  if (!macro_b && linuxcnc.signs == 0) return guess;
  guess.dialect = !macro_b ? Dialect::linuxcnc : haas.signs > 0 ? Dialect::haas : Dialect::fanuc;
  const Count& chosen = counts[static_cast<std::size_t>(*guess.dialect)];
  guess.line = chosen.line;
  guess.what = chosen.what;
  return guess;
}

void choose_dialect(Options& options, std::string_view text) {
  const DialectGuess guess = guess_dialect(text);
  if (guess.dialect) options.dialect = *guess.dialect;
  options.dialect_reason =
      std::string("the program is read as ") + traits_of(options.dialect).name + "'s: ";
  options.dialect_reason +=
      guess.dialect ? std::string("it has ") + guess.what + " in line " + std::to_string(guess.line)
                    : "nothing in it belongs to one control only, so the default stands";
}

}  // namespace aircut::interp
