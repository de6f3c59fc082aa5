// The joints on the way from the root to the tool's link are driven. They become
//
//   three sliding ones          `calibrated`: q = U⁻¹·(p − gauge), U the axes' directions as
//   columns three and more, any kinds   `serial`, by modified Denavit-Hartenberg rows
//
// Rows from axes (points p_i, directions z_i): frame i has its z along axis i and its x along the
// common normal from axis i to axis i + 1, its origin at that normal's foot. Then axis i + 1 lies
// across x_i, and the row Rx(α)·Tx(a)·Rz(θ)·Tz(d) is read off the two frames. Parallel axes: the
// normal through the last origin; one and the same axis, and the last one: x as in the frame
// before.
//
// Everything else stands at zero: other joints, and links on fixed ones, whose bodies go with the
// couple that carries them.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <set>

#include "package/machine_text.h"
#include "urdf/urdf.h"

namespace aircut::urdf {
namespace {

namespace fs = std::filesystem;

constexpr double degrees = 180 / std::numbers::pi;
constexpr double chord_mm = 0.05;  // of round bodies

/// A line in space.
struct Axis {
  Vec3 p, z;
};

Vec3 any_across(const Vec3& z) {
  Eigen::Index least = 0;
  z.cwiseAbs().minCoeff(&least);
  return z.cross(Vec3::Unit(least)).normalized();
}

// Frame on axis i before axis `next`; `before` is the frame of the axis before, or M.
Pose frame_on(const Axis& axis, const Axis* next, const Pose& before) {
  constexpr double parallel = 1e-9;
  Vec3 x = Vec3::Zero(), o = axis.p + axis.z * axis.z.dot(before.translation() - axis.p);
  if (next) {
    const Vec3 across = axis.z.cross(next->z);
    if (across.norm() > parallel) {
      x = across.normalized();
      // Foot of the common normal: along this axis, where the plane of x and the other axis cuts
      // it.
      const Vec3 n = next->z.cross(across);
      o = axis.p + axis.z * (n.dot(next->p - axis.p) / n.dot(axis.z));
      // From this axis to the other one.
      if (x.dot(next->p - o) < 0) x = -x;
    } else {
      Vec3 way = next->p - o;
      way -= axis.z * axis.z.dot(way);
      if (way.norm() > 1e-6) x = way.normalized();
    }
  }
  if (x.isZero()) {
    const Vec3 old = before.linear().col(0);
    const Vec3 level = old - axis.z * axis.z.dot(old);
    x = level.norm() > 1e-6 ? Vec3(level.normalized()) : any_across(axis.z);
  }
  Pose X = Pose::Identity();
  X.linear() << x, axis.z.cross(x), axis.z;
  X.translation() = o;
  return X;
}

// [theta, d, a, alpha] that leads from one frame to the next.
std::string row_between(const Pose& from, const Pose& to) {
  const Vec3 x = from.linear().col(0), z = to.linear().col(2);
  const double alpha =
      std::atan2(from.linear().col(2).cross(z).dot(x), from.linear().col(2).dot(z));
  const double theta = std::atan2(x.cross(to.linear().col(0)).dot(z), x.dot(to.linear().col(0)));
  const Vec3 way = to.translation() - from.translation();
  const double a = way.dot(x), d = (way - a * x).dot(z);
  return "[" + shortest(theta * degrees) + ", " + shortest(d) + ", " + shortest(a) + ", " +
         shortest(alpha * degrees) + "]";
}

std::string placed(const Pose& X) {
  const Vec3 angles = package::fixed_angles(X.linear());
  const Vec3& p = X.translation();
  return "[" + shortest(p.x()) + ", " + shortest(p.y()) + ", " + shortest(p.z()) + ", " +
         shortest(angles.x()) + ", " + shortest(angles.y()) + ", " + shortest(angles.z()) + "]";
}

/// Files of meshes: relative ones below the description's folder, others below their package.
class MeshFiles {
 public:
  MeshFiles(const std::string& file, const std::string& root)
      : folder_(fs::path(file).parent_path()), root_(root) {
    if (folder_.empty()) folder_ = ".";
  }

  Expected<fs::path> find(const std::string& name) const {
    constexpr std::string_view package = "package://";
    if (!name.starts_with(package)) {
      if (name.find("://") != name.npos)
        return refuse(name,
                      "files are named as package://NAME/PATH or relative to the description");
      return below(folder_, name, name);
    }
    const std::string rest = name.substr(package.size());
    const std::size_t slash = rest.find('/');
    if (slash == rest.npos || slash == 0) return refuse(name, "it needs package://NAME/PATH");
    const std::string of = rest.substr(0, slash), path = rest.substr(slash + 1);
    const auto home = package_folder(of);
    if (!home)
      return refuse(name, "there is no folder '" + printable(of) + "' in " +
                              (root_.empty() ? "the folders above the description" : root_) +
                              "; --package-root DIR names the folder that holds it");
    return below(*home, path, name);
  }

 private:
  static tl::unexpected<Diagnostic> refuse(const std::string& name, const std::string& why) {
    return unexpected(make_error("urdf_invalid", "can't use '" + printable(name) + "': " + why));
  }
  static Expected<fs::path> below(const fs::path& home, const std::string& path,
                                  const std::string& name) {
    if (path.empty() || path.front() == '/') return refuse(name, "it is absolute");
    std::error_code error;
    const fs::path root = fs::canonical(home, error);
    const fs::path full = fs::canonical(root / path, error);
    if (error || !fs::is_regular_file(full, error)) return refuse(name, "there is no such file");
    const auto ends = std::mismatch(root.begin(), root.end(), full.begin(), full.end());
    if (ends.first != root.end()) return refuse(name, "it leads out of its folder");
    return full;
  }
  std::optional<fs::path> package_folder(const std::string& name) const {
    if (name == ".." || name == ".") return std::nullopt;
    std::error_code error;
    if (!root_.empty()) {
      const fs::path found = fs::path(root_) / name;
      if (fs::is_directory(found, error)) return found;
      return std::nullopt;
    }
    fs::path up = fs::canonical(folder_, error);
    for (int level = 0; level < 8 && !error && up.has_relative_path(); ++level) {
      if (up.filename() == name) return up;
      if (fs::is_directory(up / name, error)) return up / name;
      error.clear();
      up = up.parent_path();
    }
    return std::nullopt;
  }

  fs::path folder_;
  std::string root_;
};

class Builder {
 public:
  Builder(const Robot& robot, const std::string& file, const Options& options, Diagnostics& out)
      : robot_(robot),
        files_(file, options.package_root),
        options_(options),
        out_(out),
        text_(robot.name.empty() ? "robot" : robot.name) {}

  std::optional<Machine> build() {
    if (!check_tree()) return std::nullopt;
    const auto tip = tool_link();
    if (!tip || !choose_joints(*tip)) return std::nullopt;
    place(root_, Pose::Identity(), "bed");
    drive(*tip);
    for (const auto& [name, at] : links_) bodies(*at);
    machine_.toml = text_.text();
    return std::move(machine_);
  }

 private:
  void fail(const SourceSpan& span, std::string message) {
    out_.error("urdf_invalid", span, std::move(message));
  }
  void unchecked(const SourceSpan& span, const std::string& what) {
    out_.warning("urdf_not_modelled", span, what);
    machine_.unchecked.push_back(what);
  }

  const std::vector<const Joint*>& children_of(const std::string& link) const {
    static const std::vector<const Joint*> none;
    const auto found = children_.find(link);
    return found == children_.end() ? none : found->second;
  }

  bool check_tree() {
    const std::size_t before = out_.errors();
    for (const Link& link : robot_.links)
      if (!links_.emplace(link.name, &link).second)
        fail(link.span, "there are two links '" + printable(link.name) + "'");
    std::vector<std::string> names;
    for (const auto& [name, link] : links_) names.push_back(name);
    std::set<std::string> joints;
    for (const Joint& joint : robot_.joints) {
      if (!joints.insert(joint.name).second)
        fail(joint.span, "there are two joints '" + printable(joint.name) + "'");
      for (const auto& [link, span] : {std::pair(&joint.parent, &joint.parent_span),
                                       std::pair(&joint.child, &joint.child_span)})
        if (!links_.contains(*link))
          fail(*span, "there is no link '" + printable(*link) + "'." + did_you_mean(*link, names));
      if (!carrier_.emplace(joint.child, &joint).second)
        fail(joint.child_span, "link '" + printable(joint.child) + "' is the child of '" +
                                   printable(carrier_.at(joint.child)->name) +
                                   "' already: links that close a loop can't be driven");
      children_[joint.parent].push_back(&joint);
    }
    for (const Link& link : robot_.links) {
      if (carrier_.contains(link.name)) continue;
      if (root_.empty())
        root_ = link.name;
      else
        fail(link.span, "link '" + printable(link.name) + "' hangs on nothing, as '" +
                            printable(root_) + "' does; a robot has one root");
    }
    if (robot_.links.empty()) fail(robot_.span, "the robot has no <link>");
    if (out_.errors() == before && root_.empty())
      fail(robot_.joints.front().span, "every link is the child of a joint: they form a loop");
    if (out_.errors() != before) return false;
    // What the root does not lead to goes in a circle.
    std::set<std::string> reached;
    std::vector<std::string> open = {root_};
    while (!open.empty()) {
      const std::string name = open.back();
      open.pop_back();
      if (!reached.insert(name).second) continue;
      for (const Joint* joint : children_of(name)) open.push_back(joint->child);
    }
    for (const Link& link : robot_.links)
      if (!reached.contains(link.name))
        fail(carrier_.at(link.name)->span, "link '" + printable(link.name) +
                                               "' is in a loop of joints that the root does not "
                                               "lead to");
    return out_.errors() == before;
  }

  std::optional<std::string> tool_link() {
    std::vector<std::string> names, leaves;
    for (const Link& link : robot_.links) {
      names.push_back(link.name);
      if (!children_.contains(link.name)) leaves.push_back(link.name);
    }
    if (!options_.tool_link.empty()) {
      if (links_.contains(options_.tool_link)) return options_.tool_link;
      fail(robot_.span, "there is no link '" + printable(options_.tool_link) +
                            "' that could carry the tool." +
                            did_you_mean(options_.tool_link, names));
      return std::nullopt;
    }
    if (leaves.size() == 1) return leaves.front();
    std::string all;
    for (const std::string& name : leaves) all += (all.empty() ? "" : ", ") + printable(name);
    fail(robot_.span, "several links end the robot (" + all +
                          "); name the one that carries the tool: FILE.urdf:LINK");
    return std::nullopt;
  }

  // Joints on the way to the tool.
  bool choose_joints(const std::string& tip) {
    for (std::string at = tip; at != root_; at = carrier_.at(at)->parent) {
      const Joint* joint = carrier_.at(at);
      if (joint->type == JointType::fixed) continue;
      if (joint->mimics) {
        fail(joint->span, "joint '" + printable(joint->name) +
                              "' mimics another one on the way to the tool: that is not modelled");
        return false;
      }
      driven_.insert(driven_.begin(), joint);
    }
    for (const Joint& joint : robot_.joints)
      if (joint.type != JointType::fixed &&
          std::find(driven_.begin(), driven_.end(), &joint) == driven_.end())
        unchecked(joint.span, "joint '" + printable(joint.name) +
                                  "' is not on the way to the tool: it stays at 0");
    constexpr std::size_t least = 3, most = 16;
    if (driven_.size() >= least && driven_.size() <= most) return true;
    fail(links_.at(tip)->span, "between the root and '" + printable(tip) + "' are " +
                                   std::to_string(driven_.size()) +
                                   " joints that move; a machine needs 3 to 16");
    return false;
  }

  // Every link below `link`, seen from the root with all joints at zero.
  void place(const std::string& first, const Pose& X_first, const std::string& carried_by) {
    struct At {
      std::string link, couple;
      Pose X;
    };
    std::vector<At> open = {{first, carried_by, X_first}};
    while (!open.empty()) {
      const At at = open.back();
      open.pop_back();
      X_[at.link] = at.X;
      couple_[at.link] = at.couple;
      for (const Joint* joint : children_of(at.link)) {
        const Pose X = at.X * joint->X_PJ;
        const bool moves = std::find(driven_.begin(), driven_.end(), joint) != driven_.end();
        open.push_back({joint->child, moves ? joint->name : at.couple, X});
        if (moves) axes_[joint] = {X.translation(), (X.linear() * joint->axis).normalized()};
      }
    }
  }

  void drive(const std::string& tip) {
    std::string kinds;
    for (const Joint* joint : driven_) {
      const bool turns = joint->type != JointType::prismatic;
      kinds += turns ? 'R' : 'T';
      const Axis& axis = axes_.at(joint);
      package::Couple couple{.name = joint->name,
                             .rotary = turns,
                             .parent = couple_.at(joint->parent),
                             .direction = axis.z,
                             .origin = axis.p,
                             .limits = limits_of(*joint)};
      text_.add(couple);
    }
    unchecked(robot_.span,
              "accelerations: a description has none; joints reach their speed in a "
              "quarter of a second here");
    // The tool points along z of its link: out of the flange.
    Pose X_tool = X_.at(tip);
    X_tool.rotate(Eigen::AngleAxisd(std::numbers::pi, Vec3::UnitX()));
    package::DriveText drive;
    drive.spindle = couple_.at(tip);
    drive.gauge = X_tool.translation();
    const Vec3 z = Vec3::UnitZ();
    Mat3 U;
    if (kinds == "TTT") {
      for (int i = 0; i < 3; ++i) U.col(i) = axes_.at(driven_[static_cast<std::size_t>(i)]).z;
      if (std::fabs(U.determinant()) < 1e-3)
        fail(driven_.front()->span, "the three sliding joints do not span the space");
      if ((X_tool.linear().col(2) - z).norm() > 1e-6)
        drive.work_angles = package::fixed_angles(X_tool.linear());
      sliding(U, X_tool, drive);
    } else {
      if (driven_.size() < 5) stays_upright(X_tool);
      drive.spindle_angles = package::fixed_angles(X_tool.linear());
      drive.kinematics = arm(kinds, X_tool);
    }
    text_.drive(drive);
  }

  // Three and four joints follow X Y Z alone.
  void stays_upright(const Pose& X_tool) {
    constexpr double straight = 1e-6;
    const Vec3 z = Vec3::UnitZ();
    if ((X_tool.linear().col(2) - z).norm() > straight)
      return fail(robot_.span,
                  "with fewer than five joints the tool must point along -Z of the root");
    for (const Joint* joint : driven_)
      if (joint->type != JointType::prismatic && axes_.at(joint).z.cross(z).norm() > straight)
        return fail(joint->span, "joint '" + printable(joint->name) +
                                     "' tilts the tool, which needs five joints or more to follow");
  }

  // M has the tool's axes, so that the spindle is upright in it.
  static void sliding(const Mat3& U, const Pose& X_tool, package::DriveText& drive) {
    const Mat3 R = drive.work_angles.isZero() ? Mat3(Mat3::Identity()) : X_tool.linear();
    const Mat3 M = U.inverse() * R;
    const Vec3 offset = R.transpose() * X_tool.translation();
    std::string values;
    for (int i = 0; i < 9; ++i) values += (i ? ", " : "") + shortest(M(i / 3, i % 3));
    drive.kinematics = "type = \"calibrated\"\nmatrix = [" + values +
                       "]\noffset = " + package::list_of(offset) + "\n";
  }

  std::string arm(const std::string& kinds, const Pose& X_tool) const {
    std::string rows;
    Pose before = Pose::Identity(), base;
    for (std::size_t i = 0; i < driven_.size(); ++i) {
      const Axis* next = i + 1 < driven_.size() ? &axes_.at(driven_[i + 1]) : nullptr;
      const Pose X = frame_on(axes_.at(driven_[i]), next, before);
      if (i == 0) base = X;
      rows += (i ? ", " : "") + (i ? row_between(before, X) : std::string("[0, 0, 0, 0]"));
      before = X;
    }
    return "type = \"serial\"\nconvention = \"modified\"\nkinds = \"" + kinds + "\"\ndh = [" +
           rows + "]\nbase = " + placed(base) + "\ntool = " + placed(before.inverse() * X_tool) +
           "\n";
  }

  package::CoupleLimits limits_of(const Joint& joint) {
    const double unit = joint.type == JointType::prismatic ? 1 : degrees;
    package::CoupleLimits l;
    if (joint.type != JointType::continuous) {
      l.min = joint.lower * unit;
      l.max = joint.upper * unit;
      l.home = std::clamp(0.0, *l.min, *l.max);
      if (l.home != 0)
        unchecked(joint.span, "joint '" + printable(joint.name) +
                                  "' has no zero inside its limits; runs start at the limit");
    }
    l.vmax = joint.velocity * unit;
    l.amax = 4 * l.vmax;
    return l;
  }

  // In bed axes with every joint at zero.
  void bodies(const Link& link) {
    const std::vector<Solid>& solids = link.collision.empty() ? link.visual : link.collision;
    if (link.collision.empty() && !link.visual.empty())
      out_.add({Severity::info,
                "urdf_not_modelled",
                "link '" + printable(link.name) + "' has no <collision>: what is drawn collides",
                link.span,
                {},
                {}});
    for (std::size_t i = 0; i < solids.size(); ++i) {
      const auto mesh = mesh_of(solids[i]);
      if (!mesh) continue;
      std::string name;
      for (const char c : link.name)
        name += (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                        c == '-' || c == '_'
                    ? c
                    : '_';
      name += "-body" + (i ? std::to_string(i + 1) : std::string());
      while (machine_.meshes.contains("meshes/" + name + ".stl")) name += "_";
      const std::string path = "meshes/" + name + ".stl";
      machine_.meshes[path] = std::make_shared<const TriangleMesh>(
          transformed(*mesh, X_.at(link.name) * solids[i].X_LS));
      text_.body({name, couple_.at(link.name), path});
    }
  }

  std::optional<TriangleMesh> mesh_of(const Solid& solid) {
    switch (solid.shape) {
      case Shape::box:
        return make_box(-solid.size / 2, solid.size / 2);
      case Shape::cylinder:
        return transformed(
            revolve({{0, 0}, {solid.radius, 0}, {solid.radius, solid.length}, {0, solid.length}},
                    chord_mm),
            translation(Vec3(0, 0, -solid.length / 2)));
      case Shape::sphere: {
        Profile outline;
        constexpr int parts = 24;
        for (int i = 0; i <= parts; ++i) {
          const double angle = std::numbers::pi * i / parts;
          const bool pole = i == 0 || i == parts;
          outline.push_back(
              {pole ? 0 : solid.radius * std::sin(angle), -solid.radius * std::cos(angle)});
        }
        return revolve(outline, chord_mm);
      }
      case Shape::mesh:
        break;
    }
    const auto path = files_.find(solid.file);
    if (!path) {
      fail(solid.span, path.error().message);
      return std::nullopt;
    }
    constexpr double mm = 1000;
    auto mesh = read_mesh(path->string(), {.unit_mm = mm});
    if (!mesh) {
      fail(solid.span, mesh.error().message);
      return std::nullopt;
    }
    const bool mirrored = solid.scale.prod() < 0;
    for (Vec3& v : mesh->vertices) v = v.cwiseProduct(solid.scale);
    if (mirrored)
      for (auto& triangle : mesh->triangles) std::swap(triangle[1], triangle[2]);
    return std::move(*mesh);
  }

  const Robot& robot_;
  MeshFiles files_;
  const Options& options_;
  Diagnostics& out_;
  package::MachineText text_;
  Machine machine_;
  std::map<std::string, const Link*> links_;
  std::map<std::string, const Joint*> carrier_;  ///< joint whose child a link is
  std::map<std::string, std::vector<const Joint*>> children_;
  std::string root_;
  std::vector<const Joint*> driven_;
  std::map<std::string, Pose> X_;              ///< of each link in bed axes, joints at zero
  std::map<std::string, std::string> couple_;  ///< that carries each link, or `bed`
  std::map<const Joint*, Axis> axes_;
};

}  // namespace

Expected<Machine> machine_of(const Robot& robot, const std::string& file, const Options& options,
                             Diagnostics& out) {
  const std::size_t before = out.errors();
  auto machine = Builder(robot, file, options, out).build();
  if (machine && out.errors() == before) return std::move(*machine);
  return unexpected(make_error("urdf_invalid", "the robot's description has errors"));
}

}  // namespace aircut::urdf
