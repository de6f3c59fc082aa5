// `aircut workspace`: what a machine reaches, on a grid: share, volume, extent, largest box.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numbers>

#include "cli/exit_code.h"
#include "cli/job.h"
#include "cli/rows.h"
#include "cli/workspace_picture.h"
#include "machine/workspace/workspace_files.h"
#include "sim/pose_check.h"

namespace aircut::cli {

namespace {

constexpr double degree = std::numbers::pi / 180;

// `A:B`, or one number for both ends.
tl::expected<std::pair<double, double>, std::string> range_of(const std::string& option,
                                                              const std::string& text) {
  const std::size_t colon = text.find(':');
  const auto low = number_of(text.substr(0, colon));
  const auto high = colon == text.npos ? low : number_of(text.substr(colon + 1));
  if (!low || !high || *low > *high || std::abs(*low) > 1e6 || std::abs(*high) > 1e6)
    return unexpected(option + " needs FROM:TO with FROM below TO, or one number; this is '" +
                      printable(text) + "'");
  return std::pair(*low, *high);
}

std::string dimensions(const Vec3& size, const std::array<int, 3>& count) {
  std::string text;
  for (int a = 0; a < 3; ++a)
    if (count[static_cast<std::size_t>(a)] > 1)
      text += (text.empty() ? "" : " x ") + shortest(std::round(size[a] * 1e6) / 1e6);
  return text.empty() ? "one point" : text + " mm";
}

std::string text_of(const machine::Workspace& w, const machine::GridBox& box, double margin) {
  const Vec3 low = w.place(box.first[0], box.first[1], box.first[2]);
  const Vec3 high = w.place(box.last[0], box.last[1], box.last[2]);
  std::string text;
  for (int a = 0; a < 3; ++a) {
    const double m = w.count()[static_cast<std::size_t>(a)] > 1 ? margin : 0;
    text +=
        std::string(a ? ", " : "") + "XYZ"[a] + " " +
        shortest(std::round((low[a] - m) * 1e6) / 1e6) +
        (m > 0 || high[a] > low[a] ? " … " + shortest(std::round((high[a] + m) * 1e6) / 1e6) : "");
  }
  return text;
}

void print_workspace(const machine::Machine& machine, const machine::Workspace& w,
                     const machine::WorkspaceQuery& query) {
  const auto percent = [](long part, long whole) {
    return fixed(whole > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : 0, 1);
  };
  int dimension = 0;
  for (const int n : w.count()) dimension += n > 1;
  const long reached = w.reached();
  std::printf("%s: %d x %d x %d %s, pitch %s mm, %zu tilt%s\n", printable(machine.name()).c_str(),
              w.count()[0], w.count()[1], w.count()[2], query.nodes ? "nodes" : "cells",
              shortest(query.pitch).c_str(), std::max<std::size_t>(1, query.tilts.size()),
              query.tilts.size() > 1 ? "s" : "");
  std::printf("  reached      %ld of %ld (%s %%), %s %% of them at the border\n", reached,
              w.points(), percent(reached, w.points()).c_str(),
              percent(w.at_border(), reached).c_str());
  // Nodes have no size: a cell of one pitch belongs to each.
  if (dimension > 1)
    std::printf("  %s       %s mm%s\n", dimension == 2 ? "area  " : "volume",
                shortest(static_cast<double>(reached) * std::pow(query.pitch, dimension)).c_str(),
                dimension == 2 ? "²" : "³");
  const double half = query.nodes ? 0 : query.pitch / 2;
  if (reached > 0) {
    std::printf("  extent       %s\n", text_of(w, w.extent(), half).c_str());
    const machine::GridBox box = w.largest_box();
    const Vec3 size = w.place(box.last[0], box.last[1], box.last[2]) -
                      w.place(box.first[0], box.first[1], box.first[2]) + Vec3::Constant(2 * half);
    std::printf("  largest box  %s: %s, %ld points; its faces are certain to half a pitch\n",
                text_of(w, box, half).c_str(), dimensions(size, w.count()).c_str(), box.points());
  }
  for (std::size_t j = 0; j < w.failures().size(); ++j) {
    if (w.failures()[j] == 0) continue;
    const auto joints = static_cast<std::size_t>(machine.joint_count());
    const std::string why =
        j < joints
            ? "joint " + printable(machine.joint(machine::JointId{static_cast<int>(j)}).name) +
                  " beyond its travel"
        : j == joints ? "no solution"
                      : "bodies touch";
    std::printf("  not reached  %ld: %s\n", w.failures()[j], why.c_str());
  }
}

// Nothing of what can be wrong with an output is found after the search.
Expected<void> check_outputs(const WorkspaceArguments& a) {
  for (const std::string& path : a.output) {
    const std::string ending = std::filesystem::path(path).extension().string();
    if (ending != ".csv" && ending != ".npy" && ending != ".stl" && ending != ".png")
      return unexpected(make_error(
          "usage", "the name of '" + printable(path) + "' must end in .csv, .npy, .stl or .png"));
    std::error_code error;
    if (std::filesystem::exists(path, error) && !a.force)
      return unexpected(
          make_error("output_failed", "'" + printable(path) + "' exists; use --force"));
  }
  return {};
}

// What a picture says below: how the points were chosen, and what stands in it.
std::vector<std::string> picture_notes(const WorkspaceArguments& a,
                                       const machine::WorkspaceQuery& query) {
  std::vector<std::string> notes = {"pitch " + shortest(query.pitch) + " mm" +
                                    (a.nodes ? ", nodes" : ", middles of cells")};
  const auto tilt = [&](const char* name, const std::string& range) {
    if (!range.empty()) notes.front() += std::string(", ") + name + " " + range + "°";
  };
  tilt("A", a.a);
  tilt("B", a.b);
  if (a.tool != 0) notes.front() += ", tip of tool T" + std::to_string(a.tool);
  if (a.connected) notes.front() += ", connected with home";
  if (a.free) notes.front() += ", free of collision";
  return notes;
}

// Which of the tilts is none: the picture shows both.
std::optional<machine::Workspace> without_tilts(const machine::Machine& machine,
                                                machine::WorkspaceQuery query) {
  if (query.tilts.size() < 2) return std::nullopt;
  query.tilts.clear();
  return machine::Workspace::of(machine, query);
}

Expected<void> write_outputs(const WorkspaceArguments& a, const machine::Machine& machine,
                             const machine::WorkspaceQuery& query,
                             const machine::Workspace& workspace) {
  for (const std::string& path : a.output) {
    const std::string ending = std::filesystem::path(path).extension().string();
    std::string bytes;
    if (ending == ".png") {
      auto picture = workspace_picture(machine, workspace, without_tilts(machine, query),
                                       picture_notes(a, query));
      if (!picture) return unexpected(picture.error());
      bytes = std::move(*picture);
    } else {
      bytes = ending == ".csv"   ? machine::workspace_csv(workspace)
              : ending == ".npy" ? machine::workspace_npy(workspace)
                                 : stl_bytes(machine::workspace_solid(workspace));
    }
    if (auto written = write_file(path, bytes); !written) return written;
    std::printf("  written      %s\n", printable(path).c_str());
  }
  return {};
}

}  // namespace

int workspace_command(const WorkspaceArguments& a) {
  const auto fail = [&](const std::string& kind, const std::string& message) {
    print_error(make_error(kind, message), a.color);
    return code(ExitCode::unknown);
  };
  if (const auto good = check_outputs(a); !good)
    return fail(good.error().kind, good.error().message);
  Job job;
  ProgramArguments inputs;
  inputs.machine = a.machine;
  inputs.ini_use = ProgramArguments::IniUse::machine;
  inputs.tools = a.tools;
  inputs.setup = a.setup;
  const bool opened = open_inputs(job, inputs);
  print_errors(job.diagnostics, a.color);
  if (!opened) return code(ExitCode::unknown);
  const machine::Machine& machine = *job.machine;

  machine::WorkspaceQuery query;
  query.pitch = a.pitch;
  query.nodes = a.nodes;
  if (!(query.pitch >= 1e-3 && query.pitch <= 1e5))
    return fail("usage", "--pitch needs millimetres from 0.001 to 100000");
  const bool guess = a.x.empty() || a.y.empty() || a.z.empty();
  const auto box = guess ? machine::reach_box(machine) : std::optional<Box3>(Box3());
  if (!box) return fail("input", "no joints inside the travel can be assembled");
  for (int axis = 0; axis < 3; ++axis) {
    const std::string& text = axis == 0 ? a.x : axis == 1 ? a.y : a.z;
    std::pair<double, double> ends;
    if (text.empty()) {  // grown to whole pitches
      ends = {std::floor(box->min()[axis] / query.pitch) * query.pitch,
              std::ceil(box->max()[axis] / query.pitch) * query.pitch};
    } else {
      const auto range = range_of(std::string("--") + "xyz"[axis], text);
      if (!range) return fail("usage", range.error());
      ends = *range;
    }
    query.low[axis] = ends.first;
    query.high[axis] = ends.second;
  }
  const auto tilt_a = range_of("--tilt-a", a.a.empty() ? "0" : a.a);
  const auto tilt_b = range_of("--tilt-b", a.b.empty() ? "0" : a.b);
  if (!tilt_a || !tilt_b) return fail("usage", (tilt_a ? tilt_b : tilt_a).error());
  for (const auto& [axis, text] : {std::pair(Axis::a, &a.a), std::pair(Axis::b, &a.b)})
    if (!text->empty() && !machine.kinematics().axes().has(axis))
      return fail("usage", std::string("this machine has no axis ") + letter(axis));
  query.tilts = machine::tilts_of_box(tilt_a->first * degree, tilt_a->second * degree,
                                      tilt_b->first * degree, tilt_b->second * degree);
  sim::Scene scene(job.machine, job.tools);
  scene.load_tool(a.tool);
  if (a.tool != 0 && !scene.tool())
    return fail("usage", "tool T" + std::to_string(a.tool) + " is not in the tool table");
  if (a.tool != 0) query.tool_offset = scene.tool()->offset;
  query.threads = a.threads;
  std::optional<sim::PoseCheck> bodies;
  if (a.free) {
    bodies.emplace(std::move(scene), job.start);
    if (bodies->pairs() == 0)
      return fail("input", "this machine has no two bodies that could touch");
    for (const std::string& pair : bodies->left_out())
      std::printf("  left out     %s: they touch at home\n", printable(pair).c_str());
    query.is_free = [&](const machine::JointVector& q) { return bodies->is_free(q); };
  }
  auto workspace = machine::Workspace::of(machine, query);
  if (!workspace)
    return fail("usage", "the grid has more than " +
                             std::to_string(machine::Workspace::max_points) +
                             " points; take a larger --pitch or smaller ranges");
  if (a.connected) {
    const auto home = machine.kinematics().forward(machine.home(), {});
    if (!home || !workspace->keep_connected({(*home)[Axis::x], (*home)[Axis::y], (*home)[Axis::z]}))
      return fail("input", "the point of the grid that is nearest to home is not reached");
  }
  print_workspace(machine, *workspace, query);
  if (const auto written = write_outputs(a, machine, query, *workspace); !written)
    return fail(written.error().kind, written.error().message);
  return code(workspace->reached() > 0 ? ExitCode::pass : ExitCode::fail);
}

}  // namespace aircut::cli
