// A workspace as a picture.
#pragma once

#include <optional>

#include "base/base.h"
#include "machine/workspace/workspace.h"

namespace aircut::cli {

/// A PNG file: the plane of a flat workspace, or three planes through the middle of the largest
/// box. `upright`: what is reached without tilts, when the workspace was asked for with some.
Expected<std::string> workspace_picture(const machine::Machine& machine,
                                        const machine::Workspace& workspace,
                                        const std::optional<machine::Workspace>& upright,
                                        const std::vector<std::string>& notes);

}  // namespace aircut::cli
