#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>

#include "cli/exit_code.h"
#include "cli/job.h"
#include "cli/view.h"

namespace aircut::cli {

namespace {

constexpr double degrees = 180 / M_PI;

void print_info(const machine::Machine& machine, const tool::ToolTable& tools) {
  std::printf("%s (%s)\n  kinematics %s, program axes ", printable(machine.name()).c_str(),
              printable(machine.folder()).c_str(),
              std::string(machine.kinematics().type()).c_str());
  for (const Axis axis : all_axes)
    if (machine.kinematics().axes().has(axis)) std::printf("%c", letter(axis));
  for (const std::string& channel : machine.channels())
    std::printf("%s%s", &channel == &machine.channels().front() ? "\n  channels " : ", ",
                (printable(channel) + (channel == machine.channel() ? " (driven)" : "")).c_str());
  std::printf("\n  joint        range                      speed      acceleration  home\n");
  for (int j = 0; j < machine.joint_count(); ++j) {
    const machine::Joint& joint = machine.joint(machine::JointId{j});
    const bool rotary = joint.kind == machine::JointKind::rotary;
    const double scale = rotary ? degrees : 1;
    std::printf("  %-12s %9s … %-9s %-4s %7s %s/s %8s %s/s²  %s\n", printable(joint.name).c_str(),
                fixed(joint.min * scale, 3).c_str(), fixed(joint.max * scale, 3).c_str(),
                rotary ? "deg" : "mm", fixed(joint.vmax * scale, 1).c_str(), rotary ? "deg" : "mm",
                fixed(joint.amax * scale, 0).c_str(), rotary ? "deg" : "mm",
                fixed(joint.home * scale, 3).c_str());
  }
  for (const machine::Joint& joint : machine.tree())
    if (joint.held)
      std::printf(
          "  %-12s stays at %s: of another channel\n", printable(joint.name).c_str(),
          fixed(joint.home * (joint.kind == machine::JointKind::rotary ? degrees : 1), 3).c_str());
  std::printf("  bodies\n");
  for (const machine::Body& body : machine.bodies()) {
    const Box3 box = bounds(*body.mesh);
    const Vec3 size = box.sizes();
    std::printf("    %-22s %-8s on %-12s %6zu triangles  %s x %s x %s mm%s\n",
                printable(body.name).c_str(), std::string(machine::to_string(body.role)).c_str(),
                printable(machine.links()[static_cast<std::size_t>(index(body.link))].name).c_str(),
                body.mesh->triangles.size(), fixed(size.x(), 1).c_str(), fixed(size.y(), 1).c_str(),
                fixed(size.z(), 1).c_str(), body.collide ? "" : "  picture only");
  }
  for (const machine::Exclusion& e : machine.exclusions())
    std::printf("  not checked: %s – %s: %s\n", printable(e.a).c_str(), printable(e.b).c_str(),
                printable(e.reason).c_str());
  std::printf("  tools\n");
  for (const tool::Tool& tool : tools.tools)
    std::printf("    T%-4d %-34s D %-8s length %s\n", tool.number, printable(tool.name).c_str(),
                fixed(tool.diameter, 3).c_str(), fixed(tool.offset[Axis::z], 3).c_str());
}

int render_machine(const MachineArguments& a, const Job& job) {
  const auto fail = [&](const Diagnostic& d) {
    print_error(d, a.color);
    return code(ExitCode::unknown);
  };
  std::error_code error;
  if (!a.force && std::filesystem::exists(a.output, error))
    return fail(make_error("output_failed",
                           "'" + printable(a.output) + "' exists; use --force to replace it"));
  sim::Scene scene(job.machine, job.tools);
  if (a.tool != 0) {
    scene.load_tool(a.tool);
    if (!scene.tool())
      return fail(
          make_error("usage", "tool T" + std::to_string(a.tool) + " is not in the tool table"));
  }
  const auto view = view_of(a.view);
  if (!view) return fail(view.error());
  if (a.view.camera == "work" || a.view.camera == "tool")
    return fail(make_error("usage", "--camera " + a.view.camera + " is for the pictures of a run"));
  if (auto known = report::check_view(*job.machine, *view); !known) return fail(known.error());
  render::Scene picture;
  picture.bodies = report::draw_bodies(scene, job.start);
  view->select(picture.bodies);
  picture.caption.left = {printable(job.machine->name())};
  const auto camera = view->fitted_camera(picture.bodies, static_cast<double>(a.width) / a.height);
  if (!camera) return fail(camera.error());
  machine::LinkPoses poses;
  machine::forward(*job.machine, job.start, poses);
  view->cut_open(picture,
                 poses.X_WL[static_cast<std::size_t>(machine::index(job.machine->work_link()))] *
                     job.machine->X_LM(),
                 *camera);
  auto renderer = render::Renderer::create({a.width, a.height});
  if (!renderer) return fail(renderer.error());
  if (auto written = write_file(a.output, render::png_bytes(renderer->draw(picture, *camera)));
      !written)
    return fail(written.error());
  std::printf("written  %s\n", printable(a.output).c_str());
  return code(ExitCode::pass);
}

// What can only be seen with the collision check: bodies that overlap at home.
void check_at_home(const Job& job, Diagnostics& out) {
  sim::CheckOptions options;
  options.near = 0;
  sim::Simulator simulator(job.machine, job.tools, job.start, options);
  simulator.start();
  plan::Segment still;
  if (const auto tip = job.machine->kinematics().forward(job.start, {}))
    still.path = plan::Hold{*tip};
  simulator.step(still);
  for (const sim::Finding& f : simulator.finish().findings) {
    Diagnostic d{f.severity, std::string(sim::to_string(f.kind)), f.message};
    if (f.depth) d.notes.push_back({"depth", fixed(*f.depth, 3) + " mm"});
    if (!f.remedy.empty()) d.notes.push_back({"help", f.remedy});
    out.add(d);
  }
}

}  // namespace

int machine_command(const MachineArguments& a) {
  if (a.action == MachineArguments::Action::create) return new_command(a);
  if (a.action == MachineArguments::Action::convert) return import_command(a);
  Job job;
  ProgramArguments inputs;
  inputs.machine = a.machine;
  inputs.ini_use = ProgramArguments::IniUse::machine;
  inputs.setup = a.setup;
  inputs.tools = a.tools;
  const bool opened = open_inputs(job, inputs);
  if (!opened || a.action != MachineArguments::Action::check)
    print_errors(job.diagnostics, a.color);
  if (!opened) return code(ExitCode::unknown);
  switch (a.action) {
    case MachineArguments::Action::info:
      print_info(*job.machine, job.tools);
      return code(ExitCode::pass);
    case MachineArguments::Action::render:
      return render_machine(a, job);
    case MachineArguments::Action::check:
    case MachineArguments::Action::create:
    case MachineArguments::Action::convert:
      break;
  }
  machine::check_model(*job.machine, job.diagnostics);
  check_at_home(job, job.diagnostics);
  for (const Diagnostic& d : job.diagnostics.list())
    std::fputs(format_human(d, {use_color(a.color, STDOUT_FILENO)}).c_str(), stdout);
  std::printf("%s: %zu problem%s, %zu of them errors\n", printable(job.machine->name()).c_str(),
              job.diagnostics.list().size(), job.diagnostics.list().size() == 1 ? "" : "s",
              job.diagnostics.errors());
  return code(job.diagnostics.errors() > 0 ? ExitCode::fail : ExitCode::pass);
}

}  // namespace aircut::cli
