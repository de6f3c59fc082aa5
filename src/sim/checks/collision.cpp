// Collisions and near misses of every watched pair of bodies, proven over the whole of every step.
//
// Which pairs: all bodies on different links that collide, without
//   - neighbours in the tree (machine and spindle bodies on links joined by one couple),
//   - fixture against fixture (they rest on one another),
//   - pairs excluded by name in machine.toml, which the report lists with their reason.
// A pair that overlaps at the start pose is an error of the model (self_overlap); it is named and
// then left out, since nothing further can be said of it.
//
// Each pair keeps a budget of proven distance, so a step in which nothing is near costs no query.

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/sim.h"

namespace aircut::sim {

namespace {

using machine::Body;
using machine::LinkPoses;
using machine::Role;

struct Pair {
  std::size_t a = 0, b = 0;  // indices into Scene::bodies(); a is nearer to the tool
  collide::Budget budget;
  bool left_out = false;    // overlapped at the start
  double contact_end = -1;  // program time at which the last contact ended
};

bool is_tool(Role role) {
  return role == Role::holder || role == Role::shank || role == Role::cutter || role == Role::probe;
}

bool is_machine(Role role) { return role == Role::machine || role == Role::spindle; }

// The body that a person would name first: the tool's, then the spindle's, fixtures last.
int rank(Role role) {
  switch (role) {
    case Role::holder:
    case Role::shank:
    case Role::cutter:
    case Role::probe:
      return 0;
    case Role::spindle:
      return 1;
    case Role::machine:
      return 2;
    case Role::stock:
    case Role::part:
    case Role::fixture:
      return 3;
  }
  return 3;
}

std::string in_words(const Body& body) {
  const std::string name = "`" + body.name + "`";
  switch (body.role) {
    case Role::holder:
      return "tool holder " + name;
    case Role::shank:
      return "tool shank " + name;
    case Role::cutter:
      return "cutter " + name;
    case Role::fixture:
      return "fixture " + name;
    case Role::spindle:
      return "spindle " + name;
    case Role::probe:
      return "probe " + name;
    case Role::stock:
      return "stock " + name;
    case Role::part:
      return "part " + name;
    case Role::machine:
      return "machine part " + name;
  }
  return name;
}

std::string during(const plan::Segment& segment) {
  if (segment.kind == plan::MotionKind::blend)
    return std::holds_alternative<canon::Rapid>(segment.command.action)
               ? "during a rapid, where it rounds the corner (G64)"
               : "during a feed move, where it rounds the corner (G64)";
  switch (segment.kind) {
    case plan::MotionKind::rapid:
      return "during a rapid";
    case plan::MotionKind::feed:
      return "during a feed move";
    case plan::MotionKind::arc:
      return "during an arc";
    case plan::MotionKind::blend:
      break;
    case plan::MotionKind::probe:
      return "during a probing move";
    case plan::MotionKind::sync:
      return "during a synchronised move";
    case plan::MotionKind::tool_change:
      return "at a tool change";
    case plan::MotionKind::idle:
    case plan::MotionKind::dwell:
      return "at standstill";
  }
  return "";
}

// Link poses at times of one step, worked out once however many pairs ask.
class PoseCache {
 public:
  PoseCache(const machine::Machine& machine, const motion::JointMotion& motion)
      : machine_(machine), motion_(motion) {}

  const LinkPoses* at(double t) {
    for (Entry& entry : entries_)
      if (entry.filled && entry.t == t) return entry.reachable ? &entry.poses : nullptr;
    Entry& entry = entries_[next_++ % entries_.size()];
    entry.filled = true;
    entry.t = t;
    const auto q = motion_.at(t);
    entry.reachable = q.has_value();
    if (q) machine::forward(machine_, *q, entry.poses);
    return entry.reachable ? &entry.poses : nullptr;
  }

  // Travel of every couple within [ta, tb]; null when no bound is known.
  const std::vector<double>* travel(double ta, double tb) {
    if (!(known_ && ta == ta_ && tb == tb_)) {
      travel_.assign(machine_.tree().size(), 0);
      bounded_ = motion_.travel_bound(ta, tb, travel_);
      known_ = true;
      ta_ = ta;
      tb_ = tb;
    }
    return bounded_ ? &travel_ : nullptr;
  }

 private:
  struct Entry {
    bool filled = false, reachable = false;
    double t = 0;
    LinkPoses poses;
  };
  const machine::Machine& machine_;
  const motion::JointMotion& motion_;
  std::array<Entry, 32> entries_;
  std::size_t next_ = 0;
  bool known_ = false, bounded_ = false;
  double ta_ = 0, tb_ = 0;
  std::vector<double> travel_;
};

Pose mesh_pose(const Body& body, const LinkPoses& poses) {
  return poses.X_WL[static_cast<std::size_t>(index(body.link))] * body.X_LB;
}

class CollisionCheck final : public Check {
 public:
  explicit CollisionCheck(const CheckOptions& options) : options_(options) {}

  void start(const Scene& scene, const JointVector& joints, Findings&) override {
    bound_.emplace(scene.machine());
    start_joints_ = joints;
    choose_pairs(scene);
    pending_start_ = true;
  }

  void scene_changed(const Step& step, const JointVector& joints, Findings& out) override {
    choose_pairs(step.scene);
    LinkPoses poses;
    machine::forward(step.scene.machine(), joints, poses);
    check_at_rest(step, poses, Kind::tool_change_collision, out);
  }

  void step(const Step& step, Findings& out) override {
    if (pending_start_) {
      LinkPoses poses;
      machine::forward(step.scene.machine(), start_joints_, poses);
      check_at_rest(step, poses, Kind::self_overlap, out);
      pending_start_ = false;
    }
    if (step.segment.duration() <= 0 || std::holds_alternative<plan::Hold>(step.segment.path))
      return;
    PoseCache cache(step.scene.machine(), step.motion);
    for (Pair& pair : pairs_)
      if (!pair.left_out) check_pair(step, pair, cache, out);
  }

  void finish(Summary& summary) override {
    summary.collision.pairs = most_pairs_;
    summary.collision.bodies = most_bodies_;
    summary.collision.distance_queries = cost_.distance_queries;
    summary.collision.overlap_queries = cost_.overlap_queries;
    const double total = clear_time_ + hit_time_ + unresolved_time_;
    summary.collision.clear = total > 0 ? clear_time_ / total : 1;
    summary.collision.hit = total > 0 ? hit_time_ / total : 0;
    summary.collision.unresolved = total > 0 ? unresolved_time_ / total : 0;
    summary.collision.exclusions = exclusions_;
  }

 private:
  void choose_pairs(const Scene& scene) {
    std::vector<Pair> before = std::move(pairs_);
    std::vector<std::string> names_before = std::move(pair_names_);
    pairs_.clear();
    pair_names_.clear();
    exclusions_.clear();
    const auto& bodies = scene.bodies();
    for (std::size_t i = 0; i < bodies.size(); ++i)
      for (std::size_t j = i + 1; j < bodies.size(); ++j) {
        if (!watched(scene, bodies[i], bodies[j])) continue;
        const bool swap = rank(bodies[j].body.role) < rank(bodies[i].body.role);
        Pair pair;
        pair.a = swap ? j : i;
        pair.b = swap ? i : j;
        // What was left out at the start stays out when the tool changes.
        const std::string name = bodies[pair.a].body.name + "\n" + bodies[pair.b].body.name;
        for (std::size_t k = 0; k < before.size(); ++k)
          if (names_before[k] == name) pair.left_out = before[k].left_out;
        pairs_.push_back(pair);
        pair_names_.push_back(name);
      }
    most_pairs_ = std::max(most_pairs_, pairs_.size());
    most_bodies_ = std::max(most_bodies_, bodies.size());
  }

  bool watched(const Scene& scene, const SceneBody& a, const SceneBody& b) {
    if (!a.collision || !b.collision || a.body.link == b.body.link) return false;
    const Role ra = a.body.role, rb = b.body.role;
    if (ra == Role::part || rb == Role::part) return false;
    if (is_tool(ra) && is_tool(rb)) return false;
    if (ra == Role::fixture && rb == Role::fixture) return false;
    const auto& links = scene.machine().links();
    const machine::Link& la = links[static_cast<std::size_t>(index(a.body.link))];
    const machine::Link& lb = links[static_cast<std::size_t>(index(b.body.link))];
    const bool adjacent =
        (la.joint >= 0 && la.parent == b.body.link) || (lb.joint >= 0 && lb.parent == a.body.link);
    if (adjacent && is_machine(ra) && is_machine(rb)) return false;
    for (const machine::Exclusion& e : scene.machine().exclusions()) {
      const auto names = [&](const std::string& name, const SceneBody& body,
                             const machine::Link& link) {
        return name == body.body.name || name == link.name ||
               body.body.name.starts_with(name + "/");
      };
      if ((names(e.a, a, la) && names(e.b, b, lb)) || (names(e.a, b, lb) && names(e.b, a, la))) {
        exclusions_.push_back(a.body.name + " – " + b.body.name + ": " + e.reason);
        return false;
      }
    }
    return true;
  }

  // All pairs at a pose that does not change: the start, or a new tool in place.
  void check_at_rest(const Step& step, const LinkPoses& poses, Kind kind, Findings& out) {
    const auto& bodies = step.scene.bodies();
    for (Pair& pair : pairs_) {
      const SceneBody& a = bodies[pair.a];
      const SceneBody& b = bodies[pair.b];
      if (pair.left_out || (kind == Kind::tool_change_collision && !is_tool(a.body.role))) continue;
      const Pose X_WA = mesh_pose(a.body, poses), X_WB = mesh_pose(b.body, poses);
      ++cost_.overlap_queries;
      if (!collide::overlap(*a.collision, X_WA, *b.collision, X_WB)) continue;
      const auto depth =
          collide::penetration(*a.collision, X_WA, *b.collision, X_WB, {}, options_.touch);
      if (depth.depth <= options_.touch) continue;
      Finding f =
          finding_at(kind, step, kind == Kind::self_overlap ? step.motion.t0() : step.motion.t1());
      name_pair(f, a.body, b.body);
      f.depth = depth.depth;
      f.depth_bound = options_.touch;
      f.points = {depth.point};
      f.normal = depth.direction;
      if (kind == Kind::self_overlap) {
        f.message = in_words(a.body) + " overlaps " + in_words(b.body) + " before anything moves";
        f.remedy =
            "the model or the set-up is wrong; if the two always touch, exclude the pair in "
            "machine.toml: ignore = [{ bodies = [\"" +
            a.body.name + "\", \"" + b.body.name +
            "\"], reason = \"…\" }]. This pair is not checked any further";
        pair.left_out = true;
      } else {
        f.message =
            in_words(a.body) + " is inside " + in_words(b.body) + " as soon as the tool is changed";
        f.remedy = "retract further before the tool change";
      }
      out.add(f);
    }
  }

  void check_pair(const Step& step, Pair& pair, PoseCache& cache, Findings& out) {
    const auto& bodies = step.scene.bodies();
    const SceneBody& a = bodies[pair.a];
    const SceneBody& b = bodies[pair.b];
    const double t1 = step.motion.t1();
    const auto relative = relative_motion(a, b, cache);
    const collide::ProofOptions proof{.margin = options_.near,
                                      .resolution = step.scene.machine().collision_tolerance(),
                                      .touch = options_.touch};
    double t = step.motion.t0();
    // Contacts that end and begin again within a block are rows of their own; more than this many
    // are told as one that lasts to the block's end.
    constexpr int most_rows = 8;
    for (int row = 0; row < most_rows && t < t1; ++row) {
      const auto outcome =
          collide::prove(*a.collision, *b.collision, relative, t, t1, proof, pair.budget, cost_);
      double next = t1;
      std::visit(overloaded{
                     [&](const collide::Clear&) { clear_time_ += t1 - t; },
                     [&](const collide::Near& near) {
                       clear_time_ += t1 - t;
                       // Parting after a contact is no near miss of its own.
                       const bool parting = pair.contact_end >= 0 && t <= pair.contact_end + 1e-6;
                       if (parting &&
                           distance_at(a, b, t, near.distance_high + 3 * proof.resolution, cache) <=
                               near.distance_high + 2 * proof.resolution)
                         return;
                       report_near(step, a.body, b.body, near, cache, out);
                     },
                     [&](const collide::Hit& hit) {
                       next = row + 1 == most_rows ? t1 : end_of_contact(a, b, hit, t1, cache);
                       clear_time_ += hit.t_first - t;
                       hit_time_ += next - hit.t_first;
                       pair.contact_end = next;
                       report_hit(step, a, b, hit, next, cache, out);
                     },
                     [&](const collide::Unresolved& gap) {
                       // Bodies that come apart are within the resolution for a moment: that is
                       // the end of the contact that was told already.
                       if (pair.contact_end >= 0 && gap.t0 <= pair.contact_end + 1e-6) {
                         next = end_of_touch(a, b, t, t1, proof.resolution, cache);
                         hit_time_ += next - t;
                         pair.contact_end = next;
                         return;
                       }
                       clear_time_ += (t1 - t) - (gap.t1 - gap.t0);
                       unresolved_time_ += gap.t1 - gap.t0;
                       report_unresolved(step, a.body, b.body, gap, out);
                     },
                 },
                 outcome);
      t = next;
    }
  }

  collide::RelativeMotion relative_motion(const SceneBody& a, const SceneBody& b,
                                          PoseCache& cache) const {
    return {
        .X_AB = [&a, &b, &cache](double t) -> std::optional<Pose> {
          const LinkPoses* poses = cache.at(t);
          if (!poses) return std::nullopt;
          return mesh_pose(a.body, *poses).inverse(Eigen::Isometry) * mesh_pose(b.body, *poses);
        },
        .travel = [this, &a, &b, &cache](double ta, double tb) -> std::optional<double> {
          const std::vector<double>* travel = cache.travel(ta, tb);
          const LinkPoses* poses = travel ? cache.at(0.5 * (ta + tb)) : nullptr;
          if (!poses) return std::nullopt;
          return bound_->bound(a.body.link, mesh_pose(a.body, *poses) * a.collision->centre(),
                               a.collision->radius(), b.body.link,
                               mesh_pose(b.body, *poses) * b.collision->centre(),
                               b.collision->radius(), *poses, *travel);
        },
    };
  }

  // When the bodies come apart after hit.t_overlap, found by stepping and halving; t1 if they
  // don't.
  double end_of_contact(const SceneBody& a, const SceneBody& b, const collide::Hit& hit, double t1,
                        PoseCache& cache) {
    constexpr int steps = 64;
    double inside = hit.t_overlap;
    for (int i = 1; i <= steps; ++i) {
      const double t = hit.t_overlap + (t1 - hit.t_overlap) * i / steps;
      if (overlap_at(a, b, t, cache)) {
        inside = t;
        continue;
      }
      double outside = t;
      while (outside - inside > 1e-6) {
        const double middle = 0.5 * (inside + outside);
        (overlap_at(a, b, middle, cache) ? inside : outside) = middle;
      }
      return outside;
    }
    return t1;
  }

  // When bodies that part are clearly apart, after time t; t1 if they aren't until then.
  double end_of_touch(const SceneBody& a, const SceneBody& b, double t, double t1,
                      double resolution, PoseCache& cache) {
    constexpr int steps = 256;
    for (int i = 1; i <= steps; ++i) {
      const double at = t + (t1 - t) * i / steps;
      if (distance_at(a, b, at, 3 * resolution, cache) > 2 * resolution) return at;
    }
    return t1;
  }

  // Distance at time t, looked for up to `bound`; 0 for a pose that doesn't exist.
  double distance_at(const SceneBody& a, const SceneBody& b, double t, double bound,
                     PoseCache& cache) {
    const LinkPoses* poses = cache.at(t);
    ++cost_.distance_queries;
    if (!poses) return 0;
    return collide::distance(*a.collision, mesh_pose(a.body, *poses), *b.collision,
                             mesh_pose(b.body, *poses), bound)
        .value;
  }

  bool overlap_at(const SceneBody& a, const SceneBody& b, double t, PoseCache& cache) {
    const LinkPoses* poses = cache.at(t);
    ++cost_.overlap_queries;
    return poses && collide::overlap(*a.collision, mesh_pose(a.body, *poses), *b.collision,
                                     mesh_pose(b.body, *poses));
  }

  static void name_pair(Finding& f, const Body& a, const Body& b) {
    f.body_a = a.name;
    f.body_b = b.name;
    f.pair =
        std::string(machine::to_string(a.role)) + "-" + std::string(machine::to_string(b.role));
  }

  void report_hit(const Step& step, const SceneBody& a, const SceneBody& b, const collide::Hit& hit,
                  double t_end, PoseCache& cache, Findings& out) {
    Finding f = finding_at(Kind::collision, step, hit.t_first);
    name_pair(f, a.body, b.body);
    f.message = in_words(a.body) + " hits " + in_words(b.body) + " " + during(step.segment);
    f.t_worst = hit.t_overlap;
    f.t_end = t_end;
    f.u_first = fraction_at(step, f.t_first);
    f.u_end = fraction_at(step, f.t_end);
    if (detailed_++ < options_.detailed) measure_depth(a, b, hit, t_end, cache, f);
    if (const auto state = step.motion.state_at(f.t_worst)) {
      f.joints_worst = state->q;
      f.tip = state->tip;
      f.feed_actual = state->path_speed;
    }
    if (f.points.empty())
      if (const LinkPoses* poses = cache.at(hit.t_overlap))
        f.points = {mesh_pose(a.body, *poses) * hit.point};
    out.add(f);
  }

  // Deepest of several times of the contact, then the lift along the tool axis that clears it.
  void measure_depth(const SceneBody& a, const SceneBody& b, const collide::Hit& hit, double t_end,
                     PoseCache& cache, Finding& f) {
    constexpr int samples = 8;
    for (int i = 0; i <= samples; ++i) {
      const double t = hit.t_overlap + (t_end - hit.t_overlap) * i / samples;
      const LinkPoses* poses = cache.at(t);
      if (!poses) continue;
      const Pose X_WA = mesh_pose(a.body, *poses), X_WB = mesh_pose(b.body, *poses);
      const Vec3 axis = X_WA.linear().col(2);
      const auto depth =
          collide::penetration(*a.collision, X_WA, *b.collision, X_WB, {axis}, options_.touch);
      if (depth.depth <= f.depth.value_or(0)) continue;
      f.depth = depth.depth;
      f.depth_bound = options_.touch;
      f.normal = depth.direction;
      f.points = {depth.point};
      f.t_worst = t;
    }
    if (!is_tool(a.body.role)) return;
    if (const LinkPoses* poses = cache.at(f.t_worst))
      if (const auto lift =
              axial_retract(a, mesh_pose(a.body, *poses), b, mesh_pose(b.body, *poses)))
        f.remedy = "at its worst the tool must come up by " + fixed(*lift, 2) +
                   " mm along its axis to clear; retract first, or raise the clearance plane";
  }

  std::optional<double> axial_retract(const SceneBody& a, const Pose& X_WA, const SceneBody& b,
                                      const Pose& X_WB) {
    const Vec3 axis = X_WA.linear().col(2);
    const auto hits_at = [&](double lift) {
      ++cost_.overlap_queries;
      return collide::overlap(*a.collision, translation(lift * axis) * X_WA, *b.collision, X_WB);
    };
    constexpr double farthest = 400, step = 2;  // mm
    double low = 0, high = step;
    while (hits_at(high)) {
      low = high;
      high += step;
      if (high > farthest) return std::nullopt;
    }
    while (high - low > 0.005) {
      const double middle = 0.5 * (low + high);
      (hits_at(middle) ? low : high) = middle;
    }
    return high;
  }

  void report_near(const Step& step, const Body& a, const Body& b, const collide::Near& near,
                   PoseCache& cache, Findings& out) const {
    if (options_.near <= 0 || near.distance_low >= options_.near) return;
    Finding f = finding_at(Kind::near_miss, step, near.t);
    name_pair(f, a, b);
    f.message = in_words(a) + " passes " + in_words(b) + " at " + fixed(near.distance_low, 3) +
                " mm " + during(step.segment);
    f.u_first = f.u_end = fraction_at(step, near.t);
    f.depth = -near.distance_low;
    f.depth_bound = near.distance_high - near.distance_low;
    f.value = near.distance_low;
    f.limit = options_.near;
    f.unit = "mm";
    if (const LinkPoses* poses = cache.at(near.t)) {
      const Pose X_WA = mesh_pose(a, *poses);
      f.points = {X_WA * near.on_a, X_WA * near.on_b};
    }
    out.add(f);
  }

  void report_unresolved(const Step& step, const Body& a, const Body& b,
                         const collide::Unresolved& gap, Findings& out) const {
    Finding f = finding_at(Kind::near_miss, step, gap.t0);
    name_pair(f, a, b);
    f.message = in_words(a) + " and " + in_words(b) + " come within " +
                fixed(step.scene.machine().collision_tolerance(), 4) + " mm " +
                during(step.segment) + ": neither contact nor clearance could be proven";
    f.t_end = gap.t1;
    f.u_first = fraction_at(step, gap.t0);
    f.u_end = fraction_at(step, gap.t1);
    f.depth = -gap.distance_high;
    f.depth_bound = gap.distance_high - gap.distance_low;
    f.unresolved = true;
    f.makes_unknown = true;
    out.add(f);
  }

  CheckOptions options_;
  std::optional<machine::MotionBound> bound_;
  JointVector start_joints_;
  bool pending_start_ = false;
  std::vector<Pair> pairs_;
  std::vector<std::string> pair_names_;  // by index of pairs_
  std::vector<std::string> exclusions_;
  std::size_t most_pairs_ = 0, most_bodies_ = 0, detailed_ = 0;
  collide::ProofCost cost_;
  double clear_time_ = 0, hit_time_ = 0, unresolved_time_ = 0;
};

}  // namespace

std::unique_ptr<Check> make_collision_check(const CheckOptions& options) {
  return std::make_unique<CollisionCheck>(options);
}

}  // namespace aircut::sim
