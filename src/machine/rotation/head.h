// Milling heads with two rotary axes, and a head together with a turntable: one axis more than a
// tool direction needs.
#pragma once

#include <limits>

#include "machine/rotation/two_turns.h"

namespace aircut::machine {

/// Entry of a head table (HEAD_DEF), mm. Mount frame: z along the first axis, away from the head.
/// Each length runs along the coordinate that its pair of measured offsets leaves out.
struct TwoAxisHead {
  Vec3 u1 = Vec3::UnitZ();             ///< first axis (C), at zero
  Vec3 u2 = Vec3::UnitX();             ///< second axis (A), at zero
  double l1 = 540.735, l2 = 250.049;   ///< along −z: mount to second axis, second axis to face
  double h1 = 200.007;                 ///< along y: from the first axis to the second one
  double l1_x = 0.024, l1_y = 0.032;   ///< offsets across l1
  double l2_x = 0.011, l2_y = -0.041;  ///< offsets across l2
  double h1_x = 0.335, h1_z = 0.247;   ///< offsets across h1
  double step1 = 0, step2 = 0;         ///< rad: coupling step of an indexing head; 0: continuous
};
/// The sample head's second axis at 45°.
Vec3 nutating_axis();

struct HeadAngles {
  double c = 0, a = 0;  ///< rad
};

/// Tool tip seen from the mount: R(u1, c) · Trans(v1 + vh) · R(u2, a) · Trans(v2).
Pose tip_on_head(const TwoAxisHead& head, const HeadAngles& at, double tool_length);
/// All angles (in (−π, π]) that give the tool direction k; an angle that k leaves open is the one
/// of `near`.
std::vector<HeadAngles> head_angles(const TwoAxisHead& head, const Vec3& k,
                                    const HeadAngles& near = {});
/// Where the mount must be so that the tip is at p.
Vec3 mount_for(const TwoAxisHead& head, const HeadAngles& at, double tool_length, const Vec3& p);

/// An indexing head takes the nearest steps.
struct Indexed {
  HeadAngles at;
  double error = 0;                    ///< rad between the wanted and the reached direction
  Mat3 correction = Mat3::Identity();  ///< turns the wanted direction to the reached one
};
Indexed indexed(const TwoAxisHead& head, const HeadAngles& wanted);

/// A head over a turntable, whose work direction k_W is seen from the machine as R(u_t, −t) · k_W.
struct TableAndHead {
  TwoAxisHead head;
  Vec3 table = Vec3::UnitZ();  ///< u_t
  double table_min = -std::numeric_limits<double>::infinity();
  double table_max = std::numeric_limits<double>::infinity();
  double a_min = -std::numeric_limits<double>::infinity();
  double a_max = std::numeric_limits<double>::infinity();
  double w_table = 1, w_c = 1, w_a = 1;  ///< weights of the travel
};
struct TableAndHeadAngles {
  double t = 0;
  HeadAngles head;
};
/// The head follows, the table stays at `near.t`.
std::optional<TableAndHeadAngles> turn_head(const TableAndHead& machine, const Vec3& k_W,
                                            const TableAndHeadAngles& near);
/// The table follows, the head stays: exists only if u_t·k_W = u_t·k_head (1e-9).
std::optional<TableAndHeadAngles> turn_table(const TableAndHead& machine, const Vec3& k_W,
                                             const TableAndHeadAngles& near);
/// Least weighted travel from `near` over both head solutions and all table angles.
std::optional<TableAndHeadAngles> turn_least(const TableAndHead& machine, const Vec3& k_W,
                                             const TableAndHeadAngles& near);
/// Position of a work point seen from the machine, whose zero is the table's centre with the table
/// at zero.
Vec3 work_point(const TableAndHead& machine, double t, const Vec3& o_W);

}  // namespace aircut::machine
