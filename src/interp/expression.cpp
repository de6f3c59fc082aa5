// The evaluator: a stack of numbers, one instruction after the other. The parser limits bracket
// depth to 64; a level holds at most five pending left operands (one per precedence) and one more
// for atan, so the stack below can't overflow.
#include "interp/expression.h"

#include <array>
#include <cmath>
#include <numbers>

#include "base/text.h"
#include "interp/macro_expression.h"
#include "interp/parameters.h"

namespace aircut::interp {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr const char* not_finite = "the result is not a finite number; keep it below 1e308";

// The control counts in long double. That shows at whole quarter turns only: sin[180] and cos[90]
// are not 0 there, and tan[90] is finite.
bool is_quarter_turn(double degrees) {
  const double quarters = degrees * (1.0 / 90);
  if (std::fabs(quarters) < 1e9) {  // most are far off: told without a division
    constexpr double to_integer = 0x1.8p52;
    const double nearest = (quarters + to_integer) - to_integer;
    if (std::fabs(quarters - nearest) > 1e-3) return false;
  }
  return degrees / 90 == std::floor(degrees / 90);
}
long double radians(double degrees) { return degrees * std::numbers::pi_v<long double> / 180; }
double sine(double x) {
  return is_quarter_turn(x) ? static_cast<double>(std::sin(radians(x))) : std::sin(x * degree);
}
double cosine(double x) {
  return is_quarter_turn(x) ? static_cast<double>(std::cos(radians(x))) : std::cos(x * degree);
}
double tangent(double x) {
  return is_quarter_turn(x) ? static_cast<double>(std::tan(radians(x))) : std::tan(x * degree);
}
// EQ and NE compare within this absolute band, the others do not (as the reference).
constexpr double equality_band = 1e-4;

struct Machine {
  Machine(const Parameters& p, std::optional<Fault>& f) : parameters(p), fault(f) {}

  const Parameters& parameters;
  std::optional<Fault>& fault;
  std::array<double, 640> stack;  // not zeroed: the depth says what is in use
  std::size_t depth = 0;

  double pop() { return stack[--depth]; }
  double& top() { return stack[depth - 1]; }
  void push(double value) { stack[depth++] = value; }

  bool fail(const Instruction& at, std::string message, const char* kind = "math_domain") {
    fault = Fault{kind, at.place, std::move(message)};
    return false;
  }

  bool read(const Instruction& at, int number) {
    const auto value = parameters.read(number, at.place, fault);
    if (!value) return false;
    push(*value);
    return true;
  }

  bool unary(const Instruction& at);
  bool binary(const Instruction& at);
  bool parameter(const Instruction& at);
  bool macro(const Instruction& at);
  bool step(const Instruction& at);
};

bool Machine::unary(const Instruction& at) {
  double& x = top();
  switch (at.op) {
    case Op::abs:
      if (x < 0) x = -x;  // as the control: -0 stays
      return true;
    case Op::tan:
      x = tangent(x);
      return true;
    case Op::exp:
      x = std::exp(x);
      return true;
    case Op::fix:
      x = std::floor(x);
      return true;
    case Op::fup:
      x = std::ceil(x);
      return true;
    case Op::round:
      x = std::round(x) + 0.0;  // the control makes an integer of it, which has no -0
      return true;
    case Op::acos:
    case Op::asin:
      if (std::fabs(x) > 1)
        return fail(at, "the argument must be from -1 to 1, this is " + shortest(x));
      x = (at.op == Op::acos ? std::acos(x) : std::asin(x)) / degree;
      return true;
    case Op::ln:
      if (x <= 0) return fail(at, "LN needs an argument above 0, this is " + shortest(x));
      x = std::log(x);
      return true;
    case Op::sqrt:
      if (x < 0) return fail(at, "SQRT needs an argument of 0 or more, this is " + shortest(x));
      x = std::sqrt(x);
      return true;
    default:
      return false;
  }
}

bool Machine::binary(const Instruction& at) {
  const double b = pop();
  double& a = top();
  const auto truth = [](bool yes) { return yes ? 1.0 : 0.0; };
  switch (at.op) {
    case Op::modulo: {
      if (b == 0) return fail(at, "MOD by zero; the right side must not be 0");
      double rest = std::fmod(a, b);
      if (rest < 0) rest += std::fabs(b);
      a = rest;
      return true;
    }
    case Op::power:
      if (a < 0 && b != std::floor(b))
        return fail(at, "a negative number can't be raised to a power that is not an integer (" +
                            shortest(a) + " ** " + shortest(b) + ")");
      a = std::pow(a, b);
      return true;
    case Op::equal:
      a = truth(std::fabs(a - b) < equality_band);
      return true;
    case Op::not_equal:
      a = truth(std::fabs(a - b) >= equality_band);
      return true;
    case Op::greater:
      a = truth(a > b);
      return true;
    case Op::greater_equal:
      a = truth(a >= b);
      return true;
    case Op::less_equal:
      a = truth(a <= b);
      return true;
    case Op::and_:
      a = truth(a != 0 && b != 0);
      return true;
    case Op::or_:
      a = truth(a != 0 || b != 0);
      return true;
    case Op::xor_:
      a = truth((a != 0) != (b != 0));
      return true;
    case Op::atan:
      a = std::atan2(a, b) / degree;
      return true;
    default:
      return false;
  }
}

bool Machine::parameter(const Instruction& at) {
  switch (at.op) {
    case Op::read_indirect: {
      const double number = pop();
      const auto index = as_integer(number);
      if (!index)
        return fail(at, "a parameter's number must be an integer, this is " + shortest(number),
                    "parameter_range");
      return read(at, *index);
    }
    case Op::exists: {
      const auto index = as_integer(top());
      if (!index)
        return fail(at, "a parameter's number must be an integer, this is " + shortest(top()),
                    "parameter_range");
      top() = Parameters::in_range(*index) ? 1 : 0;
      return true;
    }
    case Op::exists_named:
      push(parameters.exists(at.id) ? 1 : 0);
      return true;
    default: {
      const auto value = parameters.read_named(at.id, at.place, fault);
      if (!value) return false;
      push(*value);
      return true;
    }
  }
}

bool Machine::macro(const Instruction& at) {
  if (at.op == Op::read_system) return read(at, at.id);
  if (at.op == Op::vacant) {
    push(vacant_value);
    return true;
  }
  const bool two = at.op >= Op::same;
  const double b = two ? pop() : 0;
  std::string problem;
  const auto value = macro_operation(at.op, top(), b, parameters, problem);
  if (!value) return fail(at, std::move(problem));
  top() = *value;
  return true;
}

bool Machine::step(const Instruction& at) {
  if (at.op == Op::read) return read(at, at.id);
  if (is_macro(at.op)) return macro(at);
  const bool is_parameter = at.op > Op::read && at.op <= Op::exists_named;
  const bool is_binary = (at.op >= Op::power && at.op <= Op::xor_) || at.op == Op::atan;
  if (is_parameter) return parameter(at);  // may be vacant
  if (!(is_binary ? binary(at) : unary(at))) return false;
  return std::isfinite(top()) || fail(at, not_finite);
}

}  // namespace

namespace {

// An operation together with the place of its right operand: one jump for both.
constexpr int key(Op op, Right right) { return static_cast<int>(op) * 3 + static_cast<int>(right); }

}  // namespace

// The top of the stack is kept in a register. What loops are made of is done here; the rest by the
// machine, which sees the same stack.
bool evaluate(const Value& value, const Code& code, const Parameters& parameters, double& number,
              std::optional<Fault>& fault) {
  if (value.constant()) {
    number = value.number;
    return true;
  }
  Machine machine(parameters, fault);
  double* below = machine.stack.data();  // one behind the operands below the top
  double top = 0;                        // the first push puts this aside, and nobody takes it
  const auto push = [&](double value_on_top) {
    *below++ = top;
    top = value_on_top;
  };
  const Instruction* at = code.data() + value.first;
  const Instruction* const end = at + value.count;
  const auto parameter = [&] { return parameters.stored(at->id); };
  for (; at != end; ++at) {
    switch (key(at->op, at->right)) {
      case key(Op::number, Right::stack):
        push(at->number);
        continue;
      case key(Op::less, Right::stack):
        top = *--below < top ? 1 : 0;
        continue;
      case key(Op::less, Right::number):
        top = top < at->number ? 1 : 0;
        continue;
      case key(Op::less, Right::parameter):
        top = top < parameter() ? 1 : 0;
        continue;
      case key(Op::add, Right::stack):
        top = *--below + top;
        break;
      case key(Op::add, Right::number):
        top = top + at->number;
        break;
      case key(Op::add, Right::parameter):
        top = top + parameter();
        break;
      case key(Op::subtract, Right::stack):
        top = *--below - top;
        break;
      case key(Op::subtract, Right::number):
        top = top - at->number;
        break;
      case key(Op::subtract, Right::parameter):
        top = top - parameter();
        break;
      case key(Op::multiply, Right::stack):
        top = *--below * top;
        break;
      case key(Op::multiply, Right::number):
        top = top * at->number;
        break;
      case key(Op::multiply, Right::parameter):
        top = top * parameter();
        break;
      case key(Op::divide, Right::stack):
      case key(Op::divide, Right::number):
      case key(Op::divide, Right::parameter): {
        const double right = at->right == Right::stack    ? top
                             : at->right == Right::number ? at->number
                                                          : parameter();
        if (right == 0) {
          return machine.fail(*at, "division by zero; the divisor must not be 0");
        }
        top = (at->right == Right::stack ? *--below : top) / right;
        break;
      }
      case key(Op::negate, Right::stack):
        top = -top;
        continue;
      case key(Op::cos, Right::stack):
        top = cosine(top);
        break;
      case key(Op::cos, Right::parameter):
        push(cosine(parameter()));
        break;
      case key(Op::sin, Right::stack):
        top = sine(top);
        break;
      case key(Op::sin, Right::parameter):
        push(sine(parameter()));
        break;
      case key(Op::read, Right::stack):
        if (Parameters::always_readable(at->id)) {
          push(parameter());
          continue;
        }
        [[fallthrough]];
      default:
        if (at->right == Right::number) push(at->number);
        if (at->right == Right::parameter) push(parameter());
        push(0);  // puts the top on the machine's stack
        machine.depth = static_cast<std::size_t>(below - machine.stack.data());
        if (!machine.step(*at)) return false;
        top = machine.pop();
        below = machine.stack.data() + machine.depth;
        continue;
    }
    if (!std::isfinite(top)) return machine.fail(*at, not_finite);
  }
  number = top;
  return true;
}

std::optional<int> as_integer(double value) {
  const double nearest = std::round(value);
  if (!(std::fabs(value - nearest) <= 1e-4) || std::fabs(nearest) > 1e9) return std::nullopt;
  return static_cast<int>(nearest);
}

}  // namespace aircut::interp
