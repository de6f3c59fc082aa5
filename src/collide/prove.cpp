// Proof over time: conservative advancement with bounds of travel.
//
// Let d be the distance of the bodies at t (rounded down by a slack) and μ(t, t') a bound of how
// far any point of B moves relative to A from t to t'. Then the distance stays ≥ d − μ(t, t') until
// t'. The march goes from t0 to t1 in such pieces:
//
//   d ≥ margin       far: go on while d − μ ≥ margin
//   d > resolution   near: go on while d − μ ≥ resolution/2, remember the piece
//   else             in contact: a small step that proves nothing; its time counts as unresolved.
//                    An overlap that is certain (certain_overlap.cpp) ends the march with a Hit.
//
// No piece is shorter than resolution/2 of travel, except that the steps in contact grow to a
// hundredth of the way gone in contact, so that bodies that rest on each other cost little. A
// number of queries is the last limit; what is left then is unresolved.
//
// The smallest distance of a near miss is found by branch and bound over the near pieces: each has
// a lower bound; the piece with the lowest one is halved and its middle measured, until that bound
// is within `near_width` of the smallest distance seen.
#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include "collide/budget.h"
#include "collide/collide.h"
#include "collide/mesh_impl.h"

namespace aircut::collide {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Queries per proof while marching and while refining a near miss; about a second of work.
constexpr std::uint64_t max_march_queries = 50'000;
constexpr std::uint64_t max_refine_queries = 20'000;
/// Of the size of the scene: the error of a distance (triangle_pair.cpp) and of the poses.
constexpr double relative_slack = 2e-8;
/// Distances of the march may be too small by this share: that costs a little more steps and saves
/// most of the search.
constexpr double march_tolerance = 0.1;
/// A time step that must be gone even where the travel bound is too large for any step: a share of
/// the interval.
constexpr double smallest_share = 1.0 / 4096;

/// A stretch of time with a proven lower bound of the distance.
struct Piece {
  double t0, t1, low;
  bool operator<(const Piece& other) const {  // for a queue with the lowest bound on top
    return low != other.low ? low > other.low : t0 > other.t0;
  }
};

struct Sample {
  double t = 0;
  double low = 0;              ///< lower bound of the surfaces' distance but for rounding
  double distance = infinity;  ///< of the surfaces; infinite when nothing is near enough to know
  ClosestPoints points;
};

class Proof {
 public:
  Proof(const CollisionMesh& a, const CollisionMesh& b, const RelativeMotion& motion, double t0,
        double t1, const ProofOptions& options, ProofCost& cost)
      : a_(a),
        b_(b),
        motion_(motion),
        t0_(t0),
        t1_(t1),
        options_(options),
        margin_(std::max(options.margin, 0.0)),
        resolution_(std::max(options.resolution, 1e-6)),
        cost_(cost) {}

  Outcome run(Budget& budget) {
    separate_ = budget.distance >= 0;
    if (!covered_by(budget)) march();
    budget.distance = separate_ && low_ > 0 && !hit_ ? low_ : -1;
    if (hit_) return *hit_;
    if (unresolved_)
      return Unresolved{unresolved_->t0, unresolved_->t1, unresolved_->low,
                        std::isfinite(unresolved_high_) ? unresolved_high_ : unresolved_->low};
    if (near_.distance < margin_) return refined();
    return Clear{std::clamp(clear_low_, 0.0, margin_)};
  }

 private:
  // The march. `t_` is how far the proof has come, `low_` a lower bound of the distance there;
  // below 0 when nothing is known.

  /// What is left of an earlier proof may be enough for the whole interval.
  bool covered_by(Budget budget) {
    if (budget.distance <= far_floor()) return false;
    const auto travel = motion_.travel(t0_, t1_);
    if (!travel || !spend(budget, *travel, far_floor())) return false;
    low_ = clear_low_ = budget.distance;
    return true;
  }

  void march() {
    t_ = t0_;
    while (!hit_ && (t_ < t1_ || low_ < 0)) {
      if (queries_ >= max_march_queries) return give_up(t1_, 0);
      const auto X_AB = motion_.X_AB(t_);
      if (!X_AB || !X_AB->matrix().allFinite()) {
        if (!skip_unknown()) return;
        continue;
      }
      measure(*X_AB);
      if (hit_) return;
      if (t_ >= t1_) return;
      if (in_contact_)
        step_in_contact();
      else
        advance(last_.distance < margin_ ? near_floor() : far_floor());
    }
  }

  double far_floor() const { return collide::far_floor(margin_, resolution_); }
  double near_floor() const { return 0.5 * resolution_; }

  /// Goes on as far as the known distance carries, at least `resolution/2`.
  void advance(double floor) {
    const double allowance = std::max(low_ - floor, 0.5 * resolution_);
    const Reach reach = reach_from(t_, allowance);
    if (!reach.known) {
      low_ = -1;
      skip_unknown();
      return;
    }
    const double low = low_ - reach.travel;
    clear_low_ = std::min(clear_low_, low);
    if (last_.distance < margin_ || low < margin_) pieces_.push_back({t_, reach.t, low});
    t_ = reach.t;
    low_ = t_ < t1_ ? -1 : low;  // a new measurement is better than what is left
  }

  /// A time that can't be judged: no pose, or no bound of travel. False at the end of the interval.
  bool skip_unknown() {
    const double next = std::min(t1_, t_ + smallest_share * (t1_ - t0_));
    note_unresolved(t_, next, 0, infinity);
    separate_ = false;
    in_contact_ = false;
    const bool more = t_ < t1_ && next > t_;
    t_ = more ? next : t1_;
    low_ = -1;
    return more;
  }

  void measure(const Pose& X_AB) {
    const double rest = motion_.travel(t_, t1_).value_or(0);
    // Far enough for the rest of this interval and some more like it, so that long runs of short
    // steps need few queries.
    const double size = a_.radius() + b_.radius();
    const double cap =
        std::max(margin_, resolution_) + 16 * std::max(rest, resolution_) + 0.02 * size;
    slack_ = relative_slack * (size + X_AB.translation().norm());
    resolution_ = std::max(resolution_, 8 * slack_);
    // Boxes are enough when they clear the rest of the interval, or a good part of the bodies'
    // size.
    const double enough = far_floor() + slack_ + std::min(padded(rest), 0.25 * size);
    last_ = sample(t_, X_AB, cap, enough, {.relative = march_tolerance});
    if (last_.low < far_floor() && last_.distance >= far_floor())
      last_ = sample(t_, X_AB, cap, enough, {});
    low_ = std::max(last_.low - slack_, 0.0);
    const bool touching = last_.distance <= slack_;
    if (!touching && !separate_) {
      const auto inner = contained_point(a_, b_, X_AB);
      ++cost_.overlap_queries;
      if (inner) return overlapping(X_AB);
      separate_ = true;
    }
    if (touching) return overlapping(X_AB);
    if (last_.distance <= resolution_) return contact(last_.distance);
    in_contact_ = false;
    clear_low_ = std::min(clear_low_, low_);
    if (last_.distance < near_.distance) near_ = last_;
  }

  /// Surface distance up to `cap`; boxes alone if they are `enough` apart.
  Sample sample(double t, const Pose& X_AB, double cap, double enough, const Tolerance& tolerance) {
    Sample out;
    out.t = t;
    ++queries_;
    const double boxes = box_distance(a_, b_, X_AB);
    if (boxes >= std::min(enough, cap)) {
      out.low = boxes;
      return out;
    }
    ++cost_.distance_queries;
    const auto found = surface_distance(a_, b_, X_AB, cap, tolerance);
    out.low = found ? found->low : cap;
    if (found) {
      out.distance = std::sqrt(found->points.squared);
      out.points = found->points;
    }
    return out;
  }

  // Contact.

  /// The surfaces touch, or one body is in the other.
  void overlapping(const Pose& X_AB) {
    ++cost_.overlap_queries;
    const auto point = certain_overlap(a_, b_, X_AB, options_.touch);
    separate_ = false;
    contact(0);
    if (!point) return;
    // Not where this contact began: an earlier one, too shallow to be a hit, may have come apart.
    hit_ = Hit{std::min(unresolved_->t0, contact_safe_), t_, *point};
    bisect_overlap();
  }

  void contact(double distance) {
    if (!in_contact_) {
      in_contact_ = true;
      contact_travel_ = 0;
      contact_safe_ = t_;
      contact_previous_ = t_;
    }
    note_unresolved(t_, t_, std::max(distance - slack_, 0.0), distance);
  }

  void step_in_contact() {
    const double step = std::max(0.5 * resolution_, 0.01 * contact_travel_);
    const Reach reach = reach_from(t_, step);
    if (!reach.known) {
      skip_unknown();
      return;
    }
    const double low = low_ - reach.travel;
    note_unresolved(t_, reach.t, std::max(low, 0.0), last_.distance);
    // The bodies can't have touched as long as every step is shorter than the gap before it.
    if (low > 0 && contact_safe_ == t_) contact_safe_ = reach.t;
    if (low <= 0) separate_ = false;
    contact_previous_ = t_;
    contact_travel_ += reach.travel;
    t_ = reach.t;
    low_ = -1;  // the end is always measured
  }

  /// Brings t_overlap near to the first time at which the overlap is certain.
  void bisect_overlap() {
    double before = contact_previous_;
    for (int i = 0; i < 40 && before < hit_->t_overlap; ++i) {
      const auto travel = motion_.travel(before, hit_->t_overlap);
      if (travel && *travel <= 0.5 * resolution_) return;
      const double middle = 0.5 * (before + hit_->t_overlap);
      if (!(before < middle && middle < hit_->t_overlap)) return;
      const auto X_AB = motion_.X_AB(middle);
      if (!X_AB) return;
      ++cost_.overlap_queries;
      if (const auto point = certain_overlap(a_, b_, *X_AB, options_.touch)) {
        hit_->t_overlap = middle;
        hit_->point = *point;
      } else {
        before = middle;
      }
    }
  }

  // Bounds of travel.

  struct Reach {
    bool known = false;
    double t = 0, travel = 0;
  };

  /// The furthest time found with a travel of at most `allowance`.
  Reach reach_from(double t, double allowance) {
    double end = t1_;
    auto travel = motion_.travel(t, end);
    for (int i = 0; i < 60; ++i) {
      if (travel && *travel <= allowance) return {true, end, padded(*travel)};
      // Proportion first (travel is often even), at least a halving.
      const double share = travel && std::isfinite(*travel) ? 0.95 * allowance / *travel : 0.0;
      const double next = t + (end - t) * std::clamp(share, 1e-3, travel ? 0.9 : 0.5);
      if (!(next > t) || end - t <= 1e-12 * (t1_ - t0_)) break;
      end = next;
      travel = motion_.travel(t, end);
    }
    return {};
  }

  static double padded(double travel) { return travel * (1 + 1e-12); }

  // Near misses.

  Outcome refined() {
    const double width = options_.near_width > 0 ? options_.near_width : resolution_;
    std::priority_queue<Piece> open(std::less<Piece>(), std::move(pieces_));
    double high = near_.distance;
    double settled = infinity;  // lower bound of what is no longer looked at
    const std::uint64_t limit = queries_ + max_refine_queries;
    while (!open.empty() && open.top().low < high - width) {
      const Piece piece = open.top();
      open.pop();
      const double middle = 0.5 * (piece.t0 + piece.t1);
      const auto before = motion_.travel(piece.t0, middle);
      const auto after = motion_.travel(middle, piece.t1);
      const auto X_AB = motion_.X_AB(middle);
      const bool divisible = piece.t0 < middle && middle < piece.t1 && before && after && X_AB;
      if (!divisible || queries_ >= limit) {
        settled = std::min(settled, piece.low);
        if (queries_ >= limit) break;
        continue;
      }
      const double reach = padded(std::max(*before, *after));
      const Sample at =
          sample(middle, *X_AB, high + reach, high + reach, {.absolute = 0.1 * width});
      if (at.distance < high) {
        high = at.distance;
        near_ = at;
      }
      const double low = at.low - slack_;
      open.push({piece.t0, middle, std::max(piece.low, low - padded(*before))});
      open.push({middle, piece.t1, std::max(piece.low, low - padded(*after))});
    }
    double low = std::min(settled, high);
    if (!open.empty()) low = std::min(low, open.top().low);
    return Near{near_.t, std::max(low, 0.0), high, near_.points.on_a, near_.points.on_b};
  }

  // Unresolved times.

  void note_unresolved(double from, double to, double low, double high) {
    if (!unresolved_) {
      unresolved_ = Piece{from, to, low};
      unresolved_high_ = high;
    }
    unresolved_->t1 = std::max(unresolved_->t1, to);
    unresolved_->low = std::min(unresolved_->low, low);
    unresolved_high_ = std::min(unresolved_high_, high);
  }
  void give_up(double to, double low) {
    note_unresolved(t_, to, low, last_.distance);
    separate_ = false;
    low_ = -1;
  }

  const CollisionMesh& a_;
  const CollisionMesh& b_;
  const RelativeMotion& motion_;
  const double t0_, t1_;
  const ProofOptions options_;
  const double margin_;
  double resolution_;  ///< as asked for, or larger where rounding demands it
  ProofCost& cost_;

  double t_ = 0;
  double low_ = -1;
  double slack_ = 0;
  bool separate_ = false;  ///< proven: no overlap at t_, so none inside the other either
  std::uint64_t queries_ = 0;
  Sample last_;
  Sample near_;
  double clear_low_ = infinity;
  std::vector<Piece> pieces_;
  bool in_contact_ = false;
  double contact_travel_ = 0, contact_safe_ = 0, contact_previous_ = 0;
  std::optional<Piece> unresolved_;
  double unresolved_high_ = 0;
  std::optional<Hit> hit_;
};

}  // namespace

Outcome prove(const CollisionMesh& a, const CollisionMesh& b, const RelativeMotion& motion,
              double t0, double t1, const ProofOptions& options, Budget& budget, ProofCost& cost) {
  return Proof(a, b, motion, t0, t1, options, cost).run(budget);
}

}  // namespace aircut::collide
