// What the O-words do. Jumps go along the links of the FlowIndex; a frame per call holds the loops
// that are running in it.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

#include "base/text.h"
#include "interp/codes/codes.h"
#include "interp/impl.h"
#include "interp/lexer.h"
#include "interp/macro_expression.h"

namespace aircut::interp {
namespace {

const char* word_of(Keyword keyword) {
  return keyword == Keyword::while_ ? "while" : keyword == Keyword::do_ ? "do" : "repeat";
}

}  // namespace

FlowIndex& Interpreter::Impl::flow_of(ProgramFile& file) {
  if (!file.flow)
    file.flow = std::make_unique<FlowIndex>(*file.text, file.begin, options_.block_delete,
                                            file.percent, parameters_, table_);
  if (file.flow->overfull() && !statistics_.limit_reached) {
    report("limit_reached", {0, block_ ? block_->length : 0},
           "the O-words and N blocks of the program are too many for the room that there is for "
           "temporary files (" +
               std::to_string(file.flow->entries.size()) +
               " O-words were read); make room there, or split the program");
    statistics_.limit_reached = true;
    stop();
  }
  return *file.flow;
}

// A comment on the line of an O-word does nothing, not even (MSG, …).
void Interpreter::Impl::execute_oword(Block& block) {
  Frame& frame = frames_.back();
  OWord& oword = block.oword;
  if (oword.keyword == Keyword::call) {
    flow_of(*frame.file);
    return call(block);
  }
  if (oword.entry < 0) oword.entry = flow_of(*frame.file).at(block.begin);
  const int at = oword.entry;
  if (at < 0) return;  // behind the end of a `%` program
  if (!entry_is_sound(at)) return;
  switch (oword.keyword) {
    case Keyword::fanuc_sub:
      if (!options_.fanuc_subs)
        report("fanuc_subs_off", oword.place,
               "subs of this style are switched off on this machine (DISABLE_FANUC_STYLE_SUB); use "
               "o… sub and o… endsub");
      return;
    default:
      return;
    case Keyword::sub:
      return pass_sub(block, at);
    case Keyword::endsub:
    case Keyword::return_:
      return leave_sub(block);
    case Keyword::if_:
      return branch_if(block, at);
    case Keyword::elseif:
      return pass_branches(block, at);
    case Keyword::else_:
      return jump_behind(entry(at).partner);
    case Keyword::endif:
      return;
    case Keyword::while_:
      return entry(at).partner > at ? enter_while(block, at) : do_while(block, at);
    case Keyword::do_:
      frame.loops.push_back({at});
      return;
    case Keyword::repeat:
      return enter_repeat(block, at);
    case Keyword::endwhile:
    case Keyword::endrepeat:
      return end_loop(block, at);
    case Keyword::break_:
    case Keyword::continue_:
      return leave_or_continue(block, at);
  }
}

// Tells a structural problem. A construct without an end can't be gone through: the run stops.
bool Interpreter::Impl::entry_is_sound(int at) {
  const FlowEntry& e = entry(at);
  if (e.fault == FlowFault::none) return true;
  report_problem(at, flow().line_of(at).place);
  const bool opener = e.keyword == Keyword::if_ || e.keyword == Keyword::elseif ||
                      e.keyword == Keyword::else_ || e.keyword == Keyword::while_ ||
                      e.keyword == Keyword::do_ || e.keyword == Keyword::repeat ||
                      e.keyword == Keyword::sub;
  if (opener && e.partner < 0) stop();
  return opener && e.partner >= 0 && !done_;
}

// Tells what is wrong with an entry of this file, at a place of the block in execution.
void Interpreter::Impl::report_problem(int at, Place place) {
  FlowProblem problem = flow().problem_of(at);
  report(problem.kind, place, std::move(problem.text));
}

// The same at the entry's own place.
void Interpreter::Impl::report_at(int where) {
  const FlowProblem problem = flow().problem_of(where);
  const FlowLine line = flow().line_of(where);
  SourceSpan at;
  at.text = frames_.back().file->text;
  at.begin = entry(where).begin + line.place.begin;
  at.length = line.place.length;
  at.line = entry(where).line;
  if (!reported_.emplace(at.text, at.begin, problem.kind).second) return;
  diagnostics_.error(problem.kind, at, problem.text);
  if (!options_.keep_going) stop();
}

// The line of an entry when it is kept parsed. The block that leads there remembers it.
Block* Interpreter::Impl::kept_block(int at) {
  OWord& from = block_->oword;
  if (from.jump_entry == at) return from.jump_block;
  const auto& blocks = frames_.back().file->blocks;
  const auto found = blocks.find(entry(at).begin);
  if (found == blocks.end()) return nullptr;
  from.jump_entry = at;
  from.jump_block = found->second.get();
  return from.jump_block;
}

void Interpreter::Impl::jump_to(int at) {
  Frame& frame = frames_.back();
  const FlowEntry& target = entry(at);
  frame.at = target.begin;
  frame.line = target.line - 1;
  frame.last = nullptr;
  frame.upcoming = kept_block(at);
}

void Interpreter::Impl::jump_behind(int at) {
  Frame& frame = frames_.back();
  const Block* kept = kept_block(at);
  frame.at = kept ? kept->next_begin : flow().after(at);
  frame.line = entry(at).line;
  frame.last = nullptr;
  frame.upcoming = kept ? kept->following : nullptr;
}

// The number in brackets; false when there is none, which is told.
bool Interpreter::Impl::condition(Block& block, double& value) {
  std::optional<Fault> fault;
  const bool known = evaluate(block.oword.arguments.front(), block.code, parameters_, value, fault);
  if (!known) report(*fault);
  return known;
}

// ---- branches --------------------------------------------------------------------------------

void Interpreter::Impl::branch_if(Block& block, int at) {
  double value = 0;
  if (!condition(block, value)) return jump_behind(entry(at).partner);
  if (value == 0) take_branch(at);
}

// Goes on with the branch behind `from`, whose condition was false.
void Interpreter::Impl::take_branch(int from) {
  while (true) {
    const int at = entry(from).next;
    const FlowEntry& branch = entry(at);
    if (branch.keyword != Keyword::elseif) return jump_behind(at);
    jump_to(at);
    Block* block = fetch();
    double value = 0;
    if (!block || !condition(*block, value)) return jump_behind(branch.partner);
    if (value != 0) return;
    from = at;
  }
}

// A branch was done. The control evaluates the conditions of the others nevertheless.
void Interpreter::Impl::pass_branches(Block& block, int at) {
  double unused = 0;
  condition(block, unused);
  for (int next = entry(at).next; entry(next).keyword == Keyword::elseif && !done_;
       next = entry(next).next) {
    jump_to(next);
    if (Block* line = fetch()) condition(*line, unused);
  }
  jump_behind(entry(at).partner);
}

// ---- loops -----------------------------------------------------------------------------------

// The running loop of the entry; loops inside it that were left by a jump are forgotten.
Loop* Interpreter::Impl::loop_at(int at) {
  auto& loops = frames_.back().loops;
  if (!loops.empty() && loops.back().entry == at) return &loops.back();
  const auto found = std::find_if(loops.rbegin(), loops.rend(),
                                  [&](const Loop& loop) { return loop.entry == at; });
  if (found == loops.rend()) return nullptr;
  loops.erase(found.base(), loops.end());
  return &loops.back();
}

bool Interpreter::Impl::next_pass(Loop& loop) {
  if (++loop.pass <= options_.limits.max_repeat) return true;
  --loop.pass;
  loop_limit(frames_.back(), std::to_string(options_.limits.max_repeat) +
                                 " passes of one loop (--max-blocks raises it)");
  return false;
}

void Interpreter::Impl::enter_while(Block& block, int at) {
  auto& loops = frames_.back().loops;
  const bool running = !loops.empty() && loops.back().entry == at;
  double value = 0;
  if (condition(block, value) && value != 0) {
    if (!running) loops.push_back({at});
    return;
  }
  if (running) loops.pop_back();
  continue_pending_ = false;
  // On its way to the end the control meets the loop's own breaks.
  for (int inside = at + 1; inside < entry(at).partner; ++inside)
    if (entry(inside).keyword == Keyword::break_ && entry(inside).partner == at)
      break_pending_ = true;
  jump_behind(entry(at).partner);
}

void Interpreter::Impl::do_while(Block& block, int at) {
  const int head = entry(at).partner;
  Loop* loop = loop_at(head);
  if (!loop) return;
  double value = 0;
  const bool again = condition(block, value) && value != 0;
  const bool left = std::exchange(break_pending_, false);
  if (left && again)
    warn(Fault{"control_fault", block.oword.place,
               "the control runs this do loop once only, because a break has left a while loop "
               "before it; use while instead of do"});
  if (left || !again) return frames_.back().loops.pop_back();
  if (next_pass(*loop)) jump_behind(head);
}

void Interpreter::Impl::enter_repeat(Block& block, int at) {
  double value = 0;
  const double rounded =
      condition(block, value) ? std::nearbyint(value) : 0;  // halves to the even number
  if (rounded <= 0) {
    continue_pending_ = false;
    return jump_behind(entry(at).partner);
  }
  Loop loop;
  loop.entry = at;
  loop.passes = rounded < 1e18 ? static_cast<std::uint64_t>(rounded)
                               : std::numeric_limits<std::uint64_t>::max();
  frames_.back().loops.push_back(std::move(loop));
}

void Interpreter::Impl::end_loop(Block& block, int at) {
  const int head = entry(at).partner;
  Loop* loop = loop_at(head);
  if (!loop) return;
  if (block.oword.keyword == Keyword::endwhile) {
    if (next_pass(*loop)) jump_to(head);
    return;
  }
  if (loop->pass >= loop->passes) {
    frames_.back().loops.pop_back();
    if (!std::exchange(continue_pending_, false)) return;
    warn(Fault{"control_fault", block.oword.place,
               "the control runs this loop once more from its begin, because it has not forgotten "
               "the continue of a do loop before it; use while instead of do"});
    return jump_to(head);
  }
  if (next_pass(*loop)) jump_behind(head);
}

void Interpreter::Impl::leave_or_continue(Block& block, int at) {
  const int head = entry(at).partner;
  if (!loop_at(head)) return;
  const int end = entry(head).partner;
  if (block.oword.keyword == Keyword::continue_) {
    if (entry(head).keyword == Keyword::do_) continue_pending_ = true;
    return jump_to(end);
  }
  frames_.back().loops.pop_back();
  if (entry(head).keyword == Keyword::while_) break_pending_ = true;
  jump_behind(end);
}

// The parameters that the condition in the line at `begin` reads, with their last values.
std::string Interpreter::Impl::tested_values(const ProgramFile& file, std::uint64_t begin,
                                             Keyword only) {
  Block block;
  const std::string_view text = file.text->content();
  const std::string_view line = text.substr(begin, find_line_end(text, begin).end - begin);
  block.clear();
  if (parse_line(line, parameters_, table_, block)) return {};
  if (only != Keyword::none && block.oword.keyword != only) return {};
  std::vector<std::string> seen;
  std::string values;
  std::optional<Fault> fault;
  for (const Instruction& i : block.code) {
    std::string name;
    std::optional<double> value;
    if (i.op == Op::read || i.op == Op::read_system || i.right == Right::parameter) {
      name = "#" + std::to_string(i.id);
      value = parameters_.read(i.id, i.place, fault);
    } else if (i.op == Op::read_named) {
      name = "#<" + printable(parameters_.name_of(i.id)) + ">";
      value = parameters_.read_named(i.id, i.place, fault);
    }
    if (!value || std::find(seen.begin(), seen.end(), name) != seen.end()) continue;
    seen.push_back(name);
    values += (values.empty() ? "" : ", ") + name +
              (is_vacant(*value) ? " vacant" : " = " + shortest(*value));
  }
  return values;
}

void Interpreter::Impl::loop_limit(const Frame& frame, const std::string& which) {
  const Loop& loop = frame.loops.back();
  FlowIndex& index = *frame.file->flow;
  const FlowEntry head = index.entries[static_cast<std::size_t>(loop.entry)];
  const Place place = index.line_of(loop.entry).place;
  SourceSpan at;
  at.text = frame.file->text;
  at.begin = head.begin + place.begin;
  at.length = place.length;
  at.line = head.line;
  at.calls = frame.calls;
  std::string message = "the limit of " + which + " is reached in pass " +
                        std::to_string(loop.pass) + " of this loop";
  const int test = head.keyword == Keyword::do_ ? head.partner : loop.entry;
  const std::string values =
      tested_values(*frame.file, index.entries[static_cast<std::size_t>(test)].begin);
  if (!values.empty()) message += "; its condition sees " + values;
  message += "; does it ever end?";
  // A limit of ours, not of the control: the program is not wrong, it could not be checked.
  diagnostics_.warning("loop_limit", at, std::move(message));
  statistics_.limit_reached = true;
  stop();
}

// (In place: handing a shared_ptr back makes the processor wait for the memory.)
void Interpreter::Impl::find_calls(std::shared_ptr<const CallFrame>& calls) {
  Frame& frame = frames_.back();
  calls = frame.calls;
  for (Loop& loop : frame.loops) {
    if (loop.frame && loop.frame->pass != loop.pass && loop.frame.use_count() == 1) {
      // Nobody else has kept the pass before, so its frame serves for this one.
      std::atomic_thread_fence(std::memory_order_acquire);
      loop.frame->pass = loop.pass;
      loop.frame->site.calls = std::move(calls);
    } else if (!loop.frame || loop.frame->pass != loop.pass) {
      const FlowEntry& head = entry(loop.entry);
      if (loop.title.empty()) {
        const FlowLine line = flow().line_of(loop.entry);
        loop.place = line.place;
        loop.title = head.keyword == Keyword::while_do
                         ? "DO" + line.label
                         : written_label(line.label) + ' ' + word_of(head.keyword);
      }
      auto made = std::make_shared<CallFrame>();
      made->site.text = frame.file->text;
      made->site.begin = head.begin + loop.place.begin;
      made->site.length = loop.place.length;
      made->site.line = head.line;
      made->site.calls = std::move(calls);
      made->what = loop.title;
      made->pass = loop.pass;
      loop.frame = std::move(made);
    }
    calls = loop.frame;
  }
}

}  // namespace aircut::interp
