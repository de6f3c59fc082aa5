// Stops, the end of the program, Fanuc-style subs, and the stack of modal settings (M70-M73).
#include <limits>

#include "interp/codes/codes.h"

namespace aircut::interp {

void program_stop(const CodeRule& rule, BlockRun& run) {
  if (rule.code == 60) run.emit(canon::PalletChange{});
  run.emit(canon::ProgramStop{rule.code == 1});
}

// What is reset, and that units, G92, length offset, G98/99, path and lathe modes are not, follows
// interp.md 7.
void program_end(const CodeRule& rule, BlockRun& run) {
  ModalState& state = run.state;
  run.session.compensator.flush(run);
  state.comp = CompState{};
  run.set_parameter(number::active_system, 1);
  load_work_system(run, 1);
  run.emit_work_offset();
  run.emit_rotation();
  if (state.plane != canon::Plane::xy) {
    state.plane = canon::Plane::xy;
    run.emit(canon::SelectPlane{state.plane});
  }
  state.incremental = false;
  state.feed_mode = canon::FeedMode::per_minute;
  run.emit(canon::SetFeedMode{state.feed_mode});
  state.feed = 0;
  run.emit(canon::SetFeedRate{});
  if (!state.feed_override) {
    state.feed_override = true;
    run.emit(canon::Override{canon::Override::Kind::feed, true, 0});
  }
  for (int i = 0; i < run.session.options.spindles; ++i) {
    SpindleState& spindle = state.spindles[static_cast<std::size_t>(i)];
    if (!spindle.override_on) {
      spindle.override_on = true;
      run.emit(canon::Override{canon::Override::Kind::speed, true, i});
    }
    spindle.turn = canon::SpindleTurn::stop;
    spindle.css = false;
    canon::TurnSpindle stop;
    stop.spindle = i;
    run.emit(stop);
    run.emit(canon::SetSpindleMode{i, 0});
  }
  if (state.mist) run.emit(canon::Coolant{canon::Coolant::Kind::mist, false});
  if (state.flood) run.emit(canon::Coolant{canon::Coolant::Kind::flood, false});
  state.mist = state.flood = false;
  state.motion = 10;
  state.cycle = CycleState{};
  if (rule.code == 30) run.emit(canon::PalletChange{});
  run.emit(canon::ProgramEnd{rule.code == 30});
  run.flow.kind = FlowRequest::Kind::end;
}

void call_fanuc(const CodeRule& rule, BlockRun& run) {
  if (!run.has('P')) return run.error("word_missing", rule, "M98 needs P: the number of the sub");
  const auto label = run.integer('P', 0, 999'999'999);
  if (!label) return;
  run.flow.kind = FlowRequest::Kind::call;
  run.flow.label = *label;
  if (run.has('L')) {
    const auto l = run.integer('L', 0, 999'999'999);
    if (!l) return;
    run.flow.repeats = static_cast<std::uint64_t>(*l);
  }
}

// In the main program M99 would start over; without an operator that is the end.
void return_fanuc(const CodeRule& rule, BlockRun& run) {
  switch (run.level) {
    case Level::main:
      return program_end(rule, run);
    case Level::fanuc_sub:
      run.flow.kind = FlowRequest::Kind::return_;
      return;
    case Level::sub:
      return run.error("flow_syntax", rule,
                       "M99 can't end a sub that was called with o… call; use endsub");
  }
}

void modal_stack(const CodeRule& rule, BlockRun& run) {
  switch (rule.code) {
    case 71:
      run.stack.drop = true;
      return;
    case 72:
      if (!run.saved)
        return run.error("modal_stack", rule,
                         "M72 restores what M70 has saved on this level; give M70 before");
      return restore_state(run, *run.saved);
    default:
      run.stack.save = run.state;
      run.stack.restore_at_return = rule.code == 73;
  }
}

// Not restored: position, motion mode, tool, G92, the numbers of the work systems.
void restore_state(BlockRun& run, const ModalState& saved) {
  ModalState& state = run.state;
  if (state.unit != saved.unit) {
    state.unit = saved.unit;
    run.emit(canon::UseUnit{state.unit});
  }
  if (state.feed_mode != saved.feed_mode) {
    state.feed_mode = saved.feed_mode;
    run.emit(canon::SetFeedMode{state.feed_mode});
    state.feed = std::numeric_limits<double>::quiet_NaN();  // to be said again
  }
  if (state.feed != saved.feed) {
    state.feed = saved.feed;
    canon::SetFeedRate rate;
    switch (state.feed_mode) {
      case canon::FeedMode::per_minute:
        rate.value = state.feed * state.unit_mm() / 60;
        rate.rotary = state.feed * radian_per_degree / 60;
        break;
      case canon::FeedMode::inverse_time:
        rate.value = state.feed / 60;
        break;
      case canon::FeedMode::per_revolution:
        rate.value = state.feed * state.unit_mm();
        break;
    }
    run.emit(rate);
  }
  for (int i = 0; i < run.session.options.spindles; ++i) {
    SpindleState& now = state.spindles[static_cast<std::size_t>(i)];
    const SpindleState& then = saved.spindles[static_cast<std::size_t>(i)];
    if (now.css != then.css) run.emit(canon::SetSpindleMode{i, then.css ? then.css_limit : 0});
    if (now.speed != then.speed || now.css != then.css) {
      const bool feet = then.css && state.unit == canon::Unit::inch;
      run.emit(canon::SetSpindleSpeed{i, feet ? then.speed * 0.3048 : then.speed});
    }
    if (now.turn != then.turn) {
      canon::TurnSpindle command;
      command.spindle = i;
      command.turn = then.turn;
      run.emit(command);
    }
    if (now.override_on != then.override_on)
      run.emit(canon::Override{canon::Override::Kind::speed, then.override_on, i});
    now = then;
  }
  if (state.plane != saved.plane) {
    state.plane = saved.plane;
    run.emit(canon::SelectPlane{state.plane});
  }
  state.lathe_diameter = saved.lathe_diameter;
  if (saved.comp.side == CompSide::off && state.comp.side != CompSide::off) {
    run.session.compensator.flush(run);
    state.comp.leaving = state.comp.entered;
    state.comp.side = CompSide::off;
  }
  if (saved.length_offset == AxisValues{} && !(state.length_offset == AxisValues{}))
    use_length_offset(run, {});
  if (state.system != saved.system) {
    run.set_parameter(number::active_system, saved.system);
    load_work_system(run, saved.system);
    run.emit_work_offset();
    run.emit_g92();
    run.emit_rotation();
  }
  if (state.path_mode != saved.path_mode || state.path_tolerance != saved.path_tolerance ||
      state.naive_tolerance != saved.naive_tolerance) {
    state.path_mode = saved.path_mode;
    state.path_tolerance = saved.path_tolerance;
    state.naive_tolerance = saved.naive_tolerance;
    run.emit(canon::SetPathMode{state.path_mode, state.path_tolerance});
    if (state.path_mode == canon::PathMode::continuous)
      run.emit(canon::SetNaiveCam{state.naive_tolerance});
  }
  state.incremental = saved.incremental;
  state.absolute_centres = saved.absolute_centres;
  state.retract_to_r = saved.retract_to_r;
  if (state.mist != saved.mist) run.emit(canon::Coolant{canon::Coolant::Kind::mist, saved.mist});
  if (state.flood != saved.flood)
    run.emit(canon::Coolant{canon::Coolant::Kind::flood, saved.flood});
  state.mist = saved.mist;
  state.flood = saved.flood;
  using Kind = canon::Override::Kind;
  if (state.feed_override != saved.feed_override)
    run.emit(canon::Override{Kind::feed, saved.feed_override, 0});
  if (state.adaptive_feed != saved.adaptive_feed)
    run.emit(canon::Override{Kind::adaptive_feed, saved.adaptive_feed, 0});
  if (state.feed_hold != saved.feed_hold)
    run.emit(canon::Override{Kind::feed_hold, saved.feed_hold, 0});
  state.feed_override = saved.feed_override;
  state.adaptive_feed = saved.adaptive_feed;
  state.feed_hold = saved.feed_hold;
}

}  // namespace aircut::interp
