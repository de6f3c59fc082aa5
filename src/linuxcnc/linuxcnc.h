// linuxcnc: what the set-up file of a LinuxCNC machine means for a job: options of the interpreter,
// default files, travel. docs/linuxcnc-ini.md lists every key. Nothing that a set-up names is ever
// executed; what can't be followed is told, and makes a verdict unknown.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "ini/ini.h"
#include "interp/interp.h"

namespace aircut::linuxcnc {

/// Soft limits of a program axis, mm or rad.
struct Travel {
  std::optional<double> min, max;
  SourceSpan min_span, max_span;
};

struct Setup {
  interp::Options options;  ///< without the position at the start, --set and limits
  double unit_mm = 1;       ///< machine unit: of tool table, parameter file and the file itself
  bool random_tool_changer = false;
  std::string parameter_file, tool_table;  ///< paths that can be opened; empty: none
  std::map<Axis, Travel> travel;
  std::vector<std::string> unchecked;  ///< what is not modelled, a sentence each
};

/// What the user gave in place of the set-up's: its own is not looked at then.
struct Given {
  bool tools = false, parameters = false;
};

/// Reads `path` and everything that it includes. Paths in it start at its folder and stay in it.
/// Errors are in `out`; nothing when the file can't be opened.
Expected<Setup> read_setup(const std::string& path, Given given, SourceMap& sources,
                           Diagnostics& out);

/// The machine of a set-up: what `[KINS]`, its joints and axes and the HAL files say, as a
/// machine.toml without bodies.
struct MachineImport {
  std::string toml;
  std::vector<std::string> unchecked;  ///< what was not understood, a sentence each
  std::vector<std::string> undrawn;    ///< likewise; counts only where bodies are looked at
  bool axes_are_joints = false;        ///< so the joints' limits hold those of the axes
  /// The analog output (M67, M68) that switches the kinematics.
  std::optional<int> switch_output;
  std::vector<std::string> models;  ///< channels of `toml` in the order of its numbers
};
/// Nothing when the set-up names no kinematics; errors are in `out`.
Expected<std::optional<MachineImport>> import_machine(const std::string& path, SourceMap& sources,
                                                      Diagnostics& out);

/// Tells moves beyond the travel, once per block, axis and end (kind `overtravel`).
class TravelCheck {
 public:
  TravelCheck(std::map<Axis, Travel> travel, const AxisValues& start)
      : travel_(std::move(travel)), tip_(start) {}
  /// Takes the commands one after the other.
  void see(const canon::Command& command, Diagnostics& out);

 private:
  void bulges(const canon::ArcFeed& arc, const canon::Command& command, Diagnostics& out);
  void point(const AxisValues& tip, const canon::Command& command, Diagnostics& out);

  std::map<Axis, Travel> travel_;
  AxisValues tip_, length_offset_;
  bool tip_known_ = true;
  std::set<std::tuple<const SourceText*, std::uint64_t, Axis, bool>> told_;
};

/// A REMAP line: `M400 modalgroup=10 argspec=Pq ngc=probe`. Nothing with an error at `span`, or
/// when the control takes no notice of the line (a warning).
std::optional<interp::Remap> read_remap(const std::string& value, const SourceSpan& span,
                                        Diagnostics& out);

/// Warns of keys that look misspelt.
void check_keys(const ini::IniFile& file, Diagnostics& out);

/// Kinds of messages of this library, for `explain` and the docs.
const std::vector<KindText>& kinds();

}  // namespace aircut::linuxcnc
