#include "tool/tool.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

namespace aircut::tool {
namespace {

constexpr double degree = std::numbers::pi / 180;

struct Read {
  SourceMap sources;
  Diagnostics out;
  ToolTable table;
  bool good = false;

  std::string errors() const {
    std::string all;
    for (const Diagnostic& d : out.list()) all += format_gcc(d) + "\n";
    return all;
  }
  const Tool& tool(int number) const {
    const Tool* found = table.find(number);
    EXPECT_NE(found, nullptr) << errors();
    static const Tool none;
    return found ? *found : none;
  }
};

void keep(Read& read, Expected<ToolTable> table) {
  read.good = table.has_value();
  if (table) read.table = *table;
  EXPECT_EQ(read.good, read.out.errors() == 0);
}

std::unique_ptr<Read> tbl(const std::string& text, double unit_mm = 1) {
  auto read = std::make_unique<Read>();
  keep(*read, read_tbl(read->sources.add("tool.tbl", text), unit_mm, read->out));
  return read;
}

std::unique_ptr<Read> toml(const std::string& text,
                           std::map<std::string, std::string> holders = {}) {
  auto read = std::make_unique<Read>();
  const SourceReader reader = [&](const std::string& name) -> Expected<const SourceText*> {
    const auto found = holders.find(name);
    if (found == holders.end()) return unexpected(make_error("input", "no such file"));
    return &read->sources.add("holders/" + name + ".toml", found->second);
  };
  keep(*read, read_toml(read->sources.add("tools.toml", text), reader, read->out));
  return read;
}

/// One tool with the stick-out given.
std::unique_ptr<Read> one(const std::string& keys) {
  return toml("[[tool]]\nnumber = 1\nstick_out = 40\n" + keys);
}

double radius_at(const Profile& outline, double z) {
  for (std::size_t i = 1; i < outline.size(); ++i)
    if (z <= outline[i].z && outline[i].z > outline[i - 1].z)
      return std::lerp(outline[i - 1].r, outline[i].r,
                       (z - outline[i - 1].z) / (outline[i].z - outline[i - 1].z));
  return outline.back().r;
}

// ---- tool.tbl --------------------------------------------------------------------------------

TEST(Tbl, ReadsWordsInAnyOrderAndTheNameAfterTheSemicolon) {
  const auto read =
      tbl("T2 P5 Z+12.5 D.5 ; ball \nt1p1 d3 I10 J-20 Q4 x1 A90\n\n;only a comment\n");
  ASSERT_TRUE(read->good) << read->errors();
  ASSERT_EQ(read->table.tools.size(), 2u);
  const Tool& two = read->tool(2);
  EXPECT_EQ(two.pocket, 5);
  EXPECT_EQ(two.name, "ball");
  EXPECT_DOUBLE_EQ(two.offset[Axis::z], 12.5);
  EXPECT_DOUBLE_EQ(two.diameter, 0.5);
  const Tool& one = read->tool(1);
  EXPECT_DOUBLE_EQ(one.front_angle, 10 * degree);
  EXPECT_DOUBLE_EQ(one.back_angle, -20 * degree);
  EXPECT_EQ(one.orientation, 4);
  EXPECT_DOUBLE_EQ(one.offset[Axis::x], 1);
  EXPECT_DOUBLE_EQ(one.offset[Axis::a], 90 * degree);
  EXPECT_TRUE(one.pieces.empty());
  EXPECT_EQ(one.gauge_length, 0);
  EXPECT_EQ(read->table.find(3), nullptr);
}

TEST(Tbl, IsInTheUnitOfTheMachineButAnglesAreNot) {
  const auto read = tbl("T1 P1 Z1 D0.5 C180\r\n", 25.4);
  EXPECT_DOUBLE_EQ(read->tool(1).offset[Axis::z], 25.4);
  EXPECT_DOUBLE_EQ(read->tool(1).diameter, 12.7);
  EXPECT_DOUBLE_EQ(read->tool(1).offset[Axis::c], 180 * degree);
}

TEST(Tbl, NamesThePlaceOfEveryError) {
  EXPECT_EQ(tbl("P1 Z1\n")->errors(),
            "tool.tbl:1:1: error: T is missing: the tool's number [tools_invalid]\n");
  EXPECT_EQ(tbl("\nT1 Z1\n")->errors(),
            "tool.tbl:2:1: error: P is missing: the tool's pocket [tools_invalid]\n");
  EXPECT_EQ(tbl("T1 P1\nT1 P2\n")->errors(),
            "tool.tbl:2:1: error: tool 1 was defined before [tools_invalid]\n");
  EXPECT_EQ(tbl("T1 P1 Z1 Z2\n")->errors(),
            "tool.tbl:1:10: error: Z stands twice on this line [tools_invalid]\n");
  EXPECT_EQ(tbl("T1.5 P1\n")->errors(),
            "tool.tbl:1:1: error: T needs a whole number from 0 to 99999999 [tools_invalid]\n");
  EXPECT_EQ(tbl("T0 P1\n")->errors(),
            "tool.tbl:1:1: error: tool numbers start at 1; 0 means no tool [tools_invalid]\n");
  EXPECT_EQ(tbl("T1 P1 Q10\n")->errors(),
            "tool.tbl:1:7: error: Q needs a whole number from 0 to 9 [tools_invalid]\n");
  EXPECT_EQ(tbl("T1 P1 Z\n")->errors(),
            "tool.tbl:1:7: error: 'Z' needs a number after the letter, such as Z12.5 "
            "[tools_invalid]\n");
  EXPECT_EQ(tbl("T1 P1 Zinf\n")->out.errors(), 4u);  // Z I without numbers, N F unknown
}

TEST(Tbl, RefusesAWordThatHasNoMeaningAndAnExponent) {
  EXPECT_EQ(tbl("T1 P1 K4\n")->out.errors(), 1u);
  EXPECT_EQ(tbl("T1 P1 Z1e1\n")->out.errors(), 1u);
  EXPECT_EQ(tbl("T1 P1 ?\n")->out.errors(), 1u);
}

TEST(Tbl, ReportsAllBadLines) {
  const auto read = tbl("T1\nT2 P2\nT3\rT4\r\n");
  EXPECT_EQ(read->out.errors(), 3u);
  EXPECT_NE(read->errors().find("tool.tbl:4:1"), std::string::npos) << read->errors();
}

// ---- cutters ---------------------------------------------------------------------------------

TEST(Toml, BuildsAFlatCutterAShankAndAHolderThatTouch) {
  const auto read = toml(R"(
[[tool]]
number = 4
name = "10 mm 3-flute end mill"
kind = "flat"
diameter = 10
flute_length = 22
shank_diameter = 12
stick_out = 40
length = 72
holder = "er32-63"
max_rpm = 12000
)",
                         {{"er32-63", "profile = [[25, 0], [25, 30], [31.5, 30], [31.5, 63]]"}});
  ASSERT_TRUE(read->good) << read->errors();
  const Tool& tool = read->tool(4);
  EXPECT_EQ(tool.pocket, 4);
  EXPECT_EQ(tool.name, "10 mm 3-flute end mill");
  EXPECT_EQ(tool.max_rpm, 12000);
  EXPECT_EQ(tool.diameter, 10);
  EXPECT_EQ(tool.flute_length, 22);
  EXPECT_EQ(tool.gauge_length, 103);
  EXPECT_EQ(tool.offset[Axis::z], 103);
  ASSERT_EQ(tool.pieces.size(), 3u);
  EXPECT_EQ(tool.pieces[0].role, PieceRole::cutter);
  EXPECT_EQ(tool.pieces[1].role, PieceRole::shank);
  EXPECT_EQ(tool.pieces[2].role, PieceRole::holder);
  EXPECT_EQ(tool.pieces[0].profile.front().z, 0);
  for (std::size_t i = 1; i < tool.pieces.size(); ++i)
    EXPECT_EQ(tool.pieces[i].profile.front().z, tool.pieces[i - 1].profile.back().z);
  EXPECT_EQ(tool.pieces[2].profile.back().z, tool.gauge_length);
  EXPECT_EQ(radius_at(tool.pieces[0].profile, 10), 5);
  EXPECT_EQ(radius_at(tool.pieces[1].profile, 30), 6);
}

// The radius of the outline against that of the exact arc: never smaller, at most 0.002 mm off.
void expect_outside_by_the_tolerance(const Profile& outline, double centre_r, double centre_z,
                                     double radius, double from_z, double to_z) {
  for (const ProfilePoint& p : outline) {
    if (p.z < from_z || p.z > to_z || p.r < centre_r) continue;
    const double distance = std::hypot(p.r - centre_r, p.z - centre_z);
    EXPECT_LE(distance, radius + 0.002 + 1e-9);
  }
  for (int i = 1; i < 2000; ++i) {
    const double z = from_z + (to_z - from_z) * i / 2000;
    const double exact =
        centre_r + std::sqrt(std::max(0.0, radius * radius - (z - centre_z) * (z - centre_z)));
    EXPECT_GE(radius_at(outline, z), exact - 1e-9) << "z " << z;
  }
}

TEST(Toml, PutsTheOutlineOfABallAroundTheBall) {
  const auto read = one("kind = 'ball'\ndiameter = 8\nflute_length = 20");
  ASSERT_TRUE(read->good) << read->errors();
  const Profile& outline = read->tool(1).pieces[0].profile;
  EXPECT_EQ(outline.front().r, 0);
  EXPECT_EQ(outline.front().z, 0);
  expect_outside_by_the_tolerance(outline, 0, 4, 4, 0, 4);
  EXPECT_DOUBLE_EQ(radius_at(outline, 10), 4);
}

TEST(Toml, PutsTheOutlineOfABullNoseAroundItsCorner) {
  const auto read = one("kind = 'bull'\ndiameter = 12\ncorner_radius = 2\nflute_length = 20");
  ASSERT_TRUE(read->good) << read->errors();
  expect_outside_by_the_tolerance(read->tool(1).pieces[0].profile, 4, 2, 2, 0, 2);
}

TEST(Toml, ReachesADrillsDiameterAboveItsPoint) {
  const auto read = one("kind = 'drill'\ndiameter = 10\npoint_angle = 90\nflute_length = 20");
  ASSERT_TRUE(read->good) << read->errors();
  const Profile& outline = read->tool(1).pieces[0].profile;
  EXPECT_NEAR(radius_at(outline, 2.5), 2.5, 1e-12);
  EXPECT_NEAR(radius_at(outline, 7), 5, 1e-12);
}

TEST(Toml, GivesAChamferMillAFlatTip) {
  const auto read =
      one("kind = 'chamfer'\ndiameter = 10\ntip_diameter = 2\npoint_angle = 90\nflute_length = 6");
  ASSERT_TRUE(read->good) << read->errors();
  const Profile& outline = read->tool(1).pieces[0].profile;
  EXPECT_NEAR(radius_at(outline, 1), 2, 1e-12);
  EXPECT_NEAR(radius_at(outline, 4), 5, 1e-12);
}

// Half angle 5°, ball of 1 mm at the tip: at height 20 the radius is that of the tangent cone,
// (1 + (20 − 1) sin 5°) / cos 5°.
TEST(Toml, LeansABallTippedTaperAgainstItsBall) {
  const auto read = one("kind = 'taper'\ncorner_radius = 1\ntaper_angle = 5\nflute_length = 20");
  ASSERT_TRUE(read->good) << read->errors();
  const Profile& outline = read->tool(1).pieces[0].profile;
  EXPECT_NEAR(outline.back().r, (1 + 19 * std::sin(5 * degree)) / std::cos(5 * degree), 1e-9);
  EXPECT_NEAR(read->tool(1).diameter, 2 * outline.back().r, 1e-12);
  expect_outside_by_the_tolerance(outline, 0, 1, 1, 0, 1 - std::sin(5 * degree));
}

TEST(Toml, LetsADovetailLeanInwards) {
  const auto read = one("kind = 'taper'\ntip_diameter = 20\ntaper_angle = -30\nflute_length = 6");
  ASSERT_TRUE(read->good) << read->errors();
  EXPECT_NEAR(read->tool(1).pieces[0].profile.back().r, 10 - 6 * std::tan(30 * degree), 1e-9);
  EXPECT_EQ(read->tool(1).diameter, 20);
}

TEST(Toml, EndsALollipopWhereItsNeckBegins) {
  const auto read = one("kind = 'lollipop'\ndiameter = 10\nneck_diameter = 6");
  ASSERT_TRUE(read->good) << read->errors();
  const Tool& tool = read->tool(1);
  EXPECT_NEAR(tool.flute_length, 5 + 4, 1e-9);  // 3-4-5 triangle
  EXPECT_EQ(tool.pieces[1].name, "neck");
  EXPECT_EQ(tool.pieces[1].profile.front().r, 3);
}

TEST(Toml, TakesAnyOutline) {
  const auto read = one("kind = 'profile'\nprofile = [[10, 0], [10, 3], [4, 3], [4, 12]]");
  ASSERT_TRUE(read->good) << read->errors();
  EXPECT_EQ(read->tool(1).diameter, 20);
  EXPECT_EQ(read->tool(1).flute_length, 12);
}

TEST(Toml, TakesAptParametersAndChecksThatTheLinesTouchTheCorner) {
  const auto good = one("kind = 'apt'\napt = {d = 12, r = 2, e = 4, f = 2, a = 0, b = 0, h = 20}");
  ASSERT_TRUE(good->good) << good->errors();
  EXPECT_EQ(good->tool(1).diameter, 12);
  const auto lower =
      one("kind = 'apt'\napt = {d = 12, r = 2, e = 4, f = 2.1, a = 0, b = 0, h = 20}");
  EXPECT_EQ(
      lower->errors(),
      "tools.toml:5:34: error: the lower line does not touch the corner circle: it passes its "
      "centre at 2.100000 mm, the corner radius is 2.000000 [tools_invalid]\n");
  const auto upper =
      one("kind = 'apt'\napt = {d = 12, r = 2, e = 4.1, f = 2, a = 0, b = 0, h = 20}");
  EXPECT_EQ(upper->out.errors(), 1u);
  EXPECT_NE(upper->errors().find("tools.toml:5:27: error: the upper line"), std::string::npos);
}

TEST(Toml, StacksANeckBetweenFlutesAndShank) {
  const auto read =
      one("kind='flat'\ndiameter=6\nflute_length=10\nneck_diameter=5.5\nneck_length=25\n"
          "shank_diameter=8");
  ASSERT_TRUE(read->good) << read->errors();
  const Tool& tool = read->tool(1);
  ASSERT_EQ(tool.pieces.size(), 3u);
  EXPECT_EQ(tool.pieces[1].profile.back().z, 25);
  EXPECT_EQ(tool.pieces[1].profile.back().r, 2.75);
  EXPECT_EQ(tool.pieces[2].profile.front().r, 4);
}

TEST(Toml, IsInItsOwnUnit) {
  const auto read = toml(
      "units='inch'\n[[tool]]\nnumber=1\nkind='flat'\ndiameter=0.5\nflute_length=1\nstick_out=2\n"
      "holder='h'\n",
      {{"h", "units='mm'\nprofile=[[20,0],[20,50]]"}});
  ASSERT_TRUE(read->good) << read->errors();
  EXPECT_DOUBLE_EQ(read->tool(1).diameter, 12.7);
  EXPECT_DOUBLE_EQ(read->tool(1).gauge_length, 100.8);
}

TEST(Toml, TakesTheGaugeLengthInsteadOfTheStickOut) {
  const auto read = toml(
      "[[tool]]\nnumber=1\nkind='flat'\ndiameter=5\nflute_length=10\ngauge_length=90\nholder='h'\n",
      {{"h", "profile=[[20,0],[20,50]]"}});
  ASSERT_TRUE(read->good) << read->errors();
  EXPECT_EQ(read->tool(1).pieces[2].profile.front().z, 40);
}

TEST(Toml, ReadsATurningToolWithoutSolids) {
  const auto read = toml(
      "[[tool]]\nnumber=1\nkind='turning'\nnose_radius=0.4\norientation=2\nfront_angle=85\n"
      "back_angle=25\noffset={x=10,z=30}\n");
  ASSERT_TRUE(read->good) << read->errors();
  const Tool& tool = read->tool(1);
  EXPECT_TRUE(tool.pieces.empty());
  EXPECT_DOUBLE_EQ(tool.diameter, 0.8);
  EXPECT_EQ(tool.orientation, 2);
  EXPECT_EQ(tool.offset[Axis::x], 10);
}

// ---- what is wrong ---------------------------------------------------------------------------

struct Bad {
  const char* keys;
  const char* error;  // after `tools.toml:`
};

TEST(Toml, NamesTheKeyOfEveryError) {
  const Bad cases[] = {
      {"kind='flat'\ndiameter=0\nflute_length=5",
       "5:10: error: 'diameter' needs a length of more than 0"},
      {"kind='flat'\nflute_length=5", "1:1: error: 'diameter' is missing: it needs a number"},
      {"kind='flatt'\ndiameter=1", "4:6: error: 'kind' must be "},
      {"kind='bull'\ndiameter=10\ncorner_radius=6\nflute_length=20",
       "6:15: error: 'corner_radius' can't be more than half of the diameter"},
      {"kind='ball'\ndiameter=10\nflute_length=4",
       "6:14: error: the height 4.000 mm ends inside the corner, which needs 5.000"},
      {"kind='drill'\ndiameter=10\npoint_angle=180\nflute_length=4",
       "6:13: error: 'point_angle' needs an angle between 0 and 180 degrees"},
      {"kind='drill'\ndiameter=10\npoint_angle=90\nflute_length=4",
       "7:14: error: 'flute_length' is shorter than the point, which is 5.000 mm high"},
      {"kind='flat'\ndiameter=10\nflute_length=50",
       "6:14: error: the cutter is 50.000 mm long, but the tool stands out of its holder by "
       "40.000"},
      {"kind='flat'\ndiameter=10\nflute_length=20\nlength=30",
       "7:8: error: 'length' is less than the tool's part below the holder, 40.000 mm"},
      {"kind='flat'\ndiameter=10\nflute_length=20\nholder='none'",
       "7:8: error: holder 'none' can't be read: no such file"},
      {"kind='flat'\ndiameter=10\nflute_length=20\nholder='../none'",
       "7:8: error: 'holder' needs the name of a file in holders/, without folder and .toml"},
      {"kind='flat'\ndiameter=10\nflute_length=20\ncorner_radius=1", "7:1: error: unknown key"},
      {"kind='flat'\ndiameter=10\nflute_length=20\nneck_length=30",
       "7:13: error: 'neck_length' needs 'neck_diameter' too"},
      {"kind='flat'\ndiameter=10\nflute_length=20\nneck_length=50\nneck_diameter=9",
       "7:13: error: 'neck_length' (from the tip) reaches into the holder"},
      {"kind='flat'\ndiameter=10\nflute_length=20\ngauge_length=41",
       "7:14: error: 'gauge_length' is not 'stick_out' and the holder's height together"},
      {"kind='profile'\nprofile=[[10,0],[10,-1]]",
       "5:9: error: point 2 of 'profile' lies below the point before it"},
      {"kind='profile'\nprofile=[[-1,0],[10,1]]",
       "5:9: error: point 1 of 'profile' has a radius below 0"},
      {"kind='profile'\nprofile=[[1,1],[10,2]]",
       "5:9: error: point 1 of 'profile' must have the height 0"},
      {"kind='profile'\nprofile=[[0,0],[0,2]]", "5:9: error: 'profile' has no radius"},
      {"kind='taper'\ntaper_angle=5\nflute_length=5", "1:1: error: a taper needs 'tip_diameter'"},
      {"kind='flat'\ndiameter=10\nflute_length=20\nmax_rpm=0", "7:9: error: 'max_rpm' needs more"},
      {"kind='flat'\ndiameter=10\nflute_length=20\npocket=-1", "7:8: error: 'pocket' needs"},
      {"kind='lollipop'\ndiameter=10\nneck_diameter=10",
       "6:15: error: 'neck_diameter' must be less than the diameter"},
  };
  for (const Bad& bad : cases) {
    const auto read = one(bad.keys);
    EXPECT_FALSE(read->good) << bad.keys;
    EXPECT_TRUE(read->errors().starts_with(std::string("tools.toml:") + bad.error))
        << bad.keys << "\ngives\n"
        << read->errors() << "not " << bad.error;
    EXPECT_EQ(read->out.errors(), 1u) << bad.keys << "\ngives\n" << read->errors();
  }
}

TEST(Toml, RefusesANumberThatIsUsedTwiceOrMissing) {
  const std::string tool = "kind='flat'\ndiameter=1\nflute_length=2\nstick_out=3\n";
  const auto twice = toml("[[tool]]\nnumber=1\n" + tool + "[[tool]]\nnumber=1\n" + tool);
  EXPECT_EQ(twice->errors(), "tools.toml:8:8: error: tool 1 was defined before [tools_invalid]\n");
  EXPECT_EQ(toml("[[tool]]\n" + tool)->out.errors(), 1u);
}

TEST(Toml, SaysOnceWhatIsWrongWithAHolder) {
  const std::string tool = "kind='flat'\ndiameter=1\nflute_length=2\nstick_out=3\nholder='h'\n";
  const auto read = toml("[[tool]]\nnumber=1\n" + tool + "[[tool]]\nnumber=2\n" + tool,
                         {{"h", "profile=[[0,0],[0,5]]"}});
  const std::string errors = read->errors();
  EXPECT_NE(errors.find("holders/h.toml:1:9: error: 'profile' has no radius"), std::string::npos)
      << errors;
  EXPECT_EQ(errors.find("has no radius"), errors.rfind("has no radius")) << errors;
}

TEST(Toml, WarnsWhenTheLengthOffsetIsNotTheGaugeLength) {
  const std::string tool = "kind='flat'\ndiameter=1\nflute_length=2\n";
  const auto off = one(tool + "offset={z=40.6}\n");
  EXPECT_TRUE(off->good);
  ASSERT_EQ(off->out.list().size(), 1u);
  EXPECT_EQ(off->out.list()[0].severity, Severity::warning);
  EXPECT_EQ(off->out.list()[0].span.line, 7u);
  EXPECT_TRUE(one(tool + "offset={z=40.5}\n")->out.list().empty());
}

// ---- files -----------------------------------------------------------------------------------

TEST(Files, AreReadByTheirExtensionWithHoldersBesideThem) {
  const auto folder = std::filesystem::temp_directory_path() / "aircut_tool_test";
  std::filesystem::create_directories(folder / "holders");
  const auto write = [&](const char* name, const char* text) {
    std::ofstream(folder / name) << text;
    return (folder / name).string();
  };
  write("holders/h.toml", "profile=[[20,0],[20,50]]\n");
  const std::string library = write("tools.toml",
                                    "[[tool]]\nnumber=1\nkind='flat'\ndiameter=1\nflute_length=2\n"
                                    "stick_out=3\nholder='h'\n");
  SourceMap sources;
  Diagnostics out;
  const auto table = read_tools(library, 1, sources, out);
  ASSERT_TRUE(table) << table.error().message;
  EXPECT_EQ(table->find(1)->gauge_length, 53);
  const auto inches = read_tools(write("a.tbl", "T1 P1 Z1\n"), 25.4, sources, out);
  ASSERT_TRUE(inches);
  EXPECT_EQ(inches->find(1)->offset[Axis::z], 25.4);
  EXPECT_EQ(out.errors(), 0u);
  EXPECT_FALSE(read_tools(write("a.csv", ""), 1, sources, out));
  EXPECT_FALSE(read_tools((folder / "missing.tbl").string(), 1, sources, out));
  EXPECT_EQ(out.errors(), 2u);
  std::filesystem::remove_all(folder);
}

TEST(Files, OfTheMachinePackagesAreGood) {
  int read = 0;
  for (const auto& package : std::filesystem::directory_iterator(AIRCUT_SOURCE_DIR "/machines")) {
    const auto file = package.path() / "tools.toml";
    if (!std::filesystem::exists(file)) continue;
    SourceMap sources;
    Diagnostics out;
    EXPECT_TRUE(read_tools(file.string(), 1, sources, out)) << file;
    for (const Diagnostic& d : out.list()) ADD_FAILURE() << format_gcc(d);
    ++read;
  }
  EXPECT_GT(read, 0);
}

}  // namespace
}  // namespace aircut::tool
