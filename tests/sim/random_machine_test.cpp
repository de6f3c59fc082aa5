// What a run tells of random machines, against the brute-force judge. AIRCUT_SCENES=n takes n of
// them instead of the few of the fast run, AIRCUT_SEED=n begins at another one.
#include "support/random_machine.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "base/text.h"
#include "support/brute_force.h"
#include "support/run_program.h"

namespace aircut::sim {
namespace {

using testing::make_random_machine;
using testing::RandomMachine;
using testing::run_program;
using testing::RunResult;

constexpr double resolution = 0.005;  // of a machine, unless its file says otherwise
// Ends of a move are written with so many digits that bodies are where the judge has them to 1e-7.
constexpr double numbers = 1e-6;

int from_environment(const char* name, int otherwise) {
  const char* wanted = std::getenv(name);
  const auto number = wanted != nullptr ? parse_number(wanted) : std::nullopt;
  return number && *number > 0 ? static_cast<int>(*number) : otherwise;
}

struct Counts {
  int pairs = 0, clear = 0, near = 0, hit = 0, at_start = 0, unresolved = 0, unproven_hits = 0;
  long samples = 0;
};

/// One pair of bodies of a machine, and the rows that name it.
class JudgedPair {
 public:
  JudgedPair(const RandomMachine& scene, const machine::Body& a, const machine::Body& b,
             const RunResult& run)
      : scene_(scene), a_(a), b_(b), solid_a_(*a.mesh), solid_b_(*b.mesh) {
    for (const Finding& f : run.findings)
      if ((f.body_a == a.name && f.body_b == b.name) || (f.body_a == b.name && f.body_b == a.name))
        rows_.push_back(&f);
  }

  void judge(Counts& counts) {
    std::string told = "told:";
    for (const Finding* f : rows_)
      told += fmt::format("\n  {} from u {} to {}: {}", to_string(f->kind), f->u_first, f->u_end,
                          f->message);
    SCOPED_TRACE(told);
    ++counts.pairs;
    const auto pose = [&](double u) { return scene_.between(a_, b_, u); };
    truth_ =
        brute_force::sample_motion(solid_a_, solid_b_, pose, 0, 1, scene_.speed(a_, b_), 0.001);
    counts.samples += truth_.samples;
    if (first(Kind::self_overlap) != nullptr) {
      ++counts.at_start;
      EXPECT_TRUE(truth_.first_overlap == 0.0) << "nothing overlaps at the start";
      return;
    }
    for (const Finding* f : rows_)
      if (f->kind == Kind::collision) must_be_a_contact(*f);
    if (const Finding* hit = first(Kind::collision)) {
      ++counts.hit;
      if (truth_.first_overlap) {
        EXPECT_LE(hit->u_first, *truth_.first_overlap + 1e-9) << "told too late";
      }
    } else if (const Finding* open = unresolved()) {
      ++counts.unresolved;
      EXPECT_LE(-*open->depth, resolution + numbers);
      if (!truth_.first_overlap) return;
      ++counts.unproven_hits;
      EXPECT_LE(open->u_first, *truth_.first_overlap + 1e-9) << "told too late";
      must_be_shallow();
    } else if (truth_.first_overlap) {
      ADD_FAILURE() << "MISSED: they overlap at u = " << *truth_.first_overlap;
    } else if (const Finding* near = first(Kind::near_miss)) {
      ++counts.near;
      const double low = *near->value;
      EXPECT_LE(low, truth_.smallest + numbers) << "nearer than told";
      EXPECT_LE(*near->depth_bound, resolution + numbers);
      EXPECT_LT(low, scene_.near);
    } else {
      ++counts.clear;
      EXPECT_GE(truth_.smallest, scene_.near - resolution - numbers) << "nearer than the margin";
    }
  }

 private:
  const Finding* first(Kind kind) const {
    for (const Finding* f : rows_)
      if (f->kind == kind && !f->unresolved) return f;
    return nullptr;
  }
  const Finding* unresolved() const {
    for (const Finding* f : rows_)
      if (f->unresolved) return f;
    return nullptr;
  }
  Pose between(const JointVector& joints) const {
    const std::vector<double> q(joints.begin(), joints.end());
    return scene_.pose(a_, q).inverse(Eigen::Isometry) * scene_.pose(b_, q);
  }
  double distance(const JointVector& joints) const {
    brute_force::Nearest nearest;
    return brute_force::distance(solid_a_, solid_b_, between(joints), nearest);
  }
  // No false alarm: they overlap where it is said to be worst, and all but touch where it begins.
  void must_be_a_contact(const Finding& f) const {
    EXPECT_EQ(distance(f.joints_worst), 0) << "a false alarm";
    EXPECT_LE(distance(f.joints_first), resolution + numbers) << "told too early";
  }
  // An overlap may stay unproven only where no corner shows that it is deep.
  void must_be_shallow() const {
    const bool large = a_.mesh->triangles.size() + b_.mesh->triangles.size() > 500;
    const int times = large ? 8 : 100;
    for (int i = 0; i <= times; ++i) {
      const double u = *truth_.first_overlap + (1 - *truth_.first_overlap) * i / times;
      EXPECT_LE(brute_force::corner_depth(*a_.mesh, Pose::Identity(), *b_.mesh,
                                          scene_.between(a_, b_, u)),
                0.005)
          << "a deep overlap is not proven";
    }
  }

  const RandomMachine& scene_;
  const machine::Body &a_, &b_;
  brute_force::Solid solid_a_, solid_b_;
  std::vector<const Finding*> rows_;
  brute_force::Sampled truth_;
};

void judge_scene(unsigned seed, Counts& counts) {
  const RandomMachine scene = make_random_machine(seed);
  SCOPED_TRACE(fmt::format("AIRCUT_SCENES=1 AIRCUT_SEED={}\n{}", seed, scene.program));
  SourceMap sources;
  CheckOptions options;
  options.near = scene.near;
  options.detailed = seed % 16 == 0 ? 100 : 0;  // depths take most of the time
  const RunResult run = run_program(scene.program, scene.machine, {}, sources, options);
  for (const Diagnostic& d : run.diagnostics.list()) ADD_FAILURE() << format_human(d, {});
  const auto& bodies = scene.machine->bodies();
  for (std::size_t i = 0; i < bodies.size(); ++i)
    for (std::size_t k = i + 1; k < bodies.size(); ++k) {
      const machine::Body &a = bodies[i], &b = bodies[k];
      const bool fixture = a.role == machine::Role::fixture || b.role == machine::Role::fixture;
      if (a.link == b.link || (!fixture && scene.adjacent(a, b))) continue;
      SCOPED_TRACE(a.name + " and " + b.name);
      JudgedPair(scene, a, b, run).judge(counts);
    }
}

TEST(RandomMachines, NeverHideAnOverlap) {
  Counts counts;
  const int n = from_environment("AIRCUT_SCENES", 60);
  const int first = from_environment("AIRCUT_SEED", 1);
  for (int i = 0; i < n && !::testing::Test::HasFailure(); ++i)
    judge_scene(static_cast<unsigned>(first + i), counts);
  fmt::print(
      "{} machines from {}: {} pairs, clear {}, near {}, hit {}, at the start {}, unresolved "
      "{} ({} of them overlap); {} samples\n",
      n, first, counts.pairs, counts.clear, counts.near, counts.hit, counts.at_start,
      counts.unresolved, counts.unproven_hits, counts.samples);
  if (n < 20 || ::testing::Test::HasFailure()) return;
  EXPECT_GT(counts.clear, n / 20);
  EXPECT_GT(counts.near, n / 40);
  EXPECT_GT(counts.hit, n / 5);
  EXPECT_LT(counts.unresolved, n / 20);
}

}  // namespace
}  // namespace aircut::sim
