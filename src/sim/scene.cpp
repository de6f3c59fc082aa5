#include "sim/sim.h"

namespace aircut::sim {

namespace {

// Tool pieces are drawn and checked as solids of revolution; this is how much larger they may be.
constexpr double tool_facet_tolerance = 0.005;  // mm

machine::Role role_of(tool::PieceRole role) {
  switch (role) {
    case tool::PieceRole::cutter:
      return machine::Role::cutter;
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

}  // namespace

Scene::Scene(std::shared_ptr<const machine::Machine> machine, const tool::ToolTable& tools)
    : machine_(std::move(machine)), tools_(tools) {
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

const tool::Tool* Scene::tool() const { return loaded_ == 0 ? nullptr : tools_.find(loaded_); }

void Scene::load_tool(int number) {
  loaded_ = number;
  bodies_.resize(fixed_bodies_);
  const tool::Tool* loaded = tool();
  if (!loaded) return;
  const machine::Spindle& spindle = machine_->spindle();
  for (const tool::Piece& piece : loaded->pieces) {
    machine::Body body;
    body.name = "T" + std::to_string(number) + "/" + piece.name;
    body.role = role_of(piece.role);
    body.link = spindle.link;
    body.mesh = std::make_shared<TriangleMesh>(revolve(piece.profile, tool_facet_tolerance));
    Pose X_LF = translation(spindle.gauge);
    X_LF.linear() = spindle.R_LF;
    body.X_LB = X_LF * translation(Vec3(0, 0, -loaded->gauge_length));  // X_LF · X_FT
    body.color = color_of(piece.role);
    bodies_.push_back({body, std::make_shared<collide::CollisionMesh>(*body.mesh)});
  }
}

}  // namespace aircut::sim
