// What becomes of a move that waits for its corner when the next block brings none.
#include "interp/impl.h"

namespace aircut::interp {

// The error belongs to the word of the corner; the block that has come is innocent.
void Interpreter::Impl::give_up_corner(const Block& block, const std::string& message) {
  SourceSpan at = session_.held->head.span;
  at.begin += session_.held->place.begin;
  at.length = session_.held->place.length;
  if (reported_.emplace(at.text, at.begin, "corner_error").second)
    diagnostics_.error("corner_error", at, message);
  if (!options_.keep_going) stop();
  release_corner(block);
}

// The move is made as it is programmed, so that what follows starts from the right place.
void Interpreter::Impl::release_corner(const Block& block) {
  next_ = state_;
  BlockRun run(session_, block, next_, *this, queue_);
  release_held(run);
  state_ = next_;
  idle_blocks_ = 0;
}

}  // namespace aircut::interp
