#include "cli/rows.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "cli/exit_code.h"
#include "cli/job.h"

namespace aircut::cli {

namespace {

// 12 significant digits, the same in every locale.
std::string digits12(double value) {
  char text[32];
  if (value == 0) value = 0;  // minus zero loses its sign
  const auto end =
      std::to_chars(text, text + sizeof text, value, std::chars_format::general, 12).ptr;
  return std::string(text, end);
}

bool is_separator(char c) { return c == ' ' || c == '\t' || c == ',' || c == '\r'; }

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t i = 0; i < line.size();) {
    if (is_separator(line[i])) {
      ++i;
      continue;
    }
    std::size_t end = i;
    while (end < line.size() && !is_separator(line[end])) ++end;
    words.push_back(line.substr(i, end - i));
    i = end;
  }
  return words;
}

char upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

bool same_name(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return upper(x) == upper(y); });
}

}  // namespace

std::string text_of(const Row& row) {
  std::string line;
  for (const double value : row) line += (line.empty() ? "" : " ") + digits12(value);
  return line;
}

std::string text_of_all(const std::vector<Row>& rows) {
  std::string line;
  for (const Row& row : rows) line += (line.empty() ? "" : " ; ") + text_of(row);
  return line;
}

std::optional<double> number_of(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

std::string names_of(const std::vector<Column>& columns) {
  std::string names;
  for (const Column& column : columns) names += (names.empty() ? "" : " ") + column.name;
  return printable(names);
}

namespace {

// `B30`, or `S1=30` for names that are longer than a letter. Returns the column.
tl::expected<std::pair<std::size_t, double>, std::string> named_value(
    std::string_view word, const std::vector<Column>& columns) {
  const std::size_t equals = word.find('=');
  const std::string_view name = word.substr(0, equals == word.npos ? 1 : equals);
  const auto value = number_of(word.substr(equals == word.npos ? 1 : equals + 1));
  for (std::size_t i = 0; i < columns.size() && value; ++i)
    if (same_name(columns[i].name, name)) return std::pair(i, *value);
  return unexpected("'" + printable(word) + "' is neither a number nor one of the words " +
                    names_of(columns) + " with a number, like " + printable(columns[0].name) +
                    (columns[0].name.size() == 1 ? "" : "=") + "12.5");
}

}  // namespace

RowOrReason read_row(std::string_view line, const std::vector<Column>& columns) {
  const std::vector<std::string_view> words = words_of(line);
  Row row(columns.size());
  std::vector<bool> given(columns.size(), false);
  std::size_t plain = 0;
  for (const std::string_view word : words) {
    if (const auto value = number_of(word)) {
      if (plain < columns.size()) row[plain] = *value;
      ++plain;
      continue;
    }
    const auto named = named_value(word, columns);
    if (!named) return unexpected(named.error());
    if (given[named->first])
      return unexpected("'" + printable(columns[named->first].name) + "' is given twice");
    given[named->first] = true;
    row[named->first] = named->second;
  }
  if (plain == words.size() && plain != columns.size())
    return unexpected("a row needs " + std::to_string(columns.size()) + " numbers (" +
                      names_of(columns) + "), this one has " + std::to_string(plain));
  if (plain == words.size()) return row;
  if (plain > 0)
    return unexpected("a row has either plain numbers or words with names, this one has both");
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (!given[i]) return unexpected("'" + printable(columns[i].name) + "' is missing");
  return row;
}

int answer_rows(std::string_view text, const std::string& wanted, When color,
                const std::function<TextOrReason(std::string_view line)>& answer) {
  if (text.empty()) {
    print_error(make_error("input", "no rows on standard input; a row is " + wanted), color);
    return code(ExitCode::unknown);
  }
  bool good = true;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const TextOrReason out = answer(text.substr(0, end));
    text = end == text.npos ? std::string_view() : text.substr(end + 1);
    good = good && out.has_value();
    if (out)
      std::puts(out->c_str());
    else
      std::printf("error: %s\n", out.error().c_str());
  }
  return code(good ? ExitCode::pass : ExitCode::fail);
}

}  // namespace aircut::cli
