// Values of words: increments, rounding; settings of variables.
#include "interp/macro_execute.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "interp/codes/codes.h"
#include "interp/dialect.h"
#include "interp/impl.h"
#include "interp/macro_expression.h"

namespace aircut::interp {
namespace {

constexpr int most_told_points = 20;

bool is_rotary_letter(char letter) { return (letter >= 'A' && letter <= 'C') || letter == 'a'; }

// The unit of the block: G20 or G21 on it, else the one in force.
bool in_inches(const BlockRun& run) {
  for (const Word& word : run.block.words)
    if (word.rule && word.rule->group == ModalGroup::unit) return word.rule->code == 200;
  return run.state.unit == canon::Unit::inch;
}

// F without a decimal point: mm/min are whole, 0.01 in/min, 0.01 mm/rev, 0.0001 in/rev; some
// controls take lengths' increments.
double feed_divisor(const BlockRun& run, bool inch) {
  if (run.session.table.dialect().feed_increments) return increments_of('F', inch);
  canon::FeedMode mode = run.state.feed_mode;
  for (const Word& word : run.block.words) {
    if (!word.rule || word.rule->group != ModalGroup::feed_mode) continue;
    const bool lathe = run.session.options.lathe;
    if (word.rule->code == (lathe ? 990 : 950)) mode = canon::FeedMode::per_revolution;
    if (word.rule->code == (lathe ? 980 : 940)) mode = canon::FeedMode::per_minute;
  }
  if (mode == canon::FeedMode::per_minute) return inch ? 100 : 1;
  if (mode == canon::FeedMode::per_revolution) return inch ? 10'000 : 100;
  return 1;
}

void tell_increments(BlockRun& run, const Word& word, double divisor, double number) {
  if (run.session.points_missing >= most_told_points) return;
  const char* unit = is_rotary_letter(word.letter) ? " degrees" : in_inches(run) ? " in" : " mm";
  const std::string what = written(word.letter) + shortest(word.text.number);
  run.warning("decimal_point", word.place,
              what + " without a decimal point counts " + shortest(1 / divisor) + unit +
                  ": it is " + shortest(number) + unit + "; write " + what + ". if that is meant");
}

}  // namespace

double increments_of(char letter, bool inch) {
  return inch && !is_rotary_letter(letter) ? 10'000 : 1000;
}

double word_number(BlockRun& run, const Word& word, double value) {
  if (is_vacant(value)) return value;
  if (is_count_of_cycle(run, word.letter) || is_plain_number(run, word.letter)) return value;
  const bool inch = in_inches(run);
  const bool increments = (letter_bit(word.letter) & increment_letters) != 0;
  if (!word.text.constant()) {
    if (increments) return rounded_to(value, increments_of(word.letter, inch));
    return word.letter == 'F' || word.letter == 'E' || word.letter == 'G' ? value
                                                                          : std::round(value);
  }
  if (!word.no_point || value == 0 || !run.session.table.dialect().least_increments ||
      run.session.options.whole_units || (!increments && word.letter != 'F'))
    return value;
  const double divisor = increments ? increments_of(word.letter, inch) : feed_divisor(run, inch);
  if (divisor == 1) return value;
  const double number = value / divisor;
  tell_increments(run, word, divisor, number);
  return number;
}

// Words and settings read the variables as they are before the block.
bool BlockExecutor::evaluate_macro_b() {
  std::optional<Fault> fault;
  for (Word& word : block_.words) {
    double value = word.text.number;
    if (!word.text.constant()) {
      const auto result = interp::evaluate(word.text, block_.code, run_.session.parameters, fault);
      if (!result) {
        run_.fault_ = fault;
        return false;
      }
      value = *result;
    }
    word.number = word_number(run_, word, value);
    if (!word.text.constant() && (word.letter == 'G' || word.letter == 'M'))
      word.rule = run_.session.table.find(word.letter, word.number);
  }
  return true;
}

// A word whose value is vacant does not count: the block without such words. A value that can't be
// computed stays, and is told when the block is executed.
Block& Interpreter::Impl::without_vacant(Block& block) {
  std::optional<Fault> fault;
  const auto vacant = [&](const Word& word) {
    if (word.text.constant()) return false;
    const auto value = evaluate(word.text, block.code, parameters_, fault);
    return value && is_vacant(*value);
  };
  std::vector<bool> drop;
  for (const Word& word : block.words) drop.push_back(vacant(word));
  if (std::find(drop.begin(), drop.end(), true) == drop.end()) return block;
  reduced_ = block;
  reduced_.following = nullptr;
  reduced_.words.clear();
  reduced_.slot.fill(-1);
  reduced_.letters = 0;
  reduced_.has_rules = false;
  for (std::size_t i = 0; i < block.words.size(); ++i) {
    if (drop[i]) continue;
    const Word& word = block.words[i];
    if (word.letter == 'G' || word.letter == 'M')
      reduced_.has_rules = true;
    else
      reduced_.slot[static_cast<std::size_t>(letter_index(word.letter))] =
          static_cast<std::int8_t>(reduced_.words.size());
    reduced_.letters |= letter_bit(word.letter);
    reduced_.words.push_back(word);
  }
  return reduced_;
}

bool BlockExecutor::macro_settings() {
  Parameters& parameters = run_.session.parameters;
  std::optional<Fault> fault;
  std::vector<std::pair<int, double>> set;
  for (const Setting& setting : block_.settings) {
    const auto value = interp::evaluate(setting.value, block_.code, parameters, fault);
    const auto target =
        value ? interp::evaluate(setting.target, block_.code, parameters, fault) : std::nullopt;
    if (!value || !target) {
      run_.fault_ = fault;
      return false;
    }
    const auto index = as_integer(std::round(*target));
    if (index && *index == 0) {
      run_.error("parameter_read_only", setting.place, "#0 is always vacant and can't be set");
      return false;
    }
    if (!index || (*index < Parameters::first_system && !Parameters::is_macro_variable(*index))) {
      run_.error("parameter_range", setting.place,
                 "there is no variable #" + shortest(*target) +
                     "; those for programs are #1-#33, #100-#199 and #500-#999");
      return false;
    }
    set.emplace_back(*index, *value);
  }
  for (std::size_t i = 0; i < set.size() && run_.ok(); ++i) {
    const auto [index, value] = set[i];
    if (index < Parameters::first_system)
      parameters.write(index, value);
    else
      write_system_variable(run_, index, value, block_.settings[i].place);
  }
  return run_.ok();
}

}  // namespace aircut::interp
