#include "config/config.h"

#include <gtest/gtest.h>

#include <string>

namespace aircut::config {
namespace {

// `line:column message` of each diagnostic.
std::vector<std::string> told(const Diagnostics& diagnostics) {
  std::vector<std::string> out;
  for (const Diagnostic& d : diagnostics.list())
    out.push_back(std::to_string(d.span.line) + ":" + std::to_string(d.span.column()) + " " +
                  d.message);
  return out;
}

using Told = std::vector<std::string>;

TEST(Config, ReadsEveryKindOfValue) {
  const SourceText text("m.toml",
                        "n = 2\nx = 2.5\nb = true\nt = \"é\"\nv = [1, 2.5, -3]\n"
                        "w = [\"a\", \"b\"]\np = [[\"a\", \"b\"], [\"c\", \"d\"]]\n"
                        "q = [[1, 2], [3, 4]]\n[s]\nk = 1\n[[r]]\nk = 2\n[[r]]\nk = 3\n");
  Reader reader(text, "machine_invalid");
  Table top = reader.top();
  EXPECT_EQ(top.integer("n"), 2);
  EXPECT_EQ(top.number("n"), 2.0);
  EXPECT_EQ(top.number("x"), 2.5);
  EXPECT_EQ(top.number("absent", 7), 7);
  EXPECT_EQ(top.boolean("b"), true);
  EXPECT_EQ(top.text("t"), "é");
  EXPECT_EQ(top.numbers("v", 3), (std::vector<double>{1, 2.5, -3}));
  EXPECT_EQ(top.texts("w"), (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(top.text_lists("p").at(1), (std::vector<std::string>{"c", "d"}));
  EXPECT_EQ(top.number_lists("q", 2)->at(1), (std::vector<double>{3, 4}));
  EXPECT_EQ(top.table("s")->number("k"), 1);
  std::vector<Table> rows = top.tables("r");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].number("k"), 2);
  EXPECT_EQ(rows[1].number("k"), 3);
  EXPECT_EQ(told(reader.finish()), Told{});
}

TEST(Config, NamesUnknownKeysWithTheNearestKnownOne) {
  const SourceText text("m.toml", "[axis]\n  nam = 1\nzzzzz = 2\n[other]\n");
  Reader reader(text, "machine_invalid");
  Table top = reader.top();
  auto axis = top.table("axis");
  axis->number("name");
  axis->number("kind");
  EXPECT_EQ(told(reader.finish()), (Told{"2:3 unknown key 'nam'. Did you mean 'name'?",
                                         "3:1 unknown key 'zzzzz'. Known here: 'kind' and 'name'.",
                                         "4:2 unknown key 'other'. Known here: 'axis'."}));
}

TEST(Config, CountsColumnsInCharacters) {
  const SourceText text("m.toml", "a = { \"größe\" = 1, x = nan }\n");
  Reader reader(text, "machine_invalid");
  auto a = reader.top().table("a");
  a->number("größe");
  a->number("x");
  EXPECT_EQ(told(reader.finish()),
            Told{"1:24 'x' needs a finite number; inf and nan are not allowed"});
}

TEST(Config, RefusesNumbersThatAreNotFinite) {
  const SourceText text("m.toml", "a = inf\nb = [1, -inf]\nc = [[nan, 1]]\n");
  Reader reader(text, "machine_invalid");
  Table top = reader.top();
  EXPECT_EQ(top.number("a"), std::nullopt);
  EXPECT_EQ(top.numbers("b", 2), std::nullopt);
  EXPECT_EQ(top.number_lists("c", 2), std::nullopt);
  EXPECT_EQ(told(reader.finish()),
            (Told{"1:5 'a' needs a finite number; inf and nan are not allowed",
                  "2:9 'b' needs a finite number; inf and nan are not allowed",
                  "3:7 'c' needs a finite number; inf and nan are not allowed"}));
}

TEST(Config, SaysWhichTypeIsWantedAndWhichIsThere) {
  const SourceText text("m.toml",
                        "n = \"1\"\ni = 1.5\nt = 3\nb = 1\nv = [1, 2]\nw = [1]\ns = 1\n"
                        "r = { x = 1 }\nc = \"blu\"\nd = 1979-05-27\n");
  Reader reader(text, "machine_invalid");
  Table top = reader.top();
  top.number("n");
  top.integer("i");
  top.text("t");
  top.boolean("b");
  top.numbers("v", 3);
  top.texts("w");
  top.table("s");
  top.tables("r");
  top.choice("c", {"red", "blue"}, "red");
  top.number("d");
  top.required_number("e");
  const Told expected{
      "1:0 'e' is missing: it needs a number",
      "1:5 'n' needs a number, this is a text",
      "2:5 'i' needs a whole number, this is one with decimals",
      "3:5 't' needs a text in quotes, this is a number",
      "4:5 'b' needs true or false, this is a number",
      "5:5 'v' needs an array of 3 numbers, this is one of 2",
      "6:6 'w' needs texts, this is a number",
      "7:5 's' needs one table [s], this is a number",
      "8:5 'r' needs tables written [[r]], this is a table",
      "9:5 'c' must be 'red' or 'blue', not 'blu'. Did you mean 'blue'?",
      "10:5 'd' needs a number, this is a date or time",
  };
  Told got = told(reader.finish());
  ASSERT_EQ(got.size(), expected.size());
  got[0].replace(0, 3, "1:0");  // the top table has no better place than the file's first line
  EXPECT_EQ(got, expected);
}

TEST(Config, AValueThatIsReadTwiceIsReportedOnce) {
  const SourceText text("m.toml", "a = \"x\"\n");
  Reader reader(text, "machine_invalid");
  reader.top().number("a");
  reader.top().number("a");
  EXPECT_EQ(told(reader.finish()).size(), 1u);
}

TEST(Config, KeysComeInTheOrderOfTheFile) {
  const SourceText text("m.toml", "zeta = 1\nalpha = 2\nmid = 3\n");
  Reader reader(text, "machine_invalid");
  EXPECT_EQ(reader.top().keys(), (std::vector<std::string>{"zeta", "alpha", "mid"}));
  EXPECT_EQ(told(reader.finish()), Told{});
}

struct Broken {
  std::string text;
  std::uint32_t line;
  std::size_t column;
};

TEST(Config, TextThatIsNotTomlGivesOneErrorAtItsPlace) {
  const std::vector<Broken> cases = {
      {"a = 1\nb = 1\na = 2\n", 3, 1},        // a key twice
      {"[a]\nb = 1\n[a]\n", 3, 1},            // a table twice
      {"a = 1\nä = \n", 2, 1},                // bare keys are ASCII
      {"a = 1\n\"ä\" = 1 1\n", 2, 9},         // two values
      {"a = \"\xff\"\n", 1, 5},               // not UTF-8
      {std::string("a = 1\0b\n", 8), 1, 6},   // NUL
      {"a = 99999999999999999999\n", 1, 25},  // too large for 64 bits
      {"a = [1,\n2\n", 2, 2},                 // ends too early
      {"\xff\xfe\x61\x00", 1, 1},             // UTF-16
      {"a = 1\rb = 2\r", 1, 6},               // lone CR
  };
  for (const Broken& c : cases) {
    const SourceText text("m.toml", c.text);
    Reader reader(text, "machine_invalid");
    reader.top().required_number("missing");  // nothing is missed in a file that can't be read
    const Diagnostics out = reader.finish();
    ASSERT_EQ(out.list().size(), 1u) << c.text;
    EXPECT_EQ(out.list()[0].span.line, c.line) << c.text << out.list()[0].message;
    EXPECT_EQ(out.list()[0].span.column(), c.column) << c.text << out.list()[0].message;
    EXPECT_EQ(out.list()[0].kind, "machine_invalid");
    EXPECT_NE(format_human(out.list()[0], {}), "");
  }
}

TEST(Config, DeepNestingIsRefusedWithoutACrash) {
  const std::size_t deep = 200000;
  std::string dotted = "a";
  for (std::size_t i = 0; i < deep; ++i) dotted += ".a";
  const std::vector<std::string> texts = {
      "a = " + std::string(deep, '['),
      [&] {
        std::string inline_tables = "a = ";
        for (std::size_t i = 0; i < deep; ++i) inline_tables += "{a=";
        return inline_tables;
      }(),
      dotted + " = 1\n",
      "[" + dotted + "]\n",
      "\"" + dotted + "\".x = [" + dotted + "]",
  };
  for (const std::string& content : texts) {
    const SourceText text("m.toml", content);
    Reader reader(text, "machine_invalid");
    reader.top();
    EXPECT_EQ(reader.finish().errors(), 1u) << content.substr(0, 40);
  }
}

TEST(Config, CommentsAndTextsMayHaveManyDots) {
  const SourceText text("m.toml",
                        "# " + std::string(300, '.') + "\na = \"" + std::string(300, '.') +
                            "\"\nb = [1.5, 2.5, 3.5, 4.5, 5.5, "
                            "6.5, 7.5, 8.5, 9.5, 1.5, 2.5, 3.5, 4.5, 5.5, 6.5, 7.5, 8.5]\n");
  Reader reader(text, "machine_invalid");
  reader.top().text("a");
  reader.top().numbers("b", 0);
  EXPECT_EQ(told(reader.finish()), Told{});
}

TEST(Config, AByteOrderMarkAndCrLfAreRead) {
  const SourceText text("m.toml", "\xef\xbb\xbfschema = 1\r\nb = nan\r\n");
  Reader reader(text, "machine_invalid");
  EXPECT_EQ(reader.top().integer("schema"), 1);
  reader.top().number("b");
  EXPECT_EQ(told(reader.finish()),
            Told{"2:5 'b' needs a finite number; inf and nan are not allowed"});
}

TEST(Config, CharactersOutsideOfAsciiStandInTextsAndCommentsOnly) {
  const SourceText good("m.toml", "# 90°\na = \"é \\\" ü\" # ß\nb = 'ö' \nc = \"\"\"\nä\n\"\"\"\n");
  Reader reader(good, "machine_invalid");
  reader.top().text("a");
  reader.top().text("b");
  reader.top().text("c");
  EXPECT_EQ(told(reader.finish()), Told{});

  const SourceText bad("m.toml", "a = \"°\"\nangle = 90°\n");
  Reader other(bad, "machine_invalid");
  other.top();
  EXPECT_EQ(told(other.finish()),
            Told{"2:11 this is not TOML: '°' may stand only in strings (in quotes) and comments"});
}

}  // namespace
}  // namespace aircut::config
