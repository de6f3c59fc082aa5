// sim: the virtual machine. Takes segments, moves the machine, checks every interval, reports
// findings and tells observers what happened. Units mm, rad, s.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "base/time_buckets.h"
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

/// A place for a tool, on a machine whose channels run at once.
struct Seat {
  std::string channel;
  machine::Spindle spindle;
};

/// What is where. Changes only at a tool change.
class Scene {
 public:
  /// Without seats there is one, the machine's spindle.
  Scene(std::shared_ptr<const machine::Machine> machine, const tool::ToolTable& tools,
        std::vector<Seat> seats = {});

  const machine::Machine& machine() const { return *machine_; }
  std::shared_ptr<const machine::Machine> machine_ptr() const { return machine_; }
  const std::vector<SceneBody>& bodies() const { return bodies_; }
  /// The tool whose length offset is in force; 0: none, or one given as numbers.
  int length_offset() const { return length_offset_; }
  void use_length_offset(int tool) { length_offset_ = tool; }
  /// Puts a tool into the spindle (0 = none).
  void load_tool(int number, std::size_t seat = 0);
  /// Puts one into every seat.
  void load_tools(const std::vector<int>& numbers);
  int loaded_tool(std::size_t seat = 0) const { return loaded_[seat]; }
  /// By seat.
  const std::vector<int>& loaded_tools() const { return loaded_; }
  const tool::Tool* tool(std::size_t seat = 0) const;
  const tool::ToolTable& tools() const { return tools_; }
  /// Empty when only one channel runs.
  const std::vector<Seat>& seats() const { return seats_; }

 private:
  void add_tool(std::size_t seat);

  std::shared_ptr<const machine::Machine> machine_;
  tool::ToolTable tools_;
  std::vector<Seat> seats_;
  std::size_t fixed_bodies_ = 0;  ///< the tool's pieces come after these
  std::vector<SceneBody> bodies_;
  std::vector<int> loaded_;  ///< by seat
  int length_offset_ = 0;
};

struct ChannelSteps;

/// One interval given to the checks.
struct Step {
  const Scene& scene;
  const motion::JointMotion& motion;
  const plan::Segment& segment;
  /// On a machine whose channels run at once: whose segment it is, and what all of them do.
  std::size_t channel = 0;
  const ChannelSteps* all = nullptr;
  const SourceSpan& span() const { return segment.command.span; }
};

/// What the channels do in one interval.
struct ChannelSteps {
  std::vector<Step> of;                            ///< by channel: the same motion of the machine
  std::vector<std::string> names;                  ///< by channel
  std::vector<std::vector<std::size_t>> moved_by;  ///< by LinkId: channels that move the link
};

enum class Kind : unsigned char {
  collision,
  near_miss,
  self_overlap,
  tool_change_collision,
  probe_contact,
  probe_missed,
  overtravel,
  overtravel_margin,
  unreachable,
  singular,
  axis_unwind,
  feed_not_reached,
  branch_flip,
  velocity_limit,
  acceleration_limit,
  jerk_limit,
  path_deviation,
  sync_limit,
  rapid_cut,
  spindle_stopped_cut,
  spindle_direction_cut,
  no_tool_cut,
  plunge_not_center_cutting,
  engagement_limit,
  loose_piece,
  air_cut,
  gouge,
  gouge_live,
  excess,
  wrong_setup,
  dynamics_limit,
  tool_missing,
  not_executed,
  not_checked,
  spindle_conflict,
  axis_conflict,
  wait_deadlock,
};
std::string_view to_string(Kind kind);
Severity severity_of(Kind kind);

/// All kinds of findings with their long text.
const std::vector<KindText>& finding_kinds();

/// What the user reads.
struct Finding {
  int id = 0;
  int episode = 0;
  Kind kind = Kind::collision;
  Severity severity = Severity::error;
  std::string message;  ///< one sentence
  SourceSpan span;
  std::string expanded;
  std::uint64_t block = 0;              ///< running number of the executed block
  double t_block = 0, t_block_end = 0;  ///< time of the part of the block that was looked at, s
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
  std::vector<Vec3> points_part;      ///< the same in the stock's frame; empty without one
  std::optional<Vec3> tip_part;       ///< the tip at t_worst, likewise
  Vec3 tool_axis = Vec3::Zero();      ///< from the tip to the spindle, at t_worst; bed frame
  int length_offset = 0;              ///< tool whose length was in force (G43 H); 0: none
  /// Of a contact: how far up the tool's axis, and back along the block's path, it is clear; mm.
  std::optional<double> axial_retract, retreat;
  Vec3 normal = Vec3::Zero();
  std::string joint;     ///< travel kinds
  std::string quantity;  ///< what `value` and `limit` are of, where a kind has several
  std::optional<double> value, limit;
  std::string unit;
  bool unresolved = false;
  bool makes_unknown = false;  ///< something could not be checked
  std::string remedy;
  std::string picture;  ///< path relative to the output folder
  // Where channels run at once; else empty:
  std::string channel;        ///< whose block it is
  std::string other_channel;  ///< that takes part in it …
  SourceSpan other_span;      ///< … with this block
  std::vector<int> tools;     ///< in the seats
};

enum class Verdict : unsigned char { pass, fail, unknown };
std::string_view to_string(Verdict verdict);

/// Collects findings in the order in which they are raised; finish() sorts and numbers them.
class Findings {
 public:
  explicit Findings(std::size_t keep = 10'000) : keep_(keep) {}
  /// A row that continues the last one of the same bodies in the same block is merged with it (a
  /// block may come as several segments). Beyond `keep` rows only the count is kept, and the
  /// verdict can't be pass.
  void add(Finding finding);
  std::size_t size() const { return list_.size(); }
  std::size_t dropped() const { return dropped_; }
  /// Sorted by (t_first, kind, bodies), numbered from 1; rows that continue one another in the next
  /// block share an episode.
  std::vector<Finding> finish();

 private:
  /// Kind, bodies, joint, quantity, channel.
  using Key = std::tuple<Kind, std::string, std::string, std::string, std::string, std::string>;
  static Key key_of(const Finding& f) {
    return {f.kind, f.body_a, f.body_b, f.joint, f.quantity, f.channel};
  }

  std::size_t keep_;
  std::size_t dropped_ = 0;
  std::vector<Finding> list_;
  std::map<Key, std::size_t> last_;  ///< index of the last row of each key
};

/// Of material, mm³.
struct Volume {
  double value = 0;
  void merge(const Volume& other) { value += other.value; }
};

struct Summary {
  Verdict verdict = Verdict::unknown;
  double cycle_time = 0;  ///< s, planned
  double feed_time = 0, rapid_time = 0, dwell_time = 0, tool_change_time = 0;
  double spindle_wait_time = 0;  ///< for its speed, or its index
  double blend_time = 0;         ///< of feed_time: in rounded corners
  std::uint64_t blocks = 0, moves = 0;
  std::size_t findings_dropped = 0;

  struct Joint {
    std::string name;
    bool rotary = false;
    double low = 0, high = 0;  ///< reached, within 0.01 mm or 0.01°
  };
  std::vector<Joint> joints;

  struct Collision {
    std::size_t bodies = 0, pairs = 0;
    std::uint64_t distance_queries = 0, overlap_queries = 0;
    double clear = 0, hit = 0, unresolved = 0;  ///< shares of checked pair-time; their sum is 1
    std::vector<std::string> exclusions;        ///< "a – b: reason"
  } collision;

  struct Stock {
    double pitch = 0;                       ///< of the lattice, mm
    double sweep_bound = 0;                 ///< mm: straight pieces in place of the motion
    double initial_volume = 0, volume = 0;  ///< mm³, before and after
    std::size_t bytes = 0;                  ///< of the material in memory
    TimeBuckets<Volume> removed;            ///< when it went
  };
  std::optional<Stock> stock;  ///< when there was one and all its cuts are known

  /// The result against the design.
  struct Part {
    double gouge = 0, excess = 0;  ///< the largest found, mm
    double tol_gouge = 0, tol_excess = 0, allowance = 0;
    double bound = 0;                      ///< by which either may be larger, mm
    std::size_t points = 0;                ///< compared
    std::size_t gouges = 0, excesses = 0;  ///< places beyond the tolerances
  };
  std::optional<Part> part;  ///< when there was one and all cuts are known

  std::vector<std::string> unchecked;  ///< what was not checked, in words
  bool interrupted = false;
  bool limit_reached = false;    ///< of simulated time
  bool program_refused = false;  ///< the interpreter refused a block
};

/// Looks at intervals of motion and reports findings.
class Check {
 public:
  virtual ~Check() = default;
  /// Before the first segment, machine at `start`.
  virtual void start(const Scene&, const JointVector&, Findings&) {}
  virtual void step(const Step&, Findings&) = 0;
  /// The scene's bodies changed (a tool change) at the end of `step`, machine at `joints`.
  virtual void scene_changed(const Step&, const JointVector&, Findings&) {}
  virtual void finish(Summary&, Findings&) {}
};

/// The stock as it was during a run, for pictures.
class StockHistory {
 public:
  virtual ~StockHistory() = default;
  /// Its surface at program time t, in the frame of the stock's body. Times must not go back.
  /// Errors: `output_failed`, or what Stock::cut says.
  virtual Expected<std::shared_ptr<const TriangleMesh>> at(double t) = 0;

  /// Pieces of the surface, each made by one tool; 0: as it came to the machine.
  struct MadeBy {
    int tool = 0;
    std::shared_ptr<const TriangleMesh> mesh;
  };
  /// The surface at program time t by the tools that made it, by number; for one history either
  /// this or at(). Empty where it is not known: a turned stock.
  virtual Expected<std::vector<MadeBy>> by_tool(double) { return std::vector<MadeBy>{}; }
};

/// Looks at everything and writes it down.
class Observer {
 public:
  virtual ~Observer() = default;
  virtual void on_start(const Scene&, const JointVector&) {}
  virtual void on_step(const Step&) {}
  virtual void on_finish(const Summary&) {}
};

struct CheckOptions {
  bool limits = true;
  bool collision = true;
  bool cut = true;             ///< the cutter against the stock
  bool keep_cuts = false;      ///< for stock_history()
  double near = 2;             ///< mm; 0 = near misses are not looked for
  double touch = 0.001;        ///< ε_c, mm
  std::size_t detailed = 100;  ///< collisions whose depth is worked out; the others have none
};
std::unique_ptr<Check> make_travel_check();
/// Rotary joints that turn back or wind up.
std::unique_ptr<Check> make_unwind_check();
/// Feed moves that stay far below their F.
std::unique_ptr<Check> make_feed_check();
/// Speeds, accelerations and jerks of the planned motion, and joints that jump.
std::unique_ptr<Check> make_dynamics_check();
/// The planned path against the programmed one.
std::unique_ptr<Check> make_deviation_check();
std::unique_ptr<Check> make_collision_check(const CheckOptions& options);

/// "G54" for 1 … "G59.3" for 9, "G54.1 P7" for 107.
std::string work_system_name(int system);
/// Fields of a finding that follow from the step: place, tool, motion kind, feed, joints at t.
Finding finding_at(Kind kind, const Step& step, double t);
/// Fraction of the block's path that is done at program time t.
double fraction_at(const Step& step, double t);

class CuttingCheck;
class TurningCheck;
class CutListener;

/// What a probing move meets.
struct ProbeResult {
  enum class What : unsigned char {
    tripped,
    missed,
    wrong_start,  ///< it is in that state already
    unknown,
  } what = What::unknown;
  double way = 0;    ///< gone until then, along the feed metric
  std::string text;  ///< the body that is touched or left; for `unknown` why, in words
};

/// Drives the machine through segments.
class Simulator {
 public:
  Simulator(std::shared_ptr<const machine::Machine> machine, const tool::ToolTable& tools,
            const JointVector& start, const CheckOptions& options);

  /// Observers are told in the order in which they were added.
  void add_observer(Observer& observer) { observers_.push_back(&observer); }
  /// Told of all cuts (sim/cuts.h), if there is a stock that is cut. Before start().
  void listen_to_cuts(CutListener& listener);
  /// Puts a tool into the spindle before the run.
  void load_tool(int number) { scene_.load_tool(number); }
  void start();
  /// What the probing move would meet that comes next: `way` is the whole of it at 1 mm a second.
  ProbeResult look_ahead(const plan::Segment& way);
  /// Moves, checks, tells the observers.
  void step(const plan::Segment& segment);
  /// True after a segment with a failure: nothing can follow.
  bool stopped() const { return stopped_; }
  /// Notes something that was not checked: the verdict can't be pass.
  void not_checked(const std::string& what);
  /// The program has looked at what M66 read: what was taken for it counts.
  void inputs_are_used() { inputs_used_ = true; }

  struct Result {
    std::vector<Finding> findings;
    Summary summary;  ///< without the verdict
  };
  Result finish();

  const Scene& scene() const { return scene_; }
  const JointVector& joints() const { return joints_; }
  /// What is left of the stock, in the frame of its body; empty when there was none or it is not
  /// known.
  std::optional<TriangleMesh> part() const;
  /// The same stock for another job (stock.h, Stock::save); likewise.
  std::optional<std::string> saved_stock() const;
  /// The part with a vertex in every cell, and how far each is outside of the design, mm.
  struct ComparedPart {
    TriangleMesh mesh;
    std::vector<double> outside;
  };
  /// Empty when there is no design part.
  std::optional<ComparedPart> deviation() const;
  /// Null when there was no stock or the cuts were not kept. Error kind `output_failed`.
  /// It is cut on a lattice of at most `steps` to its longest side; the default is finer than a
  /// picture's pixels.
  Expected<std::unique_ptr<StockHistory>> stock_history(double steps = 300);

 private:
  void count(const plan::Segment& segment);
  void user_code(const Step& step, const canon::UserCode& code);
  void probed(const Step& step);
  void feed_without_tool(const Step& step);
  /// The fields that follow from the joints at the worst moment.
  void place(Finding& f) const;

  Scene scene_;
  JointVector joints_;
  std::vector<std::unique_ptr<Check>> checks_;
  CuttingCheck* cutting_ = nullptr;  ///< one of them, where the spindle turns the tool …
  TurningCheck* turning_ = nullptr;  ///< … or the work
  std::vector<Observer*> observers_;
  Findings findings_;
  Summary summary_;
  bool stopped_ = false;
  bool told_no_tool_ = false;
  bool inputs_used_ = false;
  std::vector<Finding> inputs_;  ///< of M66 that only count when a program looks at the result
  std::optional<ProbeResult> probing_;  ///< of the probing move that comes next
};

/// Whether the machine's spindle turns the work and not the tool.
bool turns_the_work(const machine::Machine& machine);

/// Whether the machine's stock fits into memory on its lattice; the error `stock_memory` names the
/// finest pitch that does.
Expected<void> stock_fits(const machine::Machine& machine);

struct RunOptions {
  double max_time = 360'000;                                  ///< simulated seconds
  std::function<bool()> stop_requested;                       ///< asked every block; may be empty
  std::function<void(double t, const SourceSpan&)> progress;  ///< may be empty
  std::function<void(const canon::Command&)> listen;          ///< sees every command; may be empty
};

/// What a program can do to switch the kinematics of this machine, as options of the interpreter.
interp::KinematicsSwitch kinematics_switch(const machine::Machine& machine);
/// What the machine does at a tool change, where the options do not say it themselves.
void use_tool_change(const machine::Machine& machine, interp::Options& options);

/// The main loop: program → commands → segments → machine. Errors of the program are in the
/// interpreter's diagnostics; after the first one nothing moves any more, as on the control, and
/// only the text is checked on.
Simulator::Result run(interp::Interpreter& interpreter, const Diagnostics& diagnostics,
                      plan::Planner& planner, Simulator& simulator, const RunOptions& options);

/// fail if a finding or diagnostic is at or above `fail_on`, else unknown if anything was not
/// checked, else pass.
Verdict judge(const std::vector<Finding>& findings, const Summary& summary,
              const Diagnostics& diagnostics, std::optional<Severity> fail_on);

}  // namespace aircut::sim
