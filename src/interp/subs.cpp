// Calls and returns: `o… call` with arguments, files of subs, and M98/M99.
#include <algorithm>

#include "base/text.h"
#include "interp/codes/codes.h"
#include "interp/impl.h"

namespace aircut::interp {
namespace {

constexpr std::size_t max_files = 10'000;

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

// `, in a circle: o1 call → o2 call → …` when the innermost call's sub is open further out already.
std::string circle_of_calls(const std::vector<Frame>& frames) {
  const Frame& inner = frames.back();
  std::size_t from = frames.size() - 1;
  while (from > 1 && !(frames[from - 1].file == inner.file && frames[from - 1].sub == inner.sub))
    --from;
  if (from <= 1) return {};
  std::string out;
  for (; from < frames.size(); ++from) {
    if (!frames[from].calls) continue;
    const std::string& what = frames[from].calls->what;
    out += what.substr(0, what.find(" [")) + " → ";
  }
  return out.empty() ? out : ", in a circle: " + out + "…";
}

}  // namespace

// `100` → o100, `pocket` → o<pocket>.
std::string written_label(const std::string& label) {
  const bool plain = !label.empty() && (label[0] == '[' || label[0] == '#' ||
                                        std::all_of(label.begin(), label.end(),
                                                    [](char c) { return c >= '0' && c <= '9'; }));
  return plain ? "o" + label : "o<" + label + ">";
}

void Interpreter::Impl::pass_sub(Block& block, int at) {
  FlowEntry& sub = entry(at);
  if (sub.called_ahead)
    report("sub_reached", block.oword.place,
           "the main program runs into a sub that it has called from before; end the main program "
           "with M2 before this line");
  if (!is_first_definition(block, at)) return jump_behind(sub.partner);
  sub.passed = true;
  if (block.oword.computed)
    if (const auto label = label_of(block); label && !flow().name_sub(at, *label)) {
      statistics_.limit_reached = true;
      report("limit_reached", block.oword.place,
             "more than " + std::to_string(FlowIndex::max_computed) +
                 " labels of subs that are expressions");
      return stop();
    }
  // A sub inside this one would come to light only in a call.
  for (int inside = at + 1; inside < sub.partner; ++inside) {
    const FlowEntry& other = entry(inside);
    if (other.keyword == Keyword::sub && other.fault != FlowFault::none) report_at(inside);
  }
  const std::string own = flow().line_of(at).label;
  for (int inside = at + 1; inside <= sub.partner; ++inside) {
    const FlowEntry& other = entry(inside);
    const bool ends = other.keyword == Keyword::endsub || other.keyword == Keyword::return_;
    if (ends && flow().line_of(inside).label == own) pass_value(inside);
  }
  jump_behind(sub.partner);
}

// Of two subs of one name the control refuses the one that it comes past as the second.
bool Interpreter::Impl::is_first_definition(const Block& block, int at) {
  if (block.oword.computed) return true;
  ProgramFile* known = find_known_sub(block.oword.label);
  if (!known) return true;
  const int first = known->flow->find_sub(block.oword.label);
  if (known == frames_.back().file && first == at) return true;
  report("label_reused", block.oword.place,
         "there is a sub " + written_label(printable(block.oword.label)) + " already, in line " +
             std::to_string(known->flow->entries[static_cast<std::size_t>(first)].line) + " of '" +
             printable(known->text->name()) + "'; give every sub a label of its own");
  return false;
}

// The control reads the ends of a sub while it passes the definition: their values count as
// returned, with 0 for names that the sub would have set.
void Interpreter::Impl::pass_value(int end) {
  jump_to(end);
  Block* block = fetch();
  if (!block) return;
  value_ = 0;
  value_returned_ = !block->oword.arguments.empty();
  if (!value_returned_) return;
  std::optional<Fault> fault;
  const auto value = evaluate(block->oword.arguments.front(), block->code, parameters_, fault);
  if (!value && std::string_view(fault->kind) != "parameter_undefined") report(*fault);
  value_ = value.value_or(0);
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

// A sub is known once its definition was passed or it was called.
ProgramFile* Interpreter::Impl::find_known_sub(const std::string& name) {
  const auto knows = [&](ProgramFile* file) {
    const int at = flow_of(*file).find_sub(name);
    return at >= 0 && file->flow->entries[static_cast<std::size_t>(at)].passed;
  };
  if (ProgramFile* here = frames_.back().file; knows(here)) return here;
  if (ProgramFile* main = frames_.front().file; knows(main)) return main;
  for (ProgramFile* file : opened_order_)
    if (knows(file)) return file;
  return nullptr;
}

// A known sub, else the one in a file of its name, else further down in this text. What stands
// above and was jumped over is not found, as on the control.
ProgramFile* Interpreter::Impl::find_sub(const std::string& name, const Block& block, Place place) {
  if (ProgramFile* file = find_known_sub(name)) return file;
  ProgramFile* here = frames_.back().file;
  const int ahead = flow_of(*here).find_sub(name);
  const bool is_ahead =
      ahead >= 0 && here->flow->entries[static_cast<std::size_t>(ahead)].begin > block.begin;
  if (is_safe_name(name)) {
    bool found = false;
    ProgramFile* file = open_sub_file(name, place, false, found);
    if (found) return file;
  } else if (!is_ahead) {
    report("path_refused", place,
           "the name of a sub's file can't be an absolute path or contain '..'; put the file into "
           "the program's folder or the sub path");
    return nullptr;
  }
  if (is_ahead) return here;
  const std::string label = written_label(printable(name));
  report("sub_missing", place,
         ahead >= 0 ? "the definition of " + label +
                          " stands above, but the control has not come past it; move it below "
                          "this call, or to where it is passed before"
                    : "there is no sub " + label + " in this program and no file '" +
                          printable(name) + ".ngc' in its folder or the sub path");
  return nullptr;
}

// `found` tells whether there is such a file; it may lack the sub, which is an error.
ProgramFile* Interpreter::Impl::open_sub_file(const std::string& name, Place place, bool fanuc,
                                              bool& found) {
  for (const std::string& folder : sub_folders()) {
    if (!reader_) break;
    const auto text = reader_(folder + name + ".ngc");
    if (!text) continue;
    found = true;
    ProgramFile& file = file_for(**text);
    if (!count_file(file, place)) return nullptr;
    const int at = fanuc ? flow_of(file).find_fanuc(name, 0) : flow_of(file).find_sub(name);
    if (at >= 0) return &file;
    const std::string wanted = fanuc ? "O" + name : written_label(printable(name)) + " sub";
    report("sub_missing", place,
           "the file '" + printable(file.text->name()) + "' has no '" + wanted +
               "'; the sub must have the name of its file");
    return nullptr;
  }
  return nullptr;
}

std::vector<std::string> Interpreter::Impl::sub_folders() const {
  std::vector<std::string> folders = {folder_of(frames_.front().file->text->name())};
  for (const std::string& folder : options_.sub_path)
    folders.push_back(folder.empty() || folder.back() == '/' ? folder : folder + "/");
  return folders;
}

bool Interpreter::Impl::count_file(ProgramFile& file, Place place) {
  if (opened_order_.size() >= max_files) {
    report("limit_reached", place, "more than 10000 files of subs were opened");
    statistics_.limit_reached = true;
    stop();
    return false;
  }
  opened_order_.push_back(&file);
  if (file.text->content().starts_with("\xef\xbb\xbf")) file.begin = 3;
  find_first_line(file);
  return true;
}

void Interpreter::Impl::call(Block& block) {
  const auto label = label_of(block);
  if (!label) return;
  const auto arguments = arguments_of(block);
  if (!arguments) return;
  ProgramFile* file = find_sub(*label, block, block.oword.place);
  if (!file) return;
  const int at = file->flow->find_sub(*label);
  FlowEntry& sub = file->flow->entries[static_cast<std::size_t>(at)];
  if (sub.fault != FlowFault::none) {
    FlowProblem problem = file->flow->problem_of(at);
    return report(problem.kind, block.oword.place, std::move(problem.text));
  }
  if (!sub.passed && file == frames_.front().file) sub.called_ahead = true;
  sub.passed = true;
  std::string what = written_label(*label) + " call";
  for (const double value : *arguments) what += " [" + shortest(value) + "]";
  if (!enter_sub(*file, at, &*arguments, std::move(what)) || !options_.count_arguments) return;
  parameters_.write_named(parameters_.intern("n_args"), static_cast<double>(arguments->size()));
  parameters_.commit();
}

bool Interpreter::Impl::enter_sub(ProgramFile& file, int at, const std::vector<double>* arguments,
                                  std::string what) {
  const FlowEntry& sub = file.flow->entries[static_cast<std::size_t>(at)];
  Frame frame;
  frame.file = &file;
  frame.start = {sub.begin, file.flow->after(at), sub.line};
  frame.sub = at;
  return push_frame(std::move(frame), std::move(what), arguments);
}

bool Interpreter::Impl::push_frame(Frame frame, std::string what,
                                   const std::vector<double>* arguments) {
  if (static_cast<int>(frames_.size()) > options_.limits.max_depth) {
    report("call_depth", {0, block_->length},
           "more than " + std::to_string(options_.limits.max_depth) + " calls inside each other" +
               circle_of_calls(frames_) + "; does the recursion end?");
    statistics_.limit_reached = true;
    stop();
    return false;
  }
  auto call = std::make_shared<CallFrame>();
  call->site = span();
  call->what = std::move(what);
  frame.at = frame.start.after;
  frame.line = frame.start.line;
  frame.call_site = block_->begin;
  frame.calls = std::move(call);
  if (frame.locals.empty())
    parameters_.enter(arguments);
  else
    parameters_.enter_macro(frame.locals);
  frames_.push_back(std::move(frame));
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
  double value = 0;
  value_returned_ = !block.oword.arguments.empty() && condition(block, value);
  value_ = value_returned_ ? value : 0;
  return_from_call();
}

void Interpreter::Impl::return_from_call() {
  Frame& frame = frames_.back();
  if (frame.restore_at_return && frame.saved) {
    BlockRun run(session_, *block_, state_, *this, queue_);
    restore_state(run, *frame.saved);
    if (!run.ok()) report(*run.fault());
    parameters_.commit();
  }
  parameters_.leave();
  auto reading = std::move(frame.reading);
  if (frame.remap) session_.remaps.leave();
  auto rest = std::move(frame.suspended);
  frames_.pop_back();
  span_valid_ = false;
  if (reading) finish_contour(std::move(reading));
  if (rest && !done_) resume_line(std::move(rest));
}

// As find_sub: one that was called before, else the one in a file of its name, else the next one
// further down in this text.
ProgramFile* Interpreter::Impl::find_fanuc_sub(const std::string& label, Place place, int& at) {
  std::vector<ProgramFile*> files = {frames_.back().file, frames_.front().file};
  files.insert(files.end(), opened_order_.begin(), opened_order_.end());
  for (ProgramFile* file : files)
    if ((at = flow_of(*file).find_called_fanuc(label)) >= 0) return file;
  ProgramFile* here = frames_.back().file;
  const bool other_style = find_known_sub(label) || flow_of(*here).find_sub(label) >= 0;
  if (!find_known_sub(label)) {
    bool found = false;
    ProgramFile* file = open_sub_file(label, place, true, found);
    if (file) at = file->flow->find_fanuc(label, 0);
    if (found) return file;
    if ((at = here->flow->find_fanuc(label, block_->begin + 1)) >= 0) return here;
  }
  if (other_style)
    report("flow_syntax", place, "M98 can't call o" + label + " sub; use o" + label + " call");
  else if (here->flow->find_fanuc(label, 0) >= 0)
    report("sub_missing", place,
           "O" + label +
               " stands above this line and was not called from further up; the control "
               "looks for it below only");
  else
    report("sub_missing", place,
           "there is no sub O" + label + " below, which begins with O" + label +
               " and ends with M99, and no file '" + label +
               ".ngc' in the program's folder or the sub path");
  return nullptr;
}

void Interpreter::Impl::call_fanuc(const FlowRequest& request) {
  const std::string label = std::to_string(request.label);
  const Place place = block_->find('P') ? block_->find('P')->place : Place{0, block_->length};
  int at = -1;
  ProgramFile* file = find_fanuc_sub(label, place, at);
  if (!file || request.repeats == 0) return;
  file->flow->entries[static_cast<std::size_t>(at)].passed = true;
  if (!enter_sub(*file, at, nullptr, "M98 P" + label)) return;
  frames_.back().fanuc = true;
  frames_.back().repeats = request.repeats;
}

void Interpreter::Impl::return_fanuc() {
  value_ = 0;
  value_returned_ = false;
  Frame& frame = frames_.back();
  if (frame.repeats > 1) {
    --frame.repeats;
    frame.loops.clear();
    return jump_behind(frame.sub);
  }
  return_from_call();
}

}  // namespace aircut::interp
