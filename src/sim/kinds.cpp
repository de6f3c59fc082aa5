#include "sim/sim.h"

namespace aircut::sim {

const std::vector<KindText>& finding_kinds() {
  static const std::vector<KindText> kinds = {
      {"collision", "two bodies that must stay apart overlap during the motion",
       "A watched pair of bodies overlaps by more than the contact tolerance (0.001 mm) somewhere "
       "in\n"
       "the move, not only at its ends: the whole motion is proven, so a thin plate crossed by a "
       "rapid\n"
       "is found too. The message gives the part of the move, the deepest point, and how far the "
       "tool\n"
       "has to come up along its axis to clear.\n"
       "Remedy: retract before the sideways move, raise the clearance plane, use a longer "
       "stick-out,\n"
       "or move the fixture (--setup). Pairs that touch by design are excluded in machine.toml "
       "with a\n"
       "reason, and the report lists them."},
      {"near_miss", "two bodies come closer than the margin without touching",
       "The smallest distance is proven as an interval. The margin is --near MM (2 mm by default, "
       "0\n"
       "turns it off). With `unresolved` neither contact nor clearance could be proven: the bodies "
       "come\n"
       "within the machine's collision tolerance of touching, and the verdict can't be pass."},
      {"self_overlap", "bodies overlap before anything moves",
       "The machine model, the tool or the set-up is wrong: a fixture stands inside the table, a "
       "mesh has\n"
       "the wrong unit, a part of the machine always touches its neighbour. The pair is named once "
       "and\n"
       "then left out of the checks.\n"
       "Remedy: correct the model, or exclude the pair by name with a reason:\n"
       "  [collision]\n  ignore = [{ bodies = [\"way-cover\", \"bed\"], reason = \"slides on it\" "
       "}]"},
      {"tool_change_collision", "the new tool is inside something as soon as it is in the spindle",
       "After a tool change the new tool and its holder are checked where the machine stands.\n"
       "Remedy: retract further before M6; check the tool's length and holder."},
      {"overtravel", "a joint passes its limit",
       "A joint leaves its range at some time of the move, also between the end points of an arc "
       "or of\n"
       "a straight move on a machine whose joints are not its axes. The message gives the joint, "
       "how far\n"
       "it goes and the part of the move.\n"
       "Remedy: move the work offset, clamp the part elsewhere, or split the move."},
      {"unreachable", "the machine has no joint values for a pose on the path",
       "The inverse kinematics has no solution somewhere on the path (a rod too short, an arm "
       "stretched).\n"
       "Planning ends at the last reachable point, since nothing after it is defined; the rest of "
       "the\n"
       "program was not checked."},
      {"singular", "the machine can't pass a pose at any speed",
       "At a singular pose a joint would need an unlimited speed. Planning ends there."},
      {"sync_limit", "an axis can't follow the spindle",
       "In threading and rigid tapping (G33, G33.1) the axis must go its pitch per revolution. "
       "Here "
       "the\n"
       "spindle asks for more than the axis can do, or the way is too short for the axis to start "
       "and\n"
       "catch up, so the thread is not what the program says.\n"
       "Remedy: a lower S, or a longer way before the thread begins."},
      {"tool_missing", "a tool is changed in that is not in the tool table",
       "The tool number of M6 or M61 has no entry in the tool file, so its shape and length are "
       "unknown.\n"
       "Remedy: add the tool, or name another file with --tools."},
      {"not_executed", "a user M-code or remap was not run",
       "M100 to M199 start programs on the control. They are never run here, so what they do to "
       "the\n"
       "machine is unknown and the verdict can't be pass.\n"
       "Remedy: say in machine.toml what the code means: [mcodes] M110 = { kind = \"ignore\" }."},
      {"not_checked", "something could not be checked",
       "A tool without geometry, or a move for which no bound of the motion is known. What was "
       "not\n"
       "checked is never called fine: the verdict is unknown."},
  };
  return kinds;
}

}  // namespace aircut::sim
