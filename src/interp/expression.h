// Expressions, compiled when a line is read and evaluated when it is executed.
// A Value is a constant or a run of instructions for a small stack machine (operands first).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace aircut::interp {

class Parameters;

/// A range of bytes relative to the begin of the line.
struct Place {
  std::uint32_t begin = 0;
  std::uint32_t length = 0;
};

enum class Op : unsigned char {
  number,         ///< push a constant
  read,           ///< push the parameter whose number is in `id`
  read_indirect,  ///< replace the number on top by that parameter
  read_named,     ///< push the parameter with the name `id`
  exists,         ///< 1 when the number on top is a valid parameter number
  exists_named,   ///< 1 when the name `id` is defined
  negate,
  power,
  multiply,
  divide,
  modulo,
  add,
  subtract,
  equal,
  not_equal,
  greater,
  greater_equal,
  less,
  less_equal,
  and_,
  or_,
  xor_,
  abs,
  acos,
  asin,
  cos,
  exp,
  fix,
  fup,
  ln,
  round,
  sin,
  sqrt,
  tan,
  atan,  ///< two operands: y, x
  // Of macro B (macro_expression.cpp). A vacant variable is NaN on the stack; nothing but these
  // operations ever sees it.
  vacant,            ///< push #0
  read_system,       ///< push the system variable `id`
  make_solid,        ///< a vacant variable counts as 0
  negate_or_vacant,  ///< a vacant variable stays vacant
  truncate,          ///< FIX: towards 0
  away,              ///< FUP: away from 0
  round_address,     ///< ROUND inside a word: to the least increment
  asin_turn,         ///< ASIN from 270 to 90 degrees
  atan_one,          ///< ATAN with one operand, from -90 to 90 degrees
  bin,               ///< from binary coded decimal
  bcd,               ///< to binary coded decimal
  same,              ///< EQ: vacant is like vacant only
  not_same,          ///< NE
  remainder,         ///< MOD with the sign of the dividend
  and_bits,
  or_bits,
  xor_bits,
  atan_turn,  ///< ATAN with two operands, from 0 to 360 degrees
};

constexpr bool is_macro(Op op) { return op >= Op::vacant; }

/// Where a binary operation finds its right operand. The left one is always on the stack.
enum class Right : unsigned char {
  stack,
  number,     ///< the instruction's `number`
  parameter,  ///< the parameter `id`, one of those that can always be read
};

struct Instruction {
  Op op = Op::number;
  Right right = Right::stack;
  std::int32_t id = 0;
  double number = 0;
  Place place;  ///< for errors: the operator, function or parameter
};
using Code = std::vector<Instruction>;

struct Value {
  double number = 0;        ///< when count is 0
  std::uint32_t first = 0;  ///< index of the first instruction
  std::uint32_t count = 0;  ///< 0: a constant

  bool constant() const { return count == 0; }
};

/// What is wrong at a place of the line.
struct Fault {
  const char* kind = "";
  Place place;
  std::string message;
};

/// Computes `number`, or gives false with `fault` filled in. Never infinity, and NaN only for a
/// vacant variable of macro B. (Not an optional: handing one back costs as much as a short
/// expression, because the processor waits for its byte and its number to reach the memory.)
bool evaluate(const Value& value, const Code& code, const Parameters& parameters, double& number,
              std::optional<Fault>& fault);
/// The same where that does not matter.
inline std::optional<double> evaluate(const Value& value, const Code& code,
                                      const Parameters& parameters, std::optional<Fault>& fault) {
  double number = 0;
  if (!evaluate(value, code, parameters, number, fault)) return std::nullopt;
  return number;
}

/// The integer that a value means (within 1e-4, as the reference), or nothing.
std::optional<int> as_integer(double value);

}  // namespace aircut::interp
