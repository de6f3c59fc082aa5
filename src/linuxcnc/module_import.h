// A set-up's kinematics module as couples and a kinematics type of ours. One row of a table per
// module (modules*.cpp) says what its inputs mean.
#pragma once

#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "linuxcnc/hal.h"
#include "linuxcnc/linuxcnc.h"
#include "package/machine_text.h"

namespace aircut::linuxcnc {

/// What the rows of the table read from and write to. Lengths mm, angles degrees.
class ModuleImport {
 public:
  ModuleImport(const ini::IniFile& ini, Hal& hal, double unit_mm, Diagnostics& out,
               MachineImport& result);

  /// All of it: `[KINS]` and the joints, by the row of the module.
  void run(const ini::Entry& kinematics);

  // ---- for the rows
  package::MachineText& text() { return text_; }
  /// Letters of `coordinates=`, in capitals; `usual` without.
  std::string letters(std::string_view usual);
  int joints() const { return joints_; }
  /// Limits of a joint. With a letter that is moved by this joint alone, also those of the axis.
  package::CoupleLimits limits(int joint, bool rotary, char axis = 0);
  /// A couple with them, named J0, J1, …
  package::Couple couple(int joint, bool rotary, const Eigen::Vector3d& direction,
                         const std::string& parent = "bed");
  /// An input of the module, or the module's default in the machine's unit.
  double length(const std::string& pin, std::optional<double> usual);
  double plain(const std::string& pin, std::optional<double> usual);
  Eigen::Vector3d point(const std::string& pins);
  /// Is the tool's length added to this input?
  bool gets_tool_length(const std::string& pin);
  /// Told, and the verdict of every run is unknown.
  void unchecked(const std::string& what);
  /// Likewise, but only where bodies are looked at.
  void undrawn(const std::string& what);
  void error(const std::string& what);
  /// Joints that are not part of the machine that is moved, and the axes that go with them.
  void leave_out(const std::vector<int>& joints, const std::string& letters = "");
  /// All from this one on.
  void leave_out_from(int first);
  /// Every joint is an axis of the program.
  void axes_are_joints() { result_.axes_are_joints = true; }
  /// `sparm=identityfirst`.
  bool identity_first() const { return identity_first_; }
  /// Pose of the set-up's home, `[TRAJ]HOME` or the axes' own; nothing when it is not said.
  std::optional<Eigen::Vector3d> home_point() const;
  double unit() const { return unit_mm_; }

 private:
  const ini::Entry* find(const std::string& section, std::string_view key) const;
  std::optional<double> number(const std::string& section, std::string_view key);
  std::string section_of(int joint) const;
  void parameters(const ini::Entry& kinematics);
  void count_joints();
  std::optional<HalInput> input(const std::string& pin);
  void tell_unused();
  void switching();
  void speed();

  const ini::IniFile& ini_;
  Hal& hal_;
  double unit_mm_;
  Diagnostics& out_;
  MachineImport& result_;
  package::MachineText text_;
  std::string module_, coordinates_;
  SourceSpan span_;  ///< of KINEMATICS
  int joints_ = 0;
  bool identity_first_ = false;
  std::set<std::string> asked_;  ///< pins of the module
};

/// A module by the name that a set-up gives it.
struct ModuleRow {
  std::string_view name;
  void (*write)(ModuleImport&);
  bool has_pins = false;           ///< that set lengths
  std::string_view harmless = "";  ///< pins that change nothing of the machine, between blanks
};
/// serial machines: axes as they are, tables and heads
std::span<const ModuleRow> serial_modules();
/// arms, deltas, hexapods
std::span<const ModuleRow> other_modules();

}  // namespace aircut::linuxcnc
