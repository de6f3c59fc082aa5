// process: what the cutting forces do along a program. Every stretch that the virtual machine cuts
// (sim/cuts.h) becomes a contact of the elastic model (accuracy/): its force from the material's
// law, the displacement of tool against work, the error of the surface. What comes of it is
// gathered while the program runs: a table on disk, the worst places of each tool, named sizes.
//
// Units inside are mm, N, rad, s; places are those of the machine's frame M with all joints at
// zero.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "accuracy/accuracy.h"
#include "base/output_file.h"
#include "sim/cuts.h"

namespace aircut::process {

using accuracy::Setup;

/// The largest of something, and where.
struct Worst {
  double value = 0;
  SourceSpan span;
  double t = 0;          ///< s
  std::size_t over = 0;  ///< stretches beyond the limit
  void offer(double candidate, const sim::Cut& cut) {
    if (candidate <= value && span) return;
    value = candidate;
    span = cut.span;
    t = cut.t0;
  }
};

/// A line of a diagram that stays short however many points it is given: of neighbours the larger
/// one is kept.
class Track {
 public:
  void add(double x, double y);
  const std::vector<std::pair<double, double>>& points() const { return points_; }

 private:
  static constexpr std::size_t most = 4096;
  std::vector<std::pair<double, double>> points_;
  std::size_t stride_ = 1, waiting_ = 0;
};

/// Of one tool over the whole program.
struct ToolSummary {
  std::size_t tool = 0;  ///< place in Setup::tools
  std::size_t stretches = 0;
  double time = 0, volume = 0;                   ///< s in the material, mm³
  Worst force, power, torque, chip, deflection;  ///< N, kW, N·mm, mm, mm
  Worst most, least;           ///< error of the surface, mm; `least` with its sign turned
  double mean = 0;             ///< of it, weighted with time
  std::vector<double> shares;  ///< of each body in the mean
  Track over_time, over_way;   ///< error in µm over s, over mm of cut
};

struct Summary {
  std::size_t stretches = 0;
  double time = 0;                                    ///< s
  std::vector<ToolSummary> tools;                     ///< those that cut
  std::vector<accuracy::DimensionResult> dimensions;  ///< as in Setup::dimensions
  std::vector<std::string> unchecked;                 ///< what is not known, in words
  std::vector<std::string> sources;                   ///< of the coefficients
};

class Along final : public sim::CutListener {
 public:
  /// Both outlive it. Errors of the file against this machine go to `out`.
  Along(const Setup& setup, std::shared_ptr<const machine::Machine> machine, Diagnostics& out);
  ~Along() override;
  /// A row per stretch and contact.
  Expected<void> write_to(const std::string& path);
  /// Keeps where each stretch went, for on_part().
  void keep_places();
  /// For each triangle of the part's mesh (stock's frame) the predicted error of the last cut that
  /// made it, mm; nothing where no known cut did.
  std::vector<std::optional<double>> on_part(const TriangleMesh& mesh) const;

  void on_cut(const sim::Cut& cut) override;
  /// Findings and warnings go to `out`.
  Summary finish(Diagnostics& out);
  /// Error of the table, if any.
  Expected<void> result();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace aircut::process
