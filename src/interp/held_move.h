// A move that can't be made before the next one is known: its corner is rounded or cut off (`,R`,
// `,C`), or only its direction is given (`,A`). Fanuc-like controls.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "interp/block.h"
#include "interp/compensation.h"
#include "interp/contour.h"
#include "interp/corner.h"

namespace aircut::interp {

class BlockRun;
struct CodeRule;

/// What a line says about the corner at its end.
struct CornerRequest {
  CornerWord word;
  char letter = 0;  ///< r c (with a comma), R C I K (lathes); 0: no corner
  int sign = 0;     ///< of the number
};
/// The request of the line's words; an error when they do not fit together.
CornerRequest corner_request(BlockRun& run, const CodeRule& motion);
/// Why the request can't be met between these two pieces (u is Z and v is X for the words of
/// lathes), or nothing. `doubt` is filled in when it depends on a setting of the control.
std::optional<std::string> corner_problem(const CornerRequest& request, const ContourPiece& before,
                                          const ContourPiece& after, std::string& doubt);
/// True when the control makes no corner, because the two pieces run on within a degree.
bool runs_straight_on(const ContourPiece& before, const ContourPiece& after);

/// The angle word of a lathe's line (,A or A) in rad, counter-clockwise from +Z; nothing without.
std::optional<double> line_angle(const BlockRun& run);
/// Where a line under the angle reaches the coordinate that is given. Nothing when it never does.
std::optional<PlanePoint> end_under_angle(PlanePoint start, double angle, std::optional<double> u,
                                          std::optional<double> v);
/// Where the line from `start` under `first` meets the one that runs to `end` under `second`.
std::optional<PlanePoint> meeting_point(PlanePoint start, double first, PlanePoint end,
                                        double second);

struct HeldMove {
  PlannedMove move;
  AxisValues from;  ///< where it begins, as programmed
  CornerRequest corner;
  std::optional<double> angle;  ///< rad: the line's end is where it meets the next line
  Place place;                  ///< of the word, in its block
  canon::Command head;          ///< carries the block's place
  AxisValues tip_before;        ///< of the state
  AxisValues programmed_before;
  std::vector<canon::Command> waiting;  ///< what the next block gives in front of its move
};

/// True when no move waits or has to wait for another one: a move is made as it is programmed.
bool is_free(const BlockRun& run);
/// Makes a move of G1 to G3 as the line says: now, or when the next one has come.
void make_move(BlockRun& run, const CodeRule& rule, const PlannedMove& move);
/// Makes it now, through radius compensation where that is on.
void deliver(BlockRun& run, const PlannedMove& move);
/// A G1 line of a lathe that has an angle.
void line_by_angle(const CodeRule& rule, BlockRun& run, double angle);
/// Whether the control goes on to this block with a corner pending: a move of G1 to G3, a dwell, or
/// a block without words.
bool may_follow_corner(const Block& block, const ModalState& state);
/// Makes the held move as it is programmed, without its corner.
void release_held(BlockRun& run);

}  // namespace aircut::interp
