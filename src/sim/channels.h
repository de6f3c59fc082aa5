// Several channels of one machine at once, on one clock (docs/channels.md). Each channel has its
// own program, interpreter, planner and tool; they share the machine, the stock and the spindles.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "sim/sim.h"

namespace aircut::sim {

/// A channel and what carries its program out, borrowed for the run.
struct ChannelJob {
  std::string name;
  int number = 1;                                   ///< in the package, from 1: P of a wait code
  std::shared_ptr<const machine::Machine> machine;  ///< where only its axes are driven
  std::vector<int> joints;                          ///< of the whole machine, for each of its own
  interp::Interpreter* interpreter = nullptr;
  const Diagnostics* diagnostics = nullptr;  ///< of its program
  plan::Planner* planner = nullptr;
  std::function<void(const canon::Command&)> listen;  ///< sees every command; may be empty
};

/// How a channel's time went.
struct ChannelTimes {
  std::string name;
  double end = 0;      ///< when its program ended, s
  double waiting = 0;  ///< s, of it, at wait codes
  std::uint64_t blocks = 0, moves = 0;
  bool turned_by_other = false;  ///< another channel has started the spindle that it works in
};

class ChannelCuts;
class CutListener;
class TurningCheck;

class ChannelRun {
 public:
  /// `whole`: the machine with every axis driven, at `start`. `wait`: first and last wait code.
  ChannelRun(std::shared_ptr<const machine::Machine> whole, const tool::ToolTable& tools,
             const JointVector& start, const CheckOptions& options,
             std::optional<std::pair<int, int>> wait, std::vector<ChannelJob> jobs);
  ~ChannelRun();

  /// Sees the whole machine; what is told of a block is the first channel's.
  void add_observer(Observer& observer) { observers_.push_back(&observer); }
  /// Sees one channel's own view.
  void add_observer(std::size_t channel, Observer& observer);
  /// Told of all cuts (sim/cuts.h), if there is a stock that is cut. Before run().
  void listen_to_cuts(CutListener& listener);
  Simulator::Result run(const RunOptions& options);

  const std::vector<ChannelTimes>& times() const { return times_; }
  /// The tools' places, for a scene of this machine.
  std::vector<Seat> seats() const;
  /// As those of a Simulator.
  std::optional<TriangleMesh> part() const;
  Expected<std::unique_ptr<StockHistory>> stock_history();

 private:
  struct Channel;
  struct Interval;
  void start();
  /// The next thing that the channel does; nothing when it ended or waits.
  std::optional<plan::Segment> next(Channel& c);
  void fetch(Channel& c);
  void complete(Channel& c, const plan::Segment& segment);
  void change_tool(Channel& c);
  bool meet();
  void release(Channel& c);
  std::set<int> partners(const Channel& c) const;
  void tell_deadlock();
  double next_event() const;
  void advance(double t1);
  std::unique_ptr<Interval> interval(double t0, double t1);
  void share_joints(Interval& interval);
  void look_at_spindles(const Interval& interval);
  double shared_rpm(std::size_t channel) const;
  void cut(const Interval& interval);
  bool work_is_moved(std::size_t channel, const Interval& interval) const;
  void stop(Channel& c, const std::string& why);
  Finding finding(Kind kind, const Channel& c, const canon::Command& command) const;
  Simulator::Result finish();

  Scene scene_;
  CheckOptions options_;
  std::optional<std::pair<int, int>> wait_;
  std::vector<std::unique_ptr<Channel>> channels_;
  std::vector<std::string> names_;
  std::vector<std::vector<std::size_t>> moved_by_;  ///< by LinkId
  std::vector<std::vector<std::size_t>> users_;     ///< by joint: channels that drive it
  std::unique_ptr<Check> collision_;
  std::unique_ptr<TurningCheck> turning_;
  std::unique_ptr<ChannelCuts> cuts_;  ///< null when nobody listens
  std::vector<Observer*> observers_;
  Findings findings_;
  JointVector joints_;  ///< of the whole machine, now
  double now_ = 0;
  bool stopped_ = false, interrupted_ = false, out_of_time_ = false;
  std::vector<std::string> unchecked_;
  std::vector<ChannelTimes> times_;
};

}  // namespace aircut::sim
