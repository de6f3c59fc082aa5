// The tree of bodies against the published vectors, and both ways of evaluation against each other.
#include "accuracy/vectors.h"
#include "base/random.h"

namespace aircut::accuracy::testing {
namespace {

std::vector<Response> two_pass(const Structure& structure, const std::vector<Contact>& contacts,
                               const std::vector<Load>& loads) {
  Structure::Scratch scratch;
  std::vector<Response> out(contacts.size());
  structure.respond(contacts, loads, scratch, out);
  return out;
}

void expect_vectors(const std::string& name) {
  const json file = vectors(name);
  const Tolerance tolerance(file["tolerance"]);
  ASSERT_GE(file["cases"].size(), 9u);
  for (const json& one : file["cases"]) {
    SCOPED_TRACE(one["id"].get<std::string>());
    const Case c = read_case(one["input"]);
    const Structure structure(c.bodies);
    const Influence E = structure.assemble(c.contacts);
    const auto assembled = E.responses(c.loads);
    const auto passed = two_pass(structure, c.contacts, c.loads);
    const json& expect = one["expect"];
    for (std::size_t k = 0; k < c.contacts.size(); ++k)
      for (int i = 0; i < 3; ++i) {
        const auto at = static_cast<std::size_t>(i);
        const double w = expect["w_um"][k][at], turn = expect["rot_urad"][k][at];
        EXPECT_WITHIN(assembled[k].displacement[i] * 1e3, w, tolerance);
        EXPECT_WITHIN(passed[k].displacement[i] * 1e3, w, tolerance);
        EXPECT_WITHIN(assembled[k].rotation[i] * 1e6, turn, tolerance);
        EXPECT_WITHIN(passed[k].rotation[i] * 1e6, turn, tolerance);
        for (std::size_t l = 0; l < c.contacts.size(); ++l)
          for (int j = 0; j < 3; ++j) {
            const double wanted =
                expect["E_um_per_N"][3 * k + at][3 * l + static_cast<std::size_t>(j)];
            EXPECT_WITHIN(E.E(k, l)(i, j) * 1e3, wanted, tolerance);
          }
      }
  }
}

TEST(Structure, MeetsTheVectorsOfTheSixAdjustments) { expect_vectors("adjustments"); }

TEST(Structure, MeetsTheVectorsOfTheFullFactorModel) { expect_vectors("fullfactor"); }

// Random machines. Compliances are symmetric and positive unless asked otherwise.
class RandomMachine {
 public:
  explicit RandomMachine(std::uint64_t seed) : random_(seed) {}
  double between(double low, double high) { return random_.between(low, high); }
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(random_.next() % n); }
  Vec3 vec(double size) {
    return {between(-size, size), between(-size, size), between(-size, size)};
  }
  Mat6 positive() {
    Mat6 A;
    for (int i = 0; i < 36; ++i) A.data()[i] = between(-1, 1);
    Eigen::Matrix<double, 6, 1> scale;
    scale << 5e-3, 5e-3, 5e-3, 5e-5, 5e-5, 5e-5;
    return scale.asDiagonal() * (A * A.transpose()) * scale.asDiagonal();
  }
  Body body(int parent) {
    const Mat6 C = positive();
    Body out;
    out.parent = parent;
    out.base_point = vec(150);
    out.compliance = {C.topLeftCorner<3, 3>(), C.topRightCorner<3, 3>(),
                      C.bottomRightCorner<3, 3>()};
    return out;
  }
  std::vector<Body> bodies(std::size_t n) {
    std::vector<Body> out;
    for (std::size_t i = 0; i < n; ++i) out.push_back(body(static_cast<int>(below(i + 1)) - 1));
    return out;
  }
  std::vector<Contact> contacts(std::size_t n, std::size_t bodies) {
    std::vector<Contact> out;
    while (out.size() < n) {
      const int tool = static_cast<int>(below(bodies)), work = static_cast<int>(below(bodies));
      if (tool != work) out.push_back({tool, work, vec(150)});
    }
    return out;
  }
  std::vector<Load> loads(std::size_t n) {
    std::vector<Load> out;
    for (std::size_t i = 0; i < n; ++i) out.push_back({vec(1000), vec(20000)});
    return out;
  }
  Mat3 rotation() {
    return (Eigen::AngleAxisd(between(-3, 3), Vec3::UnitX()) *
            Eigen::AngleAxisd(between(-3, 3), Vec3::UnitY()) *
            Eigen::AngleAxisd(between(-3, 3), Vec3::UnitZ()))
        .toRotationMatrix();
  }

 private:
  Random random_;
};

void expect_same(const std::vector<Response>& a, const std::vector<Response>& b) {
  ASSERT_EQ(a.size(), b.size());
  double size = 1e-9, turn = 1e-12;
  for (const Response& r : a) {
    size = std::max(size, r.displacement.norm());
    turn = std::max(turn, r.rotation.norm());
  }
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_LT((a[k].displacement - b[k].displacement).norm(), 1e-10 * size);
    EXPECT_LT((a[k].rotation - b[k].rotation).norm(), 1e-10 * turn);
  }
}

TEST(Structure, BothWaysOfEvaluationAgreeOnRandomTrees) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    RandomMachine make(seed);
    const std::size_t n = 2 + make.below(11), m = 1 + make.below(5);
    std::vector<Body> bodies = make.bodies(n);
    // The last body is work held as a beam in every third machine; it carries nothing.
    if (seed % 3 == 0) {
      Beam beam = round_beam(200, 30, 210000, static_cast<Held>(seed % 9 / 3));
      beam.axis = make.rotation().col(0);
      beam.e_clamp = 1e-5;
      beam.e_centre = 2e-5;
      bodies.back().beam = beam;
    }
    const Structure structure(bodies);
    const auto contacts = make.contacts(m, n);
    const auto loads = make.loads(m);
    expect_same(structure.assemble(contacts).responses(loads),
                two_pass(structure, contacts, loads));
  }
}

TEST(Structure, IsSymmetricAndPassiveWhenItsBodiesAre) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    RandomMachine make(seed);
    const Structure structure(make.bodies(8));
    const auto contacts = make.contacts(4, 8);
    const Influence E = structure.assemble(contacts);
    Eigen::MatrixXd all(12, 12);
    for (std::size_t k = 0; k < 4; ++k)
      for (std::size_t l = 0; l < 4; ++l)
        all.block<3, 3>(static_cast<int>(3 * k), static_cast<int>(3 * l)) = E.E(k, l);
    EXPECT_LT((all - all.transpose()).norm(), 1e-12 * all.norm());
    const auto values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(all).eigenvalues();
    EXPECT_GT(values[0], -1e-12 * values[11]);
  }
}

TEST(Structure, ScalesWithTheForcesAndIgnoresToolsThatDoNotCut) {
  RandomMachine make(7);
  const Structure structure(make.bodies(6));
  auto contacts = make.contacts(3, 6);
  auto loads = make.loads(3);
  const auto once = two_pass(structure, contacts, loads);
  auto twice = loads;
  for (Load& load : twice) load = {2 * load.force, 2 * load.moment};
  auto expected = once;
  for (Response& r : expected) r = {2 * r.displacement, 2 * r.rotation};
  expect_same(two_pass(structure, contacts, twice), expected);
  contacts.push_back({2, 3, Vec3(1, 2, 3)});
  loads.push_back({});
  auto more = two_pass(structure, contacts, loads);
  more.pop_back();
  expect_same(more, once);
}

TEST(Structure, ARigidSubsystemChangesNothing) {
  RandomMachine make(8);
  auto bodies = make.bodies(6);
  const auto contacts = make.contacts(3, 6);
  const auto loads = make.loads(3);
  const auto before = two_pass(Structure(bodies), contacts, loads);
  Body rigid;
  rigid.parent = bodies[4].parent;
  rigid.base_point = Vec3(7, 8, 9);
  bodies.push_back(rigid);
  bodies[4].parent = 6;
  expect_same(two_pass(Structure(bodies), contacts, loads), before);
}

TEST(Structure, MovingABasePointByTheShiftRuleChangesNothing) {
  RandomMachine make(9);
  auto bodies = make.bodies(6);
  const auto contacts = make.contacts(3, 6);
  const auto loads = make.loads(3);
  const auto before = two_pass(Structure(bodies), contacts, loads);
  for (Body& body : bodies) {
    const Vec3 shift = make.vec(80);
    body.compliance = shifted(body.compliance, shift);
    body.base_point += shift;
  }
  expect_same(two_pass(Structure(bodies), contacts, loads), before);
}

TEST(Structure, RotatingTheWholeSetUpRotatesTheDisplacements) {
  RandomMachine make(10);
  auto bodies = make.bodies(6);
  auto contacts = make.contacts(3, 6);
  auto loads = make.loads(3);
  auto expected = two_pass(Structure(bodies), contacts, loads);
  const Mat3 R = make.rotation();
  for (Body& body : bodies) {
    body.compliance = rotated(body.compliance, R);
    body.base_point = R * body.base_point;
  }
  for (Contact& contact : contacts) contact.point = R * contact.point;
  for (Load& load : loads) load = {R * load.force, R * load.moment};
  for (Response& r : expected) r = {R * r.displacement, R * r.rotation};
  expect_same(two_pass(Structure(bodies), contacts, loads), expected);
}

TEST(Structure, ABodyInTwoHalvesInSeriesMovesAsOne) {
  RandomMachine make(11);
  auto bodies = make.bodies(6);
  const auto contacts = make.contacts(3, 6);
  const auto loads = make.loads(3);
  const auto before = two_pass(Structure(bodies), contacts, loads);
  Body half = bodies[3];
  half.compliance = {0.5 * half.compliance.e, 0.5 * half.compliance.c, 0.5 * half.compliance.xi};
  bodies[3].compliance = half.compliance;
  bodies[3].parent = 6;
  bodies.push_back(half);
  expect_same(two_pass(Structure(bodies), contacts, loads), before);
}

TEST(Structure, SharesOfTheBodiesSumToTheError) {
  RandomMachine make(12);
  const Structure structure(make.bodies(7));
  const auto contacts = make.contacts(3, 7);
  const auto loads = make.loads(3);
  const auto moved = two_pass(structure, contacts, loads);
  const Vec3 normal = make.rotation().col(1);
  for (std::size_t k = 0; k < 3; ++k) {
    double sum = 0;
    for (const ErrorShare& share : error_shares(structure, contacts, loads, k, normal))
      sum += share.delta;
    EXPECT_NEAR(sum, normal_error(normal, moved[k].displacement), 1e-12);
  }
}

TEST(Structure, FindsWhatIsInOrBehindACycle) {
  const std::vector<int> parents = {-1, 0, 3, 2, 2, 1};
  EXPECT_EQ(parents_first(parents), (std::vector<int>{0, 1, 5}));
}

TEST(Process, SegmentsOfTimeMeetTheVectors) {
  const json file = vectors("process");
  const Tolerance tolerance(file["tolerance"]);
  ASSERT_GE(file["timeline"].size(), 2u);
  for (const json& one : file["timeline"]) {
    SCOPED_TRACE(one["id"].get<std::string>());
    const Case c = read_case(one["input"]);
    const Structure structure(c.bodies);
    std::vector<Span> spans;
    for (const json& j : one["input"]["contacts"])
      spans.push_back({j["interval_s"][0], j["interval_s"][1]});
    const json& expected = one["expect"]["segments"];
    const auto segments = active_segments(spans);
    // The vectors keep segments in which nothing cuts; they have no displacements.
    std::size_t s = 0;
    for (const json& wanted : expected) {
      if (wanted["active"].empty()) continue;
      ASSERT_LT(s, segments.size());
      const ActiveSegment& segment = segments[s++];
      EXPECT_DOUBLE_EQ(segment.from, wanted["t0"]);
      EXPECT_DOUBLE_EQ(segment.to, wanted["t1"]);
      ASSERT_EQ(segment.active.size(), wanted["active"].size());
      std::vector<Contact> contacts;
      std::vector<Load> loads;
      for (const std::size_t k : segment.active) {
        contacts.push_back(c.contacts[k]);
        loads.push_back(c.loads[k]);
      }
      const auto moved = two_pass(structure, contacts, loads);
      for (std::size_t i = 0; i < segment.active.size(); ++i) {
        const std::string name = one["input"]["contacts"][segment.active[i]]["name"];
        const Vec3 w = vec3(wanted["w_um"][name]);
        for (int axis = 0; axis < 3; ++axis)
          EXPECT_WITHIN(moved[i].displacement[axis] * 1e3, w[axis], tolerance);
      }
    }
    EXPECT_EQ(s, segments.size());
  }
}

}  // namespace
}  // namespace aircut::accuracy::testing
