// The vectors of a head table's entry: v1 = (l1_x, l1_y, −l1), vh = (h1_x, h1, h1_z),
// v2 = (l2_x, l2_y, −l2 − tool length) (kinematics.md d.5). The tool points from the tip along +z.
//
// Table and head (d.6): for a table angle t the head sees R(u_t, −t) · k_W and has up to two
// solutions, each a smooth function of t. The weighted travel is looked at every degree within half
// a turn of where the table is, and its best place is refined by golden section.
#include "machine/rotation/head.h"

#include <cmath>
#include <numbers>

namespace aircut::machine {

namespace {

constexpr double pi = std::numbers::pi;

Mat3 turn(const Vec3& u, double angle) { return Eigen::AngleAxisd(angle, u).toRotationMatrix(); }

// The turn of an angle that is nearest to another one.
double unwound(double angle, double near) {
  return angle + 2 * pi * std::round((near - angle) / (2 * pi));
}

double to_step(double angle, double step) {
  return step > 0 ? step * std::round(angle / step) : angle;
}

struct Choice {
  TableAndHeadAngles at;
  double cost = std::numeric_limits<double>::infinity();
};

Choice best_at(const TableAndHead& m, const Vec3& k_W, const TableAndHeadAngles& near, double t) {
  Choice best;
  if (!(t >= m.table_min && t <= m.table_max)) return best;
  for (HeadAngles h : head_angles(m.head, turn(m.table, -t) * k_W, near.head)) {
    h.c = unwound(h.c, near.head.c);
    h.a = unwound(h.a, near.head.a);
    if (!(h.a >= m.a_min && h.a <= m.a_max)) continue;
    const double cost = m.w_table * std::abs(t - near.t) + m.w_c * std::abs(h.c - near.head.c) +
                        m.w_a * std::abs(h.a - near.head.a);
    if (cost < best.cost) best = {{t, h}, cost};
  }
  return best;
}

std::optional<TableAndHeadAngles> found(const Choice& choice) {
  if (!std::isfinite(choice.cost)) return std::nullopt;
  return choice.at;
}

}  // namespace

Vec3 nutating_axis() { return Vec3(0, std::numbers::sqrt2 / 2, std::numbers::sqrt2 / 2); }

Pose tip_on_head(const TwoAxisHead& h, const HeadAngles& at, double tool_length) {
  const Vec3 v1(h.l1_x, h.l1_y, -h.l1), vh(h.h1_x, h.h1, h.h1_z);
  const Vec3 v2(h.l2_x, h.l2_y, -h.l2 - tool_length);
  const Mat3 C = turn(h.u1, at.c), CA = C * turn(h.u2, at.a);
  Pose X = translation(C * (v1 + vh) + CA * v2);
  X.linear() = CA;
  return X;
}

std::vector<HeadAngles> head_angles(const TwoAxisHead& head, const Vec3& k,
                                    const HeadAngles& near) {
  std::vector<HeadAngles> out;
  for (const TwoTurns& s : two_turns(head.u1, head.u2, Vec3::UnitZ(), k))
    out.push_back({s.outer.value_or(near.c), s.inner.value_or(near.a)});
  return out;
}

Vec3 mount_for(const TwoAxisHead& head, const HeadAngles& at, double tool_length, const Vec3& p) {
  return p - tip_on_head(head, at, tool_length).translation();
}

Indexed indexed(const TwoAxisHead& head, const HeadAngles& wanted) {
  Indexed out;
  out.at = {to_step(wanted.c, head.step1), to_step(wanted.a, head.step2)};
  const Vec3 k = tip_on_head(head, wanted, 0).linear().col(2);
  const Vec3 reached = tip_on_head(head, out.at, 0).linear().col(2);
  out.error = std::atan2(k.cross(reached).norm(), k.dot(reached));
  out.correction = Eigen::Quaterniond::FromTwoVectors(k, reached).toRotationMatrix();
  return out;
}

std::optional<TableAndHeadAngles> turn_head(const TableAndHead& machine, const Vec3& k_W,
                                            const TableAndHeadAngles& near) {
  return found(best_at(machine, k_W, near, near.t));
}

std::optional<TableAndHeadAngles> turn_table(const TableAndHead& m, const Vec3& k_W,
                                             const TableAndHeadAngles& near) {
  const Vec3 k = tip_on_head(m.head, near.head, 0).linear().col(2);
  constexpr double same = 1e-9;
  if (std::abs(m.table.dot(k_W) - m.table.dot(k)) > same) return std::nullopt;
  const auto angle = angle_about(m.table, k_W, k);
  TableAndHeadAngles out = near;
  if (angle) out.t = unwound(-*angle, near.t);
  if (!(out.t >= m.table_min && out.t <= m.table_max)) return std::nullopt;
  return out;
}

std::optional<TableAndHeadAngles> turn_least(const TableAndHead& m, const Vec3& k_W,
                                             const TableAndHeadAngles& near) {
  constexpr double step = pi / 180;
  Choice best;
  for (int i = 0; i <= 180; ++i)
    for (const double side : {1.0, -1.0}) {
      const Choice here = best_at(m, k_W, near, near.t + side * i * step);
      if (here.cost < best.cost) best = here;
    }
  if (!std::isfinite(best.cost)) return std::nullopt;
  // Golden section over the two degrees around the best place.
  constexpr double part = 0.6180339887498949;
  double low = best.at.t - step, high = best.at.t + step;
  for (int round = 0; round < 40; ++round) {
    const double a = high - part * (high - low), b = low + part * (high - low);
    const Choice at_a = best_at(m, k_W, near, a), at_b = best_at(m, k_W, near, b);
    for (const Choice& c : {at_a, at_b})
      if (c.cost < best.cost) best = c;
    (at_a.cost < at_b.cost ? high : low) = at_a.cost < at_b.cost ? b : a;
  }
  return found(best);
}

Vec3 work_point(const TableAndHead& machine, double t, const Vec3& o_W) {
  return turn(machine.table, -t) * o_W;
}

}  // namespace aircut::machine
