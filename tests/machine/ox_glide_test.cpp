// Numbers of the O-X glide: the published positions, areas and limits (kinematics.md b).
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "samples.h"

namespace aircut::machine {
namespace {

nlohmann::json vectors(const std::string& form) {
  std::ifstream file(std::string(AIRCUT_SOURCE_DIR) + "/tests/data/ox_glide_" + form + ".json");
  return nlohmann::json::parse(file);
}

OxGlide parameters(const nlohmann::json& file) {
  const auto& p = file.at("parameters");
  OxGlide glide;
  glide.form = file.at("form") == "crossed" ? OxGlide::Form::crossed : OxGlide::Form::extended;
  glide.l1 = p.at("l1");
  glide.l2 = p.at("l2");
  glide.p1 = p.at("p1");
  glide.p2 = p.at("p2");
  glide.d = p.at("d");
  return glide;
}

AxisValues tip_of(const nlohmann::json& pose) {
  return axis_values(pose.at("x"), pose.at("y"), pose.at("z"));
}

const JointVector zero = JointVector::Zero(3);

JointVector joints3(double s1, double s2, double s3) {
  JointVector joints(3);
  joints << s1, s2, s3;
  return joints;
}

TEST(OxGlide, GivesTheSlidersOfTheVectors) {
  for (const char* form : {"crossed", "extended"}) {
    const auto file = vectors(form);
    const auto glide = make_ox_glide(parameters(file));
    ASSERT_EQ(file.at("vectors").size(), 10u);
    for (const auto& v : file.at("vectors")) {
      const auto joints = glide->inverse({tip_of(v.at("pose")), {}}, zero);
      ASSERT_TRUE(joints) << v << joints.error().reason;
      const auto& q = v.at("joints");
      const JointVector wanted = joints3(q.at("s1"), q.at("s2"), q.at("s3"));
      EXPECT_LE((*joints - wanted).cwiseAbs().maxCoeff(), 1e-6) << v;
      const auto tip = glide->forward(wanted, {});
      ASSERT_TRUE(tip) << v << tip.error().reason;
      for (const Axis axis : {Axis::x, Axis::y, Axis::z})
        EXPECT_NEAR((*tip)[axis], tip_of(v.at("pose"))[axis], 1e-6) << v;
    }
  }
}

TEST(OxGlide, GivesTheJacobianOfTheVectors) {
  for (const char* form : {"crossed", "extended"}) {
    const auto file = vectors(form);
    const auto glide = make_ox_glide(parameters(file));
    for (const auto& v : file.at("vectors"))
      for (const int column : {0, 1}) {
        const AxisValues d = column == 0 ? axis_values(1, 0, 0) : axis_values(0, 0, 1);
        JointVector dq, ddq;
        ASSERT_TRUE(glide->rates({tip_of(v.at("pose")), {}}, zero, d, {}, dq, ddq));
        for (const int row : {0, 1})
          EXPECT_NEAR(dq[row], v.at("jacobian_ds_dxz")[row][column].get<double>(), 1e-6) << v;
      }
  }
}

TEST(OxGlide, KnowsWhichPosesAreInTheWorkspace) {
  for (const char* form : {"crossed", "extended"}) {
    const auto file = vectors(form);
    const auto glide = make_ox_glide(parameters(file));
    const double low = file.at("parameters").at("smin"), high = file.at("parameters").at("smax");
    ASSERT_EQ(file.at("membership").size(), 3u);
    for (const auto& m : file.at("membership")) {
      const auto joints = glide->inverse({tip_of(m.at("pose")), {}}, zero);
      EXPECT_EQ(joints.has_value(), m.at("reachable").get<bool>()) << m;
      bool inside = joints.has_value();
      for (const int i : {0, 1}) inside = inside && (*joints)[i] >= low && (*joints)[i] <= high;
      EXPECT_EQ(inside, m.at("in_workspace").get<bool>()) << m;
      if (!joints) continue;
      for (const int i : {0, 1, 2})
        EXPECT_NEAR((*joints)[i], m.at("joints")[static_cast<std::size_t>(i)].get<double>(), 1e-6);
    }
  }
}

// Area of the workspace in the X-Z plane by counting cells of 1 mm.
double area(const Kinematics& glide) {
  int cells = 0;
  for (int x = 0; x < 600; ++x)
    for (int z = -380; z < -74; ++z) {
      const auto q = glide.inverse({axis_values(x + 0.5, 0, z + 0.5), {}}, zero);
      if (q && (*q)[0] >= 0 && (*q)[0] <= 500 && (*q)[1] >= 0 && (*q)[1] <= 500) ++cells;
    }
  return cells;
}

TEST(OxGlide, HasThePublishedAreas) {
  OxGlide glide;
  EXPECT_NEAR(area(*make_ox_glide(glide)), 27730, 60);
  glide.form = OxGlide::Form::extended;
  EXPECT_NEAR(area(*make_ox_glide(glide)), 4590, 30);
}

TEST(OxGlide, SaysWhichRodDoesNotReachAndByHowMuch) {
  const auto glide = make_ox_glide({});
  const auto at = [&](double z) { return glide->inverse({axis_values(250, 0, z), {}}, zero); };
  ASSERT_FALSE(at(-361.2));
  EXPECT_EQ(at(-361.2).error().reason,
            "rod 2 is 3.200 mm too short for Z -361.200; it reaches down to Z -358.000");
  EXPECT_TRUE(at(-358));  // rod 2 vertical: the limit itself is reached
  ASSERT_FALSE(at(-74));
  EXPECT_EQ(at(-74).error().reason,
            "Z -74.000 lifts the platform to the guides; it must stay below Z -74.000");
  EXPECT_FALSE(at(std::nan("")));
  // A tool of 50 mm reaches 50 mm deeper.
  const Target with_50 = with_tool(axis_values(250, 0, -358.5), 50);
  ASSERT_FALSE(glide->inverse(with_50, zero));
  EXPECT_EQ(glide->inverse(with_50, zero).error().reason,
            "rod 2 is 0.500 mm too short for Z -408.500; it reaches down to Z -408.000");
}

TEST(OxGlide, SaysWhySlidersAreNoPosition) {
  const auto crossed = make_ox_glide({});
  EXPECT_EQ(crossed->forward(joints3(500, -400, 0), {}).error().reason,
            "the rods don't meet: sliders at 500 and -400 are too far apart");
  // The mirror order of the sliders belongs to the extended form.
  EXPECT_EQ(crossed->forward(joints3(61.722, 420.181, 0), {}).error().reason,
            "sliders at 61.722 and 420.181 are not in the crossed form");
  // S1 = S2: the platform hangs beside both sliders.
  EXPECT_FALSE(crossed->forward(joints3(100, 220, 0), {}));
}

TEST(OxGlide, RodsAndPlatformAreDrawnWhereTheyAre) {
  for (const Sample& sample : samples()) {
    if (sample.kinematics->type() != "ox-glide") continue;
    if (sample.name == "ox-glide with offset") continue;
    Random random(5);
    for (int i = 0; i < 1000; ++i) {
      const AxisValues tip = random_tip(sample, random);
      const JointVector s = *sample.kinematics->inverse({tip, {}}, zero);
      std::array<double, 4> passive{};
      sample.kinematics->passive(s, passive);
      // The rod hangs from the slider; turned by its angle about +Y its end is at the platform.
      const auto end_of = [](double slider, double guide, double length, double angle) -> Vec3 {
        return Vec3(slider, 0, guide) +
               Eigen::AngleAxisd(angle, Vec3::UnitY()) * Vec3(0, 0, -length);
      };
      const Vec3 end1 = end_of(s[0], -74, 302, passive[0]);
      const Vec3 end2 = end_of(s[1], 74, 432, passive[1]);
      ASSERT_LE((end1 - Vec3(tip[Axis::x] - 55, 0, tip[Axis::z])).norm(), 1e-9);
      ASSERT_LE((end2 - Vec3(tip[Axis::x] + 65, 0, tip[Axis::z])).norm(), 1e-9);
      ASSERT_NEAR(passive[2], tip[Axis::x], 1e-9);
      ASSERT_NEAR(passive[3], tip[Axis::z], 1e-9);
    }
  }
}

TEST(OxGlide, HasNoRatesAndNoBoundWhereARodIsVertical) {
  const auto glide = make_ox_glide({});
  JointVector dq, ddq;
  EXPECT_FALSE(
      glide->rates({axis_values(250, 0, -358), {}}, zero, axis_values(0, 0, 1), {}, dq, ddq));
  EXPECT_TRUE(
      glide->rates({axis_values(250, 0, -357), {}}, zero, axis_values(0, 0, 1), {}, dq, ddq));
  std::array<double, 7> travel{};
  TipInterval interval{axis_values(250, 0, -358.1), axis_values(250, 0, -357), {}, {}};
  interval.travel[Axis::z] = 1.1;
  EXPECT_FALSE(glide->travel_bound(interval, travel));
  interval = {axis_values(250, 0, -100), axis_values(250, 0, -70), axis_values(0, 0, 30), {}};
  EXPECT_FALSE(glide->travel_bound(interval, travel));
}

}  // namespace
}  // namespace aircut::machine
