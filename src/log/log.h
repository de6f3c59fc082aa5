// log: the joint log. Columns and header keys are described in docs/joint-log.md.
// Units of the file: mm, degrees, seconds.
#pragma once

#include <memory>
#include <string>

#include "sim/sim.h"

namespace aircut::log {

struct JointLogOptions {
  double period = 0.001;  ///< s
  int every = 1;          ///< write each n-th sample
  std::string program;    ///< name in the header
  std::string program_sha256;
  std::string machine_sha256;
};

/// Samples q(t) at every period and writes `joints.csv`; complete or absent.
class CsvJointLog final : public sim::Observer {
 public:
  static Expected<std::unique_ptr<CsvJointLog>> create(const std::string& path,
                                                       const machine::Machine& machine,
                                                       JointLogOptions options);
  ~CsvJointLog() override;
  void on_start(const sim::Scene& scene, const sim::JointVector& joints) override;
  void on_step(const sim::Step& step) override;
  void on_finish(const sim::Summary& summary) override;
  /// Result of the commit, after on_finish.
  Expected<void> result() const;

 private:
  CsvJointLog();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace aircut::log
