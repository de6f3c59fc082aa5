// Rows in which Haas controls differ from Fanuc's.
#include "interp/codes/codes.h"
#include "interp/dialect.h"

namespace aircut::interp {
namespace {

using G = ModalGroup;
using P = Phase;
constexpr AxisUse none = AxisUse::none, own = AxisUse::own;

// clang-format off
constexpr CodeRule common[] = {
    {'M',  97, G::stop,          P::stop,          none,   "PL",    call_local_sub},
    {'G', 1100, G::work_system,  P::work_system,   none,   "",      fanuc_work_system},
    {'G', 1110, G::work_system,  P::work_system,   none,   "",      fanuc_work_system},
    {'G', 1120, G::work_system,  P::work_system,   none,   "",      fanuc_work_system},
    {'G', 1130, G::work_system,  P::work_system,   none,   "",      fanuc_work_system},
    {'G', 1140, G::work_system,  P::work_system,   none,   "",      fanuc_work_system},
    {'G', 1150, G::work_system,  P::work_system,   none,   "",      fanuc_work_system},
    {'G', 1160, G::work_system,  P::work_system,   none,   "",      fanuc_work_system},
    {'G', 1170, G::work_system,  P::work_system,   none,   "",      fanuc_work_system},
    {'G', 1180, G::work_system,  P::work_system,   none,   "",      fanuc_work_system},
    {'G', 1190, G::work_system,  P::work_system,   none,   "",      fanuc_work_system},
    {'G', 1200, G::work_system,  P::work_system,   none,   "",      fanuc_work_system},
    {'G', 1210, G::work_system,  P::work_system,   none,   "",      fanuc_work_system},
    {'G', 1220, G::work_system,  P::work_system,   none,   "",      fanuc_work_system},
    {'G', 1230, G::work_system,  P::work_system,   none,   "",      fanuc_work_system},
    {'G', 1240, G::work_system,  P::work_system,   none,   "",      fanuc_work_system},
    {'G', 1250, G::work_system,  P::work_system,   none,   "",      fanuc_work_system},
    {'G', 1260, G::work_system,  P::work_system,   none,   "",      fanuc_work_system},
    {'G', 1270, G::work_system,  P::work_system,   none,   "",      fanuc_work_system},
    {'G', 1280, G::work_system,  P::work_system,   none,   "",      fanuc_work_system},
    {'G', 1290, G::work_system,  P::work_system,   none,   "",      fanuc_work_system},
    {'G', 1540, G::work_system,  P::work_system,   none,   "P",     fanuc_work_system},
    {'G', 661, G::free,          P::non_modal,     none,   "PL",    nullptr},
    // They move nothing, and are not modelled.
    {'G', 1030, G::free,         P::control,       none,   "P",     accepted},
    {'G', 1870, G::free,         P::control,       none,   "PE",    accepted},
    // Brakes, conveyors, doors, jets, gears, displays: they move no axis of the program.
    {'M',  10, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M',  11, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M',  12, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M',  13, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M',  14, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M',  15, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M',  16, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M',  17, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M',  18, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M',  31, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M',  33, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M',  34, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M',  35, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M',  36, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M',  41, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M',  42, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M',  43, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M',  44, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M',  69, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M',  76, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M',  77, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M',  80, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M',  81, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M',  82, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M',  83, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M',  84, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M',  85, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M',  86, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M',  88, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M',  89, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M',  93, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M',  94, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M',  95, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M', 104, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M', 105, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M', 110, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M', 111, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M', 114, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M', 115, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M', 116, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M', 117, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M', 118, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M', 119, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M', 130, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M', 131, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M', 138, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M', 139, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M', 158, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M', 159, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M', 160, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M', 161, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M', 162, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M', 163, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M', 164, G::free,          P::user,          none,   "PQRIJK", accepted},
    {'M', 165, G::free,          P::user,          none,   "PQRIJK", accepted},
};

constexpr CodeRule mill[] = {
    {'G', 150, G::polar,         P::control,       none,   "",      accepted},
    {'G', 160, G::polar,         P::non_modal,     own,    "",      nullptr},
    {'G', 1000, G::mirror,       P::non_modal,     own,    "",      mirror_image},
    {'G', 1010, G::mirror,       P::non_modal,     own,    "",      mirror_image},
    // They move, or change moves, and are not modelled: the line is refused.
    {'G',  350, G::free,         P::non_modal,     own,    "",      nullptr},
    {'G',  360, G::free,         P::non_modal,     own,    "",      nullptr},
    {'G',  470, G::free,         P::non_modal,     own,    "",      nullptr},
    {'G', 1360, G::free,         P::non_modal,     own,    "",      nullptr},
    {'G', 1410, G::free,         P::non_modal,     own,    "",      nullptr},
    {'G', 1430, G::free,         P::non_modal,     own,    "",      nullptr},
    {'G', 1740, G::free,         P::non_modal,     own,    "",      nullptr},
    {'G', 1841, G::free,         P::non_modal,     own,    "",      nullptr},
    {'G', 2340, G::length_offset, P::length_offset, none,  "H",     fanuc_length_offset},
    {'G', 2530, G::free,         P::non_modal,     own,    "",      nullptr},
    {'G', 2540, G::free,         P::non_modal,     own,    "",      nullptr},
    {'G', 2550, G::free,         P::non_modal,     own,    "",      nullptr},
    {'G', 2680, G::free,         P::non_modal,     own,    "",      nullptr},
    {'G', 2690, G::free,         P::non_modal,     own,    "",      nullptr},
};

// Polar interpolation; on mills these are work systems.
constexpr CodeRule lathe[] = {
    {'G', 1120, G::free,         P::non_modal,     own,    "",      nullptr},
    {'G', 1130, G::free,         P::control,       none,   "",      accepted},
};
// clang-format on

}  // namespace

std::span<const CodeRule> haas_rows() { return common; }
std::span<const CodeRule> haas_mill_rows() { return mill; }
std::span<const CodeRule> haas_lathe_rows() { return lathe; }

}  // namespace aircut::interp
