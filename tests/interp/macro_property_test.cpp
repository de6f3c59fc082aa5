// Programs of macro B made by chance, run by the interpreter and by a reader that shares nothing
// with it: what they write, which lines fail, and what the kept variables hold must agree.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "base/text.h"
#include "interp/run_program.h"
#include "support/macro_reference.h"

namespace aircut::test {
namespace {

/// #501-#508 are free for expressions, #511… count loops.
class Generator {
 public:
  explicit Generator(unsigned seed) : random_(seed) {}

  std::string program() {
    statements(12, 0);
    for (int n = 501; n <= 508; ++n) write(n);
    line("M30");
    return text_;
  }

 private:
  int below(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }
  void line(const std::string& text) { text_ += text + "\n"; }
  std::string variable() { return "#" + std::to_string(501 + below(8)); }
  void write(int n) { line("DPRNT[#" + std::to_string(n) + "[86]]"); }

  std::string operand(int depth) {
    switch (below(depth > 2 ? 4 : 8)) {
      case 0:
      case 1:
        return variable();
      case 2:
        return std::to_string(below(20));
      case 3:
        return std::to_string(below(9)) + "." + std::to_string(below(1000));
      case 4:
        return "-" + variable();
      case 5:
        return "[" + expression(depth + 1) + "]";
      case 6:
        return "#[500+" + std::to_string(1 + below(8)) + "]";
      default: {
        const char* names[] = {"SIN", "COS", "ABS", "ROUND", "FIX", "FUP", "SQRT", "ATAN"};
        const int which = below(8);
        std::string call = std::string(names[which]) + "[" + expression(depth + 1) + "]";
        if (which == 7) call += "/[" + expression(depth + 1) + "]";
        return call;
      }
    }
  }

  std::string expression(int depth) {
    const char* operators[] = {"+", "-", "*", "/", " MOD ", " AND ", " OR ", " XOR ", "+", "*"};
    std::string text = operand(depth);
    for (int n = below(3); n > 0; --n) text += operators[below(10)] + operand(depth);
    return text;
  }

  std::string condition() {
    const char* relations[] = {" EQ ", " NE ", " GT ", " GE ", " LT ", " LE "};
    const std::string right = below(4) == 0 ? "#0" : expression(2);
    return "[" + expression(2) + relations[below(6)] + right + "]";
  }

  // Results are brought back to a size at which six decimals are exact.
  void setting() {
    const std::string target = variable();
    line(target + "=" + (below(8) == 0 ? "#0" : below(6) == 0 ? variable() : expression(0)));
    if (below(2) == 0) line("IF [ABS[" + target + "] GT 1000] THEN " + target + "=7.5");
  }

  void statements(int count, int loops) {
    for (; count > 0; --count) {
      switch (below(8)) {
        case 0:
          skip();
          break;
        case 1:
          if (loops < 3) while_loop(loops);
          break;
        case 2:
          if (loops == 0) goto_loop();
          break;
        case 3:
          line("IF " + condition() + " THEN " + variable() + "=" + expression(1));
          break;
        case 4:
          write(501 + below(8));
          break;
        default:
          setting();
      }
    }
  }

  void skip() {
    const std::string label = std::to_string(++label_ * 10);
    line("IF " + condition() + " GOTO " + label);
    setting();
    line("N" + label + " " + variable() + "=" + std::to_string(below(50)));
  }

  void while_loop(int loops) {
    const std::string counter = "#" + std::to_string(511 + loops);
    const std::string number = std::to_string(loops + 1);
    const std::string label = std::to_string(++label_ * 10);
    line(counter + "=0");
    line("WHILE [" + counter + " LT " + std::to_string(below(5)) + "] DO" + number);
    line(counter + "=" + counter + "+1");
    statements(3, loops + 1);
    if (below(3) == 0) line("IF " + condition() + " GOTO " + label);
    line("END" + number);
    line("N" + label + " " + variable() + "=" + counter);
  }

  void goto_loop() {
    const std::string counter = "#" + std::to_string(515 + label_ % 20);
    const std::string label = std::to_string(++label_ * 10);
    line(counter + "=0");
    line("N" + label + " " + counter + "=" + counter + "+1");
    statements(2, 3);
    line("IF [" + counter + " LT " + std::to_string(1 + below(5)) + "] GOTO " + label);
  }

  std::mt19937 random_;
  std::string text_;
  int label_ = 0;
};

bool close(double a, double b) {
  return std::fabs(a - b) <= 1e-6 * std::max(1.0, std::max(std::fabs(a), std::fabs(b)));
}

TEST(MacroPrograms, MadeByChanceDoWhatAnotherReaderSays) {
  int written = 0, failed = 0;
  for (unsigned seed = 1; seed <= 400; ++seed) {
    const std::string program = Generator(seed).program();
    const MacroResult expected = run_macro_reference(program, 200'000);
    ASSERT_FALSE(expected.too_long);
    SourceMap sources;
    Setting setting;
    setting.options.dialect = interp::Dialect::fanuc;
    const Ran ran = run_program(sources, program, setting);
    std::vector<std::string> output;
    for (const canon::Command& command : ran.commands)
      if (const auto* message = std::get_if<canon::Message>(&command.action))
        output.push_back(message->text);
    ASSERT_EQ(output.size(), expected.output.size()) << "seed " << seed << "\n" << program;
    for (std::size_t i = 0; i < output.size(); ++i) {
      const std::size_t digits = output[i].find_first_not_of(' ');
      const double is = parse_number(output[i].substr(digits)).value_or(NAN);
      ASSERT_TRUE(close(is, std::stod(expected.output[i])))
          << "seed " << seed << ", output " << i << ": " << is << " instead of "
          << expected.output[i] << "\n"
          << program;
    }
    std::set<int> wrong_lines,
        expected_lines(expected.failed_lines.begin(), expected.failed_lines.end());
    for (const Diagnostic& d : ran.diagnostics.list())
      if (d.severity == Severity::error) {
        wrong_lines.insert(static_cast<int>(d.span.line));
        EXPECT_EQ(d.kind, "math_domain") << "seed " << seed << "\n" << format_gcc(d);
      }
    ASSERT_EQ(wrong_lines, expected_lines) << "seed " << seed << "\n" << program;
    for (const auto& [number, value] : ran.parameters.values) {
      if (number < 500 || number > 999) continue;
      ASSERT_TRUE(expected.variables.contains(number)) << "seed " << seed << " #" << number;
      ASSERT_TRUE(close(value, expected.variables.at(number))) << "seed " << seed << " #" << number;
    }
    written += static_cast<int>(output.size());
    failed += static_cast<int>(wrong_lines.size());
  }
  EXPECT_GT(written, 3000);
  EXPECT_GT(failed, 50) << "programs that fail are part of the test";
}

TEST(MacroPrograms, AreToldFromThoseOfOtherControls) {
  using interp::Dialect;
  const auto guess = [](const char* text) { return interp::guess_dialect(text).dialect; };
  EXPECT_EQ(guess("G0 X1\nM2\n"), std::nullopt);
  EXPECT_EQ(guess("%\nO1234 (PART)\nG0 X1.\nM30\n%\n"), Dialect::fanuc);
  EXPECT_EQ(guess("G0 X1.\n#100=#101+2\n"), Dialect::fanuc);
  EXPECT_EQ(guess("#100=[#101+2]\nG64 P0.01\n"), std::nullopt);
  EXPECT_EQ(guess("o100 sub\no100 endsub\n"), Dialect::linuxcnc);
  EXPECT_EQ(guess("; IF [#1 EQ 2] GOTO 5\n#<depth> = 3\n"), Dialect::linuxcnc);
  EXPECT_EQ(guess("(O1234)\nN10 if [#1 eq 2] goto 5\n"), Dialect::fanuc);
  EXPECT_EQ(guess("%\nO01000\nM97 P100\n"), Dialect::haas);
  EXPECT_EQ(guess("G65 P9000 A1.\n"), Dialect::fanuc);
  EXPECT_EQ(guess(""), std::nullopt);
}

TEST(MacroPrograms, GetAdviceWhenTheyAreReadAsLinuxCncs) {
  for (const char* line :
       {"IF [#100 EQ 1] GOTO 10", "#100=#101+1", "G65 P9000 A1.", "WHILE [#1 LT 5] DO1"}) {
    SourceMap sources;
    const Ran ran = run_program(sources, std::string("G21\nG0 X1\n") + line + "\nM2\n");
    ASSERT_FALSE(ran.diagnostics.list().empty()) << line;
    const auto& notes = ran.diagnostics.list().front().notes;
    ASSERT_EQ(notes.size(), 1u) << line;
    EXPECT_NE(notes[0].text.find("--dialect fanuc"), std::string::npos) << line;
  }
}

TEST(MacroPrograms, TakeWholeUnitsWhenTheControlDoes) {
  SourceMap sources;
  Setting setting;
  setting.options.dialect = interp::Dialect::fanuc;
  setting.options.whole_units = true;
  const Ran ran = run_program(sources, "O1\nG0 X10 Y-3\nM30\n", setting);
  EXPECT_EQ(ran.texts.front(), "rapid X10 Y-3 Z0");
  EXPECT_TRUE(ran.diagnostics.list().empty());
}

}  // namespace
}  // namespace aircut::test
