#include "accuracy/evaluate.h"

namespace aircut::accuracy {

const std::vector<KindText>& kinds() {
  static const std::vector<KindText> all = {
      {"accuracy_invalid", "the accuracy set-up is wrong",
       "A key is unknown or missing, a matrix has not three rows of three, or a number is not\n"
       "finite. The message has line and column; docs/accuracy.md lists all keys."},
      {"accuracy_range", "a number that can't be",
       "A speed, diameter, number of teeth, entering angle, band or allowance lies outside of "
       "what\n"
       "is possible, such as V = 0 or kappa_deg = 180. The message says what would be."},
      {"accuracy_reference", "a name or number that the set-up does not have",
       "A tool or work names a body that is not there, a contact a tool, a tool a material, or "
       "the\n"
       "material lacks the law that the cut needs. The nearest known name is suggested."},
      {"body_tree", "the bodies form no tree",
       "A parent is missing, two bodies have the same name, the parents go round in a circle, or "
       "a\n"
       "body hangs on a beam. Every chain of parents must end at a body without one: it stands on\n"
       "the ground."},
      {"not_a_rotation", "R is no rotation",
       "The columns of R are the body's own axes in the machine's: three unit vectors at right\n"
       "angles, right-handed."},
      {"not_passive", "a compliance that gives energy back",
       "Pushing on a joint stores energy, so the symmetric part of e and xi has no negative\n"
       "eigenvalue. A measured matrix that has one was usually read with a probe or a load turned\n"
       "round: sign_policy = \"row_flip\" or \"column_flip\" repairs that, \"as_given\" uses it "
       "as\n"
       "it is."},
      {"matrix_suspect", "a compliance that is doubtful",
       "Warning. The matrix is used, but is not passive or far from symmetric, so what it says of\n"
       "some direction may be wrong. symmetrize and psd_project make it what a joint can be."},
      {"support_not_invertible", "two supports of which one is rigid",
       "What two supports hold together gives way by (A^-1 + B^-1)^-1, so each of them needs e "
       "and\n"
       "xi that can be inverted. A rigid one needs no second."},
      {"base_point_missing", "a body that turns about an unknown point",
       "Warning. The body has xi but neither base_point nor coupling. The lever arms of its "
       "forces\n"
       "are then measured from the machine's origin."},
      {"law_extrapolated", "a force law used outside of where it was measured",
       "Warning. Depth, feed or speed is outside of the material's 'valid' range. The force is\n"
       "computed by the same law all the same."},
      {"allowance_clipped", "an allowance larger than the depth",
       "Warning. Half of the allowance is more than the depth, so some parts of the batch are not\n"
       "cut there at all; the depth ends at 0."},
      {"no_relative_compliance", "nothing gives way between tool and work",
       "Warning. Both hang on the same bodies, so the forces stay inside of them. The "
       "displacement\n"
       "is 0; name the elastic parts between them."},
      {"displacement_large", "a displacement that is large against the depth",
       "Warning. The tool moves by more than a tenth of its depth. The model is linear; such a\n"
       "result is a rough one. 'coupled = true' at least lets the depth shrink."},
      {"statically_unstable", "a cut that runs away",
       "With 'coupled', a deeper cut pulls the tool deeper still, faster than the machine holds "
       "it\n"
       "back. There is no depth at rest. Usually a sign of a compliance is wrong."},
      {"copying_not_converged", "the real depth was not found",
       "Warning. With 'coupled', Newton's method did not settle in 30 steps; the results are "
       "those\n"
       "of the programmed depth."},
      {"size_error", "a size out of its tolerance",
       "The forces push the tools so far that the size leaves its tolerance. The shares of the\n"
       "bodies in the output say where to look. A correction of the tool's offset may be enough:\n"
       "'compensate = true' assumes it."},
      {"scatter_too_wide", "a batch that scatters out of its tolerance",
       "The size is right on average, but stiffness, material and allowances vary so much that\n"
       "some parts leave the tolerance. Smaller allowances, a stiffer set-up or less force help."},
      {"force_limit", "a cutting force over its limit",
       "The cutting force of a tool is larger than limits.Fc_N. Less depth or feed lowers it."},
      {"power_limit", "more power than the spindle has",
       "The tools on one spindle need more than limits.power_kW together, with the efficiency "
       "eta."},
      {"torque_limit", "more torque than the spindle has",
       "The tools on one spindle need more than limits.torque_Nm together."},
      {"chip_load", "a chip thicker than allowed", "The chip's thickness is above limits.h_max."},
      {"force_unknown", "a cut whose force is not known",
       "Warning. Along a program something is cut of which the accuracy file does not tell the "
       "force:\n"
       "a tool that it does not list, a thread, an end mill that goes straight down, a cutter "
       "without\n"
       "'milling'. Its errors are unknown, and so is the verdict. Complete [[tools]] and their\n"
       "materials."},
      {"chatter_risk", "a cut that is deeper than its vibrations allow",
       "Warning. With the frequency, stiffness and damping of 'mode' the cut chatters from a depth "
       "on\n"
       "that is told; nine tenths of it are reached here. Turned: the depth that is safe at every\n"
       "speed (Tlusty). Milled: the limit at this speed (zeroth order), poor for widths below a "
       "tenth\n"
       "of the diameter. Less depth, another speed, a shorter tool or fewer teeth help."},
      {"deflection", "a tool that moves too far",
       "The tool's tip is displaced against the work by more than limits.deflection_um."},
  };
  return all;
}

}  // namespace aircut::accuracy
