// What the page and the animation file both show: where the links are, and the stock by stages.
#pragma once

#include <array>
#include <vector>

#include "page/replay.h"

namespace aircut::page {

/// Meshes of bodies with more are thinned.
inline constexpr std::size_t most_body_triangles = 60'000;

/// Place of a link in the world (x, y, z in mm) and its turn (x, y, z, w of a unit quaternion whose
/// sign does not jump), a value for each key of the replay.
using LinkTrack = std::array<std::vector<double>, 7>;
/// By LinkId.
std::vector<LinkTrack> link_tracks(const Replay& replay);

/// The stock as it is from a moment on, in the frame of its body.
struct StockStage {
  double t = 0;  ///< s
  TriangleMesh mesh;
};
/// Evenly over the run; none without a history. Errors: those of the history.
Expected<std::vector<StockStage>> stock_stages(const Replay& replay, sim::StockHistory* history);

}  // namespace aircut::page
