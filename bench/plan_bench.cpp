// Planning speed: moves per second, and how many times faster than the motion itself.
#include <benchmark/benchmark.h>

#include <cmath>
#include <limits>

#include "machine/machine.h"
#include "plan/plan.h"

namespace {

using namespace aircut;

void add_joint(machine::Machine& m, const char* name) {
  machine::Joint joint;
  joint.name = name;
  joint.vmax = 300;
  joint.amax = 3000;
  joint.driven = static_cast<int>(m.driven_.size());
  m.driven_.push_back(static_cast<int>(m.tree_.size()));
  m.tree_.push_back(joint);
}

machine::Machine mill() {
  machine::Machine m;
  for (const char* name : {"X", "Y", "Z"}) add_joint(m, name);
  m.kinematics_ = machine::make_identity({Axis::x, Axis::y, Axis::z});
  return m;
}

machine::Machine ox_glide() {
  machine::Machine m;
  for (const char* name : {"s1", "s2", "s3"}) add_joint(m, name);
  m.kinematics_ = machine::make_ox_glide({});
  return m;
}

AxisValues xyz(double x, double y, double z) {
  AxisValues out;
  out[Axis::x] = x;
  out[Axis::y] = y;
  out[Axis::z] = z;
  return out;
}

struct Path {
  double step;  // mm per move
  double p, q;  // G64
  double feed = 50;
  double turn = 0;  // of `turned`, rad per mm
  std::vector<Axis> turned = {};
};

// A wave of short moves back and forth, as CAM systems write them.
template <class Push>
void wave(const Path& path, int moves, const AxisValues& middle, Push push) {
  push(canon::SetPathMode{canon::PathMode::continuous, path.p});
  push(canon::SetNaiveCam{path.q});
  push(canon::SetFeedRate{path.feed, 0});
  for (int i = 1; i <= moves; ++i) {
    const double a = i * path.step / 20;
    AxisValues tip = middle + xyz(20 * std::sin(a), 10 * std::cos(a), 3 * std::sin(3 * a));
    for (const Axis axis : path.turned)
      tip[axis] += 20 * path.turn * std::sin((1 + static_cast<double>(index(axis))) * a / 3);
    push(canon::LinearFeed{tip});
  }
}

void plan_near(benchmark::State& state, const machine::Machine& machine, const AxisValues& middle,
               const Path& path, const machine::JointVector& near) {
  const auto moves = static_cast<int>(state.range(0));
  const auto start = machine.kinematics().inverse({middle, {}}, near);
  double seconds = 0;
  for (auto _ : state) {
    plan::Planner planner(machine, *start, {});
    std::uint32_t block = 0;
    const auto drain = [&] {
      while (auto segment = planner.take()) seconds += segment->duration();
    };
    wave(path, moves, middle, [&](canon::Action action) {
      canon::Command command;
      command.action = std::move(action);
      command.block = ++block;
      if (!planner.push(command)) state.SkipWithError("refused");
      drain();
    });
    planner.flush();
    drain();
  }
  state.counters["moves/s"] = benchmark::Counter(static_cast<double>(state.iterations()) * moves,
                                                 benchmark::Counter::kIsRate);
  state.counters["x real time"] = benchmark::Counter(seconds, benchmark::Counter::kIsRate);
}

void plan(benchmark::State& state, const machine::Machine& machine, const AxisValues& middle,
          const Path& path) {
  plan_near(state, machine, middle, path, machine::JointVector::Zero(machine.joint_count()));
}

void mill_lines(benchmark::State& state) { plan(state, mill(), {}, {1, 0.02, 0}); }
void mill_short_lines(benchmark::State& state) { plan(state, mill(), {}, {0.05, 0.01, 0}); }
void mill_merged(benchmark::State& state) { plan(state, mill(), {}, {0.05, 0.01, 0.005}); }
void ox_lines(benchmark::State& state) { plan(state, ox_glide(), xyz(250, 0, -310), {1, 0.02, 0}); }
void ox_short_lines(benchmark::State& state) {
  plan(state, ox_glide(), xyz(250, 0, -310), {0.05, 0.01, 0});
}

// Six joints that all move.
machine::Machine six_joints(double jmax = std::numeric_limits<double>::infinity()) {
  machine::Machine m;
  for (const char* name : {"X", "Y", "Z", "A", "B", "C"}) {
    add_joint(m, name);
    m.tree_.back().jmax = jmax;
  }
  m.kinematics_ = machine::make_identity({Axis::x, Axis::y, Axis::z, Axis::a, Axis::b, Axis::c});
  return m;
}
const Path six_lines{
    .step = 1, .p = 0.02, .q = 0, .turn = 0.02, .turned = {Axis::a, Axis::b, Axis::c}};
const Path six_short_lines{
    .step = 0.05, .p = 0.01, .q = 0, .turn = 0.02, .turned = {Axis::a, Axis::b, Axis::c}};
void six_joints_lines(benchmark::State& state) { plan(state, six_joints(), {}, six_lines); }
void six_joints_short_lines(benchmark::State& state) {
  plan(state, six_joints(), {}, six_short_lines);
}
void six_joints_jerk(benchmark::State& state) { plan(state, six_joints(30000), {}, six_lines); }
void six_joints_jerk_short(benchmark::State& state) {
  plan(state, six_joints(30000), {}, six_short_lines);
}

// A shipped machine around its home; `tilt` turns it away from where two axes fall together.
void shipped(benchmark::State& state, const char* name, const AxisValues& tilt, const Path& path) {
  SourceMap sources;
  Diagnostics diagnostics;
  const auto machine = machine::read_machine(std::string(AIRCUT_SOURCE_DIR "/machines/") + name,
                                             sources, diagnostics);
  if (!machine) return state.SkipWithError("no such machine");
  const machine::JointVector home = (*machine)->home();
  const auto tip = (*machine)->kinematics().forward(home, {});
  plan_near(state, **machine, *tip + tilt, path, home);
}

AxisValues tilted(double a, double b) {
  AxisValues out;
  out[Axis::a] = a;
  out[Axis::b] = b;
  return out;
}
const Path lines{.step = 1, .p = 0.02, .q = 0};
const Path short_lines{.step = 0.05, .p = 0.01, .q = 0};
const Path turning_lines{.step = 1, .p = 0.02, .q = 0, .turn = 0.002, .turned = {Axis::a, Axis::c}};
const Path turning_short_lines{
    .step = 0.05, .p = 0.01, .q = 0, .turn = 0.002, .turned = {Axis::a, Axis::c}};
BENCHMARK_CAPTURE(shipped, ox_glide_crossed, "ox-glide-crossed", AxisValues(), lines)
    ->Arg(2000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(shipped, ox_glide_crossed_short, "ox-glide-crossed", AxisValues(), short_lines)
    ->Arg(10000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(shipped, mill5_ac, "mill5-ac", tilted(0.3, 0), turning_lines)
    ->Arg(2000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(shipped, mill5_ac_short, "mill5-ac", tilted(0.3, 0), turning_short_lines)
    ->Arg(10000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(shipped, lola50_6r, "lola50-6r", AxisValues(), turning_lines)
    ->Arg(2000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(shipped, lola50_6r_short, "lola50-6r", AxisValues(), turning_short_lines)
    ->Arg(10000)
    ->Unit(benchmark::kMillisecond);

// The cost of a line against the length of the program.
BENCHMARK(mill_short_lines)
    ->RangeMultiplier(10)
    ->Range(1000, 10000000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(six_joints_lines)->Arg(2000)->Unit(benchmark::kMillisecond);
BENCHMARK(six_joints_short_lines)->Arg(20000)->Unit(benchmark::kMillisecond);
BENCHMARK(six_joints_jerk)->Arg(2000)->Unit(benchmark::kMillisecond);
BENCHMARK(six_joints_jerk_short)->Arg(20000)->Unit(benchmark::kMillisecond);
BENCHMARK(mill_lines)->Arg(10000)->Unit(benchmark::kMillisecond);
BENCHMARK(mill_merged)->Arg(100000)->Unit(benchmark::kMillisecond);
BENCHMARK(ox_lines)->Arg(10000)->Unit(benchmark::kMillisecond);
BENCHMARK(ox_short_lines)->Arg(10000)->Unit(benchmark::kMillisecond);

}  // namespace
