// The file of parameters that outlive a program: `number value` per line, in ascending order.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "base/text.h"
#include "interp/interp.h"
#include "interp/lexer.h"
#include "interp/parameters.h"

namespace aircut::interp {
namespace {

struct VarLine {
  int number = 0;
  double value = 0;
  bool whole = true;  ///< nothing but blanks behind the value
};

// The control takes an integer, then a number in C's notation, and looks at nothing behind it.
template <typename T>
bool take(std::string_view& line, T& value) {
  line.remove_prefix(std::min(line.find_first_not_of(" \t\r"), line.size()));
  if (line.starts_with('+') && !line.starts_with("+-")) line.remove_prefix(1);
  const auto done = std::from_chars(line.data(), line.data() + line.size(), value);
  if (done.ec != std::errc()) return false;
  line.remove_prefix(static_cast<std::size_t>(done.ptr - line.data()));
  return true;
}

std::optional<VarLine> read_line(std::string_view line) {
  VarLine out;
  if (!take(line, out.number) || !take(line, out.value) || !std::isfinite(out.value))
    return std::nullopt;
  out.whole = line.find_first_not_of(" \t\r") == std::string_view::npos;
  return out;
}

}  // namespace

ParameterFile read_var(const SourceText& text, Diagnostics& out) {
  ParameterFile file;
  const std::string_view content = text.content();
  std::uint32_t line_number = 0;
  int last = 0;
  for (std::uint64_t at = 0; at < content.size();) {
    const LineExtent extent = find_line_end(content, at);
    std::string_view line = content.substr(at, extent.end - at);
    SourceSpan span;
    span.text = &text;
    span.begin = at;
    span.length = static_cast<std::uint32_t>(line.size());
    span.line = ++line_number;
    at = extent.next;
    const bool blank = line.find_first_not_of(" \t\r") == std::string_view::npos;
    if (blank) continue;
    const auto read = read_line(line);
    if (!read) {
      out.warning("parameter_line", span,
                  "the control ignores this line of the parameter file; a line holds a number and "
                  "a value");
      continue;
    }
    if (!Parameters::in_range(read->number)) {
      out.error(
          "parameter_range", span,
          "there is no parameter #" + std::to_string(read->number) + "; numbers go from 1 to 5601");
      continue;
    }
    if (!read->whole)
      out.warning("parameter_line", span,
                  "the control reads #" + std::to_string(read->number) + " = " +
                      shortest(read->value) +
                      " from this line of the parameter file and ignores the rest of it");
    if (read->number <= last) {
      out.error("parameter_order", span,
                "parameter " + std::to_string(read->number) + " comes after " +
                    std::to_string(last) + "; the numbers must ascend");
      continue;
    }
    last = read->number;
    file.values[last] = read->value;
  }
  return file;
}

std::string write_var(const ParameterFile& parameters) {
  std::string text;
  for (const auto& [number, value] : parameters.values)
    text += std::to_string(number) + "\t" + fixed(value, 6) + "\n";
  return text;
}

}  // namespace aircut::interp
