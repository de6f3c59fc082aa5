// M98 M198 M97 M99 G65 G66 G67: what the words ask for; the flow of control does it once the block
// has succeeded.
#include <array>
#include <limits>

#include "interp/codes/codes.h"
#include "interp/dialect.h"
#include "interp/macro_execute.h"
#include "interp/macro_expression.h"

namespace aircut::interp {
namespace {

constexpr int max_repeats = 99'999'999;

// #1… of the letters A to Z; 0 for those that are no arguments. I J K are those of the first set.
// G, L and P are arguments only of a block that G66.1 hands over.
constexpr std::array<int, 26> variable_of = {1, 2, 3, 7,  8,  9,  0,  11, 4,  5,  6,  0,  13,
                                             0, 0, 0, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26};

int variable_for(char letter, bool whole_block) {
  if (letter < 'A' || letter > 'Z') return 0;
  if (whole_block && letter == 'G') return 10;
  if (whole_block && letter == 'L') return 12;
  if (whole_block && letter == 'P') return 16;
  return variable_of[static_cast<std::size_t>(letter - 'A')];
}

std::optional<std::uint64_t> repeats_of(BlockRun& run) {
  const auto l = run.integer('L', 0, max_repeats);
  if (!l) return run.has('L') ? std::nullopt : std::optional<std::uint64_t>(1);
  return static_cast<std::uint64_t>(*l);
}

bool program_number(const CodeRule& rule, BlockRun& run) {
  if (!run.has('P')) {
    run.error("word_missing", rule, name_of(rule) + " needs P: the number of the program");
    return false;
  }
  const auto p = run.integer('P', 1, 99'999'999);
  if (!p) return false;
  run.flow.label = *p;
  run.flow.place = run.place('P');
  return true;
}

// #1-#33 from the words behind G65. I J K may come again: each further set fills the next three
// variables, and within a set they come in this order. What comes later counts.
bool arguments_of(BlockRun& run, std::vector<double>& locals, bool whole_block = false) {
  locals.assign(Parameters::macro_locals, vacant_value);
  int set = 0;
  char before = 0;
  std::optional<Fault> fault;
  for (const Word& word : run.block.macro_words) {
    int variable = variable_for(word.letter, whole_block);
    if (variable == 0) {
      run.error("word_unused", word.place,
                written(word.letter) + " can't be an argument of a macro");
      return false;
    }
    if (word.letter >= 'I' && word.letter <= 'K') {
      if (before != 0 && word.letter <= before) ++set;
      before = word.letter;
      variable += 3 * set;
      if (variable > Parameters::macro_locals) {
        run.error("word_unused", word.place, "more than ten sets of I J K");
        return false;
      }
    }
    const auto value = evaluate(word.text, run.block.code, run.session.parameters, fault);
    if (!value) {
      run.error(fault->kind, fault->place, fault->message);
      return false;
    }
    const bool scaled = word.text.constant() && word.letter != 'G';
    const double number = scaled ? word_number(run, word, *value) : *value;
    locals[static_cast<std::size_t>(variable - 1)] = number;
  }
  return true;
}

}  // namespace

// Without L the digits in front of the last four may be the count: P30012 is O0012, three times.
void call_program(const CodeRule& rule, BlockRun& run) {
  if (!program_number(rule, run)) return;
  const auto repeats = repeats_of(run);
  if (!repeats) return;
  run.flow.repeats = *repeats;
  if (run.session.table.dialect().packed_counts && !run.has('L') && run.flow.label > 9999) {
    run.flow.repeats = static_cast<std::uint64_t>(run.flow.label / 10'000);
    run.flow.label %= 10'000;
  }
  run.flow.kind = FlowRequest::Kind::call;
}

void call_local_sub(const CodeRule& rule, BlockRun& run) {
  if (!program_number(rule, run)) return;
  const auto repeats = repeats_of(run);
  if (!repeats) return;
  run.flow.repeats = *repeats;
  run.flow.kind = FlowRequest::Kind::local_call;
}

void return_from_program(const CodeRule& rule, BlockRun& run) {
  const auto block = run.integer('P', 0, 99'999'999);
  if (run.has('P') && !block) return;
  run.flow.place = block ? run.place('P') : run.place(rule);
  if (block) run.flow.block = *block;
  if (run.level == Level::main && !block) {
    run.info("program_restart", rule,
             "M99 in the main program starts it again and again; one pass is done here");
    return fanuc_end(rule, run);
  }
  run.flow.kind = FlowRequest::Kind::return_;
}

// G65 calls at once, G66 behind every block that moves.
void call_macro(const CodeRule& rule, BlockRun& run) {
  if (!program_number(rule, run)) return;
  const auto repeats = repeats_of(run);
  if (!repeats || !arguments_of(run, run.flow.locals)) return;
  run.flow.repeats = *repeats;
  run.flow.kind = rule.code == 650 ? FlowRequest::Kind::macro_call : FlowRequest::Kind::modal_call;
}

// G66.1 calls for every block behind it, which becomes the arguments.
void call_macro_per_block(const CodeRule& rule, BlockRun& run) {
  call_macro(rule, run);
  run.flow.each_block = true;
  run.warning("control_setting", run.place(rule),
              "controls differ in whether the line with G66.1 calls the macro too; here it does, "
              "with the arguments of that line");
}

bool take_block_as_arguments(BlockRun& run) { return arguments_of(run, run.flow.locals, true); }

void end_modal_macro(const CodeRule&, BlockRun& run) {
  run.flow.kind = FlowRequest::Kind::modal_end;
}

}  // namespace aircut::interp
