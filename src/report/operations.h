// The program's time by operation: a part that begins with a comment or a tool change.
#pragma once

#include "report/report.h"
#include "sim/sim.h"

namespace aircut::report {

class Operations final : public sim::Observer {
 public:
  void on_step(const sim::Step& step) override;
  /// Those that took time. What follows the thousandth counts for it.
  const std::vector<Operation>& list() const { return list_; }

 private:
  Operation& current(const sim::Step& step);

  std::vector<Operation> list_;
  bool begins_ = true;      ///< with the next step that takes time
  std::string name_;        ///< of the next one
  std::uint64_t line_ = 0;  ///< where it begins; 0: not said yet
};

}  // namespace aircut::report
