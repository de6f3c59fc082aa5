// What the O-words do. Jumps go along the links of the FlowIndex; a frame per call holds the loops
// that are running in it.
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/text.h"
#include "interp/codes/codes.h"
#include "interp/impl.h"

namespace aircut::interp {
namespace {

constexpr std::size_t max_files = 10'000;

const char* word_of(Keyword keyword) {
  return keyword == Keyword::while_ ? "while" : keyword == Keyword::do_ ? "do" : "repeat";
}

// `100` → o100, `pocket` → o<pocket>.
std::string written(const std::string& label) {
  const bool plain = !label.empty() && (label[0] == '[' || label[0] == '#' ||
                                        std::all_of(label.begin(), label.end(),
                                                    [](char c) { return c >= '0' && c <= '9'; }));
  return plain ? "o" + label : "o<" + label + ">";
}

std::string folder_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos ? std::string() : path.substr(0, slash + 1);
}

bool is_safe_name(const std::string& name) {
  if (name.empty() || name[0] == '/' || name.find('\0') != std::string::npos) return false;
  for (std::size_t at = 0; at <= name.size();) {
    const std::size_t slash = std::min(name.find('/', at), name.size());
    if (name.substr(at, slash - at) == "..") return false;
    at = slash + 1;
  }
  return true;
}

}  // namespace

FlowIndex& Interpreter::Impl::flow_of(ProgramFile& file) {
  if (!file.flow)
    file.flow = std::make_unique<FlowIndex>(file.text->content(), file.begin, options_.block_delete,
                                            file.percent, parameters_, table_);
  return *file.flow;
}

// A comment on the line of an O-word does nothing, not even (MSG, …).
void Interpreter::Impl::execute_oword(Block& block) {
  Frame& frame = frames_.back();
  OWord& oword = block.oword;
  if (oword.entry < 0) oword.entry = flow_of(*frame.file).at(block.begin);
  const int at = oword.entry;
  if (at < 0) return;  // behind the end of a `%` program
  if (&block != &scratch_) entry(at).block = &block;
  if (!entry_is_sound(at)) return;
  switch (oword.keyword) {
    case Keyword::none:
    case Keyword::fanuc_sub:
      return;
    case Keyword::sub:
      return pass_sub(block, at);
    case Keyword::endsub:
    case Keyword::return_:
      return leave_sub(block);
    case Keyword::call:
      return call(block);
    case Keyword::if_:
      return branch_if(block, at);
    case Keyword::elseif:
    case Keyword::else_:
      return jump_behind(entry(entry(at).partner));  // a branch was done
    case Keyword::endif:
      return;
    case Keyword::while_:
      return entry(at).partner > at ? enter_while(block, at) : do_while(block, at);
    case Keyword::do_:
      frame.loops.push_back({at, 1, 0, nullptr, 0});
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
  if (!e.problem_kind) return true;
  report(e.problem_kind, e.place, e.problem);
  const bool opener = e.keyword == Keyword::if_ || e.keyword == Keyword::elseif ||
                      e.keyword == Keyword::else_ || e.keyword == Keyword::while_ ||
                      e.keyword == Keyword::do_ || e.keyword == Keyword::repeat ||
                      e.keyword == Keyword::sub;
  if (opener && e.partner < 0) stop();
  return opener && e.partner >= 0;
}

void Interpreter::Impl::report_at(const FlowEntry& where) {
  SourceSpan at;
  at.text = frames_.back().file->text;
  at.begin = where.begin + where.place.begin;
  at.length = where.place.length;
  at.line = where.line;
  if (!reported_.emplace(at.text, at.begin, where.problem_kind).second) return;
  diagnostics_.error(where.problem_kind, at, where.problem);
  if (!options_.keep_going) stop();
}

void Interpreter::Impl::jump_to(const FlowEntry& target) {
  Frame& frame = frames_.back();
  frame.at = target.begin;
  frame.line = target.line - 1;
  frame.last = nullptr;
  frame.upcoming = target.block;
}

void Interpreter::Impl::jump_behind(const FlowEntry& target) {
  Frame& frame = frames_.back();
  frame.at = target.after;
  frame.line = target.line;
  frame.last = nullptr;
  frame.upcoming = target.block ? target.block->following : nullptr;
}

std::optional<double> Interpreter::Impl::condition(Block& block) {
  std::optional<Fault> fault;
  const auto value = evaluate(block.oword.arguments.front(), block.code, parameters_, fault);
  if (!value) report(*fault);
  return value;
}

// ---- branches --------------------------------------------------------------------------------

void Interpreter::Impl::branch_if(Block& block, int at) {
  const auto value = condition(block);
  if (!value) return jump_behind(entry(entry(at).partner));
  if (*value == 0) take_branch(at);
}

// Goes on with the branch behind `from`, whose condition was false.
void Interpreter::Impl::take_branch(int from) {
  while (true) {
    const int at = entry(from).next;
    const FlowEntry& branch = entry(at);
    if (branch.keyword != Keyword::elseif) return jump_behind(branch);
    jump_to(branch);
    Block* block = fetch();
    const auto value = block ? condition(*block) : std::nullopt;
    if (!value) return jump_behind(entry(branch.partner));
    if (*value != 0) return;
    from = at;
  }
}

// ---- loops -----------------------------------------------------------------------------------

// The running loop of the entry; loops inside it that were left by a jump are forgotten.
Loop* Interpreter::Impl::loop_at(int at) {
  auto& loops = frames_.back().loops;
  const auto found = std::find_if(loops.rbegin(), loops.rend(),
                                  [&](const Loop& loop) { return loop.entry == at; });
  if (found == loops.rend()) return nullptr;
  loops.erase(found.base(), loops.end());
  return &loops.back();
}

bool Interpreter::Impl::next_pass(Loop& loop) {
  if (++loop.pass <= options_.limits.max_repeat) return true;
  --loop.pass;
  loop_limit(frames_.back(), std::to_string(options_.limits.max_repeat) + " passes of one loop");
  return false;
}

void Interpreter::Impl::enter_while(Block& block, int at) {
  auto& loops = frames_.back().loops;
  const bool running = !loops.empty() && loops.back().entry == at;
  const auto value = condition(block);
  if (value && *value != 0) {
    if (!running) loops.push_back({at, 1, 0, nullptr, 0});
    return;
  }
  if (running) loops.pop_back();
  jump_behind(entry(entry(at).partner));
}

void Interpreter::Impl::do_while(Block& block, int at) {
  const int head = entry(at).partner;
  Loop* loop = loop_at(head);
  if (!loop) return;
  const auto value = condition(block);
  if (!value || *value == 0) return frames_.back().loops.pop_back();
  if (next_pass(*loop)) jump_behind(entry(head));
}

void Interpreter::Impl::enter_repeat(Block& block, int at) {
  const auto value = condition(block);
  const double rounded = value ? std::round(*value) : 0;
  if (rounded <= 0) return jump_behind(entry(entry(at).partner));
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
    if (next_pass(*loop)) jump_to(entry(head));
    return;
  }
  if (loop->pass >= loop->passes) return frames_.back().loops.pop_back();
  if (next_pass(*loop)) jump_behind(entry(head));
}

void Interpreter::Impl::leave_or_continue(Block& block, int at) {
  const int head = entry(at).partner;
  if (!loop_at(head)) return;
  const FlowEntry& end = entry(entry(head).partner);
  if (block.oword.keyword == Keyword::continue_) return jump_to(end);
  frames_.back().loops.pop_back();
  jump_behind(end);
}

// The parameters that the loop's condition reads, with their last values.
std::string Interpreter::Impl::tested_values(const Frame& frame, const FlowEntry& head) {
  const FlowEntry& place = head.keyword == Keyword::do_
                               ? frame.file->flow->entries[static_cast<std::size_t>(head.partner)]
                               : head;
  Block block;
  const std::string_view text = frame.file->text->content();
  std::string_view line = text.substr(place.begin, place.after - place.begin);
  while (!line.empty() && (line.back() == '\n' || line.back() == '\r')) line.remove_suffix(1);
  if (parse_line(line, parameters_, table_, block)) return {};
  std::vector<std::string> seen;
  std::string values;
  std::optional<Fault> fault;
  for (const Instruction& i : block.code) {
    std::string name;
    std::optional<double> value;
    if (i.op == Op::read) {
      name = "#" + std::to_string(i.id);
      value = parameters_.read(i.id, i.place, fault);
    } else if (i.op == Op::read_named) {
      name = "#<" + printable(parameters_.name_of(i.id)) + ">";
      value = parameters_.read_named(i.id, i.place, fault);
    }
    if (!value || std::find(seen.begin(), seen.end(), name) != seen.end()) continue;
    seen.push_back(name);
    values += (values.empty() ? "" : ", ") + name + " = " + shortest(*value);
  }
  return values;
}

void Interpreter::Impl::loop_limit(const Frame& frame, const std::string& which) {
  const Loop& loop = frame.loops.back();
  const FlowEntry& head = frame.file->flow->entries[static_cast<std::size_t>(loop.entry)];
  SourceSpan at;
  at.text = frame.file->text;
  at.begin = head.begin + head.place.begin;
  at.length = head.place.length;
  at.line = head.line;
  at.calls = frame.calls;
  std::string message = "the limit of " + which + " is reached in pass " +
                        std::to_string(loop.pass) + " of this loop";
  const std::string values = tested_values(frame, head);
  if (!values.empty()) message += "; its condition sees " + values;
  message += "; does it ever end?";
  diagnostics_.error("loop_limit", at, std::move(message));
  statistics_.limit_reached = true;
  stop();
}

std::shared_ptr<const CallFrame> Interpreter::Impl::current_calls() {
  Frame& frame = frames_.back();
  std::shared_ptr<const CallFrame> calls = frame.calls;
  for (Loop& loop : frame.loops) {
    if (!loop.frame || loop.frame_pass != loop.pass) {
      const FlowEntry& head = entry(loop.entry);
      auto made = std::make_shared<CallFrame>();
      made->site.text = frame.file->text;
      made->site.begin = head.begin + head.place.begin;
      made->site.length = head.place.length;
      made->site.line = head.line;
      made->site.calls = std::move(calls);
      made->what.reserve(32);
      made->what += written(head.label);
      made->what += ' ';
      made->what += word_of(head.keyword);
      made->what += ", pass ";
      made->what += std::to_string(loop.pass);
      loop.frame = std::move(made);
      loop.frame_pass = loop.pass;
    }
    calls = loop.frame;
  }
  return calls;
}

// ---- subs ------------------------------------------------------------------------------------

void Interpreter::Impl::pass_sub(Block& block, int at) {
  FlowEntry& sub = entry(at);
  if (sub.called_ahead)
    report("sub_reached", block.oword.place,
           "the main program runs into a sub that it has called from before; end the main program "
           "with M2 before this line");
  sub.passed = true;
  // A sub inside this one would come to light only in a call.
  for (int inside = at + 1; inside < sub.partner; ++inside) {
    const FlowEntry& other = entry(inside);
    if (other.keyword == Keyword::sub && other.problem_kind) report_at(other);
  }
  jump_behind(entry(sub.partner));
}

std::optional<std::string> Interpreter::Impl::label_of(const Block& block) {
  const OWord& oword = block.oword;
  if (!oword.computed) return oword.label;
  std::optional<Fault> fault;
  const auto value = evaluate(*oword.computed, block.code, parameters_, fault);
  if (!value) {
    report(*fault);
    return std::nullopt;
  }
  const auto number = as_integer(*value);
  if (!number || *number < 0) {
    report("bad_label", oword.place,
           "the number of an O-word must be an integer of 0 or more, this is " + shortest(*value));
    return std::nullopt;
  }
  return std::to_string(*number);
}

std::optional<std::vector<double>> Interpreter::Impl::arguments_of(const Block& block) {
  std::vector<double> values;
  std::optional<Fault> fault;
  for (const Value& argument : block.oword.arguments) {
    const auto value = evaluate(argument, block.code, parameters_, fault);
    if (!value) {
      report(*fault);
      return std::nullopt;
    }
    values.push_back(*value);
  }
  return values;
}

// Among the texts that are open: this one first, then in the order in which they were opened.
ProgramFile* Interpreter::Impl::find_file_with_sub(const std::string& name) {
  ProgramFile* here = frames_.back().file;
  if (flow_of(*here).find_sub(name) >= 0) return here;
  ProgramFile* main = frames_.front().file;
  if (flow_of(*main).find_sub(name) >= 0) return main;
  for (ProgramFile* file : opened_order_)
    if (flow_of(*file).find_sub(name) >= 0) return file;
  return nullptr;
}

ProgramFile* Interpreter::Impl::open_sub_file(const std::string& name, Place place) {
  if (!is_safe_name(name)) {
    report("path_refused", place,
           "the name of a sub's file can't be an absolute path or contain '..'; put the file into "
           "the program's folder or the sub path");
    return nullptr;
  }
  std::vector<std::string> folders = {folder_of(frames_.front().file->text->name())};
  for (const std::string& folder : options_.sub_path)
    folders.push_back(folder.empty() || folder.back() == '/' ? folder : folder + "/");
  if (opened_order_.size() >= max_files) {
    report("limit_reached", place, "more than 10000 files of subs were opened");
    statistics_.limit_reached = true;
    stop();
    return nullptr;
  }
  for (const std::string& folder : folders) {
    if (!reader_) break;
    const auto text = reader_(folder + name + ".ngc");
    if (!text) continue;
    ProgramFile& file = file_for(**text);
    opened_order_.push_back(&file);
    if (file.text->content().starts_with("\xef\xbb\xbf")) file.begin = 3;
    find_percent(file);
    if (flow_of(file).find_sub(name) >= 0) return &file;
    report("sub_missing", place,
           "the file '" + printable(file.text->name()) + "' has no '" + written(printable(name)) +
               " sub'; the sub must have the name of its file");
    return nullptr;
  }
  report("sub_missing", place,
         "there is no sub " + written(printable(name)) + " in this program and no file '" +
             printable(name) + ".ngc' in its folder or the sub path");
  return nullptr;
}

void Interpreter::Impl::call(Block& block) {
  const auto label = label_of(block);
  if (!label) return;
  const auto arguments = arguments_of(block);
  if (!arguments) return;
  ProgramFile* file = find_file_with_sub(*label);
  if (!file) file = open_sub_file(*label, block.oword.place);
  if (!file) return;
  const int at = file->flow->find_sub(*label);
  FlowEntry& sub = file->flow->entries[static_cast<std::size_t>(at)];
  if (sub.problem_kind) {
    report(sub.problem_kind, block.oword.place, sub.problem);
    return;
  }
  if (!sub.passed && file == frames_.front().file) sub.called_ahead = true;
  std::string what = written(*label) + " call";
  for (const double value : *arguments) what += " [" + shortest(value) + "]";
  enter_sub(*file, at, &*arguments, std::move(what));
}

bool Interpreter::Impl::enter_sub(ProgramFile& file, int at, const std::vector<double>* arguments,
                                  std::string what) {
  if (static_cast<int>(frames_.size()) > options_.limits.max_depth) {
    report("call_depth", {0, block_->length},
           "more than " + std::to_string(options_.limits.max_depth) +
               " calls inside each other; does the recursion end?");
    statistics_.limit_reached = true;
    stop();
    return false;
  }
  const FlowEntry& sub = file.flow->entries[static_cast<std::size_t>(at)];
  auto call = std::make_shared<CallFrame>();
  call->site = span();
  call->what = std::move(what);
  Frame frame;
  frame.file = &file;
  frame.at = sub.after;
  frame.line = sub.line;
  frame.sub = at;
  frame.calls = std::move(call);
  frames_.push_back(std::move(frame));
  parameters_.enter(arguments);
  return true;
}

void Interpreter::Impl::leave_sub(Block& block) {
  const Frame& frame = frames_.back();
  if (frames_.size() == 1 || frame.fanuc) {
    return report("flow_syntax", block.oword.place,
                  frame.fanuc ? "a sub called with M98 ends with M99"
                              : "return and endsub work inside a sub only");
  }
  // The value may be made of the last one, so that is forgotten only now.
  std::optional<double> value;
  if (!block.oword.arguments.empty()) value = condition(block);
  value_ = value.value_or(0);
  value_returned_ = value.has_value();
  return_from_call();
}

void Interpreter::Impl::return_from_call() {
  Frame& frame = frames_.back();
  if (frame.restore_at_return && frame.saved) {
    BlockRun run(session_, *block_, state_, *this, queue_);
    restore_state(run, *frame.saved);
    parameters_.commit();
  }
  parameters_.leave();
  frames_.pop_back();
  span_valid_ = false;
}

void Interpreter::Impl::call_fanuc(const FlowRequest& request) {
  const std::string label = std::to_string(request.label);
  ProgramFile& file = *frames_.back().file;
  FlowIndex& flow = flow_of(file);
  const int at = flow.find_fanuc(label, block_->begin);
  const Place place = block_->find('P') ? block_->find('P')->place : Place{0, block_->length};
  if (at < 0) {
    if (flow.find_sub(label) >= 0)
      return report("flow_syntax", place,
                    "M98 can't call o" + label + " sub; use o" + label + " call");
    return report("sub_missing", place,
                  "there is no sub O" + label + " in this program; it begins with O" + label +
                      " and ends with M99");
  }
  if (request.repeats == 0) return;
  if (!enter_sub(file, at, nullptr, "M98 P" + label)) return;
  frames_.back().fanuc = true;
  frames_.back().repeats = request.repeats;
}

void Interpreter::Impl::return_fanuc() {
  Frame& frame = frames_.back();
  if (frame.repeats > 1) {
    --frame.repeats;
    frame.loops.clear();
    return jump_behind(entry(frame.sub));
  }
  return_from_call();
}

}  // namespace aircut::interp
