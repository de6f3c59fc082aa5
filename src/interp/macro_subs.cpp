// Calls and returns of Fanuc-like controls: programs of this file, of those that are open, and of
// files with the program's number for a name; macros with their own #1-#33; M97, M99 P.
#include <algorithm>

#include "base/text.h"
#include "interp/codes/codes.h"
#include "interp/dialect.h"
#include "interp/impl.h"
#include "interp/macro_expression.h"

namespace aircut::interp {
namespace {

// O1234.nc, o1234, 1234.ngc, O0012.txt …
std::vector<std::string> file_names(std::int64_t number) {
  const std::string plain = std::to_string(number);
  std::vector<std::string> numbers;
  for (const std::size_t width : {std::size_t{4}, std::size_t{5}, std::size_t{1}}) {
    std::string padded = std::string(width - std::min(width, plain.size()), '0') + plain;
    if (std::find(numbers.begin(), numbers.end(), padded) == numbers.end())
      numbers.push_back(std::move(padded));
  }
  std::vector<std::string> names;
  for (const char* letter : {"O", "o", ""})
    for (const std::string& digits : numbers)
      for (const char* ending : {".nc", ".ngc", ".txt", ".NC", ".tap", ".cnc", ""})
        names.push_back(letter + digits + ending);
  return names;
}

std::string program_name(std::int64_t number) {
  const std::string plain = std::to_string(number);
  return "O" + std::string(4 - std::min<std::size_t>(4, plain.size()), '0') + plain;
}

}  // namespace

// This text, the main program's, then those opened before, in their order. `entry` is the header,
// or -1 for a file that is the program as a whole.
ProgramFile* Interpreter::Impl::find_program(std::int64_t number, Place place, int& entry) {
  std::vector<ProgramFile*> files = {frames_.back().file, frames_.front().file};
  files.insert(files.end(), opened_order_.begin(), opened_order_.end());
  for (ProgramFile* file : files) {
    entry = flow_of(*file).find_program(number);
    if (entry >= 0 || file->whole_program == number) return file;
  }
  return open_program_file(number, place, entry);
}

ProgramFile* Interpreter::Impl::open_program_file(std::int64_t number, Place place, int& entry) {
  if (reader_) {
    for (const std::string& folder : sub_folders()) {
      for (const std::string& name : file_names(number)) {
        const auto text = reader_(folder + name);
        if (!text) continue;
        ProgramFile& file = file_for(**text);
        if (!count_file(file, place)) return nullptr;
        entry = flow_of(file).find_program(number);
        if (entry >= 0) return &file;
        if (flow_of(file).entries.empty() || flow_of(file).entries[0].keyword != Keyword::program) {
          file.whole_program = number;
          return &file;
        }
        report("sub_missing", place,
               "the file '" + printable(file.text->name()) + "' has no program " +
                   program_name(number));
        return nullptr;
      }
    }
  }
  report("sub_missing", place,
         "there is no program " + program_name(number) +
             " in this file, and no file of that name (O1234.nc, 1234.txt …) in its folder or the "
             "sub path");
  return nullptr;
}

bool Interpreter::Impl::push_program(const FlowRequest& request, std::string what) {
  int header = -1;
  ProgramFile* file = find_program(request.label, request.place, header);
  if (!file) return false;
  Frame frame;
  frame.file = file;
  frame.fanuc = true;
  frame.sub = header;
  frame.program = request.label;
  frame.repeats = request.repeats;
  frame.locals = request.locals;
  if (header >= 0) {
    const FlowEntry& e = file->flow->entries[static_cast<std::size_t>(header)];
    frame.start = {e.begin, file->flow->after(header), e.line};
    frame.header_seen = true;
  } else {
    frame.start = first_line(*file);
  }
  if (!request.locals.empty()) {
    const auto own = std::count_if(frames_.begin(), frames_.end(),
                                   [](const Frame& other) { return !other.locals.empty(); });
    const int most = table_.dialect().max_macro_depth;
    if (own >= most) {
      report("call_depth", request.place,
             "more than " + std::to_string(most) + " macro calls inside each other");
      statistics_.limit_reached = true;
      stop();
      return false;
    }
  }
  return push_frame(std::move(frame), std::move(what));
}

void Interpreter::Impl::call_macro_b(const FlowRequest& request) {
  if (request.repeats == 0) return;
  const bool macro = request.kind == FlowRequest::Kind::macro_call;
  push_program(request, (macro ? "G65 P" : "M98 P") + std::to_string(request.label));
}

// How many of the macros in force count for the block that is executed: the moves of the n-th one's
// macro call the one before it, those of the program that gave them call the last.
std::size_t Interpreter::Impl::modal_level() const {
  for (auto frame = frames_.rbegin(); frame != frames_.rend(); ++frame)
    if (frame->modal_call > 0) return frame->modal_call - 1;
  return modal_macros_.size();
}

void Interpreter::Impl::change_modal_macros(const FlowRequest& request) {
  if (modal_level() != modal_macros_.size())
    return report(
        "unsupported_code", request.place,
        "G66 or G67 inside a macro that G66 has called is not implemented; give it in the "
        "program that calls");
  if (request.kind == FlowRequest::Kind::modal_end) {
    if (!modal_macros_.empty()) modal_macros_.pop_back();
    return;
  }
  const auto most = static_cast<std::size_t>(table_.dialect().max_macro_depth);
  if (modal_macros_.size() >= most) {
    report("call_depth", request.place,
           "more than " + std::to_string(most) + " G66 in force at once; give G67 before");
    statistics_.limit_reached = true;
    return stop();
  }
  modal_macros_.push_back({request.label, request.repeats, request.locals, request.each_block});
  if (request.each_block) call_modal_macro(request, modal_macros_.size());
}

// The macro of the `level`-th G66 in force, with the arguments and the place of `request`.
void Interpreter::Impl::call_modal_macro(FlowRequest request, std::size_t level) {
  const ModalMacro& macro = modal_macros_[level - 1];
  if (macro.repeats == 0) return;
  request.label = macro.label;
  request.repeats = macro.repeats;
  if (push_program(request, (macro.each_block ? "G66.1 P" : "G66 P") + std::to_string(macro.label)))
    frames_.back().modal_call = level;
}

void Interpreter::Impl::modal_macro_call(const BlockRun& run) {
  if (!run.motion_rule || !run.has_axis_words() || run.motion_rule->code == 800) return;
  const std::size_t level = modal_level();
  if (level == 0 || modal_macros_[level - 1].each_block) return;
  FlowRequest request;
  request.locals = modal_macros_[level - 1].locals;
  request.place = run.whole();
  call_modal_macro(std::move(request), level);
}

// Statements, comments and G67 are executed under G66.1; the words of other blocks are arguments.
bool Interpreter::Impl::is_handed_over(const Block& block) const {
  const std::size_t level = modal_level();
  if (level == 0 || !modal_macros_[level - 1].each_block || block.words.empty()) return false;
  return &block != &handed_ &&
         std::none_of(block.words.begin(), block.words.end(), [](const Word& word) {
           return word.rule && word.rule->handler == end_modal_macro;
         });
}

// The modal G codes of the block act, all else is handed to the macro.
void Interpreter::Impl::hand_over(Block& block) {
  for (const Fault& warning : block.warnings)
    if (std::string_view(warning.kind) == "duplicate_word")
      return report(
          "unsupported_code", warning.place,
          "a block that G66.1 hands to its macro may have each letter once; here one stands twice");
  handed_ = block;
  handed_.following = nullptr;
  handed_.plain_move = false;
  handed_.words.clear();
  handed_.macro_words.clear();
  handed_.slot.fill(-1);
  handed_.letters = 0;
  handed_.has_rules = false;
  for (const Word& word : block.words) {
    if (word.letter == 'M' && word.rule && word.rule->phase == Phase::stop &&
        word.rule->handler != program_stop)
      return report("unsupported_code", word.place,
                    name_of(*word.rule) +
                        " in a block that G66.1 hands to its macro would be an argument; give G67 "
                        "before");
    handed_.macro_words.push_back(word);
    if (word.letter != 'G') continue;
    const bool modal = word.rule && word.rule->group != ModalGroup::non_modal &&
                       word.rule->group != ModalGroup::macro_call &&
                       word.rule->group != ModalGroup::free;
    if (!modal)
      return report("unsupported_code", word.place,
                    "in a block that G66.1 hands to its macro only modal codes act; give G67 "
                    "before this one");
    handed_.has_rules = true;
    handed_.letters |= letter_bit('G');
    handed_.words.push_back(word);
  }
  execute_words(handed_);
}

void Interpreter::Impl::call_local(const FlowRequest& request) {
  if (request.repeats == 0) return;
  Frame frame;
  frame.file = frames_.back().file;
  const auto target = flow_of(*frame.file).find_block(request.label, block_->begin);
  if (!target)
    return report("label_missing", request.place,
                  "there is no block N" + std::to_string(request.label) + " in this program");
  if (target->loop >= 0)
    return report("flow_syntax", request.place,
                  "N" + std::to_string(request.label) + " is inside a loop, which M97 can't enter");
  frame.fanuc = true;
  frame.header_seen = true;
  frame.program = frames_.back().program;
  frame.repeats = request.repeats;
  frame.start = {target->place.begin, target->place.begin, target->place.line - 1};
  push_frame(std::move(frame), "M97 P" + std::to_string(request.label));
}

// Back to the caller, to its block N P, or once more. In the main program, and on Haas everywhere,
// M99 P is a jump.
void Interpreter::Impl::return_macro_b(const FlowRequest& request) {
  const bool jumps = request.block && table_.dialect().return_jumps;
  if (frames_.size() == 1 || jumps) {
    if (request.block) jump_to_block(*request.block, request.place);
    return;
  }
  Frame& frame = frames_.back();
  if (frame.repeats > 1 && !request.block) {
    --frame.repeats;
    frame.loops.clear();
    frame.at = frame.start.after;
    frame.line = frame.start.line;
    frame.last = frame.upcoming = nullptr;
    if (!frame.locals.empty()) {
      parameters_.leave();
      parameters_.enter_macro(frame.locals);
    }
    return;
  }
  const auto call_site = frame.call_site;
  const SourceSpan at = span_of(request.place);
  return_from_call();
  if (!request.block) return;
  Frame& caller = frames_.back();
  const auto target = flow_of(*caller.file).find_block(*request.block, call_site);
  if (!target) {
    diagnostics_.error(
        "label_missing", at,
        "there is no block N" + std::to_string(*request.block) + " in the calling program");
    if (!options_.keep_going) stop();
    return;
  }
  leave_loops_for(*target);
  caller.at = target->place.begin;
  caller.line = target->place.line - 1;
  caller.last = caller.upcoming = nullptr;
}

}  // namespace aircut::interp
