// Private: what a run of several channels holds of each, and what they do in one interval.
#pragma once

#include <map>

#include "sim/channels.h"

namespace aircut::sim {

struct ChannelRun::Channel {
  ChannelJob job;
  std::size_t index = 0;
  std::unique_ptr<Simulator> simulator;  ///< its own checks, its tool

  std::optional<plan::Segment> active;
  std::optional<canon::Command> mark;  ///< the wait code that the program has come to …
  bool waits = false;                  ///< … once all before it is done
  double since = 0;                    ///< when that was
  bool flushed = false, ended = false;
  std::string problem;  ///< why nothing follows what is planned already
  double waiting = 0, end = 0;

  // Where it stands between segments.
  JointVector joints;
  AxisValues tip, tool_offset;
  canon::Command last;
  int work_system = 1;
  double rpm = 0;
  bool turned = false;       ///< it has started a spindle
  bool cuts_stock = true;    ///< the stock turns in the spindle that it works on
  std::vector<int> foreign;  ///< joints of other channels between its tool and the stock
  std::map<std::size_t, std::pair<double, double>> told_rpm;  ///< conflicts by other channel
};

// All that is borrowed by the steps of one interval; it stays where it is.
struct ChannelRun::Interval {
  double t0 = 0, t1 = 0;
  std::vector<plan::Segment> segments;
  std::vector<motion::JointMotion> own;    ///< of each channel in its own view
  std::vector<motion::PartMotion> parts;   ///< of the whole machine
  std::vector<motion::JointMotion> whole;  ///< led by each channel
  ChannelSteps steps;

  bool rests(std::size_t channel) const {
    return std::holds_alternative<plan::Hold>(segments[channel].path);
  }
  /// The step that is told: of the first channel that moves.
  const Step& lead() const {
    for (std::size_t i = 0; i < segments.size(); ++i)
      if (!rests(i)) return steps.of[i];
    return steps.of.front();
  }
};

}  // namespace aircut::sim
