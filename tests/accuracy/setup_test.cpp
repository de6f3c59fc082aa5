// The reader of set-up files: what it accepts means what the vectors mean, and every mistake is
// named at its place.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "accuracy/accuracy.h"

namespace aircut::accuracy::testing {
namespace {

const std::string body = "[[bodies]]\nname = \"spindle\"\ne = [[0.04,0,0],[0,0.03,0],[0,0,0.01]]\n";
const std::string carriage =
    "[[bodies]]\nname = \"turret\"\ne = [[0.02,0,0],[0,0.02,0],[0,0,0.02]]\n";
const std::string steel =
    "[materials.steel]\nsource = \"handbook\"\ncut = {C=3000,y=0.75,z=-0.15}\n"
    "thrust = {C=2430,x=0.9,y=0.6,z=-0.3}\nfeed = {C=3390,y=0.5,z=-0.4}\n";
const std::string tool = "[[tools]]\nid = 1\nbody = \"turret\"\nlaw = \"steel\"\n";
const std::string work = "[[works]]\nspindle = 1\nbody = \"spindle\"\n";
const std::string cut =
    "[[contacts]]\ntool = 1\npoint = [37.45, 0, 74.9]\nt = 2.0\nS = 0.24\nV = 200\nfeed = [0, 0, "
    "-1]\n";
const std::string whole = body + carriage + steel + tool + work + cut;

struct Read {
  std::optional<Setup> setup;
  std::string messages;
};

Read read(const std::string& toml) {
  const SourceText text("setup.toml", toml);
  Diagnostics out;
  Read result{read_setup(text, out), ""};
  for (const Diagnostic& d : out.list()) result.messages += format_gcc(d) + "\n";
  return result;
}

std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

TEST(AccuracySetup, BecomesForcesAndContacts) {
  const Read result = read(whole);
  EXPECT_EQ(result.messages, "");
  ASSERT_TRUE(result.setup);
  ASSERT_EQ(result.setup->contacts.size(), 1u);
  const ContactEntry& c = result.setup->contacts[0];
  EXPECT_LT(
      (c.force.force(2) - Vec3(392.9624167001626, 929.2983848172122, 398.9544526024147)).norm(),
      1e-9);
  EXPECT_EQ(c.normal, Vec3::UnitX());
  EXPECT_EQ(c.source, "handbook");
  EXPECT_NEAR(result.setup->bodies[0].compliance.e(0, 0), 4e-5, 1e-18);
}

TEST(AccuracySetup, ASpeedMayComeFromTheSpindle) {
  const Read result = read(with(whole, "V = 200", "rpm = 850\ndiameter = 74.9"));
  EXPECT_EQ(result.messages, "");
  ASSERT_TRUE(result.setup);
  EXPECT_NEAR(result.setup->contacts[0].V, 200.0094962907942, 1e-9);
}

TEST(AccuracySetup, AnAllowanceMayComeFromTheStocksGrade) {
  const Read result = read(whole + "stock = { size = 74.9, it_grade = 12 }\n");
  EXPECT_EQ(result.messages, "");
  ASSERT_TRUE(result.setup);
  EXPECT_DOUBLE_EQ(result.setup->contacts[0].dt, 0.15);
}

TEST(AccuracySetup, RodsBeamsAndStepsAreBodies) {
  const Read result = read(
      "[[bodies]]\nname = \"bar\"\nrod = {length=60, diameter=10, E=210000, axis=[0,0,2]}\n"
      "[[bodies]]\nname = \"holder\"\nparent = \"bar\"\nsteps = "
      "[{length=20,diameter=20,E=2e5},{length=30,diameter=10,E=2e5}]\n"
      "[[bodies]]\nname = \"shaft\"\nparent = \"holder\"\n"
      "beam = {length=200,diameter=30,E=210000,held=\"centres\",e_centre=0.02}\n");
  EXPECT_EQ(result.messages, "");
  ASSERT_TRUE(result.setup);
  const auto& bodies = result.setup->bodies;
  ASSERT_EQ(bodies.size(), 4u);
  EXPECT_EQ(bodies[1].parent, 0);
  EXPECT_EQ(bodies[2].parent, 1);
  EXPECT_EQ(bodies[3].parent, 2);
  EXPECT_TRUE(bodies[3].beam);
}

TEST(AccuracySetup, MillingAndDrillingBecomeForces) {
  const std::string mill =
      "[materials.al]\nmilling = {K_tc=631,K_rc=99,K_ac=273,K_te=13,K_re=10,K_ae=2.8}\n"
      "kienzle = {k_c11=700,m_c=0.18}\n[[tools]]\nid = 2\nbody = \"turret\"\nlaw = \"al\"\n"
      "milling = {N=2,D=10,helix_deg=45}\n";
  const std::string contact =
      "[[contacts]]\ntool = 2\npoint = [0,0,0]\n"
      "milling = {a_p=8,a_e=2,mode=\"down\",f_t=0.1,rpm=8000,feed=[1,0,0],axis=[0,0,1]}\n"
      "[[contacts]]\ntool = 2\npoint = [0,0,0]\ndrilling = {D=10,S=0.2,rpm=1000,feed=[0,0,-1]}\n";
  const Read result = read(whole + mill + contact);
  EXPECT_EQ(result.messages, "");
  ASSERT_TRUE(result.setup);
  const ContactEntry& milled = result.setup->contacts[1];
  EXPECT_LT(
      (milled.force.force(8) - Vec3(62.077783745862064, 77.61710059545038, -34.419297727755385))
          .norm(),
      1e-9);
  EXPECT_LT((milled.force.force(4) - 0.5 * milled.force.force(8)).norm(), 1e-9);
  EXPECT_NEAR(milled.power, 0.39781160356289025, 1e-9);
  const ContactEntry& drilled = result.setup->contacts[2];
  EXPECT_GT(drilled.force.fixed.z(), 0);   // pushed back up
  EXPECT_GT(drilled.force.moment.z(), 0);  // held back against its turn, which is about −z
}

// A change of the good file, what the message must begin with, and a word that it must hold.
struct Mistake {
  const char* from;
  const char* to;
  const char* place;
  const char* kind;
};

TEST(AccuracySetup, NamesEveryMistakeAtItsPlace) {
  const std::vector<Mistake> mistakes = {
      {"name = \"turret\"\ne", "name = \"turret\"\nE", "setup.toml:6:1: error: unknown key 'E'",
       "accuracy_invalid"},
      {"[0,0,0.01]]", "[0,0,0.01],[0,0,0]]", "setup.toml:3:5: error: 'e' needs 3 rows",
       "accuracy_invalid"},
      {"[0,0,0.01]]", "[0,0]]", "setup.toml:3:29: error: 'e' needs an array of 3",
       "accuracy_invalid"},
      {"0.03", "inf", "setup.toml:3:20: error: 'e' needs a finite number", "accuracy_invalid"},
      {"0.03", "-0.03", "setup.toml:3:5: error: 'e' of body 'spindle' would give back",
       "not_passive"},
      {"name = \"turret\"", "name = \"spindle\"", "setup.toml:5:8: error: there are two bodies",
       "body_tree"},
      {"name = \"turret\"", "name = \"turret\"\nparent = \"bed\"",
       "setup.toml:6:10: error: there is no body 'bed'", "body_tree"},
      {"name = \"turret\"", "name = \"turret\"\nparent = \"turret\"",
       "setup.toml:6:10: error: the parents go round", "body_tree"},
      {"body = \"turret\"", "body = \"turet\"",
       "setup.toml:14:8: error: there is no body 'turet'. Did you mean 'turret'?",
       "accuracy_reference"},
      {"law = \"steel\"", "law = \"stel\"",
       "setup.toml:15:7: error: there is no material 'stel'. Did you mean 'steel'?",
       "accuracy_reference"},
      {"tool = 1", "tool = 2", "setup.toml:20:8: error: there is no tool 2", "accuracy_reference"},
      {"V = 200", "V = 0", "setup.toml:24:5: error: 'V' is above 0", "accuracy_range"},
      {"t = 2.0", "t = 2.0\ndt = -1", "setup.toml:23:6: error: an allowance", "accuracy_range"},
      {"law = \"steel\"", "law = \"steel\"\nkappa_deg = 180",
       "setup.toml:16:13: error: the entering angle", "accuracy_range"},
      {"law = \"steel\"", "law = \"steel\"\nmilling = {N = 0, D = 10}",
       "setup.toml:16:16: error: 'N' is the number of teeth", "accuracy_range"},
      {"law = \"steel\"", "law = \"steel\"\nmilling = {N = 2, D = 0}",
       "setup.toml:16:23: error: 'D' is above 0", "accuracy_range"},
      {"name = \"turret\"", "name = \"turret\"\nepsilon = 2",
       "setup.toml:6:11: error: 'epsilon' is the full width", "accuracy_range"},
      {"name = \"turret\"", "name = \"turret\"\nR = [[1,0,0],[0,1,0],[0,0,-1]]",
       "setup.toml:6:5: error: 'R' is no rotation", "not_a_rotation"},
      {"name = \"turret\"",
       "name = \"turret\"\nparallel = { e = [[0.02,0,0],[0,0.02,0],[0,0,0.02]] }",
       "setup.toml:6:12: error: two supports", "support_not_invertible"},
      {"feed = [0, 0, -1]", "feed = [1, 0, 0]", "setup.toml:18:1: error: 'normal' is missing",
       "accuracy_invalid"},
      {"point = [37.45, 0, 74.9]", "point = [0, 0, 74.9]\nnormal = [1, 0, 0]",
       "setup.toml:20:9: error: at the spindle's axis", "accuracy_range"},
  };
  for (const Mistake& m : mistakes) {
    const Read result = read(with(whole, m.from, m.to));
    EXPECT_FALSE(result.setup) << m.to;
    EXPECT_NE(result.messages.find("[" + std::string(m.kind) + "]"), std::string::npos)
        << m.to << "\n"
        << result.messages;
    const std::string place(m.place);
    // Lines of the file that no change moved are checked by their own numbers.
    EXPECT_NE(result.messages.find(place.substr(place.find("error"))), std::string::npos)
        << m.to << "\n"
        << result.messages;
    EXPECT_EQ(result.messages.rfind("setup.toml:", 0), 0u) << result.messages;
  }
}

TEST(AccuracySetup, GivesTheExactPlaceOfAKey) {
  const Read result = read(with(whole, "V = 200", "V = -200"));
  EXPECT_EQ(result.messages, "setup.toml:24:5: error: 'V' is above 0 [accuracy_range]\n");
}

TEST(AccuracySetup, WarnsOfWhatIsDoubtful) {
  const auto warned = [](const std::string& toml, const char* kind) {
    const Read result = read(toml);
    EXPECT_TRUE(result.setup) << result.messages;
    EXPECT_NE(result.messages.find("warning"), std::string::npos) << kind;
    EXPECT_NE(result.messages.find(kind), std::string::npos) << result.messages;
  };
  warned(with(whole, "name = \"turret\"",
              "name = \"turret\"\nxi = [[1e-6,0,0],[0,1e-6,0],[0,0,1e-6]]"),
         "base_point_missing");
  warned("sign_policy = \"as_given\"\n" + with(whole, "0.03", "-0.03"), "matrix_suspect");
  warned(with(whole, "[[0.04,0,0],[0,0.03,0]", "[[0.04,0.06,0],[-0.06,0.03,0]"), "matrix_suspect");
  warned(with(whole, "t = 2.0", "t = 2.0\ndt = 5"), "allowance_clipped");
  warned(with(whole, "source =", "valid = {t=[3,6]}\nsource ="), "law_extrapolated");
}

TEST(AccuracySetup, RepairsAreToldOneByOne) {
  const Read result =
      read("sign_policy = \"row_flip\"\n" + with(whole, "[0,0,0.01]]", "[0,0,-0.01]]"));
  ASSERT_TRUE(result.setup) << result.messages;
  ASSERT_EQ(result.setup->changes.size(), 1u);
  EXPECT_EQ(result.setup->changes[0], "body 'spindle', e: row z turned");
  EXPECT_NEAR(result.setup->bodies[0].compliance.e(2, 2), 1e-5, 1e-18);
}

}  // namespace
}  // namespace aircut::accuracy::testing
