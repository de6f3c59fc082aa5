// Work systems of Fanuc-like controls: G54-G59, G54.1 P, G154 P, G110-G129, G52, G92, G10, G53.
//
//   tip = F(program) + G52 + G92's shift + common offset + offset of the system
//
// where F is the program's frame. G52 and the shift act in every work system. As on LinuxCNC, a
// change of an offset moves no axis.
#include <cmath>

#include "base/text.h"
#include "interp/codes/codes.h"
#include "interp/dialect.h"

namespace aircut::interp {
namespace {

bool comp_is_off(BlockRun& run, const CodeRule& rule) {
  if (run.state.comp.side == CompSide::off) return true;
  run.error("comp_illegal", rule,
            name_of(rule) + " can't be used while radius compensation is on; give G40 before");
  return false;
}

bool no_frame(BlockRun& run, const CodeRule& rule) {
  if (!run.state.frame.active()) return true;
  run.error("frame_error", rule,
            name_of(rule) +
                " can't be used while mirror image, scaling or rotation is on; give "
                "G69, G50 or G50.1 before");
  return false;
}

bool is_haas(const BlockRun& run) { return run.session.options.dialect == Dialect::haas; }

// Which system a G54 … G59, G54.1, G110 … or G154 word selects; nothing with an error.
std::optional<int> system_of(const CodeRule& rule, BlockRun& run) {
  if (rule.code >= 1100 && rule.code <= 1290)
    return OffsetMemory::extended + (rule.code - 1090) / 10;
  const int last = is_haas(run) ? 99 : OffsetMemory::max_extended;
  if (rule.code == 1540 || rule.code == 541 || (rule.code == 540 && run.has('P'))) {
    if (!run.has('P')) {
      run.error("word_missing", rule, name_of(rule) + " needs P: the number of the work system");
      return std::nullopt;
    }
    const auto p = run.integer('P', 1, last);
    if (!p) return std::nullopt;
    return OffsetMemory::extended + *p;
  }
  return (rule.code - 530) / 10;
}

void reload(BlockRun& run) {
  load_work_system(run, run.state.system);
  run.emit_work_offset();
}

// G10 L2 P0-P6 and L20 P1-…: with G90 the words are the offsets, with G91 they are added to them.
void set_work_offsets(const CodeRule& rule, BlockRun& run, bool extended) {
  if (!run.has('P'))
    return run.error("g10_error", rule,
                     extended ? "G10 L20 needs P: the number of the G54.1 P system"
                              : "G10 L2 needs P: 0 for the common offset, 1-6 for G54-G59");
  const auto p = run.integer('P', extended ? 1 : 0,
                             !extended      ? 6
                             : is_haas(run) ? 99
                                            : OffsetMemory::max_extended,
                             "g10_error");
  if (!p) return;
  if (run.has('R')) return run.error("g10_error", 'R', "G10 L2 and L20 take axis words, no R");
  if (!run.has_axis_words())
    return run.error("g10_error", rule, "G10 for a work system needs at least one axis word");
  const int system = extended ? OffsetMemory::extended + *p : *p;
  const bool acts = system == run.state.system || system == OffsetMemory::common;
  if (acts && (!comp_is_off(run, rule) || !no_frame(run, rule))) return;
  // P0 of a Haas is G52.
  if (is_haas(run) && system == OffsetMemory::common) return local_shift(rule, run);
  AxisValues& offset = run.change_offsets().system(system);
  for (const Axis axis : all_axes)
    if (const auto value = run.axis(axis))
      offset[axis] = *value + (run.state.incremental ? offset[axis] : 0);
  if (acts) reload(run);
}

// The row of the tool offsets that P names, for changing it.
ToolOffset* offset_row(const CodeRule& rule, BlockRun& run) {
  if (!run.has('P')) {
    run.error("g10_error", rule, "G10 for a tool needs P: the number of the offset");
    return nullptr;
  }
  const auto p = run.integer('P', 1, OffsetMemory::max_tool, "g10_error");
  return p ? &run.change_offsets().tool_to_set(*p) : nullptr;
}

// G10 L10 to L13 of a mill: length, its wear, radius (or diameter), its wear.
void set_tool_offset(const CodeRule& rule, BlockRun& run, int kind) {
  if (!run.has('R'))
    return run.error("g10_error", rule, "G10 for a tool offset needs R: its value");
  if (run.has_axis_words())
    return run.error("g10_error", rule, "G10 for a tool offset takes R, no axis words");
  ToolOffset* row = offset_row(rule, run);
  if (!row) return;
  double value = run.length('R');
  if (kind >= 12 && is_haas(run)) value /= 2;  // a Haas table holds diameters
  double& target = kind == 10   ? row->geometry[Axis::z]
                   : kind == 11 ? row->wear[Axis::z]
                   : kind == 12 ? row->radius
                                : row->radius_wear;
  target = value + (run.state.incremental ? target : 0);
}

}  // namespace

void fanuc_work_system(const CodeRule& rule, BlockRun& run) {
  const auto system = system_of(rule, run);
  if (!system || *system == run.state.system) return;
  if (!comp_is_off(run, rule) || !no_frame(run, rule)) return;
  run.state.system = *system;
  reload(run);
}

// G52: words with 0 take the shift of their axes away.
void local_shift(const CodeRule& rule, BlockRun& run) {
  if (!comp_is_off(run, rule) || !no_frame(run, rule)) return;
  if (!run.has_axis_words())
    return run.error("axis_word_missing", rule, "G52 needs at least one axis word");
  ModalState& state = run.state;
  for (const Axis axis : all_axes) {
    const auto value = run.axis(axis);
    if (!value) continue;
    state.g92[axis] += *value - state.local_shift[axis];
    state.local_shift[axis] = *value;
  }
  run.emit_g92();
}

// G92: the point where the tool stands gets the coordinates of the words, in all work systems; the
// local shift of these axes ends. U V W of lathes (G50) add to the coordinates.
void coordinate_shift(const CodeRule& rule, BlockRun& run) {
  if (!comp_is_off(run, rule) || !no_frame(run, rule)) return;
  if (!run.has_axis_words())
    return run.error("axis_word_missing", rule, name_of(rule) + " needs at least one axis word");
  ModalState& state = run.state;
  const AxisValues program = to_program(state, state.tip);
  for (const Axis axis : all_axes) {
    if (const auto by = run.increment(axis)) state.g92[axis] -= *by;
    const auto value = run.axis(axis);
    if (!value) continue;
    state.g92[axis] += program[axis] - *value;
    state.local_shift[axis] = 0;
  }
  run.emit_g92();
}

// G92.1 X0 Y0 Z0: takes shift and local shift of the named axes away.
void preset_work_system(const CodeRule& rule, BlockRun& run) {
  if (!comp_is_off(run, rule) || !no_frame(run, rule)) return;
  if (!run.has_axis_words())
    return run.error("axis_word_missing", rule, name_of(rule) + " needs at least one axis word");
  for (const Axis axis : all_axes) {
    const auto value = run.axis(axis);
    if (!value) continue;
    if (*value != 0)
      return run.error("word_value", letter(axis),
                       name_of(rule) + " takes axis words with the value 0 only");
    run.state.g92[axis] = 0;
    run.state.local_shift[axis] = 0;
  }
  run.emit_g92();
}

void fanuc_data(const CodeRule& rule, BlockRun& run) {
  const bool lathe = run.session.table.lathe();
  if (!run.has('L')) {
    if (lathe) return set_lathe_offset(rule, run);
    return run.error("g10_error", rule, "G10 needs L: 2, 10, 11, 12, 13 or 20");
  }
  const auto l = run.integer('L', 0, 99, "g10_error");
  if (!l) return;
  switch (*l) {
    case 2:
    case 20:
      return set_work_offsets(rule, run, *l == 20);
    case 1:
      if (lathe) break;
      return set_tool_offset(rule, run, 11);
    case 10:
    case 11:
    case 12:
    case 13:
      if (lathe && is_haas(run)) return set_lathe_offset(rule, run);
      if (lathe) break;
      return set_tool_offset(rule, run, *l);
    case 50:
    case 52: {  // until G11 the lines are parameters of the control, not moves
      canon::UserCode code;
      code.letter = 'G';
      code.code = 10;
      run.emit(code);
      run.state.data_setting = true;
      return;
    }
    default:
      break;
  }
  run.error("g10_error", 'L',
            "G10 L" + std::to_string(*l) +
                " is not known here; L2 and L20 set work systems, L10 to L13 tool offsets");
}

void data_end(const CodeRule&, BlockRun& run) { run.state.data_setting = false; }

// Offsets of lathes: P is the number of the row of wear, 10000 + n the row of geometry; X (a
// diameter) Z Y and U W V, which add; R the radius of the nose, Q its orientation. Haas: L10
// geometry, L11 wear.
void set_lathe_offset(const CodeRule& rule, BlockRun& run) {
  if (!run.has('P'))
    return run.error("g10_error", rule,
                     "G10 needs P: the number of the offset (10000 + number for its geometry)");
  const auto p = run.integer('P', 1, 10000 + OffsetMemory::max_tool, "g10_error");
  if (!p) return;
  const double l = run.number_or('L', 0);
  const bool geometry = *p > 10000 || l == 10 || l == 12;
  const int number = *p > 10000 ? *p - 10000 : *p;
  if (number < 1 || number > OffsetMemory::max_tool)
    return run.error("g10_error", 'P', "offsets of tools go from 1 to 999");
  ToolOffset& row = run.change_offsets().tool_to_set(number);
  AxisValues& target = geometry ? row.geometry : row.wear;
  const char adding[] = {'U', 'V', 'W'};
  for (const Axis axis : {Axis::x, Axis::y, Axis::z}) {
    if (const auto value = run.axis(axis)) target[axis] = *value;
    const char word = adding[index(axis)];
    if (run.has(word))
      target[axis] += run.length(word) / (axis == Axis::x && run.state.lathe_diameter ? 2 : 1);
  }
  if (run.has('R')) (geometry ? row.radius : row.radius_wear) = run.length('R');
  if (run.has('Q')) {
    const auto q = run.integer('Q', 0, 9, "g10_error");
    if (q) row.orientation = *q;
  }
}

}  // namespace aircut::interp
