#include <gtest/gtest.h>

#include <random>

#include "base/base.h"
#include "base/deflate.h"

namespace aircut {
namespace {

TEST(NumberText, ReadsBackToTheSameDouble) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 100'000; ++i) {
    const double value = std::ldexp(static_cast<double>(static_cast<std::int64_t>(random())),
                                    static_cast<int>(random() % 80) - 100);
    EXPECT_EQ(std::strtod(shortest(value).c_str(), nullptr), value);
  }
  EXPECT_EQ(shortest(-0.0), "0");
  EXPECT_EQ(fixed(-0.0004, 3), "0.000");
  EXPECT_EQ(fixed(-0.0006, 3), "-0.001");
}

TEST(NumberText, TakesPlainDecimalsOnly) {
  EXPECT_EQ(parse_number("+1.5"), 1.5);
  EXPECT_EQ(parse_number("-.5"), -0.5);
  for (const char* bad : {"", "-", "+-1", "1e3", "inf", "nan", "-nan", "1.5mm", " 1", "0x10"})
    EXPECT_FALSE(parse_number(bad)) << bad;
}

TEST(NearestWord, FindsWhatWasMeantAndNothingElse) {
  const std::vector<std::string> known = {"collision", "ignore", "tolerance"};
  EXPECT_EQ(nearest_word("colision", known), "collision");
  EXPECT_EQ(nearest_word("toleranse", known), "tolerance");
  EXPECT_EQ(nearest_word("ignoer", known), "ignore");
  EXPECT_FALSE(nearest_word("spindle", known));
  EXPECT_FALSE(nearest_word(std::string(100'000, 'x'), known));
}

TEST(Printable, LeavesNothingThatDrivesATerminal) {
  EXPECT_EQ(printable("a\x1b[31m\tb\x7f"), "a^[[31m^Ib^?");
}

TEST(Sha256, AgreesWithTheStandardsExample) {
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Excerpt, ShowsTheLineBeforeAndUnderlinesTheWordInCharacters) {
  SourceMap sources;
  const SourceText& text = sources.add("p.ngc", "G21\r\n(Größe) G1 X1o\r\n");
  const std::uint64_t at = text.content().find("X1o");
  const SourceSpan span{&text, at, 3, 2};
  EXPECT_EQ(span.place(), "p.ngc:2:12");
  EXPECT_EQ(excerpt(span, "here", {}),
            " --> p.ngc:2:12\n  |\n1 | G21\n2 | (Größe) G1 X1o\n  |            ^^^ here\n");
}

TEST(Excerpt, CutsALongLineAroundThePlace) {
  SourceMap sources;
  const SourceText& text =
      sources.add("p.ngc", std::string(5000, 'x') + "Q9" + std::string(5000, 'y'));
  const std::string shown = excerpt({&text, 5000, 2, 1}, "", {});
  EXPECT_LT(shown.size(), 700u);
  EXPECT_NE(shown.find("Q9"), std::string::npos);
}

TEST(Excerpt, NamesTheCallsThatLedThere) {
  SourceMap sources;
  const SourceText& main = sources.add("main.ngc", "o<a> call\n");
  const SourceText& sub = sources.add("a.ngc", "G99 X\n");
  SourceSpan span{&sub, 4, 1, 1};
  span.calls = std::make_shared<CallFrame>(CallFrame{{&main, 0, 9, 1}, "o<a> call"});
  EXPECT_NE(excerpt(span, "", {}).find("(called from main.ngc:1, o<a> call)"), std::string::npos);
}

TEST(Hash, Base64IsThatOfTheStandard) {  // RFC 4648, section 10
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
}

// The bits of a stored and of a compressed block are read by page_in_a_browser and by the readers
// of 3MF files; here is what the format's own texts say.
TEST(Deflate, ChecksumAndSizeAreRight) {
  EXPECT_EQ(crc32_of("123456789"), 0xcbf43926u);  // the check value of CRC-32
  EXPECT_EQ(crc32_of(""), 0u);
  EXPECT_LT(deflated(std::string(100'000, 'x')).size(), 1000u);
  EXPECT_EQ(deflated(""), std::string("\x03\x00", 2));  // a last block with an end alone
}

}  // namespace
}  // namespace aircut
