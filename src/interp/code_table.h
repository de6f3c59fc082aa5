// The codes of the dialect: one row per code. The core derives from it the clashes in a modal
// group, the words that nobody uses, and the order in which the codes of a line act.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "interp/interp.h"

namespace aircut::interp {

class BlockRun;
struct CodeRule;

enum class ModalGroup : unsigned char {
  non_modal,
  offset_reset,
  motion,
  plane,
  distance,
  arc_centre,
  feed_mode,
  unit,
  radius_comp,
  length_offset,
  retract,
  work_system,
  control,
  spindle_mode,
  lathe,
  stop,
  io,
  tool,
  spindle,
  coolant,
  override_,
  user,
  macro_call,
  mirror,   ///< G50.1 G51.1
  scaling,  ///< G50 G51
  turning,  ///< G68 G69
  polar,    ///< G15 G16
  free      ///< may stand beside any other code
};
const char* name_of(ModalGroup group);

/// In this order the codes of a line act (interp.md 6). F, S and T are words with a phase.
enum class Phase : unsigned char {
  spindle_mode,
  feed_mode,
  feed,
  speed,
  tool_select,
  io,
  tool_change,
  spindle,
  coolant,
  override_,
  user,
  dwell,
  plane,
  unit,
  lathe,
  radius_comp,
  length_offset,
  work_system,
  control,
  distance,
  arc_centre,
  retract,
  non_modal,
  offset_reset,
  motion,
  stop
};

/// What the axis words of a line are for when the code is on it.
enum class AxisUse : unsigned char {
  none,      ///< the code leaves them to the motion
  motion,    ///< a motion code
  own,       ///< the code takes them (G10 G28 G92 …); there is no motion then
  optional,  ///< takes them and leaves them to a motion code on the line too (G43.1)
};

using Handler = void (*)(const CodeRule& rule, BlockRun& run);

struct CodeRule {
  char letter;
  std::int16_t code;  ///< G: number × 10; M: number
  ModalGroup group;
  Phase phase;
  AxisUse axes;
  const char* words;  ///< letters that it may use, without axis words
  Handler handler;    ///< null: known, but not implemented
};

/// `G5.1`, `M3`.
std::string name_of(const CodeRule& rule);

struct DialectTraits;

class CodeTable {
  static constexpr int max_g = 3000;  ///< G numbers × 10
  static constexpr int max_m = 1000;

 public:
  static constexpr std::size_t slots = max_g + max_m;
  explicit CodeTable(Dialect dialect = Dialect::linuxcnc, bool lathe = false);
  /// What is special about the dialect that the rows are of.
  const DialectTraits& dialect() const { return *dialect_; }
  /// A turning centre's table (Fanuc, Haas).
  bool lathe() const { return lathe_; }
  /// The row of a G or M word, or null when there is no such code.
  const CodeRule* find(char letter, double number) const {
    const int whole = number >= 0 && number < max_g / 10 ? static_cast<int>(number) : -1;
    if (whole < 0 || whole != number) return find_rounded(letter, number);
    return letter == 'G' ? g_[static_cast<std::size_t>(whole * 10)]
                         : m_[static_cast<std::size_t>(whole)];
  }
  const CodeRule* find_g(int code) const {
    return code >= 0 && code < max_g ? g_[static_cast<std::size_t>(code)] : nullptr;
  }
  /// A row that takes the place of the one of its code; it must outlive the table.
  void replace(const CodeRule& rule) {
    (rule.letter == 'G' ? g_[static_cast<std::size_t>(rule.code)]
                        : m_[static_cast<std::size_t>(rule.code)]) = &rule;
  }
  /// The rows in force, each code once.
  std::vector<const CodeRule*> rules() const;
  /// A number below `slots` that no other code has.
  static std::size_t slot(const CodeRule& rule) {
    return static_cast<std::size_t>(rule.letter == 'G' ? rule.code : max_g + rule.code);
  }

 private:
  const CodeRule* find_rounded(char letter, double number) const;

  const DialectTraits* dialect_;
  bool lathe_ = false;
  std::array<const CodeRule*, max_g> g_{};
  std::array<const CodeRule*, max_m> m_{};
};

}  // namespace aircut::interp
