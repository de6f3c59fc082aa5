#include "tool/tool.h"

#include <filesystem>

namespace aircut::tool {

const Tool* ToolTable::find(int number) const {
  for (const Tool& tool : tools)
    if (tool.number == number) return &tool;
  return nullptr;
}

Expected<ToolTable> read_tools(const std::string& path, double unit_mm, SourceMap& sources,
                               Diagnostics& out) {
  const std::filesystem::path file(path);
  const auto text = sources.open(path);
  if (!text) {
    out.add(text.error());
    return unexpected(text.error());
  }
  const std::string extension = file.extension().string();
  if (extension == ".tbl") return read_tbl(**text, unit_mm, out);
  if (extension == ".toml") {
    const SourceReader holders = [&](const std::string& name) {
      return sources.open((file.parent_path() / "holders" / (name + ".toml")).string());
    };
    return read_toml(**text, holders, out);
  }
  if (extension == ".json") return read_fusion(**text, out);
  if (extension == ".fctb") return read_fctb(**text, 1, out);
  if (extension == ".fctl") {
    // FreeCAD keeps libraries in Library/ and their tools in Bit/ beside it.
    const SourceReader tools = [&](const std::string& name) {
      auto beside = sources.open((file.parent_path() / name).string());
      if (beside) return beside;
      auto bit = sources.open((file.parent_path().parent_path() / "Bit" / name).string());
      return bit ? bit : beside;
    };
    return read_fctl(**text, tools, out);
  }
  const Diagnostic error = make_error(
      "tools_invalid", "'" + printable(path) +
                           "' is no tool table: its name must end in .tbl, .toml, .json (Fusion), "
                           ".fctl or .fctb (FreeCAD)");
  out.add(error);
  return unexpected(error);
}

}  // namespace aircut::tool
