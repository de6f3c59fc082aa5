// Compares the #include lines of src/ with what CMakeLists.txt allows each library to depend on.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

const fs::path root = AIRCUT_SOURCE_DIR;

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  std::stringstream out;
  out << in.rdbuf();
  return out.str();
}

// Library → everything that it may include, transitively, itself included.
std::map<std::string, Names> allowed_includes() {
  const std::string cmake = text_of(root / "CMakeLists.txt");
  std::map<std::string, Names> out;
  const std::regex call(R"(aircut_(?:library|program)\((\w+)([^)]*)\))");
  for (std::sregex_iterator it(cmake.begin(), cmake.end(), call), end; it != end; ++it) {
    const std::string arguments = (*it)[2];
    std::string name = (*it)[1];
    std::smatch folder;
    if (std::regex_search(arguments, folder, std::regex(R"(FOLDER (\w+))"))) name = folder[1];
    Names& names = out[name];
    names.insert(name);
    std::smatch depends;
    if (!std::regex_search(arguments, depends, std::regex(R"(DEPENDS ([a-z ]+))"))) continue;
    std::stringstream words(depends[1]);
    for (std::string word; words >> word;) names.insert(out[word].begin(), out[word].end());
  }
  return out;
}

TEST(Architecture, EveryIncludeIsAllowedByTheDependenciesOfItsLibrary) {
  const auto allowed = allowed_includes();
  ASSERT_GE(allowed.size(), 15u);
  const std::regex include(R"(#include "(\w+)/)");
  int seen = 0;
  for (const auto& entry : fs::recursive_directory_iterator(root / "src")) {
    if (entry.path().extension() != ".cpp" && entry.path().extension() != ".h") continue;
    const std::string folder = fs::relative(entry.path(), root / "src").begin()->string();
    ASSERT_TRUE(allowed.contains(folder)) << folder << " is not a library of CMakeLists.txt";
    const std::string text = text_of(entry.path());
    for (std::sregex_iterator it(text.begin(), text.end(), include), end; it != end; ++it, ++seen)
      EXPECT_TRUE(allowed.at(folder).contains((*it)[1]))
          << entry.path() << " includes " << (*it)[1];
  }
  EXPECT_GT(seen, 50);
}

TEST(Architecture, ThirdPartyLibrariesStayInTheirWrapper) {
  const std::map<std::string, std::string> wrapper = {
      {"assimp/", "geometry"},      {"fcl/", "collide"}, {"GL/", "render"},
      {"ft2build", "render"},       {"png.h", "render"}, {"toml++/", "config"},
      {"nlohmann/", "report tool"}, {"CLI/", "cli"},     {"nettle/", "base"},
      {"pugixml", "report urdf"},   {"zlib.h", "base"}};
  for (const auto& entry : fs::recursive_directory_iterator(root / "src")) {
    if (!entry.is_regular_file()) continue;
    const std::string folder = fs::relative(entry.path(), root / "src").begin()->string();
    const std::string text = text_of(entry.path());
    for (const auto& [header, home] : wrapper)
      if (text.find("#include <" + header) != std::string::npos) {
        EXPECT_NE((" " + home + " ").find(" " + folder + " "), std::string::npos)
            << entry.path() << " includes <" << header;
        EXPECT_NE(entry.path().filename(), folder + ".h")
            << "public headers show no third-party types";
      }
  }
}

}  // namespace
