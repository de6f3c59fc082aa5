// What was asked of LinuxCNC's own reader (`inivar`) is in tests/peer; here are the same facts for
// machines without it, and places and messages.
#include "ini/ini.h"

#include <gtest/gtest.h>

namespace aircut::test {
namespace {

class Ini : public ::testing::Test {
 protected:
  ini::IniFile read(const std::string& text) {
    out_ = {};
    const SourceReader include = [this](const std::string& name) -> Expected<const SourceText*> {
      if (name == "more.inc") return &sources_.add(name, "inside = 7\n[NEW]\nx = 8\n#INCLUDE a\n");
      return unexpected(make_error("input", "there is no '" + name + "'"));
    };
    return ini::read_ini(sources_.add("machine.ini", text), include, out_);
  }
  static std::string value(const ini::IniFile& file, const char* section, const char* key,
                           int n = 1) {
    const ini::Entry* entry = file.find(section, key, n);
    return entry ? entry->value : "-";
  }
  /// `kind:line:column` of each message.
  std::string messages() const {
    std::string all;
    for (const Diagnostic& d : out_.list())
      all += (all.empty() ? "" : " ") + d.kind + ":" + std::to_string(d.span.line) + ":" +
             std::to_string(d.span.column());
    return all;
  }

  SourceMap sources_;
  Diagnostics out_;
};

TEST_F(Ini, GivesValuesWithoutBlanksAndTheirPlaces) {
  const auto file = read("; top\n[TRAJ]  # units\n  LINEAR_UNITS =  mm \r\n\tSPINDLES=2 # two\n");
  EXPECT_EQ(value(file, "TRAJ", "LINEAR_UNITS"), "mm");
  EXPECT_EQ(value(file, "TRAJ", "SPINDLES"), "2 # two") << "a comment behind a value belongs to it";
  const ini::Entry* units = file.find("TRAJ", "LINEAR_UNITS");
  EXPECT_EQ(units->span.place(), "machine.ini:3:19");
  EXPECT_EQ(units->span.covered(), "mm");
  EXPECT_EQ(units->key_span.covered(), "LINEAR_UNITS");
  EXPECT_EQ(messages(), "");
}

TEST_F(Ini, KeepsTheCaseOfNames) {
  const auto file = read("[S]\nkey=1\n");
  EXPECT_EQ(value(file, "S", "key"), "1");
  EXPECT_EQ(value(file, "S", "KEY"), "-");
  EXPECT_EQ(value(file, "s", "key"), "-");
}

TEST_F(Ini, CountsRepeatedKeysUpToAnEmptyOne) {
  const auto file = read("[S]\nR=a\nR=b\nR=\nR=c\n");
  EXPECT_EQ(value(file, "S", "R", 2), "b");
  EXPECT_EQ(value(file, "S", "R", 3), "-");
  EXPECT_EQ(value(file, "S", "R", 4), "c");
  EXPECT_EQ(file.all("S", "R").size(), 2u);
}

TEST_F(Ini, LooksAtTheFirstSectionOfANameOnly) {
  const auto file = read("[A]\nx=1\n[B]\ny=2\n[A]\nx=3\nz=4\n");
  EXPECT_EQ(value(file, "A", "x"), "1");
  EXPECT_EQ(value(file, "A", "z"), "-");
  EXPECT_EQ(messages(), "ini_section:5:1");
}

TEST_F(Ini, JoinsLinesThatEndWithABackslash) {
  const auto file = read("[A]\nk=5\\\n6\\\n 7\nx=3\n");
  EXPECT_EQ(value(file, "A", "k"), "56 7");
  EXPECT_EQ(value(file, "A", "x"), "3");
  EXPECT_EQ(value(read("[A]\nz=5\\"), "A", "z"), "5\\") << "nothing follows";
  EXPECT_EQ(value(read("[A]\nz=5\\\n"), "A", "z"), "-") << "the end of the file follows";
}

TEST_F(Ini, SeesASectionInAContinuedLineFromItsStartOnly) {
  const auto file = read("[A]\nk=5\\\n[B]\nx=3\n");
  EXPECT_EQ(value(file, "A", "k"), "5[B]");
  EXPECT_EQ(value(file, "A", "x"), "3");
  EXPECT_EQ(value(file, "B", "x"), "3");
}

TEST_F(Ini, StopsAtALineThatGoesOnForMoreThan20Lines) {
  std::string text = "[A]\nx=1\n";
  for (int i = 0; i < 21; ++i) text += "k\\\n";
  const auto file = read(text + "=3\ny=2\n");
  EXPECT_EQ(value(file, "A", "x"), "1");
  EXPECT_EQ(value(file, "A", "y"), "-");
  EXPECT_EQ(messages(), "ini_line:3:1");
}

TEST_F(Ini, BreaksLinesAfter255Bytes) {
  const auto file = read("[A]\nw=" + std::string(253, 'a') + "x=5\ny=3\n");
  EXPECT_EQ(value(file, "A", "w").size(), 253u);
  EXPECT_EQ(value(file, "A", "x"), "5");
  EXPECT_EQ(messages(), "ini_line:2:256");
}

TEST_F(Ini, TakesTheKeyUpToABlankAndTheValueBehindTheFirstEqualsSign) {
  const auto file = read("[A]\nx foo = 5\ny==\"a=b\"\n=3\nword\n");
  EXPECT_EQ(value(file, "A", "x"), "5");
  EXPECT_EQ(value(file, "A", "y"), "=\"a=b\"");
  EXPECT_EQ(messages(), "ini_line:4:1 ini_line:5:1");
}

TEST_F(Ini, PutsIncludedFilesInTheirPlaceOnce) {
  const auto file = read("[A]\n#INCLUDE more.inc\ny = 9\n");
  EXPECT_EQ(value(file, "A", "inside"), "7");
  EXPECT_EQ(value(file, "NEW", "x"), "8");
  EXPECT_EQ(value(file, "NEW", "y"), "9") << "what follows belongs to the included section";
  EXPECT_EQ(file.find("A", "inside")->span.place(), "more.inc:1:10");
  EXPECT_EQ(messages(), "") << "an included file includes nothing";
}

TEST_F(Ini, SaysWhichIncludeCantBeFollowed) {
  read("[A]\n#INCLUDE  nothere.inc\n#INCLUDE\n");
  EXPECT_EQ(messages(), "ini_include:2:11 ini_include:3:1");
  EXPECT_EQ(out_.errors(), 2u);
}

TEST_F(Ini, RefusesWhatIsNoText) {
  read(std::string("[A]\nx=1\0y\n", 10));
  EXPECT_EQ(messages(), "encoding:2:4");
  read("[A]\nx=5\ry=4\n");
  EXPECT_EQ(messages(), "encoding:2:4");
  read("\xef\xbb\xbf[A]\nx=5\n");
  EXPECT_EQ(messages(), "ini_line:1:1");
}

TEST_F(Ini, TellsASectionWithoutItsBracket) {
  const auto file = read("[A]\nx=1\n[C\nx=2\n");
  EXPECT_EQ(file.sections().size(), 1u);
  EXPECT_EQ(messages(), "ini_section:3:1");
}

TEST_F(Ini, TextsOfKindsAreWritten) {
  for (const KindText& kind : ini::kinds()) EXPECT_GT(std::string(kind.text).size(), 40u);
}

}  // namespace
}  // namespace aircut::test
