#include "tool/library.h"

#include <algorithm>
#include <cmath>

#include "tool/keys.h"

namespace aircut::tool {

namespace {

constexpr std::size_t deepest = 64;
constexpr std::size_t most_tools = 10'000;

// A number as TOML wants it: a float needs a point or an exponent.
std::string toml_number(double value) {
  std::string text = shortest(value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string toml_text(const std::string& value) {
  std::string out = "\"";
  for (const char c : harmless(utf8(value))) {
    if (c == '"' || c == '\\') out += '\\';
    out += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
  }
  return out + "\"";
}

// From a byte to the end of its line.
SourceSpan span_at(const SourceText& text, std::size_t byte, std::uint64_t line) {
  const std::string_view all = text.content();
  std::size_t end = byte;
  while (end < all.size() && all[end] != '\n' && all[end] != '\r' && end - byte < 200) ++end;
  return {&text, byte, static_cast<std::uint32_t>(end - byte), line};
}

// Steps over a string; `at` is its first quote.
std::size_t after_string(std::string_view text, std::size_t at) {
  for (++at; at < text.size() && text[at] != '"'; ++at)
    if (text[at] == '\\') ++at;
  return at + 1;
}

}  // namespace

Expected<Json> parse_json(const SourceText& text) {
  std::size_t depth = 0;
  bool too_deep = false;
  const auto watch = [&](int level, Json::parse_event_t, Json&) {
    depth = std::max(depth, static_cast<std::size_t>(level));
    too_deep = too_deep || depth > deepest;
    return !too_deep;
  };
  try {
    Json json = Json::parse(text.content(), watch);
    if (!too_deep) return json;
  } catch (const Json::parse_error& error) {
    const std::string_view all = text.content();
    const std::size_t byte = std::min(error.byte > 0 ? error.byte - 1 : 0, all.size());
    const auto line =
        1 + std::count(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(byte), '\n');
    return unexpected(make_error(kind_of_errors,
                                 span_at(text, byte, static_cast<std::uint64_t>(line)),
                                 "this is no JSON from here on; a tool library begins with {"));
  } catch (const Json::exception&) {
    return unexpected(make_error(kind_of_errors, head_of(text), "this JSON can't be read"));
  }
  return unexpected(
      make_error(kind_of_errors, head_of(text), "lists and objects in this are nested too deep"));
}

SourceSpan head_of(const SourceText& text) { return span_at(text, 0, 1); }

Expected<Json> tool_list(const SourceText& text, const std::string& key) {
  auto json = parse_json(text);
  if (!json) return json;
  const Json& list = at(*json, key);
  if (!list.is_array())
    return unexpected(make_error(kind_of_errors, head_of(text),
                                 "this is no tool library: \"" + key + "\": [ … ] is missing"));
  if (list.size() > most_tools)
    return unexpected(
        make_error(kind_of_errors, head_of(text), "a tool library of more than 10 000 tools"));
  return list;
}

Places::Places(const SourceText& text, const std::string& key) : head_(head_of(text)) {
  const std::string_view all = text.content();
  std::size_t depth = 0;
  std::uint64_t line = 1;
  bool inside = false;  // of the list of that key, which is at depth 2
  for (std::size_t i = 0; i < all.size();) {
    const char c = all[i];
    if (c == '"') {
      const std::size_t end = after_string(all, i);
      if (depth == 1) inside = all.substr(i + 1, end - i - 2) == key;
      i = end;
      continue;
    }
    if (c == '\n') ++line;
    if (c == '{' || c == '[') {
      if (inside && depth == 2) spans_.push_back(span_at(text, i, line));
      ++depth;
    }
    if ((c == '}' || c == ']') && depth > 0) --depth;
    ++i;
  }
}

const Json& at(const Json& object, const std::string& key) {
  static const Json none;
  if (!object.is_object()) return none;
  const auto found = object.find(key);
  return found == object.end() ? none : *found;
}

std::optional<double> number_at(const Json& object, const std::string& key) {
  const Json& value = at(object, key);
  std::optional<double> number;
  if (value.is_number()) number = value.get<double>();
  if (value.is_string()) number = parse_number(value.get<std::string>());
  if (number && !std::isfinite(*number)) return std::nullopt;
  return number;
}

std::string text_at(const Json& object, const std::string& key) {
  const Json& value = at(object, key);
  return value.is_string() ? value.get<std::string>() : std::string();
}

Draft::Draft(int number, const std::string& name, const SourceSpan& span)
    : number_(number), name_(name), span_(span) {}

void Draft::length(const char* key, std::optional<double> mm) {
  if (mm) lines_ += std::string(key) + " = " + toml_number(*mm) + "\n";
}
void Draft::angle(const char* key, std::optional<double> degrees) { length(key, degrees); }
void Draft::word(const char* key, const std::string& value) {
  lines_ += std::string(key) + " = " + toml_text(value) + "\n";
}
void Draft::whole(const char* key, int value) {
  lines_ += std::string(key) + " = " + std::to_string(value) + "\n";
}
void Draft::holder(const Profile& outline) {
  holder_ = "schema = 1\nprofile = [";
  for (const ProfilePoint& p : outline)
    holder_ += "[" + toml_number(p.r) + ", " + toml_number(p.z) + "], ";
  holder_ += "]\n";
}

std::optional<Tool> Draft::read(Diagnostics& out) const {
  const std::string who = "tool " + std::to_string(number_) +
                          (name_.empty() ? std::string() : " \"" + printable(name_) + "\"");
  if (kind_.empty()) {
    Tool tool;
    tool.number = tool.pocket = number_;
    tool.name = harmless(utf8(name_));
    tool.span = span_;
    Diagnostic warning =
        make_error(kind_of_errors, span_, who + " is of a kind whose shape is not known here");
    warning.severity = Severity::warning;
    out.add(std::move(warning));
    return tool;
  }
  std::string toml = "schema = 1\n[[tool]]\nnumber = " + std::to_string(number_) +
                     "\nname = " + toml_text(name_) + "\nkind = " + toml_text(kind_) + "\n" +
                     lines_;
  if (!holder_.empty()) toml += "holder = \"holder\"\n";
  const SourceText text("tool", toml), holder_text("holder", holder_);
  Diagnostics found;
  auto table = read_toml(
      text, [&](const std::string&) -> Expected<const SourceText*> { return &holder_text; }, found);
  for (const Diagnostic& d : found.list()) {
    Diagnostic here = make_error(kind_of_errors, span_, who + ": " + d.message);
    here.severity = d.severity;
    out.add(std::move(here));
  }
  if (!table || table->tools.size() != 1) return std::nullopt;
  Tool tool = std::move(table->tools.front());
  tool.span = span_;
  tool.unknown = unknown_;
  return tool;
}

void add_tool(ToolTable& table, std::optional<Tool> tool, Diagnostics& out) {
  if (!tool) return;
  if (table.find(tool->number))
    return out.add(make_error(kind_of_errors, tool->span,
                              "tool " + std::to_string(tool->number) + " was defined before"));
  table.tools.push_back(std::move(*tool));
}

Expected<ToolTable> finish(ToolTable table, const Diagnostics& out) {
  for (const Diagnostic& d : out.list())
    if (d.severity == Severity::error) return unexpected(d);
  return table;
}

}  // namespace aircut::tool
