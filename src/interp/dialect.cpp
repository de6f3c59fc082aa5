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

std::string control_with(int code, Dialect dialect, bool lathe) {
  struct Other {
    Dialect dialect;
    bool lathe;
    const char* told;
  };
  static constexpr Other others[] = {
      {Dialect::fanuc, false, "Fanuc's machining centres have it (--dialect fanuc)"},
      {Dialect::fanuc, true, "Fanuc's turning centres have it (--dialect fanuc --lathe)"},
      {Dialect::haas, false, "Haas's machining centres have it (--dialect haas)"},
      {Dialect::haas, true, "Haas's turning centres have it (--dialect haas --lathe)"},
      {Dialect::linuxcnc, false, "LinuxCNC has it (--dialect linuxcnc)"},
  };
  const auto has = [code](const Other& other) {
    for (const auto layer : layers_of(other.dialect, other.lathe))
      for (const CodeRule& rule : layer)
        if (rule.letter == 'G' && rule.code == code && rule.handler) return true;
    return false;
  };
  // The same maker's other machines first.
  for (const Other& other : others)
    if (other.dialect == dialect && other.lathe != lathe && has(other)) return other.told;
  for (const Other& other : others)
    if (other.dialect != dialect && has(other)) return other.told;
  return {};
}

}  // namespace aircut::interp
