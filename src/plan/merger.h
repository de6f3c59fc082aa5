// Private: replacing chains of short lines by their chord (G64 Q).
#pragma once

#include "plan/shaper.h"

namespace aircut::plan {

/// Stands before the shaper; moves that can't be merged go straight through.
class Merger {
 public:
  explicit Merger(Shaper& shaper) : shaper_(shaper) {}

  void push(Move move);
  void push_still(Segment segment);
  void stop();

 private:
  bool extends(const Move& move) const;
  void release();

  Shaper& shaper_;
  std::vector<Move> group_;                  ///< lines in order, replaced by one chord
  std::vector<std::vector<Segment>> after_;  ///< stand-still segments behind each
};

}  // namespace aircut::plan
