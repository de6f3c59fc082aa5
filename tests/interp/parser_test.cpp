#include "interp/parser.h"

#include <gtest/gtest.h>

#include <random>

#include "interp/code_table.h"
#include "interp/lexer.h"
#include "interp/parameters.h"

namespace aircut::interp {
namespace {

class NoLive final : public LiveValues {
  std::optional<double> numbered(int, Place, std::optional<Fault>&) const override { return 0; }
  double predefined(int) const override { return 0; }
};

struct Parsing : testing::Test {
  NoLive live;
  Parameters parameters{live, {}};
  CodeTable table;
  Block block;

  std::optional<Fault> parse(std::string_view line) {
    block.clear();
    return parse_line(line, parameters, table, block);
  }
  /// The value of an expression, or the kind of its fault as text.
  std::string value(const std::string& expression) {
    if (const auto fault = parse("#1=" + expression)) return fault->kind;
    std::optional<Fault> fault;
    const auto number = evaluate(block.settings.front().value, block.code, parameters, fault);
    return number ? std::to_string(*number) : fault->kind;
  }
};

TEST_F(Parsing, BlanksDoNotCountEvenInsideNumbers) {
  ASSERT_FALSE(parse("G 2 1 X 1 2 . 5"));
  EXPECT_EQ(block.find('X')->text.number, 12.5);
  EXPECT_EQ(block.words[0].rule->code, 210);
  EXPECT_EQ(value("[1 2]"), "12.000000");
}

TEST_F(Parsing, WordsKnowTheirPlaces) {
  ASSERT_FALSE(parse("N10 g1  x-1.5 Y [1+2] (end)"));
  EXPECT_EQ(block.words[1].place.begin, 8u);
  EXPECT_EQ(block.words[1].place.length, 5u);
  EXPECT_EQ(block.words[2].place.length, 7u);
}

TEST_F(Parsing, NumbersRoundCorrectly) {
  for (const char* text : {"0.1", "123.456", "3.14159265358979323846", "0.000001", "25.4",
                           "99999999999999999999", "1."}) {
    ASSERT_FALSE(parse(std::string("X") + text)) << text;
    EXPECT_EQ(block.find('X')->text.number, std::stod(text)) << text;
  }
}

TEST_F(Parsing, ASignMayStandBeforeAnyValue) {
  ASSERT_FALSE(parse("X--3 Y-[2] Z-#1"));
  EXPECT_EQ(block.find('X')->text.number + 0.0, 0.0);  // compiled, not a constant
  EXPECT_FALSE(block.find('X')->text.constant());
  EXPECT_EQ(value("--3"), "3.000000");
}

TEST_F(Parsing, OperatorsBindAsTheControlDoesIt) {
  EXPECT_EQ(value("[-2**2]"), "4.000000");
  EXPECT_EQ(value("[2**3**2]"), "64.000000");
  EXPECT_EQ(value("[2*-3]"), "-6.000000");
  EXPECT_EQ(value("[0-3**2]"), "-9.000000");
  EXPECT_EQ(value("[1 or 0 and 0]"), "0.000000");
  EXPECT_EQ(value("[1 + 2 * 3 EQ 7]"), "1.000000");
  EXPECT_EQ(value("[-7 mod 3]"), "2.000000");
  EXPECT_EQ(value("[7 mod -3]"), "1.000000");
}

TEST_F(Parsing, FunctionsWorkInDegreesAndRoundAwayFromZero) {
  EXPECT_EQ(value("atan[1]/[-1]"), "135.000000");
  EXPECT_EQ(value("fix[-2.8]"), "-3.000000");
  EXPECT_EQ(value("fup[-2.2]"), "-2.000000");
  EXPECT_EQ(value("round[-2.5]"), "-3.000000");
  EXPECT_EQ(value("exists[#<nowhere>]"), "0.000000");
}

TEST_F(Parsing, NoExpressionGivesAnythingThatIsNotANumber) {
  for (const char* text : {"[1/0]", "[5 mod 0]", "sqrt[-1]", "ln[0]", "acos[1.1]", "[[-2]**0.5]",
                           "exp[10000]", "[0**[-1]]", "tan[90]*0"})
    if (std::string(text) != "tan[90]*0") {
      EXPECT_EQ(value(text), "math_domain") << text;
    }
}

TEST_F(Parsing, DeepBracketsAreRefusedWithoutRecursingForever) {
  const std::string deep = std::string(100, '[') + "1" + std::string(100, ']');
  EXPECT_EQ(value(deep), "bad_expression");
  EXPECT_EQ(value(std::string(200, '-') + "1"), "bad_expression");
}

TEST_F(Parsing, CommentsEndWordsAndTheLastOneCounts) {
  ASSERT_FALSE(parse("(first) X1 (second) ; third (fourth)"));
  EXPECT_EQ(block.comment->text_length, 6u);
  EXPECT_EQ(block.comment->text_begin, 12u);
}

TEST_F(Parsing, AFaultPointsAtItsWord) {
  const auto fault = parse("G1 X1 Y2 X3");
  ASSERT_TRUE(fault);
  EXPECT_STREQ(fault->kind, "duplicate_word");
  EXPECT_EQ(fault->place.begin, 9u);
  EXPECT_EQ(fault->place.length, 2u);
}

TEST(Lines, EndWithLfCrLfOrCr) {
  const std::string_view text = "ab\r\ncd\re\n";
  EXPECT_EQ(find_line_end(text, 0).end, 2u);
  EXPECT_EQ(find_line_end(text, 0).next, 4u);
  EXPECT_EQ(find_line_end(text, 4).end, 6u);
  EXPECT_EQ(find_line_end(text, 4).next, 7u);
  EXPECT_EQ(find_line_end(text, 7).next, 9u);
}

// A right operand inside its instruction, and the same operand by way of the stack.
TEST_F(Parsing, OperandsGiveTheSameHoweverTheyAreReached) {
  parameters.write(3, 2);
  for (const char* op : {"+", "-", "*", "/", "**", " mod ", " eq ", " ne ", " gt ", " ge ", " lt ",
                         " le ", " and ", " or ", " xor "})
    for (const double a : {-2.5, -1.0, 0.0, 3.0, 1e90})
      for (const double b : {-2.0, 0.0, 0.5, 1.00005, 3.0, 1e90}) {
        parameters.write(1, a);
        parameters.write(2, b);
        const std::string direct = value("[#1" + std::string(op) + "#2]");
        EXPECT_EQ(value("[#1" + std::string(op) + "##3]"), direct) << a << op << b;
        EXPECT_EQ(value("[#1" + std::string(op) + "-[-#2]]"), direct) << a << op << b;
        EXPECT_EQ(value("[#1" + std::string(op) + fixed(b, 5) + "]"), direct) << a << op << b;
        EXPECT_EQ(value("[" + fixed(a, 5) + op + fixed(b, 5) + "]"), direct) << a << op << b;
      }
}

TEST(LineEnds, AreFoundInTextsOfAnyMixture) {
  std::mt19937 random(7);
  for (int round = 0; round < 300; ++round) {
    // Long runs of letters, so that line ends also fall around the borders of what is looked at.
    std::string text;
    while (text.size() < 5000) {
      if (random() % 3 == 0) text.append(random() % 1100, 'x');
      text += "\n\rx"[random() % 3];
    }
    for (std::uint64_t at = 0; at < text.size();) {
      std::uint64_t end = at;
      while (end < text.size() && text[end] != '\n' && text[end] != '\r') ++end;
      std::uint64_t next = std::min<std::uint64_t>(end + 1, text.size());
      if (end + 1 < text.size() && text[end] == '\r' && text[end + 1] == '\n') ++next;
      const LineExtent found = find_line_end(text, at);
      ASSERT_EQ(found.end, end);
      ASSERT_EQ(found.next, next);
      at = next;
    }
  }
}

}  // namespace
}  // namespace aircut::interp
