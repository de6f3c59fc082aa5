// Tool tables from outside: any bytes, as tool.tbl, as tools.toml and as libraries of Fusion and
// FreeCAD. Holders and tools that they name resolve to the same bytes, so that the readers of those
// files see them too.
#include <cstddef>
#include <cstdint>
#include <string>

#include "tool/tool.h"

namespace {

/// A table that was accepted keeps what the rest of the program relies on.
void expect_sound(const aircut::tool::ToolTable& table) {
  for (const auto& tool : table.tools) {
    if (tool.number < 1 || table.find(tool.number) != &tool) __builtin_trap();
    double top = 0;
    for (const auto& piece : tool.pieces) {
      if (piece.profile.size() < 2 || piece.profile.front().z != top) __builtin_trap();
      for (const auto& p : piece.profile) {
        if (!(p.r >= 0) || !(p.z >= top)) __builtin_trap();
        top = p.z;
      }
    }
    if (!tool.pieces.empty() && !(tool.gauge_length >= top - 1e-6)) __builtin_trap();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace aircut;
  SourceMap sources;
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  const SourceText& text = sources.add("input", bytes);
  Diagnostics out;
  if (const auto table = tool::read_tbl(text, 25.4, out)) expect_sound(*table);
  const SourceReader holders = [&](const std::string&) -> Expected<const SourceText*> {
    return &text;
  };
  Diagnostics more;
  if (const auto table = tool::read_toml(text, holders, more)) expect_sound(*table);
  if (const auto table = tool::read_fusion(text, more)) expect_sound(*table);
  if (const auto table = tool::read_fctb(text, 1, more)) expect_sound(*table);
  if (const auto table = tool::read_fctl(text, holders, more)) expect_sound(*table);
  for (const Diagnostic& d : out.list()) format_human(d, {});
  for (const Diagnostic& d : more.list()) format_human(d, {});
  return 0;
}
