// Private: which cut made each place of the part, and what it left there.
#pragma once

#include "process/elastic.h"

namespace aircut::process {

class PartMap {
 public:
  /// Without it nothing is kept.
  void keep() { keeps_ = true; }
  void add(const machine::Machine& machine, const Engaged& engaged, const Answer& found);
  /// See Along::on_part().
  std::vector<std::optional<double>> on(const TriangleMesh& mesh) const;

 private:
  /// A stretch in the stock's frame S.
  struct Mark {
    Vec3 from = Vec3::Zero(), to = Vec3::Zero();  // milled: of the tip; turned: of the nose's point
    Vec3 axis = Vec3::UnitZ();                    // milled: from the tip to the spindle
    Vec3 moved = Vec3::Zero();  // milled: the displacement; turned: the normal of the surface
    double error = 0;           // turned
    double radius = 0, slope = 0, height = 0;  // of the cutter: at its tip, per height; its depth
    double reach = 0;                          // the lattice's pitch
    bool turned = false, ball = false;
  };
  class Grid;
  /// How far a place is from what the cutter sweeps, or nothing when it is not near its surface.
  static std::optional<double> away(const Mark& mark, const Vec3& place);
  static std::optional<double> error_at(const Mark& mark, const Vec3& place, const Vec3& normal);

  bool keeps_ = false;
  std::vector<Mark> marks_;
};

}  // namespace aircut::process
