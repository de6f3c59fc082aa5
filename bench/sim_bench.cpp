// The proof of clearance over a whole job: 50 000 five-axis moves close above the work on mill5-ac,
// whose meshes are cut finer until they have 500 000 triangles, with margins of 2 mm.
#include <benchmark/benchmark.h>
#include <stdlib.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "geometry/mesh_file.h"
#include "sim/sim.h"

namespace {

using namespace aircut;
namespace fs = std::filesystem;

// Each triangle in four.
TriangleMesh finer(const TriangleMesh& mesh) {
  TriangleMesh out;
  for (const auto& t : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(out.vertices.size());
    for (std::size_t i = 0; i < 3; ++i) out.vertices.push_back(mesh.vertices[t[i]]);
    for (std::size_t i = 0; i < 3; ++i)
      out.vertices.push_back(
          0.5 * (mesh.vertices[t[i]] + mesh.vertices[t[(i + 1) % 3]]));  // 3: 01, 4: 12, 5: 20
    for (const auto& [a, b, c] : {std::array{0u, 3u, 5u}, {3u, 1u, 4u}, {5u, 4u, 2u}, {3u, 4u, 5u}})
      out.triangles.push_back({first + a, first + b, first + c});
  }
  return out;
}

// A copy of the package with finer meshes, in a folder of its own.
class DenseMachine {
 public:
  explicit DenseMachine(std::size_t wanted) {
    std::string name = (fs::temp_directory_path() / "aircut-dense-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
    const fs::path package = folder_ / "mill5-ac";
    fs::copy(AIRCUT_SOURCE_DIR "/machines/mill5-ac", package, fs::copy_options::recursive);
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(package / "meshes"))
      files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    std::vector<TriangleMesh> meshes;
    for (const fs::path& file : files) meshes.push_back(*read_mesh(file.string()));
    for (;;) {
      triangles_ = 0;
      for (const TriangleMesh& mesh : meshes) triangles_ += mesh.triangles.size();
      if (triangles_ >= wanted) break;
      const auto coarsest = std::max_element(
          meshes.begin(), meshes.end(),
          [](const TriangleMesh& a, const TriangleMesh& b) { return longest(a) < longest(b); });
      *coarsest = finer(*coarsest);
    }
    for (std::size_t i = 0; i < files.size(); ++i)
      std::ofstream(files[i], std::ios::binary) << stl_bytes(meshes[i]);
    Diagnostics out;
    machine_ = *machine::read_machine(package.string(), sources_, out);
    tools_ = *tool::read_tools((package / "tools.toml").string(), 1, sources_, out);
  }
  ~DenseMachine() { fs::remove_all(folder_); }

  std::shared_ptr<const machine::Machine> machine() const { return machine_; }
  const tool::ToolTable& tools() const { return tools_; }
  SourceMap& sources() { return sources_; }
  std::size_t triangles() const { return triangles_; }

 private:
  static double longest(const TriangleMesh& mesh) {
    double most = 0;
    for (const auto& t : mesh.triangles)
      for (std::size_t i = 0; i < 3; ++i)
        most = std::max(most, (mesh.vertices[t[i]] - mesh.vertices[t[(i + 1) % 3]]).norm());
    return most;
  }
  fs::path folder_;
  SourceMap sources_;
  std::shared_ptr<const machine::Machine> machine_;
  tool::ToolTable tools_;
  std::size_t triangles_ = 0;
};

// A zig-zag of 1 mm moves over the fixture, the tool leaning by up to 15°.
std::string program(int moves) {
  std::string text =
      "G21 G90 G17 G94 G54 G64 P0.005\nG10 L2 P1 X0 Y0 Z140\nG53 G0 Z300\nT1 M6\nS8000 M3\nG43 H1\n"
      "G0 X-20 Y-20 Z40\nG0 A-15 C0\nF3000\n";
  for (int i = 0; i < moves; ++i) {
    const int row = i / 40 % 40, along = i % 40;
    const double x = (row % 2 == 0 ? along : 39 - along) - 19.5, y = row - 19.5;
    text += "G1 X" + fixed(x, 3) + " Y" + fixed(y, 3) + " Z" +
            fixed(12 + 2 * std::sin(0.01 * i), 3) + " A" + fixed(-10 + 5 * std::sin(0.02 * i), 3) +
            " C" + fixed(15 * std::sin(0.013 * i), 3) + "\n";
  }
  return text + "G0 Z60\nM2\n";
}

sim::Simulator::Result run_dense(DenseMachine& dense, const SourceText& text,
                                 const sim::CheckOptions& checks, Diagnostics& diagnostics) {
  interp::Options options;
  options.axes = dense.machine()->kinematics().axes();
  const machine::JointVector start = dense.machine()->home();
  if (const auto tip = dense.machine()->kinematics().forward(start, {})) options.start = *tip;
  interp::Interpreter interpreter(
      text, dense.tools(), {}, options,
      [&](const std::string& path) { return dense.sources().open(path); }, diagnostics);
  plan::Planner planner(*dense.machine(), start, {});
  sim::Simulator simulator(dense.machine(), dense.tools(), start, checks);
  return sim::run(interpreter, diagnostics, planner, simulator, {});
}

void prove_five_axes(benchmark::State& state) {
  DenseMachine dense(500'000);
  const SourceText& text =
      dense.sources().add("dense.ngc", program(static_cast<int>(state.range(0))));
  sim::Summary summary;
  std::size_t findings = 0;
  for (auto _ : state) {
    Diagnostics diagnostics;
    const auto result =
        run_dense(dense, text, {.limits = false, .cut = false, .near = 2}, diagnostics);
    summary = result.summary;
    findings = result.findings.size();
    if (diagnostics.errors() > 0) state.SkipWithError("the program was refused");
  }
  state.counters["triangles"] = static_cast<double>(dense.triangles());
  state.counters["pairs"] = static_cast<double>(summary.collision.pairs);
  state.counters["clear_%"] = 100 * summary.collision.clear;
  state.counters["findings"] = static_cast<double>(findings);
}
BENCHMARK(prove_five_axes)->Arg(50'000)->Unit(benchmark::kSecond)->Iterations(1);

// The same plan with nothing checked: what is left of the figure above is the proof.
void plan_five_axes(benchmark::State& state) {
  DenseMachine dense(0);
  const SourceText& text =
      dense.sources().add("dense.ngc", program(static_cast<int>(state.range(0))));
  for (auto _ : state) {
    Diagnostics diagnostics;
    run_dense(dense, text, {.limits = false, .collision = false, .cut = false}, diagnostics);
  }
}
BENCHMARK(plan_five_axes)->Arg(50'000)->Unit(benchmark::kSecond)->Iterations(1);

}  // namespace
