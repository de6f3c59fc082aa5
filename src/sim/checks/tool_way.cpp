#include "sim/checks/tool_way.h"

#include <algorithm>
#include <cmath>

namespace aircut::sim {

namespace {

constexpr double most_moves = 1e6;

Vec3 xyz(const AxisValues& p) { return {p[Axis::x], p[Axis::y], p[Axis::z]}; }

// The tool seen from the stock: where its tip is, and its axis.
struct ToolPose {
  Vec3 tip, axis;
};

std::optional<ToolPose> tool_pose(const Step& step, const machine::RawStock& stock, double s) {
  const machine::Machine& machine = step.scene.machine();
  const auto joints = step.motion.at_path(s);
  if (!joints) return std::nullopt;
  thread_local machine::LinkPoses poses;
  machine::forward(machine, *joints, poses);
  const auto link = [&](machine::LinkId id) -> const Pose& {
    return poses.X_WL[static_cast<std::size_t>(machine::index(id))];
  };
  const Pose X_SW = (link(stock.link) * stock.X_LS).inverse(Eigen::Isometry);
  const machine::Spindle& spindle = machine.spindle();
  const Pose& X_WL = link(spindle.link);
  const Vec3 axis = X_WL.linear() * spindle.R_LF * Vec3::UnitZ();
  const Vec3 gauge = X_WL * spindle.gauge;
  const double length = step.scene.tool() ? step.scene.tool()->gauge_length : 0;
  return ToolPose{X_SW * (gauge - length * axis), X_SW.linear() * axis};
}

double turn_of(const AxisValues& travel) {
  return std::abs(travel[Axis::a]) + std::abs(travel[Axis::b]) + std::abs(travel[Axis::c]);
}

// Into how many equal parts a path is cut where the tool does not turn.
double parts_of(const plan::Path& path, double tolerance) {
  return std::visit(
      overloaded{
          [](const plan::Hold&) { return 1.0; }, [](const plan::Line&) { return 1.0; },
          [&](const plan::Arc& arc) {
            const double r = std::max({arc.start_radius, arc.end_radius, tolerance});
            return std::ceil(std::abs(arc.angle) / (2 * std::acos(1 - tolerance / r)));
          },
          [&](const plan::Blend& blend) {
            double bend = 0;
            for (std::size_t i = 0; i + 2 < blend.control.size(); ++i)
              bend = std::max(bend, (xyz(blend.control[i]) - 2 * xyz(blend.control[i + 1]) +
                                     xyz(blend.control[i + 2]))
                                        .norm());
            return std::ceil(std::sqrt(20 * bend / (8 * tolerance)));
          },
          [](const plan::JointWay&) { return 16.0; },  // and more by what is seen
      },
      path);
}

// Where the tool does not turn: the commanded path, moved to where the tool is.
bool resting_axis(const Step& step, const machine::RawStock& stock, double tolerance,
                  std::vector<StraightMove>& out) {
  const plan::Path& path = step.segment.path;
  const double length = plan::length(path);
  const auto first = tool_pose(step, stock, 0);
  const double parts = std::max(1.0, parts_of(path, tolerance));
  if (!first || !(parts <= most_moves)) return false;
  const Mat3 R_SM = stock.X_LS.linear().transpose() * step.scene.machine().X_LM().linear();
  const Vec3 start = xyz(plan::evaluate(path, 0).p);
  Vec3 from = first->tip;
  for (int i = 1; i <= static_cast<int>(parts); ++i) {
    const double s0 = length * (i - 1) / parts, s1 = length * i / parts;
    const Vec3 to = first->tip + R_SM * (xyz(plan::evaluate(path, s1).p) - start);
    out.push_back({from, to, first->axis, s0, s1});
    from = to;
  }
  return true;
}

bool turning_axis(const Step& step, const machine::RawStock& stock, const Reach& reach, double turn,
                  double tolerance, std::vector<StraightMove>& out) {
  const plan::Path& path = step.segment.path;
  const double length = plan::length(path);
  const double middle = reach.height / 2;
  const double rho = std::hypot(middle, reach.radius);
  // A turn about the tool's own axis changes nothing, so what counts is the axis: its two ends in a
  // step and, within a step of at most `widest`, how far it can be off the arc between them.
  constexpr double widest = 0.02;  // rad
  const double off = widest * widest / 8;
  double parts = std::max({1.0, parts_of(path, tolerance), std::ceil(turn / widest)});
  const std::size_t begin = out.size();
  for (bool good = false; !good; parts *= 2) {
    if (!(parts <= most_moves)) return false;
    good = true;
    out.resize(begin);
    auto a = tool_pose(step, stock, 0);
    for (int i = 1; i <= static_cast<int>(parts) && good; ++i) {
      const double s0 = length * (i - 1) / parts, s1 = length * i / parts;
      const auto b = tool_pose(step, stock, s1), m = tool_pose(step, stock, (s0 + s1) / 2);
      if (!a || !b || !m) return false;
      const Vec3 pa = a->tip + middle * a->axis, pb = b->tip + middle * b->axis;
      const double angle = (a->axis - b->axis).norm() + 2 * off;
      good = (m->tip + middle * m->axis - (pa + pb) / 2).norm() <= tolerance &&
             (angle * rho <= 2 * tolerance || turn / parts < 1e-6);
      const Vec3 axis = (a->axis + b->axis).normalized();
      out.push_back({pa - middle * axis, pb - middle * axis, axis, s0, s1});
      a = b;
    }
    if (good) return true;
  }
  return false;
}

}  // namespace

double time_at(const Step& step, double s) {
  const plan::Segment& segment = step.segment;
  if (segment.profile.knots.empty() || s >= segment.profile.knots.back().s) return segment.t_end();
  double low = 0, high = segment.duration();
  for (int i = 0; i < 40 && high - low > 1e-9; ++i) {
    const double middle = 0.5 * (low + high);
    (segment.profile.at(middle).s < s ? low : high) = middle;
  }
  return segment.t_start + high;
}

namespace {

double turn_over(const Step& step) {
  const plan::Path& path = step.segment.path;
  const auto* way = std::get_if<plan::JointWay>(&path);
  if (!way) return turn_of(plan::bounds(path, 0, plan::length(path)).travel);
  // Of all rotary joints, more than the tool turns.
  const machine::Machine& machine = step.scene.machine();
  double turn = 0;
  for (int j = 0; j < machine.joint_count(); ++j)
    if (machine.joint(machine::JointId{j}).kind == machine::JointKind::rotary)
      turn += std::abs(way->to[j] - way->from[j]);
  return turn;
}

}  // namespace

bool turns(const Step& step, const machine::RawStock& stock) {
  return stock.link != step.scene.machine().work_link() || step.segment.kinematics ||
         turn_over(step) != 0;
}

bool straight_moves(const Step& step, const machine::RawStock& stock, const Reach& reach,
                    double tolerance, std::vector<StraightMove>& out) {
  if (!(plan::length(step.segment.path) > 0)) return true;
  const bool bends = std::holds_alternative<plan::JointWay>(step.segment.path);
  if (!bends && !turns(step, stock)) return resting_axis(step, stock, tolerance, out);
  return turning_axis(step, stock, reach, turn_over(step), tolerance, out);
}

}  // namespace aircut::sim
