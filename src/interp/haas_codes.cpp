// Rows in which Haas controls differ from Fanuc's.
#include "interp/codes/codes.h"
#include "interp/dialect.h"

namespace aircut::interp {
namespace {

using G = ModalGroup;
using P = Phase;
constexpr AxisUse none = AxisUse::none;

// clang-format off
constexpr CodeRule common[] = {
    {'M',  97, G::stop,          P::stop,          none,   "PL",    call_local_sub},
};
// clang-format on

}  // namespace

std::span<const CodeRule> haas_rows() { return common; }
std::span<const CodeRule> haas_mill_rows() { return {}; }
std::span<const CodeRule> haas_lathe_rows() { return {}; }

}  // namespace aircut::interp
