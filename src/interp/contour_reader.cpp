// Only the way counts: G0 to G3 with X Z U W I K R, F for finishing, and the words for corners.
// Everything else of the blocks is left out, as the controls do; a code that would change the
// meaning of the coordinates is refused.
#include "interp/contour_reader.h"

#include <algorithm>
#include <cmath>

#include "interp/codes/codes.h"

namespace aircut::interp {
namespace {

// Codes that leave the coordinates as they are. Radius compensation does not act in the cycles.
bool is_harmless(const CodeRule& rule) {
  return rule.letter == 'M' || rule.group == ModalGroup::radius_comp ||
         rule.group == ModalGroup::control || rule.phase == Phase::dwell ||
         rule.group == ModalGroup::spindle_mode || rule.code == 180;
}

// The motion of the block, explicit or modal, or nothing with an error.
const CodeRule* motion_of(BlockRun& run) {
  const CodeRule* motion = run.session.table.find_g(run.state.motion);
  for (const Word& word : run.block.words) {
    if (word.letter != 'G' && word.letter != 'M') continue;
    if (!word.rule) {
      run.unknown_code(word);
      return nullptr;
    }
    if (word.rule->group == ModalGroup::motion && word.rule->code <= 30) {
      motion = word.rule;
    } else if (is_harmless(*word.rule)) {
      run.warning("word_ignored", word.place,
                  name_of(*word.rule) + " does nothing in the contour of a turning cycle");
    } else {
      run.error("contour_error", word.place,
                name_of(*word.rule) +
                    " can't stand in the contour of a turning cycle; it takes G0 G1 G2 G3");
      return nullptr;
    }
  }
  return motion;
}

CornerRequest corner_of(BlockRun& run, const CodeRule& motion) {
  if (run.session.options.dialect != Dialect::linuxcnc) return corner_request(run, motion);
  CornerRequest request;
  if (const auto radius = run.number('A'); radius && *radius != 0)
    request.word = {CornerWord::Kind::round, run.length('A')};
  else if (const auto size = run.number('C'); size && *size != 0)
    request.word = {CornerWord::Kind::chamfer_round, run.length('C')};
  return request;
}

}  // namespace

void ContourReader::read(BlockRun& run) {
  const CodeRule* motion = motion_of(run);
  if (!motion) return;
  ModalState& state = run.state;
  state.motion = motion->code;
  if (run.has('F')) feed_ = *run.number('F');
  for (const Axis axis : {Axis::y, Axis::b, Axis::v})
    if (run.has(letter(axis)))
      return run.error("contour_error", letter(axis),
                       std::string("the contour of a turning cycle lies in X and Z; ") +
                           letter(axis) + " can't move in it");
  const bool lathe_line = run.session.table.lathe() && motion->code == 10;
  const auto angle = lathe_line ? line_angle(run) : std::nullopt;
  if (!run.has('X') && !run.has('Z') && !run.has('U') && !run.has('W') && !angle) return;
  AxisValues program = to_program(state, state.tip);
  PlanePoint start{program[Axis::z], program[Axis::x]};
  PlanePoint end = start;
  if (const auto x = run.axis(Axis::x)) end.v = state.incremental ? start.v + *x : *x;
  if (const auto z = run.axis(Axis::z)) end.u = state.incremental ? start.u + *z : *z;
  if (run.has('U')) end.v = start.v + run.length('U') * (state.lathe_diameter ? 0.5 : 1);
  if (run.has('W')) end.u = start.u + run.length('W');
  if (contour_.empty())
    first_names_both_ = (run.has('X') || run.has('U')) && (run.has('Z') || run.has('W'));
  if (angle && !place_by_angle(run, *angle, start, end)) return;
  if (!angle && open_angle_)
    return run.error("corner_error", run.whole(),
                     "behind a line with an angle alone stands one with X, Z and an angle");
  add(run, *motion, start, end);
  program[Axis::z] = end.u;
  program[Axis::x] = end.v;
  state.tip = to_tip(state, program);
}

// What a line's angle says about its end, or about that of the line before it.
bool ContourReader::place_by_angle(BlockRun& run, double angle, PlanePoint& start,
                                   PlanePoint& end) {
  const bool x = run.has('X') || run.has('U'), z = run.has('Z') || run.has('W');
  const Place place = run.has('a') ? run.place('a') : run.place('A');
  std::optional<PlanePoint> found;
  if (open_angle_) {
    if (run.has('X') && run.has('Z')) found = meeting_point(start, *open_angle_, end, angle);
    if (found) {
      contour_.back().end = start = *found;
      open_angle_.reset();
      return true;
    }
    run.error("corner_error", place,
              "behind a line with an angle alone stands one with X, Z and an angle, and the two "
              "lines must meet");
    return false;
  }
  if (!x && !z && run.session.options.dialect == Dialect::fanuc && !contour_.empty()) {
    open_angle_ = angle;
    return true;
  }
  if (x != z)
    found = end_under_angle(start, angle, z ? std::optional(end.u) : std::nullopt,
                            x ? std::optional(end.v) : std::nullopt);
  if (!found) {
    run.error("corner_error", place,
              "a line by its angle has one of X and Z, which it must be able to reach");
    return false;
  }
  end = *found;
  return true;
}

void ContourReader::add(BlockRun& run, const CodeRule& rule, PlanePoint start, PlanePoint end) {
  ContourPiece piece;
  piece.start = start;
  piece.end = end;
  piece.feed = feed_;
  piece.rapid = rule.code == 0;
  if (rule.code >= 20 && !contour_.empty()) {
    const auto centre = arc_centre(run, rule, start, end);
    if (!centre) return;
    piece.centre = *centre;
    piece.turn = rule.code == 30 ? 1 : -1;
  } else if (rule.code >= 20) {
    return run.error("contour_error", rule,
                     "the first move of a contour leads to its first point; it must be G0 or G1");
  }
  if (std::hypot(end.u - start.u, end.v - start.v) < 1e-9 && !contour_.empty() && !open_angle_)
    return;
  contour_.push_back(piece);
  corners_.push_back(corner_of(run, rule));
  lines_.push_back(run.block.line);
}

std::uint64_t ContourReader::line_of(std::size_t piece) const {
  return lines_.empty() ? 0 : lines_[std::min(piece, lines_.size() - 1)];
}

bool ContourReader::finish(std::string& problem, std::string& doubt) {
  if (open_angle_) {
    problem = "the contour ends with a line of which only the angle is given";
    return false;
  }
  Contour whole;
  std::vector<std::uint64_t> lines;
  for (std::size_t i = 0; i < contour_.size(); ++i) {
    whole.push_back(contour_[i]);
    lines.push_back(lines_[i]);
    const CornerRequest& corner = corners_[i];
    if (i + 1 == contour_.size() || corner.word.kind == CornerWord::Kind::none) continue;
    if (const auto wrong = corner_problem(corner, whole.back(), contour_[i + 1], doubt)) {
      problem = "line " + std::to_string(lines_[i]) + ": " + *wrong;
      return false;
    }
    if (corner.letter != 0 && runs_straight_on(whole.back(), contour_[i + 1])) continue;
    const auto cut = cut_corner(whole.back(), contour_[i + 1], corner.word);
    if (!cut) {
      problem = "the corner at the end of line " + std::to_string(lines_[i]) +
                " does not fit on its two moves; use a smaller one";
      return false;
    }
    whole.back().end = cut->start;
    contour_[i + 1].start = cut->end;
    whole.push_back(*cut);
    lines.push_back(lines_[i]);
  }
  contour_ = std::move(whole);
  lines_ = std::move(lines);
  corners_.assign(contour_.size(), {});
  return true;
}

}  // namespace aircut::interp
