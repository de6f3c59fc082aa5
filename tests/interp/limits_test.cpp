// Every limit that keeps a program from filling the memory: programs that go just past it.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>

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

/// Files may have this many bytes while it lives.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit limit = before_;
    limit.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() { ::setrlimit(RLIMIT_FSIZE, &before_); }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_{};
};

constexpr std::size_t past_the_memory = 100'000;  // more entries than are kept without a file

TEST(Limits, OWordsWithoutRoomForTheirIndex) {
  const std::string program = "G0 X1\no9 if [0]\n" + repeated(past_the_memory, "o9elseif[0]\n") +
                              "o9 endif\no1 if [0]\no1 endif\nM2\n";
  EXPECT_EQ(limit_of(program).message, "");
  const FileSizeLimit limit(1 << 20);
  const Told told = limit_of(program);
  EXPECT_NE(told.message.find("temporary files"), std::string::npos) << told.message;
  EXPECT_EQ(told.line, 2u);  // where the first of them is executed
}

TEST(Limits, NWordsWithoutRoomForTheirIndex) {
  const std::string program =
      "%\nO1\nG0 X1.\nGOTO 7\n" + repeated(past_the_memory, "N8\n") + "N7 M2\n%\n";
  EXPECT_EQ(limit_of(program, of(interp::Dialect::fanuc)).message, "");
  const FileSizeLimit limit(1 << 20);
  const Told told = limit_of(program, of(interp::Dialect::fanuc));
  EXPECT_NE(told.message.find("temporary files"), std::string::npos) << told.message;
  EXPECT_EQ(told.line, 4u);
}

/// The kinds of what is told, with their lines.
std::vector<std::pair<std::string, std::uint64_t>> told_by(const std::string& program,
                                                           const Setting& setting = {}) {
  SourceMap sources;
  const Ran ran = run_program(sources, program, setting);
  std::vector<std::pair<std::string, std::uint64_t>> told;
  for (const Diagnostic& d : ran.diagnostics.list()) told.emplace_back(d.kind, d.span.line);
  return told;
}

std::vector<std::string> moves_of(const Ran& ran) {
  std::vector<std::string> moves;
  for (const canon::Command& command : ran.commands)
    if (canon::is_motion(command.action)) moves.push_back(canon::to_text(command.action));
  return moves;
}

// A long program does what a short one does: jumps, subs, labels that are used twice.
TEST(Limits, AnIndexInAFileLeadsToTheSamePlaces) {
  std::string text = "#1=0\no1 while [#1 lt 3]\n#1=[#1+1]\no2 if [#1 eq 2]\no1 continue\n";
  text += "o2 else\n";
  for (std::size_t i = 0; i < past_the_memory; ++i) {
    const std::string label = "o" + std::to_string(i + 10);
    text += label + " if [1]\n" + label + " endif\n";
  }
  text += "o2 endif\n#2=[#2+1]\no1 endwhile\n";
  text += "o77 sub\no77 if [1]\no77 endif\no77 endsub [5]\no77 call\n";
  text += "o<x> if [#2 eq 2]\nG0 X[#<_value>]\no<x> endif\n";
  text += "o500 if [1]\no500 endif\n";  // a label that is used again, behind the sub: a new scope
  text += "o501 if [1]\no501 endif\no501 if [1]\no501 endif\nM2\n";
  SourceMap sources;
  const Ran ran = run_program(sources, text);
  EXPECT_EQ(moves_of(ran), std::vector<std::string>{"rapid X5 Y0 Z0"});
  const std::uint64_t last = static_cast<std::uint64_t>(std::count(text.begin(), text.end(), '\n'));
  EXPECT_EQ(told_by(text),
            (std::vector<std::pair<std::string, std::uint64_t>>{{"label_reused", last - 2}}));
}

TEST(Limits, NWordsInAFileAreFoundBehindAndThenFromTheTop) {
  std::string text = "%\nO1\n#1=0\nN5 #1=#1+1\n";
  for (std::size_t i = past_the_memory; i > 0; --i) text += "N" + std::to_string(i + 10) + "\n";
  text += "IF[#1LT3]GOTO5\nGOTO6\nN6 G0 X#1\nM30\n%\n";
  SourceMap sources;
  const Ran ran = run_program(sources, text, of(interp::Dialect::fanuc));
  EXPECT_EQ(moves_of(ran), std::vector<std::string>{"rapid X3 Y0 Z0"});
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
