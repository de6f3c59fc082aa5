// Types of the catalogue in packages: the tree that draws the machine ends where the kinematics has
// it, rods included.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/random.h"
#include "machine/reading.h"

namespace aircut::machine {
namespace {

constexpr double deg = std::numbers::pi / 180;

std::string list(const Vec3& v) {
  return "[" + shortest(v.x()) + ", " + shortest(v.y()) + ", " + shortest(v.z()) + "]";
}

/// Writes a machine.toml: axes in order, the tool's link last.
class Toml {
 public:
  explicit Toml(const std::string& kinematics)
      : head_("schema = 1\nname = \"test\"\n[kinematics]\n" + kinematics + "\n") {}
  Toml& slide(const std::string& name, const std::string& parent, const Vec3& direction, double min,
              double max, double home, double sense = 1) {
    axis(name, "linear", parent, direction);
    text_ += "min = " + shortest(min) + "\nmax = " + shortest(max) + "\nhome = " + shortest(home) +
             "\nvmax = 100\namax = 1000\nsense = " + shortest(sense) + "\n";
    return *this;
  }
  Toml& turn(const std::string& name, const std::string& parent, const Vec3& origin,
             const Vec3& direction, double low, double high, double home = 0, double sense = 1) {
    axis(name, "rotary", parent, direction);
    text_ += "origin = " + list(origin) + "\nmin = " + shortest(low) + "\nmax = " + shortest(high) +
             "\nhome = " + shortest(home) +
             "\nvmax = 100\namax = 1000\nsense = " + shortest(sense) + "\n";
    return *this;
  }
  Toml& passive(const std::string& value, const std::string& parent, const Vec3& origin,
                const Vec3& direction) {
    axis(value, value.ends_with("_angle") ? "rotary" : "linear", parent, direction);
    text_ += "origin = " + list(origin) + "\npassive = \"" + value + "\"\nsense = 1\n";
    return *this;
  }
  /// platform_x, _y, _z and then the angles, one on the other.
  Toml& platform(const std::string& angles) {
    std::string parent = "bed";
    for (const char* axis_name : {"x", "y", "z"}) {
      const std::string value = std::string("platform_") + axis_name;
      passive(value, parent, Vec3::Zero(), Vec3::Unit(axis_name[0] - 'x'));
      parent = value;
    }
    for (const char c : angles) {
      const std::string value = std::string("platform_") + c + "_angle";
      passive(value, parent, Vec3::Zero(), Vec3::Unit(c - 'a'));
      parent = value;
    }
    spindle_ = parent;
    return *this;
  }
  Toml& spindle(const std::string& link, const Vec3& gauge, const std::string& more = "") {
    spindle_ = link;
    gauge_ = gauge;
    more_ = more;
    return *this;
  }
  Toml& work(const std::string& link) {
    head_ += "[work]\nlink = \"" + link + "\"\n";
    return *this;
  }
  std::shared_ptr<const Machine> read() const {
    SourceMap sources;
    const SourceText& text =
        sources.add("machine.toml", head_ + "[spindle]\nlink = \"" + spindle_ +
                                        "\"\ngauge = " + list(gauge_) + "\n" + more_ + text_);
    PackageFiles none;
    Diagnostics out;
    const auto machine = read_machine_text(text, ".", none, out);
    for (const Diagnostic& d : out.list()) ADD_FAILURE() << format_gcc(d) << head_;
    return machine ? *machine : nullptr;
  }

 private:
  void axis(const std::string& name, const std::string& kind, const std::string& parent,
            const Vec3& direction) {
    text_ += "[[axis]]\nname = \"" + name + "\"\nkind = \"" + kind + "\"\nparent = \"" + parent +
             "\"\nchild = \"" + name + "\"\ndirection = " + list(direction) + "\n";
  }
  std::string head_, text_, spindle_ = "bed", more_;
  Vec3 gauge_ = Vec3::Zero();
};

Vec3 on_circle(double radius, double degrees) {
  return radius * Vec3(std::cos(degrees * deg), std::sin(degrees * deg), 0);
}

Vec3 seen(const Machine& machine, const LinkPoses& poses, const std::string& link, const Vec3& p) {
  const auto id = machine.find_link(link);
  EXPECT_TRUE(id) << link;
  return poses.X_WL[static_cast<std::size_t>(index(*id))] * p;
}

JointVector anywhere(const Machine& machine, const JointVector& home, double share,
                     Random& random) {
  for (int tries = 0; tries < 1000; ++tries) {
    JointVector q = home;
    for (Eigen::Index j = 0; j < q.size(); ++j) q[j] += random.between(-share, share);
    if (machine.kinematics().forward(q, {})) return q;
  }
  ADD_FAILURE() << "nothing can be assembled";
  return home;
}

// The far end of each rod is at its joint on the platform.
TEST(TypePackages, DeltaLinearDrawsItsRods) {
  Toml toml("type = \"delta-linear\"");
  const double h = std::sqrt(269.0 * 269 - 130.25 * 130.25);
  for (int i = 0; i < 3; ++i)
    toml.slide("S" + std::to_string(i + 1), "bed", Vec3::UnitZ(), h - 150, h + 150, h);
  toml.platform("");
  for (int i = 1; i <= 3; ++i) {
    const std::string rod = "rod" + std::to_string(i);
    const Vec3 base = on_circle(130.25, 90 + 120 * (i - 1));
    toml.passive(rod + "_a_angle", "S" + std::to_string(i), base, Vec3::UnitX());
    toml.passive(rod + "_b_angle", rod + "_a_angle", base, Vec3::UnitY());
  }
  const auto machine = toml.read();
  ASSERT_TRUE(machine);
  Random random(101);
  LinkPoses poses;
  for (int n = 0; n < 200; ++n) {
    forward(*machine, anywhere(*machine, machine->home(), 60, random), poses);
    const Vec3 P = seen(*machine, poses, "platform_z", Vec3::Zero());
    for (int i = 1; i <= 3; ++i) {
      const Vec3 end = on_circle(130.25, 90 + 120 * (i - 1)) - Vec3(0, 0, 269);
      ASSERT_LE((seen(*machine, poses, "rod" + std::to_string(i) + "_b_angle", end) - P).norm(),
                1e-6);
    }
  }
}

TEST(TypePackages, HexapodDrawsItsStrutsAndItsPlatform) {
  Toml toml("type = \"hexapod\"");
  std::vector<Vec3> base, joint;
  for (int i = 0; i < 6; ++i) {
    const double middle = 120 * (i / 2), side = i % 2 ? 1 : -1;
    base.push_back(on_circle(400, middle + 15 * side));
    joint.push_back(on_circle(160, middle + 45 * side));
  }
  for (int i = 1; i <= 6; ++i) {
    const auto k = static_cast<std::size_t>(i - 1);
    const std::string number = std::to_string(i), rod = "rod" + number;
    const double home = (joint[k] + Vec3(0, 0, -600) - base[k]).norm();
    toml.slide("Q" + number, rod + "_b_angle", -Vec3::UnitZ(), home - 80, home + 80, home);
    toml.passive(rod + "_a_angle", "bed", base[k], Vec3::UnitX());
    toml.passive(rod + "_b_angle", rod + "_a_angle", base[k], Vec3::UnitY());
  }
  toml.platform("cba");
  const auto machine = toml.read();
  ASSERT_TRUE(machine);
  Random random(102);
  LinkPoses poses;
  for (int n = 0; n < 200; ++n) {
    forward(*machine, anywhere(*machine, machine->home(), 30, random), poses);
    for (int i = 0; i < 6; ++i) {
      const auto k = static_cast<std::size_t>(i);
      // With all joints at zero the strut's end is in its base point.
      ASSERT_LE((seen(*machine, poses, "Q" + std::to_string(i + 1), base[k]) -
                 seen(*machine, poses, "platform_a_angle", joint[k]))
                    .norm(),
                1e-6);
    }
  }
}

TEST(TypePackages, BiglideDrawsItsRods) {
  Toml toml("type = \"biglide\"\nrod1 = 380\nplatform = 100");
  toml.slide("S1", "Y", Vec3::UnitX(), -500, 500, -200)
      .slide("S2", "Y", Vec3::UnitX(), -500, 500, 400);
  toml.slide("Y", "bed", Vec3::UnitY(), -50, 50, 0);
  toml.passive("platform_x", "Y", Vec3::Zero(), Vec3::UnitX());
  toml.passive("platform_z", "platform_x", Vec3::Zero(), Vec3::UnitZ());
  for (const char* number : {"1", "2"})
    toml.passive(std::string("rod") + number + "_angle", std::string("S") + number, Vec3::Zero(),
                 Vec3::UnitY());
  const auto machine = toml.spindle("platform_z", Vec3::Zero()).read();
  ASSERT_TRUE(machine);
  Random random(103);
  LinkPoses poses;
  for (int n = 0; n < 200; ++n) {
    forward(*machine, anywhere(*machine, machine->home(), 60, random), poses);
    for (const int i : {1, 2}) {
      const Vec3 end = seen(*machine, poses, "rod" + std::to_string(i) + "_angle",
                            Vec3(0, 0, i == 1 ? -380 : -400));
      ASSERT_LE((end - seen(*machine, poses, "platform_z", Vec3(i == 1 ? -50 : 50, 0, 0))).norm(),
                1e-6);
    }
  }
}

TEST(TypePackages, OtherTypesAgreeWithTheTreesThatDrawThem) {
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ(), o = Vec3::Zero();
  EXPECT_TRUE(Toml("type = \"gantry\"\naxis = \"Y\"")
                  .slide("Y1", "bed", y, -100, 100, 0)
                  .slide("Y2", "bed", y, -100, 100, 0)
                  .slide("X", "Y1", x, -100, 100, 0)
                  .slide("Z", "X", z, -100, 0, 0)
                  .spindle("Z", o)
                  .read());
  EXPECT_TRUE(Toml("type = \"corexy\"")
                  .slide("A", "bed", x, -300, 300, 0)
                  .slide("B", "bed", x, -300, 300, 0)
                  .slide("Z", "platform_y", z, -100, 0, 0)
                  .passive("platform_x", "bed", o, x)
                  .passive("platform_y", "platform_x", o, y)
                  .passive("platform_z", "bed", o, z)
                  .spindle("Z", o)
                  .read());
  EXPECT_TRUE(Toml("type = \"polar\"")
                  .slide("R", "bed", x, 10, 200, 100)
                  .slide("Z", "R", z, -100, 0, 0)
                  .turn("C", "bed", o, z, -180, 180, 0, -1)
                  .work("C")
                  .spindle("Z", o)
                  .read());
  EXPECT_TRUE(Toml("type = \"lathe-vertical\"\ne = 5")
                  .slide("X", "bed", x, -300, 300, 0)
                  .slide("Z", "X", z, -500, 0, 0)
                  .turn("C", "bed", o, z, -180, 180, 0, -1)
                  .work("C")
                  .spindle("Z", Vec3(365, 5, 600))
                  .read());
  EXPECT_TRUE(Toml("type = \"scara\"")
                  .turn("J1", "bed", o, z, -120, 120)
                  .turn("J2", "J1", Vec3(340, 0, 0), z, 10, 140, 60)
                  .slide("Q", "J2", -z, 0, 300, 50)
                  .turn("J4", "Q", Vec3(590, 0, 0), z, -180, 180)
                  .spindle("J4", Vec3(640, 0, 490))
                  .read());
  EXPECT_TRUE(Toml("type = \"five-bar\"")
                  .turn("J1", "bed", Vec3(-100, 0, 0), z, 60, 200, 110)
                  .turn("J2", "bed", Vec3(100, 0, 0), z, -20, 120, 70)
                  .slide("Z", "platform_y", z, -50, 0, 0)
                  .passive("platform_x", "bed", o, x)
                  .passive("platform_y", "platform_x", o, y)
                  .spindle("Z", o)
                  .read());
  EXPECT_TRUE(Toml("type = \"table-ac\"\npoint1 = [0, 5, -60]")
                  .slide("X", "bed", x, -100, 100, 0)
                  .slide("Y", "X", y, -100, 100, 0)
                  .slide("Z", "Y", z, -100, 0, 0)
                  .turn("A", "bed", Vec3(0, 5, -60), x, -100, 100, 0, -1)
                  .turn("C", "A", o, z, -180, 180, 0, -1)
                  .work("C")
                  .spindle("Z", o)
                  .read());
}

// The classical arm with its tool's direction turned where it points at zero.
TEST(TypePackages, ArmsOfDenavitHartenbergRowsAgreeWithTheirTrees) {
  const Vec3 y = Vec3::UnitY(), z = Vec3::UnitZ(), o = Vec3::Zero();
  const auto arm = [&](const std::string& kinematics, const Vec3& gauge) {
    return Toml(kinematics)
        .turn("J1", "bed", o, z, -170, 170)
        .turn("J2", "J1", o, y, -170, 170)
        .turn("J3", "J2", Vec3(300, 0, 0), y, -170, 170)
        .turn("J4", "J3", Vec3(350, 70, 0), -z, -170, 170)
        .turn("J5", "J4", Vec3(350, 70, -400), y, -100, 100, 40)
        .turn("J6", "J5", Vec3(350, 70, -400), -z, -170, 170)
        .spindle("J6", gauge)
        .read();
  };
  EXPECT_TRUE(arm("type = \"puma\"", Vec3(350, 70, -470)));
  EXPECT_TRUE(arm("type = \"serial\"\ntool = [0, 0, 70, 180, 0, 0]", Vec3(350, 70, -470)));
}

}  // namespace
}  // namespace aircut::machine
