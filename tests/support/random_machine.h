// Random machines of three to six couples with two or three bodies, each with one move that brings
// them near each other, and a second way to say where the bodies are during it. Everything about
// the motion is worked out here from the drawing: the poses as a chain of turns and shifts, the
// speed from lengths along the chain, the joints from lines, circles and trapezoids of speed.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "collide/scenes.h"
#include "machine/machine.h"

namespace aircut::testing {

/// Joints over u in [0, 1], the part of the move that is done.
struct JointWay {
  enum class Kind : unsigned char { line, arc, dogleg } kind = Kind::line;
  std::vector<double> from, to;  ///< mm, rad
  // Arc: of the joints x and y.
  std::size_t x = 0, y = 0;
  double radius = 0, angle = 0, sweep = 0, centre_x = 0, centre_y = 0;
  // Dog-leg: of each joint, mm or rad, s.
  std::vector<double> vmax, amax;

  /// Way and time of one joint that goes as fast as it can from rest to rest.
  static double seconds(double way, double v, double a) {
    return way * a < v * v ? 2 * std::sqrt(way / a) : way / v + v / a;
  }
  static double gone(double way, double v, double a, double t) {
    const double all = seconds(way, v, a);
    if (t >= all) return way;
    const double speeding = std::min(v / a, all / 2);
    if (t < speeding) return a * t * t / 2;
    if (t > all - speeding) return way - a * (all - t) * (all - t) / 2;
    return a * speeding * speeding / 2 + a * speeding * (t - speeding);
  }
  double duration() const {
    double out = 0;
    for (std::size_t j = 0; j < from.size(); ++j)
      out = std::max(out, seconds(std::abs(to[j] - from[j]), vmax[j], amax[j]));
    return out;
  }

  std::vector<double> at(double u) const {
    std::vector<double> q(from.size());
    for (std::size_t j = 0; j < q.size(); ++j) q[j] = from[j] + u * (to[j] - from[j]);
    if (kind == Kind::arc) {
      q[x] = centre_x + radius * std::cos(angle + u * sweep);
      q[y] = centre_y + radius * std::sin(angle + u * sweep);
    } else if (kind == Kind::dogleg) {
      const double t = u * duration();
      for (std::size_t j = 0; j < q.size(); ++j)
        q[j] = from[j] +
               std::copysign(gone(std::abs(to[j] - from[j]), vmax[j], amax[j], t), to[j] - from[j]);
    }
    return q;
  }
  /// Bound of how fast joint j changes with u.
  double rate(std::size_t j) const {
    if (kind == Kind::arc && (j == x || j == y)) return std::abs(sweep) * radius;
    if (kind == Kind::dogleg) return vmax[j] * duration();
    return std::abs(to[j] - from[j]);
  }
};

struct RandomMachine {
  std::shared_ptr<machine::Machine> machine = std::make_shared<machine::Machine>();
  JointWay way;
  std::string program;
  double near = 0;  ///< margin of near misses, mm

  /// Pose of a body's mesh.
  Pose pose(const machine::Body& body, const std::vector<double>& q) const {
    Pose X = body.X_LB;
    for (int joint = couple(body.link); joint >= 0; joint = couple(tree(joint).parent))
      X = turn(tree(joint), q[index_of(joint)]) * X;
    return X;
  }
  Pose between(const machine::Body& a, const machine::Body& b, double u) const {
    const std::vector<double> q = way.at(u);
    return pose(a, q).inverse(Eigen::Isometry) * pose(b, q);
  }
  /// Bound of how fast any point of b moves, seen from a, per u.
  double speed(const machine::Body& a, const machine::Body& b) const {
    return std::min(speed_seen(a, b), speed_seen(b, a));
  }
  /// Whether one body's link carries the other's.
  bool adjacent(const machine::Body& a, const machine::Body& b) const {
    const auto carries = [&](machine::LinkId under, machine::LinkId link) {
      const int joint = couple(link);
      return joint >= 0 && tree(joint).parent == under;
    };
    return carries(a.link, b.link) || carries(b.link, a.link);
  }

 private:
  const machine::Joint& tree(int joint) const {
    return machine->tree_[static_cast<std::size_t>(joint)];
  }
  int couple(machine::LinkId link) const {
    return machine->links_[static_cast<std::size_t>(machine::index(link))].joint;
  }
  std::size_t index_of(int joint) const { return static_cast<std::size_t>(tree(joint).driven); }
  static Pose turn(const machine::Joint& joint, double q) {
    if (joint.kind == machine::JointKind::linear) return translation(q * joint.direction);
    return translation(joint.origin) * Pose(Eigen::AngleAxisd(q, joint.direction)) *
           translation(-joint.origin);
  }

  // Along the chain from a to b; a couple turns what lies beyond it, which is no farther from its
  // axis than the rigid pieces and the slides on the way to b are long together.
  double speed_seen(const machine::Body& a, const machine::Body& b) const {
    std::vector<int> up, down;
    for (int j = couple(a.link); j >= 0; j = couple(tree(j).parent)) up.push_back(j);
    for (int j = couple(b.link); j >= 0; j = couple(tree(j).parent)) down.push_back(j);
    while (!up.empty() && !down.empty() && up.back() == down.back()) {
      up.pop_back();
      down.pop_back();
    }
    // `down` runs from b; the couples under a follow it in the order in which they are met.
    down.insert(down.end(), up.rbegin(), up.rend());
    double out = 0, reach = -1;
    Vec3 last = Vec3::Zero();
    double slides = 0;
    for (const int j : down) {
      const machine::Joint& joint = tree(j);
      const double rate = way.rate(index_of(j));
      if (joint.kind == machine::JointKind::linear) {
        out += rate;
        slides += farthest(index_of(j));
        continue;
      }
      if (reach < 0) {
        reach = 0;
        for (const Vec3& p : b.mesh->vertices)
          reach = std::max(reach, (b.X_LB * p - joint.origin).norm());
      } else {
        reach += (joint.origin - last).norm();
      }
      last = joint.origin;
      out += rate * (reach + slides);
    }
    return out;
  }
  double farthest(std::size_t j) const {
    const double ends = std::max(std::abs(way.from[j]), std::abs(way.to[j]));
    return ends + (way.kind == JointWay::Kind::arc ? 2 * way.radius : 0);
  }
};

namespace random_machine {

using collide::Random;

/// From a box to 5000 triangles; most of the bodies are small, many of them thin plates.
inline TriangleMesh body(Random& random) {
  const int choice = random.pick(10);
  if (choice < 6) return collide::random_body(random);
  if (choice < 7) return make_box({-6, -6, -0.01}, {6, 6, 0.01});
  const double triangles = 30 * std::pow(5000.0 / 30, random.uniform(0, 1));
  return collide::bumpy_ball(random, static_cast<int>(triangles));
}

inline machine::LinkId add_couple(machine::Machine& m, Random& random, machine::LinkId parent,
                                  char letter) {
  machine::Joint joint;
  joint.name = std::string(1, letter);
  const bool rotary = letter < 'X';
  joint.kind = rotary ? machine::JointKind::rotary : machine::JointKind::linear;
  joint.parent = parent;
  joint.child = machine::LinkId{static_cast<int>(m.links_.size())};
  joint.origin = random.in_box(15);
  joint.direction = random.direction();
  joint.driven = static_cast<int>(m.driven_.size());
  joint.vmax = rotary ? random.uniform(1, 12) : random.uniform(200, 1500);
  joint.amax = rotary ? random.uniform(5, 200) : random.uniform(1000, 20000);
  m.driven_.push_back(static_cast<int>(m.tree_.size()));
  m.links_.push_back({joint.name, parent, static_cast<int>(m.tree_.size())});
  m.tree_.push_back(joint);
  return m.tree_.back().child;
}

/// Values as the program's text has them, so that both sides start from the same numbers.
inline double rounded(double value) { return std::round(value * 1e6) / 1e6; }

}  // namespace random_machine

inline RandomMachine make_random_machine(unsigned seed) {
  using namespace random_machine;
  constexpr double degree = 3.14159265358979323846 / 180;
  Random random(seed);
  RandomMachine out;
  machine::Machine& m = *out.machine;
  m.name_ = "random";
  // Three to six axes with a letter each, in any order along the chain.
  const int joints = 3 + random.pick(4);
  const int least = std::max(1, joints - 3);
  const int linear = least + random.pick(std::min(3, joints) - least + 1);
  std::string letters = std::string("XYZ").substr(0, static_cast<std::size_t>(linear)) +
                        std::string("ABC").substr(0, static_cast<std::size_t>(joints - linear));
  for (std::size_t i = letters.size() - 1; i > 0; --i)
    std::swap(letters[i], letters[static_cast<std::size_t>(random.pick(static_cast<int>(i) + 1))]);
  const int under_work = random.pick(joints + 1);
  machine::LinkId work = machine::bed_link, tool = machine::bed_link;
  std::vector<Axis> axes;
  for (int j = 0; j < joints; ++j) {
    const char letter = letters[static_cast<std::size_t>(j)];
    axes.push_back(*axis_of_letter(letter));
    if (j < under_work)
      work = add_couple(m, random, work, letter);
    else
      tool = add_couple(m, random, tool, letter);
  }
  m.kinematics_ = machine::make_identity(axes);
  m.spindle_.link = tool;
  m.work_link_ = work;

  JointWay& way = out.way;
  std::string words;
  for (const machine::Joint& joint : m.tree_) {
    const bool rotary = joint.kind == machine::JointKind::rotary;
    const double unit = rotary ? degree : 1;
    const double most = rotary ? 120 : 25;
    const double from = rounded(random.uniform(-most, most));
    // One axis in four stands still, but never all.
    const bool stands = random.pick(4) == 0 && joint.driven > 0;
    const double to = stands ? from : rounded(from + random.uniform(-1, 1) * (rotary ? 120 : 30));
    way.from.push_back(from * unit);
    way.to.push_back(to * unit);
    way.vmax.push_back(joint.vmax);
    way.amax.push_back(joint.amax);
  }
  const auto place = [&](char letter) { return letters.find(letter); };
  const int choice = random.pick(4);
  std::string head = "G0", tail;
  if (choice == 1) {
    m.rapid_ = machine::RapidMode::dogleg;
    way.kind = JointWay::Kind::dogleg;
  } else if (choice == 2) {
    head = "G1 F20000";
  } else if (choice == 3 && place('Y') != std::string::npos) {
    way.kind = JointWay::Kind::arc;
    way.x = place('X');
    way.y = place('Y');
    way.radius = random.uniform(1, 15);
    way.angle = random.uniform(0, 6);
    way.sweep = random.uniform(0.2, 6) * (random.pick(2) == 0 ? 1 : -1);
    const double i = rounded(-way.radius * std::cos(way.angle));
    const double j = rounded(-way.radius * std::sin(way.angle));
    way.radius = std::hypot(i, j);
    way.angle = std::atan2(-j, -i);
    way.centre_x = way.from[way.x] + i;
    way.centre_y = way.from[way.y] + j;
    way.to[way.x] = way.centre_x + way.radius * std::cos(way.angle + way.sweep);
    way.to[way.y] = way.centre_y + way.radius * std::sin(way.angle + way.sweep);
    head = way.sweep > 0 ? "G3 F20000" : "G2 F20000";
    tail = fmt::format(" I{:.6f} J{:.6f}", i, j);
  }
  const std::string order = "XYZABC";
  for (const char letter : order)
    if (const std::size_t j = place(letter); j != std::string::npos)
      words += fmt::format(" {}{:.9f}", letter, way.to[j] / (letter < 'X' ? degree : 1));
  out.program = "G21 G90 G17 G61 G94\n" + head + words + tail + "\nM2\n";
  for (std::size_t j = 0; j < way.from.size(); ++j) m.tree_[j].home = way.from[j];

  // At one moment of the move the bodies are close to each other.
  const std::vector<double> q = way.at(random.uniform(0, 1));
  const auto add = [&](const std::string& name, machine::Role role, machine::LinkId link,
                       const Vec3& centre) {
    machine::Body made;
    made.name = name;
    made.role = role;
    made.link = link;
    made.mesh = std::make_shared<TriangleMesh>(body(random));
    const Pose X_WL = out.pose(made, q);
    made.X_LB = X_WL.inverse(Eigen::Isometry) * translation(centre) * random.turned();
    m.bodies_.push_back(std::move(made));
  };
  const Vec3 meeting = random.in_box(10);
  add("a", machine::Role::fixture, work, meeting);
  add("b", machine::Role::spindle, tool, meeting + random.uniform(0, 6) * random.direction());
  if (random.pick(3) == 0)
    add("c", machine::Role::machine, machine::LinkId{random.pick(joints + 1)},
        meeting + random.uniform(2, 8) * random.direction());
  out.near = random.pick(3) == 0 ? 0 : random.uniform(0.1, 2);
  return out;
}

}  // namespace aircut::testing
