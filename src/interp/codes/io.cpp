// Coolant, overrides, inputs and outputs, user codes.
#include <cmath>

#include "interp/codes/codes.h"

namespace aircut::interp {
namespace {

bool refuse_with_comp(BlockRun& run, const CodeRule& rule) {
  if (run.state.comp.side == CompSide::off) return false;
  run.error("comp_illegal", rule,
            name_of(rule) + " can't be used while radius compensation is on; give G40 before");
  return true;
}

constexpr int last_io = 9999;

void set_override(BlockRun& run, canon::Override::Kind kind, bool on, int spindle = 0) {
  ModalState& state = run.state;
  switch (kind) {
    case canon::Override::Kind::feed:
      state.feed_override = on;
      state.thread_override = false;
      break;
    case canon::Override::Kind::speed:
      state.spindles[static_cast<std::size_t>(spindle)].override_on = on;
      break;
    case canon::Override::Kind::adaptive_feed:
      state.adaptive_feed = on;
      break;
    case canon::Override::Kind::feed_hold:
      state.feed_hold = on;
      break;
  }
  run.emit(canon::Override{kind, on, spindle});
}

}  // namespace

void coolant(const CodeRule& rule, BlockRun& run) {
  ModalState& state = run.state;
  if (rule.code == 7) state.mist = true;
  if (rule.code == 8) state.flood = true;
  if (rule.code == 9) state.mist = state.flood = false;
  if (rule.code != 8) run.emit(canon::Coolant{canon::Coolant::Kind::mist, state.mist});
  if (rule.code != 7) run.emit(canon::Coolant{canon::Coolant::Kind::flood, state.flood});
}

void override_switch(const CodeRule& rule, BlockRun& run) {
  using Kind = canon::Override::Kind;
  if (refuse_with_comp(run, rule)) return;
  const bool on = run.number_or('P', 1) != 0;
  switch (rule.code) {
    case 48:
    case 49:
      set_override(run, Kind::feed, rule.code == 48);
      for (int i = 0; i < run.session.options.spindles; ++i)
        set_override(run, Kind::speed, rule.code == 48, i);
      return;
    case 50:
      return set_override(run, Kind::feed, on);
    case 51: {
      const auto spindle = spindle_of(run, -1);
      if (!spindle) return;
      for (int i = 0; i < run.session.options.spindles; ++i)
        if (*spindle == -1 || *spindle == i) set_override(run, Kind::speed, on, i);
      return;
    }
    case 52:
      return set_override(run, Kind::adaptive_feed, on);
    default:
      return set_override(run, Kind::feed_hold, on);
  }
}

void digital_output(const CodeRule& rule, BlockRun& run) {
  if (refuse_with_comp(run, rule)) return;
  if (!run.has('P'))
    return run.error("word_missing", rule, name_of(rule) + " needs P: the number of the output");
  const auto index = run.integer('P', 0, last_io);
  if (!index) return;
  run.emit(canon::DigitalOutput{*index, rule.code == 62 || rule.code == 64, rule.code <= 63});
}

void analog_output(const CodeRule& rule, BlockRun& run) {
  if (refuse_with_comp(run, rule)) return;
  if (!run.has('E'))
    return run.error("word_missing", rule, name_of(rule) + " needs E: the number of the output");
  const auto index = run.integer('E', 0, last_io);
  if (!index) return;
  // Without Q the control sets -1.
  const double value = run.number_or('Q', -1);
  const bool with_motion = rule.code == 67;
  run.emit(canon::AnalogOutput{*index, value, with_motion});
  if (run.session.options.kinematics.output != *index) return;
  const auto& by_value = run.session.options.kinematics.by_value;
  const bool known = value >= 0 && value < static_cast<double>(by_value.size());
  const int model = known ? by_value[static_cast<std::size_t>(value)] : -1;
  if (with_motion || model != run.state.kinematics)
    run.switch_kinematics({model, with_motion, !with_motion});
}

// A code of the machine's own.
void switch_kinematics(const CodeRule& rule, BlockRun& run, int model) {
  if (refuse_with_comp(run, rule) || model == run.state.kinematics) return;
  run.switch_kinematics({model, false, false});
}

// Without a machine nothing ever changes an input: it reads 0, and waiting for anything but a low
// digital input times out.
void wait_input(const CodeRule& rule, BlockRun& run) {
  if (refuse_with_comp(run, rule)) return;
  if (run.has('P') && run.has('E'))
    return run.error("io_error", 'E', "M66 takes P (digital) or E (analog), not both");
  if (!run.has('P') && !run.has('E'))
    return run.error("io_error", rule,
                     "M66 needs P (digital) or E (analog): the number of the input");
  const char letter = run.has('P') ? 'P' : 'E';
  const auto index = run.integer(letter, 0, last_io);
  if (!index) return;
  int mode = 0;
  if (run.has('L')) {
    const auto l = run.integer('L', 0, 4);
    if (!l) return;
    mode = *l;
  }
  const double timeout = run.number_or('Q', 0);
  if (mode != 0 && letter == 'E')
    return run.error("io_error", 'L', "an analog input can only be read at once; use L0");
  if (mode != 0 && timeout <= 0)
    return run.error("io_error", run.has('Q') ? run.place('Q') : run.place('L'),
                     "waiting for an input (L1-L4) needs Q above 0: the longest wait in seconds");
  run.set_parameter(number::input_result, mode == 0 || mode == 4 ? 0 : -1);
  run.emit(canon::WaitInput{*index, letter == 'E', mode, timeout});
}

void user_code(const CodeRule&, BlockRun& run) {
  for (const Word& word : run.block.words) {
    if (word.letter != 'M' || !word.rule || word.rule->group != ModalGroup::user) continue;
    canon::UserCode command;
    command.code = static_cast<int>(std::lround(word.number));
    command.has_p = run.has('P');
    command.has_q = run.has('Q');
    command.p = run.number_or('P', 0);
    command.q = run.number_or('Q', 0);
    run.emit(command);
  }
}

}  // namespace aircut::interp
