// Moves in the ZX plane, written in the working orientation of a contour (contour.h).
#pragma once

#include "interp/contour.h"
#include "interp/run.h"

namespace aircut::interp {

class TurningMotion {
 public:
  enum class Passes : unsigned char { along_z, along_x };
  TurningMotion(const CodeRule& rule, BlockRun& run, Passes passes)
      : rule_(rule), run_(run), passes_(passes) {}

  /// A contour read as (Z, X) with the coordinate along the passes as u.
  Contour plane_contour(const Contour& contour) const;
  /// Takes the working orientation of this contour.
  void orient(const Contour& contour) { mirror_ = working_orientation(contour); }
  void mirror_as(Mirror mirror) { mirror_ = mirror; }
  ContourPiece to_work(const ContourPiece& piece) const { return mirrored(piece, mirror_); }
  PlanePoint to_work(PlanePoint point) const { return mirrored(point, mirror_); }
  /// Where the tip is.
  PlanePoint position() const;

  void rapid(PlanePoint end, const char* what);
  void feed(PlanePoint end, const char* what);
  void follow(const ContourPiece& piece, const char* what);
  void thread(PlanePoint end, double per_revolution, int spindle, const char* what);
  void make(const CutterMove& move);

 private:
  AxisValues tip_at(PlanePoint work) const;

  const CodeRule& rule_;
  BlockRun& run_;
  Passes passes_;
  Mirror mirror_;
};

/// The tip with X and Z of the program set, all other axes where they are.
AxisValues tip_in_zx(const ModalState& state, double x, double z);

}  // namespace aircut::interp
