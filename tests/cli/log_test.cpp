// `aircut log` and `aircut diff`: joint logs read back, and programs compared by their motion.
#include <map>
#include <nlohmann/json.hpp>

#include "program.h"

namespace aircut {
namespace {

struct LogCommand : Program {
  // A short program with corners, an arc and a helix, run on a mill; the log is at log().
  void run_part(const std::string& mode = "G64 P0.02", const std::string& options = "") {
    put("part.ngc", "G21 G90 G17 G54 " + mode +
                        "\nT5 M6\nG43 H5\nS3000 M3\nG0 X10 Y10 Z20\nG1 Z10 F900\nX40\nY30\n"
                        "G2 X20 Y10 I-20 J0\nG3 X20 Y10 Z8 I5 J0\nG1 X10 Y20 F1200\nX60 Y40\n"
                        "G0 Z20\nM5\nM2\n");
    const Outcome run =
        aircut("run " + path("part.ngc") + " -m mill3 --check syntax --log " + log() + options);
    ASSERT_TRUE(std::filesystem::exists(log())) << run.err << run.out;
  }
  std::string log() const { return path("joints.csv"); }
};

TEST_F(LogCommand, ChecksARunsLogAgainstItsProgram) {
  run_part();
  const Outcome good =
      aircut("log check " + log() + " --program " + path("part.ngc") + " -m mill3");
  EXPECT_EQ(good.code, 0) << good.out << good.err;
  EXPECT_TRUE(good.says("pass"));
  put("other.ngc",
      "G21 G90 G17 G54 G61\nT5 M6\nG43 H5\nS3000 M3\nG0 X10 Y10 Z20\nG1 Z10 F900\nX41\nM2\n");
  const Outcome bad =
      aircut("log check " + log() + " --program " + path("other.ngc") + " -m mill3");
  EXPECT_EQ(bad.code, 1) << bad.out;
  EXPECT_TRUE(bad.says("off the programmed path")) << bad.out;
  EXPECT_EQ(aircut("log check " + log() + " --program " + path("part.ngc")).code, 2);
}

TEST_F(LogCommand, KeepsToThePathInExactMode) {
  run_part("G61");
  const Outcome good =
      aircut("log check " + log() + " --program " + path("part.ngc") + " -m mill3");
  EXPECT_EQ(good.code, 0) << good.out << good.err;
}

TEST_F(LogCommand, ChecksARunWithOverridesByTheirFactors) {
  put("panel.toml",
      "[[event]]\nt = 3\nfeed = 50\nrapid = 25\n[[event]]\nt = 4\nhold = true\n"
      "[[event]]\nt = 5.5\nhold = false\nspindle = 110\n");
  run_part("G64 P0.02", " --overrides " + path("panel.toml"));
  EXPECT_NE(text_of(log()).find("# feed_factors=0.5,"), std::string::npos);
  const Outcome good =
      aircut("log check " + log() + " --program " + path("part.ngc") + " -m mill3");
  EXPECT_EQ(good.code, 0) << good.out << good.err;
}

TEST_F(LogCommand, RefusesOverridesThatHoldForEverOrSayNothing) {
  const std::pair<std::string, std::string> wrong[] = {
      {"[[event]]\nt = 3\nhold = true\n", "never goes on"},
      {"[[event]]\nt = 3\n", "needs at least one of"},
      {"[[event]]\nt = 3\nfeed = -5\n", "bad.toml:3:8"},
      {"[[event]]\nt = 3\nfed = 50\n", "feed"},
      {"[[event]]\nt = 3\nfeed = 50\n[[event]]\nt = 1\nfeed = 60\n", "bad.toml:5:5"}};
  put("part.ngc", "G21 G90 F100\nG1 X1\nM2\n");
  for (const auto& [text, message] : wrong) {
    put("bad.toml", text);
    const Outcome bad =
        aircut("run " + path("part.ngc") + " -m mill3 --overrides " + path("bad.toml"));
    EXPECT_EQ(bad.code, 2) << text;
    EXPECT_TRUE(bad.says("overrides_invalid") && bad.says(message)) << bad.err;
  }
}

TEST_F(LogCommand, FindsARowThatJumps) {
  run_part();
  std::string text = text_of(log());
  // A tenth of a millimetre more in the first joint of a row in the middle.
  std::size_t row = text.find("\n1.5,");
  ASSERT_NE(row, std::string::npos);
  for (int comma = 0; comma < 7; ++comma) row = text.find(',', row) + 1;
  const std::size_t end = text.find(',', row);
  text.replace(row, end - row, std::to_string(std::stod(text.substr(row, end - row)) + 0.1));
  put("bad.csv", text);
  const Outcome bad = aircut("log check " + path("bad.csv"));
  EXPECT_EQ(bad.code, 1);
  EXPECT_TRUE(bad.says("acceleration limit of joint X is passed")) << bad.out;
  const Outcome diff = aircut("log diff " + log() + " " + path("bad.csv"));
  EXPECT_EQ(diff.code, 1);
  EXPECT_TRUE(diff.says("differs from t = 1.500 s")) << diff.out;
  EXPECT_EQ(aircut("log diff " + log() + " " + log()).code, 0);
}

TEST_F(LogCommand, RefusesWhatIsNoLogAtItsPlace) {
  put("bad.csv", "# format=aircut-joints-1\n# joints=X:furlong\nt,line\n");
  const Outcome bad = aircut("log info " + path("bad.csv"));
  EXPECT_EQ(bad.code, 2);
  EXPECT_TRUE(bad.says("bad.csv:2:3")) << bad.err;
  EXPECT_EQ(aircut("log check " + path("missing.csv")).code, 2);
  const Outcome wrong = aircut("log chekc x");
  EXPECT_EQ(wrong.code, 2);
  EXPECT_TRUE(wrong.says("check")) << wrong.err;
}

TEST_F(LogCommand, ExportsAndDraws) {
  run_part();
  EXPECT_EQ(aircut("log export " + log() + " -o " + path("t.csv") + " --columns t,q0,q1").code, 0);
  EXPECT_EQ(text_of(path("t.csv")).substr(0, 7), "t,q0,q1");
  EXPECT_EQ(aircut("log export " + log() + " -o " + path("t.csv")).code, 2) << "it exists";
  EXPECT_EQ(aircut("log export " + log() + " -o " + path("t.npy") + " --every 10").code, 0);
  EXPECT_EQ(aircut("log export " + log() + " -o " + path("t.xls")).code, 2);
  EXPECT_EQ(aircut("log plot " + log() + " -o " + path("p.png") + " --from 0.5 --to 2").code, 0);
  EXPECT_EQ(text_of(path("p.png")).substr(1, 3), "PNG");
  const Outcome info = aircut("log info " + log());
  EXPECT_EQ(info.code, 0);
  EXPECT_TRUE(info.says("cycle time"));
}

TEST_F(LogCommand, WritesAndReadsHdf5) {
  run_part();
  const std::string run = "run " + path("part.ngc") + " -m mill3 --check syntax --log ";
  aircut(run + path("joints.h5"));
  ASSERT_TRUE(std::filesystem::exists(path("joints.h5")));
  EXPECT_EQ(text_of(path("joints.h5")).substr(1, 3), "HDF");
  for (const auto& entry : std::filesystem::directory_iterator(path("")))
    EXPECT_EQ(entry.path().string().find("joints.h5."), std::string::npos) << entry.path();
  // Back to text: the same bytes as a log that was written as text.
  EXPECT_EQ(
      aircut("log export " + path("joints.h5") + " -o " + path("back.csv") + " --header").code, 0);
  EXPECT_EQ(text_of(path("back.csv")), text_of(log()));
  EXPECT_EQ(aircut("log export " + log() + " -o " + path("other.h5")).code, 0);
  EXPECT_EQ(text_of(path("other.h5")), text_of(path("joints.h5")));
  EXPECT_EQ(aircut("log diff " + log() + " " + path("other.h5")).code, 0);
  EXPECT_EQ(
      aircut("log check " + path("other.h5") + " --program " + path("part.ngc") + " -m mill3").code,
      0);
  EXPECT_EQ(aircut("log plot " + path("other.h5") + " -o " + path("p.png")).code, 0);
  EXPECT_EQ(aircut("log export " + log() + " -o " + path("x.h5") + " --every 2").code, 2);
  put("cut.h5", text_of(path("other.h5")).substr(0, 3000));
  const Outcome cut = aircut("log info " + path("cut.h5"));
  EXPECT_EQ(cut.code, 2);
  EXPECT_TRUE(cut.says("cut.h5' is no joint log")) << cut.err;
}

TEST_F(LogCommand, ARunTellsWhatHeldEachLineAndTheMostOfEachJoint) {
  put("part.ngc",
      "G21 G90 G17 G61.1 G54\nT5 M6\nG43 H5\nS3000 M3\nG0 X10 Y10 Z20\nG1 X60 F300\nG4 P0.5\n"
      "G1 X60.5 F3000\nM5\nM2\n");
  aircut("run " + path("part.ngc") + " -m mill3 --check syntax --frames none -o " + path("out"));
  const auto document = nlohmann::json::parse(text_of(path("out/result.json")));
  std::ifstream lines(path("out/lines.jsonl"));
  std::map<int, nlohmann::json> row;
  double sum = 0;
  for (std::string text; std::getline(lines, text);) {
    const auto item = nlohmann::json::parse(text);
    row[item["line"]] = item;
    sum += item["time_s"].get<double>();
  }
  EXPECT_EQ(row[6]["limited_by"], "feed");
  EXPECT_NEAR(row[6]["length_mm"].get<double>(), 50, 1e-9);
  EXPECT_GT(row[6]["time_s"].get<double>(), 10) << "50 mm at 5 mm/s";
  EXPECT_EQ(row[7]["limited_by"], "dwell");
  EXPECT_NEAR(row[7]["time_s"].get<double>(), 0.5, 1e-12);
  EXPECT_EQ(row[8]["limited_by"], "X acceleration");
  const double cycle = document["timing"]["cycle_time_s"];
  EXPECT_NEAR(sum, cycle, 1e-9);
  double held = 0;
  for (const auto& [cause, seconds] : document["timing"]["held_by_s"].items())
    held += seconds.get<double>();
  EXPECT_NEAR(held, cycle, 1e-9);
  // The most of each joint is what the checker reads from the log.
  const Outcome info = aircut("log info " + path("out/joints.csv"));
  const auto& x = document["peaks"]["X"];
  EXPECT_GT(document["planner"]["pieces"].get<int>(), 2);
  EXPECT_GE(document["planner"]["nodes"], document["planner"]["pieces"]);
  EXPECT_EQ(document["chord_error"]["value"], 0) << "each joint is an axis";
  EXPECT_GT(x["acceleration"]["value"].get<double>(), 0);
  EXPECT_EQ(x["acceleration"]["unit"], "mm/s^2");
  EXPECT_TRUE(info.says(std::to_string(x["speed"]["line"].get<int>())));
  EXPECT_TRUE(document["outputs"].dump().find("lines.jsonl") != std::string::npos);
}

TEST_F(LogCommand, AThreadThatTheAxisCanNotFollowIsFound) {
  const Outcome run = aircut("run tests/data/findings/sync_limit.ngc -m mill3 --check syntax");
  EXPECT_EQ(run.code, 1);
  EXPECT_TRUE(run.says("sync_limit")) << run.out;
  EXPECT_TRUE(run.says("sync_limit.ngc:7")) << run.out;
}

struct Diff : Program {
  Outcome diff(const std::string& a, const std::string& b) {
    put("a.ngc", a);
    put("b.ngc", b);
    return aircut("diff " + path("a.ngc") + " " + path("b.ngc"));
  }
};

TEST_F(Diff, SeesTheSameMotionInOtherWords) {
  const Outcome same =
      diff("G21 G90 F600\nG1 X10\nX20 Y5\nM2\n",
           "(the same)\nG21 G91 F600\nN10 G1 X5\nG1 X5\nG1 X[5*2] Y5 (there)\nM2\n");
  EXPECT_EQ(same.code, 0) << same.out;
  EXPECT_TRUE(same.says("the motion is the same"));
}

TEST_F(Diff, NamesTheMovesThatDiffer) {
  const Outcome moved = diff("G21 G90 F600\nG1 X10\nG1 X10 Y5\nG1 X0 Y0\nM2\n",
                             "G21 G90 F600\nG1 X10\nG1 X10 Y6\nG1 X0 Y0\nM2\n");
  EXPECT_EQ(moved.code, 1);
  EXPECT_TRUE(moved.says("- ")) << moved.out;
  EXPECT_TRUE(moved.says("a.ngc:3")) << moved.out;
  EXPECT_TRUE(moved.says("b.ngc:3"));
  EXPECT_FALSE(moved.says("a.ngc:2"));
  EXPECT_FALSE(moved.says("a.ngc:5"));
}

TEST_F(Diff, NamesTheFeedSpindleAndToolThatDiffer) {
  const Outcome feed =
      diff("G21 G90 S1000 M3 F600\nG1 X10\nY10\nM2\n", "G21 G90 S2000 M3 F500\nG1 X10\nY10\nM2\n");
  EXPECT_EQ(feed.code, 1);
  EXPECT_TRUE(feed.says("feed 600 | 500")) << feed.out;
  EXPECT_TRUE(feed.says("spindle speed 1000 | 2000"));
  EXPECT_FALSE(feed.says("a.ngc:3")) << "told once";
}

TEST_F(Diff, IsUnknownForAProgramThatIsRefused) {
  const Outcome bad = diff("G21 G90 F600\nG1 X10\nM2\n", "G21 G90 F600\nG1 X10\nG1 X1o\nM2\n");
  EXPECT_NE(bad.code, 0);
  EXPECT_TRUE(bad.says("not compared"));
}

}  // namespace
}  // namespace aircut
