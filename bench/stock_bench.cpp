// Material removal: a pocket of 50 000 moves at three pitches, CPU seconds and resident bytes.
#include <benchmark/benchmark.h>

#include <cmath>
#include <ctime>
#include <span>

#include "stock/stock.h"

namespace {

using namespace aircut;

// A zig-zag in a block of 100 x 100 x 20 mm: 80 x 80 mm, 4 mm step-over, layers of 0.5 mm, moves of
// 1 mm with a ripple of 0.1 mm in Z, so that hardly a move is level.
std::vector<stock::Piece> pocket(const stock::CutterProfile& cutter, std::size_t moves) {
  std::vector<stock::Piece> out;
  Vec3 at(0, 0, 5);
  const auto go = [&](const Vec3& to, bool cuts) {
    if (cuts) {
      stock::Piece piece{.cutter = &cutter, .start = at, .end = to};
      piece.move = static_cast<std::uint32_t>(out.size());
      out.push_back(piece);
    }
    at = to;
  };
  const double low = -40, high = 40;
  for (int layer = 1; out.size() < moves; ++layer) {
    const double z = -0.5 * layer;
    go({low, low, 5}, false);
    go({low, low, z}, true);
    bool forward = true;
    for (double y = low; y <= high + 1e-9 && out.size() < moves; y += 4) {
      for (int i = 1; i <= 80 && out.size() < moves; ++i) {
        const double x = forward ? low + i : high - i;
        go({x, y, z + 0.1 * std::sin(0.3 * x) * std::cos(0.3 * y)}, true);
      }
      if (y + 4 <= high + 1e-9) go({at.x(), y + 4, at.z()}, true);
      forward = !forward;
    }
  }
  return out;
}

void cut(benchmark::State& state, const stock::CutterProfile& cutter) {
  const double pitch = static_cast<double>(state.range(0)) / 1000;
  const auto pieces = pocket(cutter, 50000);
  double bytes = 0, volume = 0;
  for (auto _ : state) {
    auto material = stock::Stock::make(stock::Box{{-50, -50, -20}, {50, 50, 0}}, pitch);
    const auto removed = material->cut(pieces);
    if (!removed) state.SkipWithError(removed.error().message.c_str());
    volume = 0;
    for (const stock::Removal& r : *removed) volume += r.volume;
    bytes = static_cast<double>(material->bytes());
  }
  state.counters["MB"] = bytes / 1e6;
  state.counters["cm3"] = volume / 1000;
}

void mesh(benchmark::State& state) {
  const auto cutter = *stock::CutterProfile::flat(10, 30);
  const double pitch = static_cast<double>(state.range(0)) / 1000;
  auto material = stock::Stock::make(stock::Box{{-50, -50, -20}, {50, 50, 0}}, pitch);
  if (!material->cut(pocket(cutter, 5000))) state.SkipWithError("refused");
  std::size_t triangles = 0;
  for (auto _ : state) triangles = material->mesh().triangles.size();
  state.counters["triangles"] = static_cast<double>(triangles);
}

// A surface of waves, 100 x 100 mm, as a finishing program has it: rows of 0.1 mm moves, half a
// millimetre apart.
void surface(benchmark::State& state) {
  const double pitch = static_cast<double>(state.range(0)) / 1000;
  const auto cutter = *stock::CutterProfile::ball(10, 30);
  const auto place = [](int row, int i) {
    const double x = (row % 2 == 0 ? i : 1000 - i) * 0.1 - 50, y = row * 0.5 - 50;
    return Vec3(x, y, -6 + 3 * std::sin(x / 8) * std::cos(y / 9));
  };
  std::vector<stock::Piece> pieces;
  for (int row = 0; row < 200; ++row)
    for (int i = 0; i < 1000; ++i)
      pieces.push_back({.cutter = &cutter,
                        .start = place(row, i),
                        .end = place(row, i + 1),
                        .move = static_cast<std::uint32_t>(pieces.size())});
  for (auto _ : state) {
    auto material = stock::Stock::make(stock::Box{{-50, -50, -20}, {50, 50, 0}}, pitch);
    if (!material->cut(pieces)) state.SkipWithError("refused");
    state.counters["MB"] = static_cast<double>(material->bytes()) / 1e6;
  }
}

// The pocket with a tool that leans by up to 15°, three pieces a move, as a turn is cut.
void tilted(benchmark::State& state) {
  const double pitch = static_cast<double>(state.range(0)) / 1000;
  const auto cutter = *stock::CutterProfile::flat(10, 30);
  constexpr int parts = 3;
  std::vector<stock::Piece> pieces;
  for (const stock::Piece& whole : pocket(cutter, 50000))
    for (int k = 0; k < parts; ++k) {
      stock::Piece piece = whole;
      const Vec3 way = whole.end - whole.start;
      piece.start = whole.start + way * k / parts;
      piece.end = whole.start + way * (k + 1) / parts;
      const double angle = 15 * M_PI / 180 * std::sin(0.05 * piece.start.x());
      piece.axis = Vec3(std::sin(angle), 0, std::cos(angle));
      pieces.push_back(piece);
    }
  for (auto _ : state) {
    auto material = stock::Stock::make(stock::Box{{-50, -50, -20}, {50, 50, 0}}, pitch);
    if (!material->cut(pieces)) state.SkipWithError("refused");
    state.counters["MB"] = static_cast<double>(material->bytes()) / 1e6;
  }
}

// A million moves, ten pockets of a hundred thousand beside one another: seconds of the first and
// of the last one.
void history(benchmark::State& state) {
  const auto cutter = *stock::CutterProfile::flat(10, 30);
  const auto one = pocket(cutter, 100'000);
  for (auto _ : state) {
    auto material = stock::Stock::make(stock::Box{{-50, -50, -32}, {950, 50, 0}}, 0.25);
    for (int k = 0; k < 10; ++k) {
      auto pieces = one;
      for (stock::Piece& piece : pieces) {
        piece.start.x() += 100 * k;
        piece.end.x() += 100 * k;
      }
      const std::clock_t begin = std::clock();
      if (const auto cut = material->cut(pieces); !cut)
        state.SkipWithError(cut.error().message.c_str());
      const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
      if (k == 0) state.counters["first_s"] = seconds;
      state.counters["last_s"] = seconds;
    }
    state.counters["MB"] = static_cast<double>(material->bytes()) / 1e6;
  }
}

void flat(benchmark::State& state) { cut(state, *stock::CutterProfile::flat(10, 30)); }
void ball(benchmark::State& state) { cut(state, *stock::CutterProfile::ball(10, 30)); }
void bull(benchmark::State& state) { cut(state, *stock::CutterProfile::bull(10, 1, 30)); }

// The argument is the pitch in µm.
BENCHMARK(flat)->Arg(250)->Arg(100)->Arg(50)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK(ball)->Arg(250)->Arg(100)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK(bull)->Arg(250)->Arg(100)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK(surface)->Arg(250)->Arg(100)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK(tilted)->Arg(250)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK(history)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK(mesh)->Arg(250)->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace
