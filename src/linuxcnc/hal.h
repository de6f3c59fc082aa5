// The lines of HAL files that say what a kinematics module gets: `setp`, `sets`, `net`, and the
// older `newsig`, `linksp`, `linkps`. Nothing is run: a value that a component computes is unknown,
// but for `sum2`, which adds.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "ini/ini.h"

namespace aircut::linuxcnc {

/// What an input gets.
struct HalInput {
  double value = 0;
  bool tool_length = false;          ///< the tool's length in Z is added
  std::vector<std::string> unknown;  ///< pins and signals whose values the files don't give
  SourceSpan span;                   ///< where the value or the wire is
};

class Hal {
 public:
  /// `ini` gives the values of `[SECTION]KEY`; what is not understood goes to `out` (`hal_line`).
  Hal(const ini::IniFile& ini, Diagnostics& out) : ini_(ini), out_(out) {}

  /// A HAL file; lines that end with `\` go on.
  void read(const SourceText& text);
  /// One command.
  void command(const std::string& line, const SourceSpan& span);

  /// What a pin gets; nothing when no line names it. A value that is no number is an error.
  std::optional<HalInput> input(const std::string& pin, int depth = 0);
  /// The pin that drives `pin` over a signal.
  std::optional<std::string> driver(const std::string& pin) const;
  /// Pins whose names begin with `prefix` and where a line names them first.
  std::map<std::string, SourceSpan> pins(const std::string& prefix) const;

 private:
  struct Value {
    std::string text;
    SourceSpan span;
  };
  struct Signal {
    std::vector<std::string> pins;
    std::optional<std::string> driver;
    std::optional<Value> set;
    SourceSpan span;
  };
  void not_understood(const SourceSpan& span, const std::string& why);
  std::optional<std::vector<std::string>> words_of(const std::string& line, const SourceSpan& span);
  void connect(Signal& signal, const std::string& pin, const SourceSpan& span);
  void net(const std::vector<std::string>& words, const SourceSpan& span);
  void load(const std::vector<std::string>& words);
  std::optional<double> number(const Value& value);
  const Signal* signal_of(const std::string& pin) const;
  const std::string* driver_of(const Signal& signal) const;

  const ini::IniFile& ini_;
  Diagnostics& out_;
  std::map<std::string, Value> set_;  ///< by pin
  std::map<std::string, Signal> signals_;
  std::map<std::string, std::string> wired_;  ///< pin → signal
  std::map<std::string, SourceSpan> named_;   ///< pin → first line
  std::set<std::string> sums_;                ///< components of `sum2`
  bool too_many_ = false;
};

}  // namespace aircut::linuxcnc
