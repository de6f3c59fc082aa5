#include "accuracy/cut_force.h"

namespace aircut::accuracy {

std::optional<std::array<PowerTerm, 3>> turning_laws(const Material& material, double kappa) {
  if (material.turning)
    return std::array{material.turning->cut, material.turning->thrust, material.turning->feed};
  if (!material.kienzle) return std::nullopt;
  std::array<PowerTerm, 3> laws;
  laws.fill(material.kienzle->power_law(kappa));
  laws[1].K = material.thrust_ratio;
  laws[2].K = material.feed_ratio;
  return laws;
}

void set_terms(DepthForce& force, const Triad& triad, const std::array<PowerTerm, 3>& laws,
               double S, double V) {
  const std::array<Vec3, 3> directions = {triad.cut, triad.thrust, triad.feed};
  for (std::size_t i = 0; i < 3; ++i)
    force.terms[i] = {directions[i], laws[i].at(1, S, V), laws[i].x};
}

std::optional<EdgeLaw> edge_law(const Material& material) {
  EdgeLaw law;
  if (material.milling) {
    law.constants = *material.milling;
    return law;
  }
  if (!material.kienzle) return std::nullopt;
  law.kienzle = *material.kienzle;
  law.radial_ratio = material.thrust_ratio;
  law.axial_ratio = 0;
  return law;
}

MillingLoad milling_load(const Cutter& cutter, const EdgeLaw& law, const MillingCut& cut,
                         const Mat3& frame, bool peak) {
  const bool closed = cutter.shape == Cutter::Shape::flat && !law.is_kienzle();
  const MillingForce mean =
      closed ? mean_force(cutter, law.constants, cut) : mean_force(cutter, law, cut);
  const MillingForce used = peak ? peak_force(cutter, law, cut) : mean;
  const Vec3 force = frame * used.force;
  MillingLoad out;
  out.torque = used.torque;
  out.mean_torque = mean.torque;
  // The mean force of a flat end mill is proportional to a_p, so the depth may scatter; all else is
  // taken as it is.
  if (!peak && cutter.shape == Cutter::Shape::flat && force.norm() > 0)
    out.force.terms[0] = {force.normalized(), force.norm() / cut.a_p, 1};
  else
    out.force.fixed = force;
  return out;
}

}  // namespace aircut::accuracy
