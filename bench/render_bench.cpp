// Frames a second of the software renderer. The scene stands for a machine in front of which a part
// is cut: some 50,000 triangles in 24 bodies, a third of them in view of the close camera.
#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "render/render.h"

namespace {

using aircut::TriangleMesh;
using aircut::Vec3;
namespace render = aircut::render;

// A ring with a wavy tube: round shading, outlines, no creases. 2 · around · across triangles.
TriangleMesh ring(double radius, double tube, unsigned around, unsigned across) {
  TriangleMesh out;
  const double turn = 2 * std::numbers::pi;
  for (unsigned i = 0; i < around; ++i)
    for (unsigned j = 0; j < across; ++j) {
      const double a = turn * i / around, b = turn * j / across;
      const double r = radius + tube * (1 + 0.2 * std::sin(9 * a)) * std::cos(b);
      out.vertices.emplace_back(r * std::cos(a), r * std::sin(a), tube * std::sin(b));
      const unsigned i1 = (i + 1) % around, j1 = (j + 1) % across;
      out.triangles.push_back({i * across + j, i1 * across + j, i1 * across + j1});
      out.triangles.push_back({i * across + j, i1 * across + j1, i * across + j1});
    }
  return out;
}

render::Scene scene_of(int bodies, unsigned triangles_per_body) {
  render::Scene out;
  const auto across = static_cast<unsigned>(std::lround(std::sqrt(triangles_per_body / 8.0)));
  const auto mesh = std::make_shared<const TriangleMesh>(ring(60, 18, 4 * across, across));
  for (int i = 0; i < bodies; ++i) {
    render::DrawBody body;
    // A mesh of its own, as bodies of a machine have.
    body.mesh = i == 0 ? mesh : std::make_shared<const TriangleMesh>(*mesh);
    body.X_WB = aircut::translation(Vec3(90.0 * (i % 6), 110.0 * (i / 6 % 2), 45.0 * (i / 12)));
    out.bodies.push_back(std::move(body));
  }
  out.caption.left = {"bench", "N1 G0 X0"};
  return out;
}

render::Camera camera_of(const char* name) {
  return *render::camera_by_name(name, aircut::Box3(Vec3(-80, -80, -20), Vec3(530, 190, 70)), 1.6);
}

void draw(benchmark::State& state, const render::Scene& scene, int height = 800) {
  auto renderer = render::Renderer::create({1280, height});
  if (!renderer) return state.SkipWithError(renderer.error().message.c_str());
  const render::Camera camera = camera_of("iso");
  renderer->draw(scene, camera);  // uploads the meshes
  for (auto _ : state) benchmark::DoNotOptimize(renderer->draw(scene, camera).rgba.data());
  std::size_t triangles = 0;
  for (const auto& body : scene.bodies) triangles += body.mesh->triangles.size();
  state.counters["triangles"] = static_cast<double>(triangles);
  state.counters["frames/s"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

void frame_of_50k_triangles(benchmark::State& state) { draw(state, scene_of(24, 2100)); }
BENCHMARK(frame_of_50k_triangles)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

void frame_of_300k_triangles(benchmark::State& state) { draw(state, scene_of(24, 12500)); }
BENCHMARK(frame_of_300k_triangles)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

// A block whose top was milled in rows: a lattice of squares with scallops, walls and a floor.
TriangleMesh milled_block(const aircut::Box3& box, unsigned cells) {
  TriangleMesh out;
  const Vec3 size = box.sizes();
  const unsigned side = cells + 1;
  for (unsigned i = 0; i < side; ++i)
    for (unsigned j = 0; j < side; ++j) {
      const double u = static_cast<double>(i) / cells, v = static_cast<double>(j) / cells;
      const double scallop = 1.5 * std::abs(std::sin(60 * v)),
                   pocket = u * u + v * v < 0.3 ? 18 : 0;
      out.vertices.emplace_back(box.min() +
                                Vec3(u * size.x(), v * size.y(), size.z() - scallop - pocket));
    }
  for (unsigned i = 0; i < cells; ++i)
    for (unsigned j = 0; j < cells; ++j) {
      const unsigned a = i * side + j, b = a + side;
      out.triangles.push_back({a, b, b + 1});
      out.triangles.push_back({a, b + 1, a + 1});
    }
  // The rim in order, down to the middle of the lower face.
  const auto foot = static_cast<unsigned>(out.vertices.size());
  std::vector<unsigned> rim;
  for (unsigned i = 0; i < cells; ++i) rim.push_back(i * side);
  for (unsigned j = 0; j < cells; ++j) rim.push_back(cells * side + j);
  for (unsigned i = cells; i > 0; --i) rim.push_back(i * side + cells);
  for (unsigned j = cells; j > 0; --j) rim.push_back(j);
  for (const unsigned top : rim) {
    Vec3 below = out.vertices[top];
    below.z() = box.min().z();
    out.vertices.push_back(below);
  }
  const auto n = static_cast<unsigned>(rim.size()), middle = foot + n;
  out.vertices.emplace_back(box.center().x(), box.center().y(), box.min().z());
  for (unsigned i = 0; i < n; ++i) {
    const unsigned k = (i + 1) % n;
    out.triangles.push_back({rim[i], foot + i, foot + k});
    out.triangles.push_back({rim[i], foot + k, rim[k]});
    out.triangles.push_back({middle, foot + k, foot + i});
  }
  return out;
}

void frame_of_a_machine_and_a_stock_of_300k_triangles(benchmark::State& state) {
  render::Scene scene = scene_of(24, 1800);
  render::DrawBody stock;
  stock.mesh = std::make_shared<const TriangleMesh>(
      milled_block(aircut::Box3(Vec3(40, -40, 0), Vec3(400, 160, 110)), 385));
  scene.bodies.push_back(std::move(stock));
  draw(state, scene, 960);
}
BENCHMARK(frame_of_a_machine_and_a_stock_of_300k_triangles)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();

void frame_of_one_box(benchmark::State& state) {
  render::Scene scene = scene_of(1, 100);
  scene.bodies[0].mesh =
      std::make_shared<const TriangleMesh>(aircut::make_box(Vec3(0, 0, 0), Vec3(450, 110, 50)));
  draw(state, scene);
}
BENCHMARK(frame_of_one_box)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

void camera_for_finding(benchmark::State& state) {
  auto renderer = render::Renderer::create({1280, 800});
  if (!renderer) return state.SkipWithError(renderer.error().message.c_str());
  render::Scene scene = scene_of(24, 2100);
  scene.bodies[3].highlight = scene.bodies[4].highlight = true;
  for (auto _ : state)
    benchmark::DoNotOptimize(renderer->camera_for_finding(scene.bodies, Vec3(315, 0, 0), 150).eye);
}
BENCHMARK(camera_for_finding)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

void png(benchmark::State& state) {
  auto renderer = render::Renderer::create({1280, 800});
  if (!renderer) return state.SkipWithError(renderer.error().message.c_str());
  const render::Image image = renderer->draw(scene_of(24, 2100), camera_of("iso"));
  std::size_t bytes = 0;
  for (auto _ : state) bytes = render::png_bytes(image).size();
  state.counters["bytes"] = static_cast<double>(bytes);
}
BENCHMARK(png)->Unit(benchmark::kMillisecond);

}  // namespace
