// Private: tools against a stock that the spindle turns (docs/cutting.md): machines without a Y
// axis. The stock is a round bar or tube about the spindle's axis, the Z axis of M.
//
// Everything happens in the half plane through that axis in which the tool moves. A revolved tool
// (drill, bar) is seen from its side, an insert is its nose and its two edges. What such a section
// sweeps while the stock turns is gone at that radius and height, all around.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sim/checks/cut_rows.h"
#include "sim/checks/part_watch.h"
#include "sim/checks/tool_way.h"
#include "sim/checks/turning_cuts.h"
#include "sim/checks/turning_gouge.h"
#include "sim/sim.h"
#include "stock/stock.h"

namespace aircut::sim {

/// All moves that have cut, on disk, so that the stock can be shown as it was.
class TurningTape;

class TurningCheck final : public Check {
 public:
  explicit TurningCheck(const CheckOptions& options);
  ~TurningCheck() override;

  void start(const Scene& scene, const JointVector& joints, Findings& out) override;
  void step(const Step& step, Findings& out) override;
  void scene_changed(const Step& step, const JointVector& joints, Findings& out) override;
  void finish(Summary& summary, Findings& out) override;

  /// From now on it is not known what is left of the stock.
  void lose(const std::string& why) {
    if (given_up_.empty()) give_up(why);
  }
  /// Who is told of the cuts; outlives the run.
  void listen(CutListener& listener) { listener_ = &listener; }
  /// Null when there is none, or not all that was cut is known.
  const stock::TurnedStock* stock() const;
  /// Its surface in the stock's frame.
  std::optional<TriangleMesh> part() const;
  Expected<std::unique_ptr<StockHistory>> history();
  /// The part to be made; null when there is none or it can't be compared.
  const stock::Part* design() const { return watch_ && stock() ? watch_->part() : nullptr; }

 private:
  /// A piece of the tool in the half plane, its origin where the moves lead.
  struct Solid {
    std::string name;
    machine::Role role;
    std::vector<stock::TurningSection> sections;
    std::vector<tool::Block> blocks = {};
    double wider = 0;  ///< mm, of the blocks on all sides
  };
  /// The stock as it came to the machine; one that was saved has its own lattice.
  Expected<stock::TurnedStock> initial(double pitch) const;
  /// Why the set-up or the tool can't be turned with; empty: it can.
  std::string read_frame(const machine::Machine& machine);
  std::string read_tool(const Scene& scene, const Vec3& axis);
  std::string read_insert(const tool::Tool& tool);
  std::optional<Kind> forbidden(const Step& step) const;
  void look_at(const Step& step, Findings& out);
  bool ask(const Step& step, const StraightMove& move, const Solid& solid);
  void cutter_may_not(const Step& step, const StraightMove& move, const Solid& solid, Kind kind);
  stock::TurningMove in_plane(const stock::TurningSection& section, const StraightMove& move,
                              double part = 1) const;
  stock::TurningTouch touch(const Solid& solid, const StraightMove& move, double part = 1) const;
  /// What a block sweeps in the half plane as the work turns.
  stock::TurningSection swept(const Solid& solid, const tool::Block& block,
                              const StraightMove& move, double part) const;
  double cut(const Step& step, const Solid& solid, const StraightMove& move);
  void tell_gouge(const Step& step, const Solid& solid, const StraightMove& move,
                  const TurningGouge& gouge, double volume);
  void tell_axial(const Step& step, const StraightMove& move, const Solid& solid);
  Finding row(Kind kind, const Step& step, const StraightMove& move, const Solid& solid,
              const stock::TurningTouch& touch) const;
  void turn_to(const Scene& scene);
  void compare_with_part(Summary& summary, Findings& out);
  void give_up(const std::string& why);
  void tell_given_up(const Step& step, Findings& out);

  CheckOptions options_;
  std::optional<machine::RawStock> raw_;
  std::optional<stock::TurnedStock> stock_;
  std::unique_ptr<TurningTape> tape_;
  std::optional<PartWatch> watch_;
  std::string no_part_;                        ///< why the result can't be compared with the part
  double t_end_ = 0;                           ///< of the last step, s
  double initial_volume_ = 0, tolerance_ = 0;  ///< mm³, mm
  TimeBuckets<Volume> removed_when_;
  /// What belongs to one tool. Where channels cut at once each has its own, and
  /// `turret_` is that of the step at hand.
  struct Turret {
    std::shared_ptr<const machine::Machine> machine;
    JointVector joints;                                 ///< at the end of its last step
    Vec3 across = Vec3::UnitX(), side = Vec3::UnitY();  ///< of the half plane; seen from S
    std::vector<Solid> cutters, others;
    Vec3 tip = Vec3::Zero();  ///< of the sections' origin, seen from the tip of the moves; S
    bool tool_read = false, no_tool = true;
    std::string tool_problem;  ///< why it can't be cut with
    Reach reach;
    TurningCuts cuts;  ///< of the step at hand, and rays that it has not passed yet
  };
  std::vector<std::unique_ptr<Turret>> turrets_;
  Turret* turret_ = nullptr;
  std::vector<StraightMove> moves_;  ///< of the step at hand
  CutRows rows_;
  CutListener* listener_ = nullptr;
  std::string given_up_;
  bool told_ = false;
};

}  // namespace aircut::sim
