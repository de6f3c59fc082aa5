// Structural formulas of machines, like R(MS:C)-O-T(TS:X)-T(VS:Z): the couples from the workpiece
// over the bed O to the tool (docs/formulas.md).
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/base.h"

namespace aircut::machine {

struct FormulaCouple {
  bool rotary = false;  ///< R; a T slides
  std::string element;  ///< LS1, MS …
  std::string axis;     ///< X1, C, S …; empty: an indexing element without an NC axis
  bool operator==(const FormulaCouple&) const = default;

  /// The letters of the element, without its number.
  std::string_view kind() const;
  /// Turns by speed, not by position.
  bool is_spindle() const { return axis.starts_with('S'); }
};

/// Couples from the bed outwards.
using FormulaBranch = std::vector<FormulaCouple>;

/// One workpiece holder, and the tools that work on it.
struct FormulaChain {
  FormulaBranch work;
  std::vector<FormulaBranch> tools;  ///< one or more, of which one may be empty: fixed to the bed
  bool operator==(const FormulaChain&) const = default;
};

struct Formula {
  std::vector<FormulaChain> chains;
  bool operator==(const Formula&) const = default;
};

struct FormulaError {
  std::size_t column = 1;  ///< in characters of one byte, from 1
  std::string message;
};

tl::expected<Formula, FormulaError> parse_formula(std::string_view text);
/// A text that parses to the same formula.
std::string text_of(const Formula& formula);

}  // namespace aircut::machine
