// Each segment of time has its own set of engaged tools. In it: assemble E, find the depths (with
// `coupled` they answer the displacement), displace, and look along each contact's normal. A size
// then takes the rows of its contacts, with the sign and factor by which it is measured, and gets
// its field of scatter from the same row: row · E_kl · F_l(t_l) for every engaged tool l.
#include "accuracy/evaluate.h"

#include <algorithm>
#include <cmath>

#include "accuracy/copying.h"

namespace aircut::accuracy {
namespace {

/// A contact's place in its segment, and how its normal error counts.
struct RowPart {
  std::size_t place = 0;
  double factor = 1;
};

class Evaluation {
 public:
  Evaluation(const Setup& setup, Diagnostics& out)
      : setup_(setup), out_(out), structure_(setup.bodies) {}

  Result run();

 private:
  SegmentResult segment(const std::vector<std::size_t>& active, std::optional<Span> span);
  void solve_depths(SegmentResult& segment);
  void displace(SegmentResult& segment);
  void loads_of(ContactResult& result) const;
  void check_limits(const SegmentResult& segment);
  DimensionResult dimension(const Dimension& asked, const std::vector<SegmentResult>& segments);
  Field field(const SegmentResult& segment, const std::vector<RowPart>& row) const;
  std::vector<ToolShare> shares(const SegmentResult& segment, const std::vector<RowPart>& row,
                                std::optional<std::size_t> body) const;
  const ContactEntry& entry(const ContactResult& result) const {
    return setup_.contacts[result.contact];
  }
  std::vector<Contact> contacts(const SegmentResult& segment) const;
  void once(Severity severity, const char* kind, const SourceSpan& place, std::string message);
  void limit(const char* kind, const ContactEntry& contact, const std::string& what, double value,
             double limit, const char* unit);

  const Setup& setup_;
  Diagnostics& out_;
  Structure structure_;
};

// The same is said once, however many segments say it.
void Evaluation::once(Severity severity, const char* kind, const SourceSpan& place,
                      std::string message) {
  for (const Diagnostic& d : out_.list())
    if (d.kind == kind && d.span.begin == place.begin && d.span.text == place.text) return;
  Diagnostic d = make_error(kind, place, std::move(message));
  d.severity = severity;
  out_.add(std::move(d));
}

void Evaluation::limit(const char* kind, const ContactEntry& contact, const std::string& what,
                       double value, double limit, const char* unit) {
  if (!(value > limit)) return;
  once(Severity::error, kind, contact.place,
       what + " is " + fixed(value, 3) + " " + unit + ", the limit is " + fixed(limit, 3) + " " +
           unit);
}

std::vector<Contact> Evaluation::contacts(const SegmentResult& segment) const {
  std::vector<Contact> out;
  for (const ContactResult& c : segment.contacts) out.push_back(entry(c).contact);
  return out;
}

std::vector<ToolShare> Evaluation::shares(const SegmentResult& segment,
                                          const std::vector<RowPart>& row,
                                          std::optional<std::size_t> body) const {
  std::vector<ToolShare> out;
  const auto all = contacts(segment);
  std::vector<int> signs(all.size(), 1);
  if (body)
    for (std::size_t k = 0; k < all.size(); ++k) signs[k] = structure_.signs(all[k])[*body];
  for (std::size_t l = 0; l < all.size(); ++l) {
    Vec3 force_row = Vec3::Zero(), moment_row = Vec3::Zero();
    for (const RowPart& part : row) {
      const std::size_t k = part.place;
      const Vec3 n = part.factor * entry(segment.contacts[k]).normal;
      const Mat6 B = body ? Mat6(signs[k] * signs[l] *
                                 body_influence(setup_.bodies[*body], all[k].point, all[l].point))
                          : segment.influence.block(k, l);
      force_row += B.topLeftCorner<3, 3>().transpose() * n;
      moment_row += B.topRightCorner<3, 3>().transpose() * n;
    }
    const ContactEntry& tool = entry(segment.contacts[l]);
    out.push_back(tool_share(tool.force, force_row, moment_row, segment.contacts[l].t, tool.dt));
  }
  return out;
}

Field Evaluation::field(const SegmentResult& segment, const std::vector<RowPart>& row) const {
  const ScatterSettings& scatter = setup_.scatter;
  const auto tools = shares(segment, row, std::nullopt);
  std::vector<double> a, b, dt;
  for (const ToolShare& tool : tools) {
    a.push_back(tool.at(tool.t));
    b.push_back(tool.slope(tool.t));
    dt.push_back(tool.dt);
  }
  const LinearField linear = linear_field(a, b, dt, scatter.bands);
  Field out{linear.opposed, linear.which, linear.N, linear.D, linear.low, linear.high, {}};
  if (scatter.independent_bodies) {
    std::vector<BodyShare> bodies;
    for (std::size_t body = 0; body < setup_.bodies.size(); ++body)
      bodies.push_back({shares(segment, row, body), setup_.epsilon[body]});
    const ExactField exact = independent_field(bodies, scatter.bands.nu);
    out.low = exact.low;
    out.high = exact.high;
  } else if (scatter.exact) {
    const ExactField exact = exact_field(tools, scatter.bands);
    out.low = exact.low;
    out.high = exact.high;
  }
  if (scatter.draws) out.sample = monte_carlo(tools, scatter.bands, *scatter.draws);
  return out;
}

void Evaluation::solve_depths(SegmentResult& segment) {
  CopyingProblem problem;
  for (std::size_t k = 0; k < segment.contacts.size(); ++k) {
    problem.t0.push_back(segment.contacts[k].t);
    problem.shares.push_back(shares(segment, {{k, 1}}, std::nullopt));
  }
  const CopyingResult solved = solve_copying(problem);
  const SourceSpan& place = entry(segment.contacts[0]).place;
  if (solved.unstable)
    once(Severity::error, "statically_unstable", place,
         "the forces pull the tools deeper than the machine's stiffness holds them back");
  else if (!solved.converged)
    once(Severity::warning, "copying_not_converged", place,
         "the depths that the yielding machine cuts were not found; the programmed ones are used");
  if (!solved.converged) return;
  for (std::size_t k = 0; k < segment.contacts.size(); ++k) {
    segment.contacts[k].t = solved.t[k];
    segment.contacts[k].copy_ratio =
        solved.ratio(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(k));
  }
}

void Evaluation::loads_of(ContactResult& result) const {
  const ContactEntry& c = entry(result);
  result.load = {c.force.force(result.t), c.force.moment};
  const double eta = setup_.limits.efficiency;
  if (c.cut_law.C > 0) {
    const WorkEntry& work = setup_.works[c.work];
    const Vec3 arm = c.contact.point - work.axis_point;
    result.P_cut = c.cut_law.at(result.t, c.S, c.V);
    result.power = turning_power(result.P_cut, c.V, eta);
    result.torque = result.P_cut * (arm - work.axis * work.axis.dot(arm)).norm();
  } else {
    result.power = c.power / eta;
    result.torque = c.torque;
    result.P_cut = c.diameter > 0 ? 2 * c.torque / c.diameter : 0;
  }
}

void Evaluation::displace(SegmentResult& segment) {
  const auto all = contacts(segment);
  std::vector<Load> loads;
  for (ContactResult& result : segment.contacts) {
    loads_of(result);
    loads.push_back(result.load);
  }
  Structure::Scratch scratch;
  std::vector<Response> moved(all.size());
  structure_.respond(all, loads, scratch, moved);
  for (std::size_t k = 0; k < all.size(); ++k) {
    ContactResult& result = segment.contacts[k];
    const ContactEntry& c = entry(result);
    result.moved = moved[k];
    const auto signs = structure_.signs(all[k]);
    if (std::all_of(signs.begin(), signs.end(), [](int s) { return s == 0; }))
      once(Severity::warning, "no_relative_compliance", c.place,
           "tool and work hang on the same bodies, so nothing gives way between them: the "
           "displacement is 0");
    if (c.t > 0 && moved[k].displacement.norm() > 0.1 * c.t)
      once(Severity::warning, "displacement_large", c.place,
           "the displacement of " + fixed(moved[k].displacement.norm() * 1e3, 1) +
               " µm is more than a tenth of the depth: the model is linear and hardly holds");
    if (!moved[k].displacement.allFinite() || !moved[k].rotation.allFinite()) {
      once(Severity::error, "accuracy_range", c.place,
           "the displacement is no finite number: a force or a compliance is far too large");
      continue;
    }
    if (c.normal.isZero()) continue;
    const WorkEntry& work = setup_.works[c.work];
    result.delta = setup_.settings.second_order
                       ? normal_error_exact(c.normal, work.axis, all[k].point - work.axis_point,
                                            moved[k].displacement)
                       : normal_error(c.normal, moved[k].displacement);
    result.shares = error_shares(structure_, all, loads, k, c.normal);
    result.field = field(segment, {{k, 1}});
  }
}

void Evaluation::check_limits(const SegmentResult& segment) {
  const Limits& limits = setup_.limits;
  // Tools on one spindle load its drive together.
  std::map<std::size_t, std::pair<double, double>> spindles;
  for (const ContactResult& result : segment.contacts) {
    const ContactEntry& c = entry(result);
    if (limits.cut_force)
      limit("force_limit", c, "the cutting force", result.P_cut, *limits.cut_force, "N");
    if (limits.chip) limit("chip_load", c, "the chip's thickness", c.chip, *limits.chip, "mm");
    if (limits.deflection)
      limit("deflection", c, "the tool's displacement against the work",
            result.moved.displacement.norm() * 1e3, *limits.deflection * 1e3, "µm");
    auto& [power, torque] = spindles[c.cut_law.C > 0 ? c.work : setup_.works.size() + c.tool];
    power += result.power;
    torque += result.torque;
    if (limits.power_kW)
      limit("power_limit", c, "the power at the motor", power, *limits.power_kW, "kW");
    if (limits.torque_Nm)
      limit("torque_limit", c, "the torque of the spindle", torque * 1e-3, *limits.torque_Nm,
            "N·m");
  }
}

SegmentResult Evaluation::segment(const std::vector<std::size_t>& active,
                                  std::optional<Span> span) {
  SegmentResult out;
  out.span = span;
  for (const std::size_t k : active) {
    ContactResult result;
    result.contact = k;
    result.t = setup_.contacts[k].t;
    out.contacts.push_back(result);
  }
  out.influence = structure_.assemble(contacts(out));
  if (setup_.settings.coupled) solve_depths(out);
  displace(out);
  check_limits(out);
  return out;
}

DimensionResult Evaluation::dimension(const Dimension& asked,
                                      const std::vector<SegmentResult>& segments) {
  DimensionResult out;
  double time = 0, widest = -1;
  for (const SegmentResult& segment : segments) {
    std::vector<RowPart> row;
    double error = 0;
    std::size_t found = 0;
    for (const std::size_t tool : asked.tools)
      for (std::size_t k = 0; k < segment.contacts.size(); ++k) {
        const ContactResult& result = segment.contacts[k];
        if (entry(result).tool != tool) continue;
        if (!result.delta) {
          out.unchecked = "a contact of its tool has no 'normal'";
          continue;
        }
        ++found;
        row.push_back({k, size_error(asked.kind, 1)});
        error += size_error(asked.kind, *result.delta);
      }
    if (found == 0) continue;
    if (found != asked.tools.size()) {
      out.unchecked = asked.tools.size() == 2
                          ? "the two tools of a width must cut at the same time, once each"
                          : "its tool has two contacts at the same time";
      continue;
    }
    const Field field = this->field(segment, row);
    const double duration = segment.span ? segment.span->to - segment.span->from : 1;
    const bool first = time == 0;
    out.least = first ? error : std::min(out.least, error);
    out.most = first ? error : std::max(out.most, error);
    out.mean += error * duration;
    time += duration;
    const double low = first ? field.low : std::min(out.field.low, field.low);
    const double high = first ? field.high : std::max(out.field.high, field.high);
    if (field.width() > widest) {
      widest = field.width();
      out.field = field;
    }
    out.field.low = low;
    out.field.high = high;
  }
  if (time > 0)
    out.mean /= time;
  else if (out.unchecked.empty())
    out.unchecked = "its tool cuts nowhere";
  if (out.unchecked.empty()) judge(asked, asked.place, out, out_);
  return out;
}

Result Evaluation::run() {
  Result out;
  const auto& all = setup_.contacts;
  const bool timed =
      std::any_of(all.begin(), all.end(), [](const ContactEntry& c) { return c.span.has_value(); });
  if (!timed) {
    std::vector<std::size_t> together;
    for (std::size_t k = 0; k < all.size(); ++k) together.push_back(k);
    if (!together.empty()) out.segments.push_back(segment(together, std::nullopt));
  } else {
    // A contact without times cuts all the while.
    Span whole{1e300, -1e300};
    for (const ContactEntry& c : all)
      if (c.span) whole = {std::min(whole.from, c.span->from), std::max(whole.to, c.span->to)};
    std::vector<Span> spans;
    for (const ContactEntry& c : all) spans.push_back(c.span.value_or(whole));
    for (const ActiveSegment& s : active_segments(spans))
      out.segments.push_back(segment(s.active, Span{s.from, s.to}));
  }
  for (const Dimension& asked : setup_.dimensions)
    out.dimensions.push_back(dimension(asked, out.segments));
  return out;
}

}  // namespace

void judge(const Dimension& asked, const SourceSpan& place, DimensionResult& result,
           Diagnostics& out) {
  if (asked.nominal > 0) result.it_grade = it_grade_of(asked.nominal, result.field.width());
  if (!asked.tolerance) return;
  const auto [low, high] = *asked.tolerance;
  result.capability = capability(result.field.low, result.field.high, low, high, asked.compensate);
  const auto um = [](double mm) { return fixed(mm * 1e3, 1); };
  const std::string name = "'" + printable(asked.name) + "'";
  const std::string band = um(low) + " … " + um(high) + " µm";
  if (!asked.compensate && (result.least < low || result.most > high))
    out.error("size_error", place,
              "the size " + name + " is off by " + um(result.least) +
                  (result.most > result.least ? " … " + um(result.most) : "") +
                  " µm, its tolerance is " + band);
  else if (!result.capability->fits)
    out.error("scatter_too_wide", place,
              "over a batch the size " + name + " scatters over " + um(result.field.low) + " … " +
                  um(result.field.high) + " µm, its tolerance is " + band);
}

Result evaluate(const Setup& setup, Diagnostics& out) { return Evaluation(setup, out).run(); }

}  // namespace aircut::accuracy
