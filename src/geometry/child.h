// Work that may crash, hang or eat memory, done in a process of its own. Private to the geometry
// library.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "base/base.h"

namespace aircut::geometry {

struct ChildLimits {
  unsigned cpu_seconds = 120;
  std::size_t extra_memory = 4'000'000'000;  ///< bytes on top of what the process has now
};

/// Runs `work` in a copy of this process and gives the bytes it returns. What it writes to the
/// error stream is dropped. An error is a sentence about how the child ended.
tl::expected<std::string, std::string> run_in_child(const std::function<std::string()>& work,
                                                    const ChildLimits& limits);

}  // namespace aircut::geometry
