// Where a probing move meets the model, or leaves it.
//
// The move is looked at before it is planned: its way alone counts, so "time" here is the way gone,
// in mm. The bodies that touch are the tip of a tool with `probe = true`, otherwise the cutter (a
// tool that touches a plate). Against each other body the same proof as for collisions
// (collide/prove.cpp) gives the first contact, between "still apart" and "certainly inside", which
// are about 2e-4 mm apart; the middle is taken. The first of all bodies trips the probe.
//
//   toward   ──────────►│ first contact            trips there
//   away     ◄──────────│ nothing touches any more  trips there
//
// What can't be proven (a grazing touch, a pose out of reach, no geometry) is no answer: `unknown`.
#include "sim/probing.h"

#include <algorithm>

#include "sim/checks/contact.h"
#include "tool/insert.h"

namespace aircut::sim {
namespace {

using machine::Role;

// mm. A probe that came to rest within `at_contact` of what it touched still counts as touching.
constexpr collide::ProofOptions proof{.margin = 0, .resolution = 1e-4, .touch = 1e-4};
constexpr double at_contact = 1e-3;

ProbeResult unknown(std::string why) { return {ProbeResult::What::unknown, 0, std::move(why)}; }

class Search {
 public:
  explicit Search(const ProbeScene& probing)
      : probing_(probing),
        motion_(probing.scene.machine(), probing.way, probing.joints),
        cache_(probing.scene.machine(), motion_),
        end_(plan::length(probing.way.path)) {}

  ProbeResult run() {
    for (const Pair& pair : watched_pairs(probing_.scene, {}, ToolAndStock::watched).pairs)
      choose(pair);
    if (pairs_.empty()) return unknown("nothing that its tip could touch is described");
    return probing_.away ? away() : toward();
  }

 private:
  struct Bodies {
    SceneBody tip, other;
  };

  void choose(const Pair& pair) {
    const auto& bodies = probing_.scene.bodies();
    const SceneBody& tip = bodies[pair.a];
    if (tip.body.role != role_of_tip()) return;
    SceneBody other = bodies[pair.b];
    if (other.body.role == Role::stock) {
      if (!probing_.stock) return;
      other.collision = probing_.stock;
    }
    expected_ = expected_ || other.body.role == Role::stock || other.body.role == Role::fixture;
    pairs_.push_back({tip, std::move(other)});
  }

  Role role_of_tip() const {
    const tool::Tool* tool = probing_.scene.tool();
    return tool && tool::is_probe(*tool) ? Role::probe : Role::cutter;
  }

  double distance(const Bodies& pair, double s) {
    return PairAt(pair.tip, pair.other, cache_, cost_).distance(s, 2 * at_contact);
  }

  ProbeResult toward() {
    ProbeResult first{ProbeResult::What::missed, end_, {}};
    double doubt = 2 * end_;
    for (const Bodies& pair : pairs_) {
      if (distance(pair, 0) <= proof.resolution)
        return {ProbeResult::What::wrong_start, 0, in_words(pair.other.body)};
      collide::Budget budget;
      const auto motion = relative_motion(probing_.bound, pair.tip, pair.other, cache_);
      const auto outcome = collide::prove(*pair.tip.collision, *pair.other.collision, motion, 0,
                                          end_, proof, budget, cost_);
      if (const auto* gap = std::get_if<collide::Unresolved>(&outcome))
        doubt = std::min(doubt, gap->t0);
      const auto* hit = std::get_if<collide::Hit>(&outcome);
      const double s = hit ? (hit->t_first + hit->t_overlap) / 2 : end_;
      if (hit && (first.what == ProbeResult::What::missed || s < first.way))
        first = {ProbeResult::What::tripped, s, in_words(pair.other.body)};
    }
    if (doubt < first.way || (doubt <= end_ && first.what == ProbeResult::What::missed))
      return unknown("whether it touches on its way could not be proven");
    return judged(first);
  }

  // The last of the bodies that it comes off; one that is met meanwhile is taken along.
  ProbeResult away() {
    double s = 0;
    std::string touched;
    bool more = true;
    for (int round = 0; more && round < 16; ++round) {
      more = false;
      for (const Bodies& pair : pairs_) {
        if (distance(pair, s) > (s == 0 ? at_contact : 0)) continue;
        touched = in_words(pair.other.body);
        if (distance(pair, s) > 0) continue;
        PairAt at(pair.tip, pair.other, cache_, cost_);
        s = at.end_of_contact({.t_first = s, .t_overlap = s}, end_);
        more = true;
        if (s >= end_) return judged({ProbeResult::What::missed, end_, touched});
      }
    }
    if (touched.empty()) return judged({ProbeResult::What::wrong_start, 0, {}});
    return {ProbeResult::What::tripped, s, touched};
  }

  // Where no work is described, nothing is known of what a program probes.
  ProbeResult judged(ProbeResult result) const {
    if (result.what == ProbeResult::What::tripped || expected_) return result;
    return unknown("neither a stock nor a fixture is described, and it touches nothing else");
  }

  const ProbeScene& probing_;
  motion::JointMotion motion_;
  PoseCache cache_;
  double end_;
  collide::ProofCost cost_;
  std::vector<Bodies> pairs_;
  bool expected_ = false;  ///< there is work to be touched
};

}  // namespace

ProbeResult find_trip(const ProbeScene& probing) {
  const tool::Tool* tool = probing.scene.tool();
  if (!tool) return unknown("no tool is in the spindle");
  if (!tool::has_body(*tool) || !tool->unknown.empty())
    return unknown("tool T" + std::to_string(tool->number) + " has no geometry");
  if (!(plan::length(probing.way.path) > 0)) return unknown("it has no way");
  return Search(probing).run();
}

}  // namespace aircut::sim
