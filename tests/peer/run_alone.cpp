#include "peer/run_alone.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace aircut::test {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

void write(const fs::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

}  // namespace

Said run_linuxcnc(std::vector<std::string> words, const std::string& folder) {
  words.insert(words.begin(), {"timeout", "-k", "1", "10"});
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const std::string out = folder + "/stdout", err = folder + "/stderr";
  const pid_t child = ::fork();
  if (child < 0) return {};
  if (child == 0) {
    constexpr int made_anew = O_WRONLY | O_CREAT | O_TRUNC;
    const int in_fd = ::open("/dev/null", O_RDONLY);
    const int out_fd = ::open(out.c_str(), made_anew, 0600);
    const int err_fd = ::open(err.c_str(), made_anew, 0600);
    if (in_fd < 0 || out_fd < 0 || err_fd < 0 || ::chdir(folder.c_str()) != 0) ::_exit(126);
    // rs274 keeps its tools in a file in the home folder, which all runs would share.
    ::setenv("HOME", folder.c_str(), 1);
    ::dup2(in_fd, 0);
    ::dup2(out_fd, 1);
    ::dup2(err_fd, 2);
    ::execvp(argv[0], argv.data());
    ::_exit(127);
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(out), text_of(err)};
}

Trace run_with_ini(const ProgramFile& program, const std::string& folder) {
  write(fs::path(folder) / "tool.tbl", program.tools);
  write(fs::path(folder) / "program.ngc", program.text);
  std::string var;
  for (const auto& [number, value] : program.parameters.values)
    var += std::to_string(number) + "\t" + fixed(value, 6) + "\n";
  write(fs::path(folder) / "start.var", var);
  const Said said = run_linuxcnc(
      {"rs274", "-i", "machine.ini", "-t", "tool.tbl", "-v", "start.var", "-g", "program.ngc"},
      folder);
  Trace trace;
  trace.calls = parse_trace(said.out);
  trace.error_text = said.err;
  trace.timed_out = said.status == 124 || said.status == 137;
  trace.error = said.status != 0;
  return trace;
}

}  // namespace aircut::test
