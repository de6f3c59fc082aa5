// Collisions and near misses of every watched pair of bodies, proven over the whole of every step.
//
// Which pairs: pairs.h.
// A pair that overlaps at the start pose is an error of the model (self_overlap); it is named and
// then left out, since nothing further can be said of it.
//
// Each pair keeps a budget of proven distance, so a step in which nothing is near costs no query.
// Where only linear couples lie between two links, all of their bodies move by the same way.

#include <algorithm>
#include <cmath>
#include <iterator>

#include "collide/budget.h"
#include "sim/checks/contact.h"
#include "sim/checks/pairs.h"
#include "sim/sim.h"

namespace aircut::sim {

namespace {

using machine::Body;
using machine::LinkPoses;

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

// Where channels run at once: whose block a pair of bodies is told at, and whose other block takes
// part. A channel that moves just one of the two bodies counts; one that rests comes second.
struct Told {
  const Step& step;
  const Step* other = nullptr;
};

bool rests(const Step& step) { return std::holds_alternative<plan::Hold>(step.segment.path); }

Told told_at(const Step& step, machine::LinkId a, machine::LinkId b) {
  if (!step.all) return {step};
  const auto& of_a = step.all->moved_by[static_cast<std::size_t>(index(a))];
  const auto& of_b = step.all->moved_by[static_cast<std::size_t>(index(b))];
  std::vector<std::size_t> moving;
  std::set_symmetric_difference(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(),
                                std::back_inserter(moving));
  std::stable_sort(moving.begin(), moving.end(), [&](std::size_t x, std::size_t y) {
    return !rests(step.all->of[x]) && rests(step.all->of[y]);
  });
  if (moving.empty()) return {step};
  return {step.all->of[moving[0]], moving.size() > 1 ? &step.all->of[moving[1]] : nullptr};
}

void name_other(Finding& f, const Told& told) {
  if (!told.other) return;
  f.other_channel = told.other->all->names[told.other->channel];
  f.other_span = told.other->span();
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
    std::erase_if(near_at_rest_, [](const NearAtRest& near) { return near.tool; });
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
    near_at_rest_.clear();  // the motion begins there
    PoseCache cache(step.scene.machine(), step.motion);
    const auto known = ways_of(step, cache);
    const double floor = collide::far_floor(
        options_.near, std::max(step.scene.machine().collision_tolerance(), 1e-6));
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      Pair& pair = pairs_[i];
      if (pair.left_out) continue;
      if (known && way_of_[i] && !pair.touching &&
          collide::spend(pair.budget, travels_[*way_of_[i]], floor)) {
        clear_time_ += step.motion.t1() - step.motion.t0();
        continue;
      }
      check_pair(step, pair, cache, out);
    }
  }

  void finish(Summary& summary, Findings& out) override {
    for (NearAtRest& near : near_at_rest_) out.add(std::move(near.row));
    summary.collision.pairs = most_pairs_;
    summary.collision.bodies = most_bodies_;
    summary.collision.distance_queries = cost_.distance_queries;
    summary.collision.overlap_queries = cost_.overlap_queries;
    const double total = clear_time_ + hit_time_ + unresolved_time_;
    summary.collision.clear = total > 0 ? clear_time_ / total : 1;
    summary.collision.hit = total > 0 ? hit_time_ / total : 0;
    summary.collision.unresolved = total > 0 ? unresolved_time_ / total : 0;
    summary.collision.exclusions = exclusions_;
    if (most_pairs_ == 0)
      summary.unchecked.push_back(
          "collisions: no two bodies with meshes that move against each other");
  }

 private:
  void choose_pairs(const Scene& scene) {
    WatchedPairs watched = watched_pairs(scene, pairs_);
    pairs_ = std::move(watched.pairs);
    exclusions_ = std::move(watched.exclusions);
    most_pairs_ = std::max(most_pairs_, pairs_.size());
    most_bodies_ = std::max(most_bodies_, scene.bodies().size());
    ways_.clear();
    way_of_.clear();
    for (const Pair& pair : pairs_) {
      auto way = linear_way(scene.machine(), scene.bodies()[pair.a].body.link,
                            scene.bodies()[pair.b].body.link);
      way_of_.push_back(std::nullopt);
      if (!way) continue;
      way_of_.back() =
          static_cast<std::size_t>(std::find(ways_.begin(), ways_.end(), *way) - ways_.begin());
      if (*way_of_.back() == ways_.size()) ways_.push_back(std::move(*way));
    }
  }

  // The driven joints between two links, when all that moves between them is linear.
  static std::optional<std::vector<std::size_t>> linear_way(const machine::Machine& machine,
                                                            machine::LinkId a, machine::LinkId b) {
    const auto chain = [&](machine::LinkId link) {  // couples up to the bed
      std::vector<int> out;
      for (; link != machine::bed_link;
           link = machine.links()[static_cast<std::size_t>(machine::index(link))].parent)
        out.push_back(machine.links()[static_cast<std::size_t>(machine::index(link))].joint);
      return out;
    };
    std::vector<int> up = chain(a), down = chain(b);
    while (!up.empty() && !down.empty() && up.back() == down.back()) {
      up.pop_back();
      down.pop_back();
    }
    up.insert(up.end(), down.rbegin(), down.rend());
    std::vector<std::size_t> out;
    for (const int couple : up) {
      const machine::Joint& joint = machine.tree()[static_cast<std::size_t>(couple)];
      if (joint.driven < 0 && joint.held) continue;
      if (joint.kind != machine::JointKind::linear || joint.driven < 0) return std::nullopt;
      out.push_back(static_cast<std::size_t>(joint.driven));
    }
    return out;
  }

  // How far bodies of each of these ways move against one another in the step; false: not known.
  bool ways_of(const Step& step, PoseCache& cache) {
    const std::vector<double>* travel = cache.travel(step.motion.t0(), step.motion.t1());
    if (!travel) return false;
    travels_.clear();
    for (const std::vector<std::size_t>& way : ways_) {
      double sum = 0;
      for (const std::size_t joint : way) sum += (*travel)[joint];
      travels_.push_back(sum);
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
      collide::Penetration depth;
      if (collide::overlap(*a.collision, X_WA, *b.collision, X_WB))
        depth = collide::penetration(*a.collision, X_WA, *b.collision, X_WB, {}, options_.touch);
      if (depth.depth <= options_.touch) {
        look_near(step, a, X_WA, b, X_WB);
        continue;
      }
      const Told told = told_at(step, a.body.link, b.body.link);
      Finding f = finding_at(kind, told.step,
                             kind == Kind::self_overlap ? step.motion.t0() : step.motion.t1());
      name_other(f, told);
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

  // What passes near is found by the motion; where none follows, the pose is all there is.
  void look_near(const Step& step, const SceneBody& a, const Pose& X_WA, const SceneBody& b,
                 const Pose& X_WB) {
    if (options_.near <= 0) return;
    ++cost_.distance_queries;
    const auto gap = collide::distance(*a.collision, X_WA, *b.collision, X_WB, options_.near);
    if (gap.capped || gap.value >= options_.near) return;
    Finding f = near_row(step, a.body, b.body, step.motion.t1(), gap.value);
    f.message = in_words(a.body) + " stands " + fixed(gap.value, 3) + " mm from " +
                in_words(b.body) + ", and nothing moves any more";
    f.depth_bound = 0;
    f.points = {gap.on_a, gap.on_b};
    near_at_rest_.push_back({std::move(f), is_tool(a.body.role) || is_tool(b.body.role)});
  }

  void check_pair(const Step& step, Pair& pair, PoseCache& cache, Findings& out) {
    const auto& bodies = step.scene.bodies();
    const SceneBody& a = bodies[pair.a];
    const SceneBody& b = bodies[pair.b];
    const double t1 = step.motion.t1();
    const Told told = told_at(step, a.body.link, b.body.link);
    const auto relative = relative_motion(*bound_, a, b, cache);
    PairAt at(a, b, cache, cost_);
    const collide::ProofOptions proof{.margin = options_.near,
                                      .resolution = step.scene.machine().collision_tolerance(),
                                      .touch = options_.touch};
    double t = step.motion.t0();
    // A probing move is made to touch; what it has touched it may come off again.
    const bool probing =
        std::holds_alternative<canon::Probe>(step.segment.command.action) &&
        (a.body.role == machine::Role::probe || a.body.role == machine::Role::cutter);
    if (pair.touching) pair.contact_end = t;
    // Contacts that end and begin again within a block are rows of their own; more than this many
    // are told as one that lasts to the block's end.
    constexpr int most_rows = 8;
    for (int row = 0; row < most_rows && t < t1; ++row) {
      const auto outcome =
          collide::prove(*a.collision, *b.collision, relative, t, t1, proof, pair.budget, cost_);
      double next = t1;
      std::visit(overloaded{
                     [&](const collide::Clear&) {
                       clear_time_ += t1 - t;
                       pair.touching = false;
                     },
                     [&](const collide::Near& near) {
                       clear_time_ += t1 - t;
                       pair.touching = false;
                       if (probing) return;
                       // Parting after a contact is no near miss of its own.
                       const bool parting = pair.contact_end >= 0 && t <= pair.contact_end + 1e-6;
                       if (parting && at.distance(t, near.distance_high + 3 * proof.resolution) <=
                                          near.distance_high + 2 * proof.resolution)
                         return;
                       report_near(told, a.body, b.body, near, cache, out);
                     },
                     [&](const collide::Hit& hit) {
                       next = row + 1 == most_rows ? t1 : at.end_of_contact(hit, t1);
                       clear_time_ += hit.t_first - t;
                       hit_time_ += next - hit.t_first;
                       const bool comes_off = pair.touching && hit.t_first <= pair.contact_end &&
                                              !goes_deeper(at, t, next);
                       pair.contact_end = next;
                       pair.touching = (probing || comes_off) && next >= t1;
                       if (probing || comes_off) return;
                       report_hit(told, a.body, b.body, hit, next, at, cache, out);
                     },
                     [&](const collide::Unresolved& gap) {
                       pair.touching = probing;
                       if (probing) pair.contact_end = t1;
                       // Bodies that come apart are within the resolution for a moment: that is
                       // the end of the contact that was told already.
                       if (pair.contact_end >= 0 && gap.t0 <= pair.contact_end + 1e-6) {
                         next = at.end_of_touch(t, t1, proof.resolution);
                         hit_time_ += next - t;
                         pair.contact_end = next;
                         return;
                       }
                       clear_time_ += (t1 - t) - (gap.t1 - gap.t0);
                       unresolved_time_ += gap.t1 - gap.t0;
                       report_unresolved(told, a.body, b.body, gap, out);
                     },
                 },
                 outcome);
      t = next;
    }
  }

  // True where bodies that touch at t0 overlap more than there until t1.
  bool goes_deeper(PairAt& at, double t0, double t1) const {
    const auto depth = [&](double until) {
      const auto worst = at.deepest(t0, until, options_.touch);
      return worst ? worst->penetration.depth : 0;
    };
    return depth(t1) > depth(t0) + 2 * options_.touch;
  }

  static void name_pair(Finding& f, const Body& a, const Body& b) {
    f.body_a = a.name;
    f.body_b = b.name;
    f.pair =
        std::string(machine::to_string(a.role)) + "-" + std::string(machine::to_string(b.role));
  }

  void report_hit(const Told& told, const Body& a, const Body& b, const collide::Hit& hit,
                  double t_end, PairAt& at, PoseCache& cache, Findings& out) {
    const Step& step = told.step;
    const bool probe = a.role == machine::Role::probe;
    Finding f = finding_at(probe ? Kind::probe_contact : Kind::collision, step, hit.t_first);
    name_pair(f, a, b);
    name_other(f, told);
    f.message =
        in_words(a) + (probe ? " touches " : " hits ") + in_words(b) + " " + during(step.segment);
    f.t_worst = hit.t_overlap;
    f.t_end = t_end;
    f.u_first = fraction_at(step, f.t_first);
    f.u_end = fraction_at(step, f.t_end);
    if (detailed_++ < options_.detailed)
      if (const auto worst = at.deepest(hit.t_overlap, t_end, options_.touch)) {
        f.depth = worst->penetration.depth;
        f.depth_bound = options_.touch;
        f.normal = worst->penetration.direction;
        f.points = {worst->penetration.point};
        f.t_worst = worst->t;
        f.axial_retract = is_tool(a.role) ? at.axial_retract(worst->t) : std::nullopt;
        if (const auto lift = f.axial_retract)
          f.remedy = "at its worst the tool must come up by " + fixed(*lift, 2) +
                     " mm along its axis to clear; retract first, or raise the clearance plane";
      }
    if (const auto state = step.motion.state_at(f.t_worst)) {
      f.joints_worst = state->q;
      f.tip = state->tip;
      f.feed_actual = state->path_speed;
    }
    const plan::SpeedProfile& profile = step.segment.profile;
    f.retreat = profile.at(f.t_worst - step.segment.t_start).s -
                profile.at(f.t_first - step.segment.t_start).s;
    if (f.points.empty())
      if (const LinkPoses* poses = cache.at(hit.t_overlap))
        f.points = {mesh_pose(a, *poses) * hit.point};
    out.add(f);
  }

  Finding near_row(const Step& step, const Body& a, const Body& b, double t, double gap) const {
    Finding f = finding_at(Kind::near_miss, step, t);
    name_pair(f, a, b);
    f.depth = -gap;
    f.value = gap;
    f.limit = options_.near;
    f.unit = "mm";
    return f;
  }

  void report_near(const Told& told, const Body& a, const Body& b, const collide::Near& near,
                   PoseCache& cache, Findings& out) const {
    if (options_.near <= 0 || near.distance_low >= options_.near) return;
    const Step& step = told.step;
    Finding f = near_row(step, a, b, near.t, near.distance_low);
    name_other(f, told);
    f.message = in_words(a) + " passes " + in_words(b) + " at " + fixed(near.distance_low, 3) +
                " mm " + during(step.segment);
    f.u_first = f.u_end = fraction_at(step, near.t);
    f.depth_bound = near.distance_high - near.distance_low;
    if (const LinkPoses* poses = cache.at(near.t)) {
      const Pose X_WA = mesh_pose(a, *poses);
      f.points = {X_WA * near.on_a, X_WA * near.on_b};
    }
    out.add(f);
  }

  void report_unresolved(const Told& told, const Body& a, const Body& b,
                         const collide::Unresolved& gap, Findings& out) const {
    const Step& step = told.step;
    Finding f = finding_at(Kind::near_miss, step, gap.t0);
    name_pair(f, a, b);
    name_other(f, told);
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
  struct NearAtRest {
    Finding row;
    bool tool = false;  ///< of the tool that is in the spindle
  };
  std::vector<NearAtRest> near_at_rest_;  ///< where the machine stands and has not moved since
  std::vector<Pair> pairs_;
  std::vector<std::vector<std::size_t>> ways_;      ///< of pairs with linear couples: joints
  std::vector<std::optional<std::size_t>> way_of_;  ///< each pair's among ways_
  std::vector<double> travels_;                     ///< of each way in the step at hand, mm
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
