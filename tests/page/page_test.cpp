// The replay against the motion itself, and what the page says of hostile texts.
#include "page/page.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "report/samples.h"
#include "support/box_machine.h"
#include "support/run_program.h"

namespace aircut::page {
namespace {

using testing::BoxMachine;

// Sees the same run and remembers all of it.
class Everything final : public sim::Observer {
 public:
  explicit Everything(Replay& replay) : replay_(replay) {}
  struct Moment {
    double t;
    machine::JointVector q;
  };
  std::vector<Moment> moments;

  void on_start(const sim::Scene& scene, const machine::JointVector& joints) override {
    replay_.on_start(scene, joints);
  }
  void on_step(const sim::Step& step) override {
    replay_.on_step(step);
    for (int i = 0; i <= 7 && step.segment.duration() > 0; ++i) {
      const double t = step.segment.t_start + step.segment.duration() * i / 7;
      if (const auto q = step.motion.at(t)) moments.push_back({t, *q});
    }
  }
  void on_finish(const sim::Summary& summary) override { replay_.on_finish(summary); }

 private:
  Replay& replay_;
};

class ReplayOf : public ::testing::Test {
 protected:
  void run(const std::string& text, std::size_t most_keys = 150'000) {
    program = &box.sources().add("main.ngc", text);
    replay = std::make_unique<Replay>(box.machine(), tool::ToolTable(), *program, most_keys);
    everything = std::make_unique<Everything>(*replay);
    result = testing::run_program("", box.machine(), {}, box.sources(), {.collision = false}, 1e6,
                                  everything.get(), program);
  }
  // Largest distance between the run and the straight lines in time between the keys.
  double worst() const {
    const auto& keys = replay->keys();
    double out = 0;
    std::size_t k = 0;
    for (const auto& moment : everything->moments) {
      while (k + 2 < keys.size() && keys[k + 1].t < moment.t) ++k;
      const double span = keys[k + 1].t - keys[k].t;
      const double share = span > 0 ? std::clamp((moment.t - keys[k].t) / span, 0.0, 1.0) : 1;
      const machine::JointVector q = keys[k].joints + share * (keys[k + 1].joints - keys[k].joints);
      out = std::max(out, (q - moment.q).lpNorm<Eigen::Infinity>());
    }
    return out;
  }
  BoxMachine box;
  const SourceText* program = nullptr;
  std::unique_ptr<Replay> replay;
  std::unique_ptr<Everything> everything;
  testing::RunResult result;
};

TEST_F(ReplayOf, LinesAndArcsStaysCloseToTheMotion) {
  run("G21 G90 G64 F3000\nG0 X-40 Y-40\nG1 X20\nG3 X20 Y40 I0 J40\nG2 X-20 Y0 I-40 J0 Z-20\nG1 X0 "
      "Y-60\nM2\n");
  ASSERT_GT(everything->moments.size(), 50u);
  EXPECT_LT(worst(), 2 * replay->tolerance());
  EXPECT_EQ(replay->tolerance(), 0.02);
  EXPECT_LT(replay->keys().size(), 400u);
  for (std::size_t i = 1; i < replay->keys().size(); ++i)
    EXPECT_GT(replay->keys()[i].t, replay->keys()[i - 1].t);
  EXPECT_NEAR(replay->keys().back().t, result.summary.cycle_time, 1e-9);
  EXPECT_NEAR(replay->keys().back().joints[1], -60, 1e-9);
}

TEST_F(ReplayOf, ALongRunStaysSmall) {
  run("G21 G90 G61 F6000\no100 repeat [400]\nG1 X20 Y5\nG1 X-20 Y-5\nG0 Z-3\nG0 Z0\no100 "
      "endrepeat\nM2\n",
      500);
  EXPECT_LE(replay->keys().size(), 500u);
  EXPECT_GT(replay->keys().size(), 100u);
  EXPECT_NEAR(replay->keys().back().t, result.summary.cycle_time, 1e-9);
}

TEST_F(ReplayOf, KnowsTheLineOfEveryMoment) {
  run("G21 G90 G61 F600\no<dip> sub\nG1 Z-5\nG1 Z0\no<dip> endsub\nG0 X10\no<dip> call\nG0 "
      "X0\nM2\n");
  std::vector<std::uint64_t> lines;
  for (const auto& block : replay->blocks()) lines.push_back(block.line);
  EXPECT_EQ(lines, (std::vector<std::uint64_t>{6, 3, 4, 8, 9}));
  EXPECT_EQ(replay->blocks()[0].kind, plan::MotionKind::rapid);
  EXPECT_EQ(replay->blocks()[1].kind, plan::MotionKind::feed);
}

TEST_F(ReplayOf, CountsWhatJointsAndToolsDid) {
  run("G21 G90 G61 F600\nG1 X30\nG1 X10\nG1 X20 Y-5\nG0 Z-10\nM2\n");
  const auto& x = replay->joint_uses()[0];
  EXPECT_NEAR(x.low, 0, 1e-9);
  EXPECT_NEAR(x.high, 30, 1e-9);
  EXPECT_NEAR(x.distance, 60, 1e-6);
  EXPECT_EQ(x.reversals, 2u);
  EXPECT_NEAR(replay->joint_uses()[1].distance, 5, 1e-6);
  ASSERT_EQ(replay->tool_uses().size(), 1u);
  const auto& use = replay->tool_uses()[0];
  EXPECT_NEAR(use.feed_length, 30 + 20 + std::hypot(10, 5), 1e-6);
  EXPECT_NEAR(use.max_feed, 10, 1e-9);
  EXPECT_EQ(use.first_line, 2u);
  EXPECT_EQ(use.last_line, 5u);
  EXPECT_NEAR(use.feed_time + use.rapid_time, result.summary.cycle_time, 1e-6);
}

TEST_F(ReplayOf, KnowsHowNearTheJointsCameToTheirLimits) {
  // The circle of 20 mm at 100 mm/s asks for v²/r = 500 mm/s² of X and Y at their largest speed of
  // 100 mm/s; the way to it brakes with the machine's 5000 mm/s², at 500 mm/s at most.
  run("G21 G90 G61 F6000\nG0 X180\nG0 X20\nG1 X20\nG3 X20 Y0 I-20 J0\nG3 X20 Y0 I-20 J0\nM2\n");
  const auto& peaks = replay->rates().peaks();
  const auto between = [&](double t0, double t1, int joint, Rates::Measure measure) {
    float most = 0;
    for (auto i = static_cast<std::size_t>(t0 / peaks.width());
         i <= static_cast<std::size_t>(t1 / peaks.width()) && i < peaks.values().size(); ++i)
      if (const auto& of = peaks.values()[i].of; !of.empty())
        most = std::max(most, of[static_cast<std::size_t>(joint * Rates::measures + measure)]);
    return most;
  };
  const double end = result.summary.cycle_time, turn = 40 * M_PI / 100;
  EXPECT_NEAR(between(0, end - 2 * turn - 0.2, 0, Rates::speed), 500, 1);
  EXPECT_NEAR(between(0, end - 2 * turn - 0.2, 0, Rates::acceleration), 5000, 5);
  EXPECT_EQ(between(0, end - 2 * turn - 0.2, 2, Rates::speed), 0);
  for (const int joint : {0, 1}) {
    EXPECT_NEAR(between(end - 0.95 * turn, end - 0.05 * turn, joint, Rates::speed), 100, 0.5);
    EXPECT_NEAR(between(end - 0.95 * turn, end - 0.05 * turn, joint, Rates::acceleration), 500, 2);
  }
}

std::size_t count(const std::string& text, std::string_view what) {
  std::size_t n = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

TEST_F(ReplayOf, HostileTextsStayInsideTheData) {
  run("G21 G90 F600\n(</script><script>alert(1)</script>)\nG1 X30\nM2\n");
  const report::testing::HostileSamples samples;
  const auto page = page_html({samples.report(), *replay, "/nonexistent"});
  const auto plain = page_html({report::RunReport{}, *replay, "/nonexistent"});
  for (const char* tag : {"<script", "</script", "<!--", "<b>", "<img"})
    EXPECT_EQ(count(page, tag), count(plain, tag)) << tag;
  // What is between the marks is JSON, and says what was given.
  const std::string begin = "id=\"run\">";
  const std::size_t from = page.find(begin) + begin.size();
  const auto json = nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
  EXPECT_EQ(json["report"]["verdict"], "fail");
  EXPECT_NE(json["report"]["machine"].get<std::string>().find("</script>"), std::string::npos);
}

TEST_F(ReplayOf, TheSameRunGivesTheSamePage) {
  run("G21 G90 F600\nG1 X30\nG2 X0 I-15 J0\nM2\n");
  EXPECT_EQ(page_html({report::RunReport{}, *replay, "."}),
            page_html({report::RunReport{}, *replay, "."}));
}

}  // namespace
}  // namespace aircut::page
