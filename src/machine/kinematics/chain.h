// chain: any serial machine with three linear axes and up to three rotary ones, in any mixture of
// table and head, orthogonal or not (kinematics.md a.2, e.1), with tool centre point control: the
// program says where the tip is on the work, and the angles of the rotary axes themselves.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "machine/machine.h"

namespace aircut::machine {

/// One driven couple between the work and the tool.
struct ChainCouple {
  JointKind kind = JointKind::linear;
  Vec3 origin = Vec3::Zero();      ///< a point of the axis, bed axes, all joints zero
  Vec3 direction = Vec3::UnitZ();  ///< unit vector, bed axes, all joints zero
  double sense = 1;                ///< the outer link moves by sense · q
  int driven = 0;                  ///< place in the joint log
};

struct ChainGeometry {
  std::string_view type = "chain";  ///< a preset has its own name
  std::vector<ChainCouple> work;    ///< from the bed to the work
  std::vector<ChainCouple> tool;    ///< from the bed to the spindle
  std::vector<Axis> words;          ///< by joint: the program axis that it is named after
  Pose X_LM = Pose::Identity();     ///< M seen from the bed with all joints at zero
  Vec3 gauge = Vec3::Zero();        ///< F, bed axes, all joints zero; its axes are those of M then
};

/// Null when the couples are not three linear ones with the words X Y Z and up to three rotary
/// ones; `reason` says so then.
std::shared_ptr<const Kinematics> make_chain(const ChainGeometry& geometry, std::string& reason);

/// A chain with two rotary axes.
bool turns_in_two_axes(const Kinematics& kinematics);

/// All joint positions (angles in (−π, π]) in which the tip is at `tip` (M, mm) and the tool points
/// along `axis` (unit vector from the tip to the spindle, M), for chains with two rotary axes:
/// none, one or two. An angle that the direction leaves open is the one of `near`.
std::vector<JointVector> chain_positions(const Kinematics& chain, const Vec3& tip, const Vec3& axis,
                                         const AxisValues& tool_offset, const JointVector& near);

}  // namespace aircut::machine
