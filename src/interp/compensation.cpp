#include "interp/compensation.h"

#include "interp/run.h"

namespace aircut::interp {

void Compensator::move(BlockRun& run, const PlannedMove&) {
  run.error("unsupported_code", run.whole(), "radius compensation is not implemented here");
}
void Compensator::flush(BlockRun& run) {
  for (canon::Command& command : held_) run.release(std::move(command));
  held_.clear();
}
void Compensator::start(const ModalState&) { held_.clear(); }

}  // namespace aircut::interp
