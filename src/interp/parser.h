// From the text of one line to a Block.
#pragma once

#include <optional>
#include <string_view>

#include "interp/block.h"

namespace aircut::interp {

class CodeTable;
class Parameters;

/// Fills `out` (which keeps its memory from line to line). `line` is the text without its line
/// end. The first fault is returned; the block is not to be executed then. Names of parameters are
/// interned in `parameters`.
std::optional<Fault> parse_line(std::string_view line, Parameters& parameters,
                                const CodeTable& table, Block& out);

/// An integer-valued expression in `text` without any parameter, e.g. the `[1+2]` of `o[1+2]`.
std::optional<double> constant_value(const Value& value, const Code& code);

}  // namespace aircut::interp
