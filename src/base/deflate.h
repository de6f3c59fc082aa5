// What zip archives and packed data need of zlib.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace aircut {

/// Raw deflate (RFC 1951), without zlib's own header. The same bytes for the same input.
std::string deflated(std::string_view bytes);
/// The checksum of zip archives.
std::uint32_t crc32_of(std::string_view bytes);

}  // namespace aircut
