#include "base/deflate.h"

#include <zlib.h>

#include <algorithm>

namespace aircut {
namespace {

constexpr std::size_t most_at_once = 1u << 30;  // zlib counts in 32 bits
constexpr int effort = 5;  // half the time of zlib's own choice, 6, for a hundredth more bytes

}  // namespace

std::string deflated(std::string_view bytes) {
  z_stream stream{};
  // Only a lack of memory can fail it.
  if (deflateInit2(&stream, effort, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY) != Z_OK)
    return {};
  std::string out;
  std::string part(1 << 16, '\0');
  std::size_t given = 0;
  int state = Z_OK;
  while (state == Z_OK || state == Z_BUF_ERROR) {
    if (stream.avail_in == 0 && given < bytes.size()) {
      const std::size_t now = std::min(bytes.size() - given, most_at_once);
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + given));
      stream.avail_in = static_cast<uInt>(now);
      given += now;
    }
    stream.next_out = reinterpret_cast<Bytef*>(part.data());
    stream.avail_out = static_cast<uInt>(part.size());
    state = deflate(&stream, given == bytes.size() ? Z_FINISH : Z_NO_FLUSH);
    out.append(part.data(), part.size() - stream.avail_out);
  }
  deflateEnd(&stream);
  return out;
}

std::uint32_t crc32_of(std::string_view bytes) {
  uLong sum = crc32(0, nullptr, 0);
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t now = std::min(bytes.size() - at, most_at_once);
    sum = crc32(sum, reinterpret_cast<const Bytef*>(bytes.data() + at), static_cast<uInt>(now));
    at += now;
  }
  return static_cast<std::uint32_t>(sum);
}

}  // namespace aircut
