// The force of a cut that grows with its depth, from a material's law: shared by the contacts of a
// file and by those that a program makes.
#pragma once

#include <optional>

#include "accuracy/setup.h"

namespace aircut::accuracy {

/// Cutting, thrust and feed force of a material for an entering angle; nothing when it has no law
/// for turning.
std::optional<std::array<PowerTerm, 3>> turning_laws(const Material& material, double kappa);
/// Sets the terms of a force: each law along its direction, at this feed and speed.
void set_terms(DepthForce& force, const Triad& triad, const std::array<PowerTerm, 3>& laws,
               double S, double V);

/// The law of a cutter's edge; nothing when the material has none for milling.
std::optional<EdgeLaw> edge_law(const Material& material);

/// A milling cut's force on the tool in the frame whose columns are the feed, left of it and up the
/// tool; its moment about the tool's axis and the largest chip.
struct MillingLoad {
  DepthForce force;   ///< grows with a_p where it is proportional to it
  double torque = 0;  ///< N·mm, of the force that is used
  double mean_torque = 0;
};
MillingLoad milling_load(const Cutter& cutter, const EdgeLaw& law, const MillingCut& cut,
                         const Mat3& frame, bool peak);

}  // namespace aircut::accuracy
