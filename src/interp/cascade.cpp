// One mistake, one message: a block that fails changes nothing, so later blocks may fail only
// because of what it did not set. Such errors are recognised and not told:
//   position     the block is tried again from where the failed one would have led; when it is fine
//                from there, its error is an echo
//   feed, spindle, motion code, named parameters: the failed block would have set them
#include "interp/codes/codes.h"
#include "interp/impl.h"

namespace aircut::interp {
namespace {

bool sets_motion(const Word& word) {
  return word.rule && word.rule->group == ModalGroup::motion && word.rule->code != 800;
}

bool turns_spindle(const Word& word) {
  return word.letter == 'M' && word.rule && (word.rule->code == 3 || word.rule->code == 4);
}

}  // namespace

bool Interpreter::Impl::is_cascade(const Fault& fault) const {
  if (!failed_) return false;
  const std::string_view kind = fault.kind;
  if (kind == "zero_feed") return unsure_.feed;
  if (kind == "spindle_stopped") return unsure_.spindle;
  if (kind == "axis_word_unused") return unsure_.motion && state_.motion == 800;
  if (kind == "word_unused") return unsure_.motion && !block_->has_rules;
  if (kind == "parameter_undefined") {
    for (const std::string& name : unsure_.names)
      if (fault.message.find("#<" + name + ">") != std::string::npos) return true;
  }
  return false;
}

bool Interpreter::Impl::follows_from_position(const Fault& fault, Block& block) {
  const std::string_view kind = fault.kind;
  const bool by_position = kind == "arc_error" || kind == "polar_error" || kind == "probe_error";
  if (!by_position || !unsure_.tip || state_.comp.side != CompSide::off) return false;
  ModalState trial = state_;
  trial.tip = *unsure_.tip;
  CommandQueue nowhere;
  BlockRun run(session_, block, trial, *this, nowhere);
  run_block(run, block);
  parameters_.roll_back();
  run.roll_back_tools();
  session_.nurbs.resize(state_.nurbs_points);
  if (!run.ok()) return false;
  unsure_.tip = trial.tip;
  return true;
}

void Interpreter::Impl::remember_failure(const Block& block) {
  failed_ = true;
  if (contour_frame_ >= 0) frames_[static_cast<std::size_t>(contour_frame_)].reading->failed = true;
  // Where the block would have led, as far as its words say it.
  AxisValues tip = unsure_.tip.value_or(state_.tip);
  AxisValues program = to_program(state_, tip);
  bool moves = false;
  for (const Axis axis : all_axes) {
    const Word* word = block.find(letter(axis));
    if (!word) continue;
    moves = true;
    double value = word->number * (is_rotary(axis) ? radian_per_degree : state_.unit_mm());
    if (axis == Axis::x && state_.lathe_diameter) value /= 2;
    program[axis] = state_.incremental ? program[axis] + value : value;
  }
  if (moves) unsure_.tip = to_tip(state_, program);
  if (block.find('F')) unsure_.feed = true;
  for (const Word& word : block.words) {
    if (turns_spindle(word)) unsure_.spindle = true;
    if (sets_motion(word)) unsure_.motion = true;
  }
  for (const Setting& setting : block.settings)
    if (setting.name >= 0) unsure_.names.insert(parameters_.name_of(setting.name));
}

// A block that succeeded makes sure again what it sets. `next_` is the state behind it.
void Interpreter::Impl::clear_unsure(const Block& block, const AxisValues& before) {
  if (unsure_.tip) {
    AxisValues& tip = *unsure_.tip;
    for (const Axis axis : all_axes) {
      if (next_.incremental)
        tip[axis] += next_.tip[axis] - before[axis];
      else if (block.find(letter(axis)))
        tip[axis] = next_.tip[axis];
    }
    if (tip == next_.tip) unsure_.tip.reset();
  }
  if (block.find('F')) unsure_.feed = false;
  for (const Word& word : block.words) {
    if (word.letter == 'M' && word.rule && word.rule->group == ModalGroup::spindle)
      unsure_.spindle = false;
    if (word.rule && word.rule->group == ModalGroup::motion) unsure_.motion = false;
  }
  for (const Setting& setting : block.settings)
    if (setting.name >= 0) unsure_.names.erase(parameters_.name_of(setting.name));
}

}  // namespace aircut::interp
