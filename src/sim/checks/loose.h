// Private: pieces of the stock that come loose (verification.md §4.3, loose_piece).
//
// Whether the stock is in one piece is looked at now and then: after so many cuts that it costs
// little, at a tool change and at the end. When a piece more is found than before, the cuts since
// the last look are made once more on a copy of the stock as it was then (from the tape of all
// cuts) and halved until the cut is known that parted it. What was parted off is loose when nothing
// that carries the stock touches it.
#pragma once

#include <string>
#include <vector>

#include "sim/checks/cut_tape.h"
#include "sim/sim.h"
#include "stock/stock.h"

namespace aircut::sim {

class LoosePieces {
 public:
  void start(const stock::Stock& stock);
  /// A piece that waits to be cut, and the step that it belongs to.
  void add(const Step& step, const stock::Piece& piece);
  bool due() const { return pieces_.size() >= window_; }
  /// All pieces were cut. `raw`, `tape`: how to come back to the stock of the last look.
  Expected<void> look(const stock::Stock& stock, const machine::RawStock& raw, CutTape& tape,
                      const Scene& scene, Findings& out);

 private:
  /// What a row needs to know of a step; Finding itself would be too large to keep for each.
  struct Where {
    SourceSpan span;
    std::uint64_t block = 0;
    double t0 = 0, t1 = 0, feed = 0, rpm = 0;
    int tool = 0;
    plan::MotionKind motion = plan::MotionKind::idle;
    int work_system = 1;
    JointVector joints;      ///< at its end
    std::size_t pieces = 0;  ///< of the window, up to its end
  };
  std::vector<stock::Separate> pieces_of(const stock::Stock& stock) const;
  /// Halves the pieces [from, to) of the window; `stock` is as before the first of them.
  Expected<void> find(stock::Stock stock, std::size_t from, const machine::RawStock& raw,
                      const Scene& scene, Findings& out);
  void tell(const stock::Stock& stock, std::size_t last, const std::vector<stock::Separate>& before,
            const std::vector<stock::Separate>& now, const machine::RawStock& raw,
            const Scene& scene, Findings& out);
  Finding row_at(std::size_t piece, const Scene& scene) const;

  std::size_t window_ = 0;
  double least_ = 0;                    ///< mm³
  std::vector<stock::Separate> known_;  ///< at the last look
  std::uint64_t done_ = 0;              ///< pieces cut before the last look
  std::vector<stock::Piece> pieces_;    ///< since then
  std::vector<Where> steps_;            ///< of these
  std::size_t told_ = 0;
};

}  // namespace aircut::sim
