// Tools of FreeCAD: a `.fctb` is one tool, { "name", "shape": "endmill.fcstd", "parameter": {
// "Diameter": "10.0000 mm", … } }, a `.fctl` a library, { "tools": [ { "nr", "path" } ] }. They
// know of no holder; a tool stands out by `Stickout`, or else by its whole `Length`.
#include <algorithm>
#include <cmath>

#include "tool/keys.h"
#include "tool/library.h"

namespace aircut::tool {
namespace {

constexpr double most_number = 99'999'999;

struct Unit {
  const char* name;
  double mm;  ///< or degrees
};
constexpr Unit lengths[] = {{"mm", 1},    {"cm", 10},     {"m", 1000}, {"in", 25.4},
                            {"\"", 25.4}, {"inch", 25.4}, {"", 1}};
constexpr Unit angles[] = {{"°", 1}, {"deg", 1}, {"rad", 180 / std::numbers::pi}, {"", 1}};

/// "10.0000 mm" in mm, "118 °" in degrees. A text that is neither is an error.
template <std::size_t n>
std::optional<double> quantity(const Json& parameters, const char* key, const Unit (&units)[n],
                               const SourceSpan& span, Diagnostics& out) {
  const Json& value = at(parameters, key);
  if (value.is_null()) return std::nullopt;
  std::string text = value.is_number()   ? shortest(value.get<double>())
                     : value.is_string() ? value.get<std::string>()
                                         : "";
  const auto end = text.find_first_not_of("0123456789.+-");
  std::string unit = end == std::string::npos ? "" : text.substr(end);
  unit.erase(0, unit.find_first_not_of(' '));
  unit.erase(unit.find_last_not_of(' ') + 1);
  const auto number = parse_number(text.substr(0, end));
  for (const Unit& known : units)
    if (number && unit == known.name) return *number * known.mm;
  out.add(make_error(
      kind_of_errors, span,
      std::string("\"") + key + "\" is '" + printable(text) +
          "', but a number with its unit is wanted: \"10.0000 mm\", \"90 °\"" +
          (text.find(',') != std::string::npos ? "; decimals stand after a point" : "")));
  return std::nullopt;
}

std::string shape_of(const Json& json) {
  std::string shape = text_at(json, "shape");
  shape = shape.substr(shape.find_last_of("/\\") + 1);
  std::transform(shape.begin(), shape.end(), shape.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  if (shape.ends_with(".fcstd")) shape.resize(shape.size() - 6);
  return shape;
}

std::optional<Tool> read_one(const SourceText& text, int number, Diagnostics& out) {
  auto json = parse_json(text);
  if (!json) {
    out.add(json.error());
    return std::nullopt;
  }
  const SourceSpan span = head_of(text);
  const Json& parameters = at(*json, "parameter");
  if (!parameters.is_object()) {
    out.add(make_error(kind_of_errors, span, "this is no tool: \"parameter\": { … } is missing"));
    return std::nullopt;
  }
  const auto mm = [&](const char* key) { return quantity(parameters, key, lengths, span, out); };
  const auto degrees = [&](const char* key) {
    return quantity(parameters, key, angles, span, out);
  };
  Draft draft(number, text_at(*json, "name"), span);
  const std::string shape = shape_of(*json);
  const auto length = mm("Length"), stick_out = mm("Stickout");
  const auto flutes = mm("CuttingEdgeHeight");
  draft.length("diameter", mm("Diameter"));
  if (shape == "endmill" || shape == "reamer") {
    draft.kind("flat");
  } else if (shape == "ballend") {
    draft.kind("ball");
  } else if (shape == "bullnose" || shape == "torus") {
    // `FlatRadius` was taken for the flat's radius by some versions, for the corner's by others.
    if (const auto corner = mm("CornerRadius")) {
      draft.kind("bull");
      draft.length("corner_radius", corner);
    }
  } else if (shape == "drill") {
    draft.kind("drill");
    draft.angle("point_angle", degrees("TipAngle"));
  } else if (shape == "chamfer" || shape == "v-bit" || shape == "vbit") {
    draft.kind("chamfer");
    draft.angle("point_angle", degrees("CuttingEdgeAngle"));
    draft.length("tip_diameter", mm("TipDiameter"));
  }
  draft.length("flute_length", flutes ? flutes : length);
  draft.length("shank_diameter", mm("ShankDiameter"));
  draft.length("stick_out", stick_out ? stick_out : length);
  if (const auto teeth = number_at(parameters, "Flutes"); teeth && *teeth >= 1 && *teeth <= 1000)
    draft.whole("teeth", static_cast<int>(*teeth));
  if (text_at(parameters, "SpindleDirection") == "Reverse") draft.word("hand", "left");
  draft.unknown("its holder");
  return out.errors() > 0 ? std::nullopt : draft.read(out);
}

}  // namespace

Expected<ToolTable> read_fctb(const SourceText& text, int number, Diagnostics& out) {
  Diagnostics found;
  ToolTable table;
  add_tool(table, read_one(text, number, found), found);
  for (const Diagnostic& d : found.list()) out.add(d);
  return finish(std::move(table), found);
}

Expected<ToolTable> read_fctl(const SourceText& text, const SourceReader& tools, Diagnostics& out) {
  Diagnostics found;
  ToolTable table;
  const auto list = tool_list(text, "tools");
  if (!list) {
    out.add(list.error());
    return unexpected(list.error());
  }
  const Json& rows = *list;
  const Places places(text, "tools");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const SourceSpan span = places[i];
    const auto number = number_at(rows[i], "nr");
    const std::string path = text_at(rows[i], "path");
    const std::string name = path.substr(path.find_last_of("/\\") + 1);
    if (!number || *number != std::floor(*number) || *number < 1 || *number > most_number ||
        name.empty() || name.front() == '.') {
      found.add(make_error(kind_of_errors, span,
                           "a row needs \"nr\", a whole number from 1 on, and \"path\", the "
                           "name of a .fctb file"));
      continue;
    }
    const auto file = tools(name);
    if (!file) {
      found.add(
          make_error(kind_of_errors, span,
                     "tool '" + printable(name) + "' can't be read: " + file.error().message));
      continue;
    }
    Diagnostics here;
    add_tool(table, read_one(**file, static_cast<int>(*number), here), here);
    for (const Diagnostic& d : here.list()) found.add(d);
  }
  for (const Diagnostic& d : found.list()) out.add(d);
  return finish(std::move(table), found);
}

}  // namespace aircut::tool
