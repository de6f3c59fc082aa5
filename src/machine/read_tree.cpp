// The tree of links: each `[[axis]]` makes one link, its child, and hangs it on its parent.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "machine/kinematics/kinematics_table.h"
#include "machine/reading.h"

namespace aircut::machine {

namespace {

constexpr double deg = std::numbers::pi / 180;
constexpr std::size_t max_couples = 64;  // far above any machine; keeps recursions shallow

struct Axle {
  config::Table table;
  Joint joint;
  std::string parent, child;
  std::optional<double> sense;  ///< nothing: ISO 841 says it
};

double positive(config::Table& table, const std::string& key, double unit,
                const std::string& what) {
  constexpr double largest = 1e9;  // mm or rad per s, s²: beyond it the numbers are a mistake
  const auto value = table.number(key);
  if (!value) {
    if (!table.has(key)) table.error(key, "'" + key + "' is missing: " + what);
    return 1;
  }
  if (*value > 0 && *value * unit <= largest) return *value * unit;
  table.error(key, "'" + key + "' must be more than 0" +
                       (*value > 0 ? " and at most 1e9" : ", this is " + shortest(*value)));
  return 1;
}

std::optional<double> travel_end(config::Table& table, const std::string& key, const Joint& joint,
                                 double unit) {
  if (joint.kind == JointKind::rotary) {
    const auto value = table.number(key);
    if (!value) return std::nullopt;
    if (std::abs(*value) <= 1e7) return *value * unit;
    table.error(key, "'" + key + "' is beyond 1e7 degrees; leave it out for an endless axis");
    return std::nullopt;
  }
  if (!table.has(key))
    table.error(key, "'" + key + "' is missing: a linear axis needs the ends of its travel");
  return table.has(key) ? std::optional(length(table, key, 0, unit)) : std::nullopt;
}

void read_limits(config::Table& table, Joint& joint, double unit_mm) {
  const bool rotary = joint.kind == JointKind::rotary;
  const double unit = rotary ? deg : unit_mm;
  joint.min = travel_end(table, "min", joint, unit).value_or(joint.min);
  joint.max = travel_end(table, "max", joint, unit).value_or(joint.max);
  if (joint.min > joint.max)
    table.error("min", "'min' is above 'max' (" + shortest(joint.min / unit) + " > " +
                           shortest(joint.max / unit) + ")");
  joint.vmax = positive(table, "vmax", unit, "the top speed in units per second");
  joint.amax = positive(table, "amax", unit, "the top acceleration in units per second²");
  table.know("jmax");
  if (table.has("jmax"))
    joint.jmax = positive(table, "jmax", unit, "the jerk in units per second³");

  // Wrapping changes which way a rotary axis turns; without it the motion would be another one.
  const std::string wrap = table.choice("wrap", {"none", "shortest", "modulo"}, "none");
  if (wrap != "none")
    table.error("wrap", rotary ? "wrap = \"" + wrap + "\" is not supported by this version"
                               : "only a rotary axis can wrap, '" + joint.name + "' is linear");

  joint.home = rotary ? table.number("home", 0) * unit : length(table, "home", 0, unit);
  if (joint.min <= joint.max && (joint.home < joint.min || joint.home > joint.max))
    table.error("home", "home " + shortest(joint.home / unit) + " is outside of the travel " +
                            shortest(joint.min / unit) + " to " + shortest(joint.max / unit) +
                            (table.has("home") ? "" : "; give 'home'"));
}

Vec3 read_direction(config::Table& table) {
  if (!table.has("direction"))
    table.error("direction", "'direction' is missing: the unit vector of the axis, in bed axes");
  const auto values = table.numbers("direction", 3);
  if (!values) return Vec3::UnitZ();
  const Vec3 direction((*values)[0], (*values)[1], (*values)[2]);
  const double norm = direction.stableNorm();
  constexpr double slack = 1e-6;  // six decimals of a rounded vector
  if (std::abs(norm - 1) <= slack) return direction / norm;
  std::string hint;
  if (norm > 1e-9 && norm < 1e9) {
    const Vec3 unit = direction / norm;
    hint = "; the unit vector is [" + shortest(unit.x()) + ", " + shortest(unit.y()) + ", " +
           shortest(unit.z()) + "]";
  }
  table.error("direction", "'direction' has length " + shortest(norm) + ", it must be 1" + hint);
  return Vec3::UnitZ();
}

void refuse_limits_of_passive(config::Table& table, const std::string& name) {
  for (const char* key : {"min", "max", "vmax", "amax", "jmax", "wrap", "home"}) {
    table.know(key);
    if (table.has(key))
      table.error(key, "'" + name +
                           "' is passive: its value follows from the kinematics, so it has " +
                           "no '" + key + "'");
  }
}

Axle read_axle(config::Table table, double unit_mm) {
  Axle axle{.table = table, .joint = {}, .parent = {}, .child = {}, .sense = {}};
  Joint& joint = axle.joint;
  joint.name = table.required_text("name");
  const std::string kind = table.choice("kind", {"linear", "rotary"}, "linear");
  if (!table.has("kind")) table.error("kind", "'kind' is missing: \"linear\" or \"rotary\"");
  joint.kind = kind == "rotary" ? JointKind::rotary : JointKind::linear;
  axle.parent = table.required_text("parent");
  axle.child = table.required_text("child");
  if (joint.kind == JointKind::rotary && !table.has("origin"))
    table.error("origin", "'origin' is missing: a point on the rotary axis, in bed axes");
  joint.origin = point(table, "origin", Vec3::Zero(), unit_mm);
  joint.direction = read_direction(table);
  axle.sense = table.number("sense");
  if (axle.sense && *axle.sense != 1 && *axle.sense != -1)
    table.error("sense", "'sense' must be 1 or -1, this is " + shortest(*axle.sense));
  joint.sense = axle.sense.value_or(1);
  joint.passive = table.text("passive", "");
  if (table.has("passive"))
    refuse_limits_of_passive(table, joint.name);
  else
    read_limits(table, joint, unit_mm);
  return axle;
}

// Names of axes and links: once each, and the bed is nobody's child.
void check_names(std::vector<Axle>& axles) {
  std::map<std::string, std::string> child_of;  // link → axis that carries it
  std::set<std::string> names;
  for (Axle& axle : axles) {
    if (!axle.joint.name.empty() && !names.insert(axle.joint.name).second)
      axle.table.error("name", "there are two axes named '" + axle.joint.name + "'");
    if (axle.child == "bed") {
      axle.table.error("child", "the bed stands still, no axis can carry it");
    } else if (!axle.child.empty()) {
      const auto [other, fresh] = child_of.emplace(axle.child, axle.joint.name);
      if (!fresh)
        axle.table.error("child", "link '" + axle.child + "' is carried by axis '" + other->second +
                                      "' already; a link has one axis");
    }
  }
}

void check_parents(std::vector<Axle>& axles) {
  std::vector<std::string> links = {"bed"};
  for (const Axle& axle : axles) links.push_back(axle.child);
  std::sort(links.begin(), links.end());
  for (Axle& axle : axles)
    if (!axle.parent.empty() && !std::binary_search(links.begin(), links.end(), axle.parent))
      axle.table.error("parent", "there is no link '" + axle.parent +
                                     "': it must be \"bed\" or the child of an axis." +
                                     did_you_mean(axle.parent, links));
}

// Hangs links on the tree until no more axis finds its parent, in the order of the file.
void grow(std::vector<Axle>& axles, Machine& machine) {
  std::vector<bool> placed(axles.size(), false);
  const auto place = [&](std::size_t i, LinkId parent) {
    Joint joint = axles[i].joint;
    joint.parent = parent;
    joint.child = LinkId{static_cast<int>(machine.links_.size())};
    machine.links_.push_back({axles[i].child, parent, static_cast<int>(machine.tree_.size())});
    if (joint.driven >= 0)
      machine.driven_[static_cast<std::size_t>(joint.driven)] =
          static_cast<int>(machine.tree_.size());
    machine.tree_.push_back(std::move(joint));
    placed[i] = true;
  };
  for (bool grown = true; grown;) {
    grown = false;
    for (std::size_t i = 0; i < axles.size(); ++i) {
      if (placed[i]) continue;
      const auto parent = machine.find_link(axles[i].parent);
      if (!parent) continue;
      place(i, *parent);
      grown = true;
    }
  }
  // What is left hangs on an unknown link (said already) or in a loop. It is placed on the bed so
  // that bodies on it are not called errors, too.
  const auto is_child = [&](const std::string& name) {
    return std::any_of(axles.begin(), axles.end(), [&](const Axle& a) { return a.child == name; });
  };
  for (std::size_t i = 0; i < axles.size(); ++i) {
    if (placed[i]) continue;
    if (is_child(axles[i].parent))
      axles[i].table.error("parent", "axis '" + axles[i].joint.name +
                                         "' is not connected with the bed: the chain from '" +
                                         axles[i].parent + "' never reaches it");
    place(i, bed_link);
  }
}

}  // namespace

LinkId read_link(config::Table& table, const std::string& key, const std::string& fallback,
                 const Machine& machine) {
  const std::string name = table.text(key, fallback);
  if (const auto link = machine.find_link(name)) return *link;
  std::vector<std::string> names;
  for (const Link& link : machine.links()) names.push_back(link.name);
  table.error(key, "there is no link '" + name + "'." + did_you_mean(name, names));
  return bed_link;
}

void read_tree(config::Table& top, ReadState& state) {
  std::vector<Axle> axles;
  if (!top.has("axis")) top.error("axis", "there is no [[axis]]: a machine needs at least one");
  for (const config::Table& table : top.tables("axis"))
    axles.push_back(read_axle(table, state.unit_mm));
  if (axles.size() > max_couples) {
    axles[max_couples].table.error("name", "a machine has at most 64 axes");
    return;
  }
  int driven = 0;
  for (Axle& axle : axles)
    if (axle.joint.passive.empty()) axle.joint.driven = driven++;
  if (driven > max_joints)
    top.error("axis", "a machine has at most " + std::to_string(max_joints) + " driven axes");
  state.machine.driven_.assign(static_cast<std::size_t>(driven), 0);
  check_names(axles);
  check_parents(axles);
  for (const Axle& axle : axles)
    if (!axle.sense) state.open_senses.insert(axle.joint.name);
  grow(axles, state.machine);
}

}  // namespace aircut::machine
