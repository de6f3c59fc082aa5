// The elastic machine: a forest of bodies over ground, each a rigid body on an elastic joint, and
// the displacements that the forces of all cutting tools cause together. Everything in the machine
// frame M; mm, N, rad, N·mm.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "accuracy/beam.h"

namespace aircut::accuracy {

using Mat6 = Eigen::Matrix<double, 6, 6>;

/// What an elastic joint gives way to, for its base point. A force f and a moment m about the base
/// point move that point by e f + c m and turn the body by cᵀ f + ξ m.
struct Compliance {
  Mat3 e = Mat3::Zero();   ///< mm/N
  Mat3 c = Mat3::Zero();   ///< mm/(N·mm) = rad/N
  Mat3 xi = Mat3::Zero();  ///< rad/(N·mm)
};

constexpr int ground = -1;

struct Body {
  std::string name;
  int parent = ground;  ///< index of the body that carries it
  Vec3 base_point = Vec3::Zero();
  Compliance compliance;
  std::optional<Beam> beam;  ///< replaces `compliance`; such a body carries no other
};

/// One engaged tool on one workpiece.
struct Contact {
  int tool_body = ground;
  int work_body = ground;
  Vec3 point = Vec3::Zero();  ///< where the cutting force acts
};

/// On the tool; the work receives the opposite.
struct Load {
  Vec3 force = Vec3::Zero();
  Vec3 moment = Vec3::Zero();  ///< free moment (drilling torque), N·mm
};

/// Tool minus work, at the contact's point.
struct Response {
  Vec3 displacement = Vec3::Zero();
  Vec3 rotation = Vec3::Zero();
};

Mat3 skew(const Vec3& r);  ///< skew(r) v = r × v

/// Displacement and rotation of the material point of `body` at `at`, for a force and free moment
/// on the body at `load_at`; the joint of the body alone.
Mat6 body_influence(const Body& body, const Vec3& at, const Vec3& load_at);

/// All bodies with parents before children; shorter than `parents` when there is a cycle (those in
/// it and behind it are left out).
std::vector<int> parents_first(std::span<const int> parents);

/// The assembled compliance of n contacts: every contact's load on every contact's displacement.
class Influence {
 public:
  explicit Influence(std::size_t contacts) : n_(contacts), blocks_(n_ * n_, Mat6::Zero()) {}
  std::size_t size() const { return n_; }
  const Mat6& block(std::size_t k, std::size_t l) const { return blocks_[k * n_ + l]; }
  Mat6& block(std::size_t k, std::size_t l) { return blocks_[k * n_ + l]; }
  /// E_kl, mm/N.
  Mat3 E(std::size_t k, std::size_t l) const { return block(k, l).topLeftCorner<3, 3>(); }
  std::vector<Response> responses(std::span<const Load> loads) const;

 private:
  std::size_t n_;
  std::vector<Mat6> blocks_;
};

class Structure {
 public:
  /// The bodies must form a forest (parents_first() finds them all).
  explicit Structure(std::vector<Body> bodies);

  const std::vector<Body>& bodies() const { return bodies_; }
  /// For bodies that go with a moving machine: base point, compliance, or place of the beam. What
  /// carries it stays.
  Body& body(std::size_t index) { return bodies_[index]; }
  /// Per body: +1 on the tool's side of the contact, −1 on the work's, 0 on both or none.
  std::vector<int> signs(const Contact& contact) const;

  /// E once for a pose: reports, scatter and error copying need its blocks.
  Influence assemble(std::span<const Contact> contacts) const;

  /// Room for respond(), kept by the caller so that a run of segments allocates once.
  struct Scratch {
    std::vector<Load> loads;       // per body: what its joint carries, moment about the origin
    std::vector<Response> motion;  // per body: displacement of the point at the origin, rotation
  };
  /// The same displacements in O(bodies + contacts), without assembling: wrenches up the tree, then
  /// motions down.
  void respond(std::span<const Contact> contacts, std::span<const Load> loads, Scratch& scratch,
               std::span<Response> out) const;

 private:
  void add_beams(std::span<const Contact> contacts, std::span<const Load> loads,
                 std::span<Response> out) const;

  std::vector<Body> bodies_;
  std::vector<int> order_;  // parents first
  bool has_beams_ = false;
};

}  // namespace aircut::accuracy
