// What a dialect is: traits that the reader of lines asks, and layers of code-table rows. The core
// (blocks, phases, parameters, calls, offsets, motion) is the same for all of them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "interp/block.h"
#include "interp/code_table.h"
#include "interp/interp.h"

namespace aircut::interp {

struct DialectTraits {
  const char* name;        ///< as messages call the control: "LinuxCNC", "Fanuc", "Haas"
  bool macro_b;            ///< O1234 programs, IF GOTO, WHILE DO, G65; else O-words and #<names>
  bool active_comments;    ///< (MSG,…), (DEBUG,…) act
  bool least_increments;   ///< a length without a decimal point counts 0.001 mm or 0.0001 in
  bool end_required;       ///< end of file without M2, M30 or M99 is an error
  bool motion_at_start;    ///< G0 is in force at the start, else none is
  std::uint32_t max_line;  ///< characters of a line without its end; 0: any number
  int max_m_words;         ///< M words on one line
  int max_depth;           ///< nested calls
  int max_macro_depth;     ///< of them those with variables of their own (G65, G66)
  int max_brackets;        ///< [ ] inside each other
  bool bare_conditions;    ///< IF and WHILE without brackets
  bool packed_counts;      ///< M98 P30012 calls O0012 three times
  bool full_turn;          ///< ATAN[y]/[x] gives 0 to 360, ASIN 270 to 90, else both as LinuxCNC
  bool local_subs;         ///< M97 P100 calls the lines from N100
  bool feed_increments;    ///< F without a decimal point counts increments too
  bool return_jumps;       ///< M99 P goes to a block of the same program, not of the calling one
  bool arc_corners;        ///< ,R and ,C also between a line and an arc, and between arcs
};

/// Words that count least increments without a decimal point (macro B); F has its own rule.
constexpr std::uint32_t increment_letters = axis_letters | letter_bit('I') | letter_bit('J') |
                                            letter_bit('K') | letter_bit('Q') | letter_bit('R') |
                                            letter_bit('a') | letter_bit('c') | letter_bit('r');

const DialectTraits& traits_of(Dialect dialect);

/// Rows of the code table, base first: a row of a later layer replaces the row of the same code.
std::vector<std::span<const CodeRule>> layers_of(Dialect dialect, bool lathe);

/// Which other control has the G code (× 10), and the option that chooses it; empty: none.
std::string control_with(int code, Dialect dialect, bool lathe);

/// The rows that each dialect brings (code_table.cpp, fanuc_codes.cpp, haas_codes.cpp).
std::span<const CodeRule> linuxcnc_rows();
std::span<const CodeRule> builder_rows();           ///< every M-code, as the machine builder's
std::span<const CodeRule> fanuc_rows();             ///< mills and lathes
std::span<const CodeRule> fanuc_mill_rows();        ///< machining centres
std::span<const CodeRule> fanuc_lathe_rows();       ///< turning centres, G-code system A
std::span<const CodeRule> fanuc_mill_cycle_rows();  ///< fanuc_cycle_rows.cpp
std::span<const CodeRule> fanuc_lathe_cycle_rows();
std::span<const CodeRule> haas_mill_cycle_rows();
std::span<const CodeRule> haas_rows();
std::span<const CodeRule> haas_mill_rows();
std::span<const CodeRule> haas_lathe_rows();

}  // namespace aircut::interp
