// Plans a program, runs it through the joint log and hands back the text; and the programmed path
// as the judge reads it.
#pragma once

#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <sstream>

#include "log/log.h"
#include "support/plan_machines.h"

namespace aircut::test {

/// A path in the temporary folder that no other test uses.
inline std::string temporary_path(const std::string& name) {
  return "/tmp/aircut-" + std::to_string(::getpid()) + "-" + name;
}

inline std::string run_to_log(const std::shared_ptr<const machine::Machine>& machine,
                              const machine::JointVector& start, const Planned& planned,
                              log::JointLogOptions options = {}) {
  const std::string path = temporary_path("joints.csv");
  auto created = log::CsvJointLog::create(path, *machine, options);
  if (!created) return "create: " + created.error().message;
  log::CsvJointLog& log = **created;
  const sim::Scene scene(machine, tool::ToolTable{});
  log.on_start(scene, start);
  machine::JointVector joints = start;
  for (const plan::Segment& segment : planned.segments) {
    const motion::JointMotion motion(*machine, segment, joints);
    log.on_step({scene, motion, segment});
    if (const auto end = motion.at(motion.t1())) joints = *end;
  }
  log.on_finish({});
  if (const auto done = log.result(); !done) return "result: " + done.error().message;
  std::ifstream in(path, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  std::remove(path.c_str());
  return text.str();
}

/// The program's moves for worst_path_deviation(). `extra` is added to each tolerance.
inline std::string ideal_path(const Program& program, AxisValues tip, double tolerance) {
  std::ostringstream out;
  out.precision(17);
  const auto point = [&out](const AxisValues& p) {
    out << ' ' << p[Axis::x] << ' ' << p[Axis::y] << ' ' << p[Axis::z];
  };
  for (const canon::Command& command : program.commands()) {
    if (!canon::is_motion(command.action)) continue;
    const AxisValues end = canon::end_of(command.action, tip);
    out << command.block << ' ' << tolerance;
    if (const auto* arc = std::get_if<canon::ArcFeed>(&command.action)) {
      out << " arc";
      point(tip);
      point(end);
      for (const Vec3& v : {arc->centre, arc->normal})
        out << ' ' << v.x() << ' ' << v.y() << ' ' << v.z();
      out << ' ' << arc->turns << '\n';
    } else {
      out << " line";
      point(tip);
      point(end);
      out << '\n';
    }
    tip = end;
  }
  return out.str();
}

}  // namespace aircut::test
