// What people read: golden messages, order, counts, verdict.

#include <gtest/gtest.h>

#include "samples.h"
#include "support/golden.h"

namespace aircut::report {
namespace {

using aircut::testing::expect_golden;
using testing::Samples;

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++n;
  return n;
}

class Human : public ::testing::Test {
 protected:
  std::string text(const RunReport& report) { return to_human(report, {}); }
  Samples samples_;
};

TEST_F(Human, TellsEveryKindOfFinding) {
  expect_golden("report/golden/every_kind.txt", text(samples_.full()));
}

TEST_F(Human, TellsARunWithoutFindings) {
  expect_golden("report/golden/clean.txt", text(samples_.clean()));
}

TEST_F(Human, TellsManyPrograms) {
  expect_golden("report/golden/three_programs.txt", text(testing::three_programs(samples_)));
}

TEST_F(Human, HasAnExampleOfEveryKind) {
  std::set<sim::Kind> kinds;
  for (const sim::Finding& f : samples_.every_kind()) kinds.insert(f.kind);
  EXPECT_EQ(kinds.size(), sim::finding_kinds().size());
}

TEST_F(Human, SaysFirstWhatWasNotChecked) {
  RunReport r = samples_.clean();
  r.findings = {samples_.collision(), samples_.not_executed(), samples_.unresolved()};
  r.summary.findings_dropped = 3;
  r.summary.interrupted = true;
  r.summary.unchecked = {"the rest"};
  const std::string out = text(r);
  EXPECT_TRUE(out.starts_with("not checked:\n  - the rest\n")) << out;
  const std::size_t messages = out.find("error[collision]");
  for (const char* what : {"interrupted", "3 more findings", "M110 was not run", "can be proven"})
    EXPECT_LT(out.find(what), messages) << what;
}

TEST_F(Human, GivesOneMessagePerEpisodeAndCountsMessages) {
  RunReport r = samples_.clean();
  sim::Finding first = samples_.collision(), next = first, other = samples_.collision();
  next.id = 2;
  next.span = samples_.line(5);
  next.block = first.block + 1;
  next.t_end = 90;
  other.body_b = "clamp";
  r.findings = {first, next, other};
  r.summary.verdict = sim::Verdict::fail;
  const std::string out = text(r);
  EXPECT_EQ(count(out, "error[collision]"), 2u) << out;
  EXPECT_NE(out.find("verdict: fail (2 errors, 0 warnings)"), std::string::npos) << out;
  EXPECT_NE(out.find("lasts: goes on in 1 more block, up to line 5, t = 90.000 s"),
            std::string::npos)
      << out;
}

TEST_F(Human, PrintsNoMoreMessagesThanAskedForAndSaysHowManyThereAre) {
  RunReport r = samples_.clean();
  for (int i = 0; i < 7; ++i) r.findings.push_back(samples_.collision());
  for (int i = 0; i < 5; ++i) r.summary.unchecked.push_back("thing");
  const std::string out = to_human(r, {.style = {}, .most = 3});
  EXPECT_EQ(count(out, "error[collision]"), 3u);
  EXPECT_NE(out.find("and 4 more messages"), std::string::npos) << out;
  EXPECT_EQ(count(out, "- thing"), 3u);
  EXPECT_NE(out.find("and 2 more\n"), std::string::npos) << out;
  EXPECT_NE(out.find("(7 errors, 0 warnings)"), std::string::npos) << out;
}

TEST_F(Human, DoesNotLetManyOfAKindHideAnother) {
  RunReport r = samples_.clean();
  for (int i = 0; i < 150; ++i) {
    r.findings.push_back(samples_.collision());
    r.findings.back().episode = i;
    r.findings.back().span = samples_.line(i < 149 ? 4 : 5);
  }
  sim::Finding other = samples_.collision();
  other.episode = 150;
  other.body_b = "clamp";
  r.findings.push_back(other);
  const std::string out = text(r);
  EXPECT_EQ(count(out, "error[collision]"), 11u) << out;
  EXPECT_NE(out.find("and 140 more messages"), std::string::npos) << out;
  EXPECT_NE(out.find("  - 140 collision of "), std::string::npos) << out;
  EXPECT_NE(out.find(":4:1 … 5\n"), std::string::npos) << out;
  EXPECT_NE(out.find("(151 errors, 0 warnings)"), std::string::npos) << out;
}

TEST_F(Human, TellsWhatALoopDoesAgainInOneLine) {
  RunReport r = samples_.clean();
  r.operations = {{"rim", 3, 1, 60}, {"pass", 5, 1, 10}, {"pass", 5, 1, 12}, {"pass", 5, 2, 1}};
  const std::string out = text(r);
  EXPECT_NE(out.find("1:00.0  T1  line 3  rim\n"), std::string::npos) << out;
  EXPECT_NE(out.find("0:22.0  T1  line 5  pass (2 times)\n"), std::string::npos) << out;
  EXPECT_NE(out.find("0:01.0  T2  line 5  pass\n"), std::string::npos) << out;
}

TEST_F(Human, IsOneLineWhenQuiet) {
  const std::string out = to_human(samples_.full(), {.style = {}, .quiet = true});
  EXPECT_TRUE(out.starts_with("verdict: fail ("));
  EXPECT_EQ(count(out, "\n"), 1u);
}

TEST_F(Human, ColoursTheVerdictOnlyWhenAsked) {
  EXPECT_EQ(text(samples_.full()).find('\x1b'), std::string::npos);
  EXPECT_NE(to_human(samples_.clean(), {.style = {.color = true}}).find("\x1b[1;32mpass"),
            std::string::npos);
}

TEST_F(Human, NeverCallsLessThanAllOfTheMotionAHundredPercent) {
  RunReport r = samples_.clean();
  r.summary.collision.clear = 0.9999999;
  EXPECT_EQ(text(r).find("100 % proven"), std::string::npos);
  EXPECT_NE(text(samples_.clean()).find("100 % proven clear"), std::string::npos);
}

TEST_F(Human, LinesForCompilersAndAnnotationsAreGolden) {
  expect_golden("report/golden/every_kind.gcc.txt", to_gcc(samples_.full()));
  expect_golden("report/golden/every_kind.github.txt", to_github(samples_.full()));
  expect_golden("report/golden/three_programs.gcc.txt", to_gcc(testing::three_programs(samples_)));
}

}  // namespace
}  // namespace aircut::report
