#include <algorithm>

#include "sim/sim.h"
#include "tool/insert.h"

namespace aircut::sim {

namespace {

// Tool pieces are drawn and checked as solids of revolution; this is how much larger they may be.
constexpr double tool_facet_tolerance = 0.005;  // mm

machine::Role role_of(tool::PieceRole role, bool probe) {
  switch (role) {
    case tool::PieceRole::cutter:
      return probe ? machine::Role::probe : machine::Role::cutter;
    case tool::PieceRole::shank:
      return machine::Role::shank;
    case tool::PieceRole::holder:
      return machine::Role::holder;
  }
  return machine::Role::holder;
}

machine::Color color_of(tool::PieceRole role) {
  switch (role) {
    case tool::PieceRole::cutter:
      return {214, 178, 74};
    case tool::PieceRole::shank:
      return {188, 192, 198};
    case tool::PieceRole::holder:
      return {96, 102, 112};
  }
  return {};
}

// A block as a body: its outline at both ends of its reach along Y, and walls between them.
TriangleMesh prism(const tool::Block& block) {
  TriangleMesh out;
  const auto n = static_cast<std::uint32_t>(block.outline.size());
  for (const double y : {block.y_low, block.y_high})
    for (const auto& [x, z] : block.outline) out.vertices.emplace_back(x, y, z);
  // The outline goes from +X towards +Z, so seen from below it is counter-clockwise.
  for (std::uint32_t i = 1; i + 1 < n; ++i) {
    out.triangles.push_back({0, i, i + 1});
    out.triangles.push_back({n, n + i + 1, n + i});
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    out.triangles.push_back({i, n + j, j});
    out.triangles.push_back({i, n + i, n + j});
  }
  return out;
}

}  // namespace

Scene::Scene(std::shared_ptr<const machine::Machine> machine, const tool::ToolTable& tools,
             std::vector<Seat> seats)
    : machine_(std::move(machine)),
      tools_(tools),
      seats_(std::move(seats)),
      loaded_(std::max<std::size_t>(seats_.size(), 1), 0) {
  // Bodies that share a mesh (two equal rods) share its tree.
  std::map<const TriangleMesh*, std::shared_ptr<const collide::CollisionMesh>> trees;
  for (const machine::Body& body : machine_->bodies()) {
    std::shared_ptr<const collide::CollisionMesh> tree;
    if (body.collide && body.mesh) {
      auto& shared = trees[body.mesh.get()];
      if (!shared) shared = std::make_shared<collide::CollisionMesh>(*body.mesh);
      tree = shared;
    }
    bodies_.push_back({body, tree});
  }
  fixed_bodies_ = bodies_.size();
}

const tool::Tool* Scene::tool(std::size_t seat) const {
  return loaded_[seat] == 0 ? nullptr : tools_.find(loaded_[seat]);
}

void Scene::load_tool(int number, std::size_t seat) {
  loaded_[seat] = number;
  bodies_.resize(fixed_bodies_);
  for (std::size_t i = 0; i < loaded_.size(); ++i) add_tool(i);
}

void Scene::load_tools(const std::vector<int>& numbers) {
  for (std::size_t i = 0; i < loaded_.size() && i < numbers.size(); ++i)
    if (loaded_[i] != numbers[i]) load_tool(numbers[i], i);
}

void Scene::add_tool(std::size_t seat) {
  const tool::Tool* loaded = tool(seat);
  if (!loaded) return;
  const machine::Spindle& spindle = seats_.empty() ? machine_->spindle() : seats_[seat].spindle;
  const std::string owner = seats_.empty() ? "" : seats_[seat].channel + ":";
  Pose X_LF = translation(spindle.gauge);
  X_LF.linear() = spindle.R_LF;
  const auto add = [&](const std::string& name, tool::PieceRole role, TriangleMesh mesh,
                       const Vec3& from_gauge) {
    machine::Body body;
    body.name = owner + "T" + std::to_string(loaded_[seat]) + "/" + name;
    body.role = role_of(role, tool::is_probe(*loaded));
    body.link = spindle.link;
    body.mesh = std::make_shared<TriangleMesh>(std::move(mesh));
    body.X_LB = X_LF * translation(from_gauge);  // X_LF · X_FT
    body.color = color_of(role);
    bodies_.push_back({body, std::make_shared<collide::CollisionMesh>(*body.mesh)});
  };
  for (const tool::Piece& piece : loaded->pieces)
    add(piece.name, piece.role, revolve(piece.profile, tool_facet_tolerance),
        Vec3(0, 0, -loaded->gauge_length));
  // Seen from the controlled point, which is the offset away from the gauge point.
  for (const tool::Block& block : loaded->blocks)
    add(block.name, block.role, prism(block),
        -Vec3(loaded->offset[Axis::x], loaded->offset[Axis::y], loaded->offset[Axis::z]));
}

}  // namespace aircut::sim
