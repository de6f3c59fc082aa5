// Fields of scatter: the published vectors, and random samples that must stay inside.
#include <cstdlib>

#include "accuracy/vectors.h"
#include "base/random.h"

namespace aircut::accuracy::testing {
namespace {

const char* case_name(FieldCase which) {
  return which == FieldCase::all_positive ? "I" : which == FieldCase::all_negative ? "II" : "III";
}

TEST(Scatter, TheLinearFieldMeetsTheVectors) {
  const json file = vectors("scatter");
  const Tolerance tolerance(file["tolerance"]);
  ASSERT_EQ(file["closed_form"].size(), 15u);
  for (const json& one : file["closed_form"]) {
    SCOPED_TRACE(one["id"].get<std::string>());
    const json &in = one["input"], &out = one["expect"];
    const auto a = in["a_um"].get<std::vector<double>>();
    const auto b = in["b_um_per_mm"].get<std::vector<double>>();
    const auto dt = in["dt_mm"].get<std::vector<double>>();
    const LinearField field = linear_field(a, b, dt, {in["epsilon"], in["nu"]});
    EXPECT_EQ(case_name(field.which), out["case"]);
    EXPECT_WITHIN(field.N, out["N"], tolerance);
    EXPECT_WITHIN(field.D, out["D"], tolerance);
    EXPECT_WITHIN(field.low, out["w_min"], tolerance);
    EXPECT_WITHIN(field.high, out["w_max"], tolerance);
    EXPECT_WITHIN(field.width, out["field"], tolerance);
  }
}

struct Batch {
  Case machine;
  std::vector<DepthForce> forces;
  std::vector<double> t, dt;
  Bands bands;
};

Batch read_batch(const json& input) {
  Batch out;
  out.machine = read_case(input);
  out.bands = {input["epsilon"], input["nu"]};
  for (const json& j : input["contacts"]) {
    const json& d = j["triad"];
    out.forces.push_back(depth_force(turning_law(j["law"]),
                                     {vec3(d["cut"]), vec3(d["thrust"]), vec3(d["feed"])}, j["S"],
                                     j["V"]));
    out.t.push_back(j["t"]);
    out.dt.push_back(j["dt"]);
  }
  return out;
}

std::vector<ToolShare> shares(const Batch& batch, const Influence& E, std::size_t k, int axis) {
  std::vector<ToolShare> out;
  for (std::size_t l = 0; l < batch.forces.size(); ++l)
    out.push_back(
        tool_share(batch.forces[l], E.E(k, l).row(axis), Vec3::Zero(), batch.t[l], batch.dt[l]));
  return out;
}

TEST(Scatter, FromForcesToFieldsMeetsTheVectors) {
  const json file = vectors("scatter");
  const Tolerance tolerance(file["tolerance"]);
  Tolerance exact = tolerance;
  exact.relative = file["tolerance"]["exact_mode_rel"];
  ASSERT_EQ(file["end_to_end"].size(), 10u);
  for (const json& one : file["end_to_end"]) {
    SCOPED_TRACE(one["id"].get<std::string>());
    const Batch batch = read_batch(one["input"]);
    const Influence E = Structure(batch.machine.bodies).assemble(batch.machine.contacts);
    for (std::size_t l = 0; l < batch.forces.size(); ++l)
      EXPECT_LT((batch.forces[l].force(batch.t[l]) - batch.machine.loads[l].force).norm(), 1e-9);
    for (std::size_t k = 0; k < batch.forces.size(); ++k)
      for (int axis = 0; axis < 3; ++axis) {
        const json& out = one["expect"]["per_contact"][k][std::string(1, "xyz"[axis])];
        const auto tools = shares(batch, E, k, axis);
        std::vector<double> a, b;
        for (std::size_t l = 0; l < tools.size(); ++l) {
          a.push_back(tools[l].at(tools[l].t));
          b.push_back(tools[l].slope(tools[l].t));
          EXPECT_WITHIN(a[l] * 1e3, out["nominal_by_tool_um"][l], tolerance);
          EXPECT_WITHIN(b[l] * 1e3, out["slope_by_tool_um_per_mm"][l], tolerance);
        }
        const LinearField linear = linear_field(a, b, batch.dt, batch.bands);
        EXPECT_EQ(linear.opposed, out["kind"] == "opposed");
        EXPECT_EQ(case_name(linear.which), out["linear"]["case"]);
        EXPECT_WITHIN(linear.low * 1e3, out["linear"]["w_min"], tolerance);
        EXPECT_WITHIN(linear.high * 1e3, out["linear"]["w_max"], tolerance);
        EXPECT_WITHIN(linear.width * 1e3, out["linear"]["field"], tolerance);
        const ExactField field = exact_field(tools, batch.bands);
        EXPECT_WITHIN(field.low * 1e3, out["exact"]["w_min"], exact);
        EXPECT_WITHIN(field.high * 1e3, out["exact"]["w_max"], exact);
        EXPECT_WITHIN(field.width() * 1e3, out["exact"]["field"], exact);
        EXPECT_WITHIN(field.inner_low * 1e3, out["exact"]["inner_lo"], exact);
        EXPECT_WITHIN(field.inner_high * 1e3, out["exact"]["inner_hi"], exact);
      }
  }
}

// Tools with components of both signs, so that h(t) turns inside of the allowance now and then.
std::vector<ToolShare> random_tools(Random& random) {
  std::vector<ToolShare> out(1 + random.next() % 3);
  for (ToolShare& tool : out) {
    for (std::size_t i = 0; i < 3; ++i) {
      tool.gain[i] = random.between(-1, 1);
      tool.exponent[i] = random.between(0.3, 1.4);
    }
    tool.t = random.between(0.05, 3);
    tool.dt = random.between(0, 2.5);
  }
  return out;
}

double draw(const std::vector<ToolShare>& tools, const Bands& bands, Random& random, bool corners) {
  const auto pick = [&](double width) {
    if (corners) return width * (static_cast<double>(random.next() % 3) - 1) / 2;
    return random.between(-width / 2, width / 2);
  };
  double sum = 0;
  for (const ToolShare& tool : tools) sum += tool.at(std::max(0.0, tool.t + pick(tool.dt)));
  return sum * (1 + pick(bands.nu)) / (1 + pick(bands.epsilon));
}

// AIRCUT_SAMPLES asks for more; the slow test draws a million.
std::size_t samples() {
  const char* text = std::getenv("AIRCUT_SAMPLES");
  return text ? static_cast<std::size_t>(std::atoll(text)) : 40000;
}

TEST(Scatter, NoRandomSampleLeavesTheExactField) {
  constexpr std::size_t machines = 200;
  Random random(20);
  double reached = 0;
  for (std::size_t machine = 0; machine < machines; ++machine) {
    const auto tools = random_tools(random);
    const Bands bands{random.between(0, 0.6), random.between(0, 0.6)};
    const ExactField field = exact_field(tools, bands);
    const double slack = 1e-12 * std::max(std::abs(field.low), std::abs(field.high));
    double low = 1e300, high = -1e300;
    for (std::size_t i = 0; i < samples() / machines; ++i) {
      const double w = draw(tools, bands, random, i % 2 == 0);
      low = std::min(low, w);
      high = std::max(high, w);
      ASSERT_GE(w, field.low - slack);
      ASSERT_LE(w, field.high + slack);
    }
    reached += (high - low) / field.width() / machines;
  }
  EXPECT_GT(reached, 0.9);  // and the field is no wider than it must be
}

TEST(Scatter, TheLinearFieldIsTheHullOfItsCorners) {
  Random random(21);
  for (int run = 0; run < 500; ++run) {
    std::vector<double> a, b, dt;
    for (std::size_t l = 0; l < 1 + random.next() % 4; ++l) {
      a.push_back(random.between(-1, 1));
      b.push_back(random.between(-1, 1));
      dt.push_back(random.between(0, 1));
    }
    const Bands bands{random.between(0, 0.5), random.between(0, 0.5)};
    const LinearField field = linear_field(a, b, dt, bands);
    double low = 1e300, high = -1e300;
    for (std::size_t corner = 0; corner < (std::size_t{2} << a.size()); ++corner) {
      double sum = 0;
      for (std::size_t l = 0; l < a.size(); ++l)
        sum += a[l] + ((corner >> l) % 2 == 0 ? -0.5 : 0.5) * b[l] * dt[l];
      sum *= 1 + ((corner >> a.size()) == 0 ? -0.5 : 0.5) * (bands.epsilon + bands.nu);
      low = std::min(low, sum);
      high = std::max(high, sum);
    }
    EXPECT_NEAR(field.low, low, 1e-12);
    EXPECT_NEAR(field.high, high, 1e-12);
    EXPECT_NEAR(field.width, high - low, 1e-12);
  }
}

TEST(Scatter, IndependentBodiesStayInsideOfTheirHull) {
  Random random(22);
  for (int run = 0; run < 30; ++run) {
    const auto first = random_tools(random);
    std::vector<BodyShare> bodies(3);
    for (BodyShare& body : bodies) {
      body.tools = first;
      for (ToolShare& tool : body.tools)
        for (double& gain : tool.gain) gain = random.between(-1, 1);
      body.epsilon = random.between(0, 0.5);
    }
    const double nu = random.between(0, 0.4);
    const ExactField field = independent_field(bodies, nu);
    double low = 1e300, high = -1e300;
    for (int i = 0; i < 2000; ++i) {
      const auto pick = [&](double width) {
        return i % 2 == 0 ? width * (static_cast<double>(random.next() % 3) - 1) / 2
                          : random.between(-width / 2, width / 2);
      };
      std::vector<double> factors;
      for (const BodyShare& body : bodies) factors.push_back(1 / (1 + pick(body.epsilon)));
      double sum = 0;
      for (std::size_t l = 0; l < first.size(); ++l) {
        const double t = std::max(0.0, first[l].t + pick(first[l].dt));
        for (std::size_t b = 0; b < bodies.size(); ++b)
          sum += factors[b] * bodies[b].tools[l].at(t);
      }
      sum *= 1 + pick(nu);
      low = std::min(low, sum);
      high = std::max(high, sum);
    }
    EXPECT_GE(low, field.low - 1e-12);
    EXPECT_LE(high, field.high + 1e-12);
    EXPECT_GT(high - low, 0.6 * field.width());
  }
}

TEST(Scatter, ASingleIndependentBodyIsTheExactField) {
  Random random(23);
  for (int run = 0; run < 20; ++run) {
    const auto tools = random_tools(random);
    const double epsilon = random.between(0, 0.5), nu = random.between(0, 0.5);
    const ExactField one = exact_field(tools, {epsilon, nu});
    const ExactField other = independent_field(std::vector<BodyShare>{{tools, epsilon}}, nu);
    EXPECT_NEAR(one.low, other.low, 1e-12);
    EXPECT_NEAR(one.high, other.high, 1e-12);
  }
}

TEST(Scatter, DrawsRepeatWithTheirSeedAndStayInsideOfTheField) {
  const json one = vectors("scatter")["end_to_end"][1];
  const Batch batch = read_batch(one["input"]);
  const Influence E = Structure(batch.machine.bodies).assemble(batch.machine.contacts);
  const auto tools = shares(batch, E, 0, 0);
  const ExactField field = exact_field(tools, batch.bands);
  const Sample a = monte_carlo(tools, batch.bands, {.seed = 3});
  const Sample b = monte_carlo(tools, batch.bands, {.seed = 3});
  const Sample c = monte_carlo(tools, batch.bands, {.seed = 4});
  EXPECT_EQ(a.mean, b.mean);
  EXPECT_EQ(a.q_high, b.q_high);
  EXPECT_NE(a.mean, c.mean);
  EXPECT_GE(a.low, field.low);
  EXPECT_LE(a.high, field.high);
  EXPECT_LE(a.low, a.q_low);
  EXPECT_GE(a.high, a.q_high);
  // The variance of independent uniform factors, to first order: Σ (width · slope)² / 12.
  double N = 0, variance = 0;
  for (const ToolShare& tool : tools) {
    N += tool.at(tool.t);
    variance += std::pow(tool.slope(tool.t) * tool.dt, 2) / 12;
  }
  variance +=
      N * N * (batch.bands.epsilon * batch.bands.epsilon + batch.bands.nu * batch.bands.nu) / 12;
  EXPECT_NEAR(a.mean, N, 0.01 * N);
  EXPECT_NEAR(a.sigma, std::sqrt(variance), 0.03 * a.sigma);
  const Sample normal = monte_carlo(tools, batch.bands, {.shape = Draws::Shape::normal, .seed = 3});
  EXPECT_NEAR(normal.sigma, std::sqrt(variance / 3), 0.03 * normal.sigma);
}

TEST(Tolerances, OfItGrades) {
  EXPECT_DOUBLE_EQ(it_tolerance(74.9, 12).value(), 0.3);
  EXPECT_DOUBLE_EQ(it_tolerance(3, 6).value(), 0.006);
  EXPECT_DOUBLE_EQ(it_tolerance(3.001, 6).value(), 0.008);
  EXPECT_DOUBLE_EQ(it_tolerance(500, 13).value(), 0.97);
  EXPECT_FALSE(it_tolerance(501, 8));
  EXPECT_FALSE(it_tolerance(10, 5));
  EXPECT_FALSE(it_tolerance(0, 8));
  EXPECT_EQ(it_grade_of(74.9, 0.0175), 6);
  EXPECT_EQ(it_grade_of(74.9, 0.031), 8);
  EXPECT_FALSE(it_grade_of(74.9, 0.5));
}

TEST(Tolerances, CapabilityIsToleranceOverField) {
  const Capability c = capability(0.012, 0.021, -0.046, 0, false);
  EXPECT_NEAR(c.cp, 0.046 / 0.009, 1e-12);
  EXPECT_FALSE(c.fits);
  EXPECT_TRUE(capability(0.012, 0.021, -0.046, 0, true).fits);
  EXPECT_FALSE(capability(0.0, 0.05, -0.046, 0, true).fits);
}

}  // namespace
}  // namespace aircut::accuracy::testing
