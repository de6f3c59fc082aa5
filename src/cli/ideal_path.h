// What a program asks for, as pieces of path: the judge's side of a joint log. Only the interpreter
// is used, nothing of the planner.
#pragma once

#include "cli/job.h"
#include "logbook/logbook.h"

namespace aircut::cli {

/// Reads a program's commands one after the other.
class IdealPath {
 public:
  /// Interpreter and job outlive this.
  IdealPath(interp::Interpreter& interpreter, const AxisValues& start, bool straight_rapids);

  /// The next piece with way; false at the end.
  bool next(logbook::IdealPiece& out);
  /// What could not be turned into a path or a feed.
  const std::vector<std::string>& unchecked() const { return unchecked_; }

 private:
  void state(const canon::Command& command);
  bool piece(const canon::Command& command, logbook::IdealPiece& out);
  double feed(const canon::Command& command, const logbook::IdealPiece& piece,
              const AxisValues& end);
  void not_checked(const std::string& what);

  interp::Interpreter& interpreter_;
  bool straight_rapids_;
  AxisValues tip_, tool_offset_;
  canon::FeedMode feed_mode_ = canon::FeedMode::per_minute;
  canon::SetFeedRate rate_;
  double tolerance_ = 0, merge_ = 0;  ///< P, Q
  bool blends_ = true;
  double rpm_ = 0;
  bool surface_speed_ = false;
  bool probed_ = false;  ///< a probing move came: what follows depends on what it met
  std::optional<logbook::IdealPiece> back_;  ///< of a rigid tap
  std::vector<std::string> unchecked_;
};

}  // namespace aircut::cli
