// Rows in which Haas controls differ from Fanuc's.
#include "interp/dialect.h"

namespace aircut::interp {

std::span<const CodeRule> haas_rows() { return {}; }
std::span<const CodeRule> haas_mill_rows() { return {}; }
std::span<const CodeRule> haas_lathe_rows() { return {}; }

}  // namespace aircut::interp
