// Values: numbers, parameters, functions, expressions. Compiled by precedence climbing; all binary
// operators are left associative:
//   5  **    4  * / MOD    3  + -    2  EQ NE GT GE LT LE    1  AND OR XOR
// A unary minus belongs to the value behind it, so [-2**2] is 4.
#include <array>
#include <cmath>
#include <utility>

#include "interp/dialect.h"
#include "interp/line_parser.h"

namespace aircut::interp {
namespace {

constexpr int max_bracket_depth = 64;

struct Function {
  const char* name;
  Op op;
};
constexpr std::array<Function, 14> functions = {{{"abs", Op::abs},
                                                 {"acos", Op::acos},
                                                 {"asin", Op::asin},
                                                 {"atan", Op::atan},
                                                 {"cos", Op::cos},
                                                 {"exp", Op::exp},
                                                 {"exists", Op::exists},
                                                 {"fix", Op::fix},
                                                 {"fup", Op::fup},
                                                 {"ln", Op::ln},
                                                 {"round", Op::round},
                                                 {"sin", Op::sin},
                                                 {"sqrt", Op::sqrt},
                                                 {"tan", Op::tan}}};

constexpr std::array<Operator, 15> operators = {{{"**", Op::power, 5},
                                                 {"*", Op::multiply, 4},
                                                 {"/", Op::divide, 4},
                                                 {"mod", Op::modulo, 4},
                                                 {"+", Op::add, 3},
                                                 {"-", Op::subtract, 3},
                                                 {"eq", Op::equal, 2},
                                                 {"ne", Op::not_equal, 2},
                                                 {"gt", Op::greater, 2},
                                                 {"ge", Op::greater_equal, 2},
                                                 {"lt", Op::less, 2},
                                                 {"le", Op::less_equal, 2},
                                                 {"and", Op::and_, 1},
                                                 {"or", Op::or_, 1},
                                                 {"xor", Op::xor_, 1}}};

}  // namespace

// A plain number needs no instructions; everything else is compiled.
bool LineParser::value(Value& out) {
  const std::uint32_t begin = in_.position();
  const char c = in_.peek();
  const bool sign = c == '-' || c == '+';
  if (sign) in_.advance();
  if (in_.read_digits(out.number)) {
    const char next = in_.peek();
    if (next == '.' || next == ',' || !std::isfinite(out.number))
      if (!number_may_end(begin, out.number)) return false;
    if (c == '-') out.number = -out.number;
    return true;
  }
  if (in_.peek() == '.') return fail_from("bad_number", begin, "a number needs at least one digit");
  if (sign) in_.go_to(begin);
  return compiled_value(out);
}

bool LineParser::number_may_end(std::uint32_t begin, double number) {
  if (!std::isfinite(number))
    return fail_from("bad_number", begin, "the number is too large; keep it below 1e308");
  if (in_.peek() == '.')
    return fail_here("bad_number", "a second decimal point; a number has at most one");
  if (table_.dialect().macro_b) return true;
  return fail_here("bad_number", "a comma inside a number; decimals are written with a point");
}

bool LineParser::compiled_value(Value& out) {
  out.first = static_cast<std::uint32_t>(out_.code.size());
  if (!operand()) return false;
  out.count = static_cast<std::uint32_t>(out_.code.size()) - out.first;
  if (out.count == 1 && out_.code.back().op == Op::number) {
    out.number = out_.code.back().number;
    out.count = 0;
    out_.code.pop_back();
  }
  return true;
}

// A value as it may stand behind a letter or between operators.
bool LineParser::operand() {
  const std::uint32_t begin = in_.position();
  const char c = in_.peek();
  if (c == '[') return expression_in_brackets();
  if (c == '#') return parameter(false);
  if (c == '-' || c == '+') {
    if (++depth_ > max_bracket_depth)
      return fail_here("bad_expression", "more than 64 brackets and signs inside each other");
    in_.advance();
    if (!operand()) return false;
    --depth_;
    if (c == '-') emit(table_.dialect().macro_b ? Op::negate_or_vacant : Op::negate, {begin, 1});
    return true;
  }
  if (is_letter(c)) return function(begin);
  if (is_digit(c) || c == '.') {
    double number = 0;
    if (!in_.read_digits(number))
      return fail_from("bad_number", begin, "a number needs at least one digit");
    if (!std::isfinite(number))
      return fail_from("bad_number", begin, "the number is too large; keep it below 1e308");
    if (in_.peek() == '.')
      return fail_here("bad_number", "a second decimal point; a number has at most one");
    emit(Op::number, {begin, in_.length_since(begin)}, number);
    return true;
  }
  if (in_.at_end())
    return fail("bad_number", begin, 0, "a value is missing at the end of the line");
  return fail_here("bad_number", "a value is missing before " + quoted(c) +
                                     "; write a number, #parameter, [expression] or function");
}

bool LineParser::expression_in_brackets() {
  const std::uint32_t begin = in_.position();
  if (++depth_ > max_bracket_depth)
    return fail_here("bad_expression", "more than 64 brackets and signs inside each other");
  const int most = table_.dialect().max_brackets;
  if (++brackets_ > most)
    return fail_here("bad_expression", "more than " + std::to_string(most) +
                                           " brackets inside each other, which the control can't "
                                           "take; split the expression");
  in_.advance();
  const bool relation = std::exchange(relation_, false), logic = std::exchange(logic_, false);
  if (!climb(1)) return false;
  relation_ = relation;
  logic_ = logic;
  if (!in_.accept(']')) {
    if (in_.at_end())
      return fail_from("bad_expression", begin, "the bracket '[' is not closed; add ']'");
    if (is_letter(in_.peek()))
      return fail_here("unknown_operator",
                       "not an operator; known are ** * / MOD + - EQ NE GT GE LT LE AND OR XOR");
    return fail_here("bad_expression",
                     "expected an operator or ']' instead of " + quoted(in_.peek()));
  }
  --brackets_;
  --depth_;
  return true;
}

const Operator* LineParser::peek_operator() {
  const std::uint32_t begin = in_.position();
  const char c = in_.peek();
  if (c == ']' || in_.at_end()) return nullptr;
  for (const Operator& op :
       table_.dialect().macro_b ? macro_operators() : std::span<const Operator>(operators)) {
    if (op.name[0] != c) continue;
    const bool found = in_.accept_word(op.name);
    in_.go_to(begin);
    if (found) return &op;
  }
  return nullptr;
}

bool LineParser::climb(int level) {
  const std::size_t left = out_.code.size();
  if (!operand()) return false;
  while (true) {
    const Operator* op = peek_operator();
    if (!op || op->level < level) return true;
    const std::uint32_t begin = in_.position();
    in_.accept_word(op->name);
    const Place place{begin, in_.length_since(begin)};
    // Only EQ and NE of macro B tell a vacant variable from 0.
    const bool sees_vacant = op->op == Op::same || op->op == Op::not_same;
    if (table_.dialect().macro_b) note_logic(*op, place);
    if (!sees_vacant) make_solid();
    const std::size_t right = out_.code.size();
    if (!climb(op->level + 1)) return false;
    if (!sees_vacant) make_solid();
    emit_binary(op->op, place, left, right);
  }
}

// A right operand that is a number or a parameter as most are goes into the instruction itself: the
// last instruction pushes only if it is the whole of the operand. A number on the left of + or *
// may as well stand on the right. The operands' instructions begin at `left` and `right`.
void LineParser::emit_binary(Op op, Place place, std::size_t left, std::size_t right) {
  Instruction& last = out_.code.back();
  const bool plain = last.op == Op::read && Parameters::always_readable(last.id);
  if (last.op == Op::number || plain) {
    last.right = plain ? Right::parameter : Right::number;
    last.op = op;
    last.place = place;
    return;
  }
  const bool swaps = (op == Op::add || op == Op::multiply) && right == left + 1 &&
                     out_.code[left].op == Op::number;
  if (!swaps) return emit(op, place);
  const double number = out_.code[left].number;
  out_.code.erase(out_.code.begin() + static_cast<std::ptrdiff_t>(left));
  emit(op, place, number);
  out_.code.back().right = Right::number;
}

// The same for the operand of a function.
void LineParser::emit_unary(Op op, Place place) {
  Instruction& last = out_.code.back();
  if (last.op != Op::read || !Parameters::always_readable(last.id)) return emit(op, place);
  last.right = Right::parameter;
  last.op = op;
  last.place = place;
}

bool LineParser::function(std::uint32_t begin) {
  if (table_.dialect().macro_b) return macro_function(begin);
  for (const Function& known : functions) {
    if (!in_.accept_word(known.name)) continue;
    if (is_letter(in_.peek())) {  // the beginning of another name
      in_.go_to(begin);
      continue;
    }
    const Place place{begin, in_.length_since(begin)};
    if (in_.peek() != '[')
      return fail_from(
          "bad_expression", begin,
          std::string("the function ") + known.name + " needs its argument in brackets");
    if (known.op == Op::exists) return exists(begin);
    if (!expression_in_brackets()) return false;
    if (known.op != Op::atan) {
      emit_unary(known.op, place);
      return true;
    }
    if (!in_.accept('/'))
      return fail_here("bad_expression", "ATAN needs two arguments: atan[y]/[x]");
    if (in_.peek() != '[')
      return fail_here("bad_expression", "the second argument of ATAN must be in brackets");
    if (!expression_in_brackets()) return false;
    emit(known.op, place);
    return true;
  }
  std::uint32_t end = begin;
  const std::string_view line = in_.line();
  while (end < line.size() && is_letter(static_cast<char>(line[end] | 32))) ++end;
  const std::string_view name = line.substr(begin, end - begin);
  if (name.size() == 1 || !in_.line().substr(end).starts_with("["))
    return fail("bad_number", begin, end - begin,
                "a value is missing before '" + printable(name) +
                    "'; write a number, #parameter, [expression] or function");
  std::vector<std::string> known;
  for (const Function& f : functions) known.emplace_back(f.name);
  std::string lower(name);
  for (char& c : lower) c = static_cast<char>(c | 32);
  return fail("unknown_function", begin, end - begin,
              "there is no function '" + printable(name) + "'." + did_you_mean(lower, known));
}

bool LineParser::exists(std::uint32_t begin) {
  in_.advance();  // the bracket
  if (in_.peek() != '#')
    return fail_here("bad_expression", "EXISTS takes a parameter, e.g. EXISTS[#<name>]");
  if (!parameter(true)) return false;
  if (!in_.accept(']'))
    return fail_here("bad_expression", "EXISTS takes a single parameter; ']' is missing");
  static_cast<void>(begin);
  return true;
}

bool LineParser::parameter(bool only_exists) {
  if (table_.dialect().macro_b) return macro_parameter();
  const std::uint32_t begin = in_.position();
  in_.advance();
  if (in_.peek() == '<') {
    const auto name = name_in_angles();
    if (!name) return false;
    if (parameters_.too_many_names())
      return fail_from("limit_reached", begin, "more than 100000 named parameters");
    emit(only_exists ? Op::exists_named : Op::read_named, {begin, in_.length_since(begin)}, 0,
         parameters_.intern(*name));
    return true;
  }
  if (++depth_ > max_bracket_depth)
    return fail_here("bad_expression", "more than 64 brackets and signs inside each other");
  const std::size_t first = out_.code.size();
  if (!operand()) return false;
  --depth_;
  const Place place{begin, in_.length_since(begin)};
  if (only_exists) {
    emit(Op::exists, place);
    return true;
  }
  // A constant number is looked up without the stack.
  if (out_.code.size() == first + 1 && out_.code.back().op == Op::number) {
    const auto index = as_integer(out_.code.back().number);
    if (!index)
      return fail_from("parameter_range", begin, "a parameter's number must be an integer");
    out_.code.pop_back();
    emit(Op::read, place, 0, *index);
    return true;
  }
  emit(Op::read_indirect, place);
  return true;
}

std::optional<std::string> LineParser::name_in_angles() {
  const std::uint32_t begin = in_.position();
  in_.advance();
  std::string name;
  while (!in_.at_end() && in_.peek() != '>') {
    if (in_.peek() == '<' || in_.peek() == '(' || in_.peek() == ';') break;
    name += in_.peek();
    in_.advance();
  }
  if (!in_.accept('>')) {
    fail_from("bad_parameter_name", begin, "the name is not closed; add '>'");
    return std::nullopt;
  }
  if (name.empty()) {
    fail_from("bad_parameter_name", begin, "a name between '<' and '>' is missing");
    return std::nullopt;
  }
  return name;
}

}  // namespace aircut::interp
