// The run as an animation that other programs open: glTF 2.0 in one binary file (Khronos group,
// ISO/IEC 12113).
#pragma once

#include <span>
#include <string>

#include "page/tracks.h"

namespace aircut::page {

/// Machine, tools, stock by stages and tool path, moving at the machine's own speed. glTF wants
/// metres and Y up: the scene's root turns and shrinks, everything below is in mm with Z up. Tools
/// and stages that are not there at a moment have the size 0, as glTF can't hide things.
std::string glb_bytes(const Replay& replay, std::span<const StockStage> stages);

}  // namespace aircut::page
