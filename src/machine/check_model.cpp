// What can be said about a machine that was read without error, but may still be a poor model.
#include <algorithm>
#include <cmath>

#include "machine/machine.h"
#include "machine/mesh_check.h"

namespace aircut::machine {

namespace {

void check_size(const Body& body, Diagnostics& out) {
  const Vec3 size = bounds(*body.mesh).sizes();
  // A length unit that was taken for another one is wrong by 25.4 or 1000.
  constexpr double smallest_mm = 1, largest_mm = 2e4;
  if (size.maxCoeff() >= smallest_mm && size.maxCoeff() <= largest_mm) return;
  out.warning("model_suspect", body.span,
              "body '" + body.name + "' is " + fixed(size.maxCoeff(), 3) +
                  " mm long; check the unit of its mesh");
}

void check_surface(const Body& body, Diagnostics& out) {
  if (!without_border(*body.mesh))
    out.warning("mesh_defect", body.span,
                "the mesh of body '" + body.name + "' is open: its surface has a border, so only " +
                    "contact with the surface is found, not what lies inside");
  else if (volume(*body.mesh) <= 0)
    out.warning("mesh_defect", body.span,
                "the mesh of body '" + body.name + "' is inside out: its triangles face inwards");
}

void check_bodies(const Machine& machine, Diagnostics& out) {
  for (const Body& body : machine.bodies()) {
    if (!body.mesh || body.mesh->empty()) {
      out.warning("mesh_defect", body.span, "body '" + body.name + "' has no triangles");
      continue;
    }
    check_size(body, out);
    if (body.collide) check_surface(body, out);
  }
  for (const Link& link : machine.links()) {
    const auto id = machine.find_link(link.name);
    const bool seen = std::any_of(machine.bodies().begin(), machine.bodies().end(),
                                  [&](const Body& body) { return body.link == *id; });
    if (!seen)
      out.add({Severity::info, "model_suspect",
               "link '" + link.name + "' has no body: nothing of it can be checked or drawn"});
  }
  const auto is_spindle = [](const Body& body) { return body.role == Role::spindle; };
  if (std::none_of(machine.bodies().begin(), machine.bodies().end(), is_spindle))
    out.add({Severity::info, "model_suspect", "no body has the role \"spindle\""});
}

}  // namespace

void check_model(const Machine& machine, Diagnostics& out) {
  check_bodies(machine, out);
  if (machine.spindle().max_rpm == 0)
    out.add({Severity::info, "model_suspect",
             "[spindle] has no 'rpm': the spindle's speed is not checked"});
  if (machine.tool_change().seconds == 0)
    out.add({Severity::info, "model_suspect",
             "[toolchange] has no 'time': a tool change takes no time"});
}

}  // namespace aircut::machine
