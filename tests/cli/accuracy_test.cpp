// `aircut accuracy`: the shipped set-up, its files, what-ifs, and the picture that a script makes
// of them.
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "program.h"

namespace aircut {
namespace {

using nlohmann::json;

const std::string setup = "programs/accuracy/twin-turret.toml";

struct AccuracyCommand : Program {
  std::string shipped() const { return text_of(std::string(AIRCUT_SOURCE_DIR) + "/" + setup); }
  /// The shipped set-up with one text replaced.
  std::string with(const std::string& from, const std::string& to) {
    std::string text = shipped();
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    put("changed.toml", text.replace(at, from.size(), to));
    return path("changed.toml");
  }
};

TEST_F(AccuracyCommand, SaysWhatTheShippedSetUpDoes) {
  const Outcome run = aircut("accuracy " + setup);
  EXPECT_EQ(run.code, 0) << run.err;
  for (const char* text : {"15.976", "-7.791", "31.953", "case I", "C_p 2.64", "pass"})
    EXPECT_TRUE(run.says(text)) << text << "\n" << run.out;
  EXPECT_EQ(aircut("accuracy " + setup).out, run.out);
}

TEST_F(AccuracyCommand, WritesJsonAndCsv) {
  const Outcome run = aircut("accuracy " + setup + " --format json --influence -o " + path("out"));
  EXPECT_EQ(run.code, 0) << run.err;
  const json result = json::parse(text_of(path("out/accuracy.json")));
  EXPECT_EQ(run.out, text_of(path("out/accuracy.json")));
  EXPECT_EQ(result["verdict"], "pass");
  const json& one = result["segments"][0]["active"][0];
  EXPECT_NEAR(one["delta_um"].get<double>(), 15.976283301154599, 1e-9);
  EXPECT_NEAR(one["w_um"][1].get<double>(), 56.493559233620175, 1e-9);
  EXPECT_NEAR(one["scatter"]["field_um"].get<double>(), 8.720960643723025, 1e-9);
  EXPECT_NEAR(result["segments"][0]["E_um_per_N"][0][0].get<double>(), 0.076606, 1e-6);
  double sum = 0;
  for (const json& share : one["split"]) sum += share["delta_um"].get<double>();
  EXPECT_NEAR(sum, 15.976283301154599, 1e-9);
  const std::string csv = text_of(path("out/accuracy.csv"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 3);
  EXPECT_NE(csv.find(",15.9763,11.9104,20.6314\n"), std::string::npos) << csv;
  EXPECT_EQ(aircut("accuracy " + setup + " -o " + path("out")).code, 2);
  EXPECT_EQ(aircut("accuracy " + setup + " --force -o " + path("out")).code, 0);
}

TEST_F(AccuracyCommand, FailsAndRefusesWithTheRightCodes) {
  const Outcome fails = aircut("accuracy " + with("compensate = true", ""));
  EXPECT_EQ(fails.code, 1);
  EXPECT_TRUE(fails.says("error[size_error]")) << fails.err;
  const Outcome refused = aircut("accuracy " + with("V = 200", "V = fast"));
  EXPECT_EQ(refused.code, 2);
  EXPECT_TRUE(refused.says("accuracy_invalid"));
  const Outcome unknown =
      aircut("accuracy " + with("normal = [0, 0, 1]", "normal = [0, 0, 1]\nspeed = 3"));
  EXPECT_EQ(unknown.code, 2);
  EXPECT_TRUE(unknown.says("changed.toml:")) << unknown.err;
  EXPECT_EQ(aircut("accuracy nowhere.toml").code, 2);
  EXPECT_TRUE(aircut("explain scatter_too_wide").says("leave the tolerance"));
}

TEST_F(AccuracyCommand, ASweepIsATableAndAPicture) {
  const Outcome run =
      aircut("accuracy " + setup + " --sweep T2.t=1:4:1 --sweep angular=true,false --plot " +
             path("t2.png"));
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(run.out.substr(0, run.out.find('\n')),
            "T2.t,angular,T1.delta_um,T2.delta_um,D1.error_um,D1.low_um,D1.high_um");
  EXPECT_NE(run.out.find("\n1,true,15.9763,"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("\n1,false,10.1287,"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("\n4,true,-7.98453,"), std::string::npos) << run.out;
  EXPECT_EQ(text_of(path("t2.png")).substr(1, 3), "PNG");
  EXPECT_EQ(aircut("accuracy " + setup + " --sweep T2.t=1,2 --plot " + path("t2.png")).code, 2);
  EXPECT_TRUE(aircut("accuracy " + setup + " --sweep T3.t=1,2").says("there is no 'T3.t'"));
  EXPECT_TRUE(aircut("accuracy " + setup + " --sweep T2.t=4:1:1").says("goes up in steps"));
  EXPECT_TRUE(aircut("accuracy " + setup + " --sweep T2.t=a").says("can't be 'a'"));
}

TEST_F(AccuracyCommand, BothToolsOnOneCarriageMoveEachOtherMore) {
  const Outcome run =
      aircut("accuracy " + setup + " --sweep '2.body=carriage 2,carriage 1' --sweep T2.V=150,200");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.out.find("\ncarriage 2,200,15.9763,"), std::string::npos) << run.out;
  EXPECT_EQ(run.out.find("\ncarriage 1,200,15.9763,"), std::string::npos) << run.out;
}

// Figure 5 of the paper, as far as it can be had: every curve of the published vectors.
TEST_F(AccuracyCommand, TheScriptOfFigure5MeetsTheVectors) {
  const std::string root = AIRCUT_SOURCE_DIR;
  const int status =
      std::system((root + "/scripts/make-accuracy-figures " AIRCUT_BINARY_DIR "/bin/aircut " +
                   folder_.string() + " > " + path("5.csv"))
                      .c_str());
  ASSERT_EQ(status, 0);
  for (const char* name : {"accuracy-figure-5.png", "accuracy-opposed.png"})
    EXPECT_EQ(text_of(path(name)).substr(1, 3), "PNG");
  std::map<std::string, double> rows;  // "t2,policy,angular" → µm
  std::stringstream in(text_of(path("5.csv")));
  for (std::string line; std::getline(in, line);) {
    std::stringstream cells(line);
    std::string t, policy, angular, delta;
    std::getline(cells, t, ',');
    std::getline(cells, policy, ',');
    std::getline(cells, angular, ',');
    std::getline(cells, delta, ',');
    if (t != "T2.t") rows[t + "," + policy + "," + angular] = std::stod(delta);
  }
  int compared = 0;
  const json paper = json::parse(text_of(root + "/tests/data/accuracy/paper.json"));
  for (const json& one : paper["figure5_like"]) {
    if (one["kind"] != "non-opposed" || one["policy"] == "abs_diagonal") continue;
    for (std::size_t i = 0; i < one["t2"].size(); ++i, ++compared) {
      const std::string key = std::to_string(one["t2"][i].get<int>()) + "," +
                              one["policy"].get<std::string>() + "," +
                              (one["angular"].get<bool>() ? "true" : "false");
      ASSERT_TRUE(rows.contains(key)) << key;
      const double wanted = one["w1_radial_um"][i];
      EXPECT_NEAR(rows[key], wanted, 1e-5 * std::abs(wanted)) << key;
    }
  }
  EXPECT_EQ(compared, 24);
}

}  // namespace
}  // namespace aircut
