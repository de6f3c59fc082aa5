// Displacements of a segment, assembled and in two passes; draws of a batch.
#include <benchmark/benchmark.h>

#include "accuracy/accuracy.h"
#include "base/random.h"

namespace aircut::accuracy {
namespace {

struct Machine {
  std::vector<Body> bodies;
  std::vector<Contact> contacts;
  std::vector<Load> loads;
};

// 12 bodies: a bed with a spindle and its work, and three carriages with slides, turrets and tools.
Machine lathe() {
  Random random(1);
  const auto vec = [&](double size) {
    return Vec3(random.between(-size, size), random.between(-size, size),
                random.between(-size, size));
  };
  Machine out;
  const std::vector<int> parents = {-1, 0, 1, 0, 3, 4, 0, 6, 7, 0, 9, 10};
  for (const int parent : parents) {
    Body body;
    body.parent = parent;
    body.base_point = vec(150);
    body.compliance.e = Vec3(4e-5, 3e-5, 1e-5).asDiagonal();
    body.compliance.xi = Vec3(5e-9, 3e-9, 5e-9).asDiagonal();
    out.bodies.push_back(body);
  }
  for (const int tool : {5, 8, 11, 10}) {
    out.contacts.push_back({tool, 2, vec(100)});
    out.loads.push_back({vec(1000), Vec3::Zero()});
  }
  return out;
}

void TwoPass12Bodies4Contacts(benchmark::State& state) {
  const Machine machine = lathe();
  const Structure structure(machine.bodies);
  Structure::Scratch scratch;
  std::vector<Response> moved(machine.contacts.size());
  for (auto _ : state) {
    structure.respond(machine.contacts, machine.loads, scratch, moved);
    benchmark::DoNotOptimize(moved.data());
    benchmark::ClobberMemory();
  }
}
BENCHMARK(TwoPass12Bodies4Contacts);

void Assemble12Bodies4Contacts(benchmark::State& state) {
  const Machine machine = lathe();
  const Structure structure(machine.bodies);
  for (auto _ : state) benchmark::DoNotOptimize(structure.assemble(machine.contacts));
}
BENCHMARK(Assemble12Bodies4Contacts);

std::vector<ToolShare> two_tools() {
  ToolShare one, two;
  one.gain = {10e-3, 2e-3, -1e-3};
  one.exponent = {1, 0.9, 1};
  one.t = 2;
  one.dt = 0.15;
  two = one;
  two.gain = {-6e-3, -1e-3, 0.5e-3};
  two.t = 1;
  two.dt = 0.3;
  return {one, two};
}

void Draws2Tools(benchmark::State& state) {
  const auto tools = two_tools();
  const Draws draws{.seed = 1, .count = 100'000};
  for (auto _ : state)
    benchmark::DoNotOptimize(monte_carlo(tools, {.epsilon = 0.2, .nu = 0.1}, draws));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(draws.count));
}
BENCHMARK(Draws2Tools);

void ExactField2Tools(benchmark::State& state) {
  const auto tools = two_tools();
  for (auto _ : state) benchmark::DoNotOptimize(exact_field(tools, {.epsilon = 0.2, .nu = 0.1}));
}
BENCHMARK(ExactField2Tools);

}  // namespace
}  // namespace aircut::accuracy
