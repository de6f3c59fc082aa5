// G16 and G15 of Fanuc-like machining centres: the words of the plane's first axis are a radius,
// those of its second axis an angle, counter-clockwise from the first axis.
//
// With G90 the radius counts from the program's zero point (that of G52 too), with G91 from where
// the tool stands; the angle is the given one, or is added to that of the last polar words. A word
// that is missing stays as the last one: holes on a circle name the angle alone. What a missing
// word means before any polar word, or after a radius that counted from the tool, the manuals do
// not say alike: the first is a warning, the second an error.
#include <cmath>

#include "interp/codes/codes.h"

namespace aircut::interp {
namespace {

constexpr double tiny = 1e-9;  // mm

bool fail(BlockRun& run, Axis axis, const char* message) {
  run.error("polar_error", letter(axis), message);
  return false;
}

void doubt(BlockRun& run, const char* what) {
  run.warning("control_setting", run.whole(),
              std::string("the first polar words behind G16 name no ") + what +
                  ": that of the tool's place is taken, which not every control does; name it");
}

// The radius and its centre.
bool polar_radius(BlockRun& run, const PlaneAxes& axes, const AxisValues& from, PlanePoint& centre,
                  double& radius) {
  PolarState& polar = run.state.polar;
  const double u = from[axes.first], v = from[axes.second];
  if (const auto word = run.axis(axes.first)) {
    if (*word < 0) return fail(run, axes.first, "the radius of a polar point can't be negative");
    radius = *word;
    if (run.state.incremental) centre = {u, v};
    polar.radius = run.state.incremental ? std::nullopt : std::optional(radius);
    return true;
  }
  if (!polar.radius && run.state.incremental)
    return fail(run, axes.second, "with G91 the radius must be given, or one with G90 before");
  if (!polar.radius && polar.angle)
    return fail(run, axes.second,
                "the last radius counted from the tool (G91), so it must be given again");
  if (!polar.radius) doubt(run, "radius");
  radius = polar.radius.value_or(std::hypot(u, v));
  polar.radius = radius;
  return true;
}

bool polar_angle(BlockRun& run, const PlaneAxes& axes, const AxisValues& from, double& angle) {
  PolarState& polar = run.state.polar;
  if (const Word* word = run.block.find(letter(axes.second))) {
    angle = thousandths(run, *word) * radian_per_degree;
    if (!run.state.incremental) return true;
    if (!polar.angle)
      return fail(run, axes.second,
                  "with G91 the angle is added to the last one, and none was given since G16");
    angle += *polar.angle;
    return true;
  }
  if (polar.angle) {
    angle = *polar.angle;
    return true;
  }
  const double u = from[axes.first], v = from[axes.second];
  if (run.state.incremental || std::hypot(u, v) < tiny)
    return fail(run, axes.first, "the angle must be given: none is in force since G16");
  doubt(run, "angle");
  angle = std::atan2(v, u);
  return true;
}

}  // namespace

void polar_mode(const CodeRule& rule, BlockRun& run) {
  run.state.polar = PolarState{};
  run.state.polar.on = rule.code == 160;
}

bool place_polar(BlockRun& run, const AxisValues& from, AxisValues& program) {
  const PlaneAxes axes = axes_of(run.state.plane);
  if (!run.has(letter(axes.first)) && !run.has(letter(axes.second))) return true;
  if (!run.has('R') && (run.has('I') || run.has('J') || run.has('K')) && run.motion_rule &&
      run.motion_rule->code >= 20 && run.motion_rule->code <= 30) {
    run.error("polar_error", run.whole(), "arcs between G16 and G15 take R, not I J K");
    return false;
  }
  PlanePoint centre;
  double radius = 0, angle = 0;
  if (!polar_radius(run, axes, from, centre, radius) || !polar_angle(run, axes, from, angle))
    return false;
  run.state.polar.angle = angle;
  program[axes.first] = centre.u + radius * std::cos(angle);
  program[axes.second] = centre.v + radius * std::sin(angle);
  return true;
}

bool polar_is_off(BlockRun& run, const CodeRule& rule) {
  const PlaneAxes axes = axes_of(run.state.plane);
  if (!run.state.polar.on || (!run.has(letter(axes.first)) && !run.has(letter(axes.second))))
    return true;
  run.error("polar_error", rule,
            name_of(rule) +
                " of the plane's axes between G16 and G15: whether its words are polar "
                "is not known; give G15 before");
  return false;
}

}  // namespace aircut::interp
