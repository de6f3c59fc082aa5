// A machine whose channels run at once: one machine that all of them move, and each channel's own
// view of it, as it is when it is driven alone.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "machine/machine.h"

namespace aircut::machine {

struct ChannelView {
  std::string name;
  std::shared_ptr<const Machine> machine;  ///< only this channel's axes are driven
  std::vector<int> joints;                 ///< of the whole machine, for each joint of this one
};

struct ChannelMachines {
  /// Every axis is driven. Spindle, work and tip are those of the first channel.
  std::shared_ptr<const Machine> whole;
  std::vector<ChannelView> channels;
  /// First and last of the M-codes with which channels wait for one another ([wait]).
  std::optional<std::pair<int, int>> wait;
};

/// Reads a package for a run of these channels, each a name or its number from 1. Problems go to
/// `out`.
Expected<ChannelMachines> read_channel_machines(const std::string& path,
                                                const std::vector<std::string>& channels,
                                                SourceMap& sources, Diagnostics& out);

}  // namespace aircut::machine
