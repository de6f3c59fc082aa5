#include <algorithm>
#include <cstdio>
#include <thread>

#include "accuracy/accuracy.h"
#include "cli/exit_code.h"
#include "cli/job.h"
#include "cli/print_report.h"
#include "semantics/semantics.h"
#include "urdf/urdf.h"

namespace aircut::cli {

namespace {

// Kinds that belong to no stage of the program's way.
const std::vector<KindText>& general_kinds() {
  static const std::vector<KindText> kinds = {
      {"usage", "the command line is not understood",
       "An option is unknown, lacks its value or does not fit the others. Exit code 2."},
      {"input", "an input can't be read",
       "The file is missing, is a folder, or can't be opened; the message has the system's reason. "
       "Exit\n"
       "code 2: the job could not be verified."},
      {"waiver_unused", "a waiver that accepts nothing",
       "Warning. No message matched a --waive, so it hides nothing today but may hide something\n"
       "tomorrow. Remove it. A file in a waiver is the name that messages show, or the end of it\n"
       "after a slash; a line must be the message's."},
      {"output_failed", "an output could not be written",
       "The folder exists already (use --force), can't be written, or the disk is full. Files are "
       "written\n"
       "under a temporary name and renamed, so none is left half-written."},
      {"machine_invalid", "machine.toml is wrong",
       "A key is unknown, a value has the wrong type or range, or the chain of joints does not fit "
       "the\n"
       "kinematics. The message has line and column; docs/machine-package.md lists all keys."},
      {"mesh_defect", "a mesh that is open, inside out or empty",
       "Warning. Only contact with the surface of such a body is found, not what lies inside it.\n"
       "Close the mesh, or describe the body by boxes and cylinders."},
      {"model_suspect", "a machine that is probably described wrongly",
       "A body has the size of another unit, a link has no body, no body is the spindle, or a "
       "speed\n"
       "or time is missing, so that it can't be checked. docs/machine-package.md has the keys."},
      {"formula", "a structural formula can't be read",
       "The message has the column. A formula lists the couples from the workpiece over the bed O "
       "to\n"
       "the tool, like R(MS:C)-O-T(TS:X)-T(VS:Z); docs/formulas.md has the grammar."},
      {"mesh_invalid", "a mesh can't be used",
       "The file is missing, broken, empty or too large, or lies outside the package."},
      {"overrides_invalid", "the file of --overrides is wrong",
       "Every [[event]] needs t (s, in rising order) and at least one of feed, rapid, spindle, "
       "adaptive (percent) and hold (true, false). What is held must be let go by a later event, "
       "or the program would never end. docs/overrides.md has an example."},
      {"job_invalid", "the file of a job is wrong",
       "It needs schema = 1 and an [[operation]] for each run, with name, program and machine;\n"
       "setup, tools, dialect and save_stock may be given. docs/cli.md has an example."},
      {"setup_invalid", "setup.toml is wrong",
       "A key is unknown or a value does not fit; line and column say where."},
      {"stock_memory", "the stock does not fit into memory",
       "A finer pitch of [stock] takes more memory, with its square, and time. What is known "
       "before "
       "a\n"
       "run is told before it, with the finest pitch that fits; a stock whose surface grows beyond "
       "the\n"
       "memory during the run makes the verdict unknown from there on.\n"
       "Remedy: a coarser pitch in [stock], or none: the default suits most parts."},
      {"tools_invalid", "the tool table is wrong",
       "A line of the .tbl or a key of tools.toml does not fit; docs/tools.md lists all keys."},
  };
  return kinds;
}

}  // namespace

std::vector<KindText> all_kinds() {
  std::vector<KindText> out = general_kinds();
  const auto add = [&](const std::vector<KindText>& kinds) {
    for (const KindText& row :
         kinds)  // one kind may come from two libraries; the first explains it
      if (std::none_of(out.begin(), out.end(), [&](const KindText& other) {
            return std::string_view(other.kind) == row.kind;
          }))
        out.push_back(row);
  };
  add(interp::error_kinds());
  add(ini::kinds());
  add(linuxcnc::kinds());
  add(urdf::kinds());
  add(sim::finding_kinds());
  add(semantics::semantic_kinds());
  add(accuracy::kinds());
  std::stable_sort(out.begin(), out.end(), [](const KindText& a, const KindText& b) {
    return std::string_view(a.kind) < std::string_view(b.kind);
  });
  return out;
}

namespace {

/// Names that people know for what a message of another kind tells.
struct OtherName {
  const char *name, *kind, *which;
};
constexpr OtherName other_names[] = {
    {"noncutting_contact", "collision", "of the pair shank-stock or holder-stock"},
    {"workholding_cut", "collision", "of the pair cutter-fixture"},
};

}  // namespace

int explain_command(const ExplainArguments& a) {
  const std::vector<KindText> kinds = all_kinds();
  std::string kind = a.kind;
  for (const OtherName& other : other_names)
    if (kind == other.name) {
      std::printf("%s is told as %s %s.\n", other.name, other.kind, other.which);
      kind = other.kind;
    }
  if (a.list) {
    for (const KindText& row : kinds) std::printf("%-26s %s\n", row.kind, row.title);
    return code(ExitCode::pass);
  }
  std::vector<std::string> names;
  for (const KindText& row : kinds) {
    names.push_back(row.kind);
    if (kind != row.kind) continue;
    std::printf("%s: %s\n\n%s\n", row.kind, row.title, row.text);
    return code(ExitCode::pass);
  }
  print_error(make_error("usage", "there is no kind '" + printable(a.kind) + "'." +
                                      did_you_mean(a.kind, names)),
              When::automatic);
  return code(ExitCode::unknown);
}

int doctor_command() {
  std::printf("aircut %s\n", AIRCUT_VERSION);
  std::printf("threads    %u\n", std::thread::hardware_concurrency());
  // Each is opened at run time and is enough by itself.
  bool pictures = false;
  const auto try_backend = [&](const char* title, render::Backend backend) {
    const auto renderer = render::Renderer::create({64, 64, render::Supersample::once, backend});
    pictures = pictures || renderer;
    std::printf("%s%s\n", title, renderer ? "works" : printable(renderer.error().message).c_str());
  };
  try_backend("pictures   OSMesa: ", render::Backend::osmesa);
  try_backend("           EGL: ", render::Backend::egl);
  std::printf("machines  ");
  for (const std::string& folder : package_folders()) std::printf(" %s", printable(folder).c_str());
  std::printf("\n");
  return code(pictures ? ExitCode::pass : ExitCode::unknown);
}

}  // namespace aircut::cli
