// A turning cycle with a contour takes two steps. When its block is executed it asks for the
// contour: the blocks of a sub, or those from one N number to another, are run with all their
// expressions, loops and calls, but their moves go to a ContourReader instead of to the machine.
// Behind the last of them the state is again as before, and the cycle's handler is called a second
// time, with the contour.
#include "interp/codes/codes.h"
#include "interp/impl.h"

namespace aircut::interp {

void Interpreter::Impl::start_contour(const FlowRequest& request, const CodeRule& rule) {
  const std::string label = std::to_string(request.label);
  const Place place = block_->find('Q') ? block_->find('Q')->place : Place{0, block_->length};
  if (contour_frame_ >= 0)
    return report("contour_error", place, "a contour can't be cut within another contour");
  auto reading = std::make_unique<ContourReading>();
  reading->cycle = *block_;
  reading->span = span();
  reading->rule = &rule;
  reading->before = state_;
  if (request.is_range) return start_contour_range(request, std::move(reading));
  ProgramFile* file = find_sub(label, *block_, place);
  if (!file) return;
  const int at = file->flow->find_sub(label);
  FlowEntry& sub = file->flow->entries[static_cast<std::size_t>(at)];
  if (sub.fault != FlowFault::none) {
    FlowProblem problem = file->flow->problem_of(at);
    return report(problem.kind, place, std::move(problem.text));
  }
  if (!sub.passed && file == frames_.front().file) sub.called_ahead = true;
  sub.passed = true;
  const std::vector<double> no_arguments;
  if (!enter_sub(*file, at, &no_arguments, name_of(rule) + " contour o" + label)) return;
  frames_.back().reading = std::move(reading);
  contour_frame_ = static_cast<int>(frames_.size()) - 1;
  state_.motion = 0;
  state_.tip = request.contour_start;
}

// Blocks of the same program; variables are those of the cycle's own level.
void Interpreter::Impl::start_contour_range(const FlowRequest& request,
                                            std::unique_ptr<ContourReading> reading) {
  auto call = std::make_shared<CallFrame>();
  call->site = span();
  call->what = name_of(*reading->rule) + " contour";
  reading->last = request.target;
  reading->jump_behind = request.jump_behind;
  Frame frame;
  frame.file = frames_.back().file;
  frame.at = request.first.begin;
  frame.line = request.first.line - 1;
  frame.calls = std::move(call);
  frame.reading = std::move(reading);
  frames_.push_back(std::move(frame));
  contour_frame_ = static_cast<int>(frames_.size()) - 1;
  state_.motion = 0;
  state_.tip = request.contour_start;
}

// True when the last block of a range has been read.
bool Interpreter::Impl::leave_contour_range() {
  if (contour_frame_ + 1 != static_cast<int>(frames_.size())) return false;
  const Frame& frame = frames_.back();
  if (!frame.reading->last || frame.at <= frame.reading->last->begin) return false;
  std::unique_ptr<ContourReading> reading = std::move(frames_.back().reading);
  frames_.pop_back();
  span_valid_ = false;
  if (reading->jump_behind) {
    Frame& program = frames_.back();
    program.at = reading->last->after;
    program.line = reading->last->line;
    program.last = nullptr;
  }
  finish_contour(std::move(reading));
  return true;
}

// In place of execute_words while a contour is read.
void Interpreter::Impl::read_contour_block(Block& block) {
  ContourReading& reading = *frames_[static_cast<std::size_t>(contour_frame_)].reading;
  next_ = state_;
  BlockRun run(session_, block, next_, *this, queue_);
  if (BlockExecutor(run, block).values()) reading.reader.read(run);
  if (!run.ok()) {
    parameters_.roll_back();
    reading.failed = true;
    return report(*run.fault());
  }
  parameters_.commit();
  for (const Fault& warning : run.warnings()) warn(warning);
  state_ = next_;
}

// The frame that read the contour has been left.
void Interpreter::Impl::finish_contour(std::unique_ptr<ContourReading> reading) {
  contour_frame_ = -1;
  state_ = reading->before;
  finished_reading_ = std::move(reading);
  ContourReading& done = *finished_reading_;
  block_ = &done.cycle;
  span_ = done.span;
  span_valid_ = true;
  if (done.failed) return remember_failure(done.cycle);
  const std::size_t first = queue_.size();
  next_ = state_;
  BlockRun run(session_, done.cycle, next_, *this, queue_);
  run.contour = &done.reader;
  std::string problem, doubt;
  if (!done.reader.finish(problem, doubt))
    run.error("contour_error", *done.rule, problem);
  else
    done.rule->handler(*done.rule, run);
  if (!doubt.empty()) run.warning("control_setting", run.place(*done.rule), doubt);
  if (!run.ok()) {
    queue_.shorten(first);
    parameters_.roll_back();
    report(*run.fault());
    return remember_failure(done.cycle);
  }
  parameters_.commit();
  for (const Fault& warning : run.warnings()) warn(warning);
  state_ = next_;
  idle_blocks_ = 0;
}

}  // namespace aircut::interp
