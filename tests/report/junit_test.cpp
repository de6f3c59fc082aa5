#include <gtest/gtest.h>

#include <map>
#include <pugixml.hpp>

#include "samples.h"
#include "support/golden.h"

namespace aircut::report {
namespace {

using testing::Samples;

// Reads the text back and checks what every JUnit reader relies on: the counts.
class JUnit {
 public:
  explicit JUnit(const RunReport& report) {
    const std::string text = to_junit(report);
    const auto read = document_.load_buffer(text.data(), text.size());
    EXPECT_TRUE(read) << read.description() << "\n" << text;
    unsigned tests = 0, failures = 0, errors = 0;
    for (const auto suite : root().children("testsuite")) {
      unsigned t = 0, f = 0, e = 0;
      for (const auto test : suite.children("testcase")) {
        ++t;
        f += test.child("failure") ? 1 : 0;
        e += test.child("error") ? 1 : 0;
        EXPECT_FALSE(test.child("failure") && test.child("error"));
        EXPECT_STREQ(test.attribute("classname").value(), suite.attribute("name").value());
      }
      expect_counts(suite, t, f, e);
      tests += t;
      failures += f;
      errors += e;
    }
    expect_counts(root(), tests, failures, errors);
  }
  pugi::xml_node root() const { return document_.child("testsuites"); }
  pugi::xml_node suite(const std::string& name) const {
    return root().find_child_by_attribute("testsuite", "name", name.c_str());
  }
  pugi::xml_node test(const std::string& in, const std::string& name) const {
    return suite(in).find_child_by_attribute("testcase", "name", name.c_str());
  }

 private:
  static void expect_counts(pugi::xml_node node, unsigned tests, unsigned failures,
                            unsigned errors) {
    EXPECT_EQ(node.attribute("tests").as_uint(99), tests);
    EXPECT_EQ(node.attribute("failures").as_uint(99), failures);
    EXPECT_EQ(node.attribute("errors").as_uint(99), errors);
  }
  pugi::xml_document document_;
};

constexpr const char* side = "parts/side.ngc";

TEST(JUnitReport, HasACasePerKind) {
  const Samples samples;
  const JUnit out(samples.full());
  for (const KindText& row : sim::finding_kinds())
    EXPECT_TRUE(out.test(side, row.kind)) << row.kind;
  EXPECT_TRUE(out.test(side, "collision").child("failure"));
  EXPECT_TRUE(out.test(side, "arc_error").child("failure"));
  EXPECT_STREQ(out.test(side, "collision").child("failure").attribute("type").value(), "collision");
  EXPECT_NE(std::string(out.test(side, "collision").child_value("failure")).find("vise/fixed-jaw"),
            std::string::npos);
}

TEST(JUnitReport, PassesACleanRun) {
  const Samples samples;
  const JUnit out(samples.clean());
  EXPECT_EQ(out.root().attribute("failures").as_int(), 0);
  EXPECT_EQ(out.root().attribute("errors").as_int(), 0);
  EXPECT_TRUE(out.test(side, "checked"));
}

TEST(JUnitReport, KeepsWarningsBelowTheFailLevelAsOutput) {
  const Samples samples;
  RunReport r = samples.clean();
  r.findings = {samples.near_miss()};
  EXPECT_FALSE(JUnit(r).test(side, "near_miss").child("failure"));
  EXPECT_TRUE(JUnit(r).test(side, "near_miss").child("system-out"));
  r.fail_on = Severity::warning;
  EXPECT_TRUE(JUnit(r).test(side, "near_miss").child("failure"));
}

TEST(JUnitReport, CallsUnknownAnError) {
  const Samples samples;
  RunReport r = samples.clean();
  r.summary.verdict = sim::Verdict::unknown;
  r.findings = {samples.not_executed(), samples.unresolved()};
  const JUnit out(r);
  EXPECT_TRUE(out.test(side, "not_executed").child("error"));
  EXPECT_TRUE(out.test(side, "near_miss").child("error"));
  EXPECT_TRUE(out.test(side, "checked").child("error"));
  // A refused block is never a pass, whatever the fail level.
  r.findings.clear();
  r.diagnostics = {make_error("arc_error", samples.line(3), "off the circle")};
  r.fail_on = std::nullopt;
  EXPECT_TRUE(JUnit(r).test(side, "arc_error").child("error"));
}

TEST(JUnitReport, HasASuitePerProgramAndOneForWhatTheyShare) {
  const Samples samples;
  const JUnit out(testing::three_programs(samples));
  EXPECT_TRUE(out.test("inputs", "tools_invalid"));
  EXPECT_EQ(out.suite("good.ngc").attribute("failures").as_int(9), 0);
  EXPECT_EQ(out.suite("good.ngc").attribute("errors").as_int(9), 0);
  EXPECT_TRUE(out.test(side, "arc_error").child("failure"));
  EXPECT_TRUE(out.test("gone.ngc", "checked").child("error"));
  EXPECT_FALSE(out.test(side, "checked").child("error"));
}

TEST(JUnitReport, CountsOneMessagePerEpisode) {
  const Samples samples;
  RunReport r = samples.clean();
  sim::Finding f = samples.collision();
  r.findings = {f, f, samples.collision()};
  EXPECT_NE(
      std::string(JUnit(r).test(side, "collision").child("failure").attribute("message").value())
          .find("(and 1 more)"),
      std::string::npos);
}

TEST(JUnitReport, ReadsBackHostileText) {
  const testing::HostileSamples samples;
  const JUnit out(samples.report());
  const auto suite = out.root().child("testsuite");
  EXPECT_NE(std::string(suite.attribute("name").value()).find("</script><!-- ]]> &amp; <b>^M^J"),
            std::string::npos);
}

TEST(JUnitReport, IsGolden) {
  const Samples samples;
  aircut::testing::expect_golden("report/golden/three_programs.junit.xml",
                                 to_junit(testing::three_programs(samples)));
}

}  // namespace
}  // namespace aircut::report
