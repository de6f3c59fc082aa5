// `aircut kin fk|ik|jac`: the kinematics of a machine as a filter. One row of numbers per line of
// standard input, one row (or `error: …`) per line of standard output. Every row stands alone: of
// several solutions the one nearest to home is taken.
#include <algorithm>
#include <array>
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
    inputs.ini_use = ProgramArguments::IniUse::machine;
    if (a.kinstype) inputs.machine += ":" + std::to_string(*a.kinstype);
    return open_inputs(job, inputs);
  }
  auto machine = machine::bare_machine(a.type, a.parameters, job.sources, job.diagnostics);
  if (machine) job.machine = std::move(*machine);
  return machine.has_value();
}

// ---- a grid of poses ---------------------------------------------------------------------------

struct Range {
  double from = 0, step = 0;
  long count = 1;
};

// `FROM:TO:STEP` or one value, in the user's units.
std::optional<Range> range_of(std::string_view text) {
  std::array<double, 3> v{};
  std::size_t n = 0;
  for (bool more = true; more && n < 3; ++n) {
    const std::size_t colon = text.find(':');
    more = colon != text.npos;
    const auto value = number_of(text.substr(0, colon));
    if (!value) return std::nullopt;
    v[n] = *value;
    if (more) text.remove_prefix(colon + 1);
    if (more && n == 2) return std::nullopt;
  }
  if (n == 1) return Range{v[0], 0, 1};
  constexpr double most = 1e6;
  const double steps = n == 3 ? (v[1] - v[0]) / v[2] : -1;
  if (!(steps >= 0 && steps <= most)) return std::nullopt;
  return Range{v[0], v[2], static_cast<long>(steps + 1e-9) + 1};
}

// The ranges by pose word, the others at home. Prints what is wrong.
std::optional<std::vector<Range>> read_ranges(const Machine& machine, const KinArguments& a) {
  const auto columns = pose_columns(machine);
  const auto axes = pose_axes(machine);
  std::vector<Range> ranges(columns.size());
  if (const auto home = machine.kinematics().forward(machine.home(), {}))
    for (std::size_t i = 0; i < axes.size(); ++i)
      ranges[i].from = (*home)[axes[i]] / columns[i].unit;
  double rows = 1;
  for (const std::string& text : a.ranges) {
    const std::size_t equals = text.find('=');
    const auto at = std::find_if(columns.begin(), columns.end(), [&](const Column& column) {
      return column.name == text.substr(0, equals);
    });
    const auto range =
        equals == text.npos ? std::nullopt : range_of(std::string_view(text).substr(equals + 1));
    if (at == columns.end() || !range) {
      print_error(make_error("usage", "'" + printable(text) +
                                          "' is no WORD=FROM:TO:STEP (STEP leads "
                                          "from FROM to TO) or WORD=VALUE with one of the words " +
                                          names_of(columns)),
                  a.color);
      return std::nullopt;
    }
    ranges[static_cast<std::size_t>(at - columns.begin())] = *range;
  }
  for (const Range& range : ranges) rows *= static_cast<double>(range.count);
  constexpr double most_rows = 1e7;
  if (rows <= most_rows) return ranges;
  print_error(make_error("usage", "the grid has more than 10 million rows"), a.color);
  return std::nullopt;
}

// Every pose of the grid, the last word fastest: the pose, ` ; `, and its joints or why there are
// none.
int sweep(const Machine& machine, const KinArguments& a) {
  const auto ranges = read_ranges(machine, a);
  if (!ranges) return code(ExitCode::unknown);
  std::vector<long> at(ranges->size(), 0);
  bool good = true;
  for (bool more = true; more;) {
    Row row;
    for (std::size_t i = 0; i < at.size(); ++i)
      row.push_back((*ranges)[i].from + (*ranges)[i].step * static_cast<double>(at[i]));
    const auto joints = inverse_row(machine, row);
    good = good && joints.has_value();
    std::printf("%s ; %s\n", text_of(row).c_str(),
                joints ? text_of(*joints).c_str() : ("error: " + joints.error()).c_str());
    more = false;
    for (std::size_t i = at.size(); i-- > 0 && !more;) {
      more = ++at[i] < (*ranges)[i].count;
      if (!more) at[i] = 0;
    }
  }
  return code(good ? ExitCode::pass : ExitCode::fail);
}

}  // namespace

int kin_command(const KinArguments& a) {
  using Action = KinArguments::Action;
  if (a.action == Action::rot) return rot_command(a);
  Job job;
  const bool opened = open_kinematics(job, a);
  print_errors(job.diagnostics, a.color);
  if (!opened) return code(ExitCode::unknown);
  if (a.action == Action::sweep) return sweep(*job.machine, a);
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
      case Action::sweep:
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
