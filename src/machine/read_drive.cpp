// How a machine is driven: `[work]`, `[spindle]` and `[kinematics]`, once for the whole file or in
// each `[[channel]]`.
//
// A machine with several tools or workpieces has one pose of the tool seen from the workpiece for
// each pair of them, and all pairs share joints (kinematics.md a.2). A channel is such a pair with
// the axes that move it. All channels are read and compared with the tree; one is driven, and the
// axes that it does not name stay at home, where their bodies take part in collision checks.
#include <algorithm>
#include <numbers>

#include "machine/kinematics/kinematics_table.h"
#include "machine/reading.h"
#include "machine/rotation/rotation.h"

namespace aircut::machine {

namespace {

constexpr double deg = std::numbers::pi / 180;

void read_work(config::Table& table, ReadState& state) {
  auto work = table.table("work");
  state.machine.work_link_ = bed_link;
  Pose& X_LM = state.machine.X_LM_;
  X_LM = Pose::Identity();
  if (work) {
    state.machine.work_link_ = read_link(*work, "link", "bed", state.machine);
    X_LM = translation(point(*work, "origin", Vec3::Zero(), state.unit_mm));
    if (const auto angles = work->numbers("angles", 3))
      X_LM.linear() = about_fixed_axes(Vec3((*angles)[0], (*angles)[1], (*angles)[2]) * deg);
  }
  state.machine.spindle_.R_LF = X_LM.linear();
}

// ISO 841: letters describe the tool's motion relative to the work, so an axis that moves the work
// moves it the other way.
void turn_senses(LinkId link, const std::set<std::string>& open_senses, Machine& machine) {
  while (link != bed_link) {
    const Link& at = machine.links_[static_cast<std::size_t>(index(link))];
    Joint& joint = machine.tree_[static_cast<std::size_t>(at.joint)];
    if (open_senses.contains(joint.name)) joint.sense = -1;
    link = at.parent;
  }
}

void read_kinematics(config::Table& top, ReadState& state) {
  auto table = top.table("kinematics");
  if (!table) {
    if (!top.has("kinematics"))
      top.error("kinematics", "[kinematics] is missing: it says how joints move the tool");
    return;
  }
  const std::string rapid =
      table->choice("rapid", {"coordinated", "joint", "dogleg"}, "coordinated");
  state.machine.rapid_ = rapid == "joint"    ? RapidMode::joint
                         : rapid == "dogleg" ? RapidMode::dogleg
                                             : RapidMode::coordinated;
  state.machine.tip_acceleration_ = std::numeric_limits<double>::infinity();
  if (const auto limit = table->number("a_tcp")) {
    state.machine.tip_acceleration_ = *limit * state.unit_mm;
    if (!(*limit > 0)) table->error("a_tcp", "'a_tcp' needs more than 0");
  }
  if (table->has("tcp")) {
    table->know("tcp");
    table->error("tcp",
                 "'tcp' is not supported by this version; give each kinematics a [[channel]] and "
                 "name both in [tcp]");
  }
  const std::vector<std::string> types = kinematics_types();
  const std::string type = table->required_text("type");
  std::vector<Joint> driven;
  for (const int at : state.machine.driven_) {
    if (static_cast<std::size_t>(at) >= state.machine.tree_.size()) return;
    driven.push_back(state.machine.tree_[static_cast<std::size_t>(at)]);
  }
  for (const KinematicsRow& row : kinematics_table()) {
    if (row.type != type) continue;
    KinematicsInput input{*table, state.unit_mm, driven, state.machine};
    state.machine.kinematics_ = row.make(input);
    return;
  }
  if (type.empty()) return;  // said already
  std::string known;
  for (const std::string& word : types) known += (known.empty() ? "" : ", ") + word;
  table->error("type", "unknown kinematics '" + type + "'; this version knows " + known + "." +
                           did_you_mean(type, types));
  for (const std::string& key : table->keys()) table->know(key);  // whose keys they are is open
}

// Every passive couple has a value, and every value moves a couple.
void match_passive(config::Table& top, config::Table& drive, Machine& machine) {
  if (!machine.kinematics_) return;
  const std::vector<std::string> names = machine.kinematics().passive_names();
  const std::vector<config::Table> tables = top.tables("axis");
  const auto table_of = [&](const Joint& joint) {
    return *std::find_if(tables.begin(), tables.end(),
                         [&](config::Table table) { return table.text("name", "") == joint.name; });
  };
  std::set<std::string> used;
  for (Joint& joint : machine.tree_) {
    if (joint.driven >= 0 || joint.held) continue;
    const auto found = std::find(names.begin(), names.end(), joint.passive);
    if (found == names.end()) {
      table_of(joint).error("passive", "the kinematics '" +
                                           std::string(machine.kinematics().type()) +
                                           "' has no passive value '" + joint.passive + "'." +
                                           did_you_mean(joint.passive, names));
      continue;
    }
    joint.passive_index = static_cast<int>(found - names.begin());
    used.insert(joint.passive);
    const bool angle = joint.passive.ends_with("_angle");
    if (angle != (joint.kind == JointKind::rotary))
      table_of(joint).error("kind", "'" + joint.passive + "' is " +
                                        (angle ? "an angle, so its axis must be rotary"
                                               : "a length, so its axis must be linear"));
  }
  for (const std::string& name : names)
    if (!used.contains(name))
      drive.error("kinematics", "no [[axis]] has passive = \"" + name +
                                    "\": a part that the kinematics moves is not in the tree");
}

void read_spindle(config::Table& top, ReadState& state) {
  auto table = top.table("spindle");
  if (!table) {
    if (!top.has("spindle"))
      top.error("spindle",
                "[spindle] is missing: the link that carries the tool and its gauge point");
    return;
  }
  Spindle& spindle = state.machine.spindle_;
  if (!table->has("link"))
    table->error("link", "'link' is missing: the link that carries the tool");
  spindle.link = read_link(*table, "link", "bed", state.machine);
  if (!table->has("gauge"))
    table->error("gauge", "'gauge' is missing: the point where the tool length is 0, in bed axes");
  spindle.gauge = point(*table, "gauge", Vec3::Zero(), state.unit_mm);
  if (const auto angles = table->numbers("angles", 3))
    spindle.R_LF =
        spindle.R_LF * about_fixed_axes(Vec3((*angles)[0], (*angles)[1], (*angles)[2]) * deg);
  if (const auto acceleration = table->number("acceleration")) {
    spindle.acceleration = *acceleration;
    if (!(spindle.acceleration > 0))
      table->error("acceleration", "'acceleration' needs more than 0, in revolutions per s²");
  }
  if (const auto rpm = table->numbers("rpm", 2)) {
    spindle.min_rpm = (*rpm)[0];
    spindle.max_rpm = (*rpm)[1];
    if (!(0 <= spindle.min_rpm && spindle.min_rpm <= spindle.max_rpm && spindle.max_rpm > 0))
      table->error("rpm", "'rpm' needs [lowest, highest], 0 or more each");
  }
}

Drive drive_of(const std::string& name, const SourceSpan& span, const Machine& machine) {
  return {.name = name,
          .span = span,
          .tree = machine.tree_,
          .driven = machine.driven_,
          .kinematics = machine.kinematics_,
          .spindle = machine.spindle_,
          .rapid = machine.rapid_,
          .tip_acceleration = machine.tip_acceleration_,
          .work_link = machine.work_link_,
          .X_LM = machine.X_LM_};
}

// The axes that a channel names stay driven, in the order of the file; the others are held.
void choose_axes(config::Table& table, Machine& machine) {
  const auto names = table.texts("axes");
  if (!names) {
    if (!table.has("axes"))
      table.error("axes", "'axes' is missing: the names of the axes that this channel drives");
    return;
  }
  std::vector<std::string> known;
  for (const int at : machine.driven_)
    known.push_back(machine.tree_[static_cast<std::size_t>(at)].name);
  std::vector<int> kept;
  for (const int at : machine.driven_) {
    Joint& joint = machine.tree_[static_cast<std::size_t>(at)];
    joint.held = std::find(names->begin(), names->end(), joint.name) == names->end();
    joint.driven = joint.held ? -1 : static_cast<int>(kept.size());
    if (!joint.held) kept.push_back(at);
  }
  machine.driven_ = kept;
  for (std::size_t i = 0; i < names->size(); ++i) {
    const std::string& name = (*names)[i];
    const auto fail = [&](std::string message) {
      table.report(make_error("machine_invalid", table.item_span("axes", i), std::move(message)));
    };
    if (std::find(known.begin(), known.end(), name) == known.end())
      fail("there is no driven axis '" + name + "'." + did_you_mean(name, known));
    else if (std::count(names->begin(), names->begin() + static_cast<long>(i), name) > 0)
      fail("the axis '" + name + "' is there twice");
  }
  if (names->empty()) table.error("axes", "a channel drives at least one axis");
}

std::vector<Drive> read_channels(config::Table& top, ReadState& state) {
  for (const char* key : {"kinematics", "work", "spindle"}) {
    top.know(key);
    if (top.has(key))
      top.error(key, "on a machine with channels each [[channel]] has its own '" +
                         std::string(key) + "'");
  }
  std::vector<config::Table> tables = top.tables("channel");
  Machine& machine = state.machine;
  for (config::Table& table : tables)
    if (auto work = table.table("work"))
      if (const auto link = machine.find_link(work->text("link", "bed")))
        turn_senses(*link, state.open_senses, machine);
  const Machine shared = machine;
  std::vector<Drive> drives;
  for (config::Table& table : tables) {
    machine = shared;
    const std::string name = table.required_text("name");
    if (std::any_of(drives.begin(), drives.end(), [&](const Drive& d) { return d.name == name; }))
      table.error("name", "there are two channels named '" + name + "'");
    choose_axes(table, machine);
    read_work(table, state);
    read_spindle(table, state);
    read_kinematics(table, state);
    match_passive(top, table, machine);
    drives.push_back(drive_of(name, table.span("kinematics"), machine));
  }
  machine = shared;
  for (const Drive& drive : drives) machine.channels_.push_back(drive.name);
  return drives;
}

// Why a program can't go over from the driven channel to another one; empty: it can.
std::string cannot_switch(const Drive& from, const Drive& to) {
  if (!from.kinematics || !to.kinematics) return "the channel '" + to.name + "' has errors";
  const std::string what = "the channel '" + to.name + "' ";
  if (from.driven != to.driven) return what + "drives other axes than '" + from.name + "'";
  if (from.kinematics->axes() != to.kinematics->axes())
    return what + "has other words than '" + from.name + "'";
  if (from.kinematics->passive_names() != to.kinematics->passive_names())
    return what + "has other passive parts than '" + from.name + "'";
  const Spindle &a = from.spindle, &b = to.spindle;
  if (a.link != b.link || !a.gauge.isApprox(b.gauge) || !a.R_LF.isApprox(b.R_LF))
    return what + "has another tool than '" + from.name + "'";
  if (from.rapid != to.rapid) return what + "has rapids of another kind than '" + from.name + "'";
  return {};
}

void list_models(const std::vector<Drive>& drives, const Drive& driven, Machine& machine) {
  for (const Drive& to : drives) {
    KinematicsModel model{to.name, nullptr, cannot_switch(driven, to)};
    if (model.reason.empty()) model.kinematics = to.kinematics;
    machine.models_.push_back(std::move(model));
  }
}

}  // namespace

void Drive::put_on(Machine& machine) const {
  machine.channel_ = name;
  machine.tree_ = tree;
  machine.driven_ = driven;
  machine.kinematics_ = kinematics;
  machine.spindle_ = spindle;
  machine.rapid_ = rapid;
  machine.tip_acceleration_ = tip_acceleration;
  machine.work_link_ = work_link;
  machine.X_LM_ = X_LM;
}

std::vector<Drive> read_drives(config::Table& top, const std::string& channel, ReadState& state) {
  Machine& machine = state.machine;
  if (!top.has("channel")) {
    top.know("drive");
    if (top.has("drive")) top.error("drive", "there is no [[channel]] that could be driven");
    if (!channel.empty() && channel != "0")
      top.report(make_error("input", "the machine '" + machine.name() +
                                         "' has no channels, so there is no '" +
                                         printable(channel) + "' to drive"));
    read_work(top, state);
    turn_senses(machine.work_link_, state.open_senses, machine);
    read_spindle(top, state);
    read_kinematics(top, state);
    match_passive(top, top, machine);
    return {drive_of("", top.span("kinematics"), machine)};
  }
  std::vector<Drive> drives = read_channels(top, state);
  if (drives.empty()) return drives;  // the table has the error
  const std::string wanted = channel.empty() ? top.text("drive", drives.front().name) : channel;
  top.know("drive");
  auto found =
      std::find_if(drives.begin(), drives.end(), [&](const Drive& d) { return d.name == wanted; });
  // A channel that has no such name may be given by its number, from 0 on.
  for (std::size_t i = 0; found == drives.end() && i < drives.size(); ++i)
    if (wanted == std::to_string(i)) found = drives.begin() + static_cast<long>(i);
  if (found != drives.end()) {
    found->put_on(machine);
    list_models(drives, *found, machine);
    return drives;
  }
  std::string known;
  for (const Drive& d : drives) known += (known.empty() ? "" : ", ") + d.name;
  const std::string message = "there is no channel '" + printable(wanted) + "'." +
                              did_you_mean(wanted, machine.channels_) + " There are " + known + ".";
  if (channel.empty())
    top.error("drive", message);
  else
    top.report(make_error("input", message));
  drives.front().put_on(machine);
  return drives;
}

}  // namespace aircut::machine
