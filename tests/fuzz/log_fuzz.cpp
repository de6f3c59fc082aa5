// Joint logs from outside: any bytes. Whatever is accepted can be checked, compared and exported.
#include <cstddef>
#include <cstdint>
#include <string>

#include "logbook/logbook.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace aircut;
  const SourceText log("input", std::string(reinterpret_cast<const char*>(data), size));
  int pieces = 0;
  const logbook::IdealPath path = [&](logbook::IdealPiece& out) {
    out = {};
    out.block = static_cast<std::uint64_t>(++pieces);
    out.start = {0, 0, 0};
    out.end = {1.0 * pieces, 2, 3};
    out.arc = pieces % 2 == 0;
    out.normal = {0, 0, 1};
    return pieces < 300;
  };
  const auto check = logbook::check(log, path);
  if (!check) {
    format_human(check.error(), {});
    return 0;
  }
  for (const logbook::Peak& peak : check->peaks)
    if (!(peak.share >= 0)) __builtin_trap();
  const auto same = logbook::compare(log, log, 0);
  if (!same || same->first) __builtin_trap();
  std::size_t bytes = 0;
  const auto count = [&](std::string_view text) { bytes += text.size(); };
  logbook::ExportOptions options;
  options.table = logbook::Table::npy;
  if (!logbook::export_table(log, options, count)) __builtin_trap();
  return 0;
}
