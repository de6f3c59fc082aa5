// Private: the cutter against the stock of that moment (verification.md §4.3), and the stock
// itself.
//
//   step ─► straight moves of the tool, seen from the stock (tool_way.h)
//        ─► may the cutter cut here? Yes: the move waits in a batch. No: the stock is asked first,
//           and what would be taken is a finding.
//        ─► shank and holder: the stock is asked. Clear of the stock as it was when the batch began
//           is clear, since material only goes away; otherwise the batch is cut and it is asked
//           again.
//
// A shank and its own move. While the tool goes down along its axis, or level, the cutter never
// comes to a point later in the move that the shank passes: it is above the cutter by then. So the
// shank is asked after the move is cut. While the tool goes up, such a point can't have been cut
// earlier in the move. So it is asked before. Both are exact.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "sim/checks/cut_rows.h"
#include "sim/checks/cut_tape.h"
#include "sim/checks/engagement.h"
#include "sim/checks/loose.h"
#include "sim/checks/part_watch.h"
#include "sim/checks/tool_way.h"
#include "sim/cuts.h"
#include "sim/sim.h"
#include "stock/stock.h"

namespace aircut::sim {

class CuttingCheck final : public Check {
 public:
  explicit CuttingCheck(const CheckOptions& options) : options_(options) {}

  void start(const Scene& scene, const JointVector& joints, Findings& out) override;
  void step(const Step& step, Findings& out) override;
  void scene_changed(const Step& step, const JointVector& joints, Findings& out) override;
  void finish(Summary& summary, Findings& out) override;

  /// Who is told of the cuts; outlives the run.
  void listen(CutListener& listener) { listener_ = &listener; }
  /// Null when there is none, or not all that was cut is known.
  const stock::Stock* stock() const;
  /// The part to be made; null when there is none or it can't be compared.
  const stock::Part* part() const { return part_ && stock() ? part_->part() : nullptr; }
  /// Its surface as it is now, for a probe; an error says why that is not known.
  Expected<std::shared_ptr<const collide::CollisionMesh>> surface();
  /// The probe has touched the stock and may come off it.
  void probed() { touching_ = true; }
  /// Null when there is no stock.
  CutTape* tape() { return tape_ ? &*tape_ : nullptr; }

 private:
  /// A solid of the tool.
  struct Solid {
    std::string name;
    machine::Role role;
    stock::CutterProfile profile;
    stock::CutterProfile wide;  ///< larger by what rough moves may be wrong, and by half a pitch
  };
  void read_tool(const Scene& scene);
  std::optional<Kind> forbidden(const Step& step) const;
  /// `part`: only this fraction of the move, from its start.
  stock::Piece piece(const Solid& solid, const StraightMove& move, double part = 1) const;
  /// False when the solid passes outside of the box of the raw piece.
  bool near(const Solid& solid, const StraightMove& move) const;
  /// Any material, or more than a touch. False when the stock is lost.
  bool touches(const stock::Piece& piece);
  bool takes(const stock::Piece& piece);
  stock::Touch touch_of(const stock::Piece& piece);
  void hold(const Step& step, const Solid& cutter, const StraightMove& move);
  void flush();
  void note_cut(const Step& step, const StraightMove& move);
  void tell_cuts();
  bool find_moves(const Step& step);
  void look_at(const Step& step, Findings& out);
  void cutter_may_not(const Step& step, const StraightMove& move, const Solid& cutter, Kind kind);
  void ask(const Step& step, const StraightMove& move, const Solid& solid);
  void look_for_air(const Step& step, const std::vector<StraightMove>& moves, Findings& out);
  /// `enough`: whether a part of the move does what the row is about.
  Finding row(Kind kind, const Step& step, const StraightMove& move, const Solid& solid,
              const Vec3& point, const std::function<bool(const stock::Piece&)>& enough);
  void look_at_part(const Step& step, const Solid& cutter, const StraightMove& move);
  void compare_with_part(Summary& summary, Findings& out);
  void look_for_loose(const Scene& scene, Findings& out);
  bool comes_off(const StraightMove& move, const Solid& solid);
  bool is_measured(const Step& step);
  void give_up(const std::string& why);
  void tell_given_up(const Step& step, Findings& out);

  CheckOptions options_;
  std::optional<machine::RawStock> raw_;
  std::optional<stock::Stock> stock_;
  std::optional<CutTape> tape_;
  std::optional<PartWatch> part_;
  EngagementWatch engagement_;
  LoosePieces loose_;
  machine::JointVector joints_;  ///< at the end of the last step
  std::shared_ptr<const machine::Machine> machine_;
  const Scene* scene_ = nullptr;      ///< of the run
  std::size_t measured_ = 0;          ///< blocks with a contact whose depth is measured …
  std::uint64_t measured_block_ = 0;  ///< … and the last of them
  double t_end_ = 0;                  ///< of the last step, s
  double initial_volume_ = 0, tolerance_ = 0;  ///< mm³, mm
  std::int64_t removed_ = 0;                   ///< length of material taken on Z rays, quanta
  std::vector<Solid> cutters_, others_;
  std::map<const stock::CutterProfile*, const stock::CutterProfile*> taped_;  ///< of cutters_
  bool tool_known_ = true;  ///< its solids are known, or there is none
  int tool_number_ = 0;
  bool center_cutting_ = true, left_hand_ = false, no_tool_ = true;
  Reach reach_, cutter_reach_;          ///< of the whole tool, of what cuts
  std::vector<const Solid*> doubtful_;  ///< of others_: not clear of the stock over the whole step
  std::vector<StraightMove> moves_;     ///< of the step at hand
  CutRows rows_;
  std::vector<stock::Piece> batch_;                 ///< waiting to be cut
  std::vector<std::array<double, 2>> batch_times_;  ///< program times of each, from and to
  TimeBuckets<Volume> removed_when_;
  CutListener* listener_ = nullptr;
  /// A whole move that waits in the batch, from where to where it leads in M at rest.
  struct WholeCut {
    Cut cut;
    Vec3 to = Vec3::Zero();
    JointVector joints_to;
  };
  std::vector<WholeCut> batch_cuts_;  ///< empty without a listener
  std::vector<stock::Slice> slices_;  ///< of the batch, once it is cut
  std::string given_up_;  ///< why nothing more is known of the stock; empty: it is known
  std::string no_part_;   ///< why the result can't be compared with the part
  bool told_ = false;
  bool touching_ = false;  ///< the probe, since its last probing move
  std::shared_ptr<const collide::CollisionMesh> surface_;
  std::int64_t removed_at_surface_ = 0;  ///< `removed_` when that was made
};

}  // namespace aircut::sim
