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
  const std::string command = "cd " + folder_.string() + " && timeout 120 " +
                              std::filesystem::absolute(AIRCUT_BINARY_DIR).string() +
                              "/bin/aircut check" + list + " --json >" + path("json");
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
  const std::string command = "cd " + folder_.string() + " && " +
                              std::filesystem::absolute(AIRCUT_BINARY_DIR).string() +
                              "/bin/aircut check" + bad_ + " --format sarif >" + path("sarif");
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

// ---- semantics, travel, and what is accepted

class Gate : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    // T2 is in the spindle of mill3, and its length is not that of T1.
    put("wrong_h.ngc", "G21 G90 G54\nG53 G0 Z0\nT2 M6\nG43 H1\nG0 X0 Y0\nM2\n");
    put("far.ngc", "G21 G90 G54\nG53 G0 Z0\nG0 X1000\nM2\n");
    put("user.ngc", "G21\nM110\nM2\n");
    put("good.ngc", "G21 G90 G54\nG53 G0 Z0\nM2\n");
  }
  std::string file(const std::string& name) const { return " " + path(name); }
  json checked(const std::string& arguments) {
    return json::parse(aircut("check " + arguments + " --json").out);
  }
};

TEST_F(Gate, FailsForAWrongHInBothCommands) {
  for (const std::string command : {"check", "run"}) {
    const Outcome r = aircut(command + file("wrong_h.ngc") + " -m mill3");
    EXPECT_EQ(r.code, 1);
    EXPECT_TRUE(r.says("error[wrong_offset]: G43 takes the length of T1, but T2 is in the"))
        << r.out;
    EXPECT_TRUE(r.says("wrong_h.ngc:4:5")) << r.out;
  }
}

TEST_F(Gate, FindsAxisTravelAsRunDoes) {
  const Outcome fast = aircut("check" + file("far.ngc") + " -m mill3");
  const Outcome full = aircut("run" + file("far.ngc") + " -m mill3");
  EXPECT_EQ(fast.code, 1);
  EXPECT_EQ(full.code, 1);
  const std::size_t at = fast.out.find("error[overtravel]"), end = fast.out.find('\n', at);
  ASSERT_NE(at, std::string::npos) << fast.out;
  EXPECT_TRUE(full.says(fast.out.substr(at, end - at))) << full.out;
  EXPECT_EQ(aircut("check" + file("far.ngc") + " -m mill3 --check semantics").code, 0);
  EXPECT_EQ(aircut("check" + file("far.ngc")).code, 0);
  const json report = checked(file("far.ngc") + " -m mill3");
  EXPECT_EQ(report["checks"], json({"syntax", "semantics", "limits of the programmed path"}));
  EXPECT_EQ(report["cause"], "findings");
}

TEST_F(Gate, RefusesChecksThatDoNotExist) {
  const std::string good = "check" + file("good.ngc") + " -m mill3 --check ";
  EXPECT_EQ(aircut(good + "syntax,limits").code, 0);
  for (const auto& [word, text] :
       std::vector<std::pair<std::string, std::string>>{{"dynamics", "does not exist yet"},
                                                        {"cut", "aircut run"},
                                                        {"collision", "aircut run"},
                                                        {"limit", "Did you mean 'limits'?"}}) {
    const Outcome r = aircut(good + word);
    EXPECT_EQ(r.code, 2) << word;
    EXPECT_TRUE(r.says(text)) << word << r.err;
  }
  EXPECT_TRUE(aircut("check" + file("good.ngc") + " --check limits").says("needs a machine"));
  EXPECT_EQ(aircut("run" + file("good.ngc") + " -m mill3 --check dynamics").code, 2);
}

TEST_F(Gate, WaivesRaisesAndIsStrict) {
  const std::string wrong = file("wrong_h.ngc") + " -m mill3";
  EXPECT_EQ(aircut("check" + wrong + " --waive 'wrong_offset=the second edge'").code, 0);
  EXPECT_EQ(
      aircut("run" + wrong + " --check syntax,semantics --waive 'wrong_offset:wrong_h.ngc:4=x'")
          .code,
      0);
  const Outcome other = aircut("check" + wrong + " --waive wrong_offset:wrong_h.ngc:5=x");
  EXPECT_EQ(other.code, 1);
  EXPECT_TRUE(other.says("warning[waiver_unused]")) << other.out;
  EXPECT_TRUE(
      aircut("check" + wrong + " --waive wrong_ofset=x").says("Did you mean 'wrong_offset'?"));
  EXPECT_EQ(aircut("check" + wrong + " --waive wrong_offset").code, 2);

  EXPECT_EQ(aircut("check" + file("user.ngc")).code, 2);
  EXPECT_EQ(aircut("check" + file("user.ngc") + " --strict").code, 1);
  EXPECT_EQ(aircut("check" + file("user.ngc") + " --raise not_executed").code, 1);
  EXPECT_EQ(aircut("check" + file("user.ngc") + " --waive 'not_executed=a lamp'").code, 0);
  EXPECT_EQ(checked(file("user.ngc"))["cause"], "unchecked");
  EXPECT_EQ(checked(file("gone.ngc"))["cause"], "input");
  EXPECT_EQ(checked(file("good.ngc"))["cause"], "ok");
  EXPECT_EQ(checked(file("good.ngc") + " -m nowhere")["cause"], "input");
  EXPECT_EQ(checked(file("good.ngc") + " --waive nonsense")["cause"], "usage");
}

TEST_F(Gate, AcceptsWhatAnEarlierReportHas) {
  const std::string programs = file("wrong_h.ngc") + file("user.ngc") + " -m mill3";
  for (const std::string format : {"json", "sarif"}) {
    put("base", aircut("check" + programs + " --format " + format).out);
    const Outcome again = aircut("check" + programs + " --baseline" + file("base"));
    EXPECT_EQ(again.code, 0) << format << again.out;
    EXPECT_TRUE(again.says("2 findings of the baseline")) << again.out;
    // New ones still fail, also when lines have moved.
    put("wrong_h.ngc", "(new line)\nG21 G90 G54\nG53 G0 Z0\nT2 M6\nG43 H1\nG0 X0 Y0\nM2\n");
    EXPECT_EQ(aircut("check" + programs + " --baseline" + file("base")).code, 0);
    EXPECT_EQ(aircut("check" + programs + file("far.ngc") + " --baseline" + file("base")).code, 1);
    put("wrong_h.ngc", text_of(path("wrong_h.ngc")).substr(11));  // as it was
  }
  EXPECT_EQ(aircut("check" + programs + " --baseline" + file("good.ngc")).code, 2);
}

TEST_F(Gate, StreamsJsonLinesProgramByProgram) {
  const Outcome r = aircut("check" + file("wrong_h.ngc") + file("user.ngc") + file("good.ngc") +
                           " -m mill3 --format jsonl");
  EXPECT_EQ(r.code, 1);
  std::vector<std::string> items;
  std::stringstream lines(r.out);
  for (std::string text; std::getline(lines, text);) items.push_back(json::parse(text)["item"]);
  EXPECT_EQ(items, (std::vector<std::string>{"head", "input", "finding", "input", "unchecked",
                                             "finding", "input", "summary"}));
}

// After an error the checker goes on; what follows from it alone is not told.
TEST_F(Gate, ReportsIndependentErrorsWithoutCascades) {
  put("many.ngc",
      "G21 G90\n"
      "M3 S500 F100\n"
      "G1 X1O\n"        // a letter for a digit
      "G1 X10 Y\n"      // a number is missing
      "G2 X20 Y0 I1\n"  // not on the circle
      "X30\n"
      "o<nowhere> call\n"
      "G1 X40 H5\n"  // nobody uses H
      "G92 X3\n"
      "M2\n");
  const Outcome r = aircut("check" + file("many.ngc") + " --format gcc");
  EXPECT_EQ(r.code, 1);
  std::vector<std::string> kinds;
  std::stringstream lines(r.out);
  for (std::string text; std::getline(lines, text);)
    kinds.push_back(text.substr(text.find("ngc:") + 4,
                                text.find(':', text.find("ngc:") + 4) - text.find("ngc:") - 4) +
                    " " + text.substr(text.rfind('[')));
  EXPECT_EQ(kinds,
            (std::vector<std::string>{"3 [misplaced_word]", "4 [bad_number]", "5 [arc_error]",
                                      "7 [sub_missing]", "8 [word_unused]", "9 [offset_left_on]"}))
      << r.out;
}

TEST_F(Gate, ShowsTheCallsAndLoopsThatLedToAPlace) {
  put("calls.ngc",
      "G21 G90\no<drill> sub\n  o7 while [#1 LT 3]\n    #1 = [#1 + 1]\n    G0 X[1 / [#1 - 2]]\n"
      "  o7 endwhile\no<drill> endsub\no1 repeat [2]\n  o<drill> call [0]\no1 endrepeat\nM2\n");
  const Outcome r = aircut("check" + file("calls.ngc"));
  EXPECT_EQ(r.code, 1);
  EXPECT_TRUE(r.says("calls.ngc:5:")) << r.out;
  EXPECT_TRUE(r.says("o7 while, pass 2")) << r.out;
  EXPECT_TRUE(r.says("o<drill> call [0]")) << r.out;
  EXPECT_TRUE(r.says("o1 repeat, pass 1")) << r.out;
}

}  // namespace
}  // namespace aircut
