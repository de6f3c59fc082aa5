#include "interp/dialect.h"

namespace aircut::interp {
namespace {

constexpr DialectTraits linuxcnc{.name = "LinuxCNC",
                                 .macro_b = false,
                                 .active_comments = true,
                                 .least_increments = false,
                                 .end_required = true,
                                 .motion_at_start = false,
                                 .max_line = 252,
                                 .max_m_words = 4,
                                 .max_depth = 9,
                                 .max_macro_depth = 9,
                                 .max_brackets = 64,
                                 .bare_conditions = false,
                                 .packed_counts = false,
                                 .full_turn = false,
                                 .local_subs = false,
                                 .feed_increments = false,
                                 .return_jumps = false,
                                 .arc_corners = false};
constexpr DialectTraits fanuc{.name = "Fanuc",
                              .macro_b = true,
                              .active_comments = false,
                              .least_increments = true,
                              .end_required = true,
                              .motion_at_start = true,
                              .max_line = 4096,
                              .max_m_words = 3,
                              .max_depth = 10,
                              .max_macro_depth = 4,
                              .max_brackets = 5,
                              .bare_conditions = false,
                              .packed_counts = true,
                              .full_turn = true,
                              .local_subs = false,
                              .feed_increments = false,
                              .return_jumps = false,
                              .arc_corners = true};
constexpr DialectTraits haas{.name = "Haas",
                             .macro_b = true,
                             .active_comments = false,
                             .least_increments = true,
                             .end_required = true,
                             .motion_at_start = true,
                             .max_line = 4096,
                             .max_m_words = 1,
                             .max_depth = 9,
                             .max_macro_depth = 9,
                             .max_brackets = 64,
                             .bare_conditions = true,
                             .packed_counts = false,
                             .full_turn = false,
                             .local_subs = true,
                             .feed_increments = true,
                             .return_jumps = true,
                             .arc_corners = false};

}  // namespace

const DialectTraits& traits_of(Dialect dialect) {
  switch (dialect) {
    case Dialect::linuxcnc:
      return linuxcnc;
    case Dialect::fanuc:
      return fanuc;
    case Dialect::haas:
      break;
  }
  return haas;
}

std::vector<std::span<const CodeRule>> layers_of(Dialect dialect, bool lathe) {
  if (dialect == Dialect::linuxcnc) return {linuxcnc_rows()};
  std::vector<std::span<const CodeRule>> layers = {builder_rows(), fanuc_rows()};
  if (lathe) {
    layers.push_back(fanuc_lathe_rows());
    layers.push_back(fanuc_lathe_cycle_rows());
  } else {
    layers.push_back(fanuc_mill_rows());
    layers.push_back(fanuc_mill_cycle_rows());
  }
  if (dialect == Dialect::haas) {
    layers.push_back(haas_rows());
    layers.push_back(lathe ? haas_lathe_rows() : haas_mill_rows());
    if (!lathe) layers.push_back(haas_mill_cycle_rows());
  }
  return layers;
}

}  // namespace aircut::interp
