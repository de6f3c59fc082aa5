// sim: the virtual machine. Takes segments, moves the machine, checks every interval, reports
// findings and tells observers what happened. Units mm, rad, s.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "collide/collide.h"
#include "interp/interp.h"
#include "machine/machine.h"
#include "motion/motion.h"
#include "plan/plan.h"
#include "tool/tool.h"

namespace aircut::sim {

using machine::JointVector;

/// A body of the scene: of the machine, a fixture, or a piece of the tool in the spindle.
struct SceneBody {
  machine::Body body;
  std::shared_ptr<const collide::CollisionMesh> collision;  ///< null when it does not collide
};

/// What is where. Changes only at a tool change.
class Scene {
 public:
  Scene(std::shared_ptr<const machine::Machine> machine, const tool::ToolTable& tools);

  const machine::Machine& machine() const { return *machine_; }
  std::shared_ptr<const machine::Machine> machine_ptr() const { return machine_; }
  const std::vector<SceneBody>& bodies() const { return bodies_; }
  /// Puts a tool into the spindle (0 = none).
  void load_tool(int number);
  int loaded_tool() const { return loaded_; }
  const tool::Tool* tool() const;
  const tool::ToolTable& tools() const { return tools_; }

 private:
  std::shared_ptr<const machine::Machine> machine_;
  tool::ToolTable tools_;
  std::size_t fixed_bodies_ = 0;  ///< the tool's pieces come after these
  std::vector<SceneBody> bodies_;
  int loaded_ = 0;
};

/// One interval given to the checks.
struct Step {
  const Scene& scene;
  const motion::JointMotion& motion;
  const plan::Segment& segment;
  const SourceSpan& span() const { return segment.command.span; }
};

enum class Kind : unsigned char {
  collision,
  near_miss,
  self_overlap,
  tool_change_collision,
  overtravel,
  overtravel_margin,
  unreachable,
  singular,
  velocity_limit,
  acceleration_limit,
  no_tool_geometry,
  tool_missing,
  not_executed,
  unproven,
};
std::string_view to_string(Kind kind);
Severity severity_of(Kind kind);

/// What the user reads.
struct Finding {
  int id = 0;
  int episode = 0;
  Kind kind = Kind::collision;
  Severity severity = Severity::error;
  std::string message;  ///< one sentence
  SourceSpan span;
  std::string expanded;
  int tool = 0;
  std::string tool_name;
  std::string work_system;  ///< "G54"
  plan::MotionKind motion = plan::MotionKind::idle;
  double t_first = 0, t_worst = 0, t_end = 0;  ///< program time, s
  double u_first = 0, u_end = 0;               ///< fraction of the block's path
  JointVector joints_first, joints_worst;
  AxisValues tip;                    ///< at t_worst, machine coordinates
  double feed = 0, feed_actual = 0;  ///< mm/s
  double spindle_rpm = 0;
  std::string body_a, body_b, pair;
  std::optional<double> depth;        ///< mm; negative = separation
  std::optional<double> depth_bound;  ///< mm
  std::vector<Vec3> points;           ///< machine (bed) frame
  Vec3 normal = Vec3::Zero();
  std::string joint;  ///< travel kinds
  std::optional<double> value, limit;
  std::string unit;
  bool unresolved = false;
  bool makes_unknown = false;  ///< something could not be checked
  std::string remedy;
  std::string picture;  ///< path relative to the output folder
};

enum class Verdict : unsigned char { pass, fail, unknown };
std::string_view to_string(Verdict verdict);

struct Summary {
  Verdict verdict = Verdict::unknown;
  double cycle_time = 0;
  double cut_time = 0, rapid_time = 0, dwell_time = 0, tool_change_time = 0;
  std::uint64_t blocks = 0, moves = 0;
  std::uint64_t pairs_watched = 0;
  std::uint64_t distance_queries = 0;
  double share_clear = 0, share_hit = 0, share_unresolved = 0;  ///< of checked pair-time
  std::map<std::string, std::pair<double, double>> joint_extremes;
  std::vector<std::string> unchecked;  ///< what was not checked, in words
  bool interrupted = false;
};

/// Looks at everything and writes it down.
class Observer {
 public:
  virtual ~Observer() = default;
  virtual void on_start(const Scene&) {}
  virtual void on_step(const Step&) {}
  virtual void on_finding(const Step&, const Finding&) {}
  virtual void on_finish(const Scene&, const std::vector<Finding>&, const Summary&) {}
};

}  // namespace aircut::sim
