// A kinematics type by its name and parameters alone: its driven axes without limits, no links to
// draw. For questions to the kinematics, not for runs.
#include <algorithm>

#include "machine/kinematics/kinematics_table.h"

namespace aircut::machine {

namespace {

// `X Y C*`: names of driven axes, those that turn with a star.
void add_axes(std::string_view names, Machine& machine) {
  while (!names.empty()) {
    const std::size_t end = std::min(names.find(' '), names.size());
    Joint joint;
    joint.name = names.substr(0, end);
    names.remove_prefix(std::min(end + 1, names.size()));
    if (joint.name.ends_with('*')) {
      joint.kind = JointKind::rotary;
      joint.name.pop_back();
    }
    joint.driven = static_cast<int>(machine.driven_.size());
    joint.child = LinkId{static_cast<int>(machine.links_.size())};
    machine.links_.push_back({joint.name, bed_link, joint.driven});
    machine.driven_.push_back(joint.driven);
    machine.tree_.push_back(joint);
  }
}

}  // namespace

std::vector<std::string> kinematics_types() {
  std::vector<std::string> types;
  for (const KinematicsRow& row : kinematics_table()) types.emplace_back(row.type);
  return types;
}

Expected<std::shared_ptr<const Machine>> bare_machine(const std::string& type,
                                                      const std::vector<std::string>& parameters,
                                                      SourceMap& sources, Diagnostics& out) {
  const auto fail = [&](std::string message) {
    const Diagnostic d = make_error("usage", std::move(message));
    out.add(d);
    return unexpected(d);
  };
  const std::vector<std::string> types = kinematics_types();
  const auto rows = kinematics_table();
  const auto row = std::find_if(rows.begin(), rows.end(),
                                [&](const KinematicsRow& r) { return r.type == type; });
  if (row == rows.end()) {
    std::string known;
    for (const std::string& name : types) known += (known.empty() ? "" : ", ") + name;
    return fail("there is no kinematics '" + printable(type) + "'." + did_you_mean(type, types) +
                " There are " + known + ".");
  }
  if (row->joints.empty() && !row->joints_of)
    return fail("the kinematics '" + type +
                "' is made from the axes of a package: name one with -m");
  std::string text = "type = \"" + type + "\"\n";
  for (const std::string& parameter : parameters) text += parameter + "\n";
  const SourceText& source = sources.add("--param", std::move(text));
  config::Reader reader(source, "usage");
  config::Table table = reader.top();
  table.know("type");
  auto machine = std::make_shared<Machine>();
  machine->name_ = type;
  add_axes(row->joints_of ? row->joints_of(table) : std::string(row->joints), *machine);
  if (machine->joint_count() > max_joints)
    return fail("a machine has at most " + std::to_string(max_joints) + " driven axes");
  KinematicsInput input{table, 1.0, machine->tree_, *machine};
  machine->kinematics_ = row->make(input);
  const Diagnostics problems = reader.finish();
  for (const Diagnostic& d : problems.list()) out.add(d);
  if (problems.errors() > 0) return unexpected(problems.list().front());
  if (!machine->kinematics_) return fail("'" + type + "' can't be made from these parameters");
  return std::shared_ptr<const Machine>(machine);
}

}  // namespace aircut::machine
