// The tool table of LinuxCNC: one tool per line, a letter and a number each, any order, in the
// machine's unit; what follows a semicolon names the tool.
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "tool/tool.h"

namespace aircut::tool {
namespace {

constexpr double radians_per_degree = std::numbers::pi / 180;
constexpr const char* kind = "tools_invalid";
constexpr std::string_view letters = "TPXYZABCUVWDIJQ";
constexpr int largest_number = 99'999'999;  // tool and pocket numbers

bool is_blank(char c) { return c == ' ' || c == '\t'; }
char upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// One line of the file, read from left to right.
class Line {
 public:
  Line(const SourceText& text, std::size_t begin, std::size_t end, std::uint32_t number,
       Diagnostics& out)
      : text_(text), begin_(begin), number_(number), out_(out) {
    const std::string_view all = text.content().substr(begin, end - begin);
    const std::size_t comment = all.find(';');
    line_ = all.substr(0, comment);
    if (comment != std::string_view::npos) name_ = trimmed(all.substr(comment + 1));
  }

  bool is_empty() const { return trimmed(line_).empty(); }
  std::string_view name() const { return name_; }
  SourceSpan span() const { return span(0, line_.size()); }
  void error(std::size_t at, std::size_t length, std::string message) {
    out_.error(kind, span(at, length), std::move(message));
    good_ = false;
  }
  bool good() const { return good_; }

  /// Reads all words. A word that is wrong is an error, the others are still read.
  void read() {
    for (std::size_t i = 0; i < line_.size();) {
      if (is_blank(line_[i])) {
        ++i;
        continue;
      }
      const std::size_t at = i++;
      while (i < line_.size() && !is_blank(line_[i]) && !is_letter(line_[i])) ++i;
      word(at, line_.substr(at, i - at));
    }
  }

  std::optional<double> number(char letter) const { return values_[slot(letter)]; }
  /// A whole number of 0 or more; an error otherwise.
  std::optional<int> whole(char letter, int largest) {
    const auto value = number(letter);
    if (!value) return std::nullopt;
    if (std::abs(*value - std::round(*value)) < 1e-4 && *value > -0.5 && *value < largest + 0.5)
      return static_cast<int>(std::lround(*value));
    error(places_[slot(letter)].at, places_[slot(letter)].length,
          std::string(1, letter) + " needs a whole number from 0 to " + std::to_string(largest));
    return std::nullopt;
  }
  void error_at(char letter, std::string message) {
    error(places_[slot(letter)].at, places_[slot(letter)].length, std::move(message));
  }

 private:
  struct Place {
    std::size_t at = 0, length = 0;
  };

  static bool is_letter(char c) { return upper(c) >= 'A' && upper(c) <= 'Z'; }
  static std::size_t slot(char letter) { return letters.find(letter); }
  SourceSpan span(std::size_t at, std::size_t length) const {
    return {.text = &text_,
            .begin = begin_ + at,
            .length = static_cast<std::uint32_t>(length),
            .line = number_};
  }

  void word(std::size_t at, std::string_view word) {
    const char letter = upper(word[0]);
    const std::size_t index = slot(letter);
    if (!is_letter(letter) || index == std::string_view::npos)
      return error(at, word.size(),
                   "'" + printable(word) +
                       "' has no meaning here; a tool has the words T P X Y Z A B C U V W D I J Q");
    const auto value = parse_number(word.substr(1));
    if (!value || !std::isfinite(*value))
      return error(at, word.size(),
                   "'" + printable(word) + "' needs a number after the letter, such as " +
                       std::string(1, letter) + "12.5");
    if (values_[index])
      return error(at, word.size(), std::string(1, letter) + " stands twice on this line");
    values_[index] = value;
    places_[index] = {at, word.size()};
  }

  const SourceText& text_;
  std::size_t begin_;
  std::uint32_t number_;
  Diagnostics& out_;
  std::string_view line_, name_;
  bool good_ = true;
  std::array<std::optional<double>, letters.size()> values_{};
  std::array<Place, letters.size()> places_{};
};

std::optional<Tool> read_tool(Line& line, double unit_mm) {
  line.read();
  Tool tool;
  const auto number = line.whole('T', largest_number);
  const auto pocket = line.whole('P', largest_number);
  const auto orientation = line.whole('Q', 9);
  if (line.good() && !number) line.error(0, line.span().length, "T is missing: the tool's number");
  if (line.good() && !pocket) line.error(0, line.span().length, "P is missing: the tool's pocket");
  if (number && *number == 0) line.error_at('T', "tool numbers start at 1; 0 means no tool");
  if (!line.good()) return std::nullopt;
  tool.number = *number;
  tool.pocket = *pocket;
  tool.orientation = orientation.value_or(0);
  tool.name = line.name();
  for (const Axis axis : all_axes)
    tool.offset[axis] =
        line.number(letter(axis)).value_or(0) * (is_rotary(axis) ? radians_per_degree : unit_mm);
  tool.diameter = line.number('D').value_or(0) * unit_mm;
  tool.front_angle = line.number('I').value_or(0) * radians_per_degree;
  tool.back_angle = line.number('J').value_or(0) * radians_per_degree;
  tool.span = line.span();
  return tool;
}

}  // namespace

Expected<ToolTable> read_tbl(const SourceText& text, double unit_mm, Diagnostics& out) {
  const std::size_t before = out.list().size();
  const std::size_t errors_before = out.errors();
  const std::string_view all = text.content();
  ToolTable table;
  std::set<int> numbers;
  std::uint32_t number = 0;
  for (std::size_t begin = 0; begin < all.size();) {
    std::size_t end = all.find_first_of("\r\n", begin);
    if (end == std::string_view::npos) end = all.size();
    Line line(text, begin, end, ++number, out);
    if (!line.is_empty()) {
      if (auto tool = read_tool(line, unit_mm)) {
        if (numbers.insert(tool->number).second)
          table.tools.push_back(std::move(*tool));
        else
          line.error_at('T', "tool " + std::to_string(tool->number) + " was defined before");
      }
    }
    const bool two = end + 1 < all.size() && all[end] == '\r' && all[end + 1] == '\n';
    begin = end + (two ? 2 : 1);
  }
  if (out.errors() == errors_before) return table;
  for (std::size_t i = before; i < out.list().size(); ++i)
    if (out.list()[i].severity == Severity::error) return unexpected(out.list()[i]);
  return table;
}

}  // namespace aircut::tool
