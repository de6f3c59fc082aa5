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
      {"probe_contact", "a probe touches something while no probing move is active",
       "The tip of a tool with `probe = true` (tools.toml) meets a body in a move that is not G38 "
       "(or\n"
       "Fanuc's G31): the probe would break, or the control stop. Coming off what the last probing "
       "move\n"
       "has touched is no contact.\n"
       "Remedy: approach with G38.3, or stay farther away."},
      {"probe_missed", "a probing move that must touch something does not",
       "G38.2 came to its end without touching anything, G38.4 without coming off, or the probe "
       "was "
       "in\n"
       "that state already where the move began. The control stops the program there, and so does "
       "the run.\n"
       "Remedy: probe farther, correct the work offset or the set-up, or use G38.3 or G38.5 and "
       "look at\n"
       "#5070."},
      {"overtravel", "a joint passes its limit",
       "A joint leaves its range at some time of the move, also between the end points of an arc "
       "or of\n"
       "a straight move on a machine whose joints are not its axes. The message gives the joint, "
       "how far\n"
       "it goes and the part of the move.\n"
       "Remedy: move the work offset, clamp the part elsewhere, or split the move."},
      {"overtravel_margin", "a joint comes close to its limit",
       "A joint comes nearer than 1 mm or 1° to the end of its range without passing it: a small\n"
       "change of the offset or of the tool's length and the move stops. Told where a joint comes\n"
       "into that margin, not while it stays there, and not at the end at which it has its home.\n"
       "At most 100 places are listed, the nearest ones.\n"
       "Remedy: move the work offset, or clamp the part elsewhere."},
      {"unreachable", "the machine has no joint values for a pose on the path",
       "The inverse kinematics has no solution somewhere on the path (a rod too short, an arm "
       "stretched).\n"
       "Planning ends at the last reachable point, since nothing after it is defined; the rest of "
       "the\n"
       "program was not checked."},
      {"singular", "the machine can't pass a pose at any speed",
       "At a singular pose a joint would need an unlimited speed. Planning ends there."},
      {"axis_unwind", "a rotary joint turns back, or winds up",
       "A rotary joint travels more than 180° in a block at whose end the tool points the same "
       "way\n"
       "(within 10°) as at its start, seen from the work: the program takes the long way round, "
       "or\n"
       "the control unwinds the axis in the middle of a cut. Or a joint that has an end (wrap =\n"
       "\"none\") is more than 720° from where it began: cables and hoses wind up with it.\n"
       "Remedy: let the post choose the nearer angle, split the path with a retract; where the "
       "turn\n"
       "is meant, accept it: --waive axis_unwind=REASON. At most 100 blocks are listed."},
      {"feed_not_reached", "a feed move stays far below its F",
       "Over more than a tenth of the block's way the tool stays under half of the programmed "
       "feed,\n"
       "because the machine can't accelerate so fast, or a joint is at its top speed. The chip "
       "gets\n"
       "thinner than the program says, and the time longer. The 20 blocks that lose most time are\n"
       "listed.\n"
       "Remedy: G64 with a tolerance in place of exact stops, longer moves, or a lower F."},
      {"sync_limit", "an axis can't follow the spindle",
       "In threading and rigid tapping (G33, G33.1) the axis must go its pitch per revolution. "
       "Here "
       "the\n"
       "spindle asks for more than the axis can do, or the way is too short for the axis to start "
       "and\n"
       "catch up, so the thread is not what the program says.\n"
       "Remedy: a lower S, or a longer way before the thread begins."},
      {"rapid_cut", "the cutter takes material during a rapid",
       "A move at rapid (G0, the rapids of a cycle, G28, G30, a tool change) goes through stock "
       "that\n"
       "is still there at that moment: deeper than 0.01 mm along a ray, or more than 0.01 mm³.\n"
       "Remedy: retract to a clear height first, raise the cycle's R plane, or correct the work\n"
       "offset or the tool's length offset (G43 H)."},
      {"spindle_stopped_cut", "the cutter takes material while the spindle stands",
       "A feed move takes material with the spindle off, or with S0. Without stock nobody knows\n"
       "whether a move at the feed cuts: then this is a warning at the first one after M5, M6 or "
       "the\n"
       "start, and a tool with which the program probes (G38) is not told about.\n"
       "Remedy: M3 and S before the move; look for an M5 or a tool change before it."},
      {"spindle_direction_cut", "the cutter takes material while it turns backwards",
       "The spindle turns against the tool's cutting direction: M4 with a right-hand tool, M3 with "
       "a\n"
       "left-hand one (tools.toml: hand = \"left\").\n"
       "Remedy: use the other direction, or correct the tool's description."},
      {"no_tool_cut", "the bare spindle goes through stock",
       "The program moves where stock is, with no tool in the spindle or with one that is not in "
       "the\n"
       "tool table.\n"
       "Remedy: T and M6 before the move, or add the tool to the tool file."},
      {"plunge_not_center_cutting", "a tool that can't cut at its centre is moved straight down",
       "The tool is described with center_cutting = false and a feed move takes material within "
       "3°\n"
       "of its axis.\n"
       "Remedy: enter by a ramp or a helix, drill first, or correct the tool's description."},
      {"engagement_limit", "a cut asks more of the tool than its limits",
       "The tool file gives limits: max_depth (along the axis), max_width (across the feed),\n"
       "max_engagement (angle), max_removal (volume per minute) and, with `teeth`, max_chip_load\n"
       "(feed per tooth). Here the cut passes one of them. Depth, width and angle are measured in\n"
       "the stock of that moment, on its lattice, so they may be up to a pitch larger than told.\n"
       "Remedy: a smaller depth or step-over, a lower F, a higher S; see the message for which.\n"
       "At most 1000 places are listed, those farthest beyond their limits."},
      {"loose_piece", "a piece of the stock comes loose",
       "After this line the stock is in separate pieces, and one of them is not held: no fixture\n"
       "and no body that carries the stock touches it. (Where nothing touches any of them the\n"
       "largest counts as held.) Loose pieces jam, break tools and fly. Pieces under 1 mm³ or "
       "some\n"
       "cells of the lattice don't count.\n"
       "Remedy: leave tabs, clamp it, or turn it all to chips."},
      {"air_cut", "a long feed move takes nothing",
       "A feed move of more than 20 mm removes no material: time is lost, or something stands\n"
       "elsewhere than the program thinks (work offset, length offset, stock)."},
      {"gouge", "the result is cut into the part",
       "With [part] in the set-up the stock that is left is compared with the design at the end:\n"
       "at this place it lies inside the part by more than the tolerance (0.02 mm, or `gouge` in\n"
       "[part]). The line is the one that cut deepest near there.\n"
       "Remedy: see `gouge_live` of the same place; or correct the part's place in [part]."},
      {"gouge_live", "the cutter goes into the part",
       "While this line was executed, the cutter took material that belongs to the part, deeper\n"
       "than the tolerance (0.02 mm, or `gouge` in [part]). What an earlier line took there is "
       "not\n"
       "told again.\n"
       "Remedy: check the depth, the tool's length and radius offsets, the work offset, and where\n"
       "the part stands ([part] place)."},
      {"excess", "material is left on the part",
       "With [part] in the set-up the stock that is left is compared with the design at the end:\n"
       "at this place it stands out of the part by more than the tolerance (0.05 mm, or `excess`,\n"
       "plus `allowance`). Where it shall stay, say so: [[part.leave]] low = [x, y, z], high = …\n"
       "Remedy: machine it, or raise the allowance, or leave it."},
      {"wrong_setup", "the stock does not contain the part",
       "The part of [part] stands out of the raw piece before anything is cut, so it can't be "
       "made\n"
       "from it. Mostly the place of one of them is wrong.\n"
       "Remedy: correct `place` and `angle` of [stock] or [part], the unit of a mesh, or the "
       "sizes."},
      {"branch_flip", "a joint jumps to another solution of the inverse kinematics",
       "At one moment of the planned motion a joint is elsewhere than just before: the inverse\n"
       "kinematics has several solutions, and another one was taken. No machine can follow that.\n"
       "In a rapid it is a warning.\n"
       "Remedy: turn or move the part, so that the path stays clear of the pose where the\n"
       "solutions meet (see `aircut kin jac` for how near it is)."},
      {"velocity_limit", "a joint is planned faster than it can move",
       "The finished plan is judged anew, with the joints from the inverse kinematics: here a "
       "joint\n"
       "is more than 0.1 % faster than its limit. That is a fault of the plan and should never be\n"
       "seen; it is told rather than hidden.\n"
       "Remedy: a lower feed; and please report it."},
      {"acceleration_limit", "a joint is planned with more acceleration than it has",
       "As `velocity_limit`, of the joint's acceleration.\n"
       "Remedy: a lower feed; and please report it."},
      {"jerk_limit", "a joint is planned with more jerk than it is allowed",
       "As `velocity_limit`, of the joint's jerk, where the machine limits it.\n"
       "Remedy: a lower feed; and please report it."},
      {"path_deviation", "the planned path leaves the programmed one",
       "The finished plan is compared with the program's lines and arcs: here the tip is farther "
       "off\n"
       "than the tolerance in force (G64 P, and Q for lines that are joined; none with G61). That "
       "is\n"
       "a fault of the plan and should never be seen; it is told rather than hidden.\n"
       "Remedy: G61; and please report it."},
      {"dynamics_limit", "a joint's acceleration or jerk limit is passed",
       "The planner looks at every sample that the joint log will hold. Where a limit is passed it "
       "plans\n"
       "again with less, at last from rest to rest and as slowly as it takes, so this should never "
       "be\n"
       "seen. It is told rather than hidden.\n"
       "Remedy: a lower feed; and please report it."},
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
      {"spindle_conflict", "two channels command one spindle differently",
       "Two channels of a machine run at once and work in the same spindle: the one has it at a\n"
       "speed or direction that is not the other's. Which one the machine obeys is not known. The\n"
       "message names the blocks of both.\n"
       "Remedy: command the spindle in one channel, or with the same S in both, and change it\n"
       "between two wait codes (docs/channels.md)."},
      {"axis_conflict", "two channels move one axis",
       "Two channels of a machine run at once and both drive this axis: they move it at the same\n"
       "time, or the second one moves it from where it left it, while the first has moved it on.\n"
       "Remedy: let one channel move it, and the other wait until it is back where it was."},
      {"wait_deadlock", "a channel waits for ever",
       "A channel has come to a wait code ([wait] in machine.toml) that the others never come to:\n"
       "they wait at another code or with another P, they have ended, or they do not run. The\n"
       "message tells where each of them is. What follows was not checked.\n"
       "Remedy: write the same code with the same P into every channel that it names."},
  };
  return kinds;
}

}  // namespace aircut::sim
