// The commands of a block on their way out. Their places are used again and again: making a command
// anew for every move costs more than most of what the move itself does.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "canon/canon.h"

namespace aircut::interp {

class CommandQueue {
 public:
  std::size_t size() const { return size_; }
  canon::Command& operator[](std::size_t at) { return places_[at]; }

  /// One more command, without calls and without a text. Action and place are those of some command
  /// before; the caller sets them.
  canon::Command& add() {
    if (size_ == places_.size()) places_.emplace_back();
    canon::Command& command = places_[size_++];
    command.expanded.clear();
    return command;
  }
  void push_back(canon::Command command) { add() = std::move(command); }

  /// Forgets all but the first `count` commands. Nobody is told any longer to keep their calls.
  void shorten(std::size_t count) {
    for (std::size_t i = count; i < size_; ++i)
      if (places_[i].span.calls) places_[i].span.calls.reset();
    size_ = count;
    if (size_ == 0 && places_.size() > most_kept) places_.resize(most_kept);
  }

 private:
  static constexpr std::size_t most_kept = 64;

  std::vector<canon::Command> places_;  ///< those in use first
  std::size_t size_ = 0;
};

}  // namespace aircut::interp
