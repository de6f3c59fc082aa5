#include <algorithm>
#include <filesystem>

#include "machine/machine.h"

namespace aircut::machine {

namespace {

namespace fs = std::filesystem;

std::vector<std::string> packages_in(const std::vector<std::string>& folders) {
  std::vector<std::string> names;
  for (const std::string& folder : folders) {
    std::error_code error;
    fs::directory_iterator it(folder, error);
    while (!error && it != fs::directory_iterator()) {
      std::error_code ignored;
      if (fs::is_regular_file(it->path() / "machine.toml", ignored))
        names.push_back(it->path().filename().string());
      it.increment(error);
    }
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

}  // namespace

std::pair<std::string, std::string> split_channel(const std::string& what) {
  const std::size_t colon = what.rfind(':');
  std::error_code error;
  if (colon == std::string::npos || what.find('/', colon) != std::string::npos ||
      fs::exists(what, error))
    return {what, {}};
  return {what.substr(0, colon), what.substr(colon + 1)};
}

Expected<std::string> find_package(const std::string& what,
                                   const std::vector<std::string>& search) {
  const auto fail = [](std::string message) {
    return unexpected(make_error("input", std::move(message)));
  };
  std::error_code error;
  if (what.empty()) return fail("the name of the machine is empty");
  if (fs::is_directory(what, error)) {
    const fs::path file = fs::path(what) / "machine.toml";
    if (fs::is_regular_file(file, error)) return file.string();
    // A folder of that name may be unrelated to a package that is meant by its name.
    if (what.find('/') != std::string::npos)
      return fail("the folder '" + printable(what) + "' has no machine.toml");
  } else if (fs::exists(what, error)) {
    if (fs::path(what).extension() == ".toml") return what;
    return fail("'" + printable(what) + "' is no machine: it must be a package folder, a " +
                "machine.toml, the set-up of a LinuxCNC machine (.ini) or a robot's description " +
                "(.urdf)");
  }
  if (what.find('/') == std::string::npos)
    for (const std::string& folder : search) {
      const fs::path file = fs::path(folder) / what / "machine.toml";
      if (fs::is_regular_file(file, error)) return file.string();
    }
  const std::vector<std::string> names = packages_in(search);
  std::string known;
  for (const std::string& name : names) known += (known.empty() ? "" : ", ") + name;
  return fail("there is no machine '" + printable(what) + "'." + did_you_mean(what, names) +
              (known.empty() ? " It must be a folder with a machine.toml."
                             : " Known machines: " + known + "."));
}

}  // namespace aircut::machine
