// The file of parameters that outlive a program: `number value` per line, in ascending order.
#include <array>
#include <cmath>

#include "base/text.h"
#include "interp/interp.h"
#include "interp/lexer.h"
#include "interp/parameters.h"

namespace aircut::interp {
namespace {

std::string_view take_field(std::string_view& line) {
  const std::size_t first = line.find_first_not_of(" \t");
  if (first == std::string_view::npos) return line = {};
  const std::size_t end = std::min(line.find_first_of(" \t", first), line.size());
  const std::string_view field = line.substr(first, end - first);
  line.remove_prefix(end);
  return field;
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
    const auto number = parse_number(take_field(line));
    const auto value = parse_number(take_field(line));
    if (!number || !value) {
      if (!blank)
        out.warning("parameter_line", span,
                    "the control ignores this line of the parameter file; a line holds a number "
                    "and a value");
      continue;
    }
    const auto index = as_integer(*number);
    if (!index || !Parameters::in_range(*index)) {
      out.error("parameter_range", span,
                "there is no parameter #" + shortest(*number) + "; numbers go from 1 to 5601");
      continue;
    }
    if (*index <= last) {
      out.error("parameter_order", span,
                "parameter " + std::to_string(*index) + " comes after " + std::to_string(last) +
                    "; the numbers must ascend");
      continue;
    }
    last = *index;
    file.values[*index] = *value;
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
