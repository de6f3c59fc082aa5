#include "interp/codes/turning.h"

#include "interp/codes/codes.h"

namespace aircut::interp {
namespace {

PlanePoint swapped(PlanePoint p) { return {p.v, p.u}; }

ContourPiece swapped(ContourPiece piece) {
  piece.start = swapped(piece.start);
  piece.end = swapped(piece.end);
  piece.centre = swapped(piece.centre);
  piece.turn = -piece.turn;
  return piece;
}

}  // namespace

AxisValues tip_in_zx(const ModalState& state, double x, double z) {
  AxisValues program = to_program(state, state.tip);
  program[Axis::x] = x;
  program[Axis::z] = z;
  AxisValues tip = to_tip(state, program);
  AxisSet named;
  named.add(Axis::x);
  named.add(Axis::z);
  const AxisSet moved = moved_by(state, named);
  for (const Axis axis : all_axes)
    if (!moved.has(axis)) tip[axis] = state.tip[axis];
  return tip;
}

Contour TurningMotion::plane_contour(const Contour& contour) const {
  if (passes_ == Passes::along_z) return contour;
  Contour result;
  for (const ContourPiece& piece : contour) result.push_back(swapped(piece));
  return result;
}

PlanePoint TurningMotion::position() const {
  const AxisValues program = to_program(run_.state, run_.state.tip);
  const PlanePoint at{program[Axis::z], program[Axis::x]};
  return to_work(passes_ == Passes::along_z ? at : swapped(at));
}

AxisValues TurningMotion::tip_at(PlanePoint work) const {
  PlanePoint at = mirrored(work, mirror_);
  if (passes_ == Passes::along_x) at = swapped(at);
  return tip_in_zx(run_.state, at.v, at.u);
}

void TurningMotion::rapid(PlanePoint end, const char* what) {
  run_.state.tip = tip_at(end);
  run_.emit(canon::Rapid{run_.state.tip}, name_of(rule_) + " " + what);
}

void TurningMotion::feed(PlanePoint end, const char* what) {
  run_.state.tip = tip_at(end);
  run_.emit(canon::LinearFeed{run_.state.tip}, name_of(rule_) + " " + what);
}

void TurningMotion::follow(const ContourPiece& piece, const char* what) {
  if (piece.turn == 0) return feed(piece.end, what);
  // A mirror and the exchange of the two coordinates each turn the sense round.
  const bool other_way = (mirror_.u != mirror_.v) != (passes_ == Passes::along_x);
  const AxisValues middle = tip_at(piece.centre);
  run_.state.tip = tip_at(piece.end);
  canon::ArcFeed arc;
  arc.end = run_.state.tip;
  arc.centre = Vec3(middle[Axis::x], middle[Axis::y], middle[Axis::z]);
  arc.normal = plane_normal(run_.state);
  arc.turns = other_way ? -piece.turn : piece.turn;
  arc.plane = canon::Plane::zx;
  run_.emit(std::move(arc), name_of(rule_) + " " + what);
}

void TurningMotion::thread(PlanePoint end, double per_revolution, int spindle, const char* what) {
  run_.state.tip = tip_at(end);
  canon::SyncFeed move;
  move.end = run_.state.tip;
  move.per_revolution = per_revolution;
  move.spindle = spindle;
  run_.emit(std::move(move), name_of(rule_) + " " + what);
}

void TurningMotion::make(const CutterMove& move) {
  if (move.rapid) return rapid(move.end, move.what);
  ContourPiece piece;
  piece.end = move.end;
  piece.centre = move.centre;
  piece.turn = move.turn;
  follow(piece, move.what);
}

}  // namespace aircut::interp
