// Tool libraries of CAM systems: JSON with objects that describe tools in other words. Each tool is
// said again in the words of tools.toml and read by its one reader, so that all rules hold for them
// as well; what that reader says is told at the tool's place in the library. Private to tool.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tool/tool.h"

namespace aircut::tool {

using Json = nlohmann::json;

/// Parses; the error names line and column.
Expected<Json> parse_json(const SourceText& text);
/// The first line of the (valid) text.
SourceSpan head_of(const SourceText& text);
/// The list `key` of a library of tools; the error says what is wrong with the text.
Expected<Json> tool_list(const SourceText& text, const std::string& key);
/// Where the elements of the list `key` of the (valid) text begin; missing ones are at its head.
class Places {
 public:
  Places(const SourceText& text, const std::string& key);
  SourceSpan operator[](std::size_t element) const {
    return element < spans_.size() ? spans_[element] : head_;
  }

 private:
  SourceSpan head_;
  std::vector<SourceSpan> spans_;
};

/// The value of a key; null when it is missing.
const Json& at(const Json& object, const std::string& key);
/// A finite number, or a text that is one.
std::optional<double> number_at(const Json& object, const std::string& key);
std::string text_at(const Json& object, const std::string& key);

/// A tool in the words of tools.toml.
class Draft {
 public:
  Draft(int number, const std::string& name, const SourceSpan& span);
  void length(const char* key, std::optional<double> mm);
  void angle(const char* key, std::optional<double> degrees);
  void word(const char* key, const std::string& value);
  void whole(const char* key, int value);
  /// Outline of the holder from its lower face up, mm.
  void holder(const Profile& outline);
  /// The kind of cutter; without one the tool has no body.
  void kind(const std::string& kind) { kind_ = kind; }
  /// What the library does not tell of the tool's body.
  void unknown(const std::string& what) { unknown_ = what; }

  /// Errors and warnings go to `out` at the tool's place.
  std::optional<Tool> read(Diagnostics& out) const;

 private:
  int number_;
  std::string name_, kind_, lines_, holder_, unknown_;
  SourceSpan span_;
};

/// Puts a tool into a table, unless its number is there.
void add_tool(ToolTable& table, std::optional<Tool> tool, Diagnostics& out);
/// The table, or the first error of `out`.
Expected<ToolTable> finish(ToolTable table, const Diagnostics& out);

}  // namespace aircut::tool
