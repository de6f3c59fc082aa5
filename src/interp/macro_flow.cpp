// Statements of macro B: GOTO, IF, WHILE … DO … END, DPRNT. A GOTO looks for its block behind
// itself and then from the top of the program; loops that it leaves are forgotten, and it can't go
// into one.
#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "interp/impl.h"
#include "interp/lexer.h"
#include "interp/macro_expression.h"
#include "interp/macro_output.h"

namespace aircut::interp {

bool Interpreter::Impl::is_true(Block& block) {
  double value = 0;
  return condition(block, value) && !is_vacant(value) && value != 0;
}

void Interpreter::Impl::execute_macro(Block& block) {
  OWord& statement = block.oword;
  for (const Fault& warning : block.warnings) warn(warning);
  switch (statement.keyword) {
    case Keyword::program:
      return enter_program(block);
    case Keyword::if_goto:
      if (!is_true(block)) return;
      [[fallthrough]];
    case Keyword::goto_: {
      const std::size_t argument = statement.arguments.size() - 1;
      const auto number = block_number_of(block, argument);
      if (number) jump_to_block(*number, statement.argument_places[argument]);
      return;
    }
    case Keyword::if_then:
    case Keyword::if_m99:
      if (is_true(block)) execute_words(block);
      return;
    case Keyword::output:
      return write_out(block);
    case Keyword::while_do:
    case Keyword::end_:
      break;
    default:
      return;
  }
  if (statement.entry < 0) statement.entry = flow_of(*frames_.back().file).at(block.begin);
  const int at = statement.entry;
  if (at < 0) return;  // behind the `%` at the end
  const FlowEntry& e = entry(at);
  if (e.fault != FlowFault::none) {
    report_problem(at, statement.place);
    if (e.partner < 0) {
      if (statement.keyword == Keyword::while_do) stop();
      return;
    }
  }
  if (statement.keyword == Keyword::while_do) return enter_do(block, at);
  end_do(at);
}

// A second header means that the program above it has run to its last line.
void Interpreter::Impl::enter_program(Block& block) {
  Frame& frame = frames_.back();
  if (frame.header_seen) return end_of_file();
  frame.header_seen = true;
  frame.program = static_cast<std::int64_t>(parse_number(block.oword.label).value_or(0));
  if (!block.words.empty() || block.comment)
    execute_words(block.has_expressions ? without_vacant(block) : block);
}

void Interpreter::Impl::enter_do(Block& block, int at) {
  auto& loops = frames_.back().loops;
  const bool running = !loops.empty() && loops.back().entry == at;
  if (block.oword.arguments.empty() || is_true(block)) {
    if (!running) loops.push_back({at});
    return;
  }
  if (running) loops.pop_back();
  jump_behind(entry(at).partner);
}

void Interpreter::Impl::end_do(int at) {
  const int head = entry(at).partner;
  Loop* loop = loop_at(head);
  if (loop && next_pass(*loop)) jump_to(head);
}

// ---- jumps -----------------------------------------------------------------------------------

std::optional<std::int64_t> Interpreter::Impl::block_number_of(const Block& block,
                                                               std::size_t argument) {
  std::optional<Fault> fault;
  const auto value = evaluate(block.oword.arguments[argument], block.code, parameters_, fault);
  if (!value) {
    report(*fault);
    return std::nullopt;
  }
  const double rounded = std::round(*value);
  if (rounded >= 0 && rounded <= 99'999'999) return static_cast<std::int64_t>(rounded);
  report("label_missing", block.oword.argument_places[argument],
         "there is no block N" + shortest(*value) + "; block numbers go from 0 to 99999999");
  return std::nullopt;
}

bool Interpreter::Impl::jump_to_block(std::int64_t number, Place place) {
  Frame& frame = frames_.back();
  const auto target = flow_of(*frame.file).find_block(number, block_->begin);
  if (!target) {
    report("label_missing", place,
           "there is no block N" + std::to_string(number) + " in this program");
    return false;
  }
  if (!may_jump_into(*target, place)) return false;
  leave_loops_for(*target);
  if (target->place.begin <= block_->begin) {
    frame.jumped = true;
    const bool same = frame.back && frame.back->from.begin == block_->begin;
    frame.back = BackwardJump{{block_->begin, block_->next_begin, block_->line},
                              block_->oword.keyword == Keyword::none ? place : block_->oword.place,
                              target->place.begin,
                              same ? frame.back->count + 1 : 1};
    if (frame.back->count > options_.limits.max_repeat) {
      goto_limit(frame, std::to_string(options_.limits.max_repeat) +
                            " passes of one jump (--max-blocks raises it)");
      return false;
    }
  }
  frame.at = target->place.begin;
  frame.line = target->place.line - 1;
  frame.last = nullptr;
  frame.upcoming = nullptr;
  return true;
}

void Interpreter::Impl::leave_loops_for(const NumberedBlock& target) {
  auto& loops = frames_.back().loops;
  while (!loops.empty()) {
    const FlowEntry& head = entry(loops.back().entry);
    const bool inside =
        target.place.begin > head.begin && target.place.begin <= entry(head.partner).begin;
    if (inside) return;
    loops.pop_back();
  }
}

bool Interpreter::Impl::may_jump_into(const NumberedBlock& target, Place place) {
  const Frame& frame = frames_.back();
  for (int loop = target.loop; loop >= 0; loop = entry(loop).next) {
    const bool running = std::any_of(frame.loops.begin(), frame.loops.end(),
                                     [&](const Loop& other) { return other.entry == loop; });
    if (running) continue;
    report("flow_syntax", place,
           "N" + std::to_string(target.number) + " is inside the loop DO" +
               flow().line_of(loop).label + ", which a jump can't enter; jump to its WHILE");
    return false;
  }
  return true;
}

// Tells the variables that the conditions between the jump and its target test.
void Interpreter::Impl::goto_limit(const Frame& frame, const std::string& which) {
  const BackwardJump& jump = *frame.back;
  SourceSpan at;
  at.text = frame.file->text;
  at.begin = jump.from.begin + jump.place.begin;
  at.length = jump.place.length;
  at.line = jump.from.line;
  at.calls = frame.calls;
  std::string message = "the limit of " + which + " is reached after " +
                        std::to_string(jump.count) + " jumps back from here";
  std::string values;
  const std::string_view text = frame.file->text->content();
  for (std::uint64_t begin = jump.to; begin <= jump.from.begin && values.size() < 200;) {
    const std::string more = tested_values(*frame.file, begin, Keyword::if_goto);
    if (!more.empty() && values.find(more) == std::string::npos)
      values += (values.empty() ? "" : ", ") + more;
    begin = find_line_end(text, begin).next;
  }
  if (!values.empty()) message += "; the conditions in between see " + values;
  message += "; does it ever end?";
  diagnostics_.warning("loop_limit", at, std::move(message));
  statistics_.limit_reached = true;
  stop();
}

std::optional<BlockPlace> Interpreter::Impl::find_block(std::int64_t number) {
  const auto found = flow_of(*frames_.back().file).find_block(number, block_->begin);
  if (!found) return std::nullopt;
  return found->place;
}

std::optional<Fault> Interpreter::Impl::read_block(const BlockPlace& at, Block& out) {
  const std::string_view text = frames_.back().file->text->content();
  const LineExtent extent = find_line_end(text, at.begin);
  out.clear();
  out.begin = at.begin;
  out.line = at.line;
  out.next_begin = extent.next;
  out.length = static_cast<std::uint32_t>(extent.end - at.begin);
  return parse_line(text.substr(at.begin, extent.end - at.begin), parameters_, table_, out);
}

// ---- output ----------------------------------------------------------------------------------

void Interpreter::Impl::write_out(const Block& block) {
  const std::string_view line =
      frames_.back().file->text->content().substr(block.begin, block.length);
  const Place place = block.oword.argument_places.front();
  BlockRun run(session_, block, state_, *this, queue_);
  run.emit(canon::Message{canon::Message::Kind::print,
                          expand_output(line.substr(place.begin, place.length), parameters_)});
}

}  // namespace aircut::interp
