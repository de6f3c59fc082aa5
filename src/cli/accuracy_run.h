// `run --accuracy FILE`: the accuracy stage beside the virtual machine. What is wrong with its file
// stops this stage and never the others.
#pragma once

#include "cli/job.h"
#include "render/render.h"
#include "report/accuracy_along.h"
#include "sim/channels.h"
#include "sim/cuts.h"

namespace aircut::cli {

class AccuracyRun {
 public:
  /// Reads the file. Error: it can't be read at all.
  Expected<void> open(Job& job, const std::string& path);
  /// Listens to the cuts; with a folder, a row of each goes to its accuracy.csv.
  Expected<void> attach(sim::Simulator& simulator, const std::string& folder);
  Expected<void> attach(sim::ChannelRun& run, const std::string& folder);
  /// Adds findings, what is not known, and the results to the report.
  void finish(report::RunReport& report);
  /// What is wrong with the file: shown, but nothing that the verdict on collisions hangs on.
  const std::vector<Diagnostic>& file_errors() const { return file_.list(); }
  /// Writes accuracy.json, accuracy.csv and the diagrams and lists them in the report.
  Expected<void> write(const std::string& folder, report::RunReport& report);
  /// accuracy-part.ply and, with a size, accuracy-part.png: the errors on what is left of the
  /// stock.
  Expected<void> write_part(const std::string& folder, const std::optional<TriangleMesh>& part,
                            std::optional<render::FrameSize> picture, report::RunReport& report);
  bool on() const { return !path_.empty(); }

 private:
  Expected<void> write_rows(const std::string& folder);
  Expected<void> draw(const std::string& folder, bool over_time, report::RunReport& report) const;

  std::string path_, sha256_;
  Diagnostics file_, found_;
  std::optional<accuracy::Setup> setup_;
  std::unique_ptr<process::Along> along_;
  std::shared_ptr<report::AccuracyAlong> result_;
};

}  // namespace aircut::cli
