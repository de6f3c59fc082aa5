// Values as macro B writes them:
//   3  * / MOD AND    2  + - OR XOR    1  EQ NE GT GE LT LE
// Functions may be shortened to two letters. A variable that was never set is vacant: as an operand
// it counts 0, but EQ and NE tell the two apart, and a word with a vacant value does not count.
#include <algorithm>
#include <array>

#include "interp/dialect.h"
#include "interp/line_parser.h"

namespace aircut::interp {
namespace {

constexpr std::array<Operator, 14> operators = {{{"*", Op::multiply, 3},
                                                 {"/", Op::divide, 3},
                                                 {"mod", Op::remainder, 3},
                                                 {"and", Op::and_bits, 3},
                                                 {"+", Op::add, 2},
                                                 {"-", Op::subtract, 2},
                                                 {"or", Op::or_bits, 2},
                                                 {"xor", Op::xor_bits, 2},
                                                 {"eq", Op::same, 1},
                                                 {"ne", Op::not_same, 1},
                                                 {"gt", Op::greater, 1},
                                                 {"ge", Op::greater_equal, 1},
                                                 {"lt", Op::less, 1},
                                                 {"le", Op::less_equal, 1}}};

struct Function {
  const char* name;
  Op op;
  int least, most;  ///< arguments
};
constexpr std::array<Function, 16> functions = {{{"sin", Op::sin, 1, 1},
                                                 {"cos", Op::cos, 1, 1},
                                                 {"tan", Op::tan, 1, 1},
                                                 {"asin", Op::asin_turn, 1, 1},
                                                 {"acos", Op::acos, 1, 1},
                                                 {"atan", Op::atan_turn, 1, 2},
                                                 {"sqrt", Op::sqrt, 1, 1},
                                                 {"abs", Op::abs, 1, 1},
                                                 {"bin", Op::bin, 1, 1},
                                                 {"bcd", Op::bcd, 1, 1},
                                                 {"round", Op::round, 1, 1},
                                                 {"fix", Op::truncate, 1, 1},
                                                 {"fup", Op::away, 1, 1},
                                                 {"ln", Op::ln, 1, 1},
                                                 {"exp", Op::exp, 1, 1},
                                                 {"pow", Op::power, 2, 2}}};

}  // namespace

std::span<const Operator> LineParser::macro_operators() const { return operators; }

void LineParser::make_solid() {
  if (out_.code.empty()) return;
  switch (out_.code.back().op) {
    case Op::vacant:
    case Op::negate_or_vacant:
      break;
    case Op::read:
    case Op::read_system:
    case Op::read_indirect:
      if (table_.dialect().macro_b) break;
      return;
    default:
      return;
  }
  emit(Op::make_solid, out_.code.back().place);
}

// The same for a value that was just read.
void LineParser::make_solid_value(Value& value) {
  if (value.constant()) return;
  make_solid();
  value.count = static_cast<std::uint32_t>(out_.code.size()) - value.first;
}

// `#1 EQ 1 AND #2 EQ 2` is not what it looks like: AND binds closer than EQ.
void LineParser::note_logic(const Operator& op, Place place) {
  if (op.level == 1) relation_ = true;
  if (op.op == Op::and_bits || op.op == Op::or_bits || op.op == Op::xor_bits) logic_ = true;
  if (!relation_ || !logic_) return;
  relation_ = logic_ = false;
  out_.warnings.push_back({"ambiguous_logic", place,
                           "AND, OR and XOR bind closer than EQ, NE, GT, GE, LT and LE here; put "
                           "each comparison into brackets"});
}

bool LineParser::macro_function(std::uint32_t begin) {
  std::string name;
  while (is_letter(in_.peek())) {
    name += in_.peek();
    in_.advance();
  }
  const Place place{begin, in_.length_since(begin)};
  if (name.size() == 1)
    return fail("bad_number", begin, 1,
                "a value is missing before '" + printable(name) +
                    "'; write a number, #variable or [expression]");
  const auto found = std::find_if(
      functions.begin(), functions.end(),
      [&](const Function& function) { return std::string_view(function.name).starts_with(name); });
  if (found == functions.end()) {
    std::vector<std::string> known;
    for (const Function& function : functions) known.emplace_back(function.name);
    return fail("unknown_function", begin, place.length,
                "there is no function '" + printable(name) + "'." + did_you_mean(name, known));
  }
  if (in_.peek() != '[')
    return fail("bad_expression", begin, place.length,
                std::string("the function ") + found->name + " needs its argument in brackets");
  int count = 0;
  if (!macro_arguments(count)) return false;
  const bool is_atan = found->op == Op::atan_turn;
  if (is_atan && count == 1 && in_.peek() == '/') {
    in_.advance();
    if (in_.peek() != '[')
      return fail_here("bad_expression", "the second argument of ATAN must be in brackets");
    if (!macro_arguments(count)) return false;
    count = 2;
  }
  if (count < found->least || count > found->most)
    return fail("bad_expression", begin, place.length,
                std::string("the function ") + found->name + " takes " +
                    std::to_string(found->most) + (found->most == 1 ? " argument" : " arguments"));
  Op op = found->op;
  if (is_atan) op = count == 1 ? Op::atan_one : table_.dialect().full_turn ? op : Op::atan;
  if (op == Op::asin_turn && !table_.dialect().full_turn) op = Op::asin;
  const bool length = address_ != 0 && (letter_bit(address_) & increment_letters) != 0;
  if (op == Op::round && length) op = Op::round_address;
  emit(op, place);
  return true;
}

// `[a]` or `[a, b]`.
bool LineParser::macro_arguments(int& count) {
  const int most = table_.dialect().max_brackets;
  if (++brackets_ > most)
    return fail_here("bad_expression", "more than " + std::to_string(most) +
                                           " brackets inside each other, which the control can't "
                                           "take; split the expression");
  const std::uint32_t begin = in_.position();
  in_.advance();
  const bool relation = relation_, logic = logic_;
  for (count = 1;; ++count) {
    relation_ = logic_ = false;
    if (!climb(1)) return false;
    make_solid();
    if (count == 2 || !in_.accept(',')) break;
  }
  relation_ = relation;
  logic_ = logic;
  --brackets_;
  if (in_.accept(']')) return true;
  if (in_.at_end())
    return fail_from("bad_expression", begin, "the bracket '[' is not closed; add ']'");
  return fail_here("bad_expression",
                   "expected an operator or ']' instead of " + quoted(in_.peek()));
}

bool LineParser::macro_parameter() {
  const std::uint32_t begin = in_.position();
  in_.advance();
  if (in_.peek() == '<')
    return fail_from("bad_parameter_name", begin,
                     "variables have numbers on this control, e.g. #100; #<name> is LinuxCNC's");
  if (++depth_ > 64)
    return fail_here("bad_expression", "more than 64 brackets and signs inside each other");
  const std::size_t first = out_.code.size();
  if (!operand()) return false;
  --depth_;
  const Place place{begin, in_.length_since(begin)};
  if (out_.code.size() != first + 1 || out_.code.back().op != Op::number) {
    make_solid();
    emit(Op::read_indirect, place);
    return true;
  }
  const auto index = as_integer(out_.code.back().number);
  if (!index) return fail_from("parameter_range", begin, "a variable's number must be an integer");
  out_.code.pop_back();
  // Numbers that do not exist are told when they are read.
  const Op op = *index == 0                             ? Op::vacant
                : Parameters::is_macro_variable(*index) ? Op::read
                                                        : Op::read_system;
  emit(op, place, 0, *index);
  if (*index == 3001 || *index == 3002)
    out_.warnings.push_back({"time_unknown", place,
                             "the time that has passed is not known before the run; this timer "
                             "counts 1 ms per block here"});
  return true;
}

// As it stands behind `=` and in conditions: without brackets around it.
bool LineParser::whole_expression(Value& out) {
  out.first = static_cast<std::uint32_t>(out_.code.size());
  relation_ = logic_ = false;
  if (!climb(1)) return false;
  out.count = static_cast<std::uint32_t>(out_.code.size()) - out.first;
  if (out.count == 1 && out_.code.back().op == Op::number) {
    out.number = out_.code.back().number;
    out.count = 0;
    out_.code.pop_back();
  }
  return true;
}

}  // namespace aircut::interp
