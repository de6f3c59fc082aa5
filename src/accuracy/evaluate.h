// From a set-up to results: segments of time, displacements, shares, fields of scatter, sizes, and
// what is over a limit.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "accuracy/setup.h"

namespace aircut::accuracy {

/// A field of scatter in one direction, mm.
struct Field {
  bool opposed = false;
  FieldCase which = FieldCase::all_positive;
  double N = 0, D = 0;  ///< nominal, and what the allowances add on each side
  double low = 0, high = 0;
  std::optional<Sample> sample;
  double width() const { return high - low; }
};

struct ContactResult {
  std::size_t contact = 0;  ///< place in Setup::contacts
  double t = 0;             ///< the depth that is really cut
  double copy_ratio = 0;    ///< of its own blank's form error (`coupled`)
  Load load;
  Response moved;
  std::optional<double> delta;  ///< normal error; nothing when no normal is known
  std::vector<ErrorShare>
      shares;                  ///< sum to `delta` (without second order); sources are places here
  std::optional<Field> field;  ///< of `delta`
  double P_cut = 0;            ///< N
  double power = 0;            ///< at the motor, kW
  double torque = 0;           ///< about the spindle that turns, N·mm
};

struct SegmentResult {
  std::optional<Span> span;  ///< nothing when the set-up has no times: all cut together
  std::vector<ContactResult> contacts;
  Influence influence{0};
};

struct DimensionResult {
  std::string unchecked;                 ///< the reason when it could not be worked out
  double least = 0, most = 0, mean = 0;  ///< error over the segments, weighted with their time
  Field field;                           ///< hull over the segments; N, D, case of the widest
  std::optional<Capability> capability;
  std::optional<int> it_grade;  ///< finest that holds the field
};

struct Result {
  std::vector<SegmentResult> segments;
  std::vector<DimensionResult> dimensions;  ///< as in Setup::dimensions
};

/// A size's field against its tolerance: sets grade and capability, and reports what is out of it
/// at `place`.
void judge(const Dimension& asked, const SourceSpan& place, DimensionResult& result,
           Diagnostics& out);

/// Findings and warnings go to `out`.
Result evaluate(const Setup& setup, Diagnostics& out);

/// Texts of `aircut explain` for every kind that this library reports.
const std::vector<KindText>& kinds();

}  // namespace aircut::accuracy
