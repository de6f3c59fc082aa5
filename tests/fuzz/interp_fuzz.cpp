// Programs from outside: any bytes, with small limits. A first byte below 4 chooses the dialect.
// What comes out must be finite numbers, come to an end, and be the same with and without the
// interpreter's fast paths. Called files resolve to the same bytes.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

#include "interp/interp.h"

namespace {

using namespace aircut;

void require(bool holds) {
  if (!holds) __builtin_trap();
}

void expect_finite(const AxisValues& values) {
  for (const double value : values.value) require(std::isfinite(value));
}

tool::ToolTable some_tools() {
  tool::ToolTable tools;
  for (int number = 1; number <= 3; ++number) {
    tool::Tool tool;
    tool.number = number;
    tool.pocket = number;
    tool.diameter = number * 4 - 6;
    tool.offset[Axis::z] = 10 * number;
    tools.tools.push_back(tool);
  }
  return tools;
}

/// Runs the program and gives back all that it says.
std::string told_by(const std::string& bytes, interp::Options options) {
  SourceMap sources;
  const SourceText& text = sources.add("input.ngc", bytes);
  options.limits.max_blocks = 2000;
  options.limits.max_idle_blocks = 1000;
  options.limits.max_repeat = 100;
  std::map<std::string, const SourceText*> files;  // each is read once, as SourceMap::open does
  const SourceReader reader = [&](const std::string& path) -> Expected<const SourceText*> {
    const SourceText*& file = files[path];
    if (!file) file = &sources.add(path, bytes);
    return file;
  };
  Diagnostics out;
  interp::Interpreter run(text, some_tools(), {}, options, reader, out);
  AxisValues tip;
  std::string told;
  while (auto command = run.next()) {
    tip = canon::end_of(command->action, tip);
    expect_finite(tip);
    told += canon::to_text(command->action) + "\n";
    if (std::holds_alternative<canon::Probe>(command->action)) run.resume({tip, true});
  }
  for (const Diagnostic& diagnostic : out.list()) {
    require(!diagnostic.kind.empty() && !diagnostic.message.empty());
    static_cast<void>(excerpt(diagnostic.span, "", {}));
    told += diagnostic.span.place() + " " + diagnostic.kind + " " + diagnostic.message + "\n";
  }
  return told;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const int choice = size > 0 && data[0] < 4 ? data[0] : 0;
  const std::size_t skipped = size > 0 && data[0] < 4 ? 1 : 0;
  const std::string bytes(reinterpret_cast<const char*>(data) + skipped, size - skipped);
  interp::Options options;
  if (choice == 1 || choice == 3) options.dialect = interp::Dialect::fanuc;
  if (choice == 2) options.dialect = interp::Dialect::haas;
  options.lathe = choice == 3;
  static_cast<void>(interp::guess_dialect(bytes));
  const std::string fast = told_by(bytes, options);
  options.fast_paths = false;
  require(told_by(bytes, options) == fast);
  return 0;
}
