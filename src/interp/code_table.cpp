#include "interp/code_table.h"

#include <cmath>

#include "interp/codes/codes.h"
#include "interp/dialect.h"

namespace aircut::interp {
namespace {

using G = ModalGroup;
using P = Phase;
constexpr AxisUse none = AxisUse::none, motion = AxisUse::motion, own = AxisUse::own,
                  shared = AxisUse::optional;

// code: G numbers are written × 10. words: letters without axis words; F S T N need no row, $ goes
// with S. A null handler is a code of the dialect that is not implemented; a line with it is an
// `unsupported_code` error.
// clang-format off
constexpr CodeRule rows[] = {
    // motion
    {'G',   0, G::motion,        P::motion,        motion, "",      rapid},
    {'G',  10, G::motion,        P::motion,        motion, "",      linear_feed},
    {'G',  20, G::motion,        P::motion,        motion, "IJKRP", arc},
    {'G',  30, G::motion,        P::motion,        motion, "IJKRP", arc},
    {'G',  50, G::motion,        P::motion,        motion, "IJPQ",  cubic_spline},
    {'G',  51, G::motion,        P::motion,        motion, "IJ",    quadratic_spline},
    {'G',  52, G::motion,        P::motion,        motion, "PL",    nurbs_point},
    {'G',  53, G::non_modal,     P::non_modal,     none,   "",      nurbs_end},
    // of the versions after 2.9
    {'G',  60, G::motion,        P::motion,        motion, "",      nullptr},
    {'G',  61, G::motion,        P::motion,        motion, "",      nullptr},
    {'G',  62, G::motion,        P::motion,        motion, "",      nullptr},
    {'G',  63, G::non_modal,     P::non_modal,     none,   "",      nullptr},
    {'G', 330, G::motion,        P::motion,        motion, "K$",    thread},
    {'G', 331, G::motion,        P::motion,        motion, "KI$",   rigid_tap},
    {'G', 382, G::motion,        P::motion,        motion, "",      probe},
    {'G', 383, G::motion,        P::motion,        motion, "",      probe},
    {'G', 384, G::motion,        P::motion,        motion, "",      probe},
    {'G', 385, G::motion,        P::motion,        motion, "",      probe},
    {'G', 700, G::motion,        P::motion,        own,    "QDEP",  contour_turning},
    {'G', 710, G::motion,        P::motion,        own,    "QDIREP", contour_turning},
    {'G', 711, G::motion,        P::motion,        own,    "QDIREP", contour_turning},
    {'G', 712, G::motion,        P::motion,        own,    "QDIREP", contour_turning},
    {'G', 720, G::motion,        P::motion,        own,    "QDIREP", contour_turning},
    {'G', 721, G::motion,        P::motion,        own,    "QDIREP", contour_turning},
    {'G', 722, G::motion,        P::motion,        own,    "QDIREP", contour_turning},
    {'G', 730, G::motion,        P::motion,        motion, "RQLD",  canned_cycle},
    {'G', 740, G::motion,        P::motion,        motion, "RP",   canned_cycle},
    {'G', 760, G::motion,        P::motion,        motion, "PIJKRQHEL$", thread_cycle},
    {'G', 800, G::motion,        P::motion,        none,   "",      cancel_motion},
    {'G', 810, G::motion,        P::motion,        motion, "RL",    canned_cycle},
    {'G', 820, G::motion,        P::motion,        motion, "RLP",   canned_cycle},
    {'G', 830, G::motion,        P::motion,        motion, "RLQD",  canned_cycle},
    {'G', 840, G::motion,        P::motion,        motion, "RLP",   canned_cycle},
    {'G', 850, G::motion,        P::motion,        motion, "RL",    canned_cycle},
    {'G', 860, G::motion,        P::motion,        motion, "RLP",   canned_cycle},
    {'G', 870, G::motion,        P::motion,        motion, "RLIJK", canned_cycle},
    {'G', 880, G::motion,        P::motion,        motion, "RLP",   canned_cycle},
    {'G', 890, G::motion,        P::motion,        motion, "RLP",   canned_cycle},
    // modes
    {'G',  70, G::lathe,         P::lathe,         none,   "",      lathe_mode},
    {'G',  80, G::lathe,         P::lathe,         none,   "",      lathe_mode},
    {'G', 170, G::plane,         P::plane,         none,   "",      select_plane},
    {'G', 180, G::plane,         P::plane,         none,   "",      select_plane},
    {'G', 190, G::plane,         P::plane,         none,   "",      select_plane},
    {'G', 171, G::plane,         P::plane,         none,   "",      select_plane},
    {'G', 181, G::plane,         P::plane,         none,   "",      select_plane},
    {'G', 191, G::plane,         P::plane,         none,   "",      select_plane},
    {'G', 200, G::unit,          P::unit,          none,   "",      select_unit},
    {'G', 210, G::unit,          P::unit,          none,   "",      select_unit},
    {'G', 400, G::radius_comp,   P::radius_comp,   none,   "",      radius_comp_off},
    {'G', 410, G::radius_comp,   P::radius_comp,   none,   "DL",    radius_comp_on},
    {'G', 411, G::radius_comp,   P::radius_comp,   none,   "DL",    radius_comp_on},
    {'G', 420, G::radius_comp,   P::radius_comp,   none,   "DL",    radius_comp_on},
    {'G', 421, G::radius_comp,   P::radius_comp,   none,   "DL",    radius_comp_on},
    {'G', 430, G::length_offset, P::length_offset, none,   "H",     length_offset},
    {'G', 431, G::length_offset, P::length_offset, shared, "",      length_offset},
    {'G', 432, G::length_offset, P::length_offset, shared, "H",     length_offset},
    {'G', 490, G::length_offset, P::length_offset, none,   "",      length_offset},
    {'G', 540, G::work_system,   P::work_system,   none,   "",      work_system},
    {'G', 550, G::work_system,   P::work_system,   none,   "",      work_system},
    {'G', 560, G::work_system,   P::work_system,   none,   "",      work_system},
    {'G', 570, G::work_system,   P::work_system,   none,   "",      work_system},
    {'G', 580, G::work_system,   P::work_system,   none,   "",      work_system},
    {'G', 590, G::work_system,   P::work_system,   none,   "",      work_system},
    {'G', 591, G::work_system,   P::work_system,   none,   "",      work_system},
    {'G', 592, G::work_system,   P::work_system,   none,   "",      work_system},
    {'G', 593, G::work_system,   P::work_system,   none,   "",      work_system},
    {'G', 610, G::control,       P::control,       none,   "",      path_mode},
    {'G', 611, G::control,       P::control,       none,   "",      path_mode},
    {'G', 640, G::control,       P::control,       none,   "PQ",    path_mode},
    {'G', 900, G::distance,      P::distance,      none,   "",      distance_mode},
    {'G', 910, G::distance,      P::distance,      none,   "",      distance_mode},
    {'G', 901, G::arc_centre,    P::arc_centre,    none,   "",      arc_centre_mode},
    {'G', 911, G::arc_centre,    P::arc_centre,    none,   "",      arc_centre_mode},
    {'G', 930, G::feed_mode,     P::feed_mode,     none,   "",      feed_mode},
    {'G', 940, G::feed_mode,     P::feed_mode,     none,   "",      feed_mode},
    {'G', 950, G::feed_mode,     P::feed_mode,     none,   "",      feed_mode},
    {'G', 960, G::spindle_mode,  P::spindle_mode,  none,   "D",     spindle_mode},
    {'G', 970, G::spindle_mode,  P::spindle_mode,  none,   "",      spindle_mode},
    {'G', 980, G::retract,       P::retract,       none,   "",      retract_mode},
    {'G', 990, G::retract,       P::retract,       none,   "",      retract_mode},
    // for one line
    {'G',  40, G::non_modal,     P::dwell,         none,   "P",     dwell},
    {'G', 100, G::non_modal,     P::non_modal,     own,    "LPRIJQ", set_data},
    {'G', 280, G::non_modal,     P::non_modal,     own,    "",      go_home},
    {'G', 281, G::non_modal,     P::non_modal,     none,   "",      store_home},
    {'G', 300, G::non_modal,     P::non_modal,     own,    "",      go_home},
    {'G', 301, G::non_modal,     P::non_modal,     none,   "",      store_home},
    {'G', 520, G::non_modal,     P::non_modal,     own,    "",      local_offset},
    {'G', 530, G::non_modal,     P::non_modal,     none,   "",      machine_coordinates},
    {'G', 920, G::non_modal,     P::non_modal,     own,    "",      g92},
    {'G', 921, G::offset_reset,  P::offset_reset,     none,   "",      g92},
    {'G', 922, G::offset_reset,  P::offset_reset,     none,   "",      g92},
    {'G', 923, G::offset_reset,  P::offset_reset,     none,   "",      g92},
    // M
    {'M',   0, G::stop,          P::stop,          none,   "",      program_stop},
    {'M',   1, G::stop,          P::stop,          none,   "",      program_stop},
    {'M',   2, G::stop,          P::stop,          none,   "",      program_end},
    {'M',  30, G::stop,          P::stop,          none,   "",      program_end},
    {'M',  60, G::stop,          P::stop,          none,   "",      program_stop},
    {'M',  98, G::stop,          P::stop,          none,   "PL",    call_fanuc},
    {'M',  99, G::stop,          P::stop,          none,   "",      return_fanuc},
    {'M',   3, G::spindle,       P::spindle,       none,   "$",     spindle_turn},
    {'M',   4, G::spindle,       P::spindle,       none,   "$",     spindle_turn},
    {'M',   5, G::spindle,       P::spindle,       none,   "$",     spindle_turn},
    {'M',  19, G::spindle,       P::spindle,       none,   "$RPQ",  spindle_orient},
    {'M',  70, G::spindle,       P::spindle,       none,   "",      modal_stack},
    {'M',  71, G::spindle,       P::spindle,       none,   "",      modal_stack},
    {'M',  72, G::spindle,       P::spindle,       none,   "",      modal_stack},
    {'M',  73, G::spindle,       P::spindle,       none,   "",      modal_stack},
    {'M',   6, G::tool,          P::tool_change,   none,   "",      change_tool},
    {'M',  61, G::tool,          P::tool_change,   none,   "Q",     set_tool_number},
    {'M',   7, G::coolant,       P::coolant,       none,   "",      coolant},
    {'M',   8, G::coolant,       P::coolant,       none,   "",      coolant},
    {'M',   9, G::coolant,       P::coolant,       none,   "",      coolant},
    {'M',  48, G::override_,     P::override_,     none,   "",      override_switch},
    {'M',  49, G::override_,     P::override_,     none,   "",      override_switch},
    {'M',  50, G::override_,     P::override_,     none,   "P",     override_switch},
    {'M',  51, G::override_,     P::override_,     none,   "P$",    override_switch},
    {'M',  52, G::override_,     P::override_,     none,   "P",     override_switch},
    {'M',  53, G::override_,     P::override_,     none,   "P",     override_switch},
    {'M',  62, G::io,            P::io,            none,   "P",     digital_output},
    {'M',  63, G::io,            P::io,            none,   "P",     digital_output},
    {'M',  64, G::io,            P::io,            none,   "P",     digital_output},
    {'M',  65, G::io,            P::io,            none,   "P",     digital_output},
    {'M',  66, G::io,            P::io,            none,   "PELQ",  wait_input},
    {'M',  67, G::io,            P::io,            none,   "EQ",    analog_output},
    {'M',  68, G::io,            P::io,            none,   "EQ",    analog_output},
    {'M', 100, G::user,          P::user,          none,   "PQ",    user_code},  // to M199
};
// clang-format on

}  // namespace

std::span<const CodeRule> linuxcnc_rows() { return rows; }

std::string name_of(const CodeRule& rule) {
  if (rule.letter == 'M') return "M" + std::to_string(rule.code);
  std::string name = "G" + std::to_string(rule.code / 10);
  if (rule.code % 10 != 0) name += "." + std::to_string(rule.code % 10);
  return name;
}

const char* name_of(ModalGroup group) {
  switch (group) {
    case ModalGroup::non_modal:
      return "non-modal codes";
    case ModalGroup::offset_reset:
      return "G92 offsets";
    case ModalGroup::motion:
      return "motion";
    case ModalGroup::plane:
      return "plane";
    case ModalGroup::distance:
      return "distance mode";
    case ModalGroup::arc_centre:
      return "arc centre mode";
    case ModalGroup::feed_mode:
      return "feed mode";
    case ModalGroup::unit:
      return "units";
    case ModalGroup::radius_comp:
      return "radius compensation";
    case ModalGroup::length_offset:
      return "tool length offset";
    case ModalGroup::retract:
      return "retract level";
    case ModalGroup::work_system:
      return "work system";
    case ModalGroup::control:
      return "path control";
    case ModalGroup::spindle_mode:
      return "spindle mode";
    case ModalGroup::lathe:
      return "lathe diameter mode";
    case ModalGroup::stop:
      return "stops";
    case ModalGroup::io:
      return "inputs and outputs";
    case ModalGroup::tool:
      return "tool change";
    case ModalGroup::spindle:
      return "spindle";
    case ModalGroup::coolant:
      return "coolant";
    case ModalGroup::override_:
      return "overrides";
    case ModalGroup::user:
      return "user codes";
    case ModalGroup::macro_call:
      return "macro calls";
    case ModalGroup::mirror:
      return "mirror image";
    case ModalGroup::scaling:
      return "scaling";
    case ModalGroup::polar:
      return "polar coordinates";
    case ModalGroup::turning:
      return "rotation";
    case ModalGroup::free:
      return "codes of any group";
  }
  return "";
}

CodeTable::CodeTable(Dialect dialect, bool lathe) : dialect_(&traits_of(dialect)), lathe_(lathe) {
  for (const auto layer : layers_of(dialect, lathe))
    for (const CodeRule& rule : layer) {
      if (rule.letter == 'G') g_[static_cast<std::size_t>(rule.code)] = &rule;
      if (rule.letter == 'M') m_[static_cast<std::size_t>(rule.code)] = &rule;
    }
  if (m_[100] && m_[100]->group == ModalGroup::user)
    for (std::size_t code = 101; code < 200; ++code) m_[code] = m_[100];
}

const CodeRule* CodeTable::find_rounded(char letter, double number) const {
  const double scaled = letter == 'G' ? number * 10 : number;
  const int count = letter == 'G' ? max_g : max_m;
  if (!(scaled > -1 && scaled < count)) return nullptr;
  const int nearest = static_cast<int>(scaled + 0.5);
  const double band = letter == 'G' ? 1e-3 : 1e-4;
  if (nearest >= count || std::fabs(scaled - nearest) > band) return nullptr;
  const auto code = static_cast<std::size_t>(nearest);
  return letter == 'G' ? g_[code] : m_[code];
}

std::vector<const CodeRule*> CodeTable::rules() const {
  std::vector<const CodeRule*> rules;
  for (const CodeRule* rule : g_)
    if (rule) rules.push_back(rule);
  for (const CodeRule* rule : m_)
    if (rule && (rules.empty() || rules.back() != rule)) rules.push_back(rule);
  return rules;
}

}  // namespace aircut::interp
