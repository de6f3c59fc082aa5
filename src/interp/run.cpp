#include "interp/run.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/text.h"
#include "interp/dialect.h"
#include "interp/impl.h"

namespace aircut::interp {

std::optional<int> BlockRun::integer(char letter, int least, int most, const char* kind) {
  const Word* word = block.find(letter);
  if (!word) return std::nullopt;
  const auto value = as_integer(word->number);
  if (value && *value >= least && *value <= most) return value;
  std::string range = "from " + std::to_string(least) + " to " + std::to_string(most);
  if (most == std::numeric_limits<int>::max()) range = "of " + std::to_string(least) + " or more";
  error(kind, word->place,
        std::string(1, letter) + " must be an integer " + range + " here, this is " +
            shortest(word->number));
  return std::nullopt;
}

std::optional<double> BlockRun::increment(Axis which) const {
  if (!has_increments() || which > Axis::z) return std::nullopt;
  const char letter = which == Axis::x ? 'U' : which == Axis::y ? 'V' : 'W';
  if (!has(letter)) return std::nullopt;
  return which == Axis::x && state.lathe_diameter ? length(letter) / 2 : length(letter);
}

bool BlockRun::is_axis(Axis which) const {
  if (has_increments() && which >= Axis::u) return false;
  return !is_rotary(which) || !session.table.lathe() || session.options.axes.empty() ||
         session.options.axes.has(which);
}

std::optional<double> BlockRun::axis(Axis which) const {
  const Word* word = block.find(letter(which));
  if (!word || !is_axis(which)) return std::nullopt;
  return axis_number(*word, which);
}

Place BlockRun::place(char letter) const {
  const Word* word = block.find(letter);
  return word ? word->place : whole();
}

Place BlockRun::place(const CodeRule& rule) const {
  for (const Word& word : block.words)
    if (word.rule == &rule) return word.place;
  return whole();
}

bool BlockRun::given(const CodeRule& rule) const {
  return std::any_of(block.words.begin(), block.words.end(),
                     [&](const Word& word) { return word.rule == &rule; });
}

void BlockRun::error(const char* kind, Place place, std::string message) {
  if (!fault_) fault_ = Fault{kind, place, std::move(message)};
}

void BlockRun::unknown_code(const Word& word) {
  std::string other;
  if (word.letter == 'G' && word.number >= 0 && word.number < 1000)
    other = control_with(static_cast<int>(std::lround(word.number * 10)), session.options.dialect,
                         session.table.lathe());
  error("unknown_code", word.place,
        word.letter + shortest(word.number) + " is not a code of this control; " +
            (other.empty() ? "check the number" : other));
}

void BlockRun::warning(const char* kind, Place place, std::string message) {
  warnings_.push_back({kind, place, std::move(message)});
}

std::string BlockRun::text_of(const Comment& comment) const {
  const SourceSpan& span = site_.span();
  return std::string(
      span.text->content().substr(span.begin + comment.text_begin, comment.text_length));
}

void BlockRun::info(const char* kind, const CodeRule& rule, std::string message) {
  infos_.push_back({kind, place(rule), std::move(message)});
}

canon::Command BlockRun::make(canon::Action action, std::string expanded) {
  return {std::move(action), span(), block_of_command(), std::move(expanded)};
}

void BlockRun::emit_held(canon::Action action) {
  session.compensator.hold(make(std::move(action), {}));
}

void BlockRun::pass_on(canon::Command command) {
  if (session.compensator.holds())
    session.compensator.hold(std::move(command));
  else
    release(std::move(command));
}

bool BlockRun::fail_corner(std::string message) {
  if (fault_) return false;
  corner_failed_ = true;
  error("corner_error", whole(), std::move(message));
  return false;
}

void BlockRun::emit_work_offset() { emit(canon::WorkOffset{state.system, state.work_offset}); }
void BlockRun::emit_rotation() { emit(canon::WorkRotation{state.rotation}); }
void BlockRun::emit_g92() { emit(canon::G92Offset{state.g92}); }

AxisValues BlockRun::stored_axes(int first) const {
  AxisValues values;
  for (const Axis axis : all_axes)
    values[axis] = parameter(first + static_cast<int>(index(axis))) *
                   (is_rotary(axis) ? radian_per_degree : session.machine_unit_mm);
  return values;
}

void BlockRun::store_axes(int first, const AxisValues& values) {
  for (const Axis axis : all_axes)
    set_parameter(first + static_cast<int>(index(axis)),
                  values[axis] / (is_rotary(axis) ? radian_per_degree : session.machine_unit_mm));
}

tool::Tool* BlockRun::change_tool(int number) {
  const auto at = std::find_if(session.tools.tools.begin(), session.tools.tools.end(),
                               [&](const tool::Tool& tool) { return tool.number == number; });
  if (at == session.tools.tools.end()) return nullptr;
  old_tools_.push_back(*at);
  return &*at;
}

OffsetMemory& BlockRun::change_offsets() {
  if (!old_offsets_) old_offsets_ = session.offsets;
  return session.offsets;
}

void BlockRun::roll_back_tools() {
  if (old_offsets_) session.offsets = std::move(*old_offsets_);
  old_offsets_.reset();
  for (auto old = old_tools_.rbegin(); old != old_tools_.rend(); ++old)
    for (tool::Tool& tool : session.tools.tools)
      if (tool.number == old->number) tool = *old;
  old_tools_.clear();
}

void BlockRun::switch_kinematics(const canon::SwitchKinematics& to, bool again) {
  switch_to_ = to;
  switch_again_ = again;
}

}  // namespace aircut::interp
