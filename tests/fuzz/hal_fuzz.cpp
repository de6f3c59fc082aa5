// HAL files and the set-up that names them, from outside: the bytes up to a line `---` are a HAL
// file, the rest is the set-up.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>

#include "linuxcnc/module_import.h"
#include "machine/machine.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace aircut;
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  const std::size_t cut = std::min(bytes.find("\n---\n"), bytes.size());
  SourceMap sources;
  const SourceText& hal_text = sources.add("hal", bytes.substr(0, cut));
  const SourceText& ini_text =
      sources.add("ini", cut == bytes.size() ? std::string() : bytes.substr(cut + 5));
  Diagnostics out;
  const ini::IniFile ini = ini::read_ini(
      ini_text, [&](const std::string&) -> Expected<const SourceText*> { return &ini_text; }, out);
  linuxcnc::Hal hal(ini, out);
  hal.read(hal_text);
  for (const ini::Entry* entry : ini.all("HAL", "HALCMD")) hal.command(entry->value, entry->span);
  for (const auto& [pin, span] : hal.pins("")) {
    if (span.covered().size() != span.length) __builtin_trap();
    hal.input(pin);
    hal.driver(pin);
  }
  if (const ini::Entry* kinematics = ini.find("KINS", "KINEMATICS")) {
    linuxcnc::MachineImport result;
    linuxcnc::ModuleImport(ini, hal, 1, out, result).run(*kinematics);
    SourceMap more;
    const SourceText& text = more.add("machine", result.toml);
    Diagnostics problems;
    if (!result.toml.empty()) machine::read_machine(text, "/nonexistent", more, problems);
  }
  for (const Diagnostic& d : out.list()) format_human(d, {});
  return 0;
}
