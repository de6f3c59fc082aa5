// Private: the look-ahead window. Pieces whose geometry is final come in, in order, with the speed
// allowed at each joint between them; segments whose time law is final go out.
#pragma once

#include "plan/jerk.h"
#include "plan/override.h"
#include "plan/ring.h"
#include "plan/speed.h"

namespace aircut::plan {

/// A piece of path between two joints (here: junctions) of the chain.
struct Piece {
  Segment segment;  ///< all but profile, t_start and limited_by
  Grid grid;
  double entry = 0;     ///< largest squared speed at the start, in this piece's s; 0 = stop
  double per_exit = 1;  ///< squared speed here per squared speed at the end of the piece before
};

class Chain {
 public:
  /// The window is emitted piecewise when it holds more than this many nodes.
  /// `start`: joints at program time 0. The kinematics must outlive the chain.
  Chain(std::size_t max_nodes, const machine::Kinematics& kinematics, const JointLimits& limits,
        const machine::JointVector& start, double period, std::vector<OverrideEvent> overrides);

  /// A piece of path (see Piece). The grid is swapped with one that is no longer needed, whose
  /// memory can be used again.
  void push(Segment&& segment, Grid& grid, double entry, double per_exit);
  /// A segment that takes no way: it comes out after the piece before it. One that takes time needs
  /// a stop() first.
  void push_still(Segment segment);
  /// The last piece ends at rest; all of it is final.
  void stop();

  std::optional<Segment> take();
  /// Revolutions of the spindle at the end of what was handed out.
  double spindle_turns() const { return turns_; }
  Statistics statistics() const;

 private:
  struct Item {
    Piece piece;
    double factor = 1;           ///< of its speeds by overrides; 0: held
    double before = 1;           ///< the largest since the motion was last as fast as it may be
    std::vector<Segment> after;  ///< stand-still segments behind it
    Controllable stop, fast;     ///< results of the backward passes
  };

  void emit_final();
  void brake_all();
  bool emit(std::size_t count);
  void hand_on(Segment&& segment, Grid&& grid, Ride&& ride, double per_exit, double factor);
  void hand_on_still(Segment&& segment);
  void finish_front(Ride&& ride, double factor);
  // With overrides (chain_override.cpp):
  /// Where the next event comes under jerk limits.
  struct EventPlace {
    std::size_t piece = 0;  ///< of the window
    double s = 0, v = 0;    ///< of its path, and the speed there
    double t = 0;           ///< program time there
  };
  double entry_of(std::size_t i, double b_end) const;
  std::optional<EventPlace> find_event() const;
  void go_until(const EventPlace& place, Ride ride, double factor);
  bool interrupted(const Ride& ride) const;
  void set_factor(Item& item);
  void give_part(Ride ride, double factor);
  void go_until_event(Ride ride, double factor);
  void override_until(double t);
  bool slow_down(double& t);
  void wait_for_event();
  double now() const;
  void hand_out(Segment&& segment);
  void drain_jerk_stage();

  std::size_t max_nodes_;
  JointLimits limits_;
  Ring<Item> window_;
  std::size_t nodes_ = 0;                         ///< in the window
  std::uint64_t all_pieces_ = 0, all_nodes_ = 0;  ///< that came in
  std::size_t next_try_ = 512;  ///< nodes at which it is worth looking for final pieces
  double b_ = 0;      ///< squared speed at the start of the window, in its first piece's s
  double clock_ = 0;  ///< program time, s
  double turns_ = 0;
  Overrides overrides_;            ///< as of the time now()
  std::optional<double> known_;    ///< time at the end of what was handed on, where it is known
  std::optional<JerkStage> jerk_;  ///< when a joint has a jerk limit
  std::vector<Segment> ready_;
  std::size_t taken_ = 0;  ///< of ready_
};

}  // namespace aircut::plan
