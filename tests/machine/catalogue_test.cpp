// The catalogue of machines: every type comes back from a hundred thousand poses, its joints keep
// the lengths that its parts have (measured here, from the geometry alone), and it says by how much
// a pose misses.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "samples.h"

namespace aircut::machine {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double deg = pi / 180;

TEST(Catalogue, ComesBackFromAHundredThousandPoses) {
  for (const Sample& sample : catalogue()) {
    SCOPED_TRACE(sample.name);
    Random random(71);
    const int poses = sample.kinematics->type() == "serial" ? 20000 : 100000;
    const JointVector start = sample.start();
    for (int i = 0; i < poses; ++i) {
      const AxisValues tip = random_tip(sample, random);
      const auto q = sample.kinematics->inverse({tip, {}}, start);
      ASSERT_TRUE(q) << q.error().reason;
      const auto back = sample.kinematics->forward(*q, {});
      ASSERT_TRUE(back) << back.error().reason;
      for (const Axis axis : all_axes)
        if (sample.kinematics->axes().has(axis)) {
          ASSERT_NEAR((*back)[axis], tip[axis], 2e-9) << letter(axis);
        }
    }
  }
}

// Joints, not poses, at random: what can be assembled has a pose that leads back to them.
TEST(Catalogue, ComesBackFromJointsThatCanBeAssembled) {
  for (const Sample& sample : catalogue()) {
    if (!sample.bounded) continue;  // other turns and branches are as good
    SCOPED_TRACE(sample.name);
    Random random(72);
    int assembled = 0;
    for (int i = 0; i < 3000; ++i) {
      JointVector q = *sample.kinematics->inverse({random_tip(sample, random), {}}, sample.start());
      for (Eigen::Index j = 0; j < q.size(); ++j) q[j] *= 1 + random.between(-0.02, 0.02);
      sample.kinematics->couple(q);
      const auto tip = sample.kinematics->forward(q, {});
      if (!tip) continue;
      const auto back = sample.kinematics->inverse({*tip, {}}, q);
      if (!back) continue;  // beyond a reach that only the inverse looks at
      ++assembled;
      ASSERT_LE((*back - q).cwiseAbs().maxCoeff(), 1e-6) << q.transpose();
    }
    EXPECT_GT(assembled, 2500);
  }
}

Mat3 turned(const AxisValues& tip) {
  return (Eigen::AngleAxisd(tip[Axis::c], Vec3::UnitZ()) *
          Eigen::AngleAxisd(tip[Axis::b], Vec3::UnitY()) *
          Eigen::AngleAxisd(tip[Axis::a], Vec3::UnitX()))
      .toRotationMatrix();
}

Vec3 place(const AxisValues& tip) { return {tip[Axis::x], tip[Axis::y], tip[Axis::z]}; }

Vec3 on_circle(double radius, double degrees) {
  return radius * Vec3(std::cos(degrees * deg), std::sin(degrees * deg), 0);
}

const Sample& sample_of(const std::vector<Sample>& all, const std::string& name) {
  for (const Sample& sample : all)
    if (sample.name == name) return sample;
  ADD_FAILURE() << name;
  return all.front();
}

// For every type the lengths that its joints must keep: measured at random poses.
template <class Misses>
void expect_lengths(const std::string& name, Misses&& misses) {
  const auto all = catalogue();
  const Sample& sample = sample_of(all, name);
  Random random(73);
  for (int i = 0; i < 1000; ++i) {
    const AxisValues tip = random_tip(sample, random);
    const auto q = sample.kinematics->inverse({tip, {}}, sample.start());
    ASSERT_TRUE(q) << name << ": " << q.error().reason;
    ASSERT_NEAR(misses(tip, *q), 0, 1e-9) << name;
  }
}

TEST(Catalogue, KeepsTheLengthsOfRodsAndLinks) {
  expect_lengths("delta-linear", [](const AxisValues& tip, const JointVector& q) {
    double most = 0;
    for (int i = 0; i < 3; ++i) {
      const Vec3 slider = on_circle(130.25, 90 + 120 * i) + Vec3(0, 0, q[i]);
      EXPECT_GT(slider.z(), tip[Axis::z]);
      most = std::max(most, std::abs((slider - place(tip)).norm() - 269));
    }
    return most;
  });
  expect_lengths("delta-rotary", [](const AxisValues& tip, const JointVector& q) {
    double most = 0;
    for (int i = 0; i < 3; ++i) {
      const double azimuth = -90 + 120 * i;
      const Vec3 knee =
          on_circle(254 + 254 * std::cos(q[i]), azimuth) - Vec3(0, 0, 254 * std::sin(q[i]));
      const Vec3 foot = place(tip) + on_circle(152.4, azimuth);
      most = std::max(most, std::abs((knee - foot).norm() - 355.6));
    }
    return most;
  });
  expect_lengths("tripod", [](const AxisValues& tip, const JointVector& q) {
    const Vec3 p = place(tip);
    return std::abs(p.norm() - q[0]) + std::abs((p - Vec3(1000, 0, 0)).norm() - q[1]) +
           std::abs((p - Vec3(500, 900, 0)).norm() - q[2]);
  });
  expect_lengths("triglide", [](const AxisValues& tip, const JointVector& q) {
    const std::array<Vec3, 3> joints = {Vec3(-40, -50, 0), Vec3(40, 0, 0), Vec3(-40, 50, 0)};
    double most = 0;
    for (int i = 0; i < 3; ++i) {
      const Vec3 slider(q[i], -250 + 250 * i, 0);
      most = std::max(
          most, std::abs((slider - place(tip) - joints[static_cast<std::size_t>(i)]).norm() - 500));
    }
    return most;
  });
  for (const char* name : {"hexapod", "hexaglide"})
    expect_lengths(name, [&](const AxisValues& tip, const JointVector& q) {
      double most = 0;
      for (int i = 0; i < 6; ++i) {
        const double middle = 120 * (i / 2), side = i % 2 ? 1 : -1;
        const Vec3 base = on_circle(400, middle + 15 * side);
        const Vec3 joint = place(tip) + turned(tip) * on_circle(160, middle + 45 * side);
        const bool slides = std::string(name) == "hexaglide";
        const Vec3 end = slides ? Vec3(base + Vec3(0, 0, q[i])) : base;
        most = std::max(most, std::abs((joint - end).norm() - (slides ? 500 : q[i])));
      }
      return most;
    });
  expect_lengths("pentapod", [](const AxisValues& tip, const JointVector& q) {
    constexpr std::array<double, 5> z = {1000, 300, 1000, 300, 1000};
    constexpr std::array<double, 5> height = {400, 100, 400, 100, 400};
    const Mat3 R = (Eigen::AngleAxisd(tip[Axis::b], Vec3::UnitY()) *
                    Eigen::AngleAxisd(tip[Axis::a], Vec3::UnitX()))
                       .toRotationMatrix();
    double most = 0;
    for (int i = 0; i < 5; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const Vec3 base = on_circle(900, 18 + 72 * i) + Vec3(0, 0, z[k]);
      // The ring's joint: at its height on the spindle, 80 mm towards the base point.
      const Vec3 axis = R.col(2), centre = place(tip) + height[k] * axis;
      const Vec3 out = (base - centre) - axis.dot(base - centre) * axis;
      most = std::max(most, std::abs((base - centre - 80 * out.normalized()).norm() - q[i]));
    }
    return most;
  });
  expect_lengths("plotter", [](const AxisValues& tip, const JointVector& q) {
    return std::abs(std::hypot(tip[Axis::x], tip[Axis::y]) - q[0]) +
           std::abs(std::hypot(tip[Axis::x] - 1000, tip[Axis::y]) - q[1]);
  });
  expect_lengths("biglide", [](const AxisValues& tip, const JointVector& q) {
    EXPECT_LT(q[0], tip[Axis::x]);
    return std::abs(std::hypot(tip[Axis::x] - 60 - q[0], tip[Axis::z]) - 400) +
           std::abs(std::hypot(tip[Axis::x] + 60 - q[1], tip[Axis::z]) - 400) +
           std::abs(q[2] - tip[Axis::y]);
  });
  expect_lengths("five-bar", [](const AxisValues& tip, const JointVector& q) {
    double most = 0;
    for (int i = 0; i < 2; ++i) {
      const Vec3 elbow = Vec3(i ? 100 : -100, 0, 0) + on_circle(250, q[i] / deg);
      EXPECT_GT((elbow.x() - tip[Axis::x]) * (i ? 1 : -1), 0);
      const Vec3 flat(tip[Axis::x], tip[Axis::y], 0);
      most = std::max(most, std::abs((elbow - flat).norm() - 300));
    }
    return most;
  });
  expect_lengths("scara", [](const AxisValues& tip, const JointVector& q) {
    const Vec3 p = on_circle(340, q[0] / deg) + on_circle(250, (q[0] + q[1]) / deg) +
                   on_circle(50, tip[Axis::c] / deg) + Vec3(0, 0, 490 + 50 - q[2] - 50);
    return (p - place(tip)).norm() + std::abs(q[0] + q[1] + q[3] - tip[Axis::c]);
  });
  expect_lengths("scorbot", [](const AxisValues& tip, const JointVector& q) {
    const double r = 16 + 221 * std::cos(q[1]) + 221 * std::cos(q[2]);
    const Vec3 p =
        on_circle(r, q[0] / deg) + Vec3(0, 0, 140 + 221 * std::sin(q[1]) + 221 * std::sin(q[2]));
    return (p - place(tip)).norm();
  });
}

// The tip and the last two axes of the classical six-axis arm, as textbooks print them.
TEST(Catalogue, PumaAgreesWithTheTextbookFormula) {
  const auto puma = of_type("puma");
  Random random(74);
  const double a2 = 300, a3 = 50, d3 = 70, d4 = 400, d6 = 70;
  for (int i = 0; i < 1000; ++i) {
    JointVector q(6);
    for (int j = 0; j < 6; ++j) q[j] = random.between(-3, 3);
    const auto c = [&](double angle) { return std::cos(angle); };
    const auto s = [&](double angle) { return std::sin(angle); };
    const double t23 = q[1] + q[2], c4 = c(q[3]), s4 = s(q[3]), c5 = c(q[4]), s5 = s(q[4]);
    const double reach = a2 * c(q[1]) + a3 * c(t23) - d4 * s(t23);
    const Vec3 wrist(c(q[0]) * reach - d3 * s(q[0]), s(q[0]) * reach + d3 * c(q[0]),
                     -a3 * s(t23) - a2 * s(q[1]) - d4 * c(t23));
    const double in_plane = c(t23) * c4 * s5 + s(t23) * c5;
    const Vec3 out(-c(q[0]) * in_plane - s(q[0]) * s4 * s5, -s(q[0]) * in_plane + c(q[0]) * s4 * s5,
                   s(t23) * c4 * s5 - c(t23) * c5);
    const auto tip = puma->forward(q, {});
    ASSERT_TRUE(tip);
    ASSERT_LE((place(*tip) - wrist - d6 * out).norm(), 1e-9);
    ASSERT_LE((turned(*tip).col(2) - out).norm(), 1e-12);
    ASSERT_LE((*puma->tool_axis(*tip) + out).norm(), 1e-12);
  }
}

// The same arm by its Denavit-Hartenberg rows, with the flange's length in the tool.
TEST(Catalogue, SerialIsTheSameArmAsPuma) {
  const auto puma = of_type("puma");
  const auto serial = of_type("serial", {"tool = [0, 0, 70, 0, 0, 0]"});
  Random random(75);
  for (int i = 0; i < 1000; ++i) {
    JointVector q(6);
    for (int j = 0; j < 6; ++j) q[j] = random.between(-3, 3);
    const auto a = puma->forward(q, {}), b = serial->forward(q, {});
    ASSERT_TRUE(a && b);
    ASSERT_LE((place(*a) - place(*b)).norm(), 1e-9);
    // One gives the flange's z, the other the tool's direction: R is Rx·Ry·Rz there.
    const double x = (*b)[Axis::a], y = (*b)[Axis::b];
    ASSERT_LE((turned(*a).col(2) -
               Vec3(std::sin(y), -std::sin(x) * std::cos(y), std::cos(x) * std::cos(y)))
                  .norm(),
              1e-12);
  }
}

TEST(Catalogue, SerialReadsStandardRowsToo) {
  // A planar arm of two links and a turn: closed form by hand.
  const auto arm = of_type("serial", {"dh = [[0, 0, 300, 0], [30, 0, 200, 0], [0, 50, 0, 0]]",
                                      "convention = \"standard\"", "tool = [0, 0, 0, 0, 0, 0]"});
  const auto tip = arm->forward(joint_values({0.3, 0.4, 0.9}), {});
  ASSERT_TRUE(tip);
  const Vec3 wanted = on_circle(300, 0.3 / deg) + on_circle(200, 0.7 / deg + 30) + Vec3(0, 0, 50);
  EXPECT_LE((place(*tip) - wanted).norm(), 1e-9);
}

// e.2's closed forms of tool directions.
TEST(Catalogue, PresetsPointTheToolAsTheirNamesSay) {
  Random random(76);
  for (int i = 0; i < 200; ++i) {
    const double first = random.between(-3, 3), second = random.between(-3, 3);
    const double c1 = std::cos(first), s1 = std::sin(first), c2 = std::cos(second),
                 s2 = std::sin(second);
    const auto expect = [&](const char* type, Axis a, Axis b, const Vec3& k) {
      AxisValues tip;
      tip[a] = first;
      tip[b] = second;
      const auto axis = of_type(type)->tool_axis(tip);
      ASSERT_TRUE(axis) << type;
      ASSERT_LE((*axis - k).norm(), 1e-12) << type;
    };
    expect("table-ac", Axis::a, Axis::c, {s2 * s1, -c2 * s1, c1});
    expect("table-bc", Axis::b, Axis::c, {c2 * s1, s2 * s1, c1});
    expect("table-ab", Axis::a, Axis::b, {s2 * c1, -s1, c2 * c1});
    expect("head-ab", Axis::a, Axis::b, {s2, -s1 * c2, c1 * c2});
    expect("head-ca", Axis::c, Axis::a, {s1 * s2, -c1 * s2, c2});
    expect("head-cb", Axis::c, Axis::b, {c1 * s2, s1 * s2, c2});
    expect("head-b-table-c", Axis::c, Axis::b, {c1 * s2, s1 * s2, c2});
  }
}

nlohmann::json vectors(const std::string& name) {
  std::ifstream file(std::string(AIRCUT_SOURCE_DIR) + "/tests/data/" + name + ".json");
  return nlohmann::json::parse(file);
}

TEST(Catalogue, LatheVerticalGivesTheNumbersOfTheVectors) {
  const auto file = vectors("lathe_vertical");
  ASSERT_EQ(file.at("vectors").size(), 10u);
  for (const auto& v : file.at("vectors")) {
    std::vector<std::string> parameters;
    for (const auto& [key, value] : v.at("parameters").items())
      parameters.push_back(key + " = " + value.dump());
    const auto lathe = of_type("lathe-vertical", parameters);
    const auto& joints = v.at("joints");
    const JointVector q =
        joint_values({joints.at("X"), joints.at("Z"), joints.at("C").get<double>() * deg});
    const auto& pose = v.at("pose");
    const AxisValues wanted = axis_values(pose.at("x"), pose.at("y"), pose.at("z"));
    const auto tip = lathe->forward(q, {});
    ASSERT_TRUE(tip);
    EXPECT_LE((place(*tip) - place(wanted)).cwiseAbs().maxCoeff(), 1e-6) << v;
    const auto back = lathe->inverse({wanted, {}}, q);
    ASSERT_TRUE(back) << back.error().reason;
    EXPECT_NEAR((*back)[0], q[0], 1e-6) << v;
    EXPECT_NEAR((*back)[1], q[1], 1e-6) << v;
    EXPECT_NEAR((*back)[2], q[2], 1e-6 * deg) << v;
  }
}

// Constant speeds of X, Z and C draw helices and spirals on the work; with the tool on the slide's
// plane their closed forms are in the vectors.
TEST(Catalogue, LatheVerticalDrawsTheCurvesOfConstantSpeeds) {
  const auto lathe = of_type("lathe-vertical");
  const auto file = vectors("lathe_vertical");
  ASSERT_EQ(file.at("generated_curves").size(), 9u);
  const double zero_x = 420 - 55, zero_z = 900 + 250 - 140 - 350 - 60;  // X, Z 0 on the work
  for (const auto& v : file.at("generated_curves")) {
    const auto joints_at = [&](double t) {
      return joint_values({v.at("r0").get<double>() + v.at("w_x").get<double>() * t - zero_x,
                           v.at("z0").get<double>() + v.at("w_z").get<double>() * t - zero_z,
                           v.at("omega_rad_s").get<double>() * t});
    };
    const double t = v.at("t"), h = 1e-4;
    const auto tip = lathe->forward(joints_at(t), {});
    const auto before = lathe->forward(joints_at(t - h), {}),
               after = lathe->forward(joints_at(t + h), {});
    ASSERT_TRUE(tip && before && after);
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(place(*tip)[i], v.at("point")[static_cast<std::size_t>(i)].get<double>(), 1e-6)
          << v;
    EXPECT_NEAR((place(*after) - place(*before)).norm() / (2 * h), v.at("speed").get<double>(),
                1e-5)
        << v;
  }
}

TEST(Catalogue, KeepsTheBranchInWhichItIs) {
  const auto all = catalogue();
  const Sample& scara = sample_of(all, "scara");
  const AxisValues tip = axis_values(300, 200, 100, 0, 0, 0.5);
  for (const double elbow : {1.0, -1.0}) {
    const auto q = scara.kinematics->inverse({tip, {}}, joint_values({0, elbow, 0, 0}));
    ASSERT_TRUE(q);
    EXPECT_GT((*q)[1] * elbow, 0);
  }
  // Angles stay in the turn in which they are.
  const auto polar = of_type("polar");
  const auto q = polar->inverse({axis_values(0, 100, 0), {}}, joint_values({0, 0, 13}));
  ASSERT_TRUE(q);
  EXPECT_NEAR((*q)[2], pi / 2 + 4 * pi, 1e-12);
}

std::string why(const std::string& type, const AxisValues& tip,
                const std::vector<std::string>& parameters = {}) {
  const auto kinematics = of_type(type, parameters);
  const auto q = kinematics->inverse({tip, {}}, JointVector::Zero(kinematics->joint_count()));
  return q ? "reached" : q.error().reason;
}

TEST(Catalogue, SaysByHowMuchAPoseMisses) {
  EXPECT_EQ(why("delta-linear", axis_values(400, 0, 0)).substr(0, 8), "rod 1 is");
  EXPECT_EQ(why("scara", axis_values(700, 0, 0)),
            "the quill is 60.000 mm beyond the reach of the arm, 590.000 mm");
  EXPECT_EQ(why("polar", axis_values(0, 0, 0)),
            "the tip is 0.000 mm from the table's centre, where the table can turn freely (a "
            "singular pose)");
  EXPECT_EQ(why("scorbot", axis_values(500, 0, 140)),
            "the wrist is 42.000 mm beyond the reach of the arm, 442.000 mm");
  EXPECT_EQ(why("five-bar", axis_values(0, 600, 0)).substr(0, 8), "arm 1 is");
  EXPECT_NE(why("five-bar", axis_values(0, -300, 0)).find("behind the line of the motors"),
            std::string::npos);
  EXPECT_NE(why("plotter", axis_values(500, 10, 0)).find("not below"), std::string::npos);
  EXPECT_NE(why("tripod", axis_values(400, 300, -5)).find("fall to the other side"),
            std::string::npos);
  EXPECT_NE(why("delta-rotary", axis_values(0, 0, -900)).find("too short"), std::string::npos);
  EXPECT_NE(why("hexaglide", axis_values(500, 0, -400)).find("mm too short"), std::string::npos);
  EXPECT_NE(why("serial", axis_values(2000, 0, 0)).find("mm away"), std::string::npos);
  EXPECT_NE(why("puma", axis_values(2000, 0, 0)).find("beyond the reach"), std::string::npos);
  EXPECT_EQ(why("delta-linear", axis_values(std::nan(""), 0, 0)), "the pose is no number");
}

TEST(Catalogue, SaysWhyJointsAreNoPosition) {
  const auto fail = [](const std::string& type, std::initializer_list<double> q) {
    const auto tip = of_type(type)->forward(joint_values(q), {});
    return tip ? "assembled" : tip.error().reason;
  };
  EXPECT_NE(fail("gantry", {100, 102, 0, 0}).find("skewed by -0.1146 degrees"), std::string::npos)
      << fail("gantry", {100, 102, 0, 0});
  EXPECT_EQ(fail("gantry", {100, 100.2, 0, 0}), "assembled");
  EXPECT_NE(fail("tripod", {100, 100, 100}).find("don't meet"), std::string::npos);
  EXPECT_NE(fail("plotter", {100, 100, 0}).find("1000.000 mm apart"), std::string::npos);
  EXPECT_NE(fail("hexapod", {100, 100, 100, 100, 100, 5000}).find("rods"), std::string::npos);
  EXPECT_NE(fail("polar", {-5, 0, 0}).find("behind the table's centre"), std::string::npos);
  EXPECT_NE(fail("five-bar", {3, 0, 0}).find("don't meet"), std::string::npos);
}

TEST(BareMachine, SaysWhatItDoesNotUnderstand) {
  const auto fail = [](const std::string& type, const std::vector<std::string>& parameters) {
    SourceMap sources;
    Diagnostics out;
    EXPECT_FALSE(bare_machine(type, parameters, sources, out)) << type;
    std::string text;
    for (const Diagnostic& d : out.list()) text += d.message + "\n";
    return text;
  };
  EXPECT_NE(fail("hexpod", {}).find("Did you mean 'hexapod'?"), std::string::npos);
  EXPECT_NE(fail("chain", {}).find("-m"), std::string::npos);
  EXPECT_NE(fail("delta-linear", {"radus = 3"}).find("radius"), std::string::npos);
  EXPECT_NE(fail("delta-linear", {"rod = -3"}).find("must be more than 0"), std::string::npos);
  EXPECT_NE(fail("tripod", {"cy = 0"}).find("in one line"), std::string::npos);
  EXPECT_NE(fail("hexapod", {"base = [[0, 0, 0]]"}).find("needs 6 points"), std::string::npos);
  EXPECT_NE(fail("hexapod", {"start = [0, 0, 0]"}).find("don't hold it"), std::string::npos);
  EXPECT_NE(fail("serial", {"dh = [[0, 0, 0, 0], [0, 0, 300, 0], [0, 0, 200, 0]]"})
                .find("'convention' is missing"),
            std::string::npos);
  EXPECT_NE(fail("calibrated", {"matrix = [1, 0, 0, 1, 0, 0, 0, 0, 1]"}).find("determinant 0"),
            std::string::npos);
  EXPECT_FALSE(fail("scara", {"l1 = \"long\""}).empty());
  EXPECT_FALSE(fail("scara", {"]["}).empty());
}

}  // namespace
}  // namespace aircut::machine
