#include "interp/codes/hole_motion.h"

namespace aircut::interp {

HoleMotion::HoleMotion(const CodeRule& rule, BlockRun& run, double unit)
    : rule_(rule), run_(run), state_(run.state), axes_(axes_of(run.state.plane)), unit_(unit) {
  const AxisValues start = to_program(state_, state_.tip);
  a_ = start[axes_.first] / unit_;
  b_ = start[axes_.second] / unit_;
  c_ = start[axes_.normal] / unit_;
}

void HoleMotion::name_hole(int number, int count) {
  suffix_ = count > 1 ? ", hole " + std::to_string(number) + " of " + std::to_string(count) : "";
}

void HoleMotion::turn(canon::SpindleTurn turn) {
  canon::TurnSpindle command;
  command.spindle = spindle_;
  command.turn = turn;
  run_.emit(command, name_of(rule_) + suffix_);
}

void HoleMotion::peck(double depth, bool full, double r, double clearance) {
  feed(depth, "peck");
  if (full) rapid_to(r, "out of the hole");
  rapid_to(depth + clearance, full ? "back down" : "chip break");
}

void HoleMotion::dwell(double seconds) { run_.emit(canon::Dwell{seconds}, told("dwell")); }

AxisValues HoleMotion::tip_at(double a, double b, double c) const {
  AxisValues program = to_program(state_, state_.tip);
  program[axes_.first] = a * unit_;
  program[axes_.second] = b * unit_;
  program[axes_.normal] = c * unit_;
  AxisValues tip = to_tip(state_, program);
  AxisSet named;
  for (const Axis axis : {axes_.first, axes_.second, axes_.normal}) named.add(axis);
  const AxisSet moved = moved_by(state_, named);
  for (const Axis axis : all_axes)
    if (!moved.has(axis)) tip[axis] = state_.tip[axis];  // to the last bit
  return tip;
}

void HoleMotion::move(bool is_rapid, double a, double b, double c, const char* what) {
  state_.tip = tip_at(a, b, c);
  a_ = a;
  b_ = b;
  c_ = c;
  std::string expanded = told(what);
  if (is_rapid)
    run_.emit(canon::Rapid{state_.tip}, std::move(expanded));
  else
    run_.emit(canon::LinearFeed{state_.tip}, std::move(expanded));
}

}  // namespace aircut::interp
