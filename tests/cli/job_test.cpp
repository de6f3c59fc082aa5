// Jobs of several operations: the stock goes on from one to the next, one verdict over all.
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace aircut {
namespace {

namespace fs = std::filesystem;
using json = nlohmann::json;

const std::string begin =
    "G17 G21 G40 G49 G54 G80 G90 G94 G61\nG53 G0 Z0\nT1 M6\nS7600 M3\nG43 H1\n";
const std::string end = "M5\nG53 G0 Z0\nM2\n";

class JobCommand : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    // A slot along X at Y 10, then the block is turned over and its back is cut 2 mm deep along X.
    put("one.ngc", begin + "G0 X-70 Y10\nG0 Z-5\nG1 X70 F2000\nG0 Z20\n" + end);
    put("two.ngc", begin + "G0 X-70 Y0\nG0 Z-2\nG1 X70 F2000\nG0 Z20\n" + end);
    put("one.toml", place + "place = [0.0, -40.0, 76.0]\nbox = [120.0, 79.8, 50.0]\npitch = 1.0\n");
    put("two.toml",
        place + "place = [0.0, -40.0, 126.0]\nangles = [180.0, 0.0, 0.0]\nfile = \"one.stock\"\n");
  }
  static std::string operation(const std::string& name, const std::string& more = "") {
    return "[[operation]]\nname = \"" + name + "\"\nprogram = \"" + name +
           ".ngc\"\nmachine = \"mill3\"\nsetup = \"" + name + ".toml\"\n" + more;
  }
  Outcome job(const std::string& text, const std::string& more = "") {
    put("all.job.toml", text);
    return aircut("job " + path("all.job.toml") + " " + more);
  }
  const std::string place = "schema = 1\n[stock]\nfixture = \"vise\"\nreplaces = \"vise/work\"\n";
  const std::string both =
      "schema = 1\n" + operation("one", "save_stock = \"one.stock\"\n") + operation("two");
};

TEST_F(JobCommand, CutsWhatTheOperationBeforeLeftFromTheOtherSide) {
  const Outcome r = job(both, "--frames none -o " + path("out"));
  ASSERT_EQ(r.code, 0) << r.out << r.err;
  EXPECT_TRUE(r.says("job: pass"));
  const json all = json::parse(text_of(path("out/result.json")));
  EXPECT_EQ(all["verdict"], "pass");
  ASSERT_EQ(all["operations"].size(), 2U);
  EXPECT_EQ(all["operations"][1]["folder"], "2-two");
  const json one = json::parse(text_of(path("out/1-one/result.json")));
  const json two = json::parse(text_of(path("out/2-two/result.json")));
  EXPECT_NEAR(
      all["cycle_time_s"].get<double>(),
      one["timing"]["cycle_time_s"].get<double>() + two["timing"]["cycle_time_s"].get<double>(),
      1e-9);
  // 120 x 79.8 x 50 less a slot of 10 x 5, and then another one of 10 x 2 in the other face.
  const double before = 120 * 79.8 * 50, slot = 120 * 10 * 5, back = 120 * 10 * 2;
  EXPECT_NEAR(one["stock"]["final_mm3"].get<double>(), before - slot, 0.01 * before);
  EXPECT_NEAR(one["stock"]["final_mm3"].get<double>() - two["stock"]["final_mm3"].get<double>(),
              back, 0.1 * back);
}

TEST_F(JobCommand, MakesTheShippedBracketFromBothSides) {
  const fs::path programs = fs::path(AIRCUT_SOURCE_DIR) / "programs";
  fs::create_directories(path("jobs"));
  for (const char* name : {"bracket.ngc", "mill3-block.setup.toml"})
    fs::copy(programs / name, path(name));
  for (const auto& file : fs::directory_iterator(programs / "jobs"))
    if (file.path().extension() != ".stock") fs::copy(file.path(), path("jobs"));
  const Outcome r = aircut("job " + path("jobs/bracket.job.toml") + " -q");
  EXPECT_EQ(r.code, 0) << r.out << r.err;
  EXPECT_TRUE(r.says("pass     back")) << r.out;
}

TEST_F(JobCommand, RunsNothingOnAStockThatWasNotSaved) {
  put("one.ngc", begin + "G0 X-70 Y10 Q\n" + end);
  put("one.stock", "what an earlier day has left");
  const Outcome r = job(both, "--force");
  EXPECT_EQ(r.code, 1) << r.out << r.err;
  EXPECT_TRUE(r.says(
      "two: not run: an operation before it did not reach its end, or its stock is not known"))
      << r.out;
  EXPECT_TRUE(r.says("job: fail"));
}

TEST_F(JobCommand, FailsWhenOneOperationFails) {
  put("two.ngc", begin + "G0 X-70 Y0\nG0 Z-2\nG0 X70\nG0 Z20\n" + end);
  const Outcome r = job(both, "-q");
  EXPECT_EQ(r.code, 1) << r.out << r.err;
  EXPECT_TRUE(r.says("fail     two"));
  EXPECT_TRUE(r.says("pass     one"));
}

TEST_F(JobCommand, IsUnknownWhenAnOperationCantBeRead) {
  const Outcome r = job("schema = 1\n" + operation("three") + operation("one"));
  EXPECT_EQ(r.code, 2);
  EXPECT_TRUE(r.says("unknown  three: not run")) << r.out;
  EXPECT_TRUE(r.says("pass     one")) << r.out;
}

TEST_F(JobCommand, SaysWhatIsWrongWithItsFile) {
  const std::pair<std::string, std::string> rows[] = {
      {"[[operation]]\n", "'schema = 1' is missing"},
      {"schema = 1\n", "at least one [[operation]]"},
      {"schema = 1\n[[operation]]\nname = \"a\"\nmachine = \"mill3\"\n", "program"},
      {"schema = 1\n" + operation("one") + operation("one"), "two operations named 'one'"},
      {"schema = 1\n" + operation("one", "setpu = \"x\"\n"), "Did you mean 'setup'?"},
      {"schema = 1\n[[operation]]\nname = \"a\"\nprogram = \"one.ngc\"\nmachine = \"mill3\"\n"
       "save_stock = \"a\"\n",
       "needs a set-up"},
      {"schema = 1\n[[operation]\n", "job.toml:2"},
  };
  for (const auto& [text, words] : rows) {
    const Outcome r = job(text, "-o " + path("none"));
    EXPECT_EQ(r.code, 2) << text;
    EXPECT_TRUE(r.says(words)) << text << r.err;
    EXPECT_TRUE(r.says("all.job.toml:")) << r.err;
    EXPECT_FALSE(fs::exists(path("none")));
  }
  EXPECT_TRUE(aircut("job nowhere.toml").says("No such file"));
}

}  // namespace
}  // namespace aircut
