// Which keys are known, so that a misspelt one is noticed. Users keep keys of their own in a set-up
// (HAL reads any), so only a key that is nearly a known one is told.
#include <algorithm>
#include <cctype>
#include <map>

#include "linuxcnc/linuxcnc.h"

namespace aircut::linuxcnc {
namespace {

using Words = std::vector<std::string>;

const Words& keys_of(const std::string& section) {
  static const std::map<std::string, Words> keys = {
      {"RS274NGC",
       {"PARAMETER_FILE",
        "SUBROUTINE_PATH",
        "USER_M_PATH",
        "REMAP",
        "ON_ABORT_COMMAND",
        "RS274NGC_STARTUP_CODE",
        "CENTER_ARC_RADIUS_TOLERANCE_INCH",
        "CENTER_ARC_RADIUS_TOLERANCE_MM",
        "G64_DEFAULT_TOLERANCE",
        "G64_DEFAULT_NAIVETOLERANCE",
        "G73_PECK_CLEARANCE",
        "G83_PECK_CLEARANCE",
        "PARAMETER_G73_PECK_CLEARANCE",
        "PARAMETER_G83_PECK_CLEARANCE",
        "DISABLE_G92_PERSISTENCE",
        "DISABLE_FANUC_STYLE_SUB",
        "DISABLE_AUTO_G54",
        "INI_VARS",
        "HAL_PIN_VARS",
        "RETAIN_G43",
        "OWORD_NARGS",
        "OWORD_WARNONLY",
        "NO_DOWNCASE_OWORD",
        "ORIENT_OFFSET",
        "LOG_LEVEL",
        "LOG_FILE",
        "FEATURES"}},
      {"TRAJ",
       {"COORDINATES",
        "LINEAR_UNITS",
        "ANGULAR_UNITS",
        "SPINDLES",
        "DEFAULT_LINEAR_VELOCITY",
        "MAX_LINEAR_VELOCITY",
        "DEFAULT_LINEAR_ACCELERATION",
        "MAX_LINEAR_ACCELERATION",
        "DEFAULT_ANGULAR_VELOCITY",
        "MAX_ANGULAR_VELOCITY",
        "DEFAULT_ANGULAR_ACCELERATION",
        "MAX_ANGULAR_ACCELERATION",
        "POSITION_FILE",
        "NO_FORCE_HOMING",
        "HOME",
        "ARC_BLEND_ENABLE",
        "ARC_BLEND_FALLBACK_ENABLE",
        "ARC_BLEND_OPTIMIZATION_DEPTH",
        "ARC_BLEND_GAP_CYCLES",
        "ARC_BLEND_RAMP_FREQ",
        "ARC_BLEND_KINK_RATIO",
        "TPMOD",
        "AXES",
        "CYCLE_TIME",
        "NO_PROBE_JOG_ERROR",
        "NO_PROBE_HOME_ERROR"}},
      {"EMCIO",
       {"EMCIO", "CYCLE_TIME", "TOOL_TABLE", "DB_PROGRAM", "RANDOM_TOOLCHANGER",
        "TOOL_CHANGE_POSITION", "TOOL_CHANGE_WITH_SPINDLE_ON", "TOOL_CHANGE_QUILL_UP",
        "TOOL_CHANGE_AT_G30"}},
      {"DISPLAY", {"PROGRAM_PREFIX"}},
      {"KINS", {"KINEMATICS", "JOINTS"}},
      {"AXIS_",
       {"TYPE", "MAX_VELOCITY", "MAX_ACCELERATION", "MIN_LIMIT", "MAX_LIMIT", "WRAPPED_ROTARY",
        "LOCKING_INDEXER_JOINT", "OFFSET_AV_RATIO", "HOME", "LOCKING_INDEXER"}},
      {"JOINT_",
       {"TYPE",
        "MAX_VELOCITY",
        "MAX_ACCELERATION",
        "MIN_LIMIT",
        "MAX_LIMIT",
        "LOCKING_INDEXER",
        "WRAPPED_ROTARY",
        "HOME",
        "HOME_OFFSET",
        "HOME_SEQUENCE",
        "HOME_SEARCH_VEL",
        "HOME_LATCH_VEL",
        "HOME_FINAL_VEL",
        "HOME_IGNORE_LIMITS",
        "HOME_USE_INDEX",
        "BACKLASH",
        "COMP_FILE",
        "COMP_FILE_TYPE",
        "FERROR",
        "MIN_FERROR",
        "UNITS",
        "VOLATILE_HOME",
        "HOME_ABSOLUTE_ENCODER"}},
  };
  static const Words none;
  const auto group = [&] {
    if (section.starts_with("AXIS_")) return std::string("AXIS_");
    if (section.starts_with("JOINT_")) return std::string("JOINT_");
    return section;
  }();
  const auto found = keys.find(group);
  return found == keys.end() ? none : found->second;
}

std::string upper(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

}  // namespace

void check_keys(const ini::IniFile& file, Diagnostics& out) {
  static const Words sections = {"RS274NGC", "TRAJ", "EMCIO", "DISPLAY", "KINS"};
  static const Words others = {"EMC",          "FILTER", "TASK",   "EMCMOT",  "HAL", "HALUI",
                               "APPLICATIONS", "PYTHON", "WIZARD", "MACHINE", "HMOT"};
  constexpr std::size_t shortest_key = 5;  // shorter ones are near to everything
  for (const ini::Section& section : file.sections()) {
    const bool known = std::count(sections.begin(), sections.end(), section.name) > 0 ||
                       std::count(others.begin(), others.end(), section.name) > 0;
    const auto near_section = nearest_word(upper(section.name), sections);
    if (!known && near_section && section.name.size() > 3)
      out.warning("ini_key", section.span,
                  "the control does not look at a section [" + printable(section.name) +
                      "]. Did you mean [" + *near_section + "]?");
    const Words& keys = keys_of(section.name);
    for (const ini::Entry& entry : section.entries) {
      if (std::count(keys.begin(), keys.end(), entry.key) > 0 || entry.key.size() < shortest_key)
        continue;
      const auto near_key = nearest_word(upper(entry.key), keys);
      if (near_key)
        out.warning("ini_key", entry.key_span,
                    "the control does not look at '" + printable(entry.key) + "' in [" +
                        printable(section.name) + "]. Did you mean " + *near_key + "?");
    }
  }
}

}  // namespace aircut::linuxcnc
