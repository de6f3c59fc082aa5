// Parameters that follow from the state: positions, the loaded tool, modal settings.
#include <algorithm>
#include <array>

#include "base/text.h"
#include "interp/impl.h"

namespace aircut::interp {
namespace {

double unit_of(Axis axis, double length_unit) {
  return is_rotary(axis) ? radian_per_degree : length_unit;
}

}  // namespace

std::optional<double> Interpreter::Impl::numbered(int n, Place place,
                                                  std::optional<Fault>& fault) const {
  const double program_unit = state_.unit_mm();
  const double machine_unit = session_.machine_unit_mm;
  if (n >= number::current_position) {
    if (state_.comp.side != CompSide::off) {
      fault = Fault{"comp_illegal", place,
                    "the current position can't be read while radius compensation is on; give G40 "
                    "before"};
      return std::nullopt;
    }
    const Axis axis = all_axes[static_cast<std::size_t>(n - number::current_position)];
    return to_program(state_, state_.tip)[axis] / unit_of(axis, program_unit);
  }
  if (n >= number::loaded_tool) {
    const tool::Tool* tool = tools_.find(state_.tool);
    if (n == number::loaded_tool) return state_.tool;
    if (!tool) return 0;
    if (n < number::tool_diameter) {
      const Axis axis = all_axes[static_cast<std::size_t>(n - number::tool_offset)];
      return tool->offset[axis] / unit_of(axis, machine_unit);
    }
    switch (n - number::tool_diameter) {
      case 0:
        return tool->diameter / machine_unit;
      case 1:
        return tool->front_angle / radian_per_degree;
      case 2:
        return tool->back_angle / radian_per_degree;
      default:
        return tool->orientation;
    }
  }
  if (n >= number::length_offset) {
    const Axis axis = all_axes[static_cast<std::size_t>(n - number::length_offset)];
    return state_.length_offset[axis] / unit_of(axis, program_unit);
  }
  const Axis axis = all_axes[static_cast<std::size_t>(n - number::absolute_position)];
  return (state_.tip[axis] + state_.length_offset[axis]) / unit_of(axis, program_unit);
}

// In the order of predefined_names().
double Interpreter::Impl::predefined(int which) const {
  const ModalState& s = state_;
  const SpindleState& spindle = s.spindles[0];
  const auto yes = [](bool value) { return value ? 1.0 : 0.0; };
  constexpr std::array<double, 6> planes = {170, 180, 190, 171, 181, 191};
  if (which >= 30 && which < 39) {
    const Axis axis = all_axes[static_cast<std::size_t>(which - 30)];
    return to_program(s, session_.compensator.told_position(s))[axis] / unit_of(axis, s.unit_mm());
  }
  if (which >= 39 && which < 48) {
    const Axis axis = all_axes[static_cast<std::size_t>(which - 39)];
    return (session_.compensator.told_position(s)[axis] + s.length_offset[axis]) /
           unit_of(axis, s.unit_mm());
  }
  const tool::Tool* loaded = tools_.find(s.tool);
  const tool::Tool* selected = tools_.find(s.selected_tool);
  switch (which) {
    case 0:
      return static_cast<double>(frames_.back().line);
    case 1:
      return s.motion;
    case 2:
      return planes[static_cast<std::size_t>(s.plane)];
    case 3:
      return s.comp.side == CompSide::off ? 400 : s.comp.side == CompSide::left ? 410 : 420;
    case 4:
      return yes(s.unit == canon::Unit::millimetre);
    case 5:
      return yes(s.unit == canon::Unit::inch);
    case 6:
      return yes(!s.incremental);
    case 7:
      return yes(s.incremental);
    case 8:
      return yes(s.feed_mode == canon::FeedMode::inverse_time);
    case 9:
      return yes(s.feed_mode == canon::FeedMode::per_minute);
    case 10:
      return yes(s.feed_mode == canon::FeedMode::per_revolution);
    case 11:
      return s.system <= 6 ? 530 + 10 * s.system : 590 + s.system - 6;
    case 12:
      return yes(!(s.length_offset == AxisValues{}));
    case 13:
      return yes(s.retract_to_r);
    case 14:
      return yes(!s.retract_to_r);
    case 15:
      return yes(!spindle.css);
    case 16:
      return yes(spindle.css);
    case 17:
      return yes(s.absolute_centres);
    case 18:
      return yes(s.lathe_diameter);
    case 19:
      return yes(!s.lathe_diameter);
    case 20:
      return yes(spindle.turn != canon::SpindleTurn::stop);
    case 21:
      return yes(spindle.turn == canon::SpindleTurn::clockwise);
    case 22:
      return yes(s.mist);
    case 23:
      return yes(s.flood);
    case 24:
      return yes(spindle.override_on);
    case 25:
      return yes(s.feed_override);
    case 26:
      return yes(s.adaptive_feed);
    case 27:
      return yes(s.feed_hold);
    case 28:
      return s.feed;
    case 29:
      return spindle.speed;
    case 48:
      return s.tool;
    case 49:
      return loaded ? loaded->pocket : 0;
    case 50:
      return std::max(0, s.selected_tool);
    case 51:
      return selected ? selected->pocket : s.selected_tool;
    case 52:
      return value_;
    case 53:
      return yes(value_returned_);
    case 54:
      return 0;  // _task: this is not a machine's task
    case 55:
      return static_cast<double>(frames_.size() - 1);
    case 56:
      return session_.remaps.level();
    case 57:
      return 2.9;
    default:
      return 0;  // _vminor
  }
}

}  // namespace aircut::interp
