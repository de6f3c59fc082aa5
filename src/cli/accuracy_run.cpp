#include "cli/accuracy_run.h"

#include "geometry/split_edges.h"
#include "logbook/logbook.h"
#include "report/accuracy_map.h"

namespace aircut::cli {

namespace {

// Of the map on the part: edges in its diagonal, and a bound for its time and size.
constexpr double map_edges = 80;
constexpr std::size_t most_map_triangles = 1'000'000;

}  // namespace

Expected<void> AccuracyRun::open(Job& job, const std::string& path) {
  const auto text = job.sources.open(path);
  if (!text) return unexpected(text.error());
  path_ = path;
  sha256_ = sha256((*text)->content());
  job.inputs.push_back({"accuracy", path, sha256_});
  setup_ = accuracy::read_setup(**text, file_);
  if (setup_ && job.machine) {
    along_ = std::make_unique<process::Along>(*setup_, job.machine, file_);
    if (file_.errors() > 0) along_.reset();
  }
  return {};
}

Expected<void> AccuracyRun::attach(sim::Simulator& simulator, const std::string& folder) {
  if (along_) simulator.listen_to_cuts(*along_);
  return write_rows(folder);
}

Expected<void> AccuracyRun::attach(sim::ChannelRun& run, const std::string& folder) {
  if (along_) run.listen_to_cuts(*along_);
  return write_rows(folder);
}

Expected<void> AccuracyRun::write_rows(const std::string& folder) {
  if (!along_ || folder.empty()) return {};
  along_->keep_places();
  return along_->write_to(folder + "/accuracy.csv");
}

void AccuracyRun::finish(report::RunReport& report) {
  if (!on()) return;
  auto& unchecked = report.summary.unchecked;
  if (!along_) {
    unchecked.push_back("the accuracy: '" + path_ + "' is wrong");
    return;
  }
  report.checks.push_back("accuracy");
  result_ = std::make_shared<report::AccuracyAlong>();
  result_->file = path_;
  result_->setup = *setup_;
  process::Summary& sum = result_->summary;
  sum = along_->finish(found_);
  if (!report.summary.stock)
    sum.unchecked.push_back(
        "the accuracy: it is not known what the tools cut (no stock, or it was lost)");
  else if (sum.stretches == 0)
    sum.unchecked.push_back("the accuracy: nothing was cut");
  result_->verdict = found_.errors() > 0 ? "fail" : sum.unchecked.empty() ? "pass" : "unknown";
  for (const Diagnostics* list : {&file_, &found_})
    for (const Diagnostic& d : list->list())
      if (list == &found_ || d.severity != Severity::error) report.diagnostics.push_back(d);
  unchecked.insert(unchecked.end(), sum.unchecked.begin(), sum.unchecked.end());
  report.accuracy = result_;
}

Expected<void> AccuracyRun::draw(const std::string& folder, bool over_time,
                                 report::RunReport& report) const {
  logbook::Diagram diagram;
  diagram.title = over_time ? "Predicted error of the surface over time"
                            : "Predicted error of the surface over the way in the material";
  diagram.x_name = over_time ? "t, s" : "cut way, mm";
  diagram.y_name = "error, µm (positive: material left)";
  for (const process::ToolSummary& tool : result_->summary.tools)
    diagram.curves.push_back({"T" + std::to_string(setup_->tools[tool.tool].id),
                              (over_time ? tool.over_time : tool.over_way).points()});
  if (diagram.curves.empty()) return {};
  const auto png = logbook::draw(diagram);
  if (!png) return unexpected(png.error());
  const std::string name = over_time ? "accuracy-time.png" : "accuracy-path.png";
  report.outputs.push_back(name);
  return write_file(folder + "/" + name, *png);
}

Expected<void> AccuracyRun::write(const std::string& folder, report::RunReport& report) {
  if (!result_) return {};
  if (auto done = along_->result(); !done) return done;
  std::vector<Diagnostic> all = file_.list();
  all.insert(all.end(), found_.list().begin(), found_.list().end());
  if (auto done = write_file(folder + "/accuracy.json",
                             report::along_json(*result_, report.version, sha256_, all));
      !done)
    return done;
  for (const char* name : {"accuracy.json", "accuracy.csv"}) report.outputs.push_back(name);
  for (const bool over_time : {true, false})
    if (auto done = draw(folder, over_time, report); !done) return done;
  return {};
}

Expected<void> AccuracyRun::write_part(const std::string& folder,
                                       const std::optional<TriangleMesh>& part,
                                       std::optional<render::FrameSize> picture,
                                       report::RunReport& report) {
  if (!result_ || !part || part->empty() || result_->summary.stretches == 0) return {};
  const TriangleMesh mesh =
      with_short_edges(*part, bounds(*part).diagonal().norm() / map_edges, most_map_triangles);
  const auto errors = along_->on_part(mesh);
  report.outputs.push_back("accuracy-part.ply");
  if (auto done = write_file(folder + "/accuracy-part.ply", report::error_ply(mesh, errors)); !done)
    return done;
  if (!picture) return {};
  const auto image = report::error_picture(mesh, errors, *picture);
  if (!image) return unexpected(image.error());
  report.outputs.push_back("accuracy-part.png");
  return write_file(folder + "/accuracy-part.png", render::png_bytes(*image));
}

}  // namespace aircut::cli
