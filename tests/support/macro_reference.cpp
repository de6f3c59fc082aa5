#include "support/macro_reference.h"

#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <sstream>

namespace aircut::test {
namespace {

constexpr double degree = std::numbers::pi / 180;

struct Failed {};

class Reader {
 public:
  Reader(std::string text, std::map<int, double>& variables)
      : text_(std::move(text)), variables_(variables) {}

  // comparison := sum { (EQ|NE|…) sum }
  MacroValue comparison() {
    MacroValue left = sum();
    while (true) {
      const std::string op = take({"EQ", "NE", "GT", "GE", "LT", "LE"});
      if (op.empty()) return left;
      const MacroValue right = sum();
      const double a = left.value_or(0), b = right.value_or(0);
      const bool alike = left.has_value() == right.has_value() && a == b;
      const bool yes = op == "EQ"   ? alike
                       : op == "NE" ? !alike
                       : op == "GT" ? a > b
                       : op == "GE" ? a >= b
                       : op == "LT" ? a < b
                                    : a <= b;
      left = yes ? 1 : 0;
    }
  }

  bool take_word(const std::string& word) { return !take({word}).empty(); }
  int take_integer() { return static_cast<int>(number()); }
  bool at_end() const { return at_ >= text_.size(); }

 private:
  std::string take(const std::vector<std::string>& words) {
    for (const std::string& word : words)
      if (text_.compare(at_, word.size(), word) == 0) {
        at_ += word.size();
        return word;
      }
    return {};
  }

  static std::int64_t bits(double value) {
    const double whole = std::trunc(value);
    if (whole < 0 || whole > 4294967295.0) throw Failed{};
    return static_cast<std::int64_t>(whole);
  }

  static double finite(double value) {
    if (!std::isfinite(value)) throw Failed{};
    return value;
  }

  // sum := product { (+ | - | XOR | OR) product }
  MacroValue sum() {
    MacroValue left = product();
    while (true) {
      const std::string op = take({"+", "-", "XOR", "OR"});
      if (op.empty()) return left;
      const double b = product().value_or(0), a = left.value_or(0);
      if (op == "+") left = finite(a + b);
      if (op == "-") left = finite(a - b);
      if (op == "OR") left = static_cast<double>(bits(a) | bits(b));
      if (op == "XOR") left = static_cast<double>(bits(a) ^ bits(b));
    }
  }

  // product := operand { (* | / | MOD | AND) operand }
  MacroValue product() {
    MacroValue left = operand();
    while (true) {
      const std::string op = take({"*", "/", "MOD", "AND"});
      if (op.empty()) return left;
      const double b = operand().value_or(0), a = left.value_or(0);
      if ((op == "/" || op == "MOD") && b == 0) throw Failed{};
      if (op == "*") left = finite(a * b);
      if (op == "/") left = finite(a / b);
      if (op == "MOD") left = std::fmod(a, b);
      if (op == "AND") left = static_cast<double>(bits(a) & bits(b));
    }
  }

  MacroValue operand() {
    if (take_word("-")) {
      const MacroValue value = operand();
      return value ? MacroValue(-*value) : value;
    }
    if (take_word("[")) {
      const MacroValue value = comparison();
      take_word("]");
      return value;
    }
    if (take_word("#")) {
      const int index = static_cast<int>(std::lround(operand().value_or(0)));
      const auto found = variables_.find(index);
      return found == variables_.end() ? MacroValue() : MacroValue(found->second);
    }
    const std::string name = take({"SIN", "COS", "ABS", "ROUND", "FIX", "FUP", "SQRT", "ATAN"});
    if (name.empty()) return number();
    take_word("[");
    const double x = comparison().value_or(0);
    take_word("]");
    if (name == "SIN") return std::sin(x * degree);
    if (name == "COS") return std::cos(x * degree);
    if (name == "ABS") return x < 0 ? -x : x;
    if (name == "ROUND") return x < 0 ? -std::floor(0.5 - x) : std::floor(x + 0.5);
    if (name == "FIX") return x < 0 ? -std::floor(-x) : std::floor(x);
    if (name == "FUP") return x < 0 ? -std::ceil(-x) : std::ceil(x);
    if (name == "SQRT") {
      if (x < 0) throw Failed{};
      return std::sqrt(x);
    }
    take_word("/[");
    const double second = comparison().value_or(0);
    take_word("]");
    const double turn = std::atan2(x, second) / degree;
    return turn < 0 ? turn + 360 : turn;
  }

  double number() {
    std::size_t end = at_;
    while (end < text_.size() &&
           (std::isdigit(static_cast<unsigned char>(text_[end])) || text_[end] == '.'))
      ++end;
    const std::string digits = text_.substr(at_, end - at_);
    at_ = end;
    return digits.empty() ? 0 : std::stod(digits);
  }

  std::string text_;
  std::size_t at_ = 0;
  std::map<int, double>& variables_;
};

struct Program {
  std::vector<std::string> lines;  ///< without blanks
  std::map<int, std::size_t> blocks;
};

Program split(const std::string& text) {
  Program program;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    std::erase(line, ' ');
    if (!line.empty() && line[0] == 'N') {
      std::size_t end = 1;
      while (end < line.size() && std::isdigit(static_cast<unsigned char>(line[end]))) ++end;
      program.blocks[std::stoi(line.substr(1, end - 1))] = program.lines.size();
      line.erase(0, end);
    }
    program.lines.push_back(line);
  }
  return program;
}

// The DO that an END at `at` belongs to, or the END of a DO: the numbers never nest in themselves.
std::size_t partner(const Program& program, std::size_t at, const std::string& wanted, int step) {
  while (true) {
    at = step > 0 ? at + 1 : at - 1;
    const std::string& line = program.lines[at];
    if (line.size() >= wanted.size() && line.ends_with(wanted)) return at;
  }
}

class Run {
 public:
  Run(const Program& program, MacroResult& result) : program_(program), result_(result) {}

  void go(int most_steps) {
    for (int step = 0; at_ < program_.lines.size(); ++step) {
      if (step > most_steps) {
        result_.too_long = true;
        return;
      }
      const std::size_t here = at_++;
      if (program_.lines[here] == "M30") return;
      try {
        line(here);
      } catch (const Failed&) {
        result_.failed_lines.push_back(static_cast<int>(here) + 1);
        // A condition that can't be computed counts as false.
        if (program_.lines[here].starts_with("WHILE"))
          at_ = partner(program_, here,
                        "END" + program_.lines[here].substr(program_.lines[here].size() - 1), 1) +
                1;
      }
    }
  }

 private:
  void line(std::size_t here) {
    const std::string& text = program_.lines[here];
    Reader reader(text, result_.variables);
    const std::string number = text.empty() ? "" : text.substr(text.size() - 1);
    if (text.starts_with("#")) return set(reader);
    if (reader.take_word("GOTO")) {
      at_ = program_.blocks.at(reader.take_integer());
    } else if (reader.take_word("IF")) {
      if (reader.comparison().value_or(0) == 0) return;
      if (reader.take_word("GOTO"))
        at_ = program_.blocks.at(reader.take_integer());
      else if (reader.take_word("THEN"))
        set(reader);
    } else if (reader.take_word("WHILE")) {
      if (reader.comparison().value_or(0) == 0)
        at_ = partner(program_, here, "END" + number, 1) + 1;
    } else if (reader.take_word("END")) {
      at_ = partner(program_, here, "DO" + number, -1);
    } else if (reader.take_word("DPRNT[#")) {
      const auto found = result_.variables.find(reader.take_integer());
      std::array<char, 64> out{};
      std::snprintf(out.data(), out.size(), "%.6f",
                    found == result_.variables.end() ? 0 : found->second);
      result_.output.push_back(out.data());
    }
  }

  void set(Reader& reader) {
    reader.take_word("#");
    const int target = reader.take_integer();
    reader.take_word("=");
    const MacroValue value = reader.comparison();
    if (value)
      result_.variables[target] = *value;
    else
      result_.variables.erase(target);
  }

  const Program& program_;
  MacroResult& result_;
  std::size_t at_ = 0;
};

}  // namespace

MacroResult run_macro_reference(const std::string& text, int most_steps) {
  MacroResult result;
  const Program program = split(text);
  Run(program, result).go(most_steps);
  return result;
}

}  // namespace aircut::test
