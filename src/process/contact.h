// Private: the contact that a cut is: its force by depth, where and which way.
#pragma once

#include "accuracy/cut_force.h"
#include "process/process.h"

namespace aircut::process {

struct CutContact {
  accuracy::Contact contact;
  accuracy::DepthForce force;
  accuracy::PowerTerm cut_law;  ///< of turning; C = 0: none
  double t = 0, width = 0;      ///< depth; radial width of a milling cut
  double dt = 0;                ///< allowance of the depth
  double S = 0, V = 0;          ///< mm/rev, m/min
  double diameter = 0;
  double chip = 0;
  double torque = 0, power = 0;  ///< of the tool's own spindle, N·mm and kW without losses
  Vec3 normal = Vec3::Zero();    ///< out of the surface that is made
  Vec3 floor = Vec3::Zero();     ///< milled: up from the floor, else zero
  /// Milled: the engaged angles, the force per chip area, N/mm², and the ratio of its radial part.
  std::optional<accuracy::Engagement> engaged;
  double K_t = 0, K_r = 0;
  const accuracy::Material* material = nullptr;
};

/// Nothing when the force is not known; `why` says so.
std::optional<CutContact> contact_of(const Setup& setup, std::size_t tool, std::size_t work,
                                     const sim::Cut& cut, std::string& why);

}  // namespace aircut::process
