// What every format owes: hostile text stays text, unknown is said, the same report gives the same
// bytes.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <pugixml.hpp>

#include "interp/interp.h"
#include "samples.h"

namespace aircut::report {
namespace {

using nlohmann::json;
using testing::HostileSamples;
using testing::Samples;

struct Format {
  const char* name;
  std::string (*write)(const RunReport&);
  bool escapes_markup;  ///< `<` of a text must not be seen
  bool for_people;      ///< is looked at as it is
};

const Format formats[] = {
    {"human", [](const RunReport& r) { return to_human(r, {}); }, false, true},
    {"json", [](const RunReport& r) { return to_json(r); }, true, false},
    {"jsonl", [](const RunReport& r) { return to_jsonl(r); }, true, false},
    {"gcc", [](const RunReport& r) { return to_gcc(r); }, false, true},
    {"github", [](const RunReport& r) { return to_github(r); }, false, true},
    {"junit", [](const RunReport& r) { return to_junit(r); }, true, true},
    {"sarif",
     [](const RunReport& r) { return to_sarif(r, {.kinds = sim::finding_kinds(), .folder = {}}); },
     true, false},
};

class EveryFormat : public ::testing::TestWithParam<Format> {};

bool has(const std::string& text, std::string_view part) {
  return text.find(part) != std::string::npos;
}

TEST_P(EveryFormat, EscapesHostileText) {
  const HostileSamples samples;
  const std::string out = GetParam().write(samples.report());
  EXPECT_TRUE(has(out, "red")) << "the text must be told";
  EXPECT_EQ(utf8(out), out) << "not UTF-8";
  for (const char c : out)
    EXPECT_TRUE(static_cast<unsigned char>(c) >= 0x20 || c == '\n') << static_cast<int>(c);
  EXPECT_FALSE(has(out, "\x7f"));
  EXPECT_FALSE(has(out, "\n::error::mine"));
  EXPECT_FALSE(has(out, "\n##[error]"));
  if (GetParam().escapes_markup) {
    EXPECT_FALSE(has(out, "</script>"));
    EXPECT_FALSE(has(out, "<!--"));
    EXPECT_FALSE(has(out, "<b>"));
  }
}

// JSON may carry any character, since a reader gets it back as data; what people look at may not.
TEST(FormatsForPeople, ShowNoTerminalOrDirectionControls) {
  const HostileSamples samples;
  for (const Format& format : formats)
    if (format.for_people) {
      const std::string out = format.write(samples.report());
      EXPECT_EQ(harmless(out), out) << format.name;
    }
}

TEST_P(EveryFormat, SaysWhatWasNotChecked) {
  const Samples samples;
  RunReport r = samples.clean();
  r.summary.verdict = sim::Verdict::unknown;
  r.summary.unchecked = {"everything after line 17"};
  EXPECT_TRUE(has(GetParam().write(r), "everything after line 17"));
}

TEST_P(EveryFormat, TellsEveryFindingOfTheReport) {
  const Samples samples;
  const std::string out = GetParam().write(samples.full());
  for (const KindText& row : sim::finding_kinds()) EXPECT_TRUE(has(out, row.kind)) << row.kind;
  EXPECT_TRUE(has(out, "arc_error"));
}

TEST_P(EveryFormat, NamesTheProgramOfEachMessage) {
  const Samples samples;
  RunReport r = testing::three_programs(samples);
  for (Diagnostic& d : r.diagnostics) d.span = {};
  EXPECT_TRUE(has(GetParam().write(r), "parts/side.ngc")) << GetParam().write(r);
  EXPECT_TRUE(has(GetParam().write(r), "gone.ngc"));
}

TEST_P(EveryFormat, GivesTheSameBytesTwiceAndEndsWithALineEnd) {
  const Samples samples;
  const RunReport r = samples.full();
  const std::string out = GetParam().write(r);
  EXPECT_EQ(out, GetParam().write(r));
  EXPECT_TRUE(out.ends_with('\n'));
}

TEST_P(EveryFormat, StandsAnEmptyReport) { (void)GetParam().write({}); }

INSTANTIATE_TEST_SUITE_P(Formats, EveryFormat, ::testing::ValuesIn(formats),
                         [](const auto& row) { return std::string(row.param.name); });

TEST(Text, MakesUtf8OfAnything) {
  EXPECT_EQ(utf8("\xc3\xa4"), "\xc3\xa4");          // ä stays
  EXPECT_EQ(utf8("\xe4"), "\xc3\xa4");              // Latin-1 ä becomes it
  EXPECT_EQ(utf8("\xc0\x80"), "\xc3\x80\xc2\x80");  // overlong
  EXPECT_EQ(utf8("\xe2\x82"), "\xc3\xa2\xc2\x82");  // cut off
  std::string all;
  for (int i = 0; i < 256; ++i)
    for (int j = 0; j < 256; ++j) all += {static_cast<char>(i), static_cast<char>(j)};
  EXPECT_NO_THROW((void)json(utf8(all)).dump());
}

TEST(Text, KeepsColumns) {
  for (const std::string text : {"a\xe2\x80\xae"
                                 "b",
                                 "\xc2\x9b"
                                 "31m",
                                 "a\xff"
                                 "b"})
    EXPECT_EQ(count_characters(harmless(text)), count_characters(text));
}

}  // namespace
}  // namespace aircut::report
