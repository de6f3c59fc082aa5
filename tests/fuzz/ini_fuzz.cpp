// Set-up files from outside: any bytes, which their own #INCLUDE lines lead to again.
#include <cstddef>
#include <cstdint>
#include <string>

#include "ini/ini.h"
#include "linuxcnc/linuxcnc.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace aircut;
  SourceMap sources;
  const SourceText& text =
      sources.add("input", std::string(reinterpret_cast<const char*>(data), size));
  const SourceReader include = [&](const std::string&) -> Expected<const SourceText*> {
    return &text;
  };
  Diagnostics out;
  const ini::IniFile file = ini::read_ini(text, include, out);
  for (const ini::Section& section : file.sections())
    for (const ini::Entry& entry : section.entries) {
      if (entry.span.covered().size() != entry.span.length) __builtin_trap();
      if (entry.key.empty() || entry.key_span.covered().empty()) __builtin_trap();
      if (section.name == "RS274NGC" && entry.key == "REMAP")
        linuxcnc::read_remap(entry.value, entry.span, out);
    }
  linuxcnc::check_keys(file, out);
  for (const Diagnostic& d : out.list()) format_human(d, {});
  return 0;
}
