// Machine coordinates and reference points of Fanuc-like controls: G53, G27 to G30, and G31.
// The first reference point is the machine's zero unless the parameter file says otherwise
// (#5161…); the second to fourth are nowhere by themselves: #5181…, #20181…, #20201….
#include <cmath>

#include "base/text.h"
#include "interp/codes/codes.h"
#include "interp/dialect.h"

namespace aircut::interp {
namespace {

constexpr double at_reference = 0.001;  // mm or rad: G27 takes that for the same place

bool comp_is_off(BlockRun& run, const CodeRule& rule) {
  if (run.state.comp.side == CompSide::off) return true;
  run.error("comp_illegal", rule,
            name_of(rule) + " can't be used while radius compensation is on; give G40 before");
  return false;
}

AxisSet named_axes(const BlockRun& run) {
  AxisSet axes;
  for (const Axis axis : all_axes)
    if (run.axis(axis) || run.increment(axis)) axes.add(axis);
  return axes;
}

bool check_axes(BlockRun& run, const CodeRule& rule) {
  const AxisSet axes = named_axes(run);
  if (!axes.empty()) return comp_is_off(run, rule) && frame_allows(run, rule, axes);
  run.error("axis_word_missing", rule, name_of(rule) + " needs at least one axis word");
  return false;
}

// G28, G30 and (Fanuc's mills) G53 take the length offset of the axes away that they move; G43
// stays on the screen and is to be given again.
void suspend_length_offset(BlockRun& run, AxisSet axes) {
  if (run.session.table.lathe()) return;
  AxisValues offset = run.state.length_offset;
  for (const Axis axis : all_axes)
    if (axes.has(axis)) offset[axis] = 0;
  if (offset == run.state.length_offset) return;
  use_length_offset(run, offset);
  run.state.length_suspended = true;
}

/// The machine position of the n-th reference point; nothing with an error when it is not known.
std::optional<AxisValues> reference_point(const CodeRule& rule, BlockRun& run, int n) {
  if (const auto point = run.session.offsets.reference(n)) return point;
  run.error("reference_error", rule,
            "where the machine's reference point " + std::to_string(n) +
                " is, is not known; give it in the parameter file as #" +
                std::to_string(OffsetMemory::reference_number(n)) + " and the numbers behind it");
  return std::nullopt;
}

void to_machine_position(BlockRun& run, const AxisValues& position, AxisSet axes, bool feeds,
                         std::string what) {
  ModalState& state = run.state;
  AxisValues end = state.tip;
  for (const Axis axis : all_axes)
    if (axes.has(axis)) end[axis] = position[axis] - state.length_offset[axis];
  if (feeds)
    run.emit(canon::LinearFeed{end}, std::move(what));
  else
    run.emit(canon::Rapid{end}, std::move(what));
  state.tip = end;
}

}  // namespace

// Fanuc moves at rapid whatever mode is in force; Haas as G0 or G1 say.
void fanuc_machine_coordinates(const CodeRule& rule, BlockRun& run) {
  const AxisSet axes = named_axes(run);
  if (axes.empty()) return;
  if (!comp_is_off(run, rule) || !frame_allows(run, rule, axes)) return;
  if (run.state.incremental)
    return run.error("g53_error", rule,
                     "with G91 the control ignores G53, so the move is not made; give G90");
  const bool haas = run.session.options.dialect == Dialect::haas;
  bool feeds = false;
  if (haas) {
    const int motion = run.motion_rule ? run.motion_rule->code : run.state.motion;
    feeds = motion == 10;
    if (motion != 0 && !feeds)
      return run.error("g53_error", rule, "G53 works with G0 and G1 only; give one of them");
    if (feeds && !feed_is_set(run, rule)) return;
  }
  AxisValues position;
  for (const Axis axis : all_axes) position[axis] = run.axis(axis).value_or(0);
  to_machine_position(run, position, axes, feeds, "G53");
  if (!haas) suspend_length_offset(run, axes);
}

void fanuc_home(const CodeRule& rule, BlockRun& run) {
  if (!check_axes(run, rule) || !polar_is_off(run, rule)) return;
  int n = 1;
  if (rule.code == 300) {
    n = 2;
    if (run.has('P')) {
      const auto p = run.integer('P', 2, 4);
      if (!p) return;
      n = *p;
    }
  }
  const auto point = reference_point(rule, run, n);
  if (!point) return;
  const auto middle = target_of(run);
  if (!middle) return;
  ModalState& state = run.state;
  const AxisSet axes = named_axes(run);
  run.emit(canon::Rapid{*middle}, name_of(rule) + " intermediate point");
  state.tip = *middle;
  AxisValues way = state.way_point.value_or(*middle + state.length_offset);
  for (const Axis axis : all_axes)
    if (axes.has(axis)) way[axis] = (*middle + state.length_offset)[axis];
  state.way_point = way;
  to_machine_position(run, *point, axes, false, name_of(rule) + " reference point");
  suspend_length_offset(run, axes);
}

// G29: by way of G28's intermediate point to the words.
void return_from_home(const CodeRule& rule, BlockRun& run) {
  if (!check_axes(run, rule) || !polar_is_off(run, rule)) return;
  ModalState& state = run.state;
  if (!state.way_point)
    return run.error("reference_error", rule,
                     "G29 goes by way of the intermediate point of G28 or G30; give one of them "
                     "before");
  const AxisSet axes = named_axes(run);
  const auto end = target_of(run);
  if (!end) return;
  to_machine_position(run, *state.way_point, axes, false, "G29 intermediate point");
  // With G91 the words count from the intermediate point.
  AxisValues target = *end;
  if (state.incremental) {
    const auto from_there = target_of(run);
    if (!from_there) return;
    target = *from_there;
  }
  run.emit(canon::Rapid{target}, "G29");
  state.tip = target;
}

// G27: rapid to the words, which must be the reference point.
void check_home(const CodeRule& rule, BlockRun& run) {
  if (!check_axes(run, rule) || !polar_is_off(run, rule)) return;
  const auto point = reference_point(rule, run, 1);
  const auto end = target_of(run);
  if (!point || !end) return;
  for (const Axis axis : all_axes) {
    if (!run.axis(axis)) continue;
    const double off = (*end)[axis] + run.state.length_offset[axis] - (*point)[axis];
    if (std::fabs(off) > at_reference)
      return run.error("reference_error", letter(axis),
                       std::string("G27 must end at the reference point, but ") + letter(axis) +
                           " ends " + fixed(is_rotary(axis) ? off / radian_per_degree : off, 4) +
                           (is_rotary(axis) ? " degrees" : " mm") + " from it");
  }
  run.emit(canon::Rapid{*end}, "G27");
  run.state.tip = *end;
}

// G31: a feed that the skip signal ends; to reach the end without it is no error.
void skip_move(const CodeRule& rule, BlockRun& run) {
  if (!run.has_axis_words())
    return run.error("axis_word_missing", rule, name_of(rule) + " needs at least one axis word");
  if (!comp_is_off(run, rule) || !feed_is_set(run, rule) || !polar_is_off(run, rule)) return;
  const auto end = target_of(run);
  if (!end) return;
  canon::Probe move;
  move.end = *end;
  run.emit(move);
  run.state.tip = *end;
}

}  // namespace aircut::interp
