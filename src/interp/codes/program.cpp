// Stops, the end of the program, Fanuc-style subs, and the stack of modal settings (M70-M73).
#include "interp/codes/codes.h"

namespace aircut::interp {

void program_stop(const CodeRule& rule, BlockRun& run) {
  run.session.compensator.finish(run);  // the machine stands still: no corner is open
  if (!run.ok()) return;
  if (rule.code == 60) run.emit(canon::PalletChange{});
  run.emit(canon::ProgramStop{rule.code == 1});
}

// A speed override that the program has switched off stays off on LinuxCNC: its M2 and M30 switch
// the feed override on and forget this one, which its manual names as well.
void reset_speed_override(const CodeRule& rule, BlockRun& run, int number) {
  SpindleState& spindle = run.state.spindles[static_cast<std::size_t>(number)];
  if (spindle.override_on) return;
  if (run.session.options.dialect == Dialect::linuxcnc) {
    run.warning("control_fault", run.place(rule),
                "the speed override is off and stays off behind the program: the control switches "
                "only the feed override on again; give M51 (or M48) before");
    return;
  }
  spindle.override_on = true;
  run.emit(canon::Override{canon::Override::Kind::speed, true, number});
}

// What is reset, and that units, G92, length offset, G98/99, path and lathe modes are not, follows
// interp.md 7.
void program_end(const CodeRule& rule, BlockRun& run) {
  ModalState& state = run.state;
  run.session.compensator.finish(run);
  if (!run.ok()) return;
  state.comp = CompState{};
  if (run.session.options.g54_at_end) {
    run.set_parameter(number::active_system, 1);
    load_work_system(run, 1);
  }
  run.emit_work_offset();
  run.emit_rotation();
  const bool lathe = run.session.table.lathe();
  const canon::Plane plane = lathe ? canon::Plane::zx : canon::Plane::xy;
  if (state.plane != plane) {
    state.plane = plane;
    run.emit(canon::SelectPlane{state.plane});
  }
  state.incremental = false;
  state.feed_mode = lathe ? canon::FeedMode::per_revolution : canon::FeedMode::per_minute;
  run.emit(canon::SetFeedMode{state.feed_mode});
  state.feed = 0;
  run.emit(canon::SetFeedRate{});
  if (!state.feed_override) {
    state.feed_override = true;
    run.emit(canon::Override{canon::Override::Kind::feed, true, 0});
  }
  for (int i = 0; i < run.session.options.spindles; ++i) {
    SpindleState& spindle = state.spindles[static_cast<std::size_t>(i)];
    reset_speed_override(rule, run, i);
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
  if (!run.session.options.fanuc_subs)
    return run.error("fanuc_subs_off", rule,
                     "M98 is switched off on this machine (DISABLE_FANUC_STYLE_SUB); use o… call");
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

namespace {

// A feed mode forgets the feed; F is told again only when its number had changed before.
void restore_feed(BlockRun& run, const ModalState& saved) {
  ModalState& state = run.state;
  const bool feed_differs = state.feed != saved.feed;
  if (state.feed_mode != saved.feed_mode) {
    state.feed_mode = saved.feed_mode;
    run.emit(canon::SetFeedMode{state.feed_mode});
    if (state.feed_mode != canon::FeedMode::inverse_time) {
      state.feed = 0;
      run.emit(canon::SetFeedRate{});
    }
  }
  // In inverse time an F is of its own line only.
  if (!feed_differs || state.feed_mode == canon::FeedMode::inverse_time) return;
  state.feed = saved.feed;
  emit_feed(run);
}

// G96 comes back without its D.
bool restore_spindle_mode(BlockRun& run, const ModalState& saved) {
  for (int i = 0; i < run.session.options.spindles; ++i) {
    SpindleState& now = run.state.spindles[static_cast<std::size_t>(i)];
    const SpindleState& then = saved.spindles[static_cast<std::size_t>(i)];
    if (now.css == then.css) continue;
    if (then.css && now.speed == then.speed) {
      run.error("modal_stack", run.whole(),
                "the control can't go back to G96 here: it needs an S word for that and takes one "
                "only when S has changed; give G97 with another S after saving");
      return false;
    }
    now.css = then.css;
    now.css_limit = then.css ? no_css_limit : 0;
    run.emit(canon::SetSpindleMode{i, now.css_limit});
  }
  return true;
}

void restore_speed(BlockRun& run, const ModalState& saved) {
  for (int i = 0; i < run.session.options.spindles; ++i) {
    SpindleState& now = run.state.spindles[static_cast<std::size_t>(i)];
    const SpindleState& then = saved.spindles[static_cast<std::size_t>(i)];
    if (now.speed == then.speed) continue;
    now.speed = then.speed;
    const bool feet = now.css && run.state.unit == canon::Unit::inch;
    run.emit(canon::SetSpindleSpeed{i, feet ? then.speed * 0.3048 : then.speed});
  }
}

void restore_offsets(BlockRun& run, const ModalState& saved) {
  ModalState& state = run.state;
  const bool had_offset = !(saved.length_offset == AxisValues{});
  const bool has_offset = !(state.length_offset == AxisValues{});
  if (had_offset != has_offset) {  // G43 without H, or G49
    const tool::Tool* tool = had_offset ? run.session.tools.find(state.tool) : nullptr;
    use_length_offset(run, tool ? tool->offset : AxisValues{}, tool ? state.tool : 0);
    state.length_offset_on = had_offset;
  }
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
    const bool continuous = saved.path_mode == canon::PathMode::continuous;
    state.path_tolerance = continuous ? saved.path_tolerance : 0;
    if (continuous) state.naive_tolerance = saved.naive_tolerance;
    emit_path_mode(run);
    if (continuous) emit_naive_tolerance(run);
  }
}

// The M codes that lead back. Each tells whether it was needed.

bool restore_turn(BlockRun& run, const ModalState& saved) {
  bool needed = false;
  for (int i = 0; i < run.session.options.spindles; ++i) {
    SpindleState& now = run.state.spindles[static_cast<std::size_t>(i)];
    const canon::SpindleTurn then = saved.spindles[static_cast<std::size_t>(i)].turn;
    if (now.turn == then) continue;
    now.turn = then;
    canon::TurnSpindle command;
    command.spindle = i;
    command.turn = then;
    run.emit(command);
    needed = true;
  }
  return needed;
}

// M7 when it was on, M9 only when neither was: what came on beside the other stays on.
bool restore_mist(BlockRun& run, const ModalState& saved) {
  ModalState& state = run.state;
  if (saved.mist && !state.mist) {
    state.mist = true;
    run.emit(canon::Coolant{canon::Coolant::Kind::mist, true});
    return true;
  }
  if (saved.mist || saved.flood || (!state.mist && !state.flood)) return false;
  state.mist = state.flood = false;
  run.emit(canon::Coolant{canon::Coolant::Kind::mist, false});
  run.emit(canon::Coolant{canon::Coolant::Kind::flood, false});
  return true;
}

bool restore_flood(BlockRun& run, const ModalState& saved) {
  if (!saved.flood || run.state.flood) return false;
  run.state.flood = true;
  run.emit(canon::Coolant{canon::Coolant::Kind::flood, true});
  return true;
}

// M48 when the feed override was on, M51 when not.
bool restore_override(BlockRun& run, const ModalState& saved) {
  ModalState& state = run.state;
  if (state.feed_override == saved.feed_override) return false;
  if (saved.feed_override) {
    state.feed_override = true;
    run.emit(canon::Override{canon::Override::Kind::feed, true, 0});
  }
  for (int i = 0; i < run.session.options.spindles; ++i) {
    state.spindles[static_cast<std::size_t>(i)].override_on = true;
    run.emit(canon::Override{canon::Override::Kind::speed, true, i});
  }
  return true;
}

// M52 and M53 only when they were on.
bool restore_adaptive_feed(BlockRun& run, const ModalState& saved) {
  if (!saved.adaptive_feed || run.state.adaptive_feed) return false;
  run.state.adaptive_feed = true;
  run.emit(canon::Override{canon::Override::Kind::adaptive_feed, true, 0});
  return true;
}

bool restore_feed_hold(BlockRun& run, const ModalState& saved) {
  if (!saved.feed_hold || run.state.feed_hold) return false;
  run.state.feed_hold = true;
  run.emit(canon::Override{canon::Override::Kind::feed_hold, true, 0});
  return true;
}

}  // namespace

// The control writes lines of codes that lead back to the saved state and executes them: the unit;
// F, S, all G codes and the first M code that is needed; every other M code. Not restored:
// position, motion mode, tool, G92, the numbers of the work systems.
void restore_state(BlockRun& run, const ModalState& saved) {
  constexpr bool (*m_codes[])(BlockRun&, const ModalState&) = {
      restore_turn,     restore_mist,          restore_flood,
      restore_override, restore_adaptive_feed, restore_feed_hold};
  ModalState& state = run.state;
  if (state.unit != saved.unit) {
    state.unit = saved.unit;
    run.emit(canon::UseUnit{state.unit});
  }
  if (!restore_spindle_mode(run, saved)) return;
  restore_feed(run, saved);
  restore_speed(run, saved);
  std::size_t m = 0;
  while (m < std::size(m_codes) && !m_codes[m++](run, saved)) {
  }
  if (state.plane != saved.plane) {
    state.plane = saved.plane;
    run.emit(canon::SelectPlane{state.plane});
  }
  state.lathe_diameter = saved.lathe_diameter;
  restore_radius_comp(run, saved.comp.side);
  if (!run.ok()) return;
  restore_offsets(run, saved);
  state.incremental = saved.incremental;
  state.absolute_centres = saved.absolute_centres;
  state.retract_to_r = saved.retract_to_r;
  while (m < std::size(m_codes)) m_codes[m++](run, saved);
}

}  // namespace aircut::interp
