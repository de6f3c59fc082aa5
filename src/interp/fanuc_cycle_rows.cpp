// Rows of the cycles of Fanuc-like controls.
#include "interp/codes/codes.h"
#include "interp/dialect.h"

namespace aircut::interp {
namespace {

using G = ModalGroup;
using P = Phase;
constexpr AxisUse none = AxisUse::none, motion = AxisUse::motion, own = AxisUse::own;

// clang-format off
constexpr CodeRule mill[] = {
    {'G', 730, G::motion,        P::motion,        motion, "RQPKL",   fanuc_cycle},
    {'G', 740, G::motion,        P::motion,        motion, "RQPKL",   fanuc_cycle},
    {'G', 760, G::motion,        P::motion,        motion, "RQPKLIJ", fanuc_cycle},
    {'G', 810, G::motion,        P::motion,        motion, "RKL",     fanuc_cycle},
    {'G', 820, G::motion,        P::motion,        motion, "RPKL",    fanuc_cycle},
    {'G', 830, G::motion,        P::motion,        motion, "RQPKL",   fanuc_cycle},
    {'G', 840, G::motion,        P::motion,        motion, "RQPKL",   fanuc_cycle},
    {'G', 842, G::motion,        P::motion,        motion, "RPKL",    fanuc_cycle},
    {'G', 843, G::motion,        P::motion,        motion, "RPKL",    fanuc_cycle},
    {'G', 850, G::motion,        P::motion,        motion, "RKL",     fanuc_cycle},
    {'G', 860, G::motion,        P::motion,        motion, "RKL",     fanuc_cycle},
    {'G', 870, G::motion,        P::motion,        motion, "RQPKLIJ", fanuc_cycle},
    {'G', 880, G::motion,        P::motion,        motion, "RPKL",    manual_cycle},
    {'G', 890, G::motion,        P::motion,        motion, "RPKL",    fanuc_cycle},
    {'M',  29, G::user,          P::spindle,       none,   "",        rigid_tapping},
};

constexpr CodeRule lathe[] = {
    {'G', 320, G::motion,        P::motion,        motion, "QR",      lathe_thread},
    {'G', 330, G::motion,        P::motion,        motion, "QR",      lathe_thread},
    {'G', 340, G::motion,        P::motion,        motion, "K",       nullptr},
    {'G', 500, G::non_modal,     P::non_modal,     own,    "",        speed_limit},
    {'G', 700, G::non_modal,     P::non_modal,     own,    "PQ",      lathe_roughing},
    {'G', 710, G::non_modal,     P::non_modal,     own,    "PQRD",    lathe_roughing},
    {'G', 720, G::non_modal,     P::non_modal,     own,    "PQRD",    lathe_roughing},
    {'G', 730, G::non_modal,     P::non_modal,     own,    "PQR",     lathe_roughing},
    {'G', 740, G::non_modal,     P::non_modal,     own,    "PQR",     lathe_groove},
    {'G', 750, G::non_modal,     P::non_modal,     own,    "PQR",     lathe_groove},
    {'G', 760, G::non_modal,     P::non_modal,     own,    "PQRKDIA", lathe_thread_cycle},
    {'G', 900, G::motion,        P::motion,        motion, "R",       single_pass},
    {'G', 920, G::motion,        P::motion,        motion, "R",       single_pass},
    {'G', 940, G::motion,        P::motion,        motion, "R",       single_pass},
    {'G', 960, G::spindle_mode,  P::spindle_mode,  none,   "",        lathe_surface_speed},
    {'G', 980, G::feed_mode,     P::feed_mode,     none,   "",        lathe_feed_mode},
    {'G', 990, G::feed_mode,     P::feed_mode,     none,   "",        lathe_feed_mode},
};

constexpr CodeRule haas_mill[] = {
    {'G', 120, G::non_modal,     P::non_modal,     own,    "DIKQL",   circular_pocket},
    {'G', 130, G::non_modal,     P::non_modal,     own,    "DIKQL",   circular_pocket},
    {'G', 700, G::non_modal,     P::non_modal,     own,    "IJL",     hole_pattern},
    {'G', 710, G::non_modal,     P::non_modal,     own,    "IJKL",    hole_pattern},
    {'G', 720, G::non_modal,     P::non_modal,     own,    "IJL",     hole_pattern},
    {'G', 730, G::motion,        P::motion,        motion, "RQPLIJK", fanuc_cycle},
    {'G', 740, G::motion,        P::motion,        motion, "RLJ",     fanuc_cycle},
    {'G', 770, G::motion,        P::motion,        motion, "RQPLIJ",  fanuc_cycle},
    {'G', 830, G::motion,        P::motion,        motion, "RQPLIJK", fanuc_cycle},
    {'G', 840, G::motion,        P::motion,        motion, "RLJ",     fanuc_cycle},
    {'G', 1500, G::non_modal,    P::non_modal,     own,    "PQRIJKDL", general_pocket},
    {'G', 1840, G::motion,       P::motion,        motion, "RLJ",     fanuc_cycle},
};
// clang-format on

}  // namespace

std::span<const CodeRule> fanuc_mill_cycle_rows() { return mill; }
std::span<const CodeRule> fanuc_lathe_cycle_rows() { return lathe; }
std::span<const CodeRule> haas_mill_cycle_rows() { return haas_mill; }

}  // namespace aircut::interp
