// Private: which pairs of bodies are watched, and what they are called.
//
// All bodies on different links that collide, without
//   - neighbours in the tree (machine and spindle bodies on links joined by one couple),
//   - fixtures and stock among themselves (they rest on one another),
//   - the tool against the stock, which changes (cutting.h); what is not the tool is watched
//   against
//     the raw piece, so it never sees less than there is,
//   - pairs excluded by name in machine.toml, which the report lists with their reason.
#pragma once

#include "sim/sim.h"

namespace aircut::sim {

struct Pair {
  std::size_t a = 0, b = 0;  ///< indices into Scene::bodies(); a is nearer to the tool
  std::string name;          ///< of both bodies, the same after a tool change
  collide::Budget budget;
  bool left_out = false;    ///< overlapped at the start
  double contact_end = -1;  ///< program time at which the last contact ended; -1 = none
  bool touching = false;    ///< a probing move has brought them together; not apart again yet
};

struct WatchedPairs {
  std::vector<Pair> pairs;
  std::vector<std::string> exclusions;  ///< "a – b: reason"
};

enum class ToolAndStock : unsigned char { left_out, watched };

/// The pairs of a scene; what was left out in `before` stays out.
WatchedPairs watched_pairs(const Scene& scene, const std::vector<Pair>& before,
                           ToolAndStock tool_and_stock = ToolAndStock::left_out);

bool is_tool(machine::Role role);
/// "tool holder `T1/holder`"
std::string in_words(const machine::Body& body);

}  // namespace aircut::sim
