// Lines interpreted per second: straight G1 lines, mixed lines and arcs, and an O-while loop.

#include <benchmark/benchmark.h>

#include <cmath>

#include "interp/interp.h"

namespace aircut::interp {
namespace {

constexpr const char* head = "G21 G17 G90 G94 G91.1 G64 P0.01\nF3000\nS10000 M3\nG0 X0 Y0 Z5\n";

std::string spiral(int lines) {
  std::string out = head;
  for (int i = 0; i < lines; ++i) {
    const double a = i * 0.01, r = 20 + i * 1e-5;
    out += "G1 X" + fixed(r * std::cos(a), 4) + " Y" + fixed(r * std::sin(a), 4) + " Z" +
           fixed(-1 - 0.5 * std::sin(3 * a), 4) + "\n";
  }
  return out + "M2\n";
}

std::string mixed(int lines) {
  std::string out = head;
  double x = 0, y = 0;
  for (int i = 0; i < lines; i += 4) {
    x += 10;
    out += "G1 X" + fixed(x, 4) + " Y" + fixed(y, 4) + "\n";
    out += "G3 X" + fixed(x + 2, 4) + " Y" + fixed(y + 2, 4) + " I0 J2\n";
    x += 2;
    y += 7;
    out += "G1 X" + fixed(x, 4) + " Y" + fixed(y, 4) + "\n";
    out += "G2 X" + fixed(x + 2, 4) + " Y" + fixed(y + 2, 4) + " I2 J0\n";
    x += 2;
    y += 2;
    if (x > 500) {
      x = y = 0;
      out += "G0 X0 Y0\n";
    }
  }
  return out + "M2\n";
}

std::string loop(int passes) {
  return std::string(head) + "#1=0\no100 while [#1 lt " + std::to_string(passes) +
         "]\n  G1 X[20*cos[#1]] Y[20*sin[#1]] Z[0-#1/" + std::to_string(passes) +
         "]\n  #1=[#1+1]\no100 endwhile\nM2\n";
}

void interpret(benchmark::State& state, const std::string& text, std::int64_t lines) {
  SourceMap sources;
  const SourceText& program = sources.add("bench.ngc", text);
  Options options;
  for (const Axis axis : {Axis::x, Axis::y, Axis::z}) options.axes.add(axis);
  for (auto _ : state) {
    Diagnostics diagnostics;
    Interpreter interpreter(
        program, {}, {}, options, [&](const std::string& path) { return sources.open(path); },
        diagnostics);
    std::int64_t commands = 0;
    while (interpreter.next()) ++commands;
    if (diagnostics.errors() > 0) {
      state.SkipWithError(diagnostics.list().front().message.c_str());
      return;
    }
    benchmark::DoNotOptimize(commands);
  }
  state.SetItemsProcessed(state.iterations() * lines);
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(text.size()));
}

void StraightLines(benchmark::State& state) { interpret(state, spiral(100'000), 100'000); }
void LinesAndArcs(benchmark::State& state) { interpret(state, mixed(100'000), 100'000); }
void WhileLoopPasses(benchmark::State& state) { interpret(state, loop(100'000), 100'000); }

// The bound: looking at every byte once.
void BareScan(benchmark::State& state) {
  const std::string text = spiral(100'000);
  for (auto _ : state) {
    std::uint64_t digits = 0;
    for (const char c : text) digits += c >= '0' && c <= '9' ? 1 : 0;
    benchmark::DoNotOptimize(digits);
  }
  state.SetItemsProcessed(state.iterations() * 100'000);
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(text.size()));
}

BENCHMARK(StraightLines)->Unit(benchmark::kMillisecond);
BENCHMARK(LinesAndArcs)->Unit(benchmark::kMillisecond);
BENCHMARK(WhileLoopPasses)->Unit(benchmark::kMillisecond);
BENCHMARK(BareScan)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace aircut::interp
