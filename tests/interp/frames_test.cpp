// Mirror image, scaling, rotation and shifts of Fanuc-like controls against 4x4 matrices that are
// multiplied here, step by step, as the manuals describe the steps.
#include <gtest/gtest.h>

#include <random>

#include "interp/run_program.h"
#include "interp/state.h"

namespace aircut::test {
namespace {

using Mat4 = Eigen::Matrix4d;

Mat4 shifted(const Vec3& by) {
  Mat4 m = Mat4::Identity();
  for (int i = 0; i < 3; ++i) m(i, 3) = by[i];
  return m;
}

/// A linear map about a point.
Mat4 about(const Vec3& at, const Mat4& linear) { return shifted(at) * linear * shifted(-at); }

Mat4 stretched(double x, double y, double z) {
  Mat4 m = Mat4::Identity();
  m(0, 0) = x;
  m(1, 1) = y;
  m(2, 2) = z;
  return m;
}

/// Counter-clockwise by degrees about an axis: 2 is Z (G17), 1 is Y (G18), 0 is X (G19).
Mat4 turned(int axis, double degrees) {
  const double angle = degrees * std::numbers::pi / 180;
  const int a = (axis + 1) % 3, b = (axis + 2) % 3;
  Mat4 m = Mat4::Identity();
  m(a, a) = m(b, b) = std::cos(angle);
  m(b, a) = std::sin(angle);
  m(a, b) = -std::sin(angle);
  return m;
}

Vec3 mapped(const Mat4& m, const Vec3& p) { return (m * p.homogeneous()).head<3>(); }

Setting fanuc(interp::Dialect dialect = interp::Dialect::fanuc) {
  Setting setting;
  setting.options.dialect = dialect;
  for (const Axis axis : {Axis::x, Axis::y, Axis::z, Axis::c}) setting.options.axes.add(axis);
  for (int number = 1; number <= 3; ++number) {
    tool::Tool tool;
    tool.number = number;
    tool.offset[Axis::z] = 100 + number;
    tool.diameter = 2 * number;
    setting.tools.tools.push_back(tool);
  }
  return setting;
}

Ran run(const std::string& program, const Setting& setting = fanuc()) {
  SourceMap sources;
  Ran ran = run_program(sources, program, setting);
  for (const Diagnostic& d : ran.diagnostics.list())
    EXPECT_NE(d.severity, Severity::error) << program << format_gcc(d);
  return ran;
}

Vec3 tip_after(const std::string& program, const Setting& setting = fanuc()) {
  const AxisValues tip = end_tip(run(program + "\nM30\n", setting));
  return {tip[Axis::x], tip[Axis::y], tip[Axis::z]};
}

std::string number(double value) { return fixed(value, 6); }
std::string words(const Vec3& p, const char* letters = "XYZ") {
  std::string out;
  for (int i = 0; i < 3; ++i) out += std::string(" ") + letters[i] + number(p[i]);
  return out;
}

void expect_near(const Vec3& a, const Vec3& b, const std::string& what, double within = 1e-5) {
  EXPECT_LT((a - b).norm(), within)
      << what << "\n got " << a.transpose() << "\n want " << b.transpose();
}

class Numbers {
 public:
  double from(double low, double high) {
    // Six decimals, so that the text of a program holds the number as it is.
    return std::round(std::uniform_real_distribution<double>(low, high)(random_) * 1e6) / 1e6;
  }
  Vec3 point() { return {from(-50, 50), from(-50, 50), from(-50, 50)}; }
  int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(random_); }

 private:
  std::mt19937 random_{7};
};

TEST(Frames, ComposeAsTheirMatricesDo) {
  Numbers r;
  const char* const planes[] = {"G19", "G18", "G17"};
  for (int round = 0; round < 300; ++round) {
    std::string program = "G21 G90\n";
    const Vec3 work = r.point(), local = r.point();
    program += "G10 L2 P1" + words(work) + "\nG52" + words(local) + "\n";
    Mat4 map = Mat4::Identity();
    const int normal = r.below(3), a = (normal + 1) % 3, b = (normal + 2) % 3;
    program += std::string(planes[normal]) + "\n";
    bool odd = false;  // mirrored in the plane of rotation
    if (r.below(2)) {
      const int axis = r.below(3);
      const double at = r.from(-20, 20);
      program += std::string("G51.1 ") + "XYZ"[axis] + number(at) + "\n";
      Vec3 sign = Vec3::Ones(), centre = Vec3::Zero();
      sign[axis] = -1;
      centre[axis] = at;
      map = about(centre, stretched(sign[0], sign[1], sign[2])) * map;
      odd = axis != normal;
    }
    if (r.below(2)) {
      const Vec3 centre = r.point(), factor(r.from(0.2, 3), -r.from(0.2, 3), r.from(0.2, 3));
      program += "G51" + words(centre) + words(factor, "IJK") + "\n";
      map = about(mapped(map, centre), stretched(factor[0], factor[1], factor[2])) * map;
    }
    if (r.below(4)) {
      const Vec3 centre = r.point();
      const double angle = r.from(-360, 360);
      program += std::string("G68 ") + "XYZ"[a] + number(centre[a]) + " " + "XYZ"[b] +
                 number(centre[b]) + " R" + number(angle) + "\n";
      map = about(mapped(map, centre), turned(normal, odd ? -angle : angle)) * map;
    }
    const Vec3 p = r.point();
    program += "G0" + words(p);
    expect_near(tip_after(program), mapped(shifted(work) * shifted(local) * map, p), program);
    // An incremental move adds the mapped vector.
    const Vec3 d = r.point();
    expect_near(tip_after(program + "\nG91" + words(d)),
                mapped(shifted(work) * shifted(local) * map, p + d), program);
  }
}

TEST(Frames, ProgramCoordinatesComeBackFromTheTip) {
  Numbers r;
  for (int round = 0; round < 1000; ++round) {
    interp::ModalState state;
    for (const Axis axis : all_axes) {
      state.work_offset[axis] = r.from(-500, 500);
      state.g92[axis] = r.from(-500, 500);
    }
    state.rotation = r.below(2) ? r.from(-3, 3) : 0;
    for (bool& mirrored : state.frame.mirrored) mirrored = r.below(2);
    state.frame.mirror_at = r.point();
    state.frame.scaled = r.below(2);
    state.frame.factors = Vec3(r.from(0.01, 10), -r.from(0.01, 10), r.from(0.01, 10));
    state.frame.scale_at = r.point();
    state.frame.turned = r.below(2);
    state.frame.angle = r.from(-7, 7);
    state.frame.plane = static_cast<canon::Plane>(r.below(3));
    state.frame.turn_at = r.point();
    state.frame.update();
    AxisValues p;
    for (const Axis axis : all_axes) p[axis] = r.from(-100, 100);
    const AxisValues back = to_program(state, to_tip(state, p));
    for (const Axis axis : all_axes) EXPECT_NEAR(back[axis], p[axis], 1e-9);
  }
}

TEST(Frames, ThatAreTakenBackLeaveNothing) {
  const Vec3 p(12, -7, 3);
  for (const std::string frame :
       {"G68 X5. Y6. R33.\nG69\n", "G51 X5. Y6. Z1. P3.\nG50\n", "G51.1 X4.\nG50.1 X0\n",
        "G51.1 X4. Y1.\nG50.1\n", "G51.1 X0\nG51 X0 Y0 Z0 P2.\nG68 X0 Y0 R10.\nG69 G50 G50.1\n",
        "G52 X5.\nG52 X0\n", "G92 X5.\nG92.1 X0\n"})
    expect_near(tip_after(frame + "G0" + words(p)), p, frame);
}

TEST(Frames, AMirrorTwiceIsNone) {
  // Two mirrors about one axis can't be given; a mirror by a factor of -1 is the second.
  expect_near(tip_after("G51.1 X7.\nG51 X7. Y0 Z0 I-1. J1. K1.\nG0 X10. Y2. Z3."), {10, 2, 3},
              "mirror and factor -1");
}

TEST(Frames, RotationWithoutACentreTurnsAboutTheTool) {
  expect_near(tip_after("G0 X10. Y5. Z0\nG68 R90.\nG0 X11. Y5."), {10, 6, 0}, "about the tool");
}

TEST(Frames, TheFirstMoveTakesTheOtherAxisFromBeforeTheRotation) {
  const Ran ran = run("G0 X10. Y10. Z0\nG68 X0 Y0 R45.\nG1 Y14.142136 F100\nG69\nM30\n");
  const AxisValues tip = end_tip(ran);
  const Vec3 want = mapped(turned(2, 45), {10, 14.142136, 0});
  expect_near({tip[Axis::x], tip[Axis::y], tip[Axis::z]}, want, "one axis");
  EXPECT_EQ(ran.kinds(Severity::warning), std::vector<std::string>{"control_setting"});
}

// ---- arcs ------------------------------------------------------------------------------------

/// Points of a canonical arc from `start`, at equal parts of its angle.
std::vector<Vec3> points_of(const canon::ArcFeed& arc, const Vec3& start, int count) {
  const Vec3 n = arc.normal;
  const Vec3 end(arc.end[Axis::x], arc.end[Axis::y], arc.end[Axis::z]);
  const auto flat = [&](const Vec3& p) { return Vec3(p - arc.centre - n * n.dot(p - arc.centre)); };
  const Vec3 u = flat(start), w = flat(end);
  double sweep = std::atan2(n.dot(u.cross(w)), u.dot(w));
  if (arc.turns > 0 && sweep <= 1e-9) sweep += 2 * std::numbers::pi;
  if (arc.turns < 0 && sweep >= -1e-9) sweep -= 2 * std::numbers::pi;
  const double rise = n.dot(end - start);
  std::vector<Vec3> points;
  for (int i = 0; i <= count; ++i) {
    const double part = static_cast<double>(i) / count;
    points.push_back(arc.centre + n * n.dot(start - arc.centre) + n * rise * part +
                     Eigen::AngleAxisd(sweep * part, n) * u);
  }
  return points;
}

struct ArcCase {
  const char* plane;
  const char* arc;
};

/// The arc of the program's last G2 or G3 as points.
std::vector<Vec3> arc_points(const std::string& frame, const ArcCase& c) {
  const Ran ran =
      run(std::string(c.plane) + "\n" + frame + "G0 X3. Y-2. Z4.\n" + c.arc + " F100\nM30\n");
  Vec3 at = Vec3::Zero();
  for (const canon::Command& command : ran.commands) {
    if (const auto* arc = std::get_if<canon::ArcFeed>(&command.action))
      return points_of(*arc, at, 24);
    if (const auto* rapid = std::get_if<canon::Rapid>(&command.action))
      at = {rapid->end[Axis::x], rapid->end[Axis::y], rapid->end[Axis::z]};
  }
  ADD_FAILURE() << "no arc";
  return {};
}

TEST(Frames, MapEveryPointOfAnArc) {
  const ArcCase cases[] = {{"G17", "G2 X13. Y-2. I5. J0"}, {"G17", "G3 X13. Y-2. Z9. R8."},
                           {"G17", "G3 I5. J3."},          {"G18", "G2 X3. Z14. I0 K5."},
                           {"G18", "G3 X8. Z9. R-6."},     {"G19", "G3 Y-2. Z14. J0 K5."},
                           {"G19", "G2 X1. Y3. Z9. R5."}};
  struct FrameCase {
    std::string text;
    Mat4 map;
    int plane;  ///< normal axis, -1: any
  };
  const FrameCase frames[] = {
      {"G51.1 X2.\n", about({2, 0, 0}, stretched(-1, 1, 1)), -1},
      {"G51.1 Y2.\n", about({0, 2, 0}, stretched(1, -1, 1)), -1},
      {"G51.1 Z-2.\n", about({0, 0, -2}, stretched(1, 1, -1)), -1},
      {"G51.1 X1. Y2.\n", about({1, 2, 0}, stretched(-1, -1, 1)), -1},
      {"G51 X1. Y2. Z3. P2.5\n", about({1, 2, 3}, stretched(2.5, 2.5, 2.5)), -1},
      {"G51 X1. Y2. Z3. I-1. J1. K1.\n", about({1, 2, 3}, stretched(-1, 1, 1)), -1},
      {"G68 X1. Y2. R30.\n", about({1, 2, 0}, turned(2, 30)), 2},
      {"G68 X1. Z2. R-130.\n", about({1, 0, 2}, turned(1, -130)), 1},
      {"G68 Y1. Z2. R77.\n", about({0, 1, 2}, turned(0, 77)), 0},
      {"G51.1 Y1.\nG68 X1. Y2. R30.\n",
       about(Vec3(1, 0, 0), turned(2, -30)) * about({0, 1, 0}, stretched(1, -1, 1)), 2},
  };
  for (const ArcCase& c : cases)
    for (const FrameCase& f : frames) {
      const int normal = c.plane[2] == '7' ? 2 : c.plane[2] == '8' ? 1 : 0;
      if (f.plane >= 0 && f.plane != normal) continue;
      const auto plain = arc_points("", c), framed = arc_points(f.text, c);
      ASSERT_EQ(plain.size(), framed.size());
      for (std::size_t i = 0; i < plain.size(); ++i)
        expect_near(framed[i], mapped(f.map, plain[i]), f.text + c.arc);
    }
}

// ---- radius compensation ---------------------------------------------------------------------

std::vector<Vec3> ends_of(const std::string& program) {
  std::vector<Vec3> ends;
  AxisValues tip;
  for (const canon::Command& command : run(program).commands) {
    if (!canon::is_motion(command.action)) continue;
    tip = canon::end_of(command.action, tip);
    ends.push_back({tip[Axis::x], tip[Axis::y], tip[Axis::z]});
  }
  return ends;
}

std::string contour(const std::string& frame, double f, const char* end) {
  const auto n = [&](double value) { return number(f * value); };
  return frame + "G0 X" + n(-20) + " Y" + n(-20) + "\nG1 G41 D1 X" + n(-10) + " Y0 F100\nY" +
         n(10) + "\nG2 X" + n(0) + " Y" + n(20) + " I" + n(10) + " J0\nG1 X" + n(15) + "\nX" +
         n(25) + " Y" + n(30) + "\nG40 X" + n(40) + " Y" + n(40) + "\n" + end + "M30\n";
}

TEST(Frames, MirrorAndRotationTurnTheCompensatedPathAsAWhole) {
  const auto plain = ends_of(contour("", 1, ""));
  ASSERT_GT(plain.size(), 6u);
  const std::pair<const char*, Mat4> frames[] = {
      {"G51.1 X5.\n", about({5, 0, 0}, stretched(-1, 1, 1))},
      {"G51.1 X5. Y1.\n", about({5, 1, 0}, stretched(-1, -1, 1))},
      {"G68 X3. Y4. R25.\n", about({3, 4, 0}, turned(2, 25))}};
  for (const auto& [text, map] : frames) {
    const auto framed = ends_of(contour(text, 1, ""));
    ASSERT_EQ(framed.size(), plain.size()) << text;
    for (std::size_t i = 0; i < plain.size(); ++i)
      expect_near(framed[i], mapped(map, plain[i]), text);
  }
}

TEST(Frames, ScalingLeavesTheToolsRadiusAsItIs) {
  const auto by_hand = ends_of(contour("", 2, ""));
  const auto scaled = ends_of(contour("G51 X0 Y0 Z0 P2.\n", 1, ""));
  ASSERT_EQ(scaled.size(), by_hand.size());
  for (std::size_t i = 0; i < by_hand.size(); ++i) expect_near(scaled[i], by_hand[i], "scaled");
}

}  // namespace
}  // namespace aircut::test
