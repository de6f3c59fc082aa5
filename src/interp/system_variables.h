// The system variables of Fanuc-like controls that show positions and offsets. Values are in the
// unit in force (G20, G21) and degrees; X of a lathe as a diameter.
#pragma once

#include <optional>

#include "interp/offset_memory.h"
#include "interp/state.h"

namespace aircut::interp {

class BlockRun;
struct Session;

/// The value of variable `n`, or nothing when `n` shows no position or offset. A tool offset that
/// nobody has set reads 0.
std::optional<double> offset_variable(int n, const Session& session, const ModalState& state);

enum class VariableWrite : unsigned char { done, read_only, not_an_offset };
/// Sets an offset; what is in force changes at once, and no axis moves.
VariableWrite set_offset_variable(int n, double value, BlockRun& run);

/// The first variable of a work system (see OffsetMemory::system).
int system_variable_of(int system);

}  // namespace aircut::interp
