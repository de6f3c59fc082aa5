// Private: numbers and bytes in the compact form that the page's script reads back (web/blob.js).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/geometry.h"

namespace aircut::page {

/// A row of integers in a Blob.
struct Row {
  std::size_t at = 0;     ///< offset of its first byte
  std::size_t count = 0;  ///< of integers
};

/// Rows one behind the other, to be packed together. An integer is stored as its difference from
/// the one before (zigzag, then seven bits to a byte, lowest first), so what changes slowly is
/// small.
class Blob {
 public:
  Row add(const std::vector<std::int64_t>& values);
  /// Plain bytes; `count` is their number.
  Row add_text(std::string_view text);
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// The mesh with its vertices merged into cells of `cell` mm, each at the point that lies nearest
/// to all planes that meet in it (quadric clustering, Lindstrom 2000): flat faces stay flat and
/// most edges sharp. For pictures only.
TriangleMesh clustered(const TriangleMesh& mesh, double cell);
/// The mesh itself when it has no more than `most` triangles, else clustered so far that it has
/// not.
TriangleMesh at_most(const TriangleMesh& mesh, std::size_t most);

}  // namespace aircut::page
