#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "interp/interp.h"
#include "samples.h"
#include "support/golden.h"

namespace aircut::report {
namespace {

using nlohmann::json;
using testing::Samples;

std::vector<KindText> kinds() {
  std::vector<KindText> out = interp::error_kinds();
  for (const KindText& row : sim::finding_kinds()) out.push_back(row);
  return out;
}

json sarif(const RunReport& report, SarifOptions options = {.kinds = kinds(), .folder = {}}) {
  return json::parse(to_sarif(report, options));
}

void expect_text(const json& message) {
  ASSERT_TRUE(message.is_object());
  EXPECT_FALSE(message.at("text").get<std::string>().empty());
}

void expect_location(const json& location) {
  const json& place = location.at("physicalLocation");
  const std::string uri = place.at("artifactLocation").at("uri");
  EXPECT_FALSE(uri.empty());
  for (const char c : uri) EXPECT_TRUE(c > 0x20 && c < 0x7f && c != '<' && c != '"') << uri;
  if (!place.contains("region")) return;
  const json& region = place.at("region");
  EXPECT_GE(region.at("startLine"), 1);
  EXPECT_GE(region.at("startColumn"), 1);
  EXPECT_GT(region.at("endColumn"), region.at("startColumn"));
}

// What the standard requires of the parts that we write.
void expect_valid(const json& log) {
  EXPECT_EQ(log.at("version"), "2.1.0");
  EXPECT_TRUE(log.at("$schema").is_string());
  ASSERT_EQ(log.at("runs").size(), 1u);
  const json& run = log["runs"][0];
  const json& driver = run.at("tool").at("driver");
  EXPECT_EQ(driver.at("name"), "aircut");
  std::set<std::string> ids;
  for (const json& rule : driver.at("rules")) {
    EXPECT_TRUE(ids.insert(rule.at("id")).second) << "ids of rules must differ";
    if (rule.contains("shortDescription")) expect_text(rule["shortDescription"]);
    if (rule.contains("fullDescription")) expect_text(rule["fullDescription"]);
  }
  EXPECT_EQ(run.at("columnKind"), "unicodeCodePoints");
  for (const json& invocation : run.at("invocations")) {
    EXPECT_TRUE(invocation.at("executionSuccessful").is_boolean());
    for (const json& note : invocation.at("toolExecutionNotifications"))
      expect_text(note.at("message"));
  }
  const std::set<std::string> levels = {"none", "note", "warning", "error"};
  std::set<std::string> fingerprints;
  for (const json& result : run.at("results")) {
    expect_text(result.at("message"));
    EXPECT_TRUE(levels.contains(result.at("level")));
    const std::size_t index = result.at("ruleIndex");
    ASSERT_LT(index, driver["rules"].size());
    EXPECT_EQ(driver["rules"][index]["id"], result.at("ruleId"));
    for (const json& location : result.at("locations")) expect_location(location);
    if (result.contains("relatedLocations"))
      for (const json& location : result["relatedLocations"]) expect_location(location);
    for (const auto& [name, value] : result.at("partialFingerprints").items())
      EXPECT_TRUE(fingerprints.insert(value).second) << "fingerprints must differ";
  }
  for (const json& artifact : run.at("artifacts")) {
    EXPECT_TRUE(artifact.at("location").contains("uri"));
    EXPECT_TRUE(artifact.at("hashes").contains("sha-256"));
  }
}

TEST(Sarif, HasWhatTheStandardRequires) {
  const Samples samples;
  expect_valid(sarif(samples.full()));
  expect_valid(sarif(samples.clean()));
  expect_valid(sarif(testing::three_programs(samples)));
  const testing::HostileSamples hostile;
  expect_valid(sarif(hostile.report()));
}

TEST(Sarif, TakesTheTextOfRulesFromTheTableOfKinds) {
  const Samples samples;
  const json log = sarif(samples.full(), {.kinds = sim::finding_kinds(), .folder = {}});
  std::size_t found = 0;
  for (const json& rule : log["runs"][0]["tool"]["driver"]["rules"])
    for (const KindText& row : sim::finding_kinds())
      if (rule["id"] == row.kind) {
        ++found;
        EXPECT_EQ(rule["shortDescription"]["text"], std::string(row.title));
        EXPECT_EQ(rule["help"]["text"], std::string(row.text));
      }
  EXPECT_EQ(found, sim::finding_kinds().size());
}

TEST(Sarif, UnderlinesTheWord) {
  const Samples samples;
  RunReport r = samples.clean();
  r.diagnostics = {make_error("arc_error", samples.word(3, 3, 5), "off the circle")};
  const json region =
      sarif(r)["runs"][0]["results"][0]["locations"][0]["physicalLocation"]["region"];
  EXPECT_EQ(region["startLine"], 3);
  EXPECT_EQ(region["startColumn"], 4);
  EXPECT_EQ(region["endColumn"], 9);
  EXPECT_EQ(region["snippet"]["text"], "X40.0");
}

std::string fingerprint(const std::string& name, const std::string& text, std::uint32_t line,
                        const std::string& body) {
  SourceMap sources;
  const SourceText& program = sources.add(name, text);
  const Samples samples;
  RunReport r = samples.clean();
  sim::Finding f = samples.collision();
  f.span = Samples::line_of(program, line);
  f.span.length = 2;
  f.body_b = body;
  r.findings = {f};
  return sarif(r)["runs"][0]["results"][0]["partialFingerprints"]["aircutBlock/v1"];
}

TEST(Sarif, KeepsFingerprintsWhenLinesShiftOrAreRenumbered) {
  const std::string at = fingerprint("a.ngc", "G21\nG0 X1\n", 2, "vise");
  EXPECT_EQ(at, fingerprint("a.ngc", "(new)\n\nG21\nG0 X1\n", 4, "vise"));
  EXPECT_EQ(at, fingerprint("./a.ngc", "G21\nG0  X1\n", 2, "vise"));
  EXPECT_NE(at, fingerprint("a.ngc", "G21\nG0 X1\n", 2, "clamp"));
  EXPECT_NE(at, fingerprint("b.ngc", "G21\nG0 X1\n", 2, "vise"));
  EXPECT_NE(at, fingerprint("a.ngc", "G21\nG0 X2\n", 2, "vise"));
}

TEST(Sarif, KeepsFingerprintsWhenBlocksAreRenumbered) {
  const auto of = [](const std::string& text) {
    SourceMap sources;
    const SourceText& program = sources.add("a.ngc", text);
    RunReport r;
    SourceSpan span = Samples::line_of(program, 1);
    span.begin = text.find('X');
    span.length = 2;
    r.diagnostics = {make_error("arc_error", span, "…")};
    return sarif(r)["runs"][0]["results"][0]["partialFingerprints"];
  };
  EXPECT_EQ(of("N10 G2 X1\n"), of("N250G2 X1\n"));
  EXPECT_NE(of("N10 G2 X1\n"), of("N10 G2 X2\n"));
}

TEST(Sarif, WritesPathsRelativeToTheFolderAndEncoded) {
  const auto uri = [](const std::string& path) {
    RunReport r;
    r.inputs = {{"program", path, "00"}};
    return sarif(r, {.kinds = {},
                     .folder = "/home/me/job"})["runs"][0]["artifacts"][0]["location"]["uri"]
        .get<std::string>();
  };
  EXPECT_EQ(uri("parts/a.ngc"), "parts/a.ngc");
  EXPECT_EQ(uri("./parts/../a b#1.ngc"), "a%20b%231.ngc");
  EXPECT_EQ(uri("/home/me/job/parts/a.ngc"), "parts/a.ngc");
  EXPECT_EQ(uri("/home/you/a.ngc"), "file:///home/you/a.ngc");
  EXPECT_EQ(uri("c:x.ngc"), "c%3Ax.ngc");
}

TEST(Sarif, WritesAtMostSoManyResultsAndCountsTheRest) {
  const Samples samples;
  RunReport r = samples.clean();
  for (int i = 0; i < 12; ++i) r.findings.push_back(samples.collision());
  const json run = sarif(r, {.kinds = kinds(), .folder = {}, .most = 5})["runs"][0];
  EXPECT_EQ(run["results"].size(), 5u);
  const json notes = run["invocations"][0]["toolExecutionNotifications"];
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0]["message"]["text"].get<std::string>().find("7 of 12 results"),
            std::string::npos);
  EXPECT_EQ(SarifOptions{}.most, 25'000u);
}

TEST(Sarif, TellsWhatWasNotCheckedAsNotification) {
  const Samples samples;
  const json run = sarif(testing::three_programs(samples))["runs"][0];
  EXPECT_EQ(run["invocations"][0]["executionSuccessful"], false);
  EXPECT_EQ(run["invocations"][0]["toolExecutionNotifications"][0]["descriptor"]["id"],
            "not_checked");
  EXPECT_EQ(run["properties"]["verdict"], "fail");
}

TEST(Sarif, IsGolden) {
  const Samples samples;
  aircut::testing::expect_golden(
      "report/golden/three_programs.sarif",
      to_sarif(testing::three_programs(samples), {.kinds = interp::error_kinds(), .folder = {}}));
}

}  // namespace
}  // namespace aircut::report
