// Machines of other formats: `-m ROBOT.urdf`, and `aircut machine import`, which writes a package.
#include <cstdio>
#include <filesystem>

#include "cli/exit_code.h"
#include "cli/job.h"
#include "machine/reading.h"
#include "urdf/urdf.h"

namespace aircut::cli {

namespace {

namespace fs = std::filesystem;

// Of `FILE.urdf` or `FILE.urdf:LINK`. Errors are in `out`.
Expected<urdf::Machine> read_robot(const std::string& what, const std::string& package_root,
                                   SourceMap& sources, Diagnostics& out) {
  const auto [path, link] = machine::split_channel(what);
  const auto text = sources.open(path);
  if (!text) {
    out.add(text.error());
    return unexpected(text.error());
  }
  const auto robot = urdf::read_robot(**text, out);
  if (!robot) return unexpected(robot.error());
  return urdf::machine_of(*robot, path, {.tool_link = link, .package_root = package_root}, out);
}

// The files of a package that is not on disk.
machine::PackageFiles files_of(const urdf::Machine& made) {
  const auto absent = [](const std::string& path) {
    return unexpected(make_error("machine_invalid", "there is no '" + printable(path) + "'"));
  };
  machine::PackageFiles files;
  files.mesh = [meshes = made.meshes, absent](
                   const std::string& path,
                   const MeshFileOptions&) -> Expected<std::shared_ptr<const TriangleMesh>> {
    const auto found = meshes.find(path);
    if (found == meshes.end()) return absent(path);
    return found->second;
  };
  files.text = [absent](const std::string& path) -> Expected<const SourceText*> {
    return absent(path);
  };
  files.full_path = [absent](const std::string& path) -> Expected<std::string> {
    return absent(path);
  };
  return files;
}

}  // namespace

bool import_urdf(Job& job, const std::string& what) {
  const auto made = read_robot(what, "", job.sources, job.diagnostics);
  if (!made) return false;
  const std::string path = machine::split_channel(what).first;
  const SourceText& text = job.sources.add(path + " as machine.toml", made->toml);
  const auto machine = machine::read_machine_text(text, ".", files_of(*made), job.diagnostics);
  if (!machine) return false;
  job.machine = *machine;
  job.start = job.machine->home();
  job.machine_unchecked = made->unchecked;
  std::string all = made->toml;
  for (const auto& [name, mesh] : made->meshes) all += name + sha256(stl_bytes(*mesh));
  job.inputs.push_back({"machine", what, sha256(all)});
  return true;
}

int import_command(const MachineArguments& a) {
  SourceMap sources;
  Diagnostics out;
  const auto fail = [&](const Diagnostic& d) {
    print_error(d, a.color);
    return code(ExitCode::unknown);
  };
  std::error_code error;
  if (fs::exists(a.output, error) && !a.force)
    return fail(make_error("output_failed",
                           "'" + printable(a.output) + "' exists; use --force to write into it"));
  urdf::Machine made;
  bool good = false;
  const std::string file = machine::split_channel(a.machine).first;
  if (file.ends_with(".ini")) {
    if (auto imported = linuxcnc::import_machine(file, sources, out); imported && *imported) {
      good = true;
      made.toml = (*imported)->toml;
      made.unchecked = (*imported)->unchecked;
    } else if (imported) {
      out.error("ini_kinematics", {}, "the set-up has no [KINS]KINEMATICS, so it has no machine");
    } else if (out.errors() == 0) {
      out.add(imported.error());
    }
  } else if (file.ends_with(".urdf")) {
    if (auto robot = read_robot(a.machine, a.package_root, sources, out)) {
      good = true;
      made = std::move(*robot);
    }
  } else {
    return fail(make_error("usage",
                           "FILE is the set-up of a LinuxCNC machine (.ini) or a robot's "
                           "description (.urdf)"));
  }
  // What is written can be read again, or nothing is written.
  if (good) {
    const SourceText& text = sources.add(file + " as machine.toml", made.toml);
    good = machine::read_machine_text(text, ".", files_of(made), out).has_value();
  }
  print_errors(out, a.color);
  if (!good) return code(ExitCode::unknown);
  const fs::path folder = a.output;
  fs::create_directories(made.meshes.empty() ? folder : folder / "meshes", error);
  if (error)
    return fail(make_error("output_failed", "can't make the folder '" + printable(a.output) +
                                                "': " + error.message()));
  if (auto ok = write_file((folder / "machine.toml").string(), made.toml); !ok)
    return fail(ok.error());
  for (const auto& [path, mesh] : made.meshes)
    if (auto ok = write_file((folder / path).string(), stl_bytes(*mesh)); !ok)
      return fail(ok.error());
  std::printf("written  %s (machine.toml, %zu meshes)\n", printable(a.output).c_str(),
              made.meshes.size());
  for (const std::string& what : made.unchecked)
    std::printf("  not in it: %s\n", printable(what).c_str());
  return code(ExitCode::pass);
}

}  // namespace aircut::cli
