// Private: all cuts of a run in their order, kept on disk, so that the stock can be shown as it was
// at any time without keeping its states.
#pragma once

#include <cstdio>
#include <memory>
#include <vector>

#include "sim/sim.h"
#include "stock/stock.h"

namespace aircut::sim {

/// The raw piece as a stock. Errors: stock.h, Stock::make.
Expected<stock::Stock> make_stock(const machine::RawStock& raw, double pitch);
/// The spacing of its lattice when the set-up gives none: a number of 1, 2, 5 · 10^n, about
/// 1/500 of its longest side, at most 1 mm.
double default_pitch(const machine::RawStock& raw);

class CutTape {
 public:
  struct Cutter {
    std::unique_ptr<stock::CutterProfile> profile;
    int tool = 0;  ///< its number
  };
  /// Error kind `output_failed`: there is no place for a temporary file.
  static Expected<CutTape> make();

  /// The cutters that the next pieces point to; valid until the tape is gone.
  const stock::CutterProfile* keep(const stock::CutterProfile& cutter, int tool);
  /// `cutter` is a pointer that keep() gave. Error kind `output_failed`.
  /// From t0 to t1 of the program's time.
  Expected<void> add(const stock::Piece& piece, double t0, double t1);
  /// The stock, on a lattice of this pitch, after the first `pieces` of the tape.
  Expected<stock::Stock> stock_after(const machine::RawStock& raw, double pitch,
                                     std::uint64_t pieces);
  /// Plays the tape from its beginning, on a lattice that is fine enough for pictures.
  Expected<std::unique_ptr<StockHistory>> play(const machine::RawStock& raw, double steps);

 private:
  std::shared_ptr<std::FILE> file_;
  std::shared_ptr<std::vector<Cutter>> cutters_;
};

}  // namespace aircut::sim
