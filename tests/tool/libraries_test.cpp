// Tool libraries of Fusion and FreeCAD, and the limits and bodies of tools.toml that they share.
#include <gtest/gtest.h>

#include <memory>

#include "tool/insert.h"
#include "tool/tool.h"

namespace aircut::tool {
namespace {

struct Read {
  SourceMap sources;
  Diagnostics out;
  ToolTable table;
  std::string text() const {
    std::string all;
    for (const Diagnostic& d : out.list()) all += format_gcc(d) + "\n";
    return all;
  }
  const Tool& tool(int number) const {
    const Tool* found = table.find(number);
    EXPECT_NE(found, nullptr) << text();
    static const Tool none;
    return found ? *found : none;
  }
};

std::unique_ptr<Read> read_file(const std::string& name) {
  auto read = std::make_unique<Read>();
  auto table = read_tools(std::string(AIRCUT_SOURCE_DIR) + "/" + name, 1, read->sources, read->out);
  if (table) read->table = std::move(*table);
  return read;
}

std::unique_ptr<Read> fusion(const std::string& json) {
  auto read = std::make_unique<Read>();
  auto table = read_fusion(read->sources.add("library.json", json), read->out);
  if (table) read->table = std::move(*table);
  return read;
}

TEST(FusionLibrary, HasCutterShankAndHolderOfItsTools) {
  const auto read = read_file("tests/data/tools/fusion.json");
  EXPECT_EQ(read->out.errors(), 0u) << read->text();
  const Tool& mill = read->tool(1);
  EXPECT_EQ(mill.name, "10 mm end mill");
  EXPECT_EQ(mill.diameter, 10);
  EXPECT_EQ(mill.flute_length, 22);
  EXPECT_EQ(mill.teeth, 3);
  EXPECT_FALSE(mill.left_hand);
  ASSERT_EQ(mill.pieces.size(), 3u);
  EXPECT_EQ(mill.pieces[1].role, PieceRole::shank);
  // 60 of the holder are below the gauge face, what is above is in the spindle.
  EXPECT_EQ(mill.pieces[2].role, PieceRole::holder);
  EXPECT_EQ(mill.pieces[2].profile.front().r, 20);
  EXPECT_EQ(mill.pieces[2].profile.front().z, 36);
  EXPECT_EQ(mill.pieces[2].profile.back().r, 25);
  EXPECT_EQ(mill.pieces[2].profile.back().z, 96);
  EXPECT_EQ(mill.gauge_length, 96);
  EXPECT_EQ(mill.offset[Axis::z], 96);
  EXPECT_EQ(mill.unknown, "");
}

TEST(FusionLibrary, ReadsInchesAndAShaftOfCones) {
  const auto read = read_file("tests/data/tools/fusion.json");
  const Tool& ball = read->tool(2);
  EXPECT_NEAR(ball.diameter, 6.35, 1e-9);
  EXPECT_TRUE(ball.left_hand);
  EXPECT_EQ(ball.unknown, "its holder");
  ASSERT_EQ(ball.pieces.size(), 2u);
  // A shoulder of 0.2 in up to 0.75, a cone up to 1, and the shank.
  const Profile& shaft = ball.pieces[1].profile;
  ASSERT_EQ(shaft.size(), 6u);
  EXPECT_NEAR(shaft[0].z, 12.7, 1e-9);
  EXPECT_NEAR(shaft[0].r, 2.54, 1e-9);
  EXPECT_NEAR(shaft[1].z, 19.05, 1e-9);
  EXPECT_NEAR(shaft[3].z, 25.4, 1e-9);
  EXPECT_NEAR(shaft[3].r, 3.175, 1e-9);
  EXPECT_NEAR(shaft[5].z, 50.8, 1e-9);
}

TEST(FusionLibrary, LeavesAToolWithoutABodyWhoseShapeIsNotKnown) {
  const auto read = read_file("tests/data/tools/fusion.json");
  EXPECT_FALSE(has_body(read->tool(7)));
  EXPECT_NE(read->text().find("fusion.json:40"), std::string::npos) << read->text();
  EXPECT_NE(read->text().find("M6 thread mill"), std::string::npos);
}

TEST(FusionLibrary, SaysWhatIsWrongAndWhere) {
  EXPECT_NE(fusion("{\n\"data\": [\n{ \"x\": }")->text().find("library.json:3:8"),
            std::string::npos);
  EXPECT_NE(fusion("[]")->text().find("\"data\""), std::string::npos);
  const std::string tool =
      "{\"data\": [\n{\"type\": \"flat end mill\", \"unit\": \"millimeters\",\n"
      "\"geometry\": {\"DC\": 10, \"LCF\": 50, \"LB\": 36}, \"post-process\": {\"number\": 1}}";
  const auto read = fusion(tool + "]}");
  EXPECT_NE(read->text().find("library.json:2:1"), std::string::npos) << read->text();
  EXPECT_NE(read->text().find("50.000"), std::string::npos) << read->text();
  std::string good = tool;
  good.replace(good.find("50"), 2, "20");
  EXPECT_EQ(fusion(good + "]}")->out.errors(), 0u);
  EXPECT_NE(
      fusion(good + ",\n" + good.substr(good.find("\n") + 1) + "]}")->text().find("defined before"),
      std::string::npos);
}

TEST(FreeCadLibrary, NamesItsToolsByFilesBesideIt) {
  const auto read = read_file("tests/data/tools/Library/shop.fctl");
  EXPECT_EQ(read->out.errors(), 0u) << read->text();
  const Tool& mill = read->tool(1);
  EXPECT_EQ(mill.diameter, 10);
  EXPECT_EQ(mill.flute_length, 22);
  EXPECT_EQ(mill.gauge_length, 50);
  EXPECT_EQ(mill.teeth, 3);
  EXPECT_EQ(mill.unknown, "its holder");
  const Tool& bit = read->tool(5);
  EXPECT_NEAR(bit.diameter, 12.7, 1e-9);
  // A cone of 60° from the tip of 0.2.
  const double height = (12.7 - 0.2) / 2 / std::tan(M_PI / 6);
  bool cone = false;
  for (const ProfilePoint& p : bit.pieces[0].profile)
    cone = cone || (std::abs(p.z - height) < 1e-9 && std::abs(p.r - 6.35) < 1e-9);
  EXPECT_TRUE(cone);
}

TEST(FreeCadLibrary, ReadsOneToolAndWantsUnitsItKnows) {
  EXPECT_EQ(read_file("tests/data/tools/Bit/endmill_10.fctb")->tool(1).diameter, 10);
  Read read;
  const SourceText& text = read.sources.add(
      "a.fctb", "{\"shape\": \"endmill.fcstd\", \"parameter\": {\"Diameter\": \"10,5 mm\"}}");
  EXPECT_FALSE(read_fctb(text, 1, read.out));
  EXPECT_NE(read.text().find("after a point"), std::string::npos) << read.text();
}

// ---- tools.toml: limits, inserts with bodies ----

std::unique_ptr<Read> toml(const std::string& keys) {
  auto read = std::make_unique<Read>();
  auto table = read_toml(
      read->sources.add("tools.toml", "[[tool]]\nnumber = 1\n" + keys),
      [](const std::string&) -> Expected<const SourceText*> {
        return unexpected(make_error("input", "no such file"));
      },
      read->out);
  if (table) read->table = std::move(*table);
  return read;
}

TEST(ToolLimits, AreReadInTheirUnits) {
  const std::string mill = "kind = 'flat'\ndiameter = 10\nflute_length = 20\nstick_out = 40\n";
  const auto read = toml(mill +
                         "teeth = 3\nmax_depth = 5\nmax_width = 4\nmax_engagement = 90\n"
                         "max_removal = 60\nmax_chip_load = 0.1\n");
  EXPECT_EQ(read->out.errors(), 0u) << read->text();
  const CuttingLimits& limits = read->tool(1).limits;
  EXPECT_EQ(limits.depth, 5);
  EXPECT_EQ(limits.width, 4);
  EXPECT_NEAR(limits.angle, M_PI / 2, 1e-12);
  EXPECT_NEAR(limits.removal, 1000, 1e-9);  // mm³/s
  EXPECT_EQ(limits.chip_load, 0.1);
  EXPECT_NE(toml(mill + "max_chip_load = 0.1\n")->text().find("needs 'teeth'"), std::string::npos);
  EXPECT_FALSE(toml(mill)->tool(1).limits.any());
}

const std::string insert =
    "kind = 'turning'\nnose_radius = 0.8\norientation = 2\nfront_angle = 85\nback_angle = 5\n"
    "edge_length = 12\n";
const std::string block = "[[tool.block]]\noutline = [[4, 2], [70, 2], [70, 27], [4, 27]]\n";

TEST(LatheTools, HaveABodyOfAnInsertAndBlocks) {
  const auto read = toml(insert + "thickness = 4\n" + block + "y = [-25, 0]\n");
  EXPECT_EQ(read->out.errors(), 0u) << read->text();
  const Tool& tool = read->tool(1);
  ASSERT_EQ(tool.blocks.size(), 2u);
  EXPECT_EQ(tool.unknown, "");
  EXPECT_EQ(tool.blocks[0].role, PieceRole::holder);
  EXPECT_EQ(tool.blocks[1].role, PieceRole::cutter);
  EXPECT_EQ(tool.blocks[1].y_low, -4);
  double low_x = 1, low_z = 1, high_x = 0;
  for (const auto& [x, z] : tool.blocks[1].outline) {
    low_x = std::min(low_x, x);
    low_z = std::min(low_z, z);
    high_x = std::max(high_x, x);
  }
  // The nose touches both axes; its polygon lies around the circle.
  EXPECT_NEAR(low_x, 0, 0.01);
  EXPECT_NEAR(low_z, 0, 0.01);
  EXPECT_NEAR(high_x, 0.8 + 12 * std::sin(85 * M_PI / 180) - 0.8 * std::cos(85 * M_PI / 180), 0.2);
}

TEST(LatheTools, SayWhatOfTheirBodyIsMissing) {
  EXPECT_FALSE(has_body(toml(insert)->tool(1)));
  EXPECT_NE(toml(insert + "thickness = 4\n")->tool(1).unknown, "");
  EXPECT_NE(toml(insert + block + "y = [-25, 0]\n")->tool(1).unknown, "");
  EXPECT_NE(toml(insert + block)->text().find("'y' is missing"), std::string::npos);
  EXPECT_NE(
      toml(insert + "[[tool.block]]\noutline = [[0, 0], [9, 0], [3, 3], [0, 9]]\ny = [0, 1]\n")
          ->text()
          .find("convex"),
      std::string::npos);
}

TEST(LatheTools, TakeOutlinesEitherWayRound) {
  std::vector<std::array<double, 2>> one = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  std::vector<std::array<double, 2>> other = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  EXPECT_TRUE(make_convex(one));
  EXPECT_TRUE(make_convex(other));
  EXPECT_EQ(one, other);
  std::vector<std::array<double, 2>> star = {{0, 0}, {1, 1}, {1, 0}, {0, 1}};
  EXPECT_FALSE(make_convex(star));
}

}  // namespace
}  // namespace aircut::tool
