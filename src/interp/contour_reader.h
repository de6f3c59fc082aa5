// Turns the blocks between which a turning cycle finds its contour (a sub, or P … Q) into a Contour
// in the ZX plane: u = Z, v = X, program coordinates in mm.
#pragma once

#include <string>
#include <vector>

#include "interp/contour.h"
#include "interp/held_move.h"
#include "interp/run.h"

namespace aircut::interp {

class ContourReader {
 public:
  /// Reads the moves of one executed block. The run's tip follows; nothing is emitted.
  void read(BlockRun& run);
  /// Cuts the corners. False, with what is wrong and the line, when one does not fit; what depends
  /// on a setting of the control goes to `doubt`.
  bool finish(std::string& problem, std::string& doubt);

  /// The first piece is the way from the start point to the first point.
  const Contour& contour() const { return contour_; }
  /// Whether the first block leads along both axes: type II of G71 and G72.
  bool first_names_both() const { return first_names_both_; }
  /// Line of the program that a piece comes from.
  std::uint64_t line_of(std::size_t piece) const;

 private:
  void add(BlockRun& run, const CodeRule& rule, PlanePoint start, PlanePoint end);
  bool place_by_angle(BlockRun& run, double angle, PlanePoint& start, PlanePoint& end);

  Contour contour_;
  std::vector<CornerRequest> corners_;  ///< at the end of each piece
  std::optional<double> open_angle_;    ///< the last piece ends where it meets the next one
  std::vector<std::uint64_t> lines_;
  bool first_names_both_ = false;
  double feed_ = 0;  ///< of the last F word, mm/min or mm/rev as programmed, 0 without
};

}  // namespace aircut::interp
