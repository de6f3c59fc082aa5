// From a set-up file to sizes: the documented example, and what a set-up must answer for.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "accuracy/accuracy.h"

namespace aircut::accuracy::testing {
namespace {

std::string shipped() {
  std::ifstream in(std::string(AIRCUT_SOURCE_DIR) + "/programs/accuracy/twin-turret.toml");
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

struct Answer {
  std::optional<Setup> setup;
  Result result;
  std::string messages;
};

Answer answer(const std::string& toml) {
  const SourceText text("s.toml", toml);
  Diagnostics out;
  Answer a;
  a.setup = read_setup(text, out);
  if (a.setup) a.result = evaluate(*a.setup, out);
  for (const Diagnostic& d : out.list()) a.messages += d.kind + ": " + d.message + "\n";
  return a;
}

std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

TEST(Evaluate, TheDocumentedExampleComesOutAsDocumented) {
  const Answer a = answer(shipped());
  ASSERT_TRUE(a.setup) << a.messages;
  // Both carriages' xi keep an eigenvalue below 0 after the repair; nothing else is said.
  EXPECT_EQ(a.setup->changes.size(), 9u);
  EXPECT_EQ(a.messages.find("error"), std::string::npos);
  ASSERT_EQ(a.result.segments.size(), 1u);
  const ContactResult& one = a.result.segments[0].contacts[0];
  const ContactResult& two = a.result.segments[0].contacts[1];
  EXPECT_NEAR(one.P_cut, 929.298, 5e-4);
  EXPECT_LT((one.load.force - Vec3(392.962, 929.298, 398.954)).norm(), 1e-3);
  EXPECT_LT((two.load.force - Vec3(-199.477, -464.649, 210.583)).norm(), 1e-3);
  EXPECT_LT((one.moved.displacement * 1e3 - Vec3(15.976, 56.494, 3.747)).norm(), 1e-3);
  EXPECT_LT((two.moved.displacement * 1e3 - Vec3(-0.089, 21.544, 9.542)).norm(), 1e-3);
  EXPECT_NEAR(*one.delta * 1e3, 15.976, 5e-4);
  ASSERT_EQ(one.shares.size(), 3u);
  EXPECT_NEAR(one.shares[0].delta * 1e3, 8.969, 5e-4);   // spindle, own force
  EXPECT_NEAR(one.shares[1].delta * 1e3, -7.791, 5e-4);  // spindle, from tool 2
  EXPECT_NEAR(one.shares[2].delta * 1e3, 14.798, 5e-4);  // carriage
  EXPECT_TRUE(one.field->opposed);
  EXPECT_NEAR(one.field->low * 1e3, 11.910, 5e-4);
  EXPECT_NEAR(one.field->high * 1e3, 20.631, 5e-4);
  // The diameter counts twice.
  const DimensionResult& D1 = a.result.dimensions[0];
  EXPECT_EQ(D1.unchecked, "");
  EXPECT_NEAR(D1.mean * 1e3, 31.95, 5e-3);
  EXPECT_NEAR(D1.field.width() * 1e3, 2 * 8.721, 1e-3);
  EXPECT_NEAR(D1.capability->cp, 46 / (2 * 8.721), 1e-3);
  EXPECT_EQ(D1.it_grade, 6);
}

TEST(Evaluate, TheExactFieldAndDrawsAnswerToTheirKeys) {
  const Answer a = answer(with(shipped(), "mode = \"linear\"",
                               "mode = \"exact\"\nmonte_carlo = { count = 20000, seed = 3 }"));
  const Field& field = *a.result.segments[0].contacts[0].field;
  EXPECT_NEAR(field.low * 1e3, 12.099, 5e-4);
  EXPECT_NEAR(field.high * 1e3, 20.927, 5e-4);
  ASSERT_TRUE(field.sample);
  EXPECT_GE(field.sample->low, field.low);
  EXPECT_LE(field.sample->high, field.high);
}

TEST(Evaluate, BodiesOfTheirOwnScatterLessThanTogether) {
  std::string toml =
      with(shipped(), "mode = \"linear\"", "mode = \"exact\"\nindependent_bodies = true");
  for (const char* name : {"spindle", "carriage 1", "carriage 2"})
    toml = with(toml, "name = \"" + std::string(name) + "\"",
                "name = \"" + std::string(name) + "\"\nepsilon = 0.2");
  const Answer a = answer(toml);
  ASSERT_TRUE(a.setup) << a.messages;
  const Field& field = *a.result.segments[0].contacts[0].field;
  EXPECT_NEAR(field.low * 1e3, 12.099, 5);
  EXPECT_GE(field.width() * 1e3, 8.828 - 1e-3);  // tools of both signs: bodies no longer cancel
}

TEST(Evaluate, ToolsThatCutOneAfterTheOtherDoNotDisturbEachOther) {
  std::string toml = with(shipped(), "stock = {", "interval_s = [0, 10]\nstock = {");
  toml = with(toml, "dt = 0.30", "dt = 0.30\ninterval_s = [4, 6]");
  const Answer a = answer(toml);
  ASSERT_EQ(a.result.segments.size(), 3u);
  EXPECT_EQ(a.result.segments[0].contacts.size(), 1u);
  EXPECT_EQ(a.result.segments[1].contacts.size(), 2u);
  const double alone = *a.result.segments[0].contacts[0].delta;
  const double both = *a.result.segments[1].contacts[0].delta;
  EXPECT_NEAR(alone * 1e3, 23.767, 5e-4);
  EXPECT_NEAR(both * 1e3, 15.976, 5e-4);
  const DimensionResult& D1 = a.result.dimensions[0];
  EXPECT_DOUBLE_EQ(D1.least, 2 * both);
  EXPECT_DOUBLE_EQ(D1.most, 2 * alone);
  EXPECT_NEAR(D1.mean, 2 * (0.8 * alone + 0.2 * both), 1e-12);
}

TEST(Evaluate, CoupledDepthsShrinkAndCopyTheirBlank) {
  const Answer a = answer("coupled = true\n" + shipped());
  const ContactResult& one = a.result.segments[0].contacts[0];
  EXPECT_LT(one.t, 2.0);
  EXPECT_NEAR(2.0 - one.t, *one.delta, 1e-9);
  EXPECT_GT(one.copy_ratio, 0.005);
  EXPECT_LT(one.copy_ratio, 0.02);
}

TEST(Evaluate, SecondOrderAddsTheSagittaOfTheTangentialDisplacement) {
  const double first = *answer(shipped()).result.segments[0].contacts[0].delta;
  const double exact =
      *answer("second_order = true\n" + shipped()).result.segments[0].contacts[0].delta;
  EXPECT_NEAR(exact - first, 0.056494 * 0.056494 / (2 * 37.45), 5e-8);
}

TEST(Evaluate, EveryLimitAndToleranceHasItsFinding) {
  const auto said = [](const std::string& toml, const std::string& kind) {
    const Answer a = answer(toml);
    EXPECT_TRUE(a.setup) << a.messages;
    EXPECT_NE(a.messages.find(kind + ": "), std::string::npos) << kind << "\n" << a.messages;
  };
  const std::string toml = shipped();
  said(with(toml, "Fc_N = 3000", "Fc_N = 900"), "force_limit");
  said(with(toml, "power_kW = 7.5", "power_kW = 5"), "power_limit");  // 5.47 kW of both tools
  said(with(toml, "power_kW = 7.5", "torque_Nm = 50"), "torque_limit");
  said(with(toml, "power_kW = 7.5", "h_max = 0.2"), "chip_load");
  said(with(toml, "power_kW = 7.5", "deflection_um = 50"), "deflection");
  said(with(toml, "compensate = true", ""), "size_error");
  said(with(toml, "tolerance = [-0.046, 0]", "tolerance = [-0.01, 0]"), "scatter_too_wide");
  said(with(toml, "body = \"carriage 2\"", "body = \"spindle\""), "no_relative_compliance");
  said(with(toml, "epsilon = 0.2", "epsilon = 0.2") + "\n", "matrix_suspect");
  EXPECT_EQ(answer(with(toml, "power_kW = 7.5", "power_kW = 5.5")).messages.find("power_limit"),
            std::string::npos);
}

// A soft carriage, pulled into the work by its thrust when the sign of its compliance is wrong.
TEST(Evaluate, ARunawayAndALargeDisplacementAreTold) {
  const std::string soft =
      "sign_policy = \"as_given\"\n[[bodies]]\nname = \"s\"\ne = [[EE,0,0],[0,0.01,0],[0,0,0.01]]\n"
      "[[bodies]]\nname = \"t\"\ne = [[0,0,0],[0,0,0],[0,0,0]]\n"
      "[materials.m]\nkienzle = {k_c11=2000,m_c=0.2}\n[[tools]]\nid=1\nbody=\"t\"\nlaw=\"m\"\n"
      "[[works]]\nbody=\"s\"\n[[contacts]]\ntool=1\npoint=[20,0,0]\nt=1\nS=0.2\nV=200\nfeed=[0,0,-"
      "1]\n";
  const std::string digs = with(soft, "EE", "-6.0");
  EXPECT_NE(answer("coupled = true\n" + digs).messages.find("statically_unstable: "),
            std::string::npos);
  EXPECT_NE(answer(with(soft, "EE", "6.0")).messages.find("displacement_large: "),
            std::string::npos);
}

// t − t² = 0.3 has no solution, though the machine holds the tool at t = 0.3.
TEST(Evaluate, ADepthThatIsNotFoundIsTold) {
  const Answer a = answer(
      "coupled = true\nsign_policy = \"as_given\"\n[[bodies]]\nname = \"s\"\n"
      "e = [[-1,0,0],[0,0,0],[0,0,0]]\n[[bodies]]\nname = \"t\"\ne = [[0,0,0],[0,0,0],[0,0,0]]\n"
      "[materials.m]\ncut = {C=1}\nthrust = {C=1000,x=2}\nfeed = {C=1}\n"
      "[[tools]]\nid=1\nbody=\"t\"\nlaw=\"m\"\n[[works]]\nbody=\"s\"\n"
      "[[contacts]]\ntool=1\npoint=[20,0,0]\nt=0.3\nS=1\nV=200\nfeed=[0,0,-1]\n");
  EXPECT_NE(a.messages.find("copying_not_converged: "), std::string::npos) << a.messages;
  EXPECT_EQ(a.result.segments[0].contacts[0].t, 0.3);
}

TEST(Evaluate, ASizeThatCannotBeWorkedOutSaysSo) {
  const Answer a = answer(with(shipped(), "tool = 1\nkind", "tool = 2\nkind"));
  EXPECT_EQ(a.result.dimensions[0].unchecked, "");
  const std::string idle =
      with(shipped(), "[[works]]", "[[tools]]\nid = 3\nbody = \"spindle\"\n[[works]]");
  EXPECT_EQ(answer(with(idle, "tool = 1\nkind", "tool = 3\nkind")).result.dimensions[0].unchecked,
            "its tool cuts nowhere");
}

TEST(Evaluate, AWidthAddsTheErrorsOfItsTwoTools) {
  const std::string toml =
      with(shipped(), "tool = 1\nkind = \"outside_diameter\"", "tools = [1, 2]\nkind = \"width\"");
  const Answer a = answer(toml);
  ASSERT_TRUE(a.setup) << a.messages;
  const auto& c = a.result.segments[0].contacts;
  EXPECT_NEAR(a.result.dimensions[0].mean, *c[0].delta + *c[1].delta, 1e-12);
  EXPECT_NEAR(a.result.dimensions[0].field.N, *c[0].delta + *c[1].delta, 1e-12);
}

TEST(Evaluate, EveryKindHasItsText) {
  for (const KindText& row : kinds()) EXPECT_GT(std::string_view(row.text).size(), 30u) << row.kind;
}

}  // namespace
}  // namespace aircut::accuracy::testing
