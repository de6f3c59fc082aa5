// A job that goes on with what another one left, and one that is compared with a design.
#include "cli/program.h"
#include "geometry/geometry.h"
#include "support/slot_part.h"

namespace aircut {
namespace {

const std::string block =
    "schema = 1\n[stock]\nfixture = \"vise\"\nplace = [0.0, -40.0, 76.0]\n"
    "replaces = \"vise/work\"\n";
const std::string raw = "box = [120.0, 79.8, 50.0]\npitch = 1.0\n";

// A slot along X in the block's upper face.
std::string slot(double y) {
  return "G0 X-70 Y" + std::to_string(y) + "\nG0 Z-5\nG1 X70 F2000\nG0 Z20\n";
}
std::string program(const std::string& cuts) {
  return "G17 G21 G40 G49 G54 G80 G90 G94 G61\nG53 G0 Z0\nT1 M6\nS7600 M3\nG43 H1\n" + cuts +
         "M5\nG53 G0 Z0\nM2\n";
}

class StockFiles : public Program {
 protected:
  Outcome run(const std::string& name, const std::string& setup, const std::string& more) {
    return aircut("run " + path(name) + " -m mill3 --setup " + path(setup) +
                  " --check limits,cut --frames none --log null " + more);
  }
};

TEST_F(StockFiles, GoesOnWithWhatAnEarlierJobLeft) {
  put("one.ngc", program(slot(10)));
  put("two.ngc", program(slot(-15)));
  put("both.ngc", program(slot(10) + slot(-15)));
  put("raw.toml", block + raw);
  put("next.toml", block + "file = \"one.stock\"\n");
  const Outcome one = run("one.ngc", "raw.toml", "--save-stock " + path("one.stock"));
  EXPECT_EQ(one.code, 0) << one.err << one.out;
  const Outcome two = run("two.ngc", "next.toml", "-o " + path("two"));
  EXPECT_EQ(two.code, 0) << two.err << two.out;
  const Outcome both = run("both.ngc", "raw.toml", "-o " + path("both"));
  EXPECT_EQ(both.code, 0) << both.err << both.out;
  EXPECT_EQ(text_of(path("two/part.stl")), text_of(path("both/part.stl")));
  EXPECT_EQ(text_of(path("two/part.3mf")), text_of(path("both/part.3mf")));
  EXPECT_FALSE(text_of(path("two/part.3mf")).empty());
}

TEST_F(StockFiles, RefusesAStockThatWasChanged) {
  put("one.ngc", program(slot(10)));
  put("raw.toml", block + raw);
  put("next.toml", block + "file = \"one.stock\"\n");
  EXPECT_TRUE(run("one.ngc", "next.toml", "").says("no such file"));
  run("one.ngc", "raw.toml", "--save-stock " + path("one.stock"));
  std::string bytes = text_of(path("one.stock"));
  bytes[bytes.size() / 2] ^= 1;
  put("one.stock", bytes);
  const Outcome changed = run("one.ngc", "next.toml", "");
  EXPECT_EQ(changed.code, 2);
  EXPECT_TRUE(changed.says("next.toml:6")) << changed.err;
  EXPECT_TRUE(changed.says("check sum"));
  // Not replaced without being told.
  const Outcome again = run("one.ngc", "raw.toml", "--save-stock " + path("one.stock"));
  EXPECT_EQ(again.code, 2);
  EXPECT_EQ(text_of(path("one.stock")), bytes);
}

TEST_F(StockFiles, TellBeforeTheRunThatTheLatticeDoesNotFit) {
  put("one.ngc", program(slot(10)));
  put("fine.toml", block + "box = [120.0, 79.8, 50.0]\npitch = 0.001\n");
  const Outcome fine = run("one.ngc", "fine.toml", "-o " + path("fine"));
  EXPECT_EQ(fine.code, 2) << fine.out;
  EXPECT_TRUE(fine.says("error[stock_memory]")) << fine.err;
  EXPECT_TRUE(fine.says("the finest pitch that fits is 0.0076 mm")) << fine.err;
  EXPECT_TRUE(fine.says("fine.toml")) << fine.err;
  EXPECT_FALSE(std::filesystem::exists(path("fine")));
}

TEST_F(StockFiles, NeedAStockThatIsKnown) {
  put("one.ngc", program(slot(10)));
  const std::string job = "run " + path("one.ngc") + " -m mill3 --check limits --frames none ";
  for (const std::string option : {"--save-stock ", "--part "}) {
    const Outcome none = aircut(job + option + path("x.stl"));
    EXPECT_EQ(none.code, 2) << none.out;
    EXPECT_TRUE(none.says("needs a stock")) << none.err;
  }
}

TEST_F(StockFiles, GoOnOnALatheAndNotOnAMillOrTheOtherWayRound) {
  const std::string begin =
      "G18 G21 G40 G49 G54 G80 G90 G94 G61\nT1 M6\nS900 M3\nG43 H1\nG0 X34 Z5\n";
  const std::string face = "G0 Z0\nG1 X-0.5 F150\nG0 X34 Z2\n",
                    turn = "G0 X26 Z2\nG1 Z-20 F250\nG1 X34\n";
  const std::string end = "G0 X34\nG53 G0 X200\nG53 G0 Z0\nM5\nM2\n";
  put("face.ngc", begin + face + end);
  put("turn.ngc", begin + turn + end);
  put("both.ngc", begin + face + turn + end);
  const std::string place = "place = [0.0, 0.0, -670.0]\nreplaces = \"work\"\n";
  put("bar.toml", "schema = 1\n[stock]\ncylinder = [60.0, 169.0]\npitch = 0.2\n" + place);
  put("next.toml", "schema = 1\n[stock]\nfile = \"bar.stock\"\n" + place);
  const auto on_lathe = [&](const std::string& name, const std::string& setup,
                            const std::string& more) {
    return aircut("run " + path(name) + " -m lathe-slant --setup " + path(setup) +
                  " --check limits,cut --log null " + more);
  };
  const Outcome first = on_lathe("face.ngc", "bar.toml", "--save-stock " + path("bar.stock"));
  EXPECT_EQ(first.code, 0) << first.err << first.out;
  const Outcome next = on_lathe("turn.ngc", "next.toml", "--frames count=1 -o " + path("next"));
  EXPECT_EQ(next.code, 0) << next.err << next.out;
  EXPECT_EQ(on_lathe("both.ngc", "bar.toml", "--frames none -o " + path("both")).code, 0);
  EXPECT_EQ(text_of(path("next/part.stl")), text_of(path("both/part.stl")));
  EXPECT_FALSE(text_of(path("next/part.stl")).empty());
  const Outcome milled = run("face.ngc", "next.toml", "");
  EXPECT_EQ(milled.code, 2);
  EXPECT_TRUE(milled.says("next.toml:3")) << milled.err;
  EXPECT_TRUE(milled.says("saved on a machine whose spindle turns the work")) << milled.err;
  put("one.ngc", program(slot(10)));
  put("raw.toml", block + raw);
  EXPECT_EQ(run("one.ngc", "raw.toml", "--force --save-stock " + path("bar.stock")).code, 0);
  const Outcome turned = on_lathe("turn.ngc", "next.toml", "");
  EXPECT_EQ(turned.code, 2);
  EXPECT_TRUE(turned.says("a lathe needs a stock that was saved on a lathe")) << turned.err;
}

TEST_F(StockFiles, WritesOnePartWhereItIsWanted) {
  put("one.ngc", program(slot(10)));
  put("raw.toml", block + raw);
  const std::string output = " --part " + path("piece.3mf");
  EXPECT_EQ(run("one.ngc", "raw.toml", output).code, 0);
  const auto mesh = read_mesh(path("piece.3mf"));
  ASSERT_TRUE(mesh);
  EXPECT_NEAR(volume(*mesh), 120 * 79.8 * 50 - 120 * 10 * 5, 2);
  EXPECT_EQ(run("one.ngc", "raw.toml", output).code, 2);  // it exists
  EXPECT_TRUE(run("one.ngc", "raw.toml", "--part x.obj").says(".stl or .3mf"));
}

TEST_F(StockFiles, ComparesTheResultWithADesign) {
  put("slot.ngc", program(slot(0)));
  put("slot.stl", stl_bytes(testing::slotted_block(Vec3(120, 79.8, 50), 10, 4.8)));
  put("part.toml", "part = \"slot.stl\"\n" + block + raw);
  const Outcome deep = run("slot.ngc", "part.toml", "-o " + path("deep"));
  EXPECT_EQ(deep.code, 1);
  EXPECT_TRUE(deep.says("error[gouge_live]")) << deep.out << deep.err;
  EXPECT_TRUE(deep.says("slot.ngc:8:1"));
  EXPECT_TRUE(deep.says("0.200 mm into the part"));
  EXPECT_FALSE(text_of(path("deep/deviation.ply")).empty());
  put("part.toml", block + raw + "[part]\nmesh = \"slot.stl\"\ngouge = 0.21\n");
  EXPECT_EQ(run("slot.ngc", "part.toml", "").code, 0);
  put("part.toml", block + raw + "[part]\nmesh = \"slot.stl\"\ngauge = 0.21\n");
  EXPECT_TRUE(run("slot.ngc", "part.toml", "").says("gouge"));  // did you mean
}

}  // namespace
}  // namespace aircut
