// aircut check: many programs, each a unit of its own; every format on stdout.

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace aircut {
namespace {

using nlohmann::json;

class Check : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    put("good.ngc", "G21\nG0 X1\nM2\n");
    put("bad.ngc", "G21\nG1 X10\nM2\n");
    good_ = " " + path("good.ngc");
    bad_ = " " + path("bad.ngc");
    gone_ = " " + path("gone.ngc");
  }
  std::string good_, bad_, gone_;
};

TEST_F(Check, GivesTheWorstVerdictOfItsPrograms) {
  EXPECT_EQ(aircut("check" + good_).code, 0);
  EXPECT_EQ(aircut("check" + good_ + bad_).code, 1);
  EXPECT_EQ(aircut("check" + good_ + gone_).code, 2);
  EXPECT_EQ(aircut("check" + gone_ + bad_ + good_).code, 1);
  EXPECT_EQ(aircut("check" + bad_ + " --fail-on never").code, 2);  // refused, so never a pass
  EXPECT_EQ(aircut("check" + good_ + " --fail-on never").code, 0);
}

TEST_F(Check, GivesTheSameExitCodeInEveryFormat) {
  for (const char* format : {"human", "json", "jsonl", "gcc", "sarif", "junit", "github"}) {
    const Outcome r = aircut("check" + good_ + bad_ + gone_ + " --format " + format);
    EXPECT_EQ(r.code, 1) << format;
    EXPECT_NE(r.out.find("bad.ngc"), std::string::npos) << r.out;
    EXPECT_NE(r.out.find("zero_feed"), std::string::npos) << r.out;
    EXPECT_NE(r.out.find("can't read"), std::string::npos) << r.out;
    EXPECT_TRUE(r.err.empty()) << r.err;
  }
}

TEST_F(Check, KeepsProgramsApart) {
  // The second one needs a parameter and a feed that only the first one sets.
  put("one.ngc", "G20 M3 S500\n#<_mine>=7\nG1 X[#<_mine>] F100\nM2\n");
  put("two.ngc", "G1 X1\nG0 X#<_mine>\nM2\n");
  const std::string one = path("one.ngc"), two = path("two.ngc");
  const json both = json::parse(aircut("check " + one + " " + two + " --json").out);
  const json alone = json::parse(aircut("check " + two + " --json").out);
  ASSERT_EQ(alone["findings"].size(), 2u) << alone;
  EXPECT_EQ(both["programs"][1], alone["programs"][0]);
  EXPECT_EQ(both["findings"], alone["findings"]);
}

TEST_F(Check, KeepsTheTextsThatMessagesPointInto) {
  // The error is in a sub of a program that is long gone when the message is written.
  put("deep.ngc", "o<deep> sub\nG1 X10\no<deep> endsub\n");
  put("main.ngc", "G21\no<deep> call\nM2\n");
  std::string many;
  for (int i = 0; i < 50; ++i) many += good_;
  const Outcome r = aircut("check " + path("main.ngc") + many);
  EXPECT_EQ(r.code, 1);
  EXPECT_TRUE(r.says("deep.ngc:2:1")) << r.out;
  EXPECT_TRUE(r.says("called from " + path("main.ngc") + ":2")) << r.out;
  EXPECT_TRUE(r.says("programs 51: 50 pass, 1 fail;")) << r.out;
}

TEST_F(Check, TakesAThousandPrograms) {
  // Every tenth one is refused, every hundredth is missing.
  std::filesystem::create_directory(path("many"));
  std::string list;
  for (int i = 0; i < 1000; ++i) {
    const std::string name = "many/part-" + std::to_string(1000 + i) + ".ngc";
    if (i % 100 != 99)
      put(name, "G21 G90 M3 S500\n(part " + std::to_string(i) + ")\nG0 X" + std::to_string(i) +
                    (i % 10 == 0 ? "\nG1 X1\nM2\n" : "\nG1 X1 F100\nM2\n"));
    list += " many/part-" + std::to_string(1000 + i) + ".ngc";
  }
  // From inside the folder, so that the command line stays short.
  const std::string command = "cd " + folder_.string() +
                              " && timeout 120 " AIRCUT_BINARY_DIR "/bin/aircut check" + list +
                              " --json >" + path("json");
  const int status = std::system(command.c_str());
  EXPECT_EQ(WEXITSTATUS(status), 1);
  const json out = json::parse(text_of(path("json")));
  ASSERT_EQ(out.at("programs").size(), 1000u);
  EXPECT_EQ(out.at("findings").size(), 100u);
  EXPECT_EQ(out.at("unchecked").size(), 10u);
  EXPECT_EQ(out.at("inputs").size(), 990u);
  EXPECT_EQ(out.at("summary").at("blocks"), 990 * 5);
  for (int i = 0; i < 1000; ++i)
    EXPECT_EQ(out["programs"][static_cast<std::size_t>(i)]["verdict"], i % 100 == 99 ? "unknown"
                                                                       : i % 10 == 0 ? "fail"
                                                                                     : "pass")
        << i;
  for (const json& finding : out["findings"])
    EXPECT_EQ(finding["program"], finding["place"]["file"]);
}

TEST_F(Check, CountsMessagesBeyondWhatItKeeps) {
  // A program tells 10 000 messages at most; eleven of them are more than are kept.
  std::string text = "G21\n", list;
  for (int i = 0; i < 10'100; ++i) text += "G0 X1 ?\n";
  for (int i = 0; i < 11; ++i) {
    put(std::to_string(i) + ".ngc", text);
    list += " " + path(std::to_string(i) + ".ngc");
  }
  const Outcome r = aircut("check" + list + good_ + " --json");
  EXPECT_EQ(r.code, 1);
  const json out = json::parse(r.out);
  EXPECT_EQ(out["findings"].size(), 100'000u);
  for (std::size_t i = 0; i < 11; ++i) EXPECT_EQ(out["programs"][i]["verdict"], "fail");
  EXPECT_EQ(out["programs"][11]["verdict"], "pass");
  const std::string last = out["programs"][10]["unchecked"].dump();
  EXPECT_NE(last.find("more messages were counted but not kept"), std::string::npos) << last;
}

TEST_F(Check, WritesPathsForSarifRelativeToWhereItRuns) {
  const std::string command = "cd " + folder_.string() +
                              " && " AIRCUT_BINARY_DIR "/bin/aircut check" + bad_ +
                              " --format sarif >" + path("sarif");
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 1);
  const json run = json::parse(text_of(path("sarif"))).at("runs").at(0);
  EXPECT_EQ(run["results"][0]["locations"][0]["physicalLocation"]["artifactLocation"]["uri"],
            "bad.ngc");
  EXPECT_FALSE(run["tool"]["driver"]["rules"][0]["help"]["text"].get<std::string>().empty());
}

TEST_F(Check, TellsWhichFormatsThereAre) {
  const Outcome r = aircut("check" + good_ + " --format jnuit");
  EXPECT_EQ(r.code, 2);
  EXPECT_TRUE(r.says("junit")) << r.err;
}

}  // namespace
}  // namespace aircut
