// Measured matrices, the paper's tables, made bodies, and the coupled depth.
#include <numbers>

#include "accuracy/vectors.h"
#include "base/random.h"

namespace aircut::accuracy::testing {
namespace {

constexpr std::array<std::pair<const char*, SignPolicy>, 4> policies = {
    {{"as_given", SignPolicy::as_given},
     {"row_flip", SignPolicy::row_flip},
     {"column_flip", SignPolicy::column_flip},
     {"abs_diagonal", SignPolicy::abs_diagonal}}};

// The tables of the paper under a policy, in the library's units.
struct PaperTables {
  Compliance spindle, carriage;
};

PaperTables tables(const json& paper, SignPolicy policy) {
  std::vector<std::string> changes;
  const auto repair = [&](const char* name) {
    return repaired(mat3(paper["tables"][name]) * 1e-3, {policy, false, false}, changes);
  };
  return {{repair("e0_um_per_N"), Mat3::Zero(), repair("xi0_rad_per_Nm")},
          {repair("e1_um_per_N"), Mat3::Zero(), repair("xi1_rad_per_Nm_resolved")}};
}

TEST(Matrices, SignPoliciesMeetThePaper) {
  const json paper = vectors("paper");
  for (const auto& [name, policy] : policies) {
    SCOPED_TRACE(name);
    const PaperTables t = tables(paper, policy);
    const json& wanted = paper["sign_policy"][name];
    EXPECT_LT((t.spindle.e * 1e3 - mat3(wanted["e0"])).norm(), 1e-15);
    EXPECT_LT((t.carriage.e * 1e3 - mat3(wanted["e1"])).norm(), 1e-15);
    EXPECT_LT((t.spindle.xi * 1e3 - mat3(wanted["xi0"])).norm(), 1e-18);
    EXPECT_LT((t.carriage.xi * 1e3 - mat3(wanted["xi1"])).norm(), 1e-18);
    const json& values = paper["eigenvalues_of_symmetric_part"];
    const auto expect = [&](const Mat3& A, const json& list, double size) {
      EXPECT_LT((passivity(A * 1e3).eigenvalues - vec3(list)).norm(), 1e-9 * size);
    };
    expect(t.spindle.e, values["e0_um_per_N"][name], 0.05);
    expect(t.carriage.e, values["e1_um_per_N"][name], 0.01);
    expect(t.spindle.xi, values["xi0"][name], 6e-6);
    expect(t.carriage.xi, values["xi1"][name], 6e-7);
  }
}

TEST(Matrices, OnlyARepairedTableOfThePaperIsPassive) {
  const json paper = vectors("paper");
  EXPECT_FALSE(passivity(tables(paper, SignPolicy::as_given).spindle.e).passive());
  EXPECT_TRUE(passivity(tables(paper, SignPolicy::row_flip).spindle.e).passive());
  EXPECT_TRUE(passivity(tables(paper, SignPolicy::row_flip).carriage.e).passive());
  const Mat3 xi1 = tables(paper, SignPolicy::row_flip).carriage.xi;
  EXPECT_FALSE(passivity(xi1).passive());  // one eigenvalue stays at −0.15e-6
  std::vector<std::string> changes;
  const Mat3 projected = repaired(xi1, {SignPolicy::as_given, true, true}, changes);
  EXPECT_EQ(changes.size(), 2u);
  EXPECT_TRUE(passivity(projected).passive());
  EXPECT_LT(passivity(projected).asymmetry, 1e-15);
  EXPECT_GT(passivity(xi1).asymmetry, 0.5);
}

TEST(Matrices, TheFrameOfThePaperIsARotation) {
  const json paper = vectors("paper");
  const Mat3 P = mat3(paper["frame"]["model_from_table"]);
  EXPECT_NEAR(P.determinant(), 1, 1e-15);
  EXPECT_EQ(P * vec3(paper["frame"]["example"]["table_vector"]),
            vec3(paper["frame"]["example"]["model_vector"]));
  const PaperTables t = tables(paper, SignPolicy::as_given);
  EXPECT_LT((rotated(t.spindle, P).e * 1e3 - mat3(paper["frame"]["e0_model"])).norm(), 1e-15);
  EXPECT_LT((rotated(t.carriage, P).e * 1e3 - mat3(paper["frame"]["e1_model"])).norm(), 1e-15);
}

TEST(Matrices, TheBenchTestOfThePaperGivesItsAngle) {
  const json paper = vectors("paper");
  const Tolerance tolerance(paper["tolerance"]);
  std::vector<double> moments, angles;
  for (const json& row : paper["table2"]) {
    moments.push_back(row["M_Nm"]);
    angles.push_back(probe_angle(row["d1_mm"], row["d2_mm"], row["L_mm"]));
    EXPECT_NEAR(angles.back() * 1e3, row["theta_mrad"], 1e-9);
    EXPECT_NEAR(angles.back() / moments.back(), row["xi_rad_per_Nm"], 1e-9 * 6e-6);
  }
  EXPECT_WITHIN(fit_through_zero(moments, angles), paper["table2_fit"]["lsq_through_zero"],
                Tolerance(json{{"rel", 1e-9}}));
  EXPECT_DOUBLE_EQ(hysteresis(std::vector{1.0, 2.0}, std::vector{1.2, 2.0}), 0.1);
  EXPECT_EQ(it_tolerance(paper["it12"]["size_mm"], 12).value() * 1e3, paper["it12"]["it12_um"]);
}

TEST(Matrices, EveryCurveLikeFigure5IsMet) {
  const json paper = vectors("paper");
  const Tolerance tolerance(paper["tolerance"]);
  const json forces = vectors("force")["turning_power_law"];
  const TurningLaw law = turning_law(forces[0]["input"]["law"]);
  ASSERT_EQ(paper["figure5_like"].size(), 24u);
  for (const json& one : paper["figure5_like"]) {
    SCOPED_TRACE(one.dump());
    const auto policy = std::find_if(policies.begin(), policies.end(),
                                     [&](const auto& p) { return one["policy"] == p.first; });
    const PaperTables t = tables(paper, policy->second);
    const bool opposed = one["kind"] == "opposed", across = one["A2"] == "opposite side";
    const Vec3 A1(37.45, 0, 74.9), A2 = across ? Vec3(-37.45, 0, 74.9) : A1;
    std::vector<Body> bodies(3);
    bodies[0].compliance = t.spindle;
    bodies[1].compliance = bodies[2].compliance = t.carriage;
    bodies[1].base_point = A1 - Vec3(130, 0, 136);
    bodies[2].base_point = across ? Vec3(92.55, 0, -61.1) : bodies[1].base_point;
    if (!one["angular"].get<bool>())
      for (Body& body : bodies) body.compliance.xi.setZero();
    const Influence E = Structure(bodies).assemble(std::vector<Contact>{{1, 0, A1}, {2, 0, A2}});
    const Vec3 axial = Vec3::UnitZ(), radial = Vec3::UnitX(), tangential = Vec3::UnitY();
    const Triad first{tangential, radial, axial};
    // Tool 2 faces, so its thrust is axial and its feed force radial; when it is not opposed, they
    // point as those of tool 1 do.
    const Triad second =
        opposed ? Triad{-tangential, axial, -radial} : Triad{tangential, axial, radial};
    const double t1 = one["t1"];
    for (std::size_t i = 0; i < one["t2"].size(); ++i) {
      const double t2 = one["t2"][i];
      const Vec3 w = E.E(0, 0) * depth_force(law, first, 0.24, 200).force(t1) +
                     E.E(0, 1) * depth_force(law, second, 0.24, 200).force(t2);
      EXPECT_WITHIN(w.x() * 1e3, one["w1_radial_um"][i], tolerance);
      EXPECT_WITHIN(size_error(SizeKind::outside_diameter, w.x()) * 1e3,
                    one["diameter_error_um"][i], tolerance);
    }
  }
}

TEST(Matrices, ACantileversCentreOfComplianceIsItsMiddle) {
  Rod rod{.length = 60, .diameter = 10, .youngs_modulus = 210000};
  rod.clamp = Vec3(5, 6, 7);
  const Body body = rod_body(rod);
  const Vec3 tip = rod.clamp + 60 * rod.axis;
  const double EI = 210000 * std::numbers::pi * 1e4 / 64;
  EXPECT_NEAR(body_influence(body, tip, tip)(0, 0), 60 * 60 * 60 / (3 * EI), 1e-15);
  const Compliance at_clamp = shifted(body.compliance, rod.clamp - body.base_point);
  EXPECT_GT(at_clamp.c.norm(), 1e-9);
  const CentreOfCompliance centre = centre_of_compliance(at_clamp);
  EXPECT_LT((centre.shift - 30 * rod.axis).norm(), 1e-9);
  EXPECT_LT(centre.residual, 1e-15);
}

TEST(Matrices, AStepThatIsNoStepIsOneRod) {
  Rod rod{.length = 60, .diameter = 10, .youngs_modulus = 210000};
  const std::vector<RodStep> steps = {{20, 10, 210000}, {40, 10, 210000}};
  std::vector<Body> bodies = stepped_bodies(rod, steps);
  ASSERT_EQ(bodies.size(), 2u);
  EXPECT_EQ(bodies[1].parent, 0);
  bodies.push_back({});  // a rigid work
  const Vec3 tip(0, 0, 60);
  const Influence E = Structure(bodies).assemble(std::vector<Contact>{{1, 2, tip}});
  const Mat6 whole = body_influence(rod_body(rod), tip, tip);
  EXPECT_LT((E.block(0, 0) - whole).norm(), 1e-12 * whole.norm());
}

TEST(Matrices, SupportsInParallelShareTheLoad) {
  Compliance a, b;
  a.e = Vec3(2e-5, 3e-5, 4e-5).asDiagonal();
  a.xi = Vec3(1e-9, 2e-9, 3e-9).asDiagonal();
  b.e = Vec3(2e-5, 6e-5, 4e-5).asDiagonal();
  b.xi = Vec3(1e-9, 2e-9, 6e-9).asDiagonal();
  const auto both = in_parallel(a, b);
  ASSERT_TRUE(both);
  EXPECT_LT((both->e.diagonal() - Vec3(1e-5, 2e-5, 2e-5)).norm(), 1e-17);
  EXPECT_LT((both->xi.diagonal() - Vec3(0.5e-9, 1e-9, 2e-9)).norm(), 1e-21);
  b.xi.setZero();
  EXPECT_FALSE(in_parallel(a, b));
}

TEST(Beams, MeetTheVectors) {
  const json file = vectors("extensions")["work_beam"];
  const Tolerance tolerance(file["tolerance"]);
  ASSERT_EQ(file["cases"].size(), 3u);
  for (const json& one : file["cases"]) {
    const json &in = one["input"], &out = one["expect_G_mm_per_N"];
    for (const auto& [name, held] : {std::pair{"chuck", Held::chuck},
                                     {"chuck_centre", Held::chuck_centre},
                                     {"centres", Held::centres}}) {
      SCOPED_TRACE(name);
      Beam beam = round_beam(in["l"], in["d"], in["E"], held);
      beam.e_clamp = in["e_A"];
      beam.e_centre = in["e_B"];
      EXPECT_WITHIN(influence(beam, in["x"], in["a"]).deflection, out[name], tolerance);
    }
  }
}

TEST(Beams, SlopesAreTheDerivativesAndInfluenceIsMutual) {
  Random random(5);
  for (const Held held : {Held::chuck, Held::chuck_centre, Held::centres})
    for (int run = 0; run < 20; ++run) {
      Beam beam;
      beam.sections = {{60, 1e9}, {110, 4e9}, {200, 2e9}};
      beam.held = held;
      beam.e_clamp = 1e-5;
      beam.e_centre = 3e-5;
      const double x = random.between(1, 199), a = random.between(1, 199), d = 1e-3;
      const BeamInfluence g = influence(beam, x, a), back = influence(beam, a, x);
      EXPECT_NEAR(g.deflection, back.deflection, 1e-15);
      EXPECT_NEAR(g.slope, back.load_slope, 1e-17);
      const auto derivative = [&](double BeamInfluence::*of, double dx, double da) {
        return (influence(beam, x + dx, a + da).*of - influence(beam, x - dx, a - da).*of) /
               (2 * d);
      };
      EXPECT_NEAR(g.slope, derivative(&BeamInfluence::deflection, d, 0), 1e-6 * 1e-5);
      EXPECT_NEAR(g.load_slope, derivative(&BeamInfluence::deflection, 0, d), 1e-6 * 1e-5);
      EXPECT_NEAR(g.cross_slope, derivative(&BeamInfluence::slope, 0, d), 1e-6 * 1e-6);
    }
}

TEST(Copying, MeetsTheVectors) {
  const json file = vectors("extensions")["error_copying"];
  const Tolerance tolerance(file["tolerance"]);
  ASSERT_EQ(file["cases"].size(), 3u);
  for (const json& one : file["cases"]) {
    const json &in = one["input"], &out = one["expect"];
    CopyingProblem problem;
    problem.t0 = in["t0"].get<std::vector<double>>();
    const Triad axes{Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};  // cut, thrust, feed
    const DepthForce force = depth_force(turning_law(in["law"]), axes, in["S"], in["V"]);
    for (const json& row : in["g_mm_per_N"]) {
      problem.shares.emplace_back();
      for (const json& g : row)
        problem.shares.back().push_back(tool_share(force, vec3(g), Vec3::Zero(), 0, 0));
    }
    const CopyingResult result = solve_copying(problem);
    EXPECT_TRUE(result.converged);
    for (std::size_t k = 0; k < problem.t0.size(); ++k) {
      EXPECT_WITHIN(result.t[k], out["t"][k], tolerance);
      EXPECT_WITHIN(result.w[k], out["w_mm"][k], tolerance);
    }
    if (out.contains("copy_ratio")) {
      EXPECT_WITHIN(result.ratio(0, 0), out["copy_ratio"], tolerance);
    }
  }
}

TEST(Copying, FindsTheDepthOfASoftMachineNearZeroAndOfAToolThatIsPushedOut) {
  // t + 5 t^0.2 = 1: a whole Newton step from t = 1 leads below 0, where there is no force.
  ToolShare soft;
  soft.gain = {5, 0, 0};
  soft.exponent = {0.2, 1, 1};
  const CopyingResult result = solve_copying({{1.0}, {{soft}}});
  ASSERT_TRUE(result.converged);
  EXPECT_NEAR(result.t[0] + 5 * std::pow(result.t[0], 0.2), 1, 1e-8);
  // Tool 2 pushes tool 1 away by 3 mm: it does not cut at all.
  ToolShare none, push;
  push.gain = {3, 0, 0};
  push.exponent = {1, 1, 1};
  const CopyingResult out = solve_copying({{1.0, 1.0}, {{soft, push}, {none, none}}});
  ASSERT_TRUE(out.converged);
  EXPECT_NEAR(out.t[0], -2, 1e-9);
  EXPECT_NEAR(out.t[1], 1, 1e-9);
}

TEST(Copying, ADisplacementIntoTheWorkThatRunsAwayIsUnstable) {
  ToolShare dig;
  dig.gain = {-1.5, 0, 0};
  dig.exponent = {1, 1, 1};
  const CopyingResult result = solve_copying({{2.0}, {{dig}}});
  EXPECT_TRUE(result.unstable);
  EXPECT_FALSE(result.converged);
  EXPECT_DOUBLE_EQ(result.w[0], -3.0);  // the uncoupled displacement
}

TEST(Sizes, KindsCountTheNormalErrorAsTheyAreMeasured) {
  EXPECT_DOUBLE_EQ(size_error(SizeKind::outside_diameter, 0.01), 0.02);
  EXPECT_DOUBLE_EQ(size_error(SizeKind::bore_diameter, 0.01), -0.02);
  EXPECT_DOUBLE_EQ(size_error(SizeKind::length, 0.01), 0.01);
  // R = 5 mm, 10 µm out and 100 µm along: √(5.01² + 0.1²) − 5.
  EXPECT_NEAR(
      normal_error_exact(Vec3::UnitX(), Vec3::UnitZ(), Vec3(5, 0, 30), Vec3(0.01, 0.1, 0.5)),
      std::hypot(5.01, 0.1) - 5, 1e-15);
  EXPECT_NEAR(
      normal_error_exact(Vec3::UnitZ(), Vec3::UnitZ(), Vec3(5, 0, 30), Vec3(0.01, 0.1, 0.5)), 0.5,
      1e-15);
}

}  // namespace
}  // namespace aircut::accuracy::testing
