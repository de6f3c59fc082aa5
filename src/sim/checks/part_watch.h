// Private: the part that a job makes (verification.md §4.4). While it is cut, what goes into the
// part; in the end, where the result differs from it.
#pragma once

#include <vector>

#include "sim/sim.h"
#include "stock/stock.h"

namespace aircut::sim {

/// The stock's frame seen from the bed with the joints there.
Pose at_end(const machine::Machine& machine, const machine::RawStock& raw,
            const JointVector& joints);
/// The fields of a row without a line, at the end of the run.
Finding end_of_run(double t, const JointVector& joints);

class PartWatch {
 public:
  /// Tells `wrong_setup` when the part stands out of the raw piece. Errors: stock.h, Stock::make.
  static Expected<PartWatch> make(const machine::DesignPart& design, const machine::RawStock& raw,
                                  double pitch, Findings& out);

  const machine::DesignPart& design() const { return design_; }
  const stock::Part* part() const { return &part_; }
  double bound() const { return pitch_ / 2; }  ///< of depths, mm

  /// What a row of kind gouge_live says of the part, whatever `cutter` it is that goes into it.
  void describe(Finding& row, const std::string& cutter) const;
  /// How deep the piece goes into what is left of the part; 0 within the tolerance.
  Expected<stock::Touch> depth(const stock::Piece& piece) const;
  /// Takes it off the part; `row` tells of it.
  Expected<void> take(const stock::Piece& piece, const Finding& row, const stock::Touch& touch);

  /// The same where what was taken is known otherwise (turning).
  void note(const Finding& row, const stock::Touch& touch);

  /// Compares the result; `end` has the fields of rows without a line. X_WS: the stock's frame.
  template <class Material>
  Summary::Part compare(const Material& stock, const Pose& X_WS, const Finding& end,
                        Findings& out) const {
    return tell(part_.compare(stock, tolerances()), X_WS, end, out);
  }

 private:
  struct Cut {
    Finding row;
    stock::Touch touch;
  };
  PartWatch(const machine::DesignPart& design, stock::Part part, double pitch)
      : design_(design), part_(std::move(part)), pitch_(pitch) {}
  stock::PartTolerances tolerances() const {
    return {.gouge = design_.gouge,
            .excess = design_.excess,
            .allowance = design_.allowance,
            .leave = design_.leave};
  }
  Summary::Part tell(const stock::Deviation& found, const Pose& X_WS, const Finding& end,
                     Findings& out) const;
  const Cut* who_cut(const stock::Spot& spot) const;

  machine::DesignPart design_;
  stock::Part part_;
  double pitch_;
  std::vector<Cut> cuts_;  ///< into the part, the first of them
};

}  // namespace aircut::sim
