#include "interp/offset_memory.h"

namespace aircut::interp {

OffsetMemory::OffsetMemory(const tool::ToolTable& tools) {
  for (const tool::Tool& tool : tools.tools) {
    if (tool.number < 1 || tool.number > max_tool) continue;
    ToolOffset& row = tools_[tool.number];
    row.geometry = tool.offset;
    row.radius = tool.diameter / 2;
    row.orientation = tool.orientation;
  }
}

bool OffsetMemory::has_system(int system) {
  return (system >= common && system <= 6) ||
         (system > extended && system <= extended + max_extended);
}

const ToolOffset* OffsetMemory::tool(int number) const {
  const auto found = tools_.find(number);
  return found == tools_.end() ? nullptr : &found->second;
}

}  // namespace aircut::interp
