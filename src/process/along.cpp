// Cuts come in the order of time, one at a time. Each is a contact; the model answers with the
// displacement of its tool against the work. A body that is named to a link of the machine goes
// with it: its base point, and the axes in which its compliance is stated. Nothing is kept of a
// stretch but a row of the table and what the summaries take from it.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include "accuracy/copying.h"
#include "process/contact.h"

namespace aircut::process {

using namespace accuracy;

namespace {

constexpr double doubtful_share = 0.1;  // of the depth: displacements beyond are no small ones

/// What is said once of a tool, with how often it was met.
struct Said {
  std::string kind, text;
  std::size_t tool = 0;
  SourceSpan span;
  Severity severity = Severity::warning;
  std::size_t count = 0;
};

/// The errors of one tool in a size.
struct SizeTool {
  double least = 0, most = 0, sum = 0, time = 0;
  double low = 0, high = 0;
  Field widest;
  SourceSpan span;  ///< of the largest error
  double largest = -1;
};

void append(std::string& out, double value) {
  if (std::abs(value) < 1e-9) value = 0;  // rounding of what is zero
  std::array<char, 40> buffer;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                 std::chars_format::general, 6);
  out += ',';
  out.append(buffer.data(), end.ptr);
}

}  // namespace

void Track::add(double x, double y) {
  if (waiting_ > 0 && waiting_ < stride_) {
    ++waiting_;
    if (std::abs(y) > std::abs(points_.back().second)) points_.back() = {x, y};
    return;
  }
  waiting_ = 1;
  points_.emplace_back(x, y);
  if (points_.size() < most) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i + 1 < points_.size(); i += 2)
    points_[kept++] = std::abs(points_[i].second) >= std::abs(points_[i + 1].second)
                          ? points_[i]
                          : points_[i + 1];
  points_.resize(kept);
  stride_ *= 2;
}

class Along::Impl {
 public:
  Impl(const Setup& setup, std::shared_ptr<const machine::Machine> machine, Diagnostics& out);
  Expected<void> write_to(const std::string& path);
  void on_cut(const sim::Cut& cut);
  Summary finish(Diagnostics& out);
  Expected<void> result();

 private:
  struct Answer {
    Load load;
    Response moved;
    double t = 0;  // that is really cut
    double delta = 0, floor = 0;
    double P_cut = 0, power = 0, torque = 0;
    std::optional<Field> field;
  };
  void check_file(Diagnostics& out);
  void place_bodies(const sim::Cut& cut);
  Answer answer(const sim::Cut& cut, const CutContact& contact, std::size_t tool);
  double depth_at_rest(const sim::Cut& cut, const CutContact& contact, std::size_t tool);
  Field field(const CutContact& contact, const Answer& answer);
  void add_shares(const CutContact& contact, std::size_t tool, const Answer& answer, double weight,
                  std::vector<double>& shares) const;
  void gather(const sim::Cut& cut, const CutContact& contact, const Answer& answer,
              std::size_t tool);
  void gather_sizes(const sim::Cut& cut, const CutContact& contact, const Answer& answer,
                    std::size_t tool);
  void row(const sim::Cut& cut, const CutContact& contact, const Answer& answer, std::size_t tool);
  void say(const char* kind, std::size_t tool, const SourceSpan& span, const std::string& text,
           Severity severity = Severity::warning);
  void tell_limits(const ToolSummary& tool, Diagnostics& out) const;
  DimensionResult dimension(std::size_t index, Diagnostics& out);
  std::optional<std::size_t> tool_of(int number) const;
  std::string name(std::size_t tool) const { return "T" + std::to_string(setup_.tools[tool].id); }

  const Setup& setup_;
  std::shared_ptr<const machine::Machine> machine_;
  Structure structure_;
  std::vector<std::optional<machine::LinkId>> links_;  // of bodies
  machine::LinkPoses poses_;
  machine::JointVector placed_;  // for which the bodies stand where they are
  bool moves_ = false, usable_ = true, scatters_ = false;
  std::vector<std::vector<int>> sides_;  // of bodies, by tool
  std::vector<ToolSummary> tools_;       // as in Setup::tools
  std::vector<std::vector<SizeTool>> sizes_;
  std::vector<Said> said_;
  std::optional<OutputFile> table_;
  std::string line_;
  Structure::Scratch scratch_;  // has the motions of the bodies for the shares
  Structure::Scratch trial_;    // of other forces
  std::size_t stretches_ = 0;
  double time_ = 0, way_ = 0, t_end_ = -1;
};

Along::Impl::Impl(const Setup& setup, std::shared_ptr<const machine::Machine> machine,
                  Diagnostics& out)
    : setup_(setup), machine_(std::move(machine)), structure_(setup.bodies) {
  const std::size_t errors = out.errors();
  check_file(out);
  usable_ = out.errors() == errors;
  if (!usable_) return;
  for (const ToolEntry& tool : setup.tools) {
    sides_.push_back(structure_.signs({tool.body, setup.works[0].body, {}}));
    scatters_ = scatters_ || tool.dt > 0;
  }
  scatters_ = scatters_ || setup.scatter.bands.epsilon > 0 || setup.scatter.bands.nu > 0;
  tools_.resize(setup.tools.size());
  for (std::size_t i = 0; i < tools_.size(); ++i) {
    tools_[i].tool = i;
    tools_[i].shares.assign(setup.bodies.size(), 0);
  }
  for (const Dimension& size : setup.dimensions) sizes_.emplace_back(size.tools.size());
}

void Along::Impl::check_file(Diagnostics& out) {
  std::vector<std::string> names;
  std::string all;
  for (const machine::Link& link : machine_->links()) {
    names.push_back(link.name);
    all += (all.empty() ? "" : ", ") + printable(link.name);
  }
  for (std::size_t b = 0; b < setup_.links.size(); ++b) {
    const std::string& name = setup_.links[b];
    links_.push_back(name.empty() ? std::nullopt : machine_->find_link(name));
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

std::optional<std::size_t> Along::Impl::tool_of(int number) const {
  for (std::size_t i = 0; i < setup_.tools.size(); ++i)
    if (setup_.tools[i].id == number) return i;
  return std::nullopt;
}

void Along::Impl::say(const char* kind, std::size_t tool, const SourceSpan& span,
                      const std::string& text, Severity severity) {
  for (Said& said : said_)
    if (said.tool == tool && said.kind == kind && said.text == text) {
      ++said.count;
      return;
    }
  said_.push_back({kind, text, tool, span, severity, 1});
}

void Along::Impl::place_bodies(const sim::Cut& cut) {
  if (!moves_ || cut.joints.size() == 0) return;
  if (placed_.size() == cut.joints.size() && placed_ == cut.joints) return;
  placed_ = cut.joints;
  machine::forward(*machine_, cut.joints, poses_);
  const Pose& X_LM = machine_->X_LM();
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

// Newton's method for the one tool: its depth answers its displacement.
double Along::Impl::depth_at_rest(const sim::Cut& cut, const CutContact& contact,
                                  std::size_t tool) {
  const auto row = [&](const Vec3& force, const Vec3& moment) {
    const Load load{force, moment};
    Response moved;
    structure_.respond({&contact.contact, 1}, {&load, 1}, trial_, {&moved, 1});
    return contact.normal.dot(moved.displacement);
  };
  ToolShare share;
  for (std::size_t i = 0; i < share.gain.size(); ++i) {
    const DepthForce::Term& term = contact.force.terms[i];
    share.gain[i] = term.factor > 0 ? row(term.direction * term.factor, Vec3::Zero()) : 0;
    share.exponent[i] = term.exponent;
  }
  share.offset = row(contact.force.fixed, contact.force.moment);
  share.t = contact.t;
  const CopyingResult solved = solve_copying({{contact.t}, {{share}}});
  if (solved.unstable)
    say("statically_unstable", tool, cut.span,
        "the force pulls " + name(tool) + " deeper than the machine's stiffness holds it back",
        Severity::error);
  else if (!solved.converged)
    say("copying_not_converged", tool, cut.span,
        "the depth that " + name(tool) +
            " cuts on the yielding machine was not found; the programmed one is used");
  return solved.converged ? solved.t[0] : contact.t;
}

Field Along::Impl::field(const CutContact& contact, const Answer& answer) {
  const Bands& bands = setup_.scatter.bands;
  const double a = contact.normal.dot(answer.moved.displacement);
  const Load slope{contact.force.slope(answer.t), Vec3::Zero()};
  Response moved;
  structure_.respond({&contact.contact, 1}, {&slope, 1}, trial_, {&moved, 1});
  const double b = contact.normal.dot(moved.displacement);
  const LinearField linear = linear_field({&a, 1}, {&b, 1}, {&contact.dt, 1}, bands);
  Field out{linear.opposed, linear.which, linear.N, linear.D, linear.low, linear.high, {}};
  if (!setup_.scatter.exact) return out;
  const Influence E = structure_.assemble({&contact.contact, 1});
  const Vec3 force_row = E.block(0, 0).topLeftCorner<3, 3>().transpose() * contact.normal;
  const Vec3 moment_row = E.block(0, 0).topRightCorner<3, 3>().transpose() * contact.normal;
  const ToolShare share = tool_share(contact.force, force_row, moment_row, answer.t, contact.dt);
  const ExactField exact = exact_field({&share, 1}, bands);
  out.low = exact.low;
  out.high = exact.high;
  return out;
}

Along::Impl::Answer Along::Impl::answer(const sim::Cut& cut, const CutContact& contact,
                                        std::size_t tool) {
  Answer out;
  out.t = setup_.settings.coupled ? depth_at_rest(cut, contact, tool) : contact.t;
  out.load = {contact.force.force(out.t), contact.force.moment};
  structure_.respond({&contact.contact, 1}, {&out.load, 1}, scratch_, {&out.moved, 1});
  if (scatters_ || !setup_.dimensions.empty()) out.field = field(contact, out);
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
  return out;
}

// Each joint's own part of the motion of what it carries, seen at the contact along its normal. A
// beam has what the joints leave.
void Along::Impl::add_shares(const CutContact& contact, std::size_t tool, const Answer& answer,
                             double weight, std::vector<double>& shares) const {
  double rest = answer.delta;
  std::size_t beam = setup_.bodies.size();
  for (std::size_t b = 0; b < setup_.bodies.size(); ++b) {
    const int side = sides_[tool][b];
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
    shares[b] += weight * part;
    rest -= part;
  }
  if (beam < setup_.bodies.size()) shares[beam] += weight * rest;
}

void Along::Impl::on_cut(const sim::Cut& cut) {
  if (!usable_) return;
  const auto tool = tool_of(cut.tool);
  if (!tool) {
    say("force_unknown", setup_.tools.size(), cut.span,
        "T" + std::to_string(cut.tool) + " is not under [[tools]] of the accuracy file");
    return;
  }
  std::string why;
  const auto contact = contact_of(setup_, *tool, 0, cut, why);
  if (!contact) {
    say("force_unknown", *tool, cut.span, "the force of " + name(*tool) + " is not known: " + why);
    return;
  }
  place_bodies(cut);
  const Answer found = answer(cut, *contact, *tool);
  if (!found.moved.displacement.allFinite() || !found.load.force.allFinite()) {
    say("force_unknown", *tool, cut.span,
        "the displacement of " + name(*tool) + " is no finite number");
    return;
  }
  ++stretches_;
  gather(cut, *contact, found, *tool);
  gather_sizes(cut, *contact, found, *tool);
  if (table_) row(cut, *contact, found, *tool);
}

void Along::Impl::gather(const sim::Cut& cut, const CutContact& contact, const Answer& found,
                         std::size_t tool) {
  ToolSummary& sum = tools_[tool];
  const double time = cut.t1 - cut.t0;
  if (cut.t0 > t_end_ + 1e-6) {  // nothing was cut in between
    for (ToolSummary& one : tools_)
      if (one.stretches > 0) one.over_time.add(t_end_, 0);
    sum.over_time.add(cut.t0, 0);
  }
  t_end_ = std::max(t_end_, cut.t1);
  ++sum.stretches;
  sum.time += time;
  time_ += time;
  sum.volume += cut.volume;
  sum.mean += time * found.delta;
  const double um = found.delta * 1e3;
  sum.over_time.add(0.5 * (cut.t0 + cut.t1), um);
  sum.over_way.add(way_ + cut.way / 2, um);
  way_ += cut.way;
  const Limits& limits = setup_.limits;
  const auto offer = [&](Worst& worst, double value, const std::optional<double>& limit) {
    worst.offer(value, cut);
    if (limit && value > *limit) ++worst.over;
  };
  offer(sum.force, found.P_cut, limits.cut_force);
  offer(sum.power, found.power, limits.power_kW);
  const auto torque =
      limits.torque_Nm ? std::optional(*limits.torque_Nm * 1e3) : std::optional<double>();
  offer(sum.torque, found.torque, torque);
  offer(sum.chip, contact.chip, limits.chip);
  const double moved = found.moved.displacement.norm();
  offer(sum.deflection, moved, limits.deflection);
  if (sum.stretches == 1) sum.most.value = found.delta, sum.least.value = -found.delta;
  sum.most.offer(found.delta, cut);
  sum.least.offer(-found.delta, cut);
  add_shares(contact, tool, found, time, sum.shares);
  if (contact.t > 0 && moved > doubtful_share * contact.t)
    say("displacement_large", tool, cut.span,
        "the displacement of " + name(tool) +
            " is more than a tenth of its depth: the model is linear and hardly holds");
  const auto& sides = sides_[tool];
  if (std::all_of(sides.begin(), sides.end(), [](int s) { return s == 0; }))
    say("no_relative_compliance", tool, cut.span,
        "nothing gives way between " + name(tool) + " and the work");
  if (const auto& law = contact.material->turning; law && cut.turned) {
    const auto warn = [&](const char* what, const std::optional<Interval>& valid, double value) {
      if (valid && !valid->holds(value))
        say("law_extrapolated", tool, cut.span,
            std::string(what) + " of " + name(tool) + " leaves " + shortest(valid->low) + " … " +
                shortest(valid->high) + ", where its law was measured");
    };
    warn("the depth", law->valid_t, contact.t);
    warn("the feed", law->valid_S, contact.S);
    warn("the speed", law->valid_V, contact.V);
  }
}

void Along::Impl::gather_sizes(const sim::Cut& cut, const CutContact& contact, const Answer& found,
                               std::size_t tool) {
  for (std::size_t i = 0; i < sizes_.size(); ++i) {
    const Dimension& asked = setup_.dimensions[i];
    const auto line = static_cast<double>(cut.span.line);
    if (asked.lines && !asked.lines->holds(line)) continue;
    bool inside = true;
    for (int a = 0; a < 3; ++a)
      if (const auto& range = asked.at[static_cast<std::size_t>(a)])
        inside = inside && range->holds(cut.point[a]);
    if (!inside) continue;
    for (std::size_t k = 0; k < asked.tools.size(); ++k) {
      if (asked.tools[k] != tool) continue;
      const bool floor = asked.kind == SizeKind::length && !contact.floor.isZero();
      const double error = size_error(asked.kind, floor ? found.floor : found.delta);
      const double factor = size_error(asked.kind, 1), time = cut.t1 - cut.t0;
      Field field = found.field.value_or(Field{});
      double low = factor * field.low, high = factor * field.high;
      if (low > high) std::swap(low, high);
      if (floor) low = high = error;
      SizeTool& sum = sizes_[i][k];
      const bool first = sum.time == 0;
      sum.least = first ? error : std::min(sum.least, error);
      sum.most = first ? error : std::max(sum.most, error);
      sum.low = first ? low : std::min(sum.low, low);
      sum.high = first ? high : std::max(sum.high, high);
      sum.sum += error * time;
      sum.time += time;
      if (first || field.width() > sum.widest.width()) sum.widest = field;
      if (std::abs(error) > sum.largest) {
        sum.largest = std::abs(error);
        sum.span = cut.span;
      }
    }
  }
}

Expected<void> Along::Impl::write_to(const std::string& path) {
  auto file = OutputFile::create(path);
  if (!file) return unexpected(file.error());
  table_ = std::move(*file);
  table_->write(
      "segment,t0_s,t1_s,line,block,tool,spindle,t_mm,width_mm,S_mm_rev,V_m_min,D_mm,Q_mm3_s,"
      "area_mm2,chip_mm,F_cut_N,power_kW,torque_Nm,F_x_N,F_y_N,F_z_N,M_x_Nm,M_y_Nm,M_z_Nm,A_x_mm,"
      "A_y_mm,A_z_mm,w_x_um,w_y_um,w_z_um,rot_x_urad,rot_y_urad,rot_z_urad,delta_um,floor_um,"
      "scatter_low_um,scatter_high_um\n");
  return {};
}

void Along::Impl::row(const sim::Cut& cut, const CutContact& contact, const Answer& found,
                      std::size_t tool) {
  line_ = std::to_string(stretches_);
  append(line_, cut.t0);
  append(line_, cut.t1);
  line_ += ',' + std::to_string(cut.span.line) + ',' + std::to_string(cut.block) + ',' +
           std::to_string(setup_.tools[tool].id) + ',' + std::to_string(setup_.works[0].spindle);
  const double turns = std::abs(cut.rpm) / 60 * (cut.t1 - cut.t0);
  const double circle = cut.turned ? std::numbers::pi * cut.mean * turns : 0;
  for (const double value : {found.t, contact.width, contact.S, contact.V, contact.diameter,
                             cut.volume / (cut.t1 - cut.t0), circle > 0 ? cut.volume / circle : 0.0,
                             contact.chip, found.P_cut, found.power, found.torque * 1e-3})
    append(line_, value);
  const auto add3 = [&](const Vec3& v, double unit) {
    for (int i = 0; i < 3; ++i) append(line_, v[i] * unit);
  };
  add3(found.load.force, 1);
  add3(found.load.moment, 1e-3);
  add3(cut.point, 1);
  add3(found.moved.displacement, 1e3);
  add3(found.moved.rotation, 1e6);
  append(line_, found.delta * 1e3);
  if (contact.floor.isZero())
    line_ += ',';
  else
    append(line_, found.floor * 1e3);
  if (found.field) {
    append(line_, found.field->low * 1e3);
    append(line_, found.field->high * 1e3);
  } else {
    line_ += ",,";
  }
  line_ += '\n';
  table_->write(line_);
}

void Along::Impl::tell_limits(const ToolSummary& tool, Diagnostics& out) const {
  const Limits& limits = setup_.limits;
  const auto tell = [&](const char* kind, const Worst& worst, const char* what, double limit,
                        double unit, const char* unit_name) {
    if (worst.over == 0) return;
    Diagnostic d = make_error(
        kind, worst.span,
        std::string(what) + " of " + name(tool.tool) + " is " + fixed(worst.value * unit, 3) + " " +
            unit_name + " here, the limit is " + fixed(limit * unit, 3) + " " + unit_name);
    d.notes.push_back({"note", "t = " + fixed(worst.t, 3) + " s; over it in " +
                                   std::to_string(worst.over) + " of " +
                                   std::to_string(tool.stretches) + " stretches"});
    out.add(std::move(d));
  };
  if (limits.cut_force)
    tell("force_limit", tool.force, "the cutting force", *limits.cut_force, 1, "N");
  if (limits.power_kW)
    tell("power_limit", tool.power, "the power at the motor", *limits.power_kW, 1, "kW");
  if (limits.torque_Nm)
    tell("torque_limit", tool.torque, "the torque", *limits.torque_Nm * 1e3, 1e-3, "N·m");
  if (limits.chip) tell("chip_load", tool.chip, "the chip's thickness", *limits.chip, 1, "mm");
  if (limits.deflection)
    tell("deflection", tool.deflection, "the displacement against the work", *limits.deflection,
         1e3, "µm");
}

// Two tools of a width add their errors; each may be anywhere in its own range.
DimensionResult Along::Impl::dimension(std::size_t index, Diagnostics& out) {
  const Dimension& asked = setup_.dimensions[index];
  DimensionResult result;
  SourceSpan place = asked.place;
  double largest = -1;
  for (std::size_t k = 0; k < sizes_[index].size(); ++k) {
    const SizeTool& tool = sizes_[index][k];
    if (tool.time == 0) {
      result.unchecked = name(asked.tools[k]) + " cuts nothing of it";
      return result;
    }
    result.least += tool.least;
    result.most += tool.most;
    result.mean += tool.sum / tool.time;
    const Field before = result.field;
    if (k == 0 || tool.widest.width() > before.width()) result.field = tool.widest;
    result.field.low = before.low * (k > 0) + tool.low;
    result.field.high = before.high * (k > 0) + tool.high;
    if (tool.largest > largest) place = tool.span;
    largest = std::max(largest, tool.largest);
  }
  judge(asked, place, result, out);
  return result;
}

Summary Along::Impl::finish(Diagnostics& out) {
  Summary sum;
  sum.stretches = stretches_;
  sum.time = time_;
  if (!usable_) {
    sum.unchecked.push_back("the accuracy: its file does not fit the machine");
    return sum;
  }
  for (ToolSummary& tool : tools_) {
    if (tool.stretches == 0) continue;
    tool.over_time.add(t_end_, 0);
    tool.mean /= tool.time;
    for (double& share : tool.shares) share /= tool.time;
    tool.least.value = -tool.least.value;
    tell_limits(tool, out);
    sum.tools.push_back(tool);
    const ToolEntry& entry = setup_.tools[tool.tool];
    const auto law =
        setup_.materials.find(entry.law.empty() ? setup_.works[0].material : entry.law);
    if (law != setup_.materials.end() &&
        std::find(sum.sources.begin(), sum.sources.end(), law->second.source) == sum.sources.end())
      sum.sources.push_back(law->second.source);
  }
  for (const Said& said : said_) {
    const std::string often =
        said.count > 1 ? " (" + std::to_string(said.count) + " stretches from here on)" : "";
    if (said.severity == Severity::error)
      out.error(said.kind, said.span, said.text + often);
    else
      out.warning(said.kind, said.span, said.text + often);
    if (said.kind == "force_unknown" || said.kind == "copying_not_converged")
      sum.unchecked.push_back("the accuracy: " + said.text);
  }
  for (std::size_t i = 0; i < sizes_.size(); ++i) {
    sum.dimensions.push_back(dimension(i, out));
    const DimensionResult& result = sum.dimensions.back();
    if (!result.unchecked.empty())
      sum.unchecked.push_back("the size '" + setup_.dimensions[i].name + "': " + result.unchecked);
  }
  if (setup_.scatter.independent_bodies || setup_.scatter.draws)
    sum.unchecked.push_back(
        "the scatter: 'independent_bodies' and 'monte_carlo' are for a set-up without a program");
  return sum;
}

Expected<void> Along::Impl::result() {
  if (!table_) return {};
  return table_->commit();
}

Along::Along(const Setup& setup, std::shared_ptr<const machine::Machine> machine, Diagnostics& out)
    : impl_(std::make_unique<Impl>(setup, std::move(machine), out)) {}
Along::~Along() = default;
Expected<void> Along::write_to(const std::string& path) { return impl_->write_to(path); }
void Along::on_cut(const sim::Cut& cut) { impl_->on_cut(cut); }
Summary Along::finish(Diagnostics& out) { return impl_->finish(out); }
Expected<void> Along::result() { return impl_->result(); }

}  // namespace aircut::process
