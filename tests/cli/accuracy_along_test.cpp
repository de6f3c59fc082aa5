// `aircut run --accuracy`: the shipped examples of a lathe and a mill, against hand formulas that
// share nothing with the program: power law times compliance, closed sums of an end mill.
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "program.h"

namespace aircut {
namespace {

using nlohmann::json;

using Row = std::map<std::string, double>;

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> out;
  std::stringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) out.push_back(cell);
  return out;
}

std::vector<Row> rows_of(const std::string& csv) {
  std::vector<Row> out;
  std::stringstream in(csv);
  std::string line;
  std::getline(in, line);
  const auto names = cells_of(line);
  while (std::getline(in, line)) {
    const auto cells = cells_of(line);
    Row row;
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (!cells[i].empty()) row[names[i]] = std::stod(cells[i]);
    out.push_back(std::move(row));
  }
  return out;
}

struct AccuracyAlong : Program {
  const std::string shaft =
      "run programs/accuracy/shaft.ngc -m lathe-slant --setup programs/lathe-slant.setup.toml "
      "--accuracy ";
  const std::string wall =
      "run programs/accuracy/wall.ngc -m mill3 --setup programs/mill3-block.setup.toml "
      "--accuracy ";
  std::string shipped(const std::string& name) const {
    return text_of(std::string(AIRCUT_SOURCE_DIR) + "/programs/accuracy/" + name);
  }
  std::string with(const std::string& name, const std::string& from, const std::string& to) {
    std::string text = shipped(name);
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    put("changed.toml", text.replace(at, from.size(), to));
    return path("changed.toml");
  }
};

TEST_F(AccuracyAlong, DiametersOfALatheFollowFromThePowerLawAndTheCompliances) {
  const Outcome run =
      aircut(shaft + "programs/accuracy/shaft.toml --frames none -o " + path("out"));
  EXPECT_EQ(run.code, 0) << run.err << run.out;
  int turned = 0;
  for (const Row& row : rows_of(text_of(path("out/accuracy.csv")))) {
    const double line = row.at("line");
    if (line != 16 && line != 20) continue;
    // The bar of 60 to 56, then to 53: X is a radius of 28, then 26.5; F 216 at S 900.
    const double t = line == 16 ? 2 : 1.5, D = line == 16 ? 60 : 56, r = line == 16 ? 28 : 26.5;
    const double S = 216.0 / 900, V = M_PI * D * 900 / 1000;
    if (row.at("S_mm_rev") < 0.999 * S) continue;  // the move begins and ends slower
    ++turned;
    EXPECT_NEAR(row.at("t_mm"), t, 2e-6) << line;
    EXPECT_NEAR(row.at("V_m_min"), V, 1e-5 * V);
    EXPECT_NEAR(row.at("A_x_mm"), r, 1e-4);
    // Volume and geometry of the cut agree, but for a ray at the end of a short stretch.
    const double way = 3.6 * (row.at("t1_s") - row.at("t0_s"));
    EXPECT_NEAR(row.at("area_mm2"), t * S, (1e-3 + 0.04 / way) * t * S);
    const double cut = 3000 * t * std::pow(S, 0.75) * std::pow(V, -0.15);
    const double thrust = 2430 * std::pow(t, 0.9) * std::pow(S, 0.6) * std::pow(V, -0.3);
    const double feed = 3390 * t * std::pow(S, 0.5) * std::pow(V, -0.4);
    EXPECT_NEAR(row.at("F_cut_N"), cut, 1e-5 * cut);
    EXPECT_NEAR(row.at("F_x_N"), thrust, 1e-5 * thrust);
    EXPECT_NEAR(row.at("F_y_N"), cut, 1e-5 * cut);
    EXPECT_NEAR(row.at("F_z_N"), feed, 1e-5 * feed);
    EXPECT_NEAR(row.at("power_kW"), cut * V / 60000 / 0.85, 1e-5);
    // Radially: both bodies, and the tilt about Y of the spindle by the moment z F_x − x F_z.
    const double z = row.at("A_z_mm") + 640;
    const double tilt = 2e-7 * 1e-3 * (z * thrust - r * feed);
    const double delta = 1e3 * ((0.010 + 0.014) * 1e-3 * thrust + tilt * z);
    EXPECT_NEAR(row.at("delta_um"), delta, 2e-4 * delta) << line;
    // Stiffness 20 % wide, strength 10 %, depth 0.1 mm; the slope by differences.
    const auto at = [&](double depth) {
      const double P = 2430 * std::pow(depth, 0.9) * std::pow(S, 0.6) * std::pow(V, -0.3);
      const double F = 3390 * depth * std::pow(S, 0.5) * std::pow(V, -0.4);
      return 1e3 * (0.024e-3 * P + 2e-10 * (z * P - r * F) * z);
    };
    const double half = 0.05 * (at(t + 1e-4) - at(t - 1e-4)) / 2e-4;
    EXPECT_NEAR(row.at("scatter_low_um"), 0.85 * (delta - half), 2e-3 * delta);
    EXPECT_NEAR(row.at("scatter_high_um"), 1.15 * (delta + half), 2e-3 * delta);
  }
  EXPECT_GT(turned, 40);
  const json result = json::parse(text_of(path("out/result.json")));
  EXPECT_EQ(result["accuracy"]["verdict"], "pass");
  EXPECT_NEAR(result["accuracy"]["dimensions"][0]["error_max_um"].get<double>(), 17.6, 0.1);
  const json& tool = result["accuracy"]["tools"][0];
  double sum = 0;
  for (const json& share : tool["split"]) sum += share["delta_mean_um"].get<double>();
  EXPECT_NEAR(sum, tool["delta_mean_um"].get<double>(), 1e-9);
  for (const char* name : {"accuracy-time.png", "accuracy-path.png"})
    EXPECT_EQ(text_of(path("out/") + name).substr(1, 3), "PNG");
  EXPECT_NE(text_of(path("out/report.html")).find("accuracy-time.png"), std::string::npos);
  EXPECT_TRUE(run.says("size diameter 53")) << run.out;
}

TEST_F(AccuracyAlong, TheWallOfAMillFollowsFromTheClosedSumsOfItsEndMill) {
  const Outcome run = aircut(wall + "programs/accuracy/wall.toml --frames none -o " + path("out"));
  EXPECT_EQ(run.code, 0) << run.err << run.out;
  const double rod = std::pow(36.0, 3) / (3 * 600000 * M_PI * std::pow(8.0, 4) / 64);  // mm/N
  const double give = 0.035e-3 + rod;
  int milled = 0;
  for (const Row& row : rows_of(text_of(path("out/accuracy.csv")))) {
    const bool climb = row.at("line") == 19;
    const double a_e = climb ? 2 : 1;     // the first pass leaves 2 mm of it
    if (row.at("t_mm") < 1.99) continue;  // it goes in or out
    ++milled;
    EXPECT_NEAR(row.at("t_mm"), 2, 0.02);
    EXPECT_NEAR(row.at("width_mm"), a_e, 0.1);  // half a cell of the stock
    EXPECT_NEAR(row.at("S_mm_rev"), 0.15, 1e-4);
    EXPECT_NEAR(row.at("A_x_mm"), 0, 1e-9) << "the table moves, the spindle stays";
    // K in N/mm², N/mm; three teeth, 0.05 mm each.
    const double c = row.at("S_mm_rev") / 3;
    const auto force = [&](double a, double width) {
      const double alpha = std::acos(1 - 2 * width / 10);
      const double from = climb ? M_PI - alpha : 0, to = climb ? M_PI : alpha;
      const auto y = [&](double phi) {
        return 3 * a * c / (8 * M_PI) *
                   (631 * (2 * phi - std::sin(2 * phi)) + 99 * std::cos(2 * phi)) -
               3 * a / (2 * M_PI) * (13 * std::cos(phi) + 10 * std::sin(phi));
      };
      return y(to) - y(from);
    };
    // Left of a tool that goes to +X is +Y. Both walls look towards +Y.
    const double left = force(row.at("t_mm"), row.at("width_mm"));
    const double wall_force = climb ? left : -left;
    EXPECT_NEAR(row.at("F_y_N"), wall_force, 2e-4 * std::abs(left));
    EXPECT_NEAR(row.at("delta_um"), 1e3 * give * wall_force, 1e-3 * std::abs(1e3 * give * left));
    EXPECT_NEAR(row.at("F_y_N"), climb ? force(2, 2) : -force(2, 1), 0.08 * std::abs(left));
  }
  EXPECT_GT(milled, 110);
}

TEST_F(AccuracyAlong, WhatIsOverALimitOrUnknownIsToldWithItsLine) {
  const Outcome over = aircut(shaft + with("shaft.toml", "Fc_N = 3000", "Fc_N = 900"));
  EXPECT_EQ(over.code, 1);
  EXPECT_TRUE(over.says("error[force_limit]: the cutting force of T1 is 952.5")) << over.out;
  EXPECT_TRUE(over.says("shaft.ngc:16:1")) << over.out;
  const Outcome size = aircut(shaft + with("shaft.toml", "[0, 0.046]", "[0, 0.010]"));
  EXPECT_EQ(size.code, 1);
  EXPECT_TRUE(size.says("error[size_error]: the size 'diameter 53'")) << size.out;
  EXPECT_TRUE(size.says("shaft.ngc:20:1")) << size.out;
  const Outcome batch = aircut(shaft + with("shaft.toml", "[0, 0.046]", "[0, 0.018]"));
  EXPECT_TRUE(batch.says("error[scatter_too_wide]")) << batch.out;
  const Outcome unknown = aircut(shaft + with("shaft.toml", "law = \"steel45\"\n", ""));
  EXPECT_EQ(unknown.code, 2);
  EXPECT_TRUE(unknown.says("the force of T1 is not known: it has no 'law'")) << unknown.out;
  EXPECT_TRUE(unknown.says("warning[force_unknown]")) << unknown.out;
  EXPECT_TRUE(unknown.says("shaft.ngc:12:1")) << unknown.out;
  const Outcome moved = aircut(wall + with("wall.toml", "deflection_um = 50", "deflection_um = 1"));
  EXPECT_EQ(moved.code, 1);
  EXPECT_TRUE(moved.says("error[deflection]")) << moved.out;
}

TEST_F(AccuracyAlong, ACutDeeperThanItsVibrationsAllowIsWarnedOf) {
  const auto mode = [&](const std::string& file, double stiffness) {
    return with(file, "version = 1\n",
                "version = 1\nmode = { frequency_Hz = 400, stiffness_N_um = " +
                    std::to_string(stiffness) + ", damping = 0.03 }\n");
  };
  // 2 k ζ (1 + ζ) / K is the chip's width, K the force per chip area at S = 0.24 and the bar of 60
  // mm.
  const double K = 3000 * std::pow(0.24, -0.25) * std::pow(M_PI * 54, -0.15);
  const double width = 2 * 20e3 * 0.03 * 1.03 / K;
  char depth[32];
  std::snprintf(depth, sizeof depth, "from %.2f mm on", width * std::sin(95 * M_PI / 180));
  const Outcome soft = aircut(shaft + mode("shaft.toml", 20));
  EXPECT_EQ(soft.code, 0) << soft.out;
  EXPECT_TRUE(soft.says("warning[chatter_risk]: T1 cuts 2.00 mm deep")) << soft.out;
  EXPECT_TRUE(soft.says(depth)) << depth << soft.out;
  EXPECT_TRUE(soft.says("shaft.ngc:16:1")) << soft.out;
  EXPECT_FALSE(aircut(shaft + mode("shaft.toml", 2000)).says("chatter_risk"));
  EXPECT_TRUE(aircut(wall + mode("wall.toml", 0.1)).says("warning[chatter_risk]: T1 cuts 2"));
  EXPECT_FALSE(aircut(wall + mode("wall.toml", 2000)).says("chatter_risk"));
  const Outcome wrong = aircut(
      shaft + with("shaft.toml", "version = 1\n", "version = 1\nmode = { frequency_Hz = 400 }\n"));
  EXPECT_EQ(wrong.code, 2);
  EXPECT_TRUE(wrong.says("stiffness_N_um")) << wrong.out << wrong.err;
}

TEST_F(AccuracyAlong, ADepthThatIsNotAtRestIsTold) {
  // The tool is pushed out, and a joint that answers the wrong way round pulls it in.
  std::string text = shipped("shaft.toml");
  const std::string version = "version = 1\n", turret = "e = [[0.014,";
  text.replace(text.find(version), version.size(),
               "version = 1\ncoupled = true\nsign_policy = \"as_given\"\n");
  text.replace(text.find(turret), turret.size(), "e = [[-30,");
  put("digs.toml", text);
  const Outcome digs = aircut(shaft + path("digs.toml"));
  EXPECT_EQ(digs.code, 1);
  EXPECT_TRUE(digs.says("error[statically_unstable]: the force pulls T1 deeper")) << digs.out;
  EXPECT_TRUE(digs.says("shaft.ngc:")) << digs.out;
}

TEST_F(AccuracyAlong, AWrongFileStopsThisStageAlone) {
  const Outcome wrong = aircut(shaft + with("shaft.toml", "link = \"slide\"", "link = \"slid\""));
  EXPECT_EQ(wrong.code, 2);
  EXPECT_TRUE(wrong.says("changed.toml:18:8")) << wrong.out;
  EXPECT_TRUE(wrong.says("the machine has no link 'slid'")) << wrong.out;
  EXPECT_TRUE(wrong.says("proven clear")) << "collisions were looked at all the same";
  const Outcome key = aircut(shaft + with("shaft.toml", "version = 1", "version = 1\nspeed = 2"));
  EXPECT_EQ(key.code, 2);
  EXPECT_TRUE(key.says("error[accuracy_invalid]")) << key.out;
  EXPECT_EQ(aircut(shaft + "nowhere.toml").code, 2);
  // The part is the same, bit for bit, with and without this stage.
  const std::string job =
      "run programs/accuracy/wall.ngc -m mill3 --setup programs/mill3-block.setup.toml --part ";
  EXPECT_EQ(aircut(job + path("a.stl")).code, 0);
  EXPECT_EQ(aircut(job + path("b.stl") + " --accuracy programs/accuracy/wall.toml").code, 0);
  EXPECT_EQ(text_of(path("a.stl")), text_of(path("b.stl")));
}

// Of accuracy-part.ply: places with their errors in µm; not a number where none is predicted.
std::vector<std::array<float, 4>> places_of(const std::string& ply) {
  std::vector<std::array<float, 4>> out;
  const std::size_t at = ply.find("element vertex "), begin = ply.find("end_header\n");
  if (at == std::string::npos || begin == std::string::npos) return out;
  out.resize(std::stoul(ply.substr(at + 15)));
  for (std::size_t i = 0; i < out.size(); ++i)
    std::memcpy(out[i].data(), ply.data() + begin + 11 + i * 19, 16);
  return out;
}

TEST_F(AccuracyAlong, ThePartIsColouredByTheCutThatMadeEachPlace) {
  EXPECT_EQ(aircut(shaft + "programs/accuracy/shaft.toml --frames at=1 -o " + path("out")).code, 0);
  EXPECT_EQ(text_of(path("out/accuracy-part.png")).substr(1, 3), "PNG");
  EXPECT_NE(text_of(path("out/report.html")).find("accuracy-part.png"), std::string::npos);
  std::size_t turned = 0, known = 0, bar = 0;
  // Half of what the size 'diameter 53' is off; the bar of 60 was not touched.
  for (const auto& [x, y, z, error] : places_of(text_of(path("out/accuracy-part.ply")))) {
    const double radius = std::hypot(x, y);
    if (std::abs(radius - 26.5) < 0.02 && z > 112.5 && z < 166) {
      ++turned;
      if (std::isnan(error)) continue;
      ++known;
      EXPECT_GT(error, 7.9) << x << ' ' << y << ' ' << z;
      EXPECT_LT(error, 8.9) << x << ' ' << y << ' ' << z;
    } else if (std::abs(radius - 30) < 0.02 && z < 100) {
      ++bar;
      EXPECT_TRUE(std::isnan(error)) << z;
    }
  }
  EXPECT_GT(bar, 1000);
  EXPECT_GT(turned, 1000);
  EXPECT_GT(known, 0.999 * static_cast<double>(turned));
  EXPECT_EQ(aircut(wall + "programs/accuracy/wall.toml --frames none -o " + path("wall")).code, 0);
  EXPECT_FALSE(std::filesystem::exists(path("wall/accuracy-part.png")));
  std::size_t climbed = 0;
  for (const auto& [x, y, z, error] : places_of(text_of(path("wall/accuracy-part.ply")))) {
    // Y 41.9 less the radius; clear of the ends, the edges and the floor.
    if (std::abs(y - 36.9) > 0.25 || std::abs(x) > 40 || z < 48.3 || z > 49.7) continue;
    ++climbed;
    EXPECT_NEAR(error, 3.4, 0.15) << x << ' ' << z;
  }
  EXPECT_GT(climbed, 50);
}

}  // namespace
}  // namespace aircut
