#include "process/contact.h"

#include <cmath>
#include <numbers>

namespace aircut::process {
namespace {

using namespace accuracy;
using std::numbers::pi;

const Material* material_of(const Setup& setup, const ToolEntry& tool, const WorkEntry& work,
                            std::string& why) {
  const std::string& name = tool.law.empty() ? work.material : tool.law;
  const auto found = setup.materials.find(name);
  if (found != setup.materials.end()) return &found->second;
  why = "it has no 'law' and its work no 'material'";
  return nullptr;
}

bool turned(const Setup& setup, const ToolEntry& tool, const WorkEntry& work, const sim::Cut& cut,
            CutContact& out, std::string& why) {
  out.t = cut.depth;
  out.diameter = setup.settings.mean_diameter ? cut.mean : cut.outer;
  out.S = cut.speed() * 60 / std::abs(cut.rpm);
  out.V = pi * out.diameter * std::abs(cut.rpm) / 1000;
  out.normal = cut.plunge ? Vec3(-cut.feed) : cut.normal;
  const double kappa =
      cut.plunge ? pi / 2 : effective_kappa(tool.kappa, tool.nose_radius, cut.depth);
  auto laws = turning_laws(*out.material, kappa);
  if (!laws) {
    why = "its material has no law for turning ('cut', 'thrust' and 'feed', or 'kienzle')";
    return false;
  }
  // The sides of a groove push against each other.
  if (cut.plunge) (*laws)[1].C = 0;
  const Vec3 omega = std::copysign(1.0, cut.rpm) * work.axis;
  const auto triad = turning_triad(omega, cut.point - work.axis_point, cut.feed,
                                   cut.plunge ? Vec3(work.axis.cross(cut.feed)) : cut.normal);
  if (!triad || !(out.V > 0)) {
    why = "at the spindle's axis nothing turns, so no law holds";
    return false;
  }
  out.cut_law = laws->front();
  out.chip = out.S * std::sin(kappa);
  set_terms(out.force, *triad, *laws, out.S, out.V);
  return true;
}

bool milled(const ToolEntry& tool, const sim::Cut& cut, CutContact& out, std::string& why) {
  const Cutter& cutter = *tool.cutter;
  const double R = cutter.diameter / 2, rpm = std::abs(cut.rpm);
  const auto law = edge_law(*out.material);
  if (!law) {
    why = "its material has no law for milling ('milling' or 'kienzle')";
    return false;
  }
  // Each ray stands for half a pitch on both its sides.
  const auto side = [&](double seen) {
    const double at = seen + cut.pitch / 2;
    return at >= R - cut.pitch / 2 ? R : std::max(at, -R);
  };
  const double left = side(cut.in.left), right = side(cut.in.right);
  out.width = left + right;
  if (!(out.width > 0) || !(cut.way > 0)) {
    why = "it goes straight down, which has no model for an end mill";
    return false;
  }
  // Of an end mill the depth that takes as much as was taken; other shapes cut by their height.
  const double height = std::min(cut.in.depth, 20 * cutter.diameter);
  out.t = cutter.shape == Cutter::Shape::flat ? std::min(height, cut.volume / (out.width * cut.way))
                                              : height;
  if (!(out.t > 0)) {
    why = "it goes straight down, which has no model for an end mill";
    return false;
  }
  const Vec3 plan = cut.feed - cut.feed.dot(cut.axis) * cut.axis;
  const Vec3 x = plan.normalized(), to_left = cut.axis.cross(x);
  Mat3 frame;
  frame << x, to_left, cut.axis;
  const MillingCut shape{.a_p = out.t,
                         .f_t = plan.norm() * cut.speed() * 60 / (rpm * cutter.teeth),
                         .phi = {std::acos(left / R), std::acos(-right / R)}};
  const MillingLoad load = milling_load(cutter, *law, shape, frame, tool.peak);
  out.force = load.force;
  out.torque = load.torque;
  out.power = load.mean_torque * rpm * 2 * pi / 60 * 1e-6;
  out.chip = thickest_chip(shape);
  out.engaged = shape.phi;
  if (law->is_kienzle()) {
    out.K_t = law->kienzle.k11 * std::pow(mean_chip(shape), -law->kienzle.m);
    out.K_r = law->radial_ratio;
  } else if (law->constants.K_tc > 0) {
    out.K_t = law->constants.K_tc;
    out.K_r = law->constants.K_rc / law->constants.K_tc;
  }
  out.S = shape.f_t * cutter.teeth;
  out.V = pi * cutter.diameter * rpm / 1000;
  out.diameter = cutter.diameter;
  out.floor = cut.axis;
  // A wall on one side only is what the cut is for; else its floor.
  const bool wall_left = left == R, wall_right = right == R;
  out.normal = wall_left == wall_right ? cut.axis : wall_left ? Vec3(-to_left) : to_left;
  return true;
}

bool drilled(const Drill& drill, const sim::Cut& cut, CutContact& out, std::string& why) {
  if (std::abs(cut.feed.dot(cut.axis)) < 0.999) {
    why = "a drill is fed sideways";
    return false;
  }
  if (!out.material->kienzle) {
    why = "its material has no 'kienzle', which drilling needs";
    return false;
  }
  const double rpm = std::abs(cut.rpm);
  out.S = cut.speed() * 60 / rpm;
  const AxialCut load =
      accuracy::drilling(*out.material->kienzle, drill.diameter, out.S, drill.point_angle,
                         out.material->feed_ratio, drill.chisel_factor);
  out.force.fixed = -load.force * cut.feed;
  // A drill that goes down turns clockwise seen from above, about its feed; the work holds it back.
  out.force.moment = -std::copysign(1.0, cut.rpm) * load.moment * cut.feed;
  out.torque = load.moment;
  out.power = load.moment * rpm * 2 * pi / 60 * 1e-6;
  out.V = pi * drill.diameter * rpm / 1000;
  out.diameter = drill.diameter;
  out.normal = out.floor = -cut.feed;
  return true;
}

}  // namespace

std::optional<CutContact> contact_of(const Setup& setup, std::size_t tool_at, std::size_t work_at,
                                     const sim::Cut& cut, std::string& why) {
  const ToolEntry& tool = setup.tools[tool_at];
  const WorkEntry& work = setup.works[work_at];
  CutContact out;
  out.material = material_of(setup, tool, work, why);
  if (!out.material) return std::nullopt;
  out.contact = {tool.body, work.body, cut.point};
  out.dt = tool.dt;
  bool known = false;
  if (cut.rpm == 0)
    why = "its spindle stands";
  else if (cut.threads)
    why = "it cuts a thread, which has no model";
  else if (cut.turned)
    known = turned(setup, tool, work, cut, out, why);
  else if (tool.drill)
    known = drilled(*tool.drill, cut, out, why);
  else if (tool.cutter)
    known = milled(tool, cut, out, why);
  else
    why = "it turns, and the file has neither 'milling' nor 'drilling' of it";
  if (!known) return std::nullopt;
  return out;
}

}  // namespace aircut::process
