// Several channels at once, as a user runs them.
#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "program.h"

namespace aircut {
namespace {

using nlohmann::json;

class Channels : public Program {
 protected:
  static constexpr const char* head = "G18 G21 G40 G49 G54 G80 G90 G94\nG64 P0.01\n";

  // Two programs on the lathe with two turrets; result.json.
  json twin(const std::string& upper, const std::string& lower, const std::string& more = "") {
    put("upper.ngc", head + upper + "M30\n");
    put("lower.ngc", head + lower + "M30\n");
    last_ = aircut("run -m lathe-twin-turret --channel upper=" + path("upper.ngc") +
                   " --channel lower=" + path("lower.ngc") + " --format json " + more);
    return json::parse(last_.out, nullptr, false);
  }
  static std::vector<json> of_kind(const json& result, const std::string& kind) {
    std::vector<json> out;
    for (const json& finding : result["findings"])
      if (finding["kind"] == kind) out.push_back(finding);
    return out;
  }
  Outcome last_;
};

// Far in: with both turrets there, they overlap by some millimetres.
const char* const in_and_out = "T1 M6\nG43 H1\nG0 X25 Z40\nG4 P1\nG53 G0 X200\nG53 G0 Z0\n";

TEST_F(Channels, TwoTurretsAtOnePlaceAtOneTimeCollide) {
  const json result = twin(in_and_out, in_and_out);
  const auto hits = of_kind(result, "collision");
  ASSERT_FALSE(hits.empty()) << last_.out << last_.err;
  EXPECT_EQ(last_.code, 1);
  bool on_the_way_in = false;
  for (const json& hit : hits) {
    EXPECT_EQ(hit["body_a"], "turret1");
    EXPECT_EQ(hit["body_b"], "turret2");
    EXPECT_EQ(hit["channel"], "upper");
    EXPECT_EQ(hit["other_channel"], "lower");
    on_the_way_in =
        on_the_way_in || (hit["place"]["line"] == 5 && hit["other_place"]["line"] == 5 &&
                          hit["other_place"]["file"].get<std::string>().ends_with("lower.ngc"));
  }
  EXPECT_TRUE(on_the_way_in);
}

TEST_F(Channels, TheSameProgramsAreClearWhenOneWaitsForTheOther) {
  const json result =
      twin(std::string(in_and_out) + "M101 P12\n", std::string("M101 P12\n") + in_and_out);
  EXPECT_EQ(result["verdict"], "pass") << last_.out;
  const json& channels = result["channels"];
  ASSERT_EQ(channels.size(), 2u);
  EXPECT_EQ(channels[0]["channel"], "upper");
  EXPECT_EQ(channels[0]["waiting_s"], 0);
  // The lower one waits for as long as the upper one works, and works as long.
  EXPECT_NEAR(channels[1]["waiting_s"].get<double>(), channels[0]["cycle_time_s"].get<double>(),
              1e-6);
  EXPECT_NEAR(channels[1]["cycle_time_s"].get<double>(),
              2 * channels[0]["cycle_time_s"].get<double>(), 0.01);
}

TEST_F(Channels, WaitsThatNobodyMeetsAreToldAtBothLines) {
  const json result = twin("M101\n", "G4 P1\nM102\n");
  const auto found = of_kind(result, "wait_deadlock");
  ASSERT_EQ(found.size(), 2u) << last_.out;
  EXPECT_EQ(last_.code, 1);
  EXPECT_EQ(found[0]["place"]["line"], 3);
  EXPECT_EQ(found[0]["other_place"]["line"], 4);
  EXPECT_EQ(found[1]["place"]["line"], 4);
  EXPECT_FALSE(result["unchecked"].empty());
}

TEST_F(Channels, AWaitForAChannelThatHasEndedIsADeadlock) {
  const json result = twin("M101 P12\n", "G4 P1\n");
  const auto found = of_kind(result, "wait_deadlock");
  ASSERT_EQ(found.size(), 1u) << last_.out;
  EXPECT_NE(found[0]["message"].get<std::string>().find("lower has ended"), std::string::npos);
}

TEST_F(Channels, OneSpindleAtTwoSpeedsIsAConflict) {
  const json result = twin("S900 M3\nG4 P2\nM5\n", "G4 P1\nS1200 M3\nG4 P2\nM5\n");
  const auto found = of_kind(result, "spindle_conflict");
  ASSERT_FALSE(found.empty()) << last_.out;
  EXPECT_EQ(found[0]["value"], 900);
  EXPECT_EQ(found[0]["limit"], 1200);
  EXPECT_EQ(found[0]["place"]["line"], 4);
  EXPECT_EQ(found[0]["other_place"]["line"], 5);
  EXPECT_TRUE(
      of_kind(twin("S900 M3\nG4 P2\nM101\nM5\n", "S900 M3\nG4 P2\nM101\nM5\n"), "spindle_conflict")
          .empty());
}

TEST_F(Channels, OneAxisThatTwoChannelsMoveIsAConflict) {
  const json result = twin("G0 C90\nG0 C0\n", "G0 C90\nG0 C0\n");
  const auto found = of_kind(result, "axis_conflict");
  ASSERT_FALSE(found.empty()) << last_.out;
  EXPECT_EQ(found[0]["joint"], "C");
  EXPECT_TRUE(
      of_kind(twin("G0 C90\nG0 C0\nM101\n", "M101\nG0 C90\nG0 C0\n"), "axis_conflict").empty());
}

TEST_F(Channels, ARefusedBlockOfOneStopsAll) {
  const json result = twin("G4 P1\nG0 Q9\nG4 P1\n", "G4 P5\nG0 X100\n");
  EXPECT_EQ(last_.code, 1);
  ASSERT_GE(result["unchecked"].size(), 2u) << last_.out;
  EXPECT_EQ(result["timing"]["cycle_time_s"], 1);
}

TEST_F(Channels, AChannelMovesAsItDoesAlone) {
  const std::string one = "programs/lathe-twin-upper.ngc", two = "programs/lathe-twin-lower.ngc";
  ASSERT_EQ(
      aircut("run -q " + one + " -m lathe-twin-turret --frames none --log " + path("alone.csv"))
          .code,
      0);
  const Outcome both =
      aircut("run -m lathe-twin-turret --channel 1=" + one + " --channel lower=" + two +
             " --check limits --frames none --format json -o " + path("out"));
  // Each has its own idea of the spindle's speed, which moves no axis.
  const json result = json::parse(both.out, nullptr, false);
  for (const json& finding : result["findings"]) EXPECT_EQ(finding["kind"], "spindle_conflict");
  // Row by row, without the header and the waits for nobody.
  const Outcome diff = aircut("log diff " + path("alone.csv") + " " + path("out/joints-upper.csv") +
                              " --tolerance 1e-6");
  EXPECT_EQ(diff.code, 0) << diff.out << diff.err;
}

TEST_F(Channels, TwoTurretsTurnOneBar) {
  const Outcome run = aircut(
      "run -m lathe-twin-turret --channel upper=programs/channels/twin-upper.ngc"
      " --channel lower=programs/channels/twin-lower.ngc --format json"
      " --setup programs/channels/twin.setup.toml");
  const json result = json::parse(run.out, nullptr, false);
  EXPECT_EQ(result["verdict"], "pass") << run.out << run.err;
  // From radius 30 to 27.5 over 28; the lift at the end of each pass takes a little more.
  const double taken = M_PI * (30. * 30 - 27.5 * 27.5) * 28;
  EXPECT_NEAR(result["stock"]["removed_mm3"].get<double>(), taken, 0.02 * taken);
}

// The spindle gives way to each turret's thrust. Alone, the upper one leaves what turret and
// spindle give; with the lower one opposite the spindle stays, and only its own turret gives.
TEST_F(Channels, TheSecondTurretChangesTheDiameterOfTheFirst) {
  const Outcome run = aircut(
      "run -q -m lathe-twin-turret --channel upper=programs/accuracy/twin-upper.ngc"
      " --channel lower=programs/accuracy/twin-lower.ngc"
      " --setup programs/channels/twin.setup.toml -t programs/accuracy/twin.tools.toml"
      " --accuracy programs/accuracy/twin.toml --frames none --log null -o " +
      path("out"));
  ASSERT_EQ(run.code, 0) << run.out << run.err;
  std::istringstream rows(text_of(path("out/accuracy.csv")));
  std::string line;
  std::vector<std::string> names;
  std::map<std::string, std::vector<std::map<std::string, double>>> by_segment;
  while (std::getline(rows, line)) {
    std::istringstream cells(line);
    std::map<std::string, double> row;
    std::string cell;
    for (std::size_t i = 0; std::getline(cells, cell, ','); ++i)
      if (by_segment.empty() && !line.empty() && line[0] == 's')
        names.push_back(cell);
      else if (!cell.empty())
        row[names[i]] = std::stod(cell);
    if (!row.empty()) by_segment[line.substr(0, line.find(','))].push_back(row);
  }
  constexpr double turret = 0.014, spindle = 0.010;  // um/N, programs/accuracy/twin.toml
  double alone = 0, both = 0;                        // where all that cut have their whole depth
  for (const auto& [segment, contacts] : by_segment) {
    if (!std::all_of(contacts.begin(), contacts.end(),
                     [](const auto& row) { return row.at("t_mm") > 1.4; }))
      continue;
    for (const auto& row : contacts) {
      if (row.at("tool") != 1) continue;
      const double thrust = std::abs(row.at("F_x_N")), delta = row.at("delta_um");
      if (contacts.size() == 1) {
        EXPECT_GT(delta, (turret + spindle) * thrust);  // and the spindle's tilt
        alone = delta;
      } else {
        EXPECT_NEAR(delta, turret * thrust, 0.05 * delta);
        both = delta;
      }
    }
  }
  EXPECT_GT(both, 3);
  EXPECT_GT(alone, 1.8 * both);
  const json result = json::parse(text_of(path("out/accuracy.json")), nullptr, false);
  EXPECT_EQ(result["tools"].size(), 2U) << result.dump(1).substr(0, 400);
}

TEST_F(Channels, ALatheWithOpposedSpindlesWorksOnBothParts) {
  const Outcome run = aircut(
      "run -q -m lathe-opposed --channel main-upper=programs/lathe-opposed.ngc"
      " --channel sub-lower=programs/lathe-opposed-sub.ngc");
  EXPECT_EQ(run.code, 0) << run.out << run.err;
}

TEST_F(Channels, ASwissLatheTurnsInFrontAndDrillsBehind) {
  const Outcome run = aircut(
      "run -q -m lathe-swiss --channel gang=programs/lathe-swiss.ngc"
      " --channel back=programs/lathe-swiss-back.ngc");
  EXPECT_EQ(run.code, 0) << run.out << run.err;
}

TEST_F(Channels, WrongArgumentsAreToldBeforeAnythingMoves) {
  const std::string one = "programs/lathe-twin-upper.ngc";
  EXPECT_TRUE(aircut("run -m lathe-twin-turret --channel uper=" + one).says("upper"));
  EXPECT_TRUE(aircut("run -m lathe-twin-turret --channel " + one).says("NAME=PROGRAM"));
  EXPECT_TRUE(aircut("run -m lathe-twin-turret " + one + " --channel upper=" + one).says("either"));
  EXPECT_TRUE(aircut("run -m lathe-slant --channel upper=" + one).says("no channels"));
  EXPECT_TRUE(aircut("run -m lathe-twin-turret --channel 1=" + one + " --channel upper=" + one)
                  .says("twice"));
  EXPECT_TRUE(aircut("run -m lathe-twin-turret --channel 1=" + one + " --overrides x.csv")
                  .says("--overrides"));
}

}  // namespace
}  // namespace aircut
