// One call of the rotation cycle CYCLE600, from its text to its result registers.
#pragma once

#include "machine/rotation/rotation.h"

namespace aircut::machine {

struct Cycle600 {
  RotationStep step;         ///< angles rad, lengths mm
  std::string head;          ///< _MIHEAD
  bool only_compute = true;  ///< _SW_REC
  RotationConvention out;    ///< _INEXOUT, _BIN_OUT
  bool additive = false;     ///< _ROT_AD
  bool inverse = false;      ///< _ROT_INV
  bool retract = false;      ///< _RETR_Z
};

/// `CYCLE600(1, "IFVW207", 1, 57, …)` or only its 18 values; angles in degrees. The error names the
/// argument that is wrong.
tl::expected<Cycle600, std::string> read_cycle600(std::string_view text);

struct Cycle600Result {
  Pose frame = Pose::Identity();
  RotationAngles angles;  ///< registers 2 to 4, by `out`
};
/// The new frame, on top of `previous` when the call is additive.
Cycle600Result run(const Cycle600& call, const Pose& previous);

}  // namespace aircut::machine
