// Nodes along a path piece, dense enough that limits kept at the nodes are kept between them.
//
// Start with the whole piece; evaluate the middle; split where, over the interval, the rows of the
// middle differ from the mean of the ends by more than `row_tolerance` of a limit (at the largest
// speed and acceleration that can occur there), or where nodes would be too coarse for the time
// law. The middle node is kept, so the accepted intervals are half as long as the ones that were
// tested and their error is about a quarter (the rows are smooth).
//
//   time law  The profile has one acceleration per interval. Near the ends of a piece it must be
//             able to ramp: with d = b_cap / (2 u_max), the way of a ramp from rest, intervals are
//             no longer than max(d / 6, 0.2 × distance to the nearer end) before the last halving.
//   tip       Its acceleration p' u + p'' b lies in the plane of p' and p''; a circle there is the
//             limit. Rows are the sides of a polygon with 64 corners on that circle.
//   product   β(s) b(s) is a product of two linear functions: it exceeds its end values by at most
//             |Δβ| |Δb| / 4. q' sqrt(b): by (Δq'/q')² / 4 of the limit.
#include "plan/grid.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aircut::plan {
namespace {

using machine::JointVector;
using machine::ReachError;

constexpr double row_tolerance = 2e-3;         // lines and arcs
constexpr double blend_row_tolerance = 1e-2;   // a blend is short: coarser, with more slack
constexpr double moment_row_tolerance = 4e-2;  // passed in less than `moment`
constexpr double moment = 1e-3;                // s
constexpr double speed_tolerance = 1e-3;
constexpr double infinity = std::numeric_limits<double>::infinity();

constexpr int tip_sides = most_tip_rows;  // pairs of sides of the tip's polygon

struct Node {
  double s = 0;
  JointPoint joint;
  JointVector alpha, beta;
  AxisValues d, dd;  ///< p', p''
  double tip_alpha = 0, tip_along = 0,
         tip_bend = 0;      ///< |p'|, p'' along p' and across it, by limit
  double metric_speed = 1;  ///< |p'| along the feed metric
  double cap = infinity, feed_cap = infinity, joint_cap = infinity;
  Cause why, joint_why;
};

Vec3 xyz_of(const AxisValues& p) { return {p[Axis::x], p[Axis::y], p[Axis::z]}; }

// The joint with the largest share of its limit.
signed char largest_of(const JointVector& shares) {
  Eigen::Index joint = 0;
  shares.cwiseAbs().maxCoeff(&joint);
  return static_cast<signed char>(joint);
}

class GridMaker {
 public:
  GridMaker(const JointPath& path, Metric metric, double feed, const JointLimits& limits,
            const KnownRates* known, MadeGrid& out)
      : path_(path),
        known_(std::holds_alternative<Blend>(path.path()) ? known : nullptr),
        metric_(metric),
        feed_(feed),
        limits_(limits),
        length_(length(path.path())),
        grid_(out.grid),
        ends_(out.ends) {}

  std::optional<GridFailure> make(bool identity, const JointVector& near, Follows follows,
                                  bool passes);

 private:
  std::optional<ReachError> node(double s, const JointVector& near, Node& out,
                                 bool at_end = false) const;
  bool from_end_before(const JointVector& near, Node& out) const;
  void limit(Node& node) const;
  bool hardly_moves(const Node& first) const;
  bool is_uniform(bool identity, const Node& first, const Node& last) const;
  std::optional<double> row_error(const Node& a, const Node& m, const Node& b) const;
  bool split(const Node& a, const Node& b, int depth);
  void add(const Node& n, double room = 1);

  bool from_table(double s, Node& out) const;

  const JointPath& path_;
  const KnownRates* known_;
  Metric metric_;
  double feed_;
  const JointLimits& limits_;
  double length_;
  double row_tolerance_ = row_tolerance;
  double ramp_ = 0;  ///< way of a ramp from rest at the ends
  Grid& grid_;
  GridEnds& ends_;
  std::optional<GridFailure> failure_;
};

// The derivatives at a place of the table. The joints themselves are not needed inside a piece.
bool GridMaker::from_table(double s, Node& out) const {
  const Blend& blend = std::get<Blend>(path_.path());
  const double last = static_cast<double>(known_->rates.at.size() - 1);
  const double place = (blend.begin + s) / blend.whole * last, k = std::round(place);
  if (!(std::abs(place - k) < 1e-9)) return false;
  const auto& [d, dd] = known_->rates.at[static_cast<std::size_t>(k)];
  out.d = d[0] * known_->d_in + d[1] * known_->d_out;
  if (limits_.tip_a < infinity)
    out.dd = (dd[0] / known_->cut) * known_->d_in + (dd[1] / known_->cut) * known_->d_out;
  out.joint.dq = d[0] * known_->dq_in + d[1] * known_->dq_out;
  out.joint.ddq = (dd[0] / known_->cut) * known_->dq_in + (dd[1] / known_->cut) * known_->dq_out;
  // q'' = J p'' + H(p', p') with p' = d₀ in + d₁ out; H(in, out) as the mean of both.
  if (known_->ddq_in.size() > 0)
    out.joint.ddq += (d[0] + d[1]) * (d[0] * known_->ddq_in + d[1] * known_->ddq_out);
  return true;
}

// The first node from the last one of the piece before, whose direction p' is λ times this one's
// and where neither bends (p'' along p'): q' = λ q'₀, and q'' = λ² (q''₀ − μ q'₀) + ν q' where
// p''₀ = μ p'₀ and p'' = ν p'.
bool GridMaker::from_end_before(const JointVector& near, Node& out) const {
  constexpr double parallel = 1e-9, straight = 1e-6;  // share; 1/mm
  const PathPoint p = evaluate(path_.path(), 0);
  const auto dot = [](const AxisValues& a, const AxisValues& b) {
    double sum = 0;
    for (std::size_t k = 0; k < a.value.size(); ++k) sum += a.value[k] * b.value[k];
    return sum;
  };
  const auto none = [&dot](const AxisValues& way, double most) {
    return dot(way, way) <= most * most;
  };
  const AxisValues &d0 = ends_.d_end, &dd0 = ends_.dd_end;
  const double size0 = dot(d0, d0), size = dot(p.d, p.d);
  if (!(size0 > 0) || !(size > 0)) return false;
  const double lambda = dot(p.d, d0) / size0, mu = dot(dd0, d0) / size0, nu = dot(p.dd, p.d) / size;
  if (!none(p.d - lambda * d0, parallel * std::sqrt(size)) ||
      !none(dd0 - mu * d0, straight * size0) || !none(p.dd - nu * p.d, straight * size))
    return false;
  out.s = 0;
  out.d = p.d;
  out.dd = p.dd;
  out.joint.q = near;
  out.joint.dq = lambda * ends_.dq_end;
  out.joint.ddq = lambda * lambda * (ends_.ddq_end - mu * ends_.dq_end) + nu * out.joint.dq;
  limit(out);
  return true;
}

std::optional<ReachError> GridMaker::node(double s, const JointVector& near, Node& out,
                                          bool at_end) const {
  const bool nearly = known_ && known_->ddq_in.size() > 0;
  if (known_ && !(nearly && at_end) && from_table(s, out)) {
    out.joint.q = near;
    out.s = s;
    limit(out);
    return std::nullopt;
  }
  const PathPoint p = evaluate(path_.path(), s);
  if (auto why = path_.point(p, near, out.joint)) return why;
  out.s = s;
  out.d = p.d;
  out.dd = p.dd;
  limit(out);
  return std::nullopt;
}

// What follows from the joints' and the tip's derivatives.
void GridMaker::limit(Node& out) const {
  out.alpha = out.joint.dq.cwiseQuotient(limits_.a);
  out.beta = out.joint.ddq.cwiseQuotient(limits_.a);
  if (limits_.tip_a < infinity) {
    const Vec3 d = xyz_of(out.d), dd = xyz_of(out.dd);
    const double size = d.norm();
    out.tip_alpha = size / limits_.tip_a;
    out.tip_along = size > 0 ? dd.dot(d) / size / limits_.tip_a : 0;
    out.tip_bend = std::sqrt(std::max(
        dd.squaredNorm() / (limits_.tip_a * limits_.tip_a) - out.tip_along * out.tip_along, 0.0));
  }
  out.metric_speed = metric_length(metric_, out.d);
  if (feed_ < infinity && out.metric_speed > 0) {
    out.cap = out.feed_cap = (feed_ / out.metric_speed) * (feed_ / out.metric_speed);
    out.why.by = LimitedBy::feed;
  }
  const JointVector shares = out.joint.dq.cwiseQuotient(limits_.v);
  const double fastest = 1 / shares.cwiseAbs().maxCoeff();
  out.joint_cap = fastest * fastest;
  out.joint_why = {LimitedBy::velocity, largest_of(shares)};
  if (out.joint_cap < out.cap) {
    out.cap = out.joint_cap;
    out.why = out.joint_why;
  }
}

// True if the joints' rates at the start let none go far: the start then is near enough to the end.
bool GridMaker::hardly_moves(const Node& first) const {
  constexpr double most = 0.05;  // mm or rad
  const JointPoint& at = first.joint;
  return ((at.dq.cwiseAbs() + length_ * at.ddq.cwiseAbs()) * length_).maxCoeff() < most;
}

// Joints linear in s: the same q' everywhere and no q''. Identity kinematics on a line by
// definition; otherwise looked at in five places, which no smooth mechanism passes by chance.
bool GridMaker::is_uniform(bool identity, const Node& first, const Node& last) const {
  if (!std::holds_alternative<Line>(path_.path())) return false;
  if (identity) return true;
  const JointVector& dq = first.joint.dq;
  const double size = dq.norm();
  const auto same = [&](const Node& n) {
    return (n.joint.dq - dq).norm() <= 1e-12 * size &&
           n.joint.ddq.norm() * length_ <= 1e-12 * size &&
           (n.joint.q - first.joint.q - n.s * dq).norm() <= 1e-9;
  };
  if (!same(first) || !same(last)) return false;
  for (const double f : {0.31, 0.5, 0.77}) {
    Node n;
    if (node(f * length_, first.joint.q, n) || !same(n)) return false;
  }
  return true;
}

// Largest error of the rows of an interval as a share of a limit; nothing when it is too coarse.
std::optional<double> GridMaker::row_error(const Node& a, const Node& m, const Node& b) const {
  double worst = 0;
  const double ds = b.s - a.s;
  const double end_distance = std::min(b.s, length_ - a.s);
  const double growth = grid_.tip_rows > 0 && m.tip_bend > 0 ? 0.05 : 0.2;
  if (ds > std::max(ramp_ / 6, growth * end_distance)) return std::nullopt;
  // The largest speed is the cap; the largest acceleration that of standstill or less than twice
  // as much where curvature helps.
  const double alpha = std::max(
      {a.alpha.cwiseAbs().maxCoeff(), b.alpha.cwiseAbs().maxCoeff(), a.tip_alpha, b.tip_alpha});
  const double u = 2 / std::max(alpha, 1e-300);
  const double bend =
      std::max({a.beta.cwiseAbs().maxCoeff(), b.beta.cwiseAbs().maxCoeff(),
                m.beta.cwiseAbs().maxCoeff(), a.tip_bend, b.tip_bend, m.tip_bend, 1e-300});
  // Curvature alone holds b near 1 / |β|; twice that where acceleration helps.
  const double speed2 = std::min(std::max({a.cap, m.cap, b.cap}), 2 / bend);
  const double speed = std::sqrt(speed2);
  for (Eigen::Index j = 0; j < a.alpha.size(); ++j) {
    const double off_alpha = std::abs(m.alpha[j] - (a.alpha[j] + b.alpha[j]) / 2);
    const double off_beta = std::abs(m.beta[j] - (a.beta[j] + b.beta[j]) / 2);
    const double product = std::abs(b.beta[j] - a.beta[j]) * std::min(ds * u, speed2) / 8;
    worst = std::max(worst, off_alpha * u + off_beta * speed2 + product);
    if (worst > row_tolerance_) return std::nullopt;
    const double to_v = limits_.a[j] / limits_.v[j] * speed;  // α to a share of the joint's speed
    if (off_alpha * to_v > speed_tolerance) return std::nullopt;
    const double change = (b.alpha[j] - a.alpha[j]) * to_v;
    if (change * change > 4 * speed_tolerance) return std::nullopt;
  }
  if (grid_.tip_rows > 0) {
    const double off = std::abs(m.tip_bend - (a.tip_bend + b.tip_bend) / 2) +
                       std::abs(m.tip_along - (a.tip_along + b.tip_along) / 2);
    const double product = std::abs(b.tip_bend - a.tip_bend) * std::min(ds * u, speed2) / 8;
    worst = std::max(worst, off * speed2 + product);
    if (worst > row_tolerance_) return std::nullopt;
  }
  if (feed_ < infinity) {
    const double off = std::abs(m.metric_speed - (a.metric_speed + b.metric_speed) / 2);
    const double change = (b.metric_speed - a.metric_speed) / m.metric_speed;
    if (off > speed_tolerance * m.metric_speed || change * change > 4 * speed_tolerance)
      return std::nullopt;
  }
  return worst;
}

void GridMaker::add(const Node& n, double room) {
  if (!grid_.at.empty()) grid_.at.back().room = room;
  grid_.at.push_back({n.s, n.cap, 1, n.why, n.feed_cap, n.joint_cap, n.joint_why});
  if (grid_.uniform) return;
  const double inside =
      std::cos(std::numbers::pi / (2 * tip_sides));  // the polygon's corners are on it
  const auto side = [&](int i, double along, double across) {
    const double angle = std::numbers::pi * i / tip_sides;
    // At a right angle exactly none of what goes along.
    const double cosine = 2 * i == tip_sides ? 0 : std::cos(angle);
    return (cosine * along + std::sin(angle) * across) / inside;
  };
  grid_.rows.insert(grid_.rows.end(), n.alpha.begin(), n.alpha.end());
  for (int i = 0; i < grid_.tip_rows; ++i) grid_.rows.push_back(side(i, n.tip_alpha, 0));
  grid_.rows.insert(grid_.rows.end(), n.beta.begin(), n.beta.end());
  for (int i = 0; i < grid_.tip_rows; ++i) grid_.rows.push_back(side(i, n.tip_along, n.tip_bend));
}

// Adds the nodes behind `a` up to and with `b`. False after a failure.
bool GridMaker::split(const Node& a, const Node& b, int depth) {
  Node middle;
  if (const auto why = node((a.s + b.s) / 2, a.joint.q, middle)) {
    failure_ = {a.s, true, why->reason};
    return false;
  }
  // 2^-24 of the piece: nodes this near that still differ mean that the inverse jumps.
  constexpr int deepest = 24;
  const auto error = row_error(a, middle, b);
  if (depth < deepest && !error) return split(a, middle, depth + 1) && split(middle, b, depth + 1);
  if (depth == deepest) {
    const JointVector jump = b.joint.q - a.joint.q - (b.s - a.s) * middle.joint.dq;
    if (jump.cwiseAbs().maxCoeff() > 1e-3) {
      failure_ = {a.s, true, "the joints would have to jump to another branch there"};
      return false;
    }
  }
  const double room = 1 - std::min(error.value_or(0), row_tolerance_) / 2;
  add(middle, room);
  add(b, room);
  return true;
}

std::optional<GridFailure> GridMaker::make(bool identity, const JointVector& near, Follows follows,
                                           bool passes) {
  Node first, last;
  if (follows == Follows::same_curve) {
    first.joint = {ends_.q_end, ends_.dq_end, ends_.ddq_end};
    first.d = ends_.d_end;
    first.dd = ends_.dd_end;
    limit(first);
  } else if (!identity && follows == Follows::at_speed && from_end_before(near, first)) {
    // Nothing is left to find.
  } else if (const auto why = node(0, near, first, true)) {
    return GridFailure{0, true, why->reason};
  }
  // The end is reached over the middle, so that `near` is never a long way off.
  JointVector guess = first.joint.q;
  if (!identity && !hardly_moves(first)) {
    for (int i = 1; i < 16; ++i) {
      const auto q = path_.joints(length_ * i / 16, guess);
      if (!q) return GridFailure{length_ * (i - 1) / 16, false, q.error().reason};
      guess = *q;
    }
  }
  if (identity && std::holds_alternative<Line>(path_.path())) {
    // Joints are axes: nothing but the place changes on a line.
    last = first;
    last.s = length_;
    last.joint.q = first.joint.q + length_ * first.joint.dq;
  } else if (const auto why = node(length_, guess, last, true)) {
    return GridFailure{0, true, why->reason};
  }
  if (known_ && identity)
    if (auto q = path_.joints(length_, guess)) last.joint.q = std::move(*q);
  const bool uniform = is_uniform(identity, first, last);
  if (uniform && first.joint.dq.isZero(0) && last.joint.dq.isZero(0))
    return GridFailure{0, false, "no joint of the machine moves this axis"};
  grid_.at.clear();
  grid_.rows.clear();
  grid_.tip_rows = limits_.tip_a < infinity && metric_ == Metric::xyz ? tip_sides : 0;
  grid_.joints = static_cast<int>(first.alpha.size()) + grid_.tip_rows;
  grid_.uniform = uniform;
  const double of_joints = std::max(first.alpha.cwiseAbs().maxCoeff(), 1e-300);
  const double alpha = std::max(of_joints, first.tip_alpha);
  if (grid_.uniform) {
    grid_.uniform_a = 1 / alpha;
    grid_.uniform_joint =
        first.tip_alpha > of_joints ? static_cast<signed char>(-1) : largest_of(first.alpha);
  }
  const double whole_ramp = std::max(first.cap, last.cap) * alpha / 2;
  ramp_ = std::min(whole_ramp, length_);
  // On a bend the tip's limit leaves less the faster it is: the ramp is no straight line.
  if (const double bend = std::max(first.tip_bend, last.tip_bend); grid_.tip_rows > 0 && bend > 0)
    ramp_ = std::min(ramp_, alpha / (8 * bend));
  const double fastest = std::sqrt(std::max(first.cap, last.cap));
  const bool for_a_moment = length_ < moment * fastest;
  if (std::holds_alternative<Blend>(path_.path())) {
    row_tolerance_ = for_a_moment ? moment_row_tolerance : blend_row_tolerance;
    passes = true;
  }
  // No ride both starts and ends at rest there: it only passes on a ramp.
  if (passes && for_a_moment && grid_.tip_rows == 0) ramp_ = whole_ramp;
  grid_.dq_start = first.joint.dq;
  // Most pieces need no more nodes than that.
  const std::size_t few = grid_.uniform ? 2 : 3;
  grid_.at.reserve(few);
  if (!grid_.uniform) grid_.rows.reserve(few * 2 * static_cast<std::size_t>(grid_.joints));
  add(first);
  if (grid_.uniform)
    add(last);
  else if (!split(first, last, 0))
    return failure_;
  ends_.q_end = last.joint.q;
  ends_.dq_end = last.joint.dq;
  ends_.ddq_start = first.joint.ddq;
  ends_.ddq_end = last.joint.ddq;
  ends_.d_start = first.d;
  ends_.d_end = last.d;
  ends_.dd_end = last.dd;
  return std::nullopt;
}

}  // namespace

void scale_caps(Grid& grid, double factor) {
  const double square = factor * factor;
  for (GridNode& node : grid.at) {
    if (node.feed_cap == infinity) {
      // A rapid: a share of its own speed, never more.
      node.cap = std::min(square, 1.0) * node.joint_cap;
      node.why = square < 1 ? Cause{LimitedBy::feed, -1} : node.joint_why;
      continue;
    }
    const bool by_feed = square * node.feed_cap <= node.joint_cap;
    node.cap = by_feed ? square * node.feed_cap : node.joint_cap;
    node.why = by_feed ? Cause{LimitedBy::feed, -1} : node.joint_why;
  }
}

namespace {

// The node at s, between nodes k and k + 1, and its rows at the end of `rows`.
GridNode node_at(const Grid& grid, std::size_t k, double s, std::vector<double>& rows) {
  const GridNode &a = grid.at[k], &b = grid.at[k + 1];
  const double f = (s - a.s) / (b.s - a.s);
  const auto between = [f](double x, double y) { return x == y ? x : x + f * (y - x); };
  GridNode out = f < 0.5 ? a : b;
  out.s = s;
  out.cap = between(a.cap, b.cap);
  out.feed_cap = between(a.feed_cap, b.feed_cap);
  out.joint_cap = between(a.joint_cap, b.joint_cap);
  out.room = a.room;
  if (!grid.uniform)
    for (int i = 0; i < 2 * grid.joints; ++i)
      rows.push_back(between(grid.alpha(k)[i], grid.alpha(k + 1)[i]));
  return out;
}

std::size_t interval_of(const Grid& grid, double s) {
  std::size_t k = 0;
  while (k + 2 < grid.nodes() && grid.at[k + 1].s <= s) ++k;
  return k;
}

}  // namespace

Grid grid_before(const Grid& grid, double s) {
  const std::size_t k = interval_of(grid, s);
  Grid out = grid;
  const std::size_t kept = grid.at[k].s < s - same_node * grid.length() || k == 0 ? k + 1 : k;
  out.at.resize(kept);
  if (!grid.uniform) out.rows.resize(kept * 2 * static_cast<std::size_t>(grid.joints));
  const GridNode end = node_at(grid, k, s, out.rows);
  out.at.push_back(end);
  return out;
}

Grid grid_behind(const Grid& grid, double s) {
  const std::size_t k = interval_of(grid, s);
  Grid out = grid;
  out.at.clear();
  out.rows.clear();
  const GridNode begin = node_at(grid, k, s, out.rows);
  out.at.push_back(begin);
  const bool skip = grid.at[k + 1].s < s + same_node * grid.length() && k + 2 < grid.nodes();
  const std::size_t next = skip ? k + 2 : k + 1;
  out.at.insert(out.at.end(), grid.at.begin() + static_cast<std::ptrdiff_t>(next), grid.at.end());
  if (!grid.uniform)
    out.rows.insert(out.rows.end(), grid.alpha(next), grid.rows.data() + grid.rows.size());
  for (GridNode& node : out.at) node.s -= s;
  // Between two rests a motion needs a place where it moves.
  if (!grid.uniform && out.nodes() == 2) {
    std::vector<double> rows;
    const GridNode middle = node_at(out, 0, out.length() / 2, rows);
    out.at.insert(out.at.begin() + 1, middle);
    out.rows.insert(out.rows.begin() + 2 * out.joints, rows.begin(), rows.end());
  }
  return out;
}

std::optional<GridFailure> make_grid(const machine::Kinematics& kinematics, const Path& path,
                                     Metric metric, double feed, const AxisValues& tool_offset,
                                     const JointLimits& limits, const JointVector& near,
                                     MadeGrid& out, Follows follows, bool passes,
                                     const KnownRates* known) {
  const JointPath joints(kinematics, path, tool_offset);
  return GridMaker(joints, metric, feed, limits, known, out)
      .make(kinematics.type() == "identity", near, follows, passes);
}

}  // namespace aircut::plan
