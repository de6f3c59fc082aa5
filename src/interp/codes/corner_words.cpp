// Corners between two blocks on Fanuc-like controls, and lines by their angle.
//
//   G1 X40. ,R5.     the next block's move decides what the arc of 5 mm looks like, so this one is
//   G3 X50. Y30. …   held until it comes; then both are cut, and the arc is put between them.
//
// `,C` cuts the corner off: its ends are that far from the corner. On lathes R and C do the same
// without a comma, and I and K are a chamfer of 45 degrees between a line along one axis and one
// along the other: I at the end of a move in Z, K at that of a move in X, the sign says where the
// next move goes.
//
// `,A` (lathes) is the angle of a line from +Z. With X or Z the other coordinate follows; without
// both, the end is where the line meets the next one, which has X, Z and an angle of its own.
//
// Only a dwell may stand between the two blocks; settings and statements of macro B do not count,
// as the control has done them when it reads on. Radius compensation comes afterwards: it sees the
// two moves and the corner as three.
#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "interp/codes/codes.h"
#include "interp/dialect.h"
#include "interp/held_move.h"

namespace aircut::interp {
namespace {

constexpr double tiny = 1e-9;  // mm
constexpr double straight_on = 1 * radian_per_degree;

double way(const ContourPiece& p) { return std::hypot(p.end.u - p.start.u, p.end.v - p.start.v); }
bool along_u(const ContourPiece& p) {
  return p.turn == 0 && std::fabs(p.end.v - p.start.v) < 1e-6 && way(p) > tiny;
}
bool along_v(const ContourPiece& p) {
  return p.turn == 0 && std::fabs(p.end.u - p.start.u) < 1e-6 && way(p) > tiny;
}

PlanePoint direction_at(const ContourPiece& p, PlanePoint at) {
  if (p.turn == 0) return {p.end.u - p.start.u, p.end.v - p.start.v};
  return {-p.turn * (at.v - p.centre.v), p.turn * (at.u - p.centre.u)};
}

// A number of the line that is a length whatever its letter: the digits of C have been read as
// thousandths of a degree.
double corner_length(const BlockRun& run, const Word& word) {
  double number = word.number;
  const bool thousandths = word.letter == 'C' && word.no_point && !run.session.options.whole_units;
  if (thousandths && run.state.unit == canon::Unit::inch) number /= 10;
  return number * run.state.unit_mm();
}

bool has_axis(const BlockRun& run, Axis axis) {
  const AxisSet axes = run.session.options.axes;
  return axes.empty() || axes.has(axis);
}

}  // namespace

CornerRequest corner_request(BlockRun& run, const CodeRule& motion) {
  CornerRequest request;
  std::string letters = "rc";
  if (run.session.table.lathe() && motion.code == 10)
    letters += has_axis(run, Axis::c) ? "RIK" : "RIKC";
  for (const char letter : letters) {
    const Word* word = run.block.find(letter);
    if (!word) continue;
    if (request.letter != 0) {
      run.error("corner_error", word->place,
                "one corner has one word; " + written(request.letter) + " and " + written(letter) +
                    " stand on this line");
      return {};
    }
    const double size = corner_length(run, *word);
    if (size < 0 && (letter == 'r' || letter == 'c')) {
      run.error("corner_error", word->place,
                "the size of a corner can't be negative; it follows by itself to which side it "
                "lies");
      return {};
    }
    const bool round = letter == 'r' || letter == 'R';
    request.letter = letter;
    request.sign = size > 0 ? 1 : size < 0 ? -1 : 0;
    if (size != 0)
      request.word = {round ? CornerWord::Kind::round : CornerWord::Kind::chamfer, std::fabs(size)};
  }
  return request;
}

std::optional<std::string> corner_problem(const CornerRequest& request, const ContourPiece& before,
                                          const ContourPiece& after, std::string& doubt) {
  const bool bare = request.letter >= 'A' && request.letter <= 'Z';
  if (!bare) return std::nullopt;
  const std::string name(1, request.letter);
  const bool right_angle =
      (along_u(before) && along_v(after)) || (along_v(before) && along_u(after));
  const double next = along_u(after) ? after.end.u - after.start.u : after.end.v - after.start.v;
  const bool agrees = (next > 0) == (request.sign > 0);
  if (request.letter == 'I' || request.letter == 'K') {
    const bool first_fits = request.letter == 'I' ? along_u(before) : along_v(before);
    if (!right_angle || !first_fits)
      return request.letter == 'I'
                 ? "I is a chamfer between a move along Z and then one along X; use ,C here"
                 : "K is a chamfer between a move along X and then one along Z; use ,C here";
    if (!agrees)
      return "the sign of " + name + " says where the next move goes, which is the other way";
    return std::nullopt;
  }
  if (request.sign < 0 && (!right_angle || agrees)) {
    if (right_angle) return std::nullopt;
    return name + " below 0 is a corner between moves along X and along Z; use ," + name + " here";
  }
  if (request.sign < 0)
    return "the sign of " + name + " says where the next move goes, which is the other way";
  if (!right_angle || !agrees)
    doubt = name +
            " without a comma is read as the corner that lies between the two moves; on a control "
            "on which it needs a right angle and the sign of the next move (Fanuc: parameter 3405 "
            "CCR = 0) this is an alarm; write ," +
            name;
  return std::nullopt;
}

bool runs_straight_on(const ContourPiece& before, const ContourPiece& after) {
  const PlanePoint in = direction_at(before, before.end), out = direction_at(after, after.start);
  return std::fabs(std::atan2(in.u * out.v - in.v * out.u, in.u * out.u + in.v * out.v)) <
         straight_on;
}

std::optional<double> line_angle(const BlockRun& run) {
  const Word* word = run.block.find('a');
  if (!word && run.session.table.lathe() && !has_axis(run, Axis::a)) word = run.block.find('A');
  if (!word) return std::nullopt;
  return word->number * radian_per_degree;
}

std::optional<PlanePoint> end_under_angle(PlanePoint start, double angle, std::optional<double> u,
                                          std::optional<double> v) {
  const double c = std::cos(angle), s = std::sin(angle);
  if (u) {
    if (std::fabs(c) < tiny) return std::nullopt;
    return PlanePoint{*u, start.v + (*u - start.u) * s / c};
  }
  if (std::fabs(s) < tiny) return std::nullopt;
  return PlanePoint{start.u + (*v - start.v) * c / s, *v};
}

std::optional<PlanePoint> meeting_point(PlanePoint start, double first, PlanePoint end,
                                        double second) {
  const double c1 = std::cos(first), s1 = std::sin(first);
  const double c2 = std::cos(second), s2 = std::sin(second);
  const double cross = c1 * s2 - s1 * c2;
  if (std::fabs(cross) < tiny) return std::nullopt;
  const double t = ((end.u - start.u) * s2 - (end.v - start.v) * c2) / cross;
  return PlanePoint{start.u + t * c1, start.v + t * s1};
}

}  // namespace aircut::interp
