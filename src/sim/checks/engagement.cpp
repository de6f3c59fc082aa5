#include "sim/checks/engagement.h"

#include <algorithm>
#include <cmath>

namespace aircut::sim {

namespace {

constexpr double cells_of_rate = 8;  // pitches of way that a removal rate is measured over
constexpr double rounding = 1e-6;    // of a limit

double top_speed(const plan::SpeedProfile& profile) {
  double most = 0;
  for (std::size_t i = 0; i < profile.knots.size(); ++i) {
    const plan::ProfileKnot& k = profile.knots[i];
    most = std::max(most, k.v);
    // With jerk the speed may have its maximum inside of a piece.
    const double t = k.j < 0 ? -k.a / k.j : 0;
    if (t > 0 && i + 1 < profile.knots.size() && t < profile.knots[i + 1].t - k.t)
      most = std::max(most, k.v + t * k.a / 2);
  }
  return most;
}

}  // namespace

void EngagementWatch::read_tool(const tool::Tool* tool, double radius, double pitch) {
  limits_ = tool ? tool->limits : tool::CuttingLimits{};
  teeth_ = tool ? tool->teeth : 0;
  radius_ = radius;
  pitch_ = pitch;
  way_ = time_ = volume_ = 0;
}

void EngagementWatch::look(const Step& step, const StraightMove& move, const stock::Engagement& in,
                           const std::string& name) {
  const plan::Segment& segment = step.segment;
  if (in.any()) {
    compare(step, name, "axial depth", in.depth, limits_.depth, "mm", "take less depth at a time");
    compare(step, name, "radial width", std::max(0.0, in.left + in.right), limits_.width, "mm",
            "use a smaller step-over");
    // The circle of the cutter between the two sides; across its middle half of it is in material.
    const auto angle_to = [&](double side) {
      return std::asin(std::clamp(side / radius_, -1., 1.));
    };
    if (radius_ > 0)
      compare(step, name, "engagement angle",
              std::max(0.0, angle_to(in.left) + angle_to(in.right)) * 180 / M_PI,
              limits_.angle * 180 / M_PI, "deg", "use a smaller step-over");
    if (teeth_ > 0 && segment.spindle_rpm != 0)
      compare(step, name, "chip load",
              top_speed(segment.profile) * 60 / (std::abs(segment.spindle_rpm) * teeth_),
              limits_.chip_load, "mm", "lower F, or raise S");
  }
  way_ += move.s1 - move.s0;
  time_ += time_at(step, move.s1) - time_at(step, move.s0);
  volume_ += in.volume;
  if (way_ < cells_of_rate * pitch_ || !(time_ > 0)) return;
  compare(step, name, "removal rate", volume_ / time_ * 0.06, limits_.removal * 0.06, "cm3/min",
          "take less depth or width, or lower F");
  way_ = time_ = volume_ = 0;
}

void EngagementWatch::compare(const Step& step, const std::string& name, const char* quantity,
                              double value, double limit, const char* unit,
                              const std::string& remedy) {
  if (!(limit > 0) || value <= limit * (1 + rounding)) return;
  if (!rows_.wants(value / limit)) return;
  Finding f = finding_at(Kind::engagement_limit, step, step.segment.t_start);
  f.t_end = step.segment.t_end();
  f.u_first = step.segment.u0;
  f.u_end = step.segment.u1;
  f.body_a = name;
  f.body_b = "stock";
  f.pair = "cutter-stock";
  f.quantity = quantity;
  f.value = value;
  f.limit = limit;
  f.unit = unit;
  f.message = std::string(quantity) + " of " + fixed(value, 3) + " " + unit +
              " is more than the tool's limit of " + shortest(limit) + " " + unit;
  f.remedy = remedy;
  rows_.add(value / limit, std::move(f));
}

}  // namespace aircut::sim
