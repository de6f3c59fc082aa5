// Programs that switch between kinematics of one machine. The judge is the trunnion's own geometry,
// written out here: the work point p on the turntable goes by −C about Z, then by −A about the line
// along X at height 1010, and by −X, −Y with the slides; the spindle's face is at 1380 + Z.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "support/run_program.h"

namespace aircut::sim {
namespace {

using testing::run_program;
using testing::RunResult;

constexpr double degree = M_PI / 180;

// X Y Z of the slides for the tip p on the work, A and C.
std::array<double, 3> slides(const Vec3& p, double a, double c) {
  const double x = std::cos(c) * p.x() + std::sin(c) * p.y();
  const double y = -std::sin(c) * p.x() + std::cos(c) * p.y();
  const double z = p.z() + 980 - 1010;
  return {x, std::cos(a) * y + std::sin(a) * z, -std::sin(a) * y + std::cos(a) * z + 1010 - 1380};
}

struct Sample {
  std::uint64_t line = 0;
  JointVector q;
  AxisValues tip;  ///< as commanded
};

class Samples : public Observer {
 public:
  void on_start(const Scene&, const JointVector& joints) override { last_ = joints; }
  void on_step(const Step& step) override {
    for (int i = 0; i <= steps; ++i) {
      const double t = step.motion.t0() + (step.motion.t1() - step.motion.t0()) * i / steps;
      const auto state = step.motion.state_at(t);
      ASSERT_TRUE(state) << "line " << step.span().line;
      if (i == 0) jump = std::max(jump, (state->q - last_).cwiseAbs().maxCoeff());
      last_ = state->q;
      list.push_back({step.span().line, state->q, state->tip});
    }
  }
  std::vector<Sample> of_line(std::uint64_t line) const {
    std::vector<Sample> out;
    for (const Sample& s : list)
      if (s.line == line) out.push_back(s);
    return out;
  }
  std::vector<Sample> list;
  double jump = 0;  ///< the largest between two segments, mm or rad

 private:
  static constexpr int steps = 20;
  JointVector last_;
};

class Switch : public ::testing::Test {
 protected:
  std::shared_ptr<const machine::Machine> mill(const std::string& channel = {}) {
    Diagnostics problems;
    auto machine =
        machine::read_machine(AIRCUT_SOURCE_DIR "/machines/mill5-ac", sources_, problems, channel);
    EXPECT_TRUE(machine);
    return machine.value_or(nullptr);
  }
  RunResult run(const std::string& text, const std::string& channel = {},
                interp::Dialect dialect = interp::Dialect::linuxcnc) {
    tool::Tool tool;
    tool.number = 1;
    tool.offset[Axis::z] = 100;
    tool::ToolTable tools;
    tools.tools.push_back(tool);
    return run_program(text, mill(channel), tools, sources_, {.collision = false}, 360'000,
                       &samples_, nullptr, dialect);
  }
  // All samples of a line have their slides where the closed form has them.
  void expect_on_work(std::uint64_t line, double length = 0) {
    const auto list = samples_.of_line(line);
    ASSERT_GT(list.size(), 10u) << line;
    for (const Sample& s : list) {
      const Vec3 p(s.tip[Axis::x], s.tip[Axis::y], s.tip[Axis::z]);
      const auto xyz = slides(p, s.q[3], s.q[4]);
      EXPECT_NEAR(s.q[0], xyz[0], 1e-9);
      EXPECT_NEAR(s.q[1], xyz[1], 1e-9);
      EXPECT_NEAR(s.q[2], xyz[2] + length, 1e-9);
    }
  }
  SourceMap sources_;
  Samples samples_;
};

TEST_F(Switch, KeepsTheJointsAndChangesWhatTheWordsMean) {
  const RunResult r =
      run("G21 G90 G94 G61 F2000\n"
          "M429\n"
          "G0 X30 Y10 Z300 A-30 C40\n"
          "M428\n"
          "G1 X10\n"
          "G1 A-50 C10\n"
          "M429\n"
          "G1 X0\n"
          "M2\n");
  EXPECT_EQ(r.diagnostics.errors(), 0u);
  EXPECT_EQ(r.verdict, Verdict::pass);
  EXPECT_LT(samples_.jump, 1e-9);
  // Without tool centre point control the slides go as they are told, and the tables stand.
  const auto before = samples_.of_line(3).back();
  EXPECT_NEAR(before.q[0], 30, 1e-12);
  EXPECT_NEAR(before.q[2], -100, 1e-12);
  EXPECT_NEAR(before.q[3], -30 * degree, 1e-12);
  // With it the tip keeps its way on the work.
  expect_on_work(5);
  expect_on_work(6);
  const auto turn = samples_.of_line(6);
  for (const Sample& s : turn)
    for (const Axis axis : {Axis::x, Axis::y, Axis::z})
      EXPECT_NEAR(s.tip[axis], turn.front().tip[axis], 1e-12);
  EXPECT_NEAR(turn.front().tip[Axis::x], 10, 1e-12);
  EXPECT_GT(std::abs(turn.back().q[1] - turn.front().q[1]), 10);
  // And off again: only X moves, from where the slide is.
  const auto after = samples_.of_line(8);
  EXPECT_NEAR(after.front().q[0], turn.back().q[0], 1e-12);
  EXPECT_NEAR(after.back().q[0], 0, 1e-12);
  for (int j = 1; j < 5; ++j) EXPECT_NEAR(after.back().q[j], turn.back().q[j], 1e-9);
}

TEST_F(Switch, TakesWordsOfTheSameLineInTheNewKinematics) {
  const RunResult r = run("G21 G90 G94 G61 F2000\nM429\nG0 Z300 A-30\nM428 G1 X10\nM2\n");
  EXPECT_EQ(r.verdict, Verdict::pass);
  expect_on_work(4);
  EXPECT_NEAR(samples_.of_line(4).back().tip[Axis::x], 10, 1e-12);
}

TEST_F(Switch, ToACodeThatAlreadyHoldsDoesNothing) {
  EXPECT_EQ(run("G21 G90\nM428\nG0 X5\nM2\n").verdict, Verdict::pass);
  EXPECT_NEAR(samples_.list.back().q[0], 5, 1e-9);
}

TEST_F(Switch, OfFanucLikeControlsComesWithTheLengthOffset) {
  const RunResult r =
      run("O1\n"
          "G21 G90 G94 G61 G17\n"
          "G0 X30. Y10. Z300. A-30. C40.\n"
          "G43.4 H1 Z200.\n"
          "G1 A-50. C10. F2000.\n"
          "G49\n"
          "G1 X0.\n"
          "M30\n",
          "joints", interp::Dialect::fanuc);
  EXPECT_EQ(r.diagnostics.errors(), 0u);
  EXPECT_LT(samples_.jump, 1e-9);
  expect_on_work(5, 100);
  EXPECT_NEAR(samples_.of_line(5).front().tip[Axis::z], 200, 1e-12);
  const auto last = samples_.of_line(7);
  EXPECT_NEAR(last.back().q[0], 0, 1e-12);
  EXPECT_NEAR(last.back().q[3], -50 * degree, 1e-12);
}

TEST_F(Switch, RefusesReferencePointsWhileItIsOn) {
  const RunResult r = run("O1\nG21 G90\nG43.4 H1\nG28 Z0\nM30\n", "joints", interp::Dialect::fanuc);
  ASSERT_EQ(r.diagnostics.errors(), 1u);
  EXPECT_EQ(r.diagnostics.list().back().kind, "frame_error");
}

}  // namespace
}  // namespace aircut::sim
