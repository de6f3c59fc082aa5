// Number → what it shows. Each range is a row: its first number, how many, and what stands there.
//
//   positions     #5001 + axis, #5021 machine, #5041 with the tool offset, #5061 skip, #5081 offset
//   work systems  #5201 common, #5221 G54 … #5321 G59, #7001 and #14001 G54.1 P1 …, 20 apart
//   tool offsets  one number per row of the table; the ranges differ between mills, lathes and Haas
//
// Axes count in the order of the machine's axes: #5002 is Y on a mill and Z on a lathe of X and Z.
#include "interp/system_variables.h"

#include <span>

#include "interp/codes/codes.h"

namespace aircut::interp {
namespace {

enum class What : unsigned char {
  end_of_block,
  machine,
  with_offset,
  skip,
  length_offset,
  system,
  geometry,
  wear,
  radius,
  radius_wear,
  orientation
};

struct Range {
  int first, count;
  What what;
  Axis axis = Axis::z;  ///< of tool offsets
};

constexpr Range positions[] = {{5001, 20, What::end_of_block},
                               {5021, 20, What::machine},
                               {5041, 20, What::with_offset},
                               {5061, 20, What::skip},
                               {5081, 20, What::length_offset}};

constexpr Range fanuc_mill[] = {{2001, 200, What::wear},         {2201, 200, What::geometry},
                                {10001, 999, What::wear},        {11001, 999, What::geometry},
                                {12001, 999, What::radius_wear}, {13001, 999, What::radius}};
constexpr Range haas_mill[] = {{2001, 200, What::geometry},
                               {2201, 200, What::wear},
                               {2401, 200, What::radius},
                               {2601, 200, What::radius_wear}};
constexpr Range fanuc_lathe[] = {{2001, 64, What::wear, Axis::x},
                                 {2101, 64, What::wear, Axis::z},
                                 {2201, 64, What::radius_wear},
                                 {2301, 64, What::orientation},
                                 {2401, 49, What::wear, Axis::y},
                                 {2451, 49, What::geometry, Axis::y},
                                 {2701, 49, What::geometry, Axis::x},
                                 {2801, 49, What::geometry, Axis::z},
                                 {2901, 64, What::radius},
                                 {10001, 999, What::wear, Axis::x},
                                 {11001, 999, What::wear, Axis::z},
                                 {12001, 999, What::radius_wear},
                                 {13001, 999, What::orientation},
                                 {14001, 999, What::wear, Axis::y},
                                 {15001, 999, What::geometry, Axis::x},
                                 {16001, 999, What::geometry, Axis::z},
                                 {17001, 999, What::radius},
                                 {19001, 999, What::geometry, Axis::y}};

std::span<const Range> tool_ranges(Dialect dialect, bool lathe) {
  if (dialect == Dialect::haas) return lathe ? std::span<const Range>() : haas_mill;
  return lathe ? std::span<const Range>(fanuc_lathe) : fanuc_mill;
}

struct Slot {
  What what;
  int number = 0;  ///< of the work system or the tool offset
  Axis axis = Axis::x;
};

/// The k-th axis of the machine, from 1.
std::optional<Axis> axis_number(int k, const Session& session) {
  AxisSet axes = session.options.axes;
  if (axes.empty())
    for (const Axis axis : all_axes)
      if (axis <= Axis::z && !(axis == Axis::y && session.table.lathe())) axes.add(axis);
  for (const Axis axis : all_axes)
    if (axes.has(axis) && --k == 0) return axis;
  return std::nullopt;
}

std::optional<Slot> axis_slot(What what, int number, int k, const Session& session) {
  const auto axis = axis_number(k, session);
  if (!axis) return std::nullopt;
  return Slot{what, number, *axis};
}

std::optional<Slot> slot_of(int n, const Session& session) {
  const bool lathe = session.table.lathe();
  for (const Range& range : positions)
    if (n >= range.first && n < range.first + range.count)
      return axis_slot(range.what, 0, n - range.first + 1, session);
  for (const Range& range : tool_ranges(session.options.dialect, lathe))
    if (n >= range.first && n < range.first + range.count)
      return Slot{range.what, n - range.first + 1, range.axis};
  const auto in_systems = [&](int first, int count, int system) -> std::optional<Slot> {
    if (n < first || n >= first + 20 * count) return std::nullopt;
    return axis_slot(What::system, system + (n - first) / 20, (n - first) % 20 + 1, session);
  };
  if (n >= 5201 && n < 5341) return in_systems(5201, 7, OffsetMemory::common);
  if (n >= 7001 && n < 7961) return in_systems(7001, 48, OffsetMemory::extended + 1);
  if (!lathe) return in_systems(14001, OffsetMemory::max_extended, OffsetMemory::extended + 1);
  return std::nullopt;
}

/// What one unit of the variable is, in mm, rad or pieces.
double unit_of(const Slot& slot, const Session& session, const ModalState& state) {
  if (slot.what == What::orientation) return 1;
  if (slot.what == What::radius || slot.what == What::radius_wear)
    return state.unit_mm() /
           (session.options.dialect == Dialect::haas ? 2 : 1);  // a Haas table holds diameters
  if (is_rotary(slot.axis)) return radian_per_degree;
  return slot.axis == Axis::x && state.lathe_diameter ? state.unit_mm() / 2 : state.unit_mm();
}

double value_of(const Slot& slot, const Session& session, const ModalState& state) {
  const ToolOffset* row = session.offsets.tool(slot.number);
  switch (slot.what) {
    case What::end_of_block:
      return to_program(state, state.programmed_tip())[slot.axis];
    case What::machine:
      return state.tip[slot.axis] + state.length_offset[slot.axis];
    case What::with_offset:
      return to_work(state, state.tip)[slot.axis] + state.length_offset[slot.axis];
    case What::skip:
      return session.skip_position[slot.axis];
    case What::length_offset:
      return state.length_offset[slot.axis];
    case What::system:
      return session.offsets.system(slot.number)[slot.axis];
    case What::geometry:
      return row ? row->geometry[slot.axis] : 0;
    case What::wear:
      return row ? row->wear[slot.axis] : 0;
    case What::radius:
      return row ? row->radius : 0;
    case What::radius_wear:
      return row ? row->radius_wear : 0;
    case What::orientation:
      break;
  }
  return row ? row->orientation : 0;
}

}  // namespace

int system_variable_of(int system) {
  if (system == OffsetMemory::common) return 5201;
  return system <= 6 ? 5201 + 20 * system : 14001 + 20 * (system - OffsetMemory::extended - 1);
}

std::optional<double> offset_variable(int n, const Session& session, const ModalState& state) {
  const auto slot = slot_of(n, session);
  if (!slot) return std::nullopt;
  return value_of(*slot, session, state) / unit_of(*slot, session, state);
}

VariableWrite set_offset_variable(int n, double value, BlockRun& run) {
  const auto slot = slot_of(n, run.session);
  if (!slot) return VariableWrite::not_an_offset;
  if (slot->what < What::system) return VariableWrite::read_only;
  const double mm = value * unit_of(*slot, run.session, run.state);
  OffsetMemory& offsets = run.change_offsets();
  if (slot->what == What::system) {
    offsets.system(slot->number)[slot->axis] = mm;
    if (slot->number == run.state.system || slot->number == OffsetMemory::common) {
      load_work_system(run, run.state.system);
      run.emit_work_offset();
    }
    return VariableWrite::done;
  }
  ToolOffset& row = offsets.tool_to_set(slot->number);
  switch (slot->what) {
    case What::geometry:
      row.geometry[slot->axis] = mm;
      break;
    case What::wear:
      row.wear[slot->axis] = mm;
      break;
    case What::radius:
      row.radius = mm;
      break;
    case What::radius_wear:
      row.radius_wear = mm;
      break;
    default:
      row.orientation = as_integer(value).value_or(0);
      break;
  }
  return VariableWrite::done;
}

}  // namespace aircut::interp
