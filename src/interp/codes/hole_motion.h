// The moves of canned cycles at one hole. Coordinates: a and b in the plane, c along its normal,
// program coordinates in mm, or as numbers of another unit.
#pragma once

#include <string>

#include "interp/run.h"

namespace aircut::interp {

class HoleMotion {
 public:
  /// `unit`: mm per 1 of the coordinates.
  HoleMotion(const CodeRule& rule, BlockRun& run, double unit = 1);

 protected:
  AxisValues tip_at(double a, double b, double c) const;
  void move(bool is_rapid, double a, double b, double c, const char* what);
  void rapid_to(double c, const char* what) { move(true, a_, b_, c, what); }
  void feed(double c, const char* what) { move(false, a_, b_, c, what); }
  /// One peck of a chip-breaking (`full` false) or chip-removing cycle, ready for the next one.
  void peck(double depth, bool full, double r, double clearance);
  void turn(canon::SpindleTurn turn);
  void dwell(double seconds);
  /// For messages: "hole 2 of 5".
  void name_hole(int number, int count);
  std::string told(const char* what) const { return name_of(rule_) + " " + what + suffix_; }

  const CodeRule& rule_;
  BlockRun& run_;
  ModalState& state_;
  PlaneAxes axes_;
  double unit_;                   ///< mm
  double a_ = 0, b_ = 0, c_ = 0;  ///< where the tip is
  int spindle_ = 0;

 private:
  std::string suffix_;
};

}  // namespace aircut::interp
