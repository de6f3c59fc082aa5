// Pictures of a run: at times, lines, tool changes and findings; and a contact sheet.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/render.h"
#include "report/view.h"
#include "sim/sim.h"

namespace aircut::report {

struct FrameSpec {
  std::optional<int> count;     ///< evenly over the run
  std::optional<double> every;  ///< s
  std::vector<double> at;       ///< s
  std::vector<std::uint32_t> lines;
  bool findings = false;
  bool tool_changes = false;

  bool any() const {
    return count || every || !at.empty() || !lines.empty() || findings || tool_changes;
  }
};
/// Adds one `--frames` value: every=2s, at=12.5,80, line=128, tool-change, finding, count=24.
/// Error kind `usage`.
Expected<void> add_frames(FrameSpec& spec, const std::string& text);

struct FrameOptions {
  FrameSpec spec;
  View view;
  render::FrameSize size;
  std::string program;         ///< for the caption
  bool motion = false;         ///< also motion.png: the sheet's pictures one after the other
  bool video = false;          ///< also motion.mp4, by ffmpeg
  bool stock_by_tool = false;  ///< every tool's surfaces in a colour of their own
  enum class Path : unsigned char { kind, time, none } path = Path::kind;  ///< colours of it
};

/// Whether motion.mp4 can be made. Error kind `output_failed`.
Expected<void> video_ready();
/// A moment of the run that may become a picture.
struct Snapshot {
  double t = 0;
  machine::JointVector joints;
  int tool = 0;
  std::vector<int> tools;  ///< by seat, where channels run at once
  SourceSpan span;
  plan::MotionKind kind = plan::MotionKind::idle;
  double feed = 0;          ///< achieved, mm/s
  Vec3 tip = Vec3::Zero();  ///< of the tool, the work's frame, mm
};

/// Bodies of a scene at joints, ready to draw.
std::vector<render::DrawBody> draw_bodies(const sim::Scene& scene,
                                          const machine::JointVector& joints);

/// Watches a run in bounded memory and draws afterwards.
class FrameMaker final : public sim::Observer {
 public:
  FrameMaker(std::shared_ptr<const machine::Machine> machine, const tool::ToolTable& tools,
             FrameOptions options, std::vector<sim::Seat> seats = {});
  ~FrameMaker() override;
  void on_start(const sim::Scene& scene, const machine::JointVector& joints) override;
  void on_step(const sim::Step& step) override;

  /// What the stock looked like; without it, stock is drawn as it was at the start.
  void set_stock(std::unique_ptr<sim::StockHistory> stock);
  /// Draws everything into `folder` (frames/*.png, sheet.png) and names each finding's picture.
  /// Returns the paths written, relative to `folder`.
  Expected<std::vector<std::string>> write(const std::string& folder,
                                           std::vector<sim::Finding>& findings);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace aircut::report
