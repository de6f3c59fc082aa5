// G70 (finish), G71 (rough along Z) and G72 (rough along X) of LinuxCNC: Q names the sub with the
// contour, X Z the start point, D what is left on the contour, I the depth of a pass, R the way out
// of a cut. G71.1 and G72.1 leave pockets alone, G71.2 and G72.2 cut nothing but them.
#include <cmath>
#include <limits>

#include "interp/codes/codes.h"
#include "interp/codes/turning.h"
#include "interp/contour_reader.h"

namespace aircut::interp {
namespace {

constexpr std::size_t max_moves = 100'000;
constexpr double narrow_corner = 0.01;  // mm; the control gives no arc to corners below it

bool words_fit(const CodeRule& rule, BlockRun& run) {
  const auto fail = [&](const char* kind, Place place, std::string text) {
    run.error(kind, place, std::move(text));
    return false;
  };
  const std::string name = name_of(rule);
  if (run.state.plane != canon::Plane::zx)
    return fail("contour_error", run.place(rule), name + " needs the ZX plane; give G18 before");
  if (run.state.comp.side != CompSide::off)
    return fail("comp_illegal", run.place(rule),
                name + " can't be used while radius compensation is on; give G40 before");
  if (!run.has('Q'))
    return fail("word_missing", run.place(rule), name + " needs Q: the sub with the contour");
  if (run.has('I') && *run.number('I') <= 0)
    return fail("word_value", run.place('I'), "I, the depth of a pass, must be above 0");
  if (run.has('R') && *run.number('R') < 0)
    return fail("word_value", run.place('R'), "R, the way out of a cut, can't be negative");
  return feed_is_set(run, rule);
}

void ask_for_contour(const CodeRule& rule, BlockRun& run) {
  if (!words_fit(rule, run)) return;
  const auto label = run.integer('Q', 0, std::numeric_limits<int>::max(), "bad_label");
  if (!label) return;
  if (rule.code == 700 && run.has('P') && !run.integer('P', 1, 10'000)) return;
  const auto start = target_of(run);
  if (!start) return;
  run.flow.kind = FlowRequest::Kind::contour;
  run.flow.cycle = &rule;
  run.flow.label = *label;
  run.flow.contour_start = *start;
}

// G71 cuts along Z, G72 along X. G70 takes the contour in either direction.
TurningMotion::Passes passes_of(const CodeRule& rule, const Contour& read) {
  if (rule.code != 700)
    return rule.code >= 720 ? TurningMotion::Passes::along_x : TurningMotion::Passes::along_z;
  Contour along_z;
  for (std::size_t i = 1; i < read.size(); ++i)
    along_z.push_back(
        mirrored(read[i], working_orientation(Contour(read.begin() + 1, read.end()))));
  return first_going_back(along_z, false) ? TurningMotion::Passes::along_x
                                          : TurningMotion::Passes::along_z;
}

class ContourTurning {
 public:
  ContourTurning(const CodeRule& rule, BlockRun& run)
      : rule_(rule), run_(run), motion_(rule, run, passes_of(rule, run.contour->contour())) {}

  void execute() {
    const AxisValues start = *target_of(run_);
    run_.emit(canon::Rapid{start}, name_of(rule_) + " to the start");
    run_.state.tip = start;
    if (!prepare()) return;
    if (rule_.code == 700)
      finish();
    else
      rough_out();
    run_.state.motion = 10;  // the cycle ends as a feed move
  }

 private:
  bool prepare();
  bool with_allowance(double distance);
  void finish();
  void rough_out();

  const CodeRule& rule_;
  BlockRun& run_;
  TurningMotion motion_;
  Contour body_;      // without the approach
  Contour approach_;  // from the start point to the first point, with its corner
  PlanePoint start_;
};

// Brings the contour into working orientation and checks that it can be cut.
bool ContourTurning::prepare() {
  const Contour read = motion_.plane_contour(run_.contour->contour());
  if (read.size() < 2) {
    run_.error("contour_error", 'Q',
               "the contour has less than two moves; the first one leads to its first point");
    return false;
  }
  const Contour rest(read.begin() + 1, read.end());
  motion_.orient(rest);
  for (const ContourPiece& piece : rest) body_.push_back(motion_.to_work(piece));
  if (const auto back = first_going_back(body_, false)) {
    run_.error("contour_error", 'Q',
               "the contour goes back along " + std::string(rule_.code >= 720 ? "X" : "Z") +
                   " in line " + std::to_string(run_.contour->line_of(*back + 1)) +
                   "; the cycle can cut it in one direction only");
    return false;
  }
  start_ = motion_.to_work(read.front()).start;
  return true;
}

// The contour with `distance` left on it, the approach in front and, when it roughs, up to the
// level of the start at its end.
bool ContourTurning::with_allowance(double distance) {
  Contour moved = offset(body_, distance, narrow_corner);
  if (moved.empty()) {
    run_.error("contour_error", run_.has('D') ? run_.place('D') : run_.place(rule_),
               "nothing of the contour is left at this allowance");
    return false;
  }
  ContourPiece approach;
  approach.start = {std::max(start_.u, body_.front().start.u), start_.v};
  approach.end = moved.front().start;
  approach_ = {approach};
  approach_.insert(approach_.end(), moved.begin(), moved.end());
  if (rule_.code != 700 && approach_.back().end.v < start_.v) {
    ContourPiece closing;
    closing.start = approach_.back().end;
    closing.end = {closing.start.u, start_.v};
    approach_.push_back(closing);
  }
  return true;
}

void ContourTurning::finish() {
  const double last = run_.length('E'), first = run_.length('D');
  const int passes = static_cast<int>(run_.number_or('P', 1) + 0.5);
  for (int i = 1; i <= passes; ++i) {
    if (!with_allowance(last + (first - last) * (passes - i) / passes)) return;
    motion_.rapid(approach_.front().start, "to the start");
    motion_.rapid(approach_.front().end, "to the contour");
    for (std::size_t k = 1; k < approach_.size(); ++k) motion_.follow(approach_[k], "contour");
  }
}

void ContourTurning::rough_out() {
  if (!with_allowance(run_.length('D'))) return;
  if (approach_.front().end.v > start_.v + 1e-9)
    return run_.error("contour_error", run_.place(rule_),
                      "the contour begins beyond the start point; the start must lie outside of "
                      "the stock");
  Roughing options;
  options.depth = run_.has('I') ? run_.length('I') : run_.state.unit_mm();
  options.escape = run_.has('R') ? run_.length('R') : 0.5 * run_.state.unit_mm();
  options.pockets = rule_.code % 10 == 1   ? Roughing::Pockets::leave
                    : rule_.code % 10 == 2 ? Roughing::Pockets::only
                                           : Roughing::Pockets::cut;
  std::string problem;
  const auto moves = rough(approach_, options, max_moves, problem);
  if (!moves)
    return run_.error("limit_reached", run_.has('I') ? run_.place('I') : run_.place(rule_),
                      problem + "; use a larger I");
  for (const CutterMove& move : *moves) motion_.make(move);
}

}  // namespace

void contour_turning(const CodeRule& rule, BlockRun& run) {
  if (!run.contour) return ask_for_contour(rule, run);
  ContourTurning(rule, run).execute();
}

}  // namespace aircut::interp
