// Every program in programs/ comes out as its header says:
//
//   ; machine: mill3, as delivered …      the package that it runs on
//   ; setup: FILE                         with this set-up of programs/; may be missing
//   ; …  Verdict pass.                    or: verdict fail: `kind`
//
// Programs of other controls have their header in ( ), with `dialect: NAME`. `machine: none` is a
// lathe's, which is checked without a machine, with the tool table beside it.
// Programs that are meant to fail say so with the kind of the finding in backquotes.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace aircut {
namespace {

namespace fs = std::filesystem;

struct Header {
  std::string machine;  ///< empty: not said
  std::string setup;    ///< empty: none
  std::string dialect;  ///< empty: that of the machine
  bool passes = false;
  std::string kind;  ///< of the finding, when it doesn't pass
};

std::string after(const std::string& text, const std::string& mark, const std::string& end) {
  const auto at = text.find(mark);
  if (at == std::string::npos) return {};
  const auto from = at + mark.size();
  return text.substr(from, text.find_first_of(end, from) - from);
}

Header header_of(const fs::path& program) {
  std::ifstream in(program);
  std::string comments;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || std::string(";(%O").find(line[0]) == std::string::npos) break;
    comments += line + "\n";
  }
  Header header;
  header.machine = after(comments, "machine: ", ",. \n");
  header.setup = after(comments, "setup: ", ", \n");
  header.dialect = after(comments, "dialect: ", "), \n");
  header.passes = comments.find("erdict pass") != std::string::npos &&
                  comments.find("erdict fail") == std::string::npos;
  header.kind = after(comments, "erdict fail: `", "`");
  return header;
}

struct Outcome {
  int code = -1;
  std::string out;
};

Outcome aircut(const std::string& arguments) {
  const std::string command = "cd " AIRCUT_SOURCE_DIR " && timeout 300 " AIRCUT_BINARY_DIR
                              "/bin/aircut " +
                              arguments + " 2>&1 </dev/null";
  Outcome outcome;
  std::FILE* pipe = ::popen(command.c_str(), "r");
  if (!pipe) return outcome;
  std::array<char, 4096> buffer;
  for (std::size_t n; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
    outcome.out.append(buffer.data(), n);
  const int status = ::pclose(pipe);
  if (WIFEXITED(status)) outcome.code = WEXITSTATUS(status);
  return outcome;
}

std::vector<std::string> programs() {
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(AIRCUT_SOURCE_DIR "/programs"))
    if (entry.path().extension() == ".ngc") files.push_back(entry.path().filename().string());
  std::sort(files.begin(), files.end());
  return files;
}

class ShippedProgram : public ::testing::TestWithParam<std::string> {};

TEST_P(ShippedProgram, ComesOutAsItsHeaderSays) {
  const Header header = header_of(fs::path(AIRCUT_SOURCE_DIR) / "programs" / GetParam());
  ASSERT_FALSE(header.machine.empty()) << "the header has no `machine: NAME,`";
  ASSERT_NE(header.passes, !header.kind.empty())
      << "the header needs `Verdict pass` or `Verdict fail: ` with a kind in backquotes";
  std::string arguments = " programs/" + GetParam();
  if (!header.dialect.empty()) arguments += " --dialect " + header.dialect;
  if (header.machine == "none") {
    const std::string table = "programs/" + fs::path(GetParam()).stem().string() + ".tbl";
    const Outcome outcome = aircut("check" + arguments + " --lathe --tools " + table);
    EXPECT_EQ(outcome.code, 0) << outcome.out;
    EXPECT_EQ(outcome.out.find("warning["), std::string::npos) << outcome.out;
    return;
  }
  if (!header.setup.empty()) arguments += " --setup programs/" + header.setup;
  const Outcome outcome = aircut("run" + arguments + " -m " + header.machine);
  EXPECT_EQ(outcome.code, header.passes ? 0 : 1) << outcome.out;
  if (header.passes) {
    EXPECT_NE(outcome.out.find("100 % proven clear"), std::string::npos) << outcome.out;
    EXPECT_EQ(outcome.out.find("warning["), std::string::npos) << outcome.out;
  } else {
    EXPECT_NE(outcome.out.find("error[" + header.kind + "]"), std::string::npos) << outcome.out;
  }
}

std::string name_of(const ::testing::TestParamInfo<std::string>& info) {
  std::string name = fs::path(info.param).stem().string();
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '-'; }, '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Programs, ShippedProgram, ::testing::ValuesIn(programs()), name_of);

TEST(ShippedPrograms, AreThere) { EXPECT_GE(programs().size(), 9u); }

}  // namespace
}  // namespace aircut
