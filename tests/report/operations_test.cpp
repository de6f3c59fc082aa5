// Time by operation, from segments made by hand.
#include "report/operations.h"

#include <gtest/gtest.h>

#include "support/box_machine.h"

namespace aircut::report {
namespace {

class OperationsTest : public ::testing::Test {
 protected:
  OperationsTest() : scene_(box_.machine(), tool::ToolTable{}) {}
  void step(canon::Action action, plan::MotionKind kind = plan::MotionKind::idle,
            double seconds = 0) {
    plan::Segment segment;
    segment.command.action = std::move(action);
    segment.command.span.line = ++line_;
    segment.kind = kind;
    segment.tool = tool_;
    if (seconds > 0) segment.profile.knots = {{0, 0, 0, 0, 0}, {seconds, 0, 0, 0, 0}};
    const motion::JointMotion motion(*box_.machine(), segment, box_.machine()->home());
    operations_.on_step({scene_, motion, segment});
  }
  void comment(const std::string& text) {
    step(canon::Message{canon::Message::Kind::comment, text});
  }
  void change(int tool) {
    step(canon::ChangeTool{.number = tool}, plan::MotionKind::tool_change, 3);
    tool_ = tool;
  }
  void cut(double seconds) { step(canon::LinearFeed{}, plan::MotionKind::feed, seconds); }
  void rapid(double seconds) { step(canon::Rapid{}, plan::MotionKind::rapid, seconds); }

  testing::BoxMachine box_;
  sim::Scene scene_;
  Operations operations_;
  std::uint32_t line_ = 0;
  int tool_ = 0;
};

TEST_F(OperationsTest, BeginWithCommentsAndToolChanges) {
  comment("PROGRAM 12");
  comment("POCKET");  // 2
  change(1);
  rapid(1);
  cut(10);
  comment("CONTOUR");  // 6
  cut(5);
  change(2);  // 8
  rapid(2);
  const auto& list = operations_.list();
  ASSERT_EQ(list.size(), 3u);
  EXPECT_EQ(list[0].name, "POCKET");
  EXPECT_EQ(list[0].line, 2u);
  EXPECT_EQ(list[0].tool, 1);
  EXPECT_EQ(list[0].time, 14);
  EXPECT_EQ(list[0].feed, 10);
  EXPECT_EQ(list[0].rapid, 1);
  EXPECT_EQ(list[0].tool_change, 3);
  EXPECT_EQ(list[1].name, "CONTOUR");
  EXPECT_EQ(list[1].time, 5);
  EXPECT_EQ(list[2].name, "");
  EXPECT_EQ(list[2].line, 8u);
  EXPECT_EQ(list[2].tool, 2);
  EXPECT_EQ(list[2].time, 5);
}

TEST_F(OperationsTest, HaveTheWayToTheirToolChange) {
  cut(1);
  comment("POCKET");
  rapid(2);
  change(1);
  cut(3);
  ASSERT_EQ(operations_.list().size(), 2u);
  EXPECT_EQ(operations_.list()[1].name, "POCKET");
  EXPECT_EQ(operations_.list()[1].time, 8);
  EXPECT_EQ(operations_.list()[1].tool, 1);
}

TEST_F(OperationsTest, OfAProgramWithoutWordsAreOne) {
  cut(1);
  cut(2);
  ASSERT_EQ(operations_.list().size(), 1u);
  EXPECT_EQ(operations_.list()[0].time, 3);
  EXPECT_EQ(operations_.list()[0].line, 1u);
}

TEST_F(OperationsTest, AreAtMostAThousand) {
  for (int i = 0; i < 3000; ++i) {
    comment("step");
    cut(1);
  }
  ASSERT_EQ(operations_.list().size(), 1000u);
  EXPECT_EQ(operations_.list().back().time, 2001);
}

}  // namespace
}  // namespace aircut::report
