// Small codes of Fanuc-like controls: G4, path control, what is accepted without moving anything,
// M-codes of the builder, the end of the program.
#include "base/text.h"
#include "interp/codes/codes.h"
#include "interp/dialect.h"

namespace aircut::interp {

// X and U are seconds, P milliseconds; on a Haas a P with a decimal point is in seconds too.
void fanuc_dwell(const CodeRule& rule, BlockRun& run) {
  const Word* word = nullptr;
  for (const char letter : {'X', 'U', 'P'})
    if (const Word* found = run.block.find(letter)) {
      if (word)
        return run.error("word_unused", found->place,
                         "G4 takes one of X, U and P, not two of them");
      word = found;
    }
  if (!word)
    return run.error("word_missing", rule,
                     "G4 needs the time: X (or U) in seconds, or P in milliseconds");
  double seconds = thousandths(run, *word);
  if (word->letter == 'P' && !word->no_point && run.session.options.dialect != Dialect::haas) {
    if (!as_integer(word->number))
      return run.error("dwell_time", word->place,
                       "P of G4 is in whole milliseconds; give X for seconds");
    seconds = word->number / 1000;
  }
  if (seconds < 0)
    return run.error("dwell_time", word->place,
                     "G4 needs a time of 0 or more, this is " + shortest(seconds) + " seconds");
  run.emit(canon::Dwell{seconds});
}

// G61 stops at the end of each move; G62 and G63 change the feed in corners and the override, which
// is the path of G64.
void fanuc_path_mode(const CodeRule& rule, BlockRun& run) {
  const bool stop = rule.code == 610;
  run.state.path_mode = stop ? canon::PathMode::exact_stop : canon::PathMode::continuous;
  run.state.path_tolerance = 0;
  run.emit(canon::SetPathMode{run.state.path_mode, 0});
}

void accepted(const CodeRule& rule, BlockRun& run) {
  run.info("code_accepted", rule,
           name_of(rule) + " is accepted; it moves no axis, and nothing else of it is modelled");
}

bool is_plain_number(const BlockRun& run, char letter) {
  if (letter != 'Q') return false;
  for (const Word& word : run.block.words)
    if (word.rule && (word.rule->handler == fanuc_data || word.rule->handler == accepted))
      return true;
  return false;
}

void builder_code(const CodeRule& rule, BlockRun& run) {
  canon::UserCode command;
  command.code = rule.code;
  command.has_p = run.has('P');
  command.has_q = run.has('Q');
  command.p = run.number_or('P', 0);
  command.q = run.number_or('Q', 0);
  run.emit(command);
}

// M19 turns the spindle to its stop; P or R (Haas) say the angle.
void fanuc_orient(const CodeRule&, BlockRun& run) {
  double angle = 0;
  for (const char letter : {'P', 'R'})
    if (const auto value = run.number(letter)) angle = *value;
  run.state.spindles[0].turn = canon::SpindleTurn::stop;
  run.emit(canon::OrientSpindle{0, angle * radian_per_degree, 0});
}

// The end takes back what outlives no program: the frames and the local shift.
void fanuc_end(const CodeRule& rule, BlockRun& run) {
  ModalState& state = run.state;
  run.session.compensator.finish(run);
  if (!run.ok()) return;
  state.comp = CompState{};
  tell_frames_left_on(rule, run);
  reset_frames(run);
  if (!(state.local_shift == AxisValues{})) {
    state.g92 -= state.local_shift;
    state.local_shift = {};
    run.emit_g92();
  }
  program_end(rule, run);
}

}  // namespace aircut::interp
