// Joint logs as HDF5 from outside: any bytes behind the signature. Read, or a message.
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>

#include "logbook/logbook.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace aircut;
  std::FILE* file = std::tmpfile();
  if (!file) return 0;
  std::fwrite(data, 1, size, file);
  std::fflush(file);
  SourceMap sources;
  const std::string path = "/proc/self/fd/" + std::to_string(::fileno(file));
  const auto log = logbook::open_log(sources, path);
  if (!log)
    format_human(log.error(), {});
  else if (const auto check = logbook::check(**log, {}); !check)
    format_human(check.error(), {});
  std::fclose(file);
  return 0;
}
