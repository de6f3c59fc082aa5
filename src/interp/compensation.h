// Cutter radius compensation (G41, G42). See compensation.cpp for the geometry.
#pragma once

#include <string>
#include <vector>

#include "canon/canon.h"
#include "interp/state.h"

namespace aircut::interp {

class BlockRun;

/// A straight move or an arc as programmed, before compensation.
struct PlannedMove {
  enum class Kind : unsigned char { rapid, feed, arc } kind = Kind::feed;
  AxisValues end;      ///< tip, machine coordinates
  canon::ArcFeed arc;  ///< of an arc; its `end` is the same
};

/// Holds back the last compensated move until the next one says where it really ends.
class Compensator {
 public:
  bool holds() const { return !held_.empty(); }
  void hold(canon::Command command) { held_.push_back(std::move(command)); }

  /// Compensates the move and emits what has become final. The state's tip is updated. Errors go
  /// to the run.
  void move(BlockRun& run, const PlannedMove& planned);
  /// Emits everything that is held back (G40, program end).
  void flush(BlockRun& run);
  void start(const ModalState& state);

 private:
  struct Point {
    double x = 0, y = 0;
  };
  void enter(BlockRun& run, const PlannedMove& planned);
  void follow(BlockRun& run, const PlannedMove& planned);

  std::vector<canon::Command> held_;  ///< [0] is the move whose end is not final
  AxisValues programmed_;             ///< end of the last move as programmed, tip coordinates
};

}  // namespace aircut::interp
