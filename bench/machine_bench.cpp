// Inverse kinematics solves and forward poses per second.

#include <benchmark/benchmark.h>

#include <random>

#include "machine/machine.h"

namespace aircut::machine {
namespace {

std::shared_ptr<const Machine> open(const char* name) {
  static SourceMap sources;
  Diagnostics out;
  const auto machine =
      read_machine(std::string(AIRCUT_SOURCE_DIR "/machines/") + name, sources, out);
  return machine ? *machine : nullptr;
}

// Poses near home, all reachable.
std::vector<Target> targets(const Machine& machine) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> shift(-15, 15);
  const AxisValues home = *machine.kinematics().forward(machine.home(), {});
  std::vector<Target> out(1024);
  for (Target& target : out) {
    target.tip = home;
    for (const Axis axis : {Axis::x, Axis::y, Axis::z}) target.tip[axis] += shift(random);
  }
  return out;
}

void Inverse(benchmark::State& state, const char* name) {
  const auto machine = open(name);
  if (!machine) return state.SkipWithError("the package can't be read");
  const auto poses = targets(*machine);
  const JointVector home = machine->home();
  std::size_t i = 0;
  for (auto _ : state) {
    const auto q = machine->kinematics().inverse(poses[i++ % poses.size()], home);
    if (!q) return state.SkipWithError(q.error().reason.c_str());
    benchmark::DoNotOptimize((*q)[0]);
  }
  state.SetItemsProcessed(state.iterations());
}

void LinkPosesOf(benchmark::State& state, const char* name) {
  const auto machine = open(name);
  if (!machine) return state.SkipWithError("the package can't be read");
  const JointVector home = machine->home();
  LinkPoses poses;
  for (auto _ : state) {
    forward(*machine, home, poses);
    benchmark::DoNotOptimize(poses.X_WL.data());
  }
  state.SetItemsProcessed(state.iterations());
}

BENCHMARK_CAPTURE(Inverse, mill3, "mill3");
BENCHMARK_CAPTURE(Inverse, ox_glide_crossed, "ox-glide-crossed");
BENCHMARK_CAPTURE(LinkPosesOf, mill3, "mill3");
BENCHMARK_CAPTURE(LinkPosesOf, ox_glide_crossed, "ox-glide-crossed");

}  // namespace
}  // namespace aircut::machine
