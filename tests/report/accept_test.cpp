// Waivers, baselines, raised kinds, strictness.

#include "report/accept.h"

#include <gtest/gtest.h>

#include "samples.h"

namespace aircut::report {
namespace {

using testing::Samples;

Waiver waiver(const std::string& text) {
  const auto read = read_waiver(text);
  EXPECT_TRUE(read) << text;
  return read.value_or(Waiver{});
}

TEST(Waiver, HasAKindAndMayHaveAFileAndALine) {
  const Waiver w = waiver("wrong_offset:parts/side.ngc:12=H12 is the second edge=B");
  EXPECT_EQ(w.kind, "wrong_offset");
  EXPECT_EQ(w.file, "parts/side.ngc");
  EXPECT_EQ(w.line, 12u);
  EXPECT_EQ(w.reason, "H12 is the second edge=B");
  EXPECT_EQ(waiver("near_miss=soft jaw").file, "");
  EXPECT_EQ(waiver("near_miss:a.ngc=soft jaw").line, 0u);
}

TEST(Waiver, IsRefusedWithoutAReasonOrWithAnotherForm) {
  for (const char* text : {"near_miss", "near_miss=", "near_miss= ", "=why", "near_miss:=why",
                           "near_miss:a:0=why", "near_miss:a:1x=why", "near_miss:a:=why"}) {
    const auto read = read_waiver(text);
    ASSERT_FALSE(read) << text;
    EXPECT_EQ(read.error().kind, "usage");
  }
}

class Accept : public ::testing::Test {
 protected:
  Accept() : report_(samples_.clean()) {
    report_.findings = {samples_.collision(), samples_.near_miss()};
    Diagnostic d = make_error("wrong_offset", samples_.line(3), "G43 takes the length of T2");
    report_.diagnostics = {d, d};
    report_.diagnostics[1].span = samples_.line(4);
    report_.summary.unchecked = {"parts/side.ngc:6:1: nobody knows", "the rest"};
    Diagnostic open = make_error("not_executed", samples_.line(6), "nobody knows");
    open.severity = Severity::warning;
    report_.diagnostics.push_back(open);
  }

  void apply(Rules rules) {
    Acceptance acceptance(std::move(rules));
    acceptance.apply("parts/side.ngc", report_.diagnostics, report_.findings,
                     report_.summary.unchecked, report_);
    acceptance.finish(report_);
  }
  Rules waive(const std::string& text) {
    Rules rules;
    rules.waivers = {waiver(text)};
    return rules;
  }

  Samples samples_;
  RunReport report_;
};

TEST_F(Accept, TakesAWaivedKindOutOfTheMessagesAndListsIt) {
  apply(waive("wrong_offset=second edge"));
  EXPECT_EQ(report_.diagnostics.size(), 1u);
  EXPECT_EQ(report_.findings.size(), 2u);
  ASSERT_EQ(report_.accepted.size(), 2u);
  EXPECT_EQ(report_.accepted[0].reason, "second edge");
  EXPECT_EQ(report_.waivers.at(0).used, 2u);
}

TEST_F(Accept, LooksAtTheFileAndTheLine) {
  apply(waive("wrong_offset:side.ngc:4=second edge"));
  ASSERT_EQ(report_.accepted.size(), 1u);
  EXPECT_EQ(report_.accepted[0].message.span.line, 4u);
}

TEST_F(Accept, SaysWhenAWaiverWasNotNeeded) {
  for (const char* text : {"wrong_offset:other.ngc=x", "wrong_offset:ide.ngc=x",
                           "wrong_offset:side.ngc:5=x", "spindle_speed_limit=x"}) {
    RunReport before = report_;
    apply(waive(text));
    EXPECT_TRUE(report_.accepted.empty()) << text;
    EXPECT_EQ(report_.diagnostics.back().kind, "waiver_unused");
    EXPECT_EQ(report_.diagnostics.back().severity, Severity::warning);
    report_ = before;
  }
}

TEST_F(Accept, WaivesFindingsOfTheMachineToo) {
  apply(waive("collision:side.ngc:4=the jaw is soft"));
  ASSERT_EQ(report_.findings.size(), 1u);
  EXPECT_EQ(report_.findings[0].kind, sim::Kind::near_miss);
}

TEST_F(Accept, ForgetsWhatIsNotKnownOnceThatIsAccepted) {
  apply(waive("not_executed=a lamp"));
  EXPECT_EQ(report_.summary.unchecked, std::vector<std::string>{"the rest"});
}

TEST_F(Accept, RaisesAKind) {
  Rules rules;
  rules.raised = {"near_miss", "not_executed"};
  apply(rules);
  EXPECT_EQ(report_.findings[1].severity, Severity::error);
  EXPECT_EQ(report_.diagnostics[2].severity, Severity::error);
}

TEST_F(Accept, TurnsWhatIsNotKnownIntoErrorsWhenStrict) {
  Rules rules;
  rules.strict = true;
  report_.findings.push_back(samples_.unresolved());
  apply(rules);
  EXPECT_EQ(report_.findings[2].severity, Severity::error);
  EXPECT_EQ(report_.diagnostics[2].severity, Severity::error);
  ASSERT_EQ(report_.diagnostics.size(), 4u);  // "the rest" has no message of its own
  EXPECT_EQ(report_.diagnostics[3].kind, "not_checked");
  EXPECT_EQ(report_.diagnostics[3].message, "the rest");
}

// What one run says, the next accepts: from both forms, and however lines have moved.
TEST_F(Accept, TakesWhatABaselineHasAndCountsTheRest) {
  const std::string json = to_json(report_);
  const std::string sarif = to_sarif(report_, {.kinds = {}, .folder = {}, .most = 100});
  for (const std::string& text : {json, sarif}) {
    SourceMap sources;
    const auto baseline = read_baseline(sources.add("result.json", text));
    ASSERT_TRUE(baseline) << baseline.error().message;
    Rules rules;
    rules.baseline = *baseline;
    rules.has_baseline = true;
    const RunReport before = report_;
    apply(rules);
    EXPECT_TRUE(report_.diagnostics.empty());
    EXPECT_TRUE(report_.findings.empty());
    EXPECT_EQ(report_.accepted.size(), 5u);
    EXPECT_EQ(report_.baseline_gone, 0u);

    // Accepted ones are in the next baseline again.
    const auto again = read_baseline(sources.add("again.json", to_json(report_)));
    ASSERT_TRUE(again);
    EXPECT_EQ(*again, *baseline);
    report_ = before;

    // One more of a kind than before is new; one less is gone.
    report_.findings.push_back(samples_.collision());
    report_.diagnostics.erase(report_.diagnostics.begin());
    apply(rules);
    EXPECT_EQ(report_.findings.size(), 1u);
    EXPECT_EQ(report_.baseline_gone, 1u);
    report_ = before;
  }
}

TEST_F(Accept, RefusesABaselineThatIsNone) {
  SourceMap sources;
  for (const char* text : {"", "not json", "[]", "{}", "{\"runs\":[{\"results\":5}]}",
                           "{\"runs\":7}", "{\"findings\":[]}"}) {
    const auto read = read_baseline(sources.add("b.json", text));
    ASSERT_FALSE(read) << text;
    EXPECT_EQ(read.error().kind, "input");
  }
}

TEST_F(Accept, IsSeenInEveryForm) {
  Rules rules = waive("wrong_offset=<b>second\x1b[31m edge</b>");
  rules.waivers.push_back(waiver("comp_rapid=never"));
  apply(rules);
  const std::string human = to_human(report_, {});
  EXPECT_NE(human.find("accepted:"), std::string::npos) << human;
  EXPECT_NE(human.find("2 accepted"), std::string::npos) << human;
  EXPECT_NE(human.find("waiver_unused"), std::string::npos) << human;
  EXPECT_EQ(harmless(human), human);
  EXPECT_EQ(human.find('\x1b'), std::string::npos);
  const std::string json = to_json(report_), sarif = to_sarif(report_, {});
  EXPECT_NE(json.find("\"used\": 2"), std::string::npos);
  EXPECT_NE(json.find("\"by\": \"waiver\""), std::string::npos);
  EXPECT_NE(sarif.find("suppressions"), std::string::npos);
  EXPECT_EQ(json.find("<b>"), std::string::npos);
  EXPECT_EQ(sarif.find("<b>"), std::string::npos);
}

TEST_F(Accept, SaysWhyTheExitCodeIsWhatItIs) {
  RunReport r;
  r.summary.verdict = sim::Verdict::pass;
  EXPECT_EQ(cause_of(r), "ok");
  r.summary.verdict = sim::Verdict::fail;
  EXPECT_EQ(cause_of(r), "findings");
  r.summary.verdict = sim::Verdict::unknown;
  EXPECT_EQ(cause_of(r), "unchecked");
  r.unknown_cause = "limit";
  EXPECT_EQ(cause_of(r), "limit");
  r.summary.interrupted = true;
  EXPECT_EQ(cause_of(r), "interrupted");
}

}  // namespace
}  // namespace aircut::report
