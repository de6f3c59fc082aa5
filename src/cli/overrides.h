// Overrides and holds as a file says them (docs/overrides.md).
#pragma once

#include "cli/job.h"
#include "plan/plan.h"

namespace aircut::cli {

/// Error kind `overrides_invalid`, or that of a file that can't be read.
tl::expected<std::vector<plan::OverrideEvent>, Diagnostics> read_overrides(Job& job,
                                                                           const std::string& path);

}  // namespace aircut::cli
