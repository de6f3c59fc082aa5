// log: the joint log. Columns and header keys are described in docs/joint-log.md.
// Units of the file: mm, degrees, seconds.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "sim/sim.h"

namespace aircut::log {

struct JointLogOptions {
  double period = 0.001;  ///< s
  int every = 1;          ///< write each n-th sample
  std::string program;    ///< name in the header
  std::string program_sha256;
  std::string machine_sha256;
  /// What overrides may make of the programmed feed; empty without any.
  std::vector<double> feed_factors = {};
};

/// The most that a joint does, by differences of the rows; the machine stands before and after.
struct JointPeak {
  struct At {
    double value = 0;  ///< mm or degrees per s, s², s³
    double t = 0;      ///< s
    std::uint64_t line = 0;
  };
  std::array<At, 3> of;  ///< speed, acceleration, jerk
};

/// How far the tip can be from the path between two rows when the drives join them by straights of
/// the joints.
struct ChordError {
  double value = 0;  ///< mm, at most
  double t = 0;      ///< s
  std::uint64_t line = 0;
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
  /// By joint, after on_finish; empty when not every sample was written.
  const std::vector<JointPeak>& peaks() const;
  /// The largest of all rows, after on_finish; nothing when not every sample was written.
  std::optional<ChordError> chord_error() const;

 private:
  CsvJointLog();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace aircut::log
