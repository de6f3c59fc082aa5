// Every limit that keeps a program from filling the memory: programs that go just past it.
#include <gtest/gtest.h>

#include "interp/flow.h"
#include "interp/run_program.h"

namespace aircut::test {
namespace {

using Texts = std::vector<std::string>;

/// Where the limit is told: its message, and the line.
struct Told {
  std::string message;
  std::uint64_t line = 0;
};

Told limit_of(const std::string& program, const Setting& setting = {}) {
  SourceMap sources;
  const Ran ran = run_program(sources, program, setting);
  Told told;
  for (const Diagnostic& d : ran.diagnostics.list())
    if (d.kind == "limit_reached") told = {d.message, d.span.line};
  return told;
}

Setting of(interp::Dialect dialect) {
  Setting setting;
  setting.options.dialect = dialect;
  return setting;
}

std::string repeated(std::size_t times, const std::string& line) {
  std::string text;
  text.reserve(times * line.size());
  for (std::size_t i = 0; i < times; ++i) text += line;
  return text;
}

TEST(Limits, OWordsThatTheIndexKeeps) {
  const std::string tail = "o1 if [0]\no1 endif\nM2\n";
  // Branches of one `if` need no labels of their own, so that the text stays small.
  const auto program = [&](std::size_t words) {
    return "G0 X1\no9 if [0]\n" + repeated(words - 4, "o9elseif[0]\n") + "o9 endif\n" + tail;
  };
  const Told told = limit_of(program(interp::FlowIndex::max_entries + 1));
  EXPECT_NE(told.message.find("2000000 O-words"), std::string::npos) << told.message;
  EXPECT_EQ(told.line, 2u);  // where the first of them is executed
}

TEST(Limits, NWordsThatAJumpLooksAmong) {
  const auto program = [](std::size_t blocks) {
    return "%\nO1\nG0 X1.\nGOTO 7\n" + repeated(blocks, "N8\n") + "N7 M2\n%\n";
  };
  const Told told = limit_of(program(interp::FlowIndex::max_numbered), of(interp::Dialect::fanuc));
  EXPECT_NE(told.message.find("8000000 N blocks"), std::string::npos) << told.message;
  EXPECT_EQ(told.line, 4u);
}

TEST(Limits, AreNotReachedByHalfOfThem) {
  EXPECT_EQ(limit_of("%\nO1\nGOTO 7\n" + repeated(400'000, "N8\n") + "N7 M2\n%\n",
                     of(interp::Dialect::fanuc))
                .message,
            "");
  EXPECT_EQ(limit_of("o9 if [0]\n" + repeated(100'000, "o9elseif[0]\n") + "o9 endif\nM2\n").message,
            "");
}

TEST(Limits, LoopsAndBranchesInsideEachOther) {
  const auto program = [](int depth) {
    std::string text;
    for (int i = 1; i <= depth; ++i) text += "o" + std::to_string(i) + " if [1]\n";
    for (int i = depth; i >= 1; --i) text += "o" + std::to_string(i) + " endif\n";
    return text + "M2\n";
  };
  EXPECT_EQ(limit_of(program(1000)).message, "");
  EXPECT_NE(limit_of(program(1001)).message.find("1000 loops"), std::string::npos);
}

TEST(Limits, NamedParameters) {
  const auto program = [](int names) {
    std::string text;
    for (int i = 0; i < names; ++i) text += "#<n" + std::to_string(i) + ">=1\n";
    return text + "M2\n";
  };
  EXPECT_EQ(limit_of(program(100'000)).message, "");
  EXPECT_NE(limit_of(program(100'002)).message.find("100000 named"), std::string::npos);
}

TEST(Limits, FilesOfSubs) {
  Setting setting;
  std::string text;
  for (int i = 0; i <= 10'000; ++i) {
    const std::string name = "f" + std::to_string(i);
    text += "o<" + name + "> call\n";
    setting.files["folder/" + name + ".ngc"] = "o<" + name + "> sub\no<" + name + "> endsub\n";
  }
  EXPECT_NE(limit_of(text + "M2\n", setting).message.find("10000 files"), std::string::npos);
}

TEST(Limits, Messages) {
  const Told told = limit_of(repeated(10'001, "G0 Q1\n") + "M2\n");
  EXPECT_NE(told.message.find("10000 messages"), std::string::npos) << told.message;
  EXPECT_EQ(told.line, 10'000u);
}

TEST(Limits, OfOneMacroBlock) {
  const Setting fanuc = of(interp::Dialect::fanuc);
  EXPECT_NE(limit_of("O1\nG65 P1" + repeated(101, " I1.") + "\nM30\n", fanuc)
                .message.find("100 arguments"),
            std::string::npos);
  EXPECT_NE(
      limit_of("O1\n" + repeated(51, "#100=1 ") + "\nM30\n", fanuc).message.find("50 settings"),
      std::string::npos);
}

TEST(Limits, PassesOfOneLine) {
  EXPECT_NE(limit_of("M3 S100\nG0 X20 Z1\nG76 P1 Z-9 I-1 J0.001 K3 R3\nM2\n")
                .message.find("10000 passes"),
            std::string::npos);
  EXPECT_NE(limit_of("F100\nG5.2 X1 Y1 P1 L3\n" + repeated(100'001, "X1 Y2 P1\n") + "G5.3\nM2\n")
                .message.find("control points"),
            std::string::npos);
}

}  // namespace
}  // namespace aircut::test
