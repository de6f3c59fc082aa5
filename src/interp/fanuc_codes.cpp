// Rows of Fanuc-like controls. Codes that act as LinuxCNC's share their handler; what differs has
// one of its own. A code without a row is refused as unknown, never skipped.
#include <array>

#include "interp/codes/codes.h"
#include "interp/dialect.h"

namespace aircut::interp {
namespace {

using G = ModalGroup;
using P = Phase;
constexpr AxisUse none = AxisUse::none, motion = AxisUse::motion, own = AxisUse::own;

// clang-format off
constexpr CodeRule common[] = {
    {'G',   0, G::motion,        P::motion,        motion, "",      rapid},
    {'G',  10, G::motion,        P::motion,        motion, "rc",    linear_feed},
    {'G',  20, G::motion,        P::motion,        motion, "IJKRrc", arc},
    {'G',  30, G::motion,        P::motion,        motion, "IJKRrc", arc},
    {'G', 170, G::plane,         P::plane,         none,   "",      select_plane},
    {'G', 180, G::plane,         P::plane,         none,   "",      select_plane},
    {'G', 190, G::plane,         P::plane,         none,   "",      select_plane},
    {'G', 200, G::unit,          P::unit,          none,   "",      select_unit},
    {'G', 210, G::unit,          P::unit,          none,   "",      select_unit},
    {'G', 400, G::radius_comp,   P::radius_comp,   none,   "",      radius_comp_off},
    {'G', 410, G::radius_comp,    P::radius_comp,    none,   "D",     fanuc_radius_comp},
    {'G', 420, G::radius_comp,    P::radius_comp,    none,   "D",     fanuc_radius_comp},
    {'G', 530, G::non_modal,      P::non_modal,      own,    "",      fanuc_machine_coordinates},
    {'G', 540, G::work_system,    P::work_system,    none,   "P",     fanuc_work_system},
    {'G', 550, G::work_system,    P::work_system,    none,   "",      fanuc_work_system},
    {'G', 560, G::work_system,    P::work_system,    none,   "",      fanuc_work_system},
    {'G', 570, G::work_system,    P::work_system,    none,   "",      fanuc_work_system},
    {'G', 580, G::work_system,    P::work_system,    none,   "",      fanuc_work_system},
    {'G', 590, G::work_system,    P::work_system,    none,   "",      fanuc_work_system},
    {'G', 610, G::control,        P::control,        none,   "",      fanuc_path_mode},
    {'G', 620, G::control,        P::control,        none,   "",      fanuc_path_mode},
    {'G', 630, G::control,        P::control,        none,   "",      fanuc_path_mode},
    {'G', 640, G::control,        P::control,        none,   "",      fanuc_path_mode},
    {'G',  40, G::non_modal,      P::dwell,          own,    "P",     fanuc_dwell},
    {'G',  90, G::free,           P::control,        none,   "",      accepted},
    {'G', 100, G::non_modal,      P::non_modal,      own,    "LPRQ",  fanuc_data},
    {'G', 110, G::free,           P::non_modal,      none,   "",      data_end},
    {'G', 270, G::non_modal,      P::non_modal,      own,    "",      check_home},
    {'G', 280, G::non_modal,      P::non_modal,      own,    "",      fanuc_home},
    {'G', 290, G::non_modal,      P::non_modal,      own,    "",      return_from_home},
    {'G', 300, G::non_modal,      P::non_modal,      own,    "P",     fanuc_home},
    {'G', 310, G::non_modal,      P::non_modal,      own,    "P",     skip_move},
    {'G', 520, G::non_modal,      P::non_modal,      own,    "",      local_shift},
    {'G', 541, G::work_system,    P::work_system,    none,   "P",     fanuc_work_system},
    // They move nothing, and are not modelled.
    {'G',  51, G::free,           P::control,        none,   "PQR",   accepted},
    {'G',  80, G::free,           P::control,        none,   "P",     accepted},
    {'G', 131, G::free,           P::control,        none,   "",      accepted},
    {'G', 220, G::free,           P::control,        own,    "IJK",   accepted},
    {'G', 230, G::free,           P::control,        none,   "",      accepted},
    {'G', 250, G::free,           P::control,        none,   "",      accepted},
    {'G', 260, G::free,           P::control,        none,   "PQR",   accepted},
    {'G', 1130, G::free,           P::control,        none,   "",      accepted},
    {'G', 800, G::motion,        P::motion,        none,   "",      cancel_motion},
    {'G', 970, G::spindle_mode,  P::spindle_mode,  none,   "",      spindle_mode},
    // They move, or change moves, and are not modelled: the line is refused.
    {'G',  50, G::free,          P::non_modal,     own,    "",      nullptr},
    {'G',  54, G::free,          P::non_modal,     own,    "",      nullptr},
    {'G',  61, G::free,          P::non_modal,     own,    "",      nullptr},
    {'G',  62, G::free,          P::non_modal,     own,    "",      nullptr},
    {'G',  71, G::free,          P::non_modal,     own,    "",      nullptr},
    {'G', 121, G::free,          P::non_modal,     own,    "",      nullptr},
    {'G', 532, G::free,          P::non_modal,     own,    "",      nullptr},
    {'G', 1070, G::free,          P::non_modal,     own,    "",      nullptr},
    {'G', 1120, G::free,          P::non_modal,     own,    "",      nullptr},
    {'M',   0, G::stop,          P::stop,          none,   "",      program_stop},
    {'M',   1, G::stop,          P::stop,          none,   "",      program_stop},
    {'G', 650, G::macro_call,    P::stop,          none,   "PL",    call_macro},
    {'G', 660, G::macro_call,    P::stop,          none,   "PL",    call_macro},
    {'G', 661, G::macro_call,    P::stop,          none,   "PL",    call_macro_per_block},
    {'G', 670, G::macro_call,    P::stop,          none,   "",      end_modal_macro},
    {'M',  98, G::stop,          P::stop,          none,   "PL",    call_program},
    {'M', 198, G::stop,          P::stop,          none,   "PL",    call_program},
    {'M',  99, G::stop,          P::stop,          none,   "P",     return_from_program},
    {'M',   2, G::stop,           P::stop,           none,   "",      fanuc_end},
    {'M',  30, G::stop,           P::stop,           none,   "",      fanuc_end},
    {'M',   3, G::spindle,       P::spindle,       none,   "",      spindle_turn},
    {'M',   4, G::spindle,       P::spindle,       none,   "",      spindle_turn},
    {'M',   5, G::spindle,       P::spindle,       none,   "",      spindle_turn},
    {'M',  19, G::spindle,        P::spindle,        none,   "PRS",   fanuc_orient},
    {'M',  48, G::override_,      P::override_,      none,   "",      override_switch},
    {'M',  49, G::override_,      P::override_,      none,   "",      override_switch},
    {'M',   7, G::coolant,       P::coolant,       none,   "",      coolant},
    {'M',   8, G::coolant,       P::coolant,       none,   "",      coolant},
    {'M',   9, G::coolant,       P::coolant,       none,   "",      coolant},
};

constexpr CodeRule mill[] = {
    {'G', 500, G::scaling,       P::non_modal,     none,   "",      scaling},
    {'G', 510, G::scaling,       P::non_modal,     own,    "PIJK",  scaling},
    {'G', 501, G::mirror,        P::non_modal,     own,    "",      mirror_image},
    {'G', 511, G::mirror,        P::non_modal,     own,    "",      mirror_image},
    {'G', 680, G::turning,       P::non_modal,     own,    "RIJK",  rotation_on},
    {'G', 690, G::turning,       P::non_modal,     none,   "",      rotation_off},
    {'G', 430, G::length_offset,  P::length_offset,  none,   "H",     fanuc_length_offset},
    {'G', 440, G::length_offset,  P::length_offset,  none,   "H",     fanuc_length_offset},
    {'G', 490, G::length_offset,  P::length_offset,  none,   "",      fanuc_length_offset},
    {'G', 434, G::length_offset,  P::length_offset,  none,   "H",     fanuc_length_offset},
    {'G', 920, G::non_modal,      P::non_modal,      own,    "",      coordinate_shift},
    {'G', 921, G::non_modal,      P::non_modal,      own,    "",      preset_work_system},
    {'G', 150, G::polar,          P::non_modal,      none,   "",      polar_mode},
    {'G', 160, G::polar,          P::non_modal,      none,   "",      polar_mode},
    {'G', 401, G::free,           P::control,        none,   "",      accepted},
    // Refused, as above.
    {'G',  21, G::free,          P::non_modal,     own,    "",      nullptr},
    {'G',  31, G::free,          P::non_modal,     own,    "",      nullptr},
    {'G',  24, G::free,          P::non_modal,     own,    "",      nullptr},
    {'G',  34, G::free,          P::non_modal,     own,    "",      nullptr},
    {'G', 330, G::free,          P::non_modal,     own,    "",      nullptr},
    {'G', 370, G::free,          P::non_modal,     own,    "",      nullptr},
    {'G', 412, G::free,          P::non_modal,     own,    "",      nullptr},
    {'G', 422, G::free,          P::non_modal,     own,    "",      nullptr},
    {'G', 431, G::free,          P::non_modal,     own,    "",      nullptr},
    {'G', 435, G::free,          P::non_modal,     own,    "",      nullptr},
    {'G', 450, G::free,          P::non_modal,     own,    "",      nullptr},
    {'G', 460, G::free,          P::non_modal,     own,    "",      nullptr},
    {'G', 470, G::free,          P::non_modal,     own,    "",      nullptr},
    {'G', 480, G::free,          P::non_modal,     own,    "",      nullptr},
    {'G', 512, G::free,          P::non_modal,     own,    "",      nullptr},
    {'G', 531, G::free,          P::non_modal,     own,    "",      nullptr},
    {'G', 533, G::free,          P::non_modal,     own,    "",      nullptr},
    {'G', 600, G::free,          P::non_modal,     own,    "",      nullptr},
    {'G', 681, G::free,          P::non_modal,     own,    "",      nullptr},
    {'G', 682, G::free,          P::non_modal,     own,    "",      nullptr},
    {'G', 683, G::free,          P::non_modal,     own,    "",      nullptr},
    {'G', 684, G::free,          P::non_modal,     own,    "",      nullptr},
    {'G', 721, G::free,          P::non_modal,     own,    "",      nullptr},
    {'G', 900, G::distance,      P::distance,      none,   "",      distance_mode},
    {'G', 910, G::distance,      P::distance,      none,   "",      distance_mode},
    {'G', 940, G::feed_mode,     P::feed_mode,     none,   "",      feed_mode},
    {'G', 950, G::feed_mode,     P::feed_mode,     none,   "",      feed_mode},
    {'G', 980, G::retract,       P::retract,       none,   "",      retract_mode},
    {'G', 990, G::retract,       P::retract,       none,   "",      retract_mode},
    {'M',   6, G::tool,          P::tool_change,   none,   "",      fanuc_change_tool},
};

constexpr CodeRule lathe[] = {
    {'G',  10, G::motion,        P::motion,        motion, "rcaRIK", linear_feed},
    {'G', 503, G::non_modal,     P::non_modal,     own,    "",      preset_work_system},
    // They move, or change moves, and are not modelled: the line is refused.
    {'G', 360, G::free,          P::non_modal,     own,    "",      nullptr},
    {'G', 370, G::free,          P::non_modal,     own,    "",      nullptr},
    {'G', 512, G::free,          P::non_modal,     own,    "",      nullptr},
    {'G', 680, G::free,          P::non_modal,     own,    "",      nullptr},
    {'G', 681, G::free,          P::non_modal,     own,    "",      nullptr},
};
// clang-format on

// What no other row knows among M-codes is the builder's.
constexpr auto builder = [] {
  std::array<CodeRule, 1000> rows{};
  for (std::size_t i = 0; i < rows.size(); ++i)
    rows[i] = {'M', static_cast<std::int16_t>(i), G::free, P::user, none, "PQR", builder_code};
  return rows;
}();

}  // namespace

std::span<const CodeRule> builder_rows() { return builder; }

std::span<const CodeRule> fanuc_rows() { return common; }
std::span<const CodeRule> fanuc_mill_rows() { return mill; }
std::span<const CodeRule> fanuc_lathe_rows() { return lathe; }

}  // namespace aircut::interp
