// Each joint of the machine that a body is named to takes it along: its base point, and the axes in
// which its compliance is stated. The contacts of a piece of time are one load case; what one of
// them alone does to the others (for the depths at rest and the scatter) is the same machine under
// its load only.
#include "process/elastic.h"

#include <cmath>

namespace aircut::process {

using namespace accuracy;

Elastic::Elastic(const Setup& setup, const machine::Machine& machine, Remarks& remarks,
                 Diagnostics& out)
    : setup_(setup), machine_(machine), remarks_(remarks), structure_(setup.bodies) {
  const std::size_t errors = out.errors();
  check_file(out);
  if (out.errors() != errors) return;
  for (const ToolEntry& tool : setup.tools) {
    sides_.push_back(structure_.signs({tool.body, setup.works[0].body, {}}));
    scatters_ = scatters_ || tool.dt > 0;
  }
  scatters_ = scatters_ || setup.scatter.bands.epsilon > 0 || setup.scatter.bands.nu > 0;
}

void Elastic::check_file(Diagnostics& out) {
  std::vector<std::string> names;
  std::string all;
  for (const machine::Link& link : machine_.links()) {
    names.push_back(link.name);
    all += (all.empty() ? "" : ", ") + printable(link.name);
  }
  for (std::size_t b = 0; b < setup_.links.size(); ++b) {
    const std::string& name = setup_.links[b];
    links_.push_back(name.empty() ? std::nullopt : machine_.find_link(name));
    moves_ = moves_ || links_.back();
    if (!name.empty() && !links_.back())
      out.error("accuracy_reference", setup_.link_places[b],
                "the machine has no link '" + printable(name) + "', only " + all + "." +
                    did_you_mean(name, names));
  }
  if (setup_.works.size() != 1) {
    const SourceSpan place = setup_.works.empty() ? SourceSpan{} : setup_.works.back().place;
    out.error("accuracy_reference", place,
              "along a program there is one stock, so the file needs one [[works]]; this has " +
                  std::to_string(setup_.works.size()));
    return;
  }
  const WorkEntry& work = setup_.works[0];
  const Vec3 off = work.axis_point.cross(Vec3::UnitZ());
  if (std::abs(work.axis.z()) < 1 - 1e-9 || off.norm() > 1e-6)
    out.error("accuracy_range", work.place,
              "along a program the work turns about the machine's Z: leave 'axis' and 'axis_point' "
              "out, or give [0, 0, 1] or [0, 0, -1]");
}

void Elastic::place(const machine::JointVector& joints) {
  if (!moves_ || joints.size() == 0) return;
  if (placed_.size() == joints.size() && placed_ == joints) return;
  placed_ = joints;
  machine::forward(machine_, joints, poses_);
  const Pose& X_LM = machine_.X_LM();
  for (std::size_t b = 0; b < links_.size(); ++b) {
    if (!links_[b]) continue;
    const Pose& X_WL = poses_.X_WL[static_cast<std::size_t>(machine::index(*links_[b]))];
    const Pose moved = X_LM.inverse(Eigen::Isometry) * X_WL * X_LM;
    const Mat3 R = moved.linear();
    const Body& given = setup_.bodies[b];
    Body& body = structure_.body(b);
    body.base_point = moved * given.base_point;
    body.compliance = rotated(given.compliance, R);
    if (!given.beam) continue;
    body.beam->clamp = moved * given.beam->clamp;
    body.beam->axis = R * given.beam->axis;
  }
}

void Elastic::respond(std::span<const Load> loads, Structure::Scratch& scratch) {
  moved_.resize(contacts_.size());
  structure_.respond(contacts_, loads, scratch, moved_);
}

// What the load of one contact alone does to each along its normal.
const std::vector<double>& Elastic::along_normals(std::size_t source, const Load& load) {
  loads_.assign(contacts_.size(), {});
  loads_[source] = load;
  respond(loads_, trial_);
  row_.resize(contacts_.size());
  for (std::size_t k = 0; k < row_.size(); ++k) row_[k] = normals_[k].dot(moved_[k].displacement);
  return row_;
}

// Newton's method: each depth answers the displacement that all of them cause.
void Elastic::find_depths(std::span<const Engaged> engaged) {
  const std::size_t n = engaged.size();
  CopyingProblem problem;
  problem.shares.assign(n, std::vector<ToolShare>(n));
  for (std::size_t l = 0; l < n; ++l) {
    const DepthForce& force = engaged[l].contact.force;
    problem.t0.push_back(engaged[l].contact.t);
    for (std::size_t i = 0; i < force.terms.size(); ++i) {
      const DepthForce::Term& term = force.terms[i];
      if (!(term.factor > 0)) continue;
      const auto& row = along_normals(l, {term.direction * term.factor, Vec3::Zero()});
      for (std::size_t k = 0; k < n; ++k) {
        problem.shares[k][l].gain[i] = row[k];
        problem.shares[k][l].exponent[i] = term.exponent;
      }
    }
    const auto& row = along_normals(l, {force.fixed, force.moment});
    for (std::size_t k = 0; k < n; ++k) {
      problem.shares[k][l].offset = row[k];
      problem.shares[k][l].t = engaged[l].contact.t;
    }
  }
  const CopyingResult solved = solve_copying(problem);
  for (std::size_t k = 0; k < n; ++k) {
    const std::string name = "T" + std::to_string(setup_.tools[engaged[k].tool].id);
    const SourceSpan& span = engaged[k].cut->span;
    answers_[k].t = solved.converged ? solved.t[k] : engaged[k].contact.t;
    if (solved.unstable)
      remarks_.say("statically_unstable", engaged[k].tool, span,
                   "the force pulls " + name + " deeper than the machine's stiffness holds it back",
                   Severity::error);
    else if (!solved.converged)
      remarks_.say("copying_not_converged", engaged[k].tool, span,
                   "the depth that " + name +
                       " cuts on the yielding machine was not found; the programmed one is used");
  }
}

void Elastic::fields(std::span<const Engaged> engaged) {
  const Bands& bands = setup_.scatter.bands;
  const std::size_t n = engaged.size();
  std::vector<std::vector<double>> a(n, std::vector<double>(n)), b = a;  // [contact][source]
  std::vector<double> dt(n);
  for (std::size_t l = 0; l < n; ++l) {
    if (n == 1) {
      a[0][0] = normals_[0].dot(answers_[0].moved.displacement);
    } else {
      const auto& part = along_normals(l, answers_[l].load);
      for (std::size_t k = 0; k < n; ++k) a[k][l] = part[k];
    }
    const auto& slope =
        along_normals(l, {engaged[l].contact.force.slope(answers_[l].t), Vec3::Zero()});
    for (std::size_t k = 0; k < n; ++k) b[k][l] = slope[k];
    dt[l] = engaged[l].contact.dt;
  }
  const bool exact = setup_.scatter.exact;
  const Influence E = exact ? structure_.assemble(contacts_) : Influence(0);
  for (std::size_t k = 0; k < n; ++k) {
    const LinearField linear = linear_field(a[k], b[k], dt, bands);
    Field out{linear.opposed, linear.which, linear.N, linear.D, linear.low, linear.high, {}};
    if (exact) {
      std::vector<ToolShare> shares;
      for (std::size_t l = 0; l < n; ++l) {
        const Vec3 force_row = E.block(k, l).topLeftCorner<3, 3>().transpose() * normals_[k];
        const Vec3 moment_row = E.block(k, l).topRightCorner<3, 3>().transpose() * normals_[k];
        shares.push_back(
            tool_share(engaged[l].contact.force, force_row, moment_row, answers_[l].t, dt[l]));
      }
      const ExactField hull = exact_field(shares, bands);
      out.low = hull.low;
      out.high = hull.high;
    }
    answers_[k].field = out;
  }
}

void Elastic::judge(const Engaged& engaged, Answer& out) const {
  const CutContact& contact = engaged.contact;
  const WorkEntry& work = setup_.works[0];
  const Vec3 arm = contact.contact.point - work.axis_point;
  const bool circle = setup_.settings.second_order && contact.cut_law.C > 0;
  out.delta = circle ? normal_error_exact(contact.normal, work.axis, arm, out.moved.displacement)
                     : normal_error(contact.normal, out.moved.displacement);
  out.floor = contact.floor.dot(out.moved.displacement);
  const double eta = setup_.limits.efficiency;
  if (contact.cut_law.C > 0) {
    out.P_cut = contact.cut_law.at(out.t, contact.S, contact.V);
    out.power = turning_power(out.P_cut, contact.V, eta);
    out.torque = out.P_cut * (arm - work.axis * work.axis.dot(arm)).norm();
  } else {
    out.torque = contact.torque;
    out.power = contact.power / eta;
    out.P_cut = contact.diameter > 0 ? 2 * contact.torque / contact.diameter : 0;
  }
}

// Each joint's own part of the motion of what it carries, seen at the contact along its normal. A
// beam has what the joints leave.
void Elastic::add_shares(const Engaged& engaged, Answer& answer) const {
  const CutContact& contact = engaged.contact;
  std::vector<double>& shares = answer.shares;
  shares.assign(setup_.bodies.size(), 0);
  double rest = answer.delta;
  std::size_t beam = setup_.bodies.size();
  for (std::size_t b = 0; b < setup_.bodies.size(); ++b) {
    const int side = sides_[engaged.tool][b];
    if (side == 0) continue;
    if (setup_.bodies[b].beam) {
      beam = b;
      continue;
    }
    const Response& motion = scratch_.motion[b];
    Vec3 displacement = motion.displacement, rotation = motion.rotation;
    if (const int parent = setup_.bodies[b].parent; parent != ground) {
      displacement -= scratch_.motion[static_cast<std::size_t>(parent)].displacement;
      rotation -= scratch_.motion[static_cast<std::size_t>(parent)].rotation;
    }
    const double part =
        side * contact.normal.dot(displacement + rotation.cross(contact.contact.point));
    shares[b] += part;
    rest -= part;
  }
  if (beam < setup_.bodies.size()) shares[beam] += rest;
}

std::span<const Answer> Elastic::answer(std::span<const Engaged> engaged) {
  contacts_.clear();
  normals_.clear();
  loads_.clear();
  answers_.resize(engaged.size());
  for (const Engaged& one : engaged) {
    contacts_.push_back(one.contact.contact);
    normals_.push_back(one.contact.normal);
  }
  for (std::size_t k = 0; k < engaged.size(); ++k) answers_[k].t = engaged[k].contact.t;
  if (setup_.settings.coupled) find_depths(engaged);
  loads_.clear();
  for (std::size_t k = 0; k < engaged.size(); ++k) {
    const DepthForce& force = engaged[k].contact.force;
    answers_[k].load = {force.force(answers_[k].t), force.moment};
    loads_.push_back(answers_[k].load);
  }
  respond(loads_, scratch_);
  for (std::size_t k = 0; k < engaged.size(); ++k) {
    answers_[k].moved = moved_[k];
    answers_[k].field.reset();
    judge(engaged[k], answers_[k]);
    add_shares(engaged[k], answers_[k]);
  }
  if (scatters_ || !setup_.dimensions.empty()) fields(engaged);
  return answers_;
}

}  // namespace aircut::process
