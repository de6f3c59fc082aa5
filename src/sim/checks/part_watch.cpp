#include "sim/checks/part_watch.h"

#include <algorithm>

namespace aircut::sim {

namespace {

constexpr std::size_t most_cuts = 10'000;
constexpr double facets = 0.011;  // mm: surfaces of round raw pieces may be off by this much

std::string place_text(const Vec3& p) {
  return "X " + fixed(p.x(), 2) + " Y " + fixed(p.y(), 2) + " Z " + fixed(p.z(), 2) +
         " of the stock";
}

}  // namespace

Pose at_end(const machine::Machine& machine, const machine::RawStock& raw,
            const JointVector& joints) {
  machine::LinkPoses poses;
  machine::forward(machine, joints, poses);
  return poses.X_WL[static_cast<std::size_t>(machine::index(raw.link))] * raw.X_LS;
}

Finding end_of_run(double t, const JointVector& joints) {
  Finding end;
  end.t_first = end.t_worst = end.t_end = end.t_block = end.t_block_end = t;
  end.joints_first = end.joints_worst = joints;
  end.body_a = "stock";
  end.body_b = "part";
  end.pair = "stock-part";
  return end;
}

Expected<PartWatch> PartWatch::make(const machine::DesignPart& design, const machine::RawStock& raw,
                                    double pitch, Findings& out) {
  auto part = stock::Part::make(design.mesh, pitch);
  if (!part) return unexpected(part.error());
  // The surface of a saved stock is a mesh made on its lattice.
  const double tolerance =
      design.gouge + (raw.shape == machine::StockShape::saved ? pitch / 2 : facets);
  if (const stock::Spot worst = part->outside_of(*raw.mesh); worst.depth > tolerance) {
    Finding f;
    f.kind = Kind::wrong_setup;
    f.severity = severity_of(f.kind);
    f.span = design.span;
    f.body_a = "part";
    f.body_b = "stock";
    f.pair = "part-stock";
    f.depth = worst.depth;
    f.depth_bound = pitch / 2;
    f.message = "the part stands out of the raw piece by " + fixed(worst.depth, 2) + " mm at " +
                place_text(worst.point);
    f.remedy = "correct `place` or `angle` of [part] or [stock], the mesh's unit, or the sizes";
    out.add(f);
  }
  return PartWatch(design, std::move(*part), pitch);
}

Expected<stock::Touch> PartWatch::depth(const stock::Piece& piece) const {
  return part_.cut_into(piece, design_.gouge);
}

Expected<void> PartWatch::take(const stock::Piece& piece, const Finding& row,
                               const stock::Touch& touch) {
  note(row, touch);
  return part_.take(piece, touch.depth);
}

void PartWatch::describe(Finding& row, const std::string& cutter) const {
  row.body_b = "part";
  row.pair = "cutter-part";
  row.message = "cutter `" + cutter + "` goes into the part";
  row.depth_bound = bound();
  row.limit = design_.gouge;
  row.unit = "mm";
}

void PartWatch::note(const Finding& row, const stock::Touch& touch) {
  if (cuts_.size() < most_cuts) cuts_.push_back({row, touch});
}

// The deepest place that a piece made lies in or at the spot that it belongs to; of several, the
// nearest to the spot's own deepest place.
const PartWatch::Cut* PartWatch::who_cut(const stock::Spot& spot) const {
  const Cut* best = nullptr;
  double nearest = 0;
  for (const Cut& cut : cuts_) {
    const double away = spot.box.exteriorDistance(cut.touch.point);
    if (away > 2 * pitch_) continue;
    const double distance = (cut.touch.point - spot.point).norm();
    if (best && distance >= nearest) continue;
    best = &cut;
    nearest = distance;
  }
  return best;
}

Summary::Part PartWatch::tell(const stock::Deviation& found, const Pose& X_WS, const Finding& end,
                              Findings& out) const {
  const auto row = [&](Finding f, Kind kind, const stock::Spot& spot, double limit) {
    f.kind = kind;
    f.severity = severity_of(kind);
    f.depth = spot.depth;
    f.depth_bound = bound();
    f.value = spot.depth;
    f.limit = limit;
    f.unit = "mm";
    f.message = kind == Kind::gouge
                    ? "the result is cut " + fixed(spot.depth, 3) + " mm into the part at "
                    : fixed(spot.depth, 3) + " mm of material is left on the part at ";
    f.message += place_text(spot.point);
    out.add(std::move(f));
  };
  for (const stock::Spot& spot : found.gouges) {
    const Cut* cut = who_cut(spot);
    Finding f = cut ? cut->row : end;
    if (!cut) f.points = {X_WS * spot.point};
    f.body_a = "stock";
    f.body_b = "part";
    f.pair = "stock-part";
    f.remedy = cut ? f.remedy : "the part was not cut here by this job: see [stock] and [part]";
    row(std::move(f), Kind::gouge, spot, design_.gouge);
  }
  for (const stock::Spot& spot : found.excesses) {
    Finding f = end;
    f.points = {X_WS * spot.point};
    f.remedy = "machine it, or say that it stays: `allowance` or [[part.leave]]";
    row(std::move(f), Kind::excess, spot, design_.excess + design_.allowance);
  }
  Summary::Part part;
  part.gouge = found.gouge;
  part.excess = found.excess;
  part.tol_gouge = design_.gouge;
  part.tol_excess = design_.excess;
  part.allowance = design_.allowance;
  part.bound = bound();
  part.points = found.points;
  part.gouges = found.gouges.size() + found.gouges_dropped;
  part.excesses = found.excesses.size() + found.excesses_dropped;
  return part;
}

}  // namespace aircut::sim
