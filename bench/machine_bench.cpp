// Inverse kinematics solves and forward poses per second.

#include <benchmark/benchmark.h>

#include <random>
#include <string>
#include <utility>
#include <vector>

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

/// A type without a package, with its default parameters, and where it works.
struct Type {
  const char* name;
  double x, y, z, a, b;  ///< mm, deg
};

std::shared_ptr<const Machine> open(const Type& type) {
  static SourceMap sources;
  Diagnostics out;
  const auto machine = bare_machine(type.name, {}, sources, out);
  return machine ? *machine : nullptr;
}

// Poses around the place, all reachable, with their joints.
std::vector<std::pair<Target, JointVector>> places(const Type& type, const Kinematics& kinematics) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> shift(-10, 10);
  constexpr double deg = 0.017453292519943295;
  std::vector<std::pair<Target, JointVector>> out;
  JointVector near = JointVector::Zero(kinematics.joint_count());
  while (out.size() < 1024) {
    Target target;
    target.tip.value = {type.x + shift(random),
                        type.y + shift(random),
                        type.z + shift(random),
                        (type.a + shift(random)) * deg,
                        (type.b + shift(random)) * deg,
                        0,
                        0,
                        0,
                        0};
    const auto q = kinematics.inverse(target, near);
    if (!q) return {};
    near = *q;
    out.emplace_back(target, *q);
  }
  return out;
}

void InverseOf(benchmark::State& state, const Type& type) {
  const auto machine = open(type);
  const auto poses =
      machine ? places(type, machine->kinematics()) : std::vector<std::pair<Target, JointVector>>{};
  if (poses.empty()) return state.SkipWithError("no poses");
  std::size_t i = 0;
  for (auto _ : state) {
    const auto& near = poses[i].second;
    i = (i + 1) % poses.size();
    const auto q = machine->kinematics().inverse(poses[i].first, near);
    benchmark::DoNotOptimize(q->data());
  }
}

void ForwardOf(benchmark::State& state, const Type& type) {
  const auto machine = open(type);
  const auto poses =
      machine ? places(type, machine->kinematics()) : std::vector<std::pair<Target, JointVector>>{};
  if (poses.empty()) return state.SkipWithError("no poses");
  std::size_t i = 0;
  for (auto _ : state) {
    const auto tip = machine->kinematics().forward(poses[i++ % poses.size()].second, {});
    benchmark::DoNotOptimize(tip->value.data());
  }
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
BENCHMARK_CAPTURE(Inverse, mill5_ac, "mill5-ac");
BENCHMARK_CAPTURE(Inverse, mill6_head_table, "mill6-head-table");
BENCHMARK_CAPTURE(Inverse, lathe_slant, "lathe-slant");
BENCHMARK_CAPTURE(Inverse, lola50_6r, "lola50-6r");
BENCHMARK_CAPTURE(Inverse, lola50_horizontal, "lola50-horizontal");
BENCHMARK_CAPTURE(Inverse, lola50_vertical, "lola50-vertical");
BENCHMARK_CAPTURE(LinkPosesOf, lathe_opposed, "lathe-opposed");

const int registered = [] {
  static constexpr Type types[] = {{"calibrated", 0, 0, 0, 0, 0},
                                   {"corexy", 0, 0, 0, 0, 0},
                                   {"gantry", 0, 0, 0, 0, 0},
                                   {"polar", 100, 50, 0, 0, 0},
                                   {"rotated-xy", 0, 0, 0, 0, 0},
                                   {"plotter", 400, -300, 0, 0, 0},
                                   {"biglide", 100, 0, -250, 0, 0},
                                   {"five-bar", 0, 350, 0, 0, 0},
                                   {"tripod", 450, 300, 600, 0, 0},
                                   {"tripod-inverted", 450, 300, -600, 0, 0},
                                   {"triglide", 0, 0, -350, 0, 0},
                                   {"delta-linear", 10, 10, 0, 0, 0},
                                   {"delta-rotary", 10, 10, -350, 0, 0},
                                   {"hexapod", 0, 0, -600, 0, 0},
                                   {"hexaglide", 0, 0, -400, 0, 0},
                                   {"pentapod", 0, 0, 0, 0, 0},
                                   {"scara", 250, 200, 200, 0, 0},
                                   {"scorbot", 200, 50, 150, 0, 0},
                                   {"lathe-vertical", 150, 50, 200, 0, 0},
                                   {"puma", 300, 150, -150, 165, 0},
                                   {"three21", 250, 80, 50, 165, 0},
                                   {"serial", 300, 150, -150, 5, 5},
                                   {"table-ac", 0, 0, -100, 20, 0},
                                   {"head-cb", 0, 0, -100, 0, 20}};
  for (const Type& type : types) {
    benchmark::RegisterBenchmark((std::string("InverseOf/") + type.name).c_str(), InverseOf, type);
    benchmark::RegisterBenchmark((std::string("ForwardOf/") + type.name).c_str(), ForwardOf, type);
  }
  return 0;
}();

}  // namespace
}  // namespace aircut::machine
