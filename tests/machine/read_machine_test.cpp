#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "machine/machine.h"

namespace aircut::machine {
namespace {

constexpr double pi = std::numbers::pi;
const std::string folder = std::string(AIRCUT_SOURCE_DIR) + "/tests/machine/good/everything";

std::shared_ptr<const Machine> everything(SourceMap& sources) {
  Diagnostics out;
  const auto machine = read_machine(folder, sources, out);
  std::string text;
  for (const Diagnostic& d : out.list()) text += format_gcc(d) + "\n";
  EXPECT_TRUE(machine) << text;
  EXPECT_EQ(text, "");
  return machine ? *machine : nullptr;
}

TEST(ReadMachine, ReadsWhatTheFileSays) {
  SourceMap sources;
  const auto machine = everything(sources);
  ASSERT_TRUE(machine);
  EXPECT_EQ(machine->name(), "everything");
  EXPECT_EQ(machine->folder(), folder);
  EXPECT_EQ(machine->dialect_, "linuxcnc");
  EXPECT_EQ(machine->default_tools_, folder + "/tools.toml");
  EXPECT_EQ(machine->default_parameters_, folder + "/params.var");
  EXPECT_EQ(machine->rapid(), RapidMode::dogleg);
  EXPECT_EQ(machine->tip_acceleration(), 2540);
  EXPECT_EQ(machine->tool_change().seconds, 2.5);
  EXPECT_EQ(machine->tool_change().program, "change");
  ASSERT_TRUE(machine->tool_change().position);
  const auto& [axes, position] = *machine->tool_change().position;
  EXPECT_TRUE(axes.has(Axis::x) && axes.has(Axis::z) && axes.has(Axis::a) && !axes.has(Axis::y));
  EXPECT_EQ(position[Axis::z], -50.8);
  EXPECT_NEAR(position[Axis::a], M_PI / 6, 1e-15);
  EXPECT_EQ(machine->spindle().link, bed_link);
  EXPECT_EQ(machine->spindle().min_rpm, 10);
  EXPECT_EQ(machine->spindle().max_rpm, 8000);
  EXPECT_EQ(machine->spindle().acceleration, 40);
  EXPECT_EQ(machine->work_link(), machine->find_link("table"));
  ASSERT_EQ(machine->exclusions().size(), 2u);
  EXPECT_EQ(machine->exclusions()[0].reason, "bolted together");
  ASSERT_EQ(machine->user_codes().size(), 2u);
  EXPECT_EQ(machine->user_codes().at(110).kind, UserCodeKind::ignore);
  EXPECT_EQ(machine->user_codes().at(111).kind, UserCodeKind::time);
  EXPECT_EQ(machine->user_codes().at(111).seconds, 1.5);
}

TEST(ReadMachine, ConvertsInchesAndDegreesOnce) {
  SourceMap sources;
  const auto machine = everything(sources);
  ASSERT_TRUE(machine);
  EXPECT_DOUBLE_EQ(machine->spindle().gauge.z(), 76.2);
  EXPECT_DOUBLE_EQ(machine->X_LM().translation().z(), 25.4);
  EXPECT_DOUBLE_EQ(machine->collision_tolerance(), 0.0254);
  const Joint& slide = machine->joint(JointId{0});
  EXPECT_DOUBLE_EQ(slide.min, -254);
  EXPECT_DOUBLE_EQ(slide.max, 254);
  EXPECT_DOUBLE_EQ(slide.vmax, 50.8);
  EXPECT_DOUBLE_EQ(slide.amax, 508);
  EXPECT_DOUBLE_EQ(slide.jmax, 5080);
  EXPECT_DOUBLE_EQ(slide.home, 25.4);
  const Joint& tilt = machine->joint(JointId{2});
  EXPECT_DOUBLE_EQ(tilt.min, -pi / 2);
  EXPECT_DOUBLE_EQ(tilt.vmax, pi);
  EXPECT_DOUBLE_EQ(tilt.amax, 2 * pi);
  EXPECT_DOUBLE_EQ(tilt.home, pi / 4);
  EXPECT_DOUBLE_EQ(tilt.origin.z(), 76.2);
  EXPECT_EQ(tilt.wrap, Wrap::none);
  EXPECT_TRUE(std::isinf(tilt.jmax));
  // The kinematics' own lengths: tip = joint + offset.
  const auto tip = machine->kinematics().forward(machine->home(), {});
  EXPECT_DOUBLE_EQ((*tip)[Axis::x], 25.4);
  EXPECT_DOUBLE_EQ((*tip)[Axis::z], 50.8);
  EXPECT_DOUBLE_EQ((*tip)[Axis::a], pi / 4);
}

TEST(ReadMachine, AxesAreLoggedInTheFilesOrderAndTheTreeHasParentsFirst) {
  SourceMap sources;
  const auto machine = everything(sources);
  ASSERT_TRUE(machine);
  EXPECT_EQ(machine->joint(JointId{0}).name, "slide");
  EXPECT_EQ(machine->joint(JointId{1}).name, "ram");
  EXPECT_EQ(machine->joint(JointId{2}).name, "tilt");
  EXPECT_EQ(machine->tree()[0].name, "ram");
  for (int i = 0; i < 3; ++i) EXPECT_EQ(machine->joint(JointId{i}).driven, i);
  for (const Joint& joint : machine->tree()) EXPECT_LT(index(joint.parent), index(joint.child));
  // On the work's branch an axis moves its carrier against its sense, unless the file says else.
  EXPECT_EQ(machine->joint(JointId{0}).sense, -1);
  EXPECT_EQ(machine->joint(JointId{1}).sense, -1);
  EXPECT_EQ(machine->joint(JointId{2}).sense, 1);
}

TEST(ReadMachine, BodiesHaveMeshPlaceAndColour) {
  SourceMap sources;
  const auto machine = everything(sources);
  ASSERT_TRUE(machine);
  ASSERT_EQ(machine->bodies().size(), 4u);
  const Body& nose = machine->bodies()[0];
  EXPECT_EQ(nose.role, Role::spindle);
  EXPECT_EQ(nose.color.r, 0x0a);
  EXPECT_EQ(nose.color.g, 0x1b);
  EXPECT_EQ(nose.color.b, 0x2c);
  EXPECT_TRUE(nose.collide);
  EXPECT_DOUBLE_EQ(bounds(*nose.mesh).sizes().x(), 10);  // unit = "mm"
  EXPECT_NEAR(bounds(*nose.mesh).min().y(), -10, 1e-9);  // up = "y": Y went to Z, Z to −Y
  EXPECT_TRUE(nose.X_LB.translation().isApprox(Vec3(25.4, 50.8, 76.2)));
  EXPECT_TRUE((nose.X_LB.linear() * Vec3::UnitX()).isApprox(Vec3::UnitY()));
  const Body& saddle = machine->bodies()[1];
  EXPECT_EQ(saddle.name, "saddle");  // named by its link
  EXPECT_FALSE(saddle.collide);
  EXPECT_DOUBLE_EQ(bounds(*saddle.mesh).sizes().x(), 254);
  EXPECT_EQ(saddle.span.line, 94u);
}

TEST(ReadMachine, FixturesStandWhereTheirFileSays) {
  SourceMap sources;
  const auto machine = everything(sources);
  ASSERT_TRUE(machine);
  const Body& jaw = machine->bodies()[2];
  const Body& base = machine->bodies()[3];
  EXPECT_EQ(jaw.name, "vise/jaw");
  EXPECT_EQ(jaw.role, Role::fixture);
  EXPECT_EQ(jaw.link, machine->find_link("cradle"));
  // M is at z = 25.4; the fixture at (10, 20, 30) in M, turned by 90 degrees.
  EXPECT_TRUE(jaw.X_LB.translation().isApprox(Vec3(10, 20, 55.4)));
  EXPECT_TRUE(base.X_LB.translation().isApprox(Vec3(10, 25, 55.4)));
  EXPECT_TRUE((base.X_LB.linear() * Vec3::UnitX()).isApprox(Vec3::UnitY()));
}

TEST(ReadMachine, LinksMoveByTheirCouples) {
  SourceMap sources;
  const auto machine = everything(sources);
  ASSERT_TRUE(machine);
  JointVector joints(3);
  joints << 100, -50, pi / 2;
  LinkPoses poses;
  forward(*machine, joints, poses);
  const auto pose = [&](const char* link) {
    return poses.X_WL[static_cast<std::size_t>(index(*machine->find_link(link)))];
  };
  EXPECT_TRUE(pose("bed").isApprox(Pose::Identity()));
  EXPECT_TRUE(pose("saddle").translation().isApprox(Vec3(0, 0, 50)));
  EXPECT_TRUE(pose("table").translation().isApprox(Vec3(-100, 0, 50)));
  // A quarter turn about +Y through (0, 0, 76.2): the bed's (10, 0, 76.2) goes to (0, 0, 66.2).
  EXPECT_TRUE((pose("cradle") * Vec3(10, 0, 76.2)).isApprox(Vec3(-100, 0, 116.2)));
}

std::string setup_errors(const Machine& machine, SourceMap& sources, const std::string& content) {
  const std::string path = testing::TempDir() + "/aircut-setup-test.toml";
  EXPECT_TRUE(write_file(path, content));
  Diagnostics out;
  const auto setup = read_setup(path, machine, sources, out);
  EXPECT_EQ(setup.has_value(), out.errors() == 0);
  std::string text;
  for (const Diagnostic& d : out.list())
    text += std::to_string(d.span.line) + ":" + std::to_string(d.span.column()) + " " + d.message +
            " [" + d.kind + "]\n";
  return text;
}

TEST(Setup, PlacesFixturesOffsetsAndStart) {
  SourceMap sources;
  const auto machine = everything(sources);
  ASSERT_TRUE(machine);
  const auto& text = sources.add("setup.toml",
                                 "units = \"mm\"\n"
                                 "[[fixture]]\nname = \"vise\"\nplace = [1, 2, 3]\n"
                                 "[[fixture]]\nname = \"plate\"\nangle = 180\n"
                                 "[offsets]\nG54 = [1, 2, 3, 90]\nG59.3 = [4, 5, 6]\n"
                                 "[start]\njoints = { slide = 10, tilt = -90 }\n");
  const std::string path = testing::TempDir() + "/aircut-setup-good.toml";
  ASSERT_TRUE(write_file(path, std::string(text.content())));
  Diagnostics out;
  // `G59.3` is a dotted key in TOML: it needs quotes.
  EXPECT_FALSE(read_setup(path, *machine, sources, out));
  std::string quoted(text.content());
  quoted.replace(quoted.find("G59.3"), 5, "\"G59.3\"");
  ASSERT_TRUE(write_file(path, quoted));
  Diagnostics good;
  const auto setup = read_setup(path, *machine, sources, good);
  ASSERT_TRUE(setup) << (good.list().empty() ? "" : format_gcc(good.list()[0]));
  EXPECT_EQ(setup->offsets.size(), 2u);
  EXPECT_DOUBLE_EQ(setup->offsets.at(1)[Axis::a], pi / 2);
  EXPECT_EQ(setup->offsets.at(9)[Axis::z], 6);
  ASSERT_TRUE(setup->start);
  EXPECT_DOUBLE_EQ((*setup->start)[0], 10);
  EXPECT_DOUBLE_EQ((*setup->start)[1], 0);
  EXPECT_DOUBLE_EQ((*setup->start)[2], -pi / 2);

  const auto placed = apply_setup(*machine, *setup, sources, good);
  ASSERT_TRUE(placed);
  ASSERT_EQ((*placed)->bodies().size(), 5u);
  const Body& jaw = (*placed)->bodies()[2];
  EXPECT_TRUE(jaw.X_LB.translation().isApprox(Vec3(1, 2, 28.4)));
  EXPECT_TRUE((jaw.X_LB.linear() * Vec3::UnitX()).isApprox(Vec3::UnitY()));  // angle as before
  EXPECT_EQ(jaw.mesh, machine->bodies()[2].mesh);
  const Body& plate = (*placed)->bodies()[4];
  EXPECT_EQ(plate.name, "plate/plate");
  EXPECT_EQ(plate.link, (*placed)->work_link());
  EXPECT_TRUE(plate.X_LB.translation().isApprox(Vec3(1, 1, 26.4)));  // as its file says
  EXPECT_TRUE((plate.X_LB.linear() * Vec3::UnitX()).isApprox(-Vec3::UnitX()));
  EXPECT_EQ(machine->bodies().size(), 4u);  // the machine itself is as it was
}

// The machine of `everything` with this setup on it, or the messages.
std::shared_ptr<const Machine> with_setup(const Machine& machine, SourceMap& sources,
                                          const std::string& text, std::string& messages) {
  static int number = 0;
  const std::string path =
      testing::TempDir() + "/aircut-setup-stock-" + std::to_string(++number) + ".toml";
  EXPECT_TRUE(write_file(path, text));
  Diagnostics out;
  const auto setup = read_setup(path, machine, sources, out);
  std::shared_ptr<const Machine> placed;
  if (setup)
    if (auto made = apply_setup(machine, *setup, sources, out)) placed = *made;
  for (const Diagnostic& d : out.list())
    messages += std::to_string(d.span.line) + ": " + d.message + "\n";
  return placed;
}

TEST(Setup, PutsTheRawPieceWhereItSays) {
  SourceMap sources;
  const auto machine = everything(sources);
  ASSERT_TRUE(machine);
  std::string messages;
  const auto placed = with_setup(*machine, sources,
                                 "[[fixture]]\nname = \"plate\"\nplace = [10, 0, 0]\n"
                                 "angle = 90\n[stock]\nbox = [40, 30, 20]\nplace = [1, 2, 3]\n"
                                 "fixture = \"plate\"\npitch = 0.1\n",
                                 messages);
  ASSERT_TRUE(placed) << messages;
  ASSERT_TRUE(placed->stock());
  const Body& body = placed->bodies().back();
  EXPECT_EQ(body.name, "stock");
  EXPECT_EQ(body.role, Role::stock);
  EXPECT_NEAR(volume(*body.mesh), 40 * 30 * 20, 1e-9);
  const Pose X_ML = machine->X_LM().inverse();
  // The plate is turned by 90°: its (1, 2) is (−2, 1) of M.
  EXPECT_TRUE((X_ML * body.X_LB * Vec3(0, 0, 0)).isApprox(Vec3(8, 1, 3)));
  EXPECT_TRUE((X_ML * body.X_LB * Vec3(20, 15, 0)).isApprox(Vec3(-7, 21, 3)));
  EXPECT_EQ(placed->stock()->pitch, 0.1);
}

TEST(Setup, KnowsTubesAndCylinders) {
  SourceMap sources;
  const auto machine = everything(sources);
  ASSERT_TRUE(machine);
  for (const auto& [shape, exact] : std::vector<std::pair<std::string, double>>{
           {"cylinder = [40, 50]", pi * 400 * 50}, {"tube = [40, 20, 50]", pi * 300 * 50}}) {
    std::string messages;
    const auto placed = with_setup(*machine, sources, "[stock]\n" + shape + "\n", messages);
    ASSERT_TRUE(placed) << messages;
    const TriangleMesh& mesh = *placed->bodies().back().mesh;
    EXPECT_NEAR(volume(mesh), exact, 2e-3 * exact) << shape;
    for (const Shell& shell : shells(mesh)) EXPECT_TRUE(shell.closed) << shape;
  }
}

TEST(Setup, RefusesARawPieceThatIsNone) {
  SourceMap sources;
  const auto machine = everything(sources);
  ASSERT_TRUE(machine);
  const auto says = [&](const std::string& text) {
    std::string messages;
    EXPECT_FALSE(with_setup(*machine, sources, text, messages)) << text;
    return messages;
  };
  EXPECT_NE(says("[stock]\nplace = [1, 2, 3]\n").find("needs one shape"), std::string::npos);
  EXPECT_NE(says("[stock]\nbox = [1, 2, 3]\ncylinder = [1, 2]\n").find("needs one shape"),
            std::string::npos);
  EXPECT_NE(says("[stock]\ntube = [10, 10, 5]\n").find("less than the diameter"),
            std::string::npos);
  EXPECT_NE(says("[stock]\nbox = [1, 2, 3]\nfixture = \"vice\"\n").find("no fixture 'vice'"),
            std::string::npos);
  EXPECT_NE(says("[stock]\nmesh = \"none.stl\"\n"), "");
  EXPECT_NE(says("[stock]\nmesh = \"../x.stl\"\n"), "");
  EXPECT_NE(says("[stock]\nbox = [1, 2, 3]\npitch = 20\n").find("0.001 to 10 mm"),
            std::string::npos);
}

TEST(Setup, AFixtureThatIsNotPresentIsGone) {
  SourceMap sources;
  const auto machine = everything(sources);
  ASSERT_TRUE(machine);
  machine::Setup setup;
  setup.fixtures.push_back(
      {.name = "vise", .place = {}, .angle = {}, .present = false, .span = {}});
  Diagnostics out;
  const auto placed = apply_setup(*machine, setup, sources, out);
  ASSERT_TRUE(placed);
  EXPECT_EQ((*placed)->bodies().size(), 2u);
  // Its exclusions name nothing now, which is not an error of the setup.
  EXPECT_EQ(out.errors(), 0u);
}

TEST(Setup, SaysWhatIsWrongWhere) {
  SourceMap sources;
  const auto machine = everything(sources);
  ASSERT_TRUE(machine);
  EXPECT_EQ(setup_errors(*machine, sources,
                         "[stock]\nbox = [1, 0, 3]\n[probe]\n"
                         "[[fixture]]\nname = \"vise\"\nplce = [1, 2]\n"
                         "[offsets]\nG54 = [1, 2]\nG60 = [1, 2, 3]\n"
                         "[start]\njoints = { slde = 1, ram = 9.5 }\n"),
            "2:7 the sizes of 'box' must be above 0 and up to 100 m [setup_invalid]\n"
            "3:1 [probe] is not supported by this version [setup_invalid]\n"
            "6:1 unknown key 'plce'. Did you mean 'place'? [setup_invalid]\n"
            "8:7 'G54' needs 3 to 9 numbers in the order X Y Z A B C U V W [setup_invalid]\n"
            "9:1 unknown key 'G60'. Known here: 'G54', 'G55', 'G56', 'G57', 'G58', 'G59', 'G59.1', "
            "'G59.2' and 'G59.3'. [setup_invalid]\n"
            "11:12 unknown key 'slde'. Did you mean 'slide'? [setup_invalid]\n"
            "11:28 ram 9.5 is outside of the travel -101.6 to 0 [setup_invalid]\n");
  EXPECT_EQ(setup_errors(*machine, sources, "probe = \"x.stl\"\nschema = 9\n"),
            "1:9 [probe] is not supported by this version [setup_invalid]\n"
            "2:10 schema 9 is newer than this version of aircut, which knows schema 1 "
            "[setup_invalid]\n");
  EXPECT_EQ(setup_errors(*machine, sources, "[part]\nmesh = \"x.stl\"\ngouge = -1.0\n"),
            "3:9 'gouge' must be 0 to 100 mm [setup_invalid]\n");
}

TEST(Setup, AnUnknownFixtureIsAnErrorAtItsName) {
  SourceMap sources;
  const auto machine = everything(sources);
  ASSERT_TRUE(machine);
  const auto& text = sources.add("setup.toml", "[[fixture]]\nname = \"vize\"\n");
  machine::Setup setup;
  setup.fixtures.push_back({.name = "vize",
                            .place = {},
                            .angle = {},
                            .present = true,
                            .span = {.text = &text, .begin = 19, .length = 6, .line = 2}});
  Diagnostics out;
  EXPECT_FALSE(apply_setup(*machine, setup, sources, out));
  ASSERT_EQ(out.list().size(), 1u);
  EXPECT_EQ(out.list()[0].span.line, 2u);
  EXPECT_EQ(out.list()[0].message,
            "fixture 'vize': can't use the file 'fixtures/vize.toml': there is no such file. Did "
            "you mean 'vise.toml'?");
}

}  // namespace
}  // namespace aircut::machine
