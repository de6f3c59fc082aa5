// Every file in tests/machine/bad/ says behind its lines which errors it must give, as
// `# error COLUMN: text`, or `# error COLUMN: kind: text` for another kind than machine_invalid.
// The errors of a file are exactly these.
#include <gtest/gtest.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "machine/machine.h"

namespace aircut::machine {
namespace {

namespace fs = std::filesystem;

struct Said {
  std::uint64_t line = 0;
  std::size_t column = 0;
  std::string kind;
  std::string message;  // of an expectation: a part of it
};

std::string text_of(const Said& said) {
  return std::to_string(said.line) + ":" + std::to_string(said.column) + " [" + said.kind + "] " +
         said.message;
}

std::vector<Said> expectations(const std::string& file) {
  std::vector<Said> out;
  std::ifstream in(file);
  std::uint64_t number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    const std::string mark = "# error ";
    for (std::size_t at = line.find(mark); at != std::string::npos;) {
      const std::size_t next = line.find(mark, at + 1);
      std::string one = line.substr(at + mark.size(), next - at - mark.size());
      Said said{number, 0, "machine_invalid", {}};
      const char* end = one.data() + one.size();
      const char* colon = std::from_chars(one.data(), end, said.column).ptr;
      EXPECT_TRUE(colon != end && *colon == ':') << file << ": " << line;
      said.message = std::string(colon + 2, end);
      if (said.message.starts_with("mesh_invalid: ")) {
        said.kind = "mesh_invalid";
        said.message.erase(0, std::string("mesh_invalid: ").size());
      }
      while (said.message.ends_with(' ')) said.message.pop_back();
      out.push_back(said);
      at = next;
    }
  }
  return out;
}

std::vector<std::string> files() {
  std::vector<std::string> out;
  for (const auto& entry :
       fs::directory_iterator(std::string(AIRCUT_SOURCE_DIR) + "/tests/machine/bad"))
    if (entry.path().extension() == ".toml") out.push_back(entry.path().string());
  std::sort(out.begin(), out.end());
  return out;
}

TEST(BadMachine, EveryFileGivesItsErrorsAtTheirPlaces) {
  ASSERT_GE(files().size(), 30u);
  for (const std::string& file : files()) {
    SCOPED_TRACE(fs::path(file).filename().string());
    std::vector<Said> wanted = expectations(file);
    EXPECT_FALSE(wanted.empty()) << "says no error";
    SourceMap sources;
    Diagnostics out;
    const auto machine = read_machine(file, sources, out);
    EXPECT_FALSE(machine);
    for (const Diagnostic& d : out.list()) {
      if (d.severity != Severity::error) continue;
      const Said said{d.span.line, d.span.column(), d.kind, d.message};
      const auto match = std::find_if(wanted.begin(), wanted.end(), [&](const Said& w) {
        return w.line == said.line && w.column == said.column && w.kind == said.kind &&
               said.message.find(w.message) != std::string::npos;
      });
      if (match == wanted.end())
        ADD_FAILURE() << "not expected: " << text_of(said);
      else
        wanted.erase(match);
      EXPECT_EQ(format_human(d, {}).find('\x1b'), std::string::npos);
    }
    for (const Said& said : wanted) ADD_FAILURE() << "missing: " << text_of(said);
  }
}

TEST(BadMachine, ErrorsOfAFixtureArePlacedInItsFile) {
  SourceMap sources;
  Diagnostics out;
  const std::string folder = std::string(AIRCUT_SOURCE_DIR) + "/tests/machine/bad-fixture";
  EXPECT_FALSE(read_machine(folder, sources, out));
  std::vector<std::string> said;
  for (const Diagnostic& d : out.list())
    said.push_back(d.span.place().substr(folder.size() + 1) + " " + d.message);
  EXPECT_EQ(said, (std::vector<std::string>{
                      "fixtures/vise.toml:1:8 'name' is 'vice', but the file is named 'vise.toml'",
                      "fixtures/vise.toml:2:8 there is no link 'tabl'. Did you mean 'table'?",
                      "fixtures/vise.toml:3:1 unknown key 'plce'. Did you mean 'place'?",
                      "fixtures/vise.toml:9:8 can't use the file 'meshes/none.stl': there is no "
                      "such file.",
                  }));
}

TEST(BadMachine, AFileThatCannotBeReadIsAnError) {
  SourceMap sources;
  Diagnostics out;
  const auto machine = read_machine("/nowhere/at/all", sources, out);
  ASSERT_FALSE(machine);
  EXPECT_EQ(machine.error().kind, "input");
  EXPECT_EQ(out.errors(), 1u);
}

}  // namespace
}  // namespace aircut::machine
