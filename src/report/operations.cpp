// CAM systems write the name of an operation as a comment in front of it, often behind other
// comments (the program's name, the tool). So the last comment before something takes time is its
// name; a tool change after a feed move, without a comment since, begins one without a name.
//
//   (POCKET)  T2 M6  G0 … G1 …   (CONTOUR)  G0 … G1 …   T3 M6  G0 …
//   └ POCKET ──────────────────┘└ CONTOUR ────────────┘└ (line of M6) ─
#include "report/operations.h"

namespace aircut::report {

Operation& Operations::current(const sim::Step& step) {
  constexpr std::size_t most = 1000;
  if (list_.empty() || (begins_ && list_.size() < most)) {
    Operation next;
    next.name = name_;
    next.line = line_ > 0 ? line_ : step.span().line;
    list_.push_back(std::move(next));
    begins_ = false;
    name_.clear();
    line_ = 0;
  }
  return list_.back();
}

void Operations::on_step(const sim::Step& step) {
  const plan::Segment& segment = step.segment;
  if (const auto* message = std::get_if<canon::Message>(&segment.command.action);
      message && message->kind == canon::Message::Kind::comment && !message->text.empty()) {
    begins_ = true;
    name_ = message->text;
    line_ = step.span().line;
  }
  const auto* change = std::get_if<canon::ChangeTool>(&segment.command.action);
  // The way to the change belongs to the operation that the comment before it has named.
  if (change && !begins_ && !list_.empty() && list_.back().feed > 0) {
    begins_ = true;
    line_ = step.span().line;
  }
  const double time = segment.duration();
  if (!(time > 0)) return;
  Operation& operation = current(step);
  operation.time += time;
  operation.tool = change ? change->number : segment.tool;
  const plan::TimeUse use = plan::time_use(segment);
  if (use == plan::TimeUse::rapid) operation.rapid += time;
  if (use == plan::TimeUse::feed) operation.feed += time;
  if (use == plan::TimeUse::tool_change) operation.tool_change += time;
}

}  // namespace aircut::report
