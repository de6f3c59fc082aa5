// What each executed block took, and what held it: rows of lines.jsonl, and sums.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "base/base.h"
#include "sim/sim.h"

namespace aircut::report {

class LineTimes final : public sim::Observer {
 public:
  explicit LineTimes(const machine::Machine& machine) : machine_(machine) {}
  /// Rows go to this file, which is complete after on_finish or not there.
  Expected<void> write_to(const std::string& path);

  void on_step(const sim::Step& step) override;
  void on_finish(const sim::Summary& summary) override;
  /// Result of the commit, after on_finish.
  const Expected<void>& result() const { return result_; }
  /// Seconds by what held the speed: `feed`, `X speed`, `X acceleration`, `X jerk`, `dwell`, …
  const std::map<std::string, double>& held() const { return held_; }

 private:
  std::string cause(const plan::Segment& segment) const;
  void write_row();

  const machine::Machine& machine_;
  std::optional<OutputFile> file_;
  Expected<void> result_ = {};
  std::map<std::string, double> held_;

  /// The block that is being carried out.
  struct Row {
    SourceSpan span;
    std::uint64_t block = 0;
    double t0 = 0, t1 = 0;
    double length = 0;    ///< mm, or rad when only rotary axes move
    double min_feed = 0;  ///< per second
    bool moves = false, rotary = false;
    std::map<std::string, double> held;
  };
  std::optional<Row> row_;
};

}  // namespace aircut::report
