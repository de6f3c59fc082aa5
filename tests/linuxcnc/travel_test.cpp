#include <gtest/gtest.h>

#include "linuxcnc/linuxcnc.h"

namespace aircut::test {
namespace {

class Travelling : public ::testing::Test {
 protected:
  /// The axes that are told, in order, for a box of ±10 in X, Y and Z.
  std::string told(const std::string& program) {
    SourceMap sources;
    const SourceText& text = sources.add("p.ngc", program + "\nM2\n");
    interp::Options options;
    for (const Axis axis : all_axes) options.axes.add(axis);
    Diagnostics of_program, out;
    interp::Interpreter interpreter(text, {}, {}, options, {}, of_program);
    std::map<Axis, linuxcnc::Travel> travel;
    for (const Axis axis : {Axis::x, Axis::y, Axis::z}) travel[axis] = {-10, 10, {}, {}};
    travel[Axis::a].max = 1;
    linuxcnc::TravelCheck check(travel, {});
    while (const auto command = interpreter.next()) check.see(*command, out);
    EXPECT_EQ(of_program.errors(), 0u) << program;
    std::string all;
    for (const Diagnostic& d : out.list()) {
      EXPECT_EQ(d.kind, "overtravel");
      all += (all.empty() ? "" : " ") + d.message.substr(0, d.message.find(','));
    }
    return all;
  }
};

TEST_F(Travelling, TellsEndsOfMovesBeyondALimit) {
  EXPECT_EQ(told("G0 X10 Y-10 Z10"), "");
  EXPECT_EQ(told("G0 X10.001"), "X goes to machine position 10.001 mm");
  EXPECT_EQ(told("G0 X-12 Y11"),
            "X goes to machine position -12 mm Y goes to machine position 11 mm");
  EXPECT_EQ(told("G0 A90"), "A goes to machine position 90 degrees");
  EXPECT_EQ(told("G0 A-9000"), "") << "no limit on that side";
}

TEST_F(Travelling, CountsOffsetsOfWorkAndTool) {
  EXPECT_EQ(told("G10 L2 P1 X8\nG0 X3"), "X goes to machine position 11 mm");
  EXPECT_EQ(told("G43.1 Z8\nG0 Z3"), "Z goes to machine position 11 mm");
  EXPECT_EQ(told("G43.1 Z8\nG0 X1\nG49\nG0 Z9"), "") << "switching the offset moves no axis";
}

TEST_F(Travelling, SeesTheBulgesOfArcs) {
  // A circle of 12 about the origin leaves the box between ends that are inside.
  EXPECT_EQ(told("G0 X8.485 Y8.485\nG3 F100 X-8.485 Y8.485 I-8.485 J-8.485"),
            "Y goes to machine position 11.999602 mm");
  EXPECT_EQ(told("G0 X8.485 Y8.485\nG2 F100 X8.485 Y-8.485 I-8.485 J-8.485"),
            "X goes to machine position 11.999602 mm");
  EXPECT_EQ(told("G0 X9\nG3 F100 X-9 I-9"), "");
  // In ZX the first axis is Z: clockwise from 45 to 135 degrees is the long way.
  EXPECT_EQ(told("G18 G0 X8.485 Z8.485\nG2 F100 X8.485 Z-8.485 I-8.485 K-8.485\nG17"),
            "X goes to machine position -11.999602 mm Z goes to machine position 11.999602 mm "
            "Z goes to machine position -11.999602 mm");
  EXPECT_EQ(told("G18 G0 X8.485 Z8.485\nG3 F100 X8.485 Z-8.485 I-8.485 K-8.485\nG17"),
            "X goes to machine position 11.999602 mm");
}

TEST_F(Travelling, TellsEachBlockOnce) {
  EXPECT_EQ(told("o1 repeat [3]\nG0 X0\nG0 X11\no1 endrepeat"), "X goes to machine position 11 mm");
}

}  // namespace
}  // namespace aircut::test
