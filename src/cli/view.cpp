#include "cli/view.h"

namespace aircut::cli {

Expected<report::View> view_of(const ViewArguments& arguments) {
  report::View view;
  view.camera = arguments.camera;
  view.hidden = arguments.hidden;
  view.see_through = arguments.see_through;
  if (!arguments.section.empty()) {
    const auto section = report::section_of(arguments.section);
    if (!section) return unexpected(section.error());
    view.section = *section;
  }
  if (auto known = report::check_camera(view.camera); !known) return unexpected(known.error());
  return view;
}

}  // namespace aircut::cli
