// `aircut machine new`: writes a package made from a structural formula.
#include <cstdio>
#include <filesystem>

#include "cli/exit_code.h"
#include "cli/job.h"
#include "machine/formula/new_package.h"

namespace aircut::cli {

namespace {

namespace fs = std::filesystem;

Expected<void> write_package(const fs::path& folder,
                             const std::vector<machine::PackageFile>& files) {
  for (const machine::PackageFile& file : files) {
    const fs::path path = folder / file.path;
    std::error_code error;
    fs::create_directories(path.parent_path(), error);
    if (error)
      return unexpected(make_error("output_failed", "can't make the folder '" +
                                                        printable(path.parent_path().string()) +
                                                        "': " + error.message()));
    if (auto written = write_file(path.string(), file.bytes); !written) return written;
  }
  return {};
}

}  // namespace

int new_command(const MachineArguments& a) {
  SourceMap sources;
  const auto fail = [&](const Diagnostic& d) {
    print_error(d, a.color);
    return code(ExitCode::unknown);
  };
  const SourceText& text = sources.add("--formula", a.formula);
  const auto formula = machine::parse_formula(a.formula);
  if (!formula) {
    const SourceSpan span{&text, formula.error().column - 1, 1, 1};
    return fail(make_error("formula", span, formula.error().message));
  }
  const fs::path folder = a.machine;
  std::error_code error;
  if (fs::exists(folder, error) && !a.force)
    return fail(make_error("output_failed",
                           "'" + printable(a.machine) + "' exists; use --force to write into it"));
  std::string name = folder.filename().string();
  if (name.empty() || name != printable(name) || name.find_first_of("\"\\") != name.npos)
    return fail(
        make_error("usage", "NAME is the package's folder; its last part names the machine"));
  const auto files = machine::package_of(*formula, name);
  if (!files) return fail(make_error("formula", files.error()));
  if (const auto written = write_package(folder, *files); !written) return fail(written.error());
  std::printf("written  %s (%zu files) from %s\n", printable(a.machine).c_str(), files->size(),
              machine::text_of(*formula).c_str());
  return code(ExitCode::pass);
}

}  // namespace aircut::cli
