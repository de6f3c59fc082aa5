// interp: from program text to canonical commands (RS274/NGC: LinuxCNC, Fanuc, Haas).
//
//   SourceText ─ lexer/parser ─► Block ─ code table, in phase order ─► canon::Command
//
// A block is a transaction: it changes the state and emits its commands, or it records its errors
// and changes nothing. Memory: the text (mapped), parsed blocks of loops and subs, the call stack.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "canon/canon.h"
#include "tool/tool.h"

namespace aircut::interp {

/// Numbered parameters that outlive a program (the var file).
struct ParameterFile {
  std::map<int, double> values;
};
/// `number value` per line, ascending. Errors at the line; the file's other lines are ignored.
ParameterFile read_var(const SourceText& text, Diagnostics& out);
/// The text of a var file with the parameters that a control keeps.
std::string write_var(const ParameterFile& parameters);

/// Whose control the program is written for.
enum class Dialect : unsigned char { linuxcnc, fanuc, haas };

struct Limits {
  std::uint64_t max_blocks = 50'000'000;
  std::uint64_t max_idle_blocks = 10'000'000;  ///< blocks without motion or dwell
  std::uint64_t max_repeat = 100'000'000;      ///< passes of one loop statement
  int max_depth = 0;                           ///< nested calls; 0: as many as the control takes
};

/// What a text has that only one family of controls reads.
struct DialectGuess {
  std::optional<Dialect> dialect;  ///< nothing: any control could read it
  std::uint32_t line = 0;          ///< of the first sign
  const char* what = nullptr;      ///< "GOTO", "a named parameter (#<…>)"
};
DialectGuess guess_dialect(std::string_view text);

/// A code that the machine's set-up gives a meaning of its own (LinuxCNC: `REMAP=`).
struct Remap {
  char letter = 'M';    ///< G, M, or T, S, F: the word itself
  int code = 0;         ///< G: number × 10; M: number; T, S, F: 0
  int modal_group = 0;  ///< LinuxCNC's number: G 1, M 4-10
  /// Words that the sub gets as #<letter>: capital = required, small = if given; `>` `^`: the feed,
  /// the speed, which must be above 0; `n` `N`: the line's number; `@`: as #1, #2 … instead.
  std::string argspec;
  std::string ngc;           ///< sub and file that is called; empty: none
  std::optional<int> model;  ///< instead: the machine's kinematics of that number comes into force
  std::string python;        ///< what would run as a program of the control: listed, never run
  std::string name;          ///< as messages call it: `M400`, `G88.1`, `T`
  SourceSpan span;           ///< where it is said
};

/// Kinematics among which a program can switch on this machine, by number.
struct KinematicsSwitch {
  int start = 0;                       ///< in force at the start
  std::optional<int> output;           ///< LinuxCNC: M68 E with this number switches …
  std::vector<int> by_value;           ///< … to this one, by Q; -1: one that is not known
  std::map<int, int> codes;            ///< M code → number
  std::optional<int> tcp_on, tcp_off;  ///< Fanuc, Haas: of G43.4 or G234, and of G49
};

struct Options {
  Dialect dialect = Dialect::linuxcnc;
  std::string
      dialect_reason;        ///< why it was chosen (choose_dialect); told as an info when not empty
  bool whole_units = false;  ///< Fanuc, Haas: X1 is X1. and not 0.001 mm
  bool lathe = false;  ///< Fanuc, Haas: G-code system A of turning centres, else machining centres
  canon::Unit machine_unit = canon::Unit::millimetre;  ///< of tool table, var file, #5xxx
  canon::Unit start_unit = canon::Unit::millimetre;    ///< G20/G21 at the start
  AxisSet axes;      ///< axes that the machine has; a word of another one is an error
  AxisValues start;  ///< position at the start: tip in machine coordinates, mm and rad
  bool block_delete = false;
  bool optional_stop = false;
  bool keep_going = true;  ///< after an error, go on and report the others
  int tool_in_spindle = 0;
  std::vector<std::string> sub_path;                ///< folders in which called subs are looked for
  std::vector<std::pair<std::string, double>> set;  ///< --set: "#100" or "#<name>", value
  std::map<std::string, double> ini;                ///< `SECTION/KEY` for #<_ini[section]key>
  double arc_tolerance = 0.0283;                    ///< centre-format radius tolerance, mm (G21)
  double arc_tolerance_inch = 0.00283;              ///< the same in inches (G20)
  int spindles = 1;                                 ///< 1-8
  double g73_clearance = 0;                         ///< mm; 0: 0.254 mm (G21) or 0.010 in (G20)
  double g83_clearance = 0;                         ///< mm; 0: the same
  std::optional<double> g64_tolerance;              ///< mm, of G64 without P; nothing: no limit
  std::optional<double> g64_naive_tolerance;        ///< mm, of G64 without P and Q
  AxisSet wrapped;   ///< rotary axes that G90 turns the short way, by the sign of the word
  AxisSet indexers;  ///< rotary axes that are clamped: they move alone, with G0
  std::vector<Remap> remaps;
  KinematicsSwitch kinematics;
  bool tool_change_at_g30 = false;        ///< M6 goes to the G30 position first
  bool tool_change_quill_up = false;      ///< M6 lifts Z to machine 0 first
  bool tool_change_with_spindle = false;  ///< M6 leaves the spindle turning
  /// M6 moves these axes to this machine position first.
  std::optional<std::pair<AxisSet, AxisValues>> tool_change_position;
  bool retain_length_offset = false;  ///< M6 with G43 in force takes the new tool's offset
  bool fanuc_subs = true;             ///< M98, M99 (LinuxCNC dialect)
  bool g54_at_end = true;             ///< M2, M30 go back to G54
  bool keep_g92 = true;               ///< G92 of the parameter file is in force at the start
  bool count_arguments = false;       ///< #<n_args> in a sub: how many arguments the call had
  bool ini_variables = true;          ///< #<_ini[…]…> can be read
  bool hal_pins = true;               ///< #<_hal[…]> can be read, once --set gave its value
  double orient_offset = 0;           ///< degrees, added to R of M19
  /// A line that is executed before the program, and the text that it is in (null: none).
  const SourceText* startup = nullptr;
  SourceSpan startup_line;
  Limits limits;
  /// Lines that most programs are made of go past the code table. Off only in tests, which compare.
  bool fast_paths = true;
};

/// Sets `dialect` from what the text has (`--dialect auto`), and `dialect_reason`. A text without a
/// sign leaves the dialect as it is.
void choose_dialect(Options& options, std::string_view text);

/// What the run says back after a probing move.
struct ProbeHit {
  AxisValues tip;  ///< machine coordinates
  bool tripped = false;
};

class Interpreter {
 public:
  /// `tools` is copied (G10 L1 changes it). `reader` opens called sub files.
  Interpreter(const SourceText& program, const tool::ToolTable& tools,
              const ParameterFile& parameters, Options options, SourceReader reader,
              Diagnostics& diagnostics);
  ~Interpreter();
  Interpreter(const Interpreter&) = delete;
  Interpreter& operator=(const Interpreter&) = delete;

  /// The next command, or null at the end of the program (or after an error when !keep_going, or a
  /// reached limit). It is the caller's to move from and stays until the next call. Errors are in
  /// the diagnostics. The first commands describe the start state (units, work offset, plane, feed
  /// mode …), so that a stream stands on its own.
  canon::Command* next();

  /// Result of the Probe command that next() handed out last.
  void resume(const ProbeHit& hit);

  /// Where the tip is after the SwitchKinematics command that next() handed out last. Without this
  /// call the position stays what it was in the kinematics before.
  void synchronise(const AxisValues& tip);

  /// Parameters as they are now, for the var file.
  ParameterFile parameters() const;

  struct Statistics {
    std::uint64_t lines = 0;   ///< lines executed
    std::uint64_t blocks = 0;  ///< blocks executed
    bool ended = false;        ///< M2, M30 or `%` was reached
    bool limit_reached = false;
    bool input_read = false;  ///< #5399, the result of M66, was looked at
  };
  Statistics statistics() const;

  struct CodeCount {
    std::string code;  ///< `G5.1`; M100 stands for all user codes
    std::uint64_t count = 0;
  };
  /// Every code that the dialect knows with the number of blocks in which it acted, whether given
  /// or modal.
  std::vector<CodeCount> code_counts() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// Table of all error kinds of this library with their long text, for `explain` and the docs.
using aircut::KindText;
const std::vector<KindText>& error_kinds();

}  // namespace aircut::interp
