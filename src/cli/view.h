#pragma once

#include "cli/arguments.h"
#include "report/view.h"

namespace aircut::cli {

/// What can be told without the machine; report::check_view asks the rest. Error kind `usage`.
Expected<report::View> view_of(const ViewArguments& arguments);

}  // namespace aircut::cli
