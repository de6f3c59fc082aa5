// Rows of Fanuc-like controls. Codes that act as LinuxCNC's share their handler; what differs has
// one of its own. A code without a row is refused as unknown, never skipped.
#include "interp/codes/codes.h"
#include "interp/dialect.h"

namespace aircut::interp {
namespace {

using G = ModalGroup;
using P = Phase;
constexpr AxisUse none = AxisUse::none, motion = AxisUse::motion;

// clang-format off
constexpr CodeRule common[] = {
    {'G',   0, G::motion,        P::motion,        motion, "",      rapid},
    {'G',  10, G::motion,        P::motion,        motion, "",      linear_feed},
    {'G',  20, G::motion,        P::motion,        motion, "IJKR",  arc},
    {'G',  30, G::motion,        P::motion,        motion, "IJKR",  arc},
    {'G', 170, G::plane,         P::plane,         none,   "",      select_plane},
    {'G', 180, G::plane,         P::plane,         none,   "",      select_plane},
    {'G', 190, G::plane,         P::plane,         none,   "",      select_plane},
    {'G', 200, G::unit,          P::unit,          none,   "",      select_unit},
    {'G', 210, G::unit,          P::unit,          none,   "",      select_unit},
    {'G', 400, G::radius_comp,   P::radius_comp,   none,   "",      radius_comp_off},
    {'G', 410, G::radius_comp,   P::radius_comp,   none,   "D",     radius_comp_on},
    {'G', 420, G::radius_comp,   P::radius_comp,   none,   "D",     radius_comp_on},
    {'G', 530, G::non_modal,     P::non_modal,     none,   "",      machine_coordinates},
    {'G', 540, G::work_system,   P::work_system,   none,   "",      work_system},
    {'G', 550, G::work_system,   P::work_system,   none,   "",      work_system},
    {'G', 560, G::work_system,   P::work_system,   none,   "",      work_system},
    {'G', 570, G::work_system,   P::work_system,   none,   "",      work_system},
    {'G', 580, G::work_system,   P::work_system,   none,   "",      work_system},
    {'G', 590, G::work_system,   P::work_system,   none,   "",      work_system},
    {'G', 610, G::control,       P::control,       none,   "",      path_mode},
    {'G', 640, G::control,       P::control,       none,   "",      path_mode},
    {'G', 800, G::motion,        P::motion,        none,   "",      cancel_motion},
    {'G', 970, G::spindle_mode,  P::spindle_mode,  none,   "",      spindle_mode},
    {'M',   0, G::stop,          P::stop,          none,   "",      program_stop},
    {'M',   1, G::stop,          P::stop,          none,   "",      program_stop},
    {'M',   2, G::stop,          P::stop,          none,   "",      program_end},
    {'M',  30, G::stop,          P::stop,          none,   "",      program_end},
    {'G', 650, G::macro_call,    P::stop,          none,   "PL",    call_macro},
    {'G', 660, G::macro_call,    P::stop,          none,   "PL",    call_macro},
    {'G', 661, G::macro_call,    P::stop,          none,   "PL",    nullptr},
    {'G', 670, G::macro_call,    P::stop,          none,   "",      end_modal_macro},
    {'M',  98, G::stop,          P::stop,          none,   "PL",    call_program},
    {'M', 198, G::stop,          P::stop,          none,   "PL",    call_program},
    {'M',  99, G::stop,          P::stop,          none,   "P",     return_from_program},
    {'M',   3, G::spindle,       P::spindle,       none,   "",      spindle_turn},
    {'M',   4, G::spindle,       P::spindle,       none,   "",      spindle_turn},
    {'M',   5, G::spindle,       P::spindle,       none,   "",      spindle_turn},
    {'M',   7, G::coolant,       P::coolant,       none,   "",      coolant},
    {'M',   8, G::coolant,       P::coolant,       none,   "",      coolant},
    {'M',   9, G::coolant,       P::coolant,       none,   "",      coolant},
};

constexpr CodeRule mill[] = {
    {'G', 490, G::length_offset, P::length_offset, none,   "",      length_offset},
    {'G', 900, G::distance,      P::distance,      none,   "",      distance_mode},
    {'G', 910, G::distance,      P::distance,      none,   "",      distance_mode},
    {'G', 940, G::feed_mode,     P::feed_mode,     none,   "",      feed_mode},
    {'G', 950, G::feed_mode,     P::feed_mode,     none,   "",      feed_mode},
    {'G', 980, G::retract,       P::retract,       none,   "",      retract_mode},
    {'G', 990, G::retract,       P::retract,       none,   "",      retract_mode},
    {'M',   6, G::tool,          P::tool_change,   none,   "",      change_tool},
};
// clang-format on

}  // namespace

std::span<const CodeRule> fanuc_rows() { return common; }
std::span<const CodeRule> fanuc_mill_rows() { return mill; }
std::span<const CodeRule> fanuc_lathe_rows() { return {}; }

}  // namespace aircut::interp
