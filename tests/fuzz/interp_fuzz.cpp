// Programs from outside: any bytes, with small limits. A first byte below 4 chooses the dialect.
// What comes out must be finite numbers, and come to an end. Called files resolve to the same
// bytes.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "interp/interp.h"

namespace {

void expect_finite(const aircut::AxisValues& values) {
  for (const double value : values.value)
    if (!std::isfinite(value)) __builtin_trap();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace aircut;
  SourceMap sources;
  const int choice = size > 0 && data[0] < 4 ? data[0] : 0;
  const std::size_t skipped = size > 0 && data[0] < 4 ? 1 : 0;
  const std::string bytes(reinterpret_cast<const char*>(data) + skipped, size - skipped);
  const SourceText& text = sources.add("input.ngc", bytes);
  tool::ToolTable tools;
  for (int number = 1; number <= 3; ++number) {
    tool::Tool tool;
    tool.number = number;
    tool.pocket = number;
    tool.diameter = number * 4 - 6;
    tool.offset[Axis::z] = 10 * number;
    tools.tools.push_back(tool);
  }
  interp::Options options;
  if (choice == 1 || choice == 3) options.dialect = interp::Dialect::fanuc;
  if (choice == 2) options.dialect = interp::Dialect::haas;
  options.lathe = choice == 3;
  static_cast<void>(interp::guess_dialect(bytes));
  options.limits.max_blocks = 2000;
  options.limits.max_idle_blocks = 1000;
  options.limits.max_repeat = 100;
  const SourceReader reader = [&](const std::string& path) -> Expected<const SourceText*> {
    return &sources.add(path, bytes);
  };
  Diagnostics out;
  interp::Interpreter run(text, tools, {}, options, reader, out);
  AxisValues tip;
  while (auto command = run.next()) {
    tip = canon::end_of(command->action, tip);
    expect_finite(tip);
    if (std::holds_alternative<canon::Probe>(command->action)) run.resume({tip, true});
  }
  for (const Diagnostic& diagnostic : out.list()) {
    if (diagnostic.kind.empty() || diagnostic.message.empty()) __builtin_trap();
    static_cast<void>(excerpt(diagnostic.span, "", {}));
  }
  return 0;
}
