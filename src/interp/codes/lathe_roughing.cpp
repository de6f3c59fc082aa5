// G70 (finish), G71 (rough along Z), G72 (rough along X) and G73 (rough along the contour) of
// Fanuc-like turning centres. The contour stands in the blocks N P to N Q.
//
//   * G71 U d R e        depth of a pass and way out, kept for the next line
//   * G71 P Q U W F      allowances: the contour moves by U/2 in X and by W in Z
//   * G71 P Q U W D F    both in one line
//
// G71 first moves the start point by the allowances too. Pass n runs at the level d·n under it, to
// the contour, out of the cut at 45° by e, and back. The last pass follows the contour with its
// allowances. The contour must neither go back along Z nor dip in X. When the block N P leads along
// both axes (type II) it may dip: pocket_roughing.cpp has the passes then.
// G73 follows the contour R times, U and W nearer each time. All return to the start point. F, S
// and T in the contour act in G70 only (here: F); radius compensation does not act.
#include <algorithm>
#include <cmath>

#include "interp/codes/codes.h"
#include "interp/codes/lathe.h"
#include "interp/codes/turning.h"
#include "interp/contour_reader.h"

namespace aircut::interp {
namespace {

constexpr int max_passes = 20'000;
constexpr std::size_t max_moves = 200'000;

bool is_first_line(const BlockRun& run) { return !run.has('P') && !run.has('Q'); }

// The line before the one with P and Q.
void keep_words(const CodeRule& rule, BlockRun& run) {
  TurningState& kept = run.state.turning;
  const char depth = rule.code == 720 ? 'W' : 'U';
  if (rule.code == 700) return run.error("word_missing", rule, "G70 needs P and Q: the contour");
  if (rule.code == 730) {
    kept.pattern = {run.length('W', kept.pattern.u), run.length('U', kept.pattern.v)};
    if (!run.has('R')) return run.error("word_missing", rule, "G73 needs R: the number of passes");
    const double count = *run.number('R');
    if (count < 1 || count > max_passes)
      return run.error("word_value", 'R', "R of G73, the number of passes, must be 1 or more");
    kept.pattern_count = static_cast<int>(std::lround(count));
    return;
  }
  if (run.has(depth)) kept.depth = std::fabs(run.length(depth));
  if (run.has('R')) kept.escape = std::fabs(run.length('R'));
}

void ask_for_contour(const CodeRule& rule, BlockRun& run) {
  for (const char word : {'P', 'Q'})
    if (!run.has(word))
      return run.error("word_missing", rule,
                       name_of(rule) + " needs P and Q: the N numbers of the contour's blocks");
  if (!lathe_words_given(run, rule, false, false) || !feed_is_set(run, rule)) return;
  BlockPlace places[2];
  for (const char word : {'P', 'Q'}) {
    const auto n = std::lround(*run.number(word));
    const auto found = run.find_block(n);
    if (!found)
      return run.error("label_missing", word,
                       "there is no block N" + std::to_string(n) + " in this program");
    places[word == 'Q'] = *found;
  }
  if (places[1].begin < places[0].begin)
    return run.error("label_missing", 'Q', "the block of Q stands before the block of P");
  run.flow.kind = FlowRequest::Kind::contour;
  run.flow.cycle = &rule;
  run.flow.contour_start = run.state.tip;
  run.flow.first = places[0];
  run.flow.target = places[1];
  run.flow.is_range = true;
  run.flow.jump_behind = rule.code != 700 && places[0].begin > run.block.begin;
}

class LatheRoughing {
 public:
  LatheRoughing(const CodeRule& rule, BlockRun& run)
      : rule_(rule),
        run_(run),
        motion_(
            rule, run,
            rule.code == 720 ? TurningMotion::Passes::along_x : TurningMotion::Passes::along_z) {}

  void execute();

 private:
  bool read_contour();
  void finish();
  void pattern();
  void rough();
  void pass(double level, double escape);
  bool pockets(double depth);
  void follow(bool with_feeds);
  void set_feed(double feed);

  const CodeRule& rule_;
  BlockRun& run_;
  TurningMotion motion_;
  Contour body_;  // working orientation, allowances applied; without the first move
  ContourPiece approach_;
  PlanePoint start_;
};

bool LatheRoughing::read_contour() {
  const Contour read = motion_.plane_contour(run_.contour->contour());
  if (read.size() < 2) {
    run_.error("contour_error", 'P',
               "the contour has less than two moves; the first one leads to its first point");
    return false;
  }
  motion_.orient(Contour(read.begin() + 1, read.end()));
  for (const ContourPiece& piece : read) body_.push_back(motion_.to_work(piece));
  approach_ = body_.front();
  body_.erase(body_.begin());
  start_ = approach_.start;
  return true;
}

void LatheRoughing::execute() {
  if (!read_contour()) return;
  if (rule_.code == 700) return finish();
  if (rule_.code == 730) return pattern();
  rough();
}

void LatheRoughing::set_feed(double feed) {
  if (feed <= 0 || feed == run_.state.feed) return;
  run_.state.feed = feed;
  emit_feed(run_);
}

void LatheRoughing::follow(bool with_feeds) {
  for (const ContourPiece& piece : body_) {
    if (with_feeds) set_feed(piece.feed);
    if (piece.rapid)
      motion_.rapid(piece.end, "contour");
    else
      motion_.follow(piece, "contour");
  }
}

void LatheRoughing::finish() {
  set_feed(approach_.feed);
  if (approach_.rapid)
    motion_.rapid(approach_.end, "to the contour");
  else
    motion_.feed(approach_.end, "to the contour");
  follow(true);
  motion_.rapid(start_, "to the start");
}

// The shift of the contour that the allowances make, in working orientation.
PlanePoint allowance_of(const BlockRun& run, const TurningMotion& motion, bool along_x) {
  const double x = run.length('U') * (run.state.lathe_diameter ? 0.5 : 1), z = run.length('W');
  return motion.to_work(along_x ? PlanePoint{x, z} : PlanePoint{z, x});
}

void LatheRoughing::pattern() {
  const TurningState& kept = run_.state.turning;
  if (kept.pattern_count < 1)
    return run_.error("word_missing", rule_,
                      "G73 needs a first line with U, W and R: way, and number of passes");
  const PlanePoint left = allowance_of(run_, motion_, false);
  const PlanePoint way = motion_.to_work(kept.pattern);
  const Contour contour = body_;
  for (int n = 1; n <= kept.pattern_count; ++n) {
    const double rest = kept.pattern_count == 1 ? 0.0
                                                : static_cast<double>(kept.pattern_count - n) /
                                                      (kept.pattern_count - 1);
    const double du = left.u + rest * way.u, dv = left.v + rest * way.v;
    motion_.rapid({start_.u + du, start_.v + dv}, "start of a pass");
    const PlanePoint first{approach_.end.u + du, approach_.end.v + dv};
    if (approach_.rapid)
      motion_.rapid(first, "to the contour");
    else
      motion_.feed(first, "to the contour");
    body_ = shifted(contour, du, dv);
    follow(false);
  }
  motion_.rapid(start_, "to the start");
}

void LatheRoughing::rough() {
  const TurningState& kept = run_.state.turning;
  const double depth = run_.has('D') ? std::fabs(increments(run_, 'D')) : kept.depth;
  if (depth <= 0)
    return run_.error("word_missing", rule_,
                      name_of(rule_) + " needs the depth of a pass: a first line with " +
                          (rule_.code == 720 ? "W" : "U") + " and R, or D");
  const bool type_two = run_.contour->first_names_both();
  if (const auto back = first_going_back(body_, !type_two))
    return run_.error("contour_error", 'P',
                      "the contour goes back in line " +
                          std::to_string(run_.contour->line_of(*back + 1)) +
                          (type_two ? "; along the passes it must run one way"
                                    : "; it must rise or fall all along, or the block of P must "
                                      "name X and Z, so that pockets are cut (type II)"));
  const PlanePoint left = allowance_of(run_, motion_, rule_.code == 720);
  const PlanePoint finished = start_;
  body_ = shifted(body_, left.u, left.v);
  start_ = {start_.u + left.u, start_.v + left.v};
  const double lowest = body_.front().start.v;
  if (lowest > start_.v + 1e-9 || body_.front().start.u > start_.u + 1e-6)
    return run_.error("contour_error", rule_,
                      "the start point lies on the part's side of the contour; it must be outside "
                      "of the stock");
  const double passes = (start_.v - lowest) / depth;
  if (passes > max_passes)
    return run_.error("limit_reached", rule_, "more than 20000 passes; use a larger depth");
  motion_.rapid(start_, "to the allowance");
  if (type_two && !pockets(depth)) return;
  for (int n = 1; !type_two && n < passes - 1e-9; ++n) pass(start_.v - n * depth, kept.escape);
  const PlanePoint first = body_.front().start;
  if (approach_.rapid)
    motion_.rapid({start_.u, first.v}, "to the contour");
  else
    motion_.feed({start_.u, first.v}, "to the contour");
  if (first.u < start_.u - 1e-9) motion_.feed(first, "to the contour");
  follow(false);
  if (body_.back().end.v < start_.v) motion_.rapid({body_.back().end.u, start_.v}, "out");
  motion_.rapid(finished, "to the start");
}

bool LatheRoughing::pockets(double depth) {
  PocketRoughing options;
  options.start = start_;
  options.depth = depth;
  options.escape = run_.state.turning.escape;
  options.rapid_down = approach_.rapid;
  options.max_moves = max_moves;
  std::string problem;
  const auto moves = rough_pockets(body_, options, problem);
  if (!moves) {
    run_.error("limit_reached", rule_, problem);
    return false;
  }
  run_.warning("control_setting", run_.place(rule_),
               "a contour of type II: the order of its pockets and the ways between the passes "
               "differ from control to control; those here stay above what is not cut yet");
  const bool dips = first_going_back(body_, true).has_value();
  const char across = rule_.code == 720 ? 'U' : 'W';
  if (dips && run_.length(across) != 0)
    run_.warning("contour_error", run_.place(across),
                 std::string(1, across) +
                     " moves both walls of a pocket the same way, so one of them is cut into; "
                     "give it as 0");
  for (const CutterMove& move : *moves) motion_.make(move);
  const double height = moves->empty() ? start_.v : moves->back().end.v;
  motion_.rapid({start_.u, height}, "back");
  return true;
}

void LatheRoughing::pass(double level, double escape) {
  const auto crossing = next_crossing(body_, 0, start_.u, level);
  const double end = crossing ? *crossing : body_.back().end.u;
  if (approach_.rapid)
    motion_.rapid({start_.u, level}, "to depth");
  else
    motion_.feed({start_.u, level}, "to depth");
  motion_.feed({end, level}, "pass");
  motion_.rapid({end + escape, level + escape}, "out of the cut");
  motion_.rapid({start_.u, level + escape}, "back");
}

}  // namespace

void lathe_roughing(const CodeRule& rule, BlockRun& run) {
  if (run.contour) return LatheRoughing(rule, run).execute();
  if (is_first_line(run)) return keep_words(rule, run);
  ask_for_contour(rule, run);
}

}  // namespace aircut::interp
