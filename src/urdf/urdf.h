// urdf: a robot's description (URDF) as a machine package. The file is read into plain values
// (read_urdf.cpp, the only file that sees the XML library), then its chain from the root to the
// link that carries the tool becomes couples and a kinematics (machine_of_urdf.cpp).
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/base.h"
#include "geometry/geometry.h"

namespace aircut::urdf {

enum class Shape : unsigned char { mesh, box, cylinder, sphere };

/// A solid of a link. Lengths mm.
struct Solid {
  Shape shape = Shape::mesh;
  std::string file;               ///< of a mesh, as it is written
  Vec3 scale = Vec3::Ones();      ///< of a mesh, in metres per unit of its file
  Vec3 size = Vec3::Zero();       ///< of a box
  double radius = 0, length = 0;  ///< of a cylinder along Z about its middle, of a sphere
  Pose X_LS = Pose::Identity();   ///< seen from the link
  SourceSpan span;
};

struct Link {
  std::string name;
  std::vector<Solid> collision, visual;
  SourceSpan span;
};

enum class JointType : unsigned char { fixed, revolute, continuous, prismatic };

/// A couple. Lengths mm, angles rad.
struct Joint {
  std::string name;
  JointType type = JointType::fixed;
  std::string parent, child;
  Pose X_PJ = Pose::Identity();  ///< at zero, seen from the parent
  Vec3 axis = Vec3::UnitX();     ///< unit vector in the joint's frame
  double lower = 0, upper = 0, velocity = 0;
  bool mimics = false;  ///< it follows another joint
  SourceSpan span, parent_span, child_span;
};

struct Robot {
  std::string name;
  std::vector<Link> links;
  std::vector<Joint> joints;
  SourceSpan span;
};

/// Reads a description. Kinds `urdf_invalid` (errors), `urdf_not_modelled` (warnings: what the file
/// says and nothing here looks at).
Expected<Robot> read_robot(const SourceText& text, Diagnostics& out);

struct Options {
  std::string tool_link = {};     ///< empty: the only link without children
  std::string package_root = {};  ///< holds the packages of `package://`; empty: above the file
};

/// A machine.toml and the meshes that it names.
struct Machine {
  std::string toml;
  std::map<std::string, std::shared_ptr<const TriangleMesh>> meshes;  ///< by path in the package
  std::vector<std::string> unchecked;  ///< what was not understood, a sentence each
};

/// Errors are in `out`: loops, links that hang on nothing, meshes that are missing.
Expected<Machine> machine_of(const Robot& robot, const std::string& file, const Options& options,
                             Diagnostics& out);

/// Kinds of messages of this library, for `explain` and the docs.
const std::vector<KindText>& kinds();

}  // namespace aircut::urdf
