// Inserts of lathe tools: their shape from the words of the tool table.
#pragma once

#include <array>
#include <string>

#include "tool/tool.h"

namespace aircut::tool {

/// Whether anything of a tool's body is known.
inline bool has_body(const Tool& tool) { return !tool.pieces.empty() || !tool.blocks.empty(); }

/// What the tip of a probe is called: a piece in the cutter's place that touches and does not cut.
inline constexpr const char* probe_name = "probe";
inline bool is_probe(const Tool& tool) {
  for (const Piece& piece : tool.pieces)
    if (piece.role == PieceRole::cutter && piece.name == probe_name) return true;
  return false;
}

/// Seen from the controlled point, (x, z) in mm: a nose and the far ends of its two edges.
struct Insert {
  std::array<double, 2> nose{};
  double radius = 0;
  std::array<std::array<double, 2>, 2> ends{};
};

/// The insert of a lathe tool; the error says what its description lacks.
tl::expected<Insert, std::string> insert_of(const Tool& tool);

/// Its body, `thickness` below the plane of X and Z. The nose is a polygon around its circle.
Block insert_block(const Insert& insert, double thickness);

/// Whether the outline is convex with at least three corners; if it goes round the other way, it is
/// turned to go from +X towards +Z.
bool make_convex(std::vector<std::array<double, 2>>& outline);

}  // namespace aircut::tool
