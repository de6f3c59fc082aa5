// Forces of turning and milling: the published vectors, the closed forms against quadrature, and
// simple cases by hand.
#include <numbers>

#include "accuracy/vectors.h"

namespace aircut::accuracy::testing {
namespace {

constexpr double degree = std::numbers::pi / 180;

TEST(TurningForce, PowerLawsMeetTheVectors) {
  const json file = vectors("force");
  const Tolerance tolerance(file["tolerance"]);
  ASSERT_EQ(file["turning_power_law"].size(), 12u);
  for (const json& one : file["turning_power_law"]) {
    SCOPED_TRACE(one["id"].get<std::string>());
    const json& in = one["input"];
    const TurningForce force = turning_force(turning_law(in["law"]), in["t"], in["S"], in["V"]);
    EXPECT_WITHIN(force.cut, one["expect_N"]["cut"], tolerance);
    EXPECT_WITHIN(force.thrust, one["expect_N"]["thrust"], tolerance);
    EXPECT_WITHIN(force.feed, one["expect_N"]["feed"], tolerance);
  }
}

TEST(TurningForce, KienzleAsAPowerLawMeetsTheVectors) {
  const json file = vectors("force");
  const Tolerance tolerance(file["tolerance"]);
  ASSERT_EQ(file["kienzle"].size(), 4u);
  for (const json& one : file["kienzle"]) {
    const json& in = one["input"];
    const double kappa = in["kappa_deg"].get<double>() * degree;
    const PowerTerm law = KienzleTerm{in["kc11"], in["mc"]}.power_law(kappa);
    EXPECT_WITHIN(law.at(in["ap"], in["f"], 123), one["expect"]["Fc_N"], tolerance);
  }
}

TEST(TurningForce, InsideOfTheNoseRadiusTheEnteringAngleIsThatOfTheArc) {
  const double kappa = 95 * degree;
  EXPECT_DOUBLE_EQ(effective_kappa(kappa, 0.8, 2), kappa);
  EXPECT_DOUBLE_EQ(effective_kappa(kappa, 0, 0.001), kappa);
  EXPECT_NEAR(effective_kappa(kappa, 0.8, 0.8), 45 * degree, 1e-12);
  EXPECT_NEAR(effective_kappa(kappa, 0.8, 0.4), 30 * degree, 1e-12);
}

TEST(TurningForce, DirectionsAloneDecideWhetherToolsAreOpposed) {
  // The spindle turns about +Z. Tool 1 turns towards the chuck at +X; tool 2 faces inwards from −X.
  const Vec3 omega = Vec3::UnitZ();
  const auto one = turning_triad(omega, Vec3(40, 0, 0), -Vec3::UnitZ(), Vec3::UnitX());
  const auto two = turning_triad(omega, Vec3(-40, 0, 0), Vec3::UnitX(), Vec3::UnitZ());
  ASSERT_TRUE(one && two);
  EXPECT_EQ(one->cut, Vec3(0, 1, 0));
  EXPECT_EQ(one->thrust, Vec3(1, 0, 0));
  EXPECT_EQ(one->feed, Vec3(0, 0, 1));
  EXPECT_EQ(two->cut, Vec3(0, -1, 0));
  EXPECT_EQ(two->thrust, Vec3(0, 0, 1));
  EXPECT_EQ(two->feed, Vec3(-1, 0, 0));
  EXPECT_FALSE(turning_triad(omega, Vec3(0, 0, 5), Vec3::UnitX(), Vec3::UnitZ()));
}

TEST(TurningCut, MeetsTheVectors) {
  const json file = vectors("process");
  const Tolerance tolerance(file["tolerance"]);
  ASSERT_EQ(file["turning_inputs"].size(), 3u);
  for (const json& one : file["turning_inputs"]) {
    const json &in = one["input"], &out = one["expect"];
    const TurningCut cut =
        longitudinal_cut(in["D_before"], in["D_after"], in["rpm"], in["feed_mm_min"]);
    EXPECT_WITHIN(cut.t, out["t"], tolerance);
    EXPECT_WITHIN(cut.S, out["S"], tolerance);
    EXPECT_WITHIN(cut.V_outer, out["V_outer"], tolerance);
    EXPECT_WITHIN(cut.V_mean, out["V_mean"], tolerance);
    EXPECT_WITHIN(cut.Q, out["Q_mm3_min"], tolerance);
    EXPECT_WITHIN(cut.area, out["area_mm2"], tolerance);
    EXPECT_WITHIN(cut.area / cut.S, out["t_from_area"], tolerance);
  }
}

TEST(TurningCut, FeedLimitsAndRoughnessMeetTheVectors) {
  const json file = vectors("extensions");
  const Tolerance limits(file["feed_limit_turning"]["tolerance"]);
  for (const json& one : file["feed_limit_turning"]["cases"]) {
    const json& in = one["input"];
    const PowerTerm law = turning_law(in["law"]).cut;
    const double by_power = feed_for_power(law, in["t"], in["V"], in["P_kW"], in["eta"]);
    const double by_force = feed_for_force(law, in["t"], in["V"], in["Fc_limit_N"]);
    EXPECT_WITHIN(by_power, one["expect"]["S_power"], limits);
    EXPECT_WITHIN(by_force, one["expect"]["S_force"], limits);
    EXPECT_WITHIN(std::min(by_power, by_force), one["expect"]["S"], limits);
    EXPECT_NEAR(turning_power(law.at(in["t"], by_power, in["V"]), in["V"], in["eta"]), in["P_kW"],
                1e-9);
  }
  const Tolerance rough(file["roughness"]["tolerance"]);
  for (const json& one : file["roughness"]["cases"])
    EXPECT_WITHIN(turned_roughness(one["input"]["S"], one["input"]["r_eps"]) * 1e3,
                  one["expect_Rt_um"], rough);
}

TEST(Drilling, TwoLipsOfHalfTheFeed) {
  // h = 0.1 sin 59° = 0.0857 mm, k_c = 2220 · 0.0857^−0.14 = 3130.5 N/mm².
  const AxialCut cut = drilling({2220, 0.14}, 10, 0.2, 118 * degree, 0.5, 1.0);
  const double k = 2220 * std::pow(0.1 * std::sin(59 * degree), -0.14);
  EXPECT_NEAR(k, 3131, 2);
  EXPECT_NEAR(cut.moment, k * 0.2 * 100 / 8, 1e-9);
  EXPECT_NEAR(cut.force, 0.5 * k * 0.2 * 5, 1e-9);
  EXPECT_NEAR(tapping({2220, 0.14}, 8, 1.25).moment, 2220 * std::pow(1.25, -0.14) * 1.25 * 1.25,
              1e-9);
}

struct MillingCase {
  Cutter cutter;
  MillingCoefficients K;
  MillingCut cut;
};

MillingCase milling_case(const json& in) {
  MillingCase out;
  out.cutter.teeth = in["N"];
  out.cutter.diameter = in["D"];
  out.cutter.helix = in["helix_deg"].get<double>() * degree;
  out.K = coefficients(in.contains("K") ? in["K"] : in);
  out.cut = {in["ap"], in["ft"], engagement(in["D"], in["ae"], milling_mode(in["mode"]))};
  return out;
}

void expect_force(const MillingForce& f, const json& expect, const Tolerance& tolerance) {
  EXPECT_WITHIN(f.force.x(), expect["Fx"], tolerance);
  EXPECT_WITHIN(f.force.y(), expect["Fy"], tolerance);
  EXPECT_WITHIN(f.force.z(), expect["Fz"], tolerance);
  if (expect.contains("Ft_sum")) {
    EXPECT_WITHIN(f.tangential, expect["Ft_sum"], tolerance);
  }
  EXPECT_WITHIN(f.torque / 1e3, expect["torque_Nm"], tolerance);
}

TEST(MillingForce, ClosedFormsMeetTheVectors) {
  const json file = vectors("force");
  const Tolerance tolerance(file["tolerance"]);
  ASSERT_EQ(file["milling"].size(), 4u);
  for (const json& one : file["milling"]) {
    SCOPED_TRACE(one["id"].get<std::string>());
    const auto [cutter, K, cut] = milling_case(one["input"]);
    const json& expect = one["expect"];
    EXPECT_WITHIN(cut.phi.start, expect["phi_st"], tolerance);
    EXPECT_WITHIN(cut.phi.exit, expect["phi_ex"], tolerance);
    const MillingForce mean = mean_force(cutter, K, cut);
    expect_force(mean, expect["avg"], tolerance);
    const double omega = one["input"]["rpm"].get<double>() * 2 * std::numbers::pi / 60;
    EXPECT_WITHIN(mean.torque * omega * 1e-6, expect["avg"]["power_kW"], tolerance);
    EXPECT_WITHIN(thickest_chip(cut), expect["h_max"], tolerance);
    EXPECT_WITHIN(mean_chip(cut), expect["h_mean"], tolerance);
    for (const json& at : expect["instant"])
      expect_force(force_at(cutter, K, cut, at["theta"]), at, tolerance);
  }
}

TEST(MillingForce, QuadratureMeetsTheClosedForms) {
  const json file = vectors("force");
  for (const json& one : file["milling"]) {
    SCOPED_TRACE(one["id"].get<std::string>());
    const auto [cutter, K, cut] = milling_case(one["input"]);
    EdgeLaw law;
    law.constants = K;
    const MillingForce closed = mean_force(cutter, K, cut), sum = mean_force(cutter, law, cut);
    EXPECT_LT((closed.force - sum.force).norm(), 1e-9 * closed.force.norm());
    EXPECT_NEAR(closed.torque, sum.torque, 1e-9 * closed.torque);
    // Of one angle the ends of the engagement fall between points: 1/400 of the edge or less.
    const double size = peak_force(cutter, law, cut).force.norm();
    for (double theta = 0; theta < cutter.pitch(); theta += 0.1)
      EXPECT_LT(
          (force_at(cutter, K, cut, theta).force - force_at(cutter, law, cut, theta).force).norm(),
          0.02 * size);
  }
}

TEST(MillingForce, TheMeanOfAllAnglesIsTheMeanForce) {
  const json file = vectors("force");
  for (const json& one : file["milling"]) {
    const auto [cutter, K, cut] = milling_case(one["input"]);
    Vec3 sum = Vec3::Zero();
    constexpr int steps = 2000;
    for (int i = 0; i < steps; ++i)
      sum += force_at(cutter, K, cut, cutter.pitch() * (i + 0.5) / steps).force / steps;
    const Vec3 mean = mean_force(cutter, K, cut).force;
    EXPECT_LT((sum - mean).norm(), 2e-3 * mean.norm());
  }
}

TEST(MillingForce, BallAndTaperMeetTheVectors) {
  const json file = vectors("force")["general_cutter"];
  const Tolerance tolerance(file["tolerance"]);
  ASSERT_EQ(file["cases"].size(), 3u);
  for (const json& one : file["cases"]) {
    const json& in = one["input"];
    Cutter cutter;
    cutter.shape = in["shape"] == "ball" ? Cutter::Shape::ball : Cutter::Shape::taper;
    cutter.teeth = in["N"];
    cutter.diameter = 2 * in["R_tip"].get<double>();
    cutter.half_angle = in["half_angle_deg"].get<double>() * degree;
    EdgeLaw law;
    law.constants = coefficients(in["K"]);
    const MillingCut cut = {in["ap"], in["ft"], {in["phi_st"], in["phi_ex"]}};
    expect_force(mean_force(cutter, law, cut), one["expect_avg"], tolerance);
  }
}

TEST(MillingForce, KienzleWithoutCurvatureIsAnEdgeWithoutEdgeForce) {
  EdgeLaw kienzle, constants;
  kienzle.kienzle = {1800, 0};
  kienzle.radial_ratio = 0.4;
  kienzle.axial_ratio = 0.1;
  constants.constants = {1800, 720, 180, 0, 0, 0};
  const Cutter cutter{.teeth = 3, .diameter = 12, .helix = 0.5};
  const MillingCut cut{4, 0.08, engagement(12, 5, MillingMode::down)};
  EXPECT_LT(
      (mean_force(cutter, kienzle, cut).force - mean_force(cutter, constants, cut).force).norm(),
      1e-9);
}

TEST(MillingForce, ALeftHandHelixPushesTheToolIntoItsHolder) {
  const MillingCoefficients K{631, 99, 273, 13, 10, 2.8};
  const MillingCut cut{5, 0.06, engagement(12, 12, MillingMode::slot)};
  const Cutter right{.teeth = 3, .diameter = 12, .helix = 0.5};
  Cutter left = right;
  left.helix = -0.5;
  EXPECT_LT(mean_force(right, K, cut).force.z(), 0);
  EXPECT_DOUBLE_EQ(mean_force(left, K, cut).force.z(), -mean_force(right, K, cut).force.z());
  Cutter mirrored = right;
  mirrored.counter_clockwise = true;
  EXPECT_DOUBLE_EQ(mean_force(mirrored, K, cut).force.y(), -mean_force(right, K, cut).force.y());
}

TEST(MillingChip, ThinningMeetsTheVectors) {
  const json file = vectors("extensions")["chip_thinning"];
  const Tolerance tolerance(file["tolerance"]);
  for (const json& one : file["cases"]) {
    const json& in = one["input"];
    const double f_t = feed_for_chip(in["D"], in["ae"], in["h_max"]);
    EXPECT_WITHIN(f_t, one["expect"]["ft"], tolerance);
    EXPECT_WITHIN(f_t * in["N"].get<double>() * in["rpm"].get<double>(),
                  one["expect"]["feed_mm_min"], tolerance);
  }
}

TEST(WallError, MeetsTheVectors) {
  const json file = vectors("extensions")["peripheral_form_error"];
  const Tolerance tolerance(file["tolerance"]);
  ASSERT_EQ(file["cases"].size(), 2u);
  for (const json& one : file["cases"]) {
    const json& in = one["input"];
    const auto [cutter, K, cut] = milling_case(in);
    EdgeLaw law;
    law.constants = K;
    const auto y = wall_error(cutter, law, cut, milling_mode(in["mode"]),
                              {in["stickout"], in["eff_diameter"], in["E"]},
                              in["z_mm"].get<std::vector<double>>());
    for (std::size_t i = 0; i < y.size(); ++i)
      EXPECT_WITHIN(y[i], one["expect_y_mm"][i], tolerance);
  }
}

TEST(Stability, MeetsTheVectors) {
  const json file = vectors("extensions");
  const json& turning = file["stability_turning"];
  EXPECT_WITHIN(
      turning_limit({turning["input"]["k"], 100, turning["input"]["zeta"]}, turning["input"]["Kf"]),
      turning["expect"]["b_lim_min_mm"], Tolerance(turning["tolerance"]));
  const Tolerance tolerance(file["stability_milling"]["tolerance"]);
  for (const json& one : file["stability_milling"]["cases"]) {
    const json& in = one["input"];
    const Mode mode{in["k_N_per_mm"], in["fn_hz"], in["zeta"]};
    for (const json& wanted : one["expect"]) {
      const auto limits =
          milling_limits(in["N"], engagement(in["D"], in["ae"], milling_mode(in["mode"])), in["Kt"],
                         in["Kr"], mode, mode, wanted["fc_hz"], 4);
      // The two roots come in no agreed order: the nearer one is meant.
      ASSERT_FALSE(limits.empty());
      const double depth = wanted["a_lim_mm"];
      const MillingLimit& limit = *std::min_element(
          limits.begin(), limits.end(), [&](const MillingLimit& a, const MillingLimit& b) {
            return std::abs(a.depth - depth) < std::abs(b.depth - depth);
          });
      EXPECT_WITHIN(limit.depth, depth, tolerance);
      EXPECT_WITHIN(limit.eigenvalue.real(), wanted["lambda_re"], tolerance);
      EXPECT_WITHIN(limit.eigenvalue.imag(), wanted["lambda_im"], tolerance);
      EXPECT_WITHIN(limit.kappa, wanted["kappa"], tolerance);
      for (std::size_t q = 0; q < wanted["rpm"].size(); ++q)
        EXPECT_WITHIN(limit.rpm[q], wanted["rpm"][q], tolerance);
    }
  }
}

// All lobes of a dense row of frequencies; of those that nearly meet the speed the lowest.
TEST(Stability, TheDepthAtASpeedIsTheLowestOfAllLobes) {
  const Mode mode{20e3, 600, 0.03};
  for (const MillingMode way : {MillingMode::up, MillingMode::down, MillingMode::slot}) {
    const Engagement phi = engagement(20, way == MillingMode::slot ? 20 : 8, way);
    double least = 1e9;
    for (const double rpm : {2300.0, 4000.0, 7100.0, 12000.0}) {
      double lowest = 1e9;
      for (double hz = 400; hz < 1500; hz += 0.02)
        for (const MillingLimit& limit : milling_limits(4, phi, 700, 0.3, mode, mode, hz, 12)) {
          least = std::min(least, limit.depth);
          for (const double at : limit.rpm)
            if (std::abs(at - rpm) < 5e-4 * rpm) lowest = std::min(lowest, limit.depth);
        }
      const auto found = milling_depth_limit(4, phi, 700, 0.3, mode, rpm);
      ASSERT_TRUE(found);
      EXPECT_NEAR(*found, lowest, 0.015 * lowest) << rpm;
      EXPECT_GE(*found, 0.999 * least);
    }
  }
}

}  // namespace
}  // namespace aircut::accuracy::testing
