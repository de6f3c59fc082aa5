#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "samples.h"
#include "support/golden.h"

namespace aircut::report {
namespace {

using nlohmann::json;
using testing::HostileSamples;
using testing::Samples;

// Numbers without a dimension: counts, numbers of things, fractions, unit vectors.
const std::set<std::string> pure = {"schema",
                                    "id",
                                    "episode",
                                    "line",
                                    "column",
                                    "tool",
                                    "u_first",
                                    "u_end",
                                    "normal",
                                    "tool_axis",
                                    "h_offset",
                                    "errors",
                                    "warnings",
                                    "infos",
                                    "blocks",
                                    "moves",
                                    "findings_dropped",
                                    "bodies",
                                    "pairs",
                                    "share_clear",
                                    "share_hit",
                                    "share_unresolved",
                                    "distance_queries",
                                    "overlap_queries",
                                    "accepted",
                                    "used",
                                    "baseline_gone"};

bool carries_unit(const std::string& key) {
  for (const char* unit : {"_mm", "_deg", "_s", "_mm_per_min", "_rpm"})
    if (key.ends_with(unit)) return true;
  return false;
}

void expect_units(const json& at, const std::string& key, bool unit_beside,
                  std::set<std::string>& seen) {
  if (at.is_number()) {
    seen.insert(key);
    EXPECT_TRUE(carries_unit(key) || pure.contains(key) || unit_beside)
        << "number '" << key << "' has no unit";
  }
  if (at.is_array())
    for (const json& item : at) expect_units(item, key, false, seen);
  if (at.is_object())
    for (const auto& [name, value] : at.items())
      expect_units(value, name, at.contains("unit"), seen);
}

TEST(Json, EveryNumberCarriesItsUnit) {
  const Samples samples;
  std::set<std::string> seen;
  expect_units(json::parse(to_json(samples.full())), "", false, seen);
  EXPECT_GT(seen.size(), 40u);
}

TEST(Json, IsOneDocumentOfSchemaOne) {
  const Samples samples;
  const json out = json::parse(to_json(samples.full()));
  EXPECT_EQ(out.at("schema"), 1);
  EXPECT_EQ(out.begin().key(), "accepted");  // sorted by this parser; the text begins with schema
  EXPECT_TRUE(to_json(samples.full()).starts_with("{\n  \"schema\": 1,"));
  for (const char* key : {"aircut", "verdict", "inputs", "summary", "findings", "unchecked",
                          "timing", "extents", "outputs", "programs"})
    EXPECT_TRUE(out.contains(key)) << key;
  EXPECT_EQ(out.at("verdict"), "fail");
}

TEST(Json, KeepsOneRowPerBlockTiedByEpisodeAndCountsRows) {
  const Samples samples;
  RunReport r = samples.clean();
  sim::Finding first = samples.collision(), next = first;
  next.id = 2;
  r.findings = {first, next};
  const json out = json::parse(to_json(r));
  ASSERT_EQ(out.at("findings").size(), 2u);
  EXPECT_EQ(out["findings"][0]["episode"], out["findings"][1]["episode"]);
  EXPECT_EQ(out["summary"]["errors"], 2);
}

TEST(Json, WritesAnglesInDegreesAndFeedsPerMinute) {
  const Samples samples;
  RunReport r = samples.clean();
  r.findings = {samples.collision()};
  const json row = json::parse(to_json(r)).at("findings").at(0);
  EXPECT_DOUBLE_EQ(row["joints_worst"]["C_deg"], 90);
  EXPECT_DOUBLE_EQ(row["joints_worst"]["X_mm"], 412);
  EXPECT_DOUBLE_EQ(row["feed_mm_per_min"], 12000);
  EXPECT_EQ(row["place"]["block"], "G0 X12.0 Z-4.0");
}

TEST(Json, GivesHostileTextBackUnchanged) {
  const HostileSamples samples;
  const json out = json::parse(to_json(samples.report()));
  const std::string message = out.at("findings").at(0).at("message");
  EXPECT_NE(message.find("</script><!-- ]]> &amp; <b>\r\n::error::mine"), std::string::npos);
  EXPECT_NE(message.find("\x1b[31mred \"quoted\""), std::string::npos);
  EXPECT_NE(message.find("\xc3\xbf\xc3\xbe"), std::string::npos);  // the bytes ff fe as Latin-1
}

TEST(Json, TellsEachProgramsVerdict) {
  const Samples samples;
  const json out = json::parse(to_json(testing::three_programs(samples)));
  ASSERT_EQ(out.at("programs").size(), 3u);
  EXPECT_EQ(out["programs"][0]["verdict"], "pass");
  EXPECT_EQ(out["programs"][1]["verdict"], "fail");
  EXPECT_EQ(out["programs"][2]["verdict"], "unknown");
  EXPECT_EQ(out["programs"][2]["unchecked"][0], "can't read 'gone.ngc'");
  EXPECT_EQ(out["findings"][0]["program"], "");  // of the tool table, which all share
  EXPECT_EQ(out["findings"][1]["program"], "parts/side.ngc");
}

TEST(Json, IsGolden) {
  const Samples samples;
  aircut::testing::expect_golden("report/golden/every_kind.json", to_json(samples.full()));
}

TEST(JsonLines, HoldTheItemsOfTheDocumentAndEndWithTheSummary) {
  const Samples samples;
  const RunReport r = samples.full();
  const json document = json::parse(to_json(r));
  std::stringstream lines(to_jsonl(r));
  std::vector<json> rows;
  for (std::string line; std::getline(lines, line);) rows.push_back(json::parse(line));
  ASSERT_GE(rows.size(), 3u);
  EXPECT_EQ(rows.front().at("item"), "head");
  EXPECT_EQ(rows.front().at("schema"), 1);
  EXPECT_EQ(rows.back().at("item"), "summary");
  EXPECT_EQ(rows.back().at("verdict"), "fail");
  EXPECT_EQ(rows.back().at("timing"), document.at("timing"));
  EXPECT_EQ(rows[1].at("item"), "unchecked");  // before any finding
  std::size_t findings = 0;
  for (json row : rows) {
    if (row.at("item") != "finding") continue;
    row.erase("item");
    EXPECT_EQ(row, document.at("findings").at(findings++));
  }
  EXPECT_EQ(findings, document.at("findings").size());
}

}  // namespace
}  // namespace aircut::report
