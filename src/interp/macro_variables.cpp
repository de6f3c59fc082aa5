// System variables of macro B: alarms and stops (#3000, #3006), timers, modal information
// (#4001…), and what the last words were (#4107…).
#include <cmath>

#include "base/text.h"
#include "interp/impl.h"
#include "interp/macro_execute.h"
#include "interp/macro_expression.h"

namespace aircut::interp {
namespace {

constexpr double blocks_per_hour = 3.6e6;

constexpr bool within(int n, int first, int last) { return n >= first && n <= last; }

// The G code in force of group n - 4000, as #4001… say it; nothing for groups that are not kept.
std::optional<double> modal_group(int n, const ModalState& state, bool modal_macro) {
  const SpindleState& spindle = state.spindles[0];
  constexpr int planes[] = {17, 18, 19, 17, 18, 19};
  const bool cycle = state.motion >= 730 && state.motion <= 890 && state.motion != 800;
  switch (n - 4000) {
    case 1:
      return cycle || state.motion == 800 ? 0 : state.motion / 10.0;
    case 2:
      return planes[static_cast<std::size_t>(state.plane)];
    case 3:
      return state.incremental ? 91 : 90;
    case 5:
      return state.feed_mode == canon::FeedMode::per_revolution ? 95
             : state.feed_mode == canon::FeedMode::inverse_time ? 93
                                                                : 94;
    case 6:
      return state.unit == canon::Unit::inch ? 20 : 21;
    case 7:
      return state.comp.side == CompSide::off ? 40 : state.comp.side == CompSide::left ? 41 : 42;
    case 8:
      return state.length_offset == AxisValues{} ? 49 : 43;
    case 9:
      return cycle ? state.motion / 10.0 : 80;
    case 10:
      return state.retract_to_r ? 99 : 98;
    case 11:
      return state.frame.scaled ? 51 : 50;
    case 12:
      return modal_macro ? 66 : 67;
    case 13:
      return spindle.css ? 96 : 97;
    case 14:
      return state.system <= 6 ? 53 + state.system : 54.1;
    case 15:
      return state.path_mode == canon::PathMode::continuous ? 64 : 61;
    case 16:
      return state.frame.turned ? 68 : 69;
    case 22:
      return state.frame.any_mirror() ? 51.1 : 50.1;
    default:
      return std::nullopt;
  }
}

}  // namespace

double Interpreter::Impl::increments_per_unit() const {
  return state_.unit == canon::Unit::inch ? 10'000 : 1000;
}

std::optional<double> Interpreter::Impl::system_variable(int n, Place place,
                                                         std::optional<Fault>& fault) const {
  if (const auto offset = offset_variable(n, session_, state_)) return offset;
  if (within(n, 1000, 1999)) return 0;  // signals of the machine's own logic: none
  // What passes between two blocks is not known before the moves are planned: 1 ms per block.
  const auto blocks = static_cast<double>(statistics_.blocks);
  if (n == 3001) return parameters_.stored(n) + blocks;
  if (n == 3002) return parameters_.stored(n) + blocks / blocks_per_hour;
  if (n == 3000 || within(n, 3003, 3007)) return parameters_.stored(n);
  if (within(n, 4001, 4030))
    if (const auto code = modal_group(n, state_, !modal_macros_.empty())) return code;
  if (within(n, 4101, 4126)) {
    switch (n) {
      case 4109:
        return state_.feed;
      case 4114:
        return static_cast<double>(last_number_);
      case 4119:
        return state_.spindles[0].speed;
      case 4120:
        return std::max(0, state_.selected_tool);
      default:
        break;
    }
    // #4102 is B, #4107 D, #4111 H, #4113 M: the letter's place in the alphabet, but for D E F.
    const int letter = n == 4107 ? 'D' : n == 4108 ? 'E' : n == 4111 ? 'H' : n == 4113 ? 'M' : 0;
    if (n == 4102) return last_words_[1];
    if (n == 4115) return static_cast<double>(frames_.back().program);
    if (letter != 0) return last_words_[static_cast<std::size_t>(letter - 'A')];
  }
  fault = Fault{"parameter_range", place,
                "there is no variable #" + std::to_string(n) +
                    " here; programs use #1-#33, #100-#199 and #500-#999"};
  return std::nullopt;
}

void write_system_variable(BlockRun& run, int n, double value, Place place) {
  const std::optional<Comment>& comment = run.block.comment;
  const std::string text = comment ? run.text_of(*comment) : std::string();
  const double blocks = run.block_count();
  const double number = is_vacant(value) ? 0 : value;
  switch (set_offset_variable(n, number, run)) {
    case VariableWrite::done:
      return;
    case VariableWrite::read_only:
      return run.error("parameter_read_only", place,
                       "#" + std::to_string(n) + " is a position of the machine and can't be set");
    case VariableWrite::not_an_offset:
      break;
  }
  switch (n) {
    case 3000:
      return run.error("alarm", place,
                       "the program stops itself with alarm " + shortest(number) +
                           (text.empty() ? "" : ": " + printable(text)));
    case 3001:
      return run.set_parameter(n, number - blocks);
    case 3002:
      return run.set_parameter(n, number - blocks / blocks_per_hour);
    case 3003:
    case 3004:
      return run.set_parameter(n, number);
    case 3006:
      run.emit(canon::Message{canon::Message::Kind::message, text});
      return run.emit(canon::ProgramStop{false});
    default:
      break;
  }
  if (within(n, 1000, 1999) || within(n, 3005, 3999))
    return run.warning("word_ignored", place,
                       "#" + std::to_string(n) + " has no effect here: it is not modelled");
  run.error("parameter_read_only", place, "#" + std::to_string(n) + " can't be set by a program");
}

void Interpreter::Impl::remember_words(const Block& block) {
  if (block.number >= 0) last_number_ = block.number;
  for (const Word& word : block.words)
    if (word.letter >= 'A' && word.letter <= 'Z')
      last_words_[static_cast<std::size_t>(word.letter - 'A')] = word.number;
}

}  // namespace aircut::interp
