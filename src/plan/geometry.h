// Private: making and cutting path pieces, and the feed metric. Units mm, rad.
#pragma once

#include "plan/plan.h"

namespace aircut::plan {

/// Which axes a block's F counts for (RS274): the first group that moves.
enum class Metric : unsigned char { none, xyz, uvw, abc };

/// Ways shorter than this count as zero (mm, rad): very short XYZ with a large rotary way must not
/// make a huge feed.
inline constexpr double zero_length = 1e-7;

Metric metric_of(const AxisValues& way);
/// Euclidean length of the metric's axes.
double metric_length(Metric metric, const AxisValues& way);

/// A straight piece; length 0 when nothing moves.
Line make_line(const AxisValues& start, const AxisValues& end);
/// An arc as the command says. Error (kind `arc_error`): the radius at the start or end is zero, or
/// the normal is not a unit vector.
Expected<Arc> make_arc(const AxisValues& start, const canon::ArcFeed& command);

/// Point of the arc's axis at the height of its start.
Vec3 foot_of(const Arc& arc);
/// A whole blend from its control points, with its parameter fitted to the length of the way.
Blend make_curve(const std::array<AxisValues, 6>& control);
/// The same curve after a change of size: `control` must be that of `like` moved and scaled.
Blend scaled_curve(const Blend& like, const std::array<AxisValues, 6>& control, double scale);
/// True where no such parameter was found: a way that nearly stops inside (a cusp).
bool runs_along_u(const Blend& curve);
/// A rapid that is straight in the joints.
PathPoint evaluate_joint_way(const JointWay& way, double s);
/// The part of a path between two values of s; its own s starts at 0 again.
Path sub_path(const Path& path, double s0, double s1);
/// Metric of a path (none for a hold).
Metric metric_of(const Path& path);

}  // namespace aircut::plan
