// `aircut kin fk|ik|jac`: the kinematics of a machine as a filter. One row of numbers per line of
// standard input, one row (or `error: …`) per line of standard output. Every row stands alone: of
// several solutions the one nearest to home is taken.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "cli/exit_code.h"
#include "cli/job.h"
#include "cli/rows.h"
#include "machine/kinematics/chain.h"

namespace aircut::cli {

namespace {

using machine::JointId;
using machine::JointVector;
using machine::Machine;

constexpr double degree = std::numbers::pi / 180;

std::vector<Axis> pose_axes(const Machine& machine) {
  std::vector<Axis> axes;
  for (const Axis axis : all_axes)
    if (machine.kinematics().axes().has(axis)) axes.push_back(axis);
  return axes;
}

std::vector<Column> pose_columns(const Machine& machine) {
  std::vector<Column> columns;
  for (const Axis axis : pose_axes(machine))
    columns.push_back({std::string(1, letter(axis)), is_rotary(axis) ? degree : 1});
  return columns;
}

std::vector<Column> joint_columns(const Machine& machine) {
  std::vector<Column> columns;
  for (int i = 0; i < machine.joint_count(); ++i) {
    const machine::Joint& joint = machine.joint(JointId{i});
    columns.push_back({joint.name, joint.kind == machine::JointKind::rotary ? degree : 1});
  }
  return columns;
}

std::vector<Column> vector_columns() {
  return {{"X", 1}, {"Y", 1}, {"Z", 1}, {"I", 1}, {"J", 1}, {"K", 1}};
}

// ---- the questions ------------------------------------------------------------------------------

std::string reason_of(const machine::ReachError& error) { return error.reason; }

AxisValues tip_of(const Machine& machine, const Row& row) {
  AxisValues tip;
  const auto axes = pose_axes(machine);
  for (std::size_t i = 0; i < axes.size(); ++i)
    tip[axes[i]] = row[i] * (is_rotary(axes[i]) ? degree : 1);
  return tip;
}

RowOrReason forward_row(const Machine& machine, const Row& row) {
  const auto joints = joint_columns(machine);
  JointVector q(machine.joint_count());
  for (std::size_t i = 0; i < joints.size(); ++i)
    q[static_cast<Eigen::Index>(i)] = row[i] * joints[i].unit;
  const auto tip = machine.kinematics().forward(q, {});
  if (!tip) return unexpected(reason_of(tip.error()));
  Row out;
  for (const Axis axis : pose_axes(machine))
    out.push_back((*tip)[axis] / (is_rotary(axis) ? degree : 1));
  return out;
}

// Why a joint is outside of its travel; nothing when it is inside. Rows carry 12 digits, so a limit
// is reached within 1e-6 of the unit.
std::optional<std::string> beyond_limit(const Machine& machine, const Row& joints) {
  constexpr double slack = 1e-6;
  const auto columns = joint_columns(machine);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const machine::Joint& joint = machine.joint(JointId{static_cast<int>(i)});
    const double low = joint.min / columns[i].unit, high = joint.max / columns[i].unit;
    if (joints[i] >= low - slack && joints[i] <= high + slack) continue;
    return "joint " + printable(joint.name) + " would be at " +
           shortest(std::round(joints[i] * 1e6) / 1e6) + ", its limit is " +
           shortest(std::round((joints[i] < low ? low : high) * 1e9) / 1e9);
  }
  return std::nullopt;
}

// Joints in the user's units.
Row in_user_units(const Machine& machine, const JointVector& q) {
  const auto columns = joint_columns(machine);
  Row out;
  for (std::size_t i = 0; i < columns.size(); ++i)
    out.push_back(q[static_cast<Eigen::Index>(i)] / columns[i].unit);
  return out;
}

RowOrReason inverse_row(const Machine& machine, const Row& row) {
  const auto q = machine.kinematics().inverse({tip_of(machine, row), {}}, machine.home());
  if (!q) return unexpected(reason_of(q.error()));
  const Row out = in_user_units(machine, *q);
  if (const auto reason = beyond_limit(machine, out)) return unexpected(*reason);
  return out;
}

// All joint positions inside of the travel for a tip and a direction of the tool, the one nearest
// to home first. Endless and long rotary axes have more turns than these.
tl::expected<std::vector<Row>, std::string> vector_rows(const Machine& machine, const Row& row) {
  const Vec3 axis(row[3], row[4], row[5]);
  if (!(axis.norm() > 1e-9)) return unexpected(std::string("I J K has no length"));
  auto found = machine::chain_positions(machine.kinematics(), Vec3(row[0], row[1], row[2]), axis,
                                        {}, machine.home());
  std::sort(found.begin(), found.end(), [&](const JointVector& a, const JointVector& b) {
    return (a - machine.home()).norm() < (b - machine.home()).norm();
  });
  std::vector<Row> rows;
  std::string reason = "the rotary axes can't turn the tool there";
  for (const JointVector& q : found) {
    const Row out = in_user_units(machine, q);
    if (const auto beyond = beyond_limit(machine, out))
      reason = *beyond;
    else
      rows.push_back(out);
  }
  if (rows.empty()) return unexpected(reason);
  return rows;
}

// ∂ joint / ∂ pose word at a pose, row by row: a row per joint, a column per pose word.
RowOrReason jacobian_row(const Machine& machine, const Row& row) {
  const machine::Target target{tip_of(machine, row), {}};
  const auto reachable = machine.kinematics().inverse(target, machine.home());
  if (!reachable) return unexpected(reason_of(reachable.error()));
  const auto axes = pose_axes(machine);
  const auto joints = joint_columns(machine);
  Row out(joints.size() * axes.size());
  for (std::size_t column = 0; column < axes.size(); ++column) {
    AxisValues step;
    step[axes[column]] = 1;
    JointVector dq, ddq;
    if (!machine.kinematics().rates(target, *reachable, step, {}, dq, ddq) || !dq.allFinite())
      return unexpected("the joints would need an infinite speed there (a singular pose)");
    const double unit = is_rotary(axes[column]) ? degree : 1;
    for (std::size_t i = 0; i < joints.size(); ++i)
      out[i * axes.size() + column] = dq[static_cast<Eigen::Index>(i)] * unit / joints[i].unit;
  }
  return out;
}

// The machine of -m, or a kinematics alone of --type.
bool open_kinematics(Job& job, const KinArguments& a) {
  if (a.type.empty()) {
    ProgramArguments inputs;
    inputs.machine = a.machine;
    return open_inputs(job, inputs);
  }
  auto machine = machine::bare_machine(a.type, a.parameters, job.sources, job.diagnostics);
  if (machine) job.machine = std::move(*machine);
  return machine.has_value();
}

}  // namespace

int kin_command(const KinArguments& a) {
  using Action = KinArguments::Action;
  if (a.action == Action::rot) return rot_command(a);
  Job job;
  const bool opened = open_kinematics(job, a);
  print_errors(job.diagnostics, a.color);
  if (!opened) return code(ExitCode::unknown);
  const auto input = open_program(job.sources, "-");
  if (!input) {
    print_error(input.error(), a.color);
    return code(ExitCode::unknown);
  }
  const Machine& machine = *job.machine;
  if (a.tool_vector && !machine::turns_in_two_axes(machine.kinematics())) {
    print_error(make_error("usage",
                           "--tool-vector needs a machine with two rotary axes and the kinematics "
                           "'chain'; this one is '" +
                               std::string(machine.kinematics().type()) + "'"),
                a.color);
    return code(ExitCode::unknown);
  }
  const auto columns = a.action == Action::fk ? joint_columns(machine)
                       : a.tool_vector        ? vector_columns()
                                              : pose_columns(machine);
  const auto answer = [&](const Row& row) -> TextOrReason {
    switch (a.action) {
      case Action::fk:
        return forward_row(machine, row).map(text_of);
      case Action::ik:
        if (a.tool_vector) return vector_rows(machine, row).map(text_of_all);
        return inverse_row(machine, row).map(text_of);
      case Action::jac:
      case Action::rot:
        break;
    }
    return jacobian_row(machine, row).map(text_of);
  };
  return answer_rows((*input)->content(), names_of(columns), a.color,
                     [&](std::string_view line) -> TextOrReason {
                       return read_row(line, columns).and_then(answer);
                     });
}

}  // namespace aircut::cli
