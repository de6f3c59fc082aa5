#include "interp/macro_expression.h"

#include <cstdint>
#include <numbers>

#include "base/text.h"
#include "interp/parameters.h"

namespace aircut::interp {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double largest_bits = 4294967295.0;  // the control works on 32 bits

std::optional<std::uint64_t> bits_of(double value, std::string& problem) {
  const double whole = std::trunc(value);
  if (whole >= 0 && whole <= largest_bits) return static_cast<std::uint64_t>(whole);
  problem = "AND, OR, XOR, BIN and BCD work on whole numbers from 0 to 4294967295, this is " +
            shortest(value);
  return std::nullopt;
}

std::optional<double> from_bcd(std::uint64_t bits, std::string& problem) {
  double value = 0, place = 1;
  for (; bits != 0; bits >>= 4, place *= 10) {
    if ((bits & 15) > 9) {
      problem = "BIN needs a binary coded decimal; a group of four bits is above 9";
      return std::nullopt;
    }
    value += static_cast<double>(bits & 15) * place;
  }
  return value;
}

std::optional<double> to_bcd(std::uint64_t value, std::string& problem) {
  if (value > 99'999'999) {
    problem = "BCD takes at most 99999999, this is " + std::to_string(value);
    return std::nullopt;
  }
  std::uint64_t bits = 0;
  for (unsigned shift = 0; value != 0; value /= 10, shift += 4) bits |= (value % 10) << shift;
  return static_cast<double>(bits);
}

std::optional<double> on_bits(Op op, double a, double b, std::string& problem) {
  const auto first = bits_of(a, problem);
  if (!first) return std::nullopt;
  if (op == Op::bin) return from_bcd(*first, problem);
  if (op == Op::bcd) return to_bcd(*first, problem);
  const auto second = bits_of(b, problem);
  if (!second) return std::nullopt;
  const std::uint64_t bits = op == Op::and_bits  ? *first & *second
                             : op == Op::or_bits ? *first | *second
                                                 : *first ^ *second;
  return static_cast<double>(bits);
}

double full_turn(double degrees) { return degrees < 0 ? degrees + 360 : degrees; }

}  // namespace

double rounded_to(double value, double per_unit) {
  const double scaled = std::round(value * per_unit) / per_unit;
  return std::isfinite(scaled) ? scaled : value;
}

std::optional<double> macro_operation(Op op, double a, double b, const Parameters& parameters,
                                      std::string& problem) {
  switch (op) {
    case Op::make_solid:
      return is_vacant(a) ? 0 : a;
    case Op::negate_or_vacant:
      return -a;
    case Op::truncate:
      return std::trunc(a);
    case Op::away:
      return a < 0 ? std::floor(a) : std::ceil(a);
    case Op::round_address:
      return rounded_to(a, parameters.increments_per_unit());
    case Op::asin_turn:
      if (std::fabs(a) <= 1) return full_turn(std::asin(a) / degree);
      problem = "the argument must be from -1 to 1, this is " + shortest(a);
      return std::nullopt;
    case Op::atan_one:
      return std::atan(a) / degree;
    case Op::atan_turn:
      return full_turn(std::atan2(a, b) / degree);
    case Op::same:
      return is_vacant(a) || is_vacant(b) ? is_vacant(a) && is_vacant(b) : a == b;
    case Op::not_same:
      return is_vacant(a) || is_vacant(b) ? is_vacant(a) != is_vacant(b) : a != b;
    case Op::remainder:
      if (b != 0) return std::fmod(a, b);
      problem = "MOD by zero; the right side must not be 0";
      return std::nullopt;
    case Op::bin:
    case Op::bcd:
    case Op::and_bits:
    case Op::or_bits:
    case Op::xor_bits:
      return on_bits(op, a, b, problem);
    default:
      problem = "not an operation of macro B";
      return std::nullopt;
  }
}

}  // namespace aircut::interp
