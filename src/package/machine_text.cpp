#include "package/machine_text.h"

#include <cmath>
#include <numbers>

#include "base/base.h"

namespace aircut::package {

using Eigen::Vector3d;

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : utf8(text)) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) >= ' ' && c != 127) out += c;
  }
  return out + "\"";
}

std::string list_of(const Vector3d& v) {
  return "[" + shortest(v.x()) + ", " + shortest(v.y()) + ", " + shortest(v.z()) + "]";
}

std::string list_of(const std::vector<Vector3d>& points) {
  std::string out;
  for (const Vector3d& p : points) out += (out.empty() ? "[" : ", ") + list_of(p);
  return out + "]";
}

Vector3d fixed_angles(const Eigen::Matrix3d& R) {
  constexpr double degrees = 180 / std::numbers::pi;
  const double across = std::hypot(R(0, 0), R(1, 0));
  const double b = std::atan2(-R(2, 0), across);
  constexpr double locked = 1e-9;
  if (across < locked) return Vector3d(std::atan2(-R(1, 2), R(1, 1)), b, 0) * degrees;
  return Vector3d(std::atan2(R(2, 1), R(2, 2)), b, std::atan2(R(1, 0), R(0, 0))) * degrees;
}

void MachineText::couple_head(const std::string& name, bool rotary, const std::string& parent,
                              const Vector3d& direction, const Vector3d& origin, double sense) {
  couples_ += "\n[[axis]]\nname = " + quoted(name) + "\nkind = \"" +
              (rotary ? "rotary" : "linear") + "\"\nparent = " + quoted(parent) +
              "\nchild = " + quoted(name) + "\ndirection = " + list_of(direction) + "\n";
  if (rotary) couples_ += "origin = " + list_of(origin) + "\n";
  couples_ += "sense = " + shortest(sense) + "\n";
}

void MachineText::add(const Couple& couple) {
  couple_head(couple.name, couple.rotary, couple.parent, couple.direction, couple.origin,
              couple.sense);
  const CoupleLimits& l = couple.limits;
  if (l.min) couples_ += "min = " + shortest(*l.min) + "\n";
  if (l.max) couples_ += "max = " + shortest(*l.max) + "\n";
  couples_ += "vmax = " + shortest(l.vmax) + "\namax = " + shortest(l.amax) +
              "\nhome = " + shortest(l.home) + "\n";
}

void MachineText::body(const BodyText& body) {
  couples_ += "\n[[body]]\nname = " + quoted(body.name) + "\nlink = " + quoted(body.link) +
              "\nmesh = " + quoted(body.mesh) + "\nunit = \"mm\"\n";
}

void MachineText::passive(const std::string& value, const std::string& parent,
                          const Vector3d& direction) {
  couple_head(value, value.ends_with("_angle"), parent, direction, Vector3d::Zero(), 1);
  couples_ += "passive = " + quoted(value) + "\n";
}

std::string MachineText::platform(const std::string& angles) {
  std::string parent = "bed";
  for (const char c : std::string("xyz") + angles) {
    const bool turn = c < 'x';
    const std::string value = std::string("platform_") + c + (turn ? "_angle" : "");
    passive(value, parent, Vector3d::Unit(c - (turn ? 'a' : 'x')));
    parent = value;
  }
  return parent;
}

std::string MachineText::text() const {
  std::string out =
      "schema = 1\nname = " + quoted(name_) + "\nunits = \"mm\"\ndialect = \"linuxcnc\"\n";
  const bool channels = drives_.size() > 1;
  for (const DriveText& d : drives_) {
    const std::string in = channels ? "channel." : "";
    if (channels) {
      out += "\n[[channel]]\nname = " + quoted(d.name) + "\naxes = [";
      for (const std::string& axis : d.axes)
        out += (&axis == &d.axes.front() ? "" : ", ") + quoted(axis);
      out += "]\n";
    }
    out += "\n[" + in + "kinematics]\n" + d.kinematics;
    out += "\n[" + in + "work]\nlink = " + quoted(d.work) + "\n";
    if (!d.work_angles.isZero()) out += "angles = " + list_of(d.work_angles) + "\n";
    out += "\n[" + in + "spindle]\nlink = " + quoted(d.spindle) + "\ngauge = " + list_of(d.gauge) +
           "\n";
    if (!d.spindle_angles.isZero()) out += "angles = " + list_of(d.spindle_angles) + "\n";
    if (rpm_) out += "rpm = [" + shortest(rpm_->first) + ", " + shortest(rpm_->second) + "]\n";
  }
  return out + couples_;
}

}  // namespace aircut::package
