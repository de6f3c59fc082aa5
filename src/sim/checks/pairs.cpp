#include "sim/checks/pairs.h"

#include <map>

namespace aircut::sim {

using machine::Body;
using machine::Role;

bool is_tool(Role role) {
  return role == Role::holder || role == Role::shank || role == Role::cutter || role == Role::probe;
}

std::string in_words(const Body& body) {
  const std::string name = "`" + body.name + "`";
  switch (body.role) {
    case Role::holder:
      return "tool holder " + name;
    case Role::shank:
      return "tool shank " + name;
    case Role::cutter:
      return "cutter " + name;
    case Role::fixture:
      return "fixture " + name;
    case Role::spindle:
      return "spindle " + name;
    case Role::probe:
      return "probe " + name;
    case Role::stock:
      return "stock " + name;
    case Role::part:
      return "part " + name;
    case Role::machine:
      return "machine part " + name;
  }
  return name;
}

namespace {

bool is_machine(Role role) { return role == Role::machine || role == Role::spindle; }

// The body that a person would name first: the tool's, then the spindle's, fixtures last.
int rank(Role role) {
  switch (role) {
    case Role::holder:
    case Role::shank:
    case Role::cutter:
    case Role::probe:
      return 0;
    case Role::spindle:
      return 1;
    case Role::machine:
      return 2;
    case Role::stock:
    case Role::part:
    case Role::fixture:
      return 3;
  }
  return 3;
}

// An exclusion by name is told in `exclusions`.
bool watched(const Scene& scene, const SceneBody& a, const SceneBody& b,
             ToolAndStock tool_and_stock, std::vector<std::string>& exclusions) {
  if (!a.collision || !b.collision || a.body.link == b.body.link) return false;
  const Role ra = a.body.role, rb = b.body.role;
  if (ra == Role::part || rb == Role::part) return false;
  // The tool against the stock of the moment: cutting.h.
  if (tool_and_stock == ToolAndStock::left_out &&
      ((is_tool(ra) && rb == Role::stock) || (is_tool(rb) && ra == Role::stock)))
    return false;
  if ((ra == Role::fixture && rb == Role::stock) || (rb == Role::fixture && ra == Role::stock))
    return false;
  if (ra == Role::fixture && rb == Role::fixture) return false;
  const auto& links = scene.machine().links();
  const machine::Link& la = links[static_cast<std::size_t>(index(a.body.link))];
  const machine::Link& lb = links[static_cast<std::size_t>(index(b.body.link))];
  const bool adjacent =
      (la.joint >= 0 && la.parent == b.body.link) || (lb.joint >= 0 && lb.parent == a.body.link);
  if (adjacent && is_machine(ra) && is_machine(rb)) return false;
  for (const machine::Exclusion& e : scene.machine().exclusions()) {
    const auto names = [&](const std::string& name, const SceneBody& body,
                           const machine::Link& link) {
      return name == body.body.name || name == link.name || body.body.name.starts_with(name + "/");
    };
    if ((names(e.a, a, la) && names(e.b, b, lb)) || (names(e.a, b, lb) && names(e.b, a, la))) {
      exclusions.push_back(a.body.name + " – " + b.body.name + ": " + e.reason);
      return false;
    }
  }
  return true;
}

}  // namespace

WatchedPairs watched_pairs(const Scene& scene, const std::vector<Pair>& before,
                           ToolAndStock tool_and_stock) {
  std::map<std::string, bool> left_out;
  for (const Pair& pair : before) left_out[pair.name] = pair.left_out;
  WatchedPairs out;
  const auto& bodies = scene.bodies();
  for (const SceneBody& body : bodies)
    if (!body.collision)
      out.exclusions.push_back(body.body.name +
                               " – everything: it is only drawn (collide = false)");
  for (std::size_t i = 0; i < bodies.size(); ++i)
    for (std::size_t j = i + 1; j < bodies.size(); ++j) {
      if (!watched(scene, bodies[i], bodies[j], tool_and_stock, out.exclusions)) continue;
      const bool swap = rank(bodies[j].body.role) < rank(bodies[i].body.role);
      Pair pair;
      pair.a = swap ? j : i;
      pair.b = swap ? i : j;
      pair.name = bodies[pair.a].body.name + "\n" + bodies[pair.b].body.name;
      if (const auto known = left_out.find(pair.name); known != left_out.end())
        pair.left_out = known->second;
      out.pairs.push_back(std::move(pair));
    }
  return out;
}

}  // namespace aircut::sim
