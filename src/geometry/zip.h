// Just enough of zip archives to judge a 3MF file before the importer opens it. Private to the
// geometry library.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace aircut::geometry {

struct ZipEntry {
  std::string name;
  std::uint64_t packed = 0, unpacked = 0;  ///< bytes, as the directory claims
  std::uint16_t method = 0;                ///< 0 stored, 8 deflated
  std::size_t data = 0;                    ///< offset of the packed bytes
};

/// The entries of the directory; nothing when the bytes are no archive.
std::optional<std::vector<ZipEntry>> zip_entries(std::string_view archive);

/// The first `most` bytes of an entry, fewer if it is shorter; nothing when it is broken.
std::optional<std::string> unpack_start(std::string_view archive, const ZipEntry& entry,
                                        std::size_t most);

}  // namespace aircut::geometry
