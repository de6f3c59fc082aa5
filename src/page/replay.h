// What the page's replay needs of a run, recorded in bounded memory while the run goes on.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "page/rates.h"
#include "sim/sim.h"

namespace aircut::page {

/// Watches a run. Between two keys everything is linear in time: a key is kept only where leaving
/// it out would move the tool or a joint by more than a tolerance, which grows when there are too
/// many.
class Replay final : public sim::Observer {
 public:
  /// A moment. Units mm, rad, s.
  struct Key {
    double t = 0;
    machine::JointVector joints;
    Vec3 tip = Vec3::Zero();  ///< M frame
    double feed = 0;          ///< achieved along the path, mm/s
    bool rapid = false;       ///< the way from the key before
  };
  /// A stretch of time that belongs to one block.
  struct BlockTime {
    double t = 0;  ///< begin
    std::uint64_t line =
        0;  ///< of the program; of a sub in another file, that of its call; 0: none
    plan::MotionKind kind = plan::MotionKind::idle;
  };
  struct ToolTime {
    double t = 0;
    int number = 0;  ///< 0: none
  };
  /// What one tool did.
  struct ToolUse {
    int number = 0;
    double feed_time = 0, rapid_time = 0, feed_length = 0;  ///< s, mm
    double max_feed = 0, max_rpm = 0;                       ///< mm/s, rev/min
    std::uint64_t first_line = 0, last_line = 0;
  };
  /// What one joint did: mm or rad.
  struct JointUse {
    double low = 0, high = 0;
    double distance = 0;
    std::uint64_t reversals = 0;
  };

  Replay(std::shared_ptr<const machine::Machine> machine, const tool::ToolTable& tools,
         const SourceText& program, std::size_t most_keys = 150'000);

  void on_start(const sim::Scene& scene, const machine::JointVector& joints) override;
  void on_step(const sim::Step& step) override;
  void on_finish(const sim::Summary& summary) override;

  const machine::Machine& machine() const { return *machine_; }
  const tool::ToolTable& tools() const { return tools_; }
  const SourceText& program() const { return *program_; }
  const std::vector<Key>& keys() const { return keys_; }
  const std::vector<BlockTime>& blocks() const { return blocks_; }
  bool blocks_left_out() const { return blocks_left_out_; }
  const std::vector<ToolTime>& tool_times() const { return tool_times_; }
  const std::vector<ToolUse>& tool_uses() const { return tool_uses_; }
  const std::vector<JointUse>& joint_uses() const { return joint_uses_; }
  const Rates& rates() const { return rates_; }
  /// The bodies of a tool as they hang on the spindle's link.
  std::vector<machine::Body> tool_bodies(int number) const;
  /// How far a moment between two keys may be off, mm (rad · 100 mm).
  double tolerance() const { return tolerance_; }

 private:
  std::uint64_t line_of(const SourceSpan& span) const;
  void add(const Key& key);
  void keep(const Key& key);
  void thin();
  double deviation(const Key& from, const Key& to, const Key& between) const;
  int pieces_between(const plan::Segment& segment, const plan::ProfileKnot& from,
                     const plan::ProfileKnot& to) const;
  void count(const sim::Step& step, const Key& end, bool last);

  std::shared_ptr<const machine::Machine> machine_;
  tool::ToolTable tools_;
  const SourceText* program_;
  std::size_t most_keys_;
  double tolerance_ = 0.02;
  std::vector<Key> keys_;
  std::vector<Key> waiting_;  ///< behind the last kept key, may be left out
  std::vector<BlockTime> blocks_;
  bool blocks_left_out_ = false;
  std::vector<ToolTime> tool_times_;
  std::vector<ToolUse> tool_uses_;
  std::vector<JointUse> joint_uses_;
  Rates rates_;
  std::vector<double> turn_at_;  ///< per joint: where its direction was last told
  std::vector<int> direction_;
};

}  // namespace aircut::page
