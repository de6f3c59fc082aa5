// The loop over the lines: fetch, execute, keep or forget.
#include <algorithm>
#include <utility>

#include "base/text.h"
#include "interp/codes/codes.h"
#include "interp/dialect.h"
#include "interp/dialect_guess.h"
#include "interp/impl.h"
#include "interp/interp.h"
#include "interp/lexer.h"
#include "interp/macro_expression.h"

namespace aircut::interp {
namespace {

constexpr std::size_t most_kept = 24 << 20;  // bytes of the lines of loops and subs kept parsed
constexpr std::size_t max_reported = 10'000;

bool is_percent(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t");
  return first != std::string_view::npos && line[first] == '%' &&
         line.find_first_not_of(" \t", first + 1) == std::string_view::npos;
}

// What a parsed line takes, about.
std::size_t bytes_of(const Block& block) {
  return sizeof(Block) + block.words.capacity() * sizeof(Word) +
         block.code.capacity() * sizeof(Instruction) + block.settings.capacity() * sizeof(Setting) +
         block.oword.arguments.capacity() * (sizeof(Value) + sizeof(Place)) + 64;
}

// Motion or dwell: the alternatives that stand first in canon::Action.
bool takes_time(const canon::Action& action) {
  return action.index() <= canon::Action(canon::Probe{}).index();
}

}  // namespace

// ---- public face -----------------------------------------------------------------------------

Interpreter::Interpreter(const SourceText& program, const tool::ToolTable& tools,
                         const ParameterFile& parameters, Options options, SourceReader reader,
                         Diagnostics& diagnostics)
    : impl_(std::make_unique<Impl>(program, tools, parameters, std::move(options),
                                   std::move(reader), diagnostics)) {}
Interpreter::~Interpreter() = default;
canon::Command* Interpreter::next() { return impl_->next(); }
void Interpreter::resume(const ProbeHit& hit) { impl_->resume(hit); }
void Interpreter::synchronise(const AxisValues& tip) { impl_->synchronise(tip); }
ParameterFile Interpreter::parameters() const { return impl_->parameters(); }
Interpreter::Statistics Interpreter::statistics() const { return impl_->statistics(); }

std::vector<Interpreter::CodeCount> Interpreter::code_counts() const {
  return impl_->code_counts();
}

canon::Command* Interpreter::Impl::next() {
  while (head_ >= queue_.size()) {
    queue_.shorten(0);
    head_ = 0;
    if (done_) return nullptr;
    step();
  }
  return &queue_[head_++];
}

// ---- lines -----------------------------------------------------------------------------------

void Interpreter::Impl::parse_into(Frame& frame, Block& block) {
  const std::string_view text = frame.file->text->content();
  const LineExtent extent = find_line_end(text, frame.at, &frame.file->reading);
  std::uint64_t end = extent.end;
  while (end > frame.at && (text[end - 1] == ' ' || text[end - 1] == '\t')) --end;
  block.clear();
  block.begin = frame.at;
  block.line = frame.line + 1;
  block.length = static_cast<std::uint32_t>(std::min<std::uint64_t>(end - frame.at, 0xffffffff));
  block.next_begin = extent.next;
}

// A line that is executed again and again is parsed once. Such blocks are chained, so that going
// on to the next line needs no search.
Block* Interpreter::Impl::parse_cached(Frame& frame) {
  if (Block* known = std::exchange(frame.upcoming, nullptr)) return known;
  if (frame.last && frame.last->following && frame.last->next_begin == frame.at)
    return frame.last->following;
  auto& blocks = frame.file->blocks;
  const auto found = blocks.find(frame.at);
  if (found != blocks.end()) {
    if (frame.last && frame.last->next_begin == frame.at)
      frame.last->following = found->second.get();
    return found->second.get();
  }
  return nullptr;
}

Block* Interpreter::Impl::fetch() {
  Frame& frame = frames_.back();
  const bool repeated = frames_.size() > 1 || !frame.loops.empty() || frame.jumped;
  Block* block = repeated ? parse_cached(frame) : nullptr;
  if (block) {
    frame.at = block->next_begin;
    frame.line = block->line;
    frame.last = block;
    block_ = block;
    span_valid_ = false;
    return block;
  }
  const bool keep = repeated && kept_bytes_ < most_kept;
  std::unique_ptr<Block> own = keep ? std::make_unique<Block>() : nullptr;
  block = keep ? own.get() : &scratch_;
  parse_into(frame, *block);
  block_ = block;
  span_valid_ = false;
  const std::string_view line = frame.file->text->content().substr(block->begin, block->length);
  frame.at = block->next_begin;
  frame.line = block->line;
  if (is_percent_line(*frame.file, line)) {
    frame.last = nullptr;
    if (own) refused_ = std::move(own);
    if (frames_.size() > 1 || percent_seen_ || !frame.file->percent) {
      if (frames_.size() > 1 || table_.dialect().macro_b) {
        end_of_file();
      } else {
        statistics_.ended = true;
        stop();
      }
      return nullptr;
    }
    percent_seen_ = true;
    return nullptr;
  }
  if (const auto fault = parse_line(line, parameters_, table_, *block)) {
    frame.last = nullptr;
    if (own) refused_ = std::move(own);  // messages still refer to it
    if (block->block_delete && options_.block_delete) return nullptr;
    ++statistics_.lines;
    report(*fault);
    remember_failure(*block);
    return nullptr;
  }
  if (!keep) {
    frame.last = nullptr;
    return block;
  }
  kept_bytes_ += bytes_of(*block);
  if (frame.last && frame.last->next_begin == block->begin) frame.last->following = block;
  frame.last = block;
  frame.file->blocks.emplace(block->begin, std::move(own));
  return block;
}

// Whatever stands behind `%` is not read by controls with macro B, and one at the end needs none at
// the begin.
bool Interpreter::Impl::is_percent_line(const ProgramFile& file, std::string_view line) const {
  if (!table_.dialect().macro_b) return file.percent && is_percent(line);
  const std::size_t first = line.find_first_not_of(" \t");
  return first != std::string_view::npos && line[first] == '%';
}

void Interpreter::Impl::step() {
  if (waiting_) return resume_line(std::move(waiting_));
  if (contour_frame_ >= 0 && leave_contour_range()) return;
  const Frame& frame = frames_.back();
  if (frame.at >= frame.file->text->content().size()) return end_of_file();
  Block* block = fetch();
  if (!block) return;
  ++statistics_.lines;
  if (block->empty || (block->block_delete && options_.block_delete)) return;
  if (!count_block()) return;
  if (block->oword.keyword >= Keyword::program)
    execute_macro(*block);
  else if (block->oword.keyword != Keyword::none)
    execute_oword(*block);
  else if (block->has_expressions && table_.dialect().macro_b)
    execute_words(without_vacant(*block));
  else
    execute_words(*block);
}

void Interpreter::Impl::end_of_file() {
  const Frame& frame = frames_.back();
  if (frames_.size() > 1) {
    report("label_missing", {0, block_ ? block_->length : 0},
           frame.fanuc ? "the sub has no end; add M99" : "the sub has no end; add endsub");
  } else if (frame.file->percent && !table_.dialect().macro_b) {
    report("percent_missing", {0, block_ ? block_->length : 0},
           "the program begins with '%' and must end with a line that holds only '%'");
  } else {
    report("program_end_missing", {0, block_ ? block_->length : 0},
           "the program has no end; add M2 or M30 as the last line");
  }
  stop();
}

// Endless programs end here. A loop is named when there is one.
bool Interpreter::Impl::count_block() {
  ++statistics_.blocks;
  ++idle_blocks_;
  const bool many = statistics_.blocks > options_.limits.max_blocks;
  if (!many && idle_blocks_ <= options_.limits.max_idle_blocks) return true;
  const std::string which =
      (many ? std::to_string(options_.limits.max_blocks) + " executed blocks"
            : std::to_string(options_.limits.max_idle_blocks) + " blocks without motion or dwell") +
      " (--max-blocks raises it)";
  for (auto frame = frames_.rbegin(); frame != frames_.rend(); ++frame) {
    if (frame->loops.empty()) continue;
    loop_limit(*frame, which);
    return false;
  }
  for (auto frame = frames_.rbegin(); frame != frames_.rend(); ++frame) {
    if (!frame->back || frame->back->count < 2) continue;
    goto_limit(*frame, which);
    return false;
  }
  warn(Fault{
      "limit_reached",
      {0, block_->length},
      "the limit of " + which + " is reached; raise it if the program is meant to be so long"});
  statistics_.limit_reached = true;
  stop();
  return false;
}

void Interpreter::Impl::run_block(BlockRun& run, Block& block, const SuspendedBlock* rest) {
  const Frame& frame = frames_.back();
  run.level = frames_.size() == 1 ? Level::main : frame.fanuc ? Level::fanuc_sub : Level::sub;
  run.saved = frame.saved ? &*frame.saved : nullptr;
  if (rest) return BlockExecutor(run, block).resume(*rest);
  BlockExecutor(run, block).execute(frame.file->text->content().substr(block.begin, block.length));
}

// The row of the code that moves, of a line of G0 to G3 (given or modal) with the words of a move
// and nothing else. Null when the table's checks would say something about the line, or when the
// state is one in which such a line changes more than the position and what is modal about it.
const CodeRule* Interpreter::Impl::plain_motion(const Block& block) const {
  const ModalState& s = state_;
  if (!block.plain_move || !block.warnings.empty() || failed_ || s.comp.side != CompSide::off ||
      s.comp.leaving || s.nurbs_points > 0 || s.turn_is_fresh || s.turn_was_left ||
      s.length_suspended || s.data_setting || s.polar.on || session_.held)
    return nullptr;
  if (block.letters & other_axes_) return nullptr;
  const CodeRule* rule = block.plain_rule;
  if (!rule) {
    const bool arc = s.motion == 20 || s.motion == 30;
    const std::uint32_t enough = axis_letters | (arc ? centre_letters : 0);
    if (s.motion > 30 || !(block.letters & enough)) return nullptr;
    rule = table_.find_g(s.motion);
  }
  const RemapSet& remaps = session_.remaps;
  if (!remaps.empty()) {
    rule = remaps.in_force(rule);
    if (remaps.of(rule) || ((block.letters & letter_bit('F')) && remaps.of('F'))) return nullptr;
  }
  constexpr std::uint32_t arc_letters = centre_letters | letter_bit('R');
  return rule && (rule->code >= 20 || !(block.letters & arc_letters)) ? rule : nullptr;
}

// What programs are made of. The code works on the state itself: when it fails, only the feed has
// changed. The table then goes through the line again and tells what is wrong with it.
bool Interpreter::Impl::plain_move(Block& block) {
  const CodeRule* rule = plain_motion(block);
  if (!rule) return false;
  const std::size_t first = queue_.size();
  const double feed = state_.feed;
  BlockRun run(session_, block, state_, *this, queue_);
  if (BlockExecutor(run, block).move(*rule)) {
    finish_words(block, run, first);
    return true;
  }
  state_.feed = feed;
  queue_.shorten(first);
  return false;
}

// A line of settings and nothing else, none of which can fail once its value is known. As above,
// the table gives the same.
bool Interpreter::Impl::plain_settings(const Block& block) {
  constexpr std::size_t most = 8;
  if (!block.words.empty() || block.comment || block.settings.size() > most || failed_ ||
      table_.dialect().macro_b)
    return false;
  std::array<double, most> values;
  std::optional<Fault> fault;
  for (std::size_t i = 0; i < block.settings.size(); ++i) {
    const Setting& setting = block.settings[i];
    if (setting.plain == 0 && (setting.name < 0 || parameters_.read_only_name(setting.name)))
      return false;
    if (!evaluate(setting.value, block.code, parameters_, values[i], fault)) return false;
  }
  for (std::size_t i = 0; i < block.settings.size(); ++i) {
    const Setting& setting = block.settings[i];
    if (setting.plain > 0)
      parameters_.write_for_good(setting.plain, values[i]);
    else
      parameters_.write_named(setting.name, values[i]);
  }
  parameters_.commit();
  return true;
}

void Interpreter::Impl::execute_words(Block& block, const SuspendedBlock* rest) {
  if (contour_frame_ >= 0) return read_contour_block(block);
  if (!modal_macros_.empty() && is_handed_over(block)) return hand_over(block);
  const bool handed = &block == &handed_;
  if (!handed && !rest && options_.fast_paths && (plain_move(block) || plain_settings(block)))
    return;
  const bool settings_only = !handed && block.words.empty() && !block.comment;
  if (settings_only && (!table_.dialect().macro_b ||
                        block.plain_settings)) {  // settings alone leave the modal state as it is
    BlockRun run(session_, block, state_, *this, queue_);
    BlockExecutor(run, block).execute({});
    if (run.ok()) {
      parameters_.commit();
      for (const Fault& warning : block.warnings) warn(warning);
      if (failed_) {
        next_ = state_;
        clear_unsure(block, state_.tip);
      }
      return;
    }
    report(*run.fault());
    return remember_failure(block);
  }
  if (session_.held && !may_follow_corner(block, state_)) {
    give_up_corner(block,
                   "behind a corner or a line by its angle the next move of G1, G2 or G3 "
                   "must follow at once; only a dwell may stand between");
    if (done_) return;
  }
  next_ = state_;
  const std::optional<HeldMove> held_before = session_.held;
  const std::size_t first = queue_.size();
  const bool comp_active = state_.comp.side != CompSide::off || state_.comp.leaving;
  std::optional<Compensator> comp_before;
  if (comp_active) comp_before = session_.compensator;
  BlockRun run(session_, block, next_, *this, queue_);
  run_block(run, block, rest);
  if (handed && run.ok() && take_block_as_arguments(run))
    run.flow.kind = FlowRequest::Kind::block_call;
  if (!run.ok()) {
    queue_.shorten(first);
    parameters_.roll_back();
    run.roll_back_tools();
    if (comp_before) session_.compensator = std::move(*comp_before);
    session_.nurbs.resize(state_.nurbs_points);
    session_.held = held_before;
    if (run.corner_failed()) {
      give_up_corner(block, run.fault()->message);
      if (!done_) execute_words(block);
      return;
    }
    // A move that does not fit between its corners is told once; a G40, M0 or M2 behind it is fine.
    if (comp_before && std::string_view(run.fault()->kind) == "comp_gouge" &&
        session_.compensator.excuse_held() && !run.has_axis_words()) {
      report(*run.fault());
      if (!done_) execute_words(block, rest);
      return;
    }
    if (held_before) release_corner(block);
    if (!follows_from_position(*run.fault(), block)) {
      report(*run.fault());
      remember_failure(block);
    }
    if (std::string_view(run.fault()->kind) == "alarm") stop();
    return;
  }
  if (failed_) clear_unsure(block, state_.tip);
  state_ = next_;
  finish_words(block, run, first);
}

// A block has succeeded: what it says, and what it asks of the flow of control. Its commands begin
// at `first` in the queue.
void Interpreter::Impl::finish_words(Block& block, BlockRun& run, std::size_t first) {
  parameters_.commit();
  Frame& frame = frames_.back();
  if (run.stack.drop) frame.saved.reset();
  if (run.stack.save) frame.saved = run.stack.save;
  if (run.stack.restore_at_return) frame.restore_at_return = true;
  for (const Fault& warning : run.warnings()) warn(warning);
  for (const Fault& warning : block.warnings) warn(warning);
  for (const Fault& info : run.infos()) inform(info);
  if (table_.dialect().macro_b) remember_words(block);
  for (std::size_t i = first; i < queue_.size(); ++i)
    if (takes_time(queue_[i].action)) idle_blocks_ = 0;
  switch (run.flow.kind) {
    case FlowRequest::Kind::none:
      if (!modal_macros_.empty()) modal_macro_call(run);
      break;
    case FlowRequest::Kind::end:
      statistics_.ended = true;
      stop();
      break;
    case FlowRequest::Kind::call:
      if (table_.dialect().macro_b)
        call_macro_b(run.flow);
      else
        call_fanuc(run.flow);
      break;
    case FlowRequest::Kind::return_:
      if (table_.dialect().macro_b)
        return_macro_b(run.flow);
      else
        return_fanuc();
      break;
    case FlowRequest::Kind::jump:
      frame.at = run.flow.target.after;
      frame.line = run.flow.target.line;
      frame.last = frame.upcoming = nullptr;
      break;
    case FlowRequest::Kind::local_call:
      call_local(run.flow);
      break;
    case FlowRequest::Kind::macro_call:
      call_macro_b(run.flow);
      break;
    case FlowRequest::Kind::modal_call:
    case FlowRequest::Kind::modal_end:
      change_modal_macros(run.flow);
      break;
    case FlowRequest::Kind::block_call:
      call_modal_macro(run.flow, modal_level());
      break;
    case FlowRequest::Kind::contour:
      start_contour(run.flow, *run.flow.cycle);
      break;
    case FlowRequest::Kind::remap:
      call_remap(*run.remap);
      break;
    case FlowRequest::Kind::kinematics:
      waiting_ = std::move(run.remap->rest);
      break;
  }
}

std::vector<Interpreter::CodeCount> Interpreter::Impl::code_counts() const {
  std::vector<CodeCount> counts;
  for (const CodeRule* rule : table_.rules())
    counts.push_back({name_of(*rule), session_.executed[CodeTable::slot(*rule)]});
  return counts;
}

void Interpreter::Impl::resume(const ProbeHit& hit) {
  state_.tip = hit.tip;
  session_.skip_position = to_work(state_, hit.tip) + state_.length_offset;
  const AxisValues work = to_program(state_, hit.tip);
  for (const Axis axis : all_axes)
    parameters_.write(number::probe_position + static_cast<int>(index(axis)),
                      work[axis] / (is_rotary(axis) ? radian_per_degree : state_.unit_mm()));
  parameters_.write(number::probe_tripped, hit.tripped ? 1 : 0);
  parameters_.commit();
}

Interpreter::Statistics Interpreter::Impl::statistics() const {
  Statistics out = statistics_;
  out.input_read = parameters_.input_was_read();
  return out;
}

void Interpreter::Impl::synchronise(const AxisValues& tip) {
  state_.tip = tip;
  tell_kinematics();
}

// What a control keeps over a restart: home positions, G92, the nine work systems, and any user
// number that the file had already.
ParameterFile Interpreter::Impl::parameters() const {
  ParameterFile file;
  if (table_.dialect().macro_b) store_offsets(file);
  const auto keep = [&](int first, int count) {
    for (int n = first; n < first + count; ++n) file.values[n] = parameters_.stored(n);
  };
  if (!table_.dialect().macro_b) {
    keep(number::g28_position, 9);
    keep(number::g30_position, 9);
    keep(number::g92_applied, 11);
    for (int system = 0; system < 9; ++system) keep(number::first_system + 20 * system, 10);
  }
  for (const int n : kept_numbers_)
    if (!table_.dialect().macro_b || n < Parameters::first_system)
      file.values[n] = parameters_.stored(n);
  if (table_.dialect().macro_b) {
    for (int n = 500; n < Parameters::first_system; ++n) file.values[n] = parameters_.stored(n);
    std::erase_if(file.values, [](const auto& entry) { return is_vacant(entry.second); });
  }
  return file;
}

// ---- messages --------------------------------------------------------------------------------

const SourceSpan& Interpreter::Impl::span() {
  if (!span_valid_) {
    span_.text = frames_.back().file->text;
    span_.begin = block_ ? block_->begin : 0;
    span_.length = block_ ? block_->length : 0;
    span_.line = block_ ? block_->line : 0;
    span_.calls.reset();
    find_calls(span_.calls);
    span_valid_ = true;
  }
  return span_;
}

SourceSpan Interpreter::Impl::span_of(Place place) {
  SourceSpan at = span();
  at.begin += place.begin;
  at.length = place.length;
  return at;
}

// An error is told once per place and kind: in a loop it would come again with every pass.
void Interpreter::Impl::report(const Fault& fault) {
  if (!options_.keep_going) stop();
  if (is_cascade(fault)) return;
  const SourceSpan at = span_of(fault.place);
  if (!reported_.emplace(at.text, at.begin, fault.kind).second) return;
  Diagnostic diagnostic = make_error(fault.kind, at, fault.message);
  if (const char* advice = dialect_advice(at)) diagnostic.notes.push_back({"help", advice});
  diagnostics_.add(std::move(diagnostic));
  if (reported_.size() == max_reported) {
    diagnostics_.error("limit_reached", at, "more than 10000 messages; the rest is not reported");
    statistics_.limit_reached = true;
    stop();
  }
}

// Help for a program that was written for another control.
const char* Interpreter::Impl::dialect_advice(const SourceSpan& at) const {
  const bool macro_b = table_.dialect().macro_b;
  const DialectSign sign = sign_of(at.line_text(), at.line <= 2);
  if (!sign.what) return nullptr;
  if (!macro_b && sign.dialect != Dialect::linuxcnc)
    return sign.dialect == Dialect::haas ? "this looks like a Haas program; try --dialect haas"
                                         : "this looks like a Fanuc program; try --dialect fanuc";
  if (macro_b && sign.dialect == Dialect::linuxcnc)
    return "this looks like a LinuxCNC program; try --dialect linuxcnc";
  return nullptr;
}

void Interpreter::Impl::report(const char* kind, Place place, std::string message) {
  report(Fault{kind, place, std::move(message)});
}

void Interpreter::Impl::warn(const Fault& fault) {
  const SourceSpan at = span_of(fault.place);
  if (reported_.size() >= max_reported || !reported_.emplace(at.text, at.begin, fault.kind).second)
    return;
  if (std::string_view(fault.kind) == "decimal_point") ++session_.points_missing;
  diagnostics_.warning(fault.kind, at, fault.message);
}

void Interpreter::Impl::inform(const Fault& fault) {
  const SourceSpan at = span_of(fault.place);
  if (!reported_.emplace(at.text, at.begin, fault.kind).second) return;
  diagnostics_.add({Severity::info, fault.kind, fault.message, at});
}

}  // namespace aircut::interp
