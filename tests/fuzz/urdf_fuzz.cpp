// Robots' descriptions from outside. Meshes are looked for in a folder that is not there.
#include <cstddef>
#include <cstdint>
#include <string>

#include "machine/machine.h"
#include "urdf/urdf.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace aircut;
  SourceMap sources;
  const SourceText& text =
      sources.add("input", std::string(reinterpret_cast<const char*>(data), size));
  Diagnostics out;
  if (const auto robot = urdf::read_robot(text, out))
    if (const auto made = urdf::machine_of(*robot, "/nonexistent/robot.urdf", {}, out)) {
      const SourceText& toml = sources.add("machine", made->toml);
      Diagnostics problems;
      machine::read_machine(toml, "/nonexistent", sources, problems);
    }
  for (const Diagnostic& d : out.list()) {
    if (d.span && d.span.begin + d.span.length > d.span.text->content().size()) __builtin_trap();
    format_human(d, {});
  }
  return 0;
}
