// ffmpeg runs without a shell and without input but the pictures, which it reads one after the
// other from a file; it writes under a temporary name that becomes the right one when it has
// succeeded.
#include "report/video.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <vector>

namespace aircut::report {
namespace {

namespace fs = std::filesystem;

constexpr rlim_t most_seconds = 3600;  // of processor time

Diagnostic failed(const std::string& message) { return make_error("output_failed", message); }

// Files that are gone when the work is done, whatever its end.
struct Temporary {
  explicit Temporary(std::string p) : path(std::move(p)) {}
  ~Temporary() { std::remove(path.c_str()); }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;
  std::string path;
};

// In the child: never returns.
[[noreturn]] void become(const std::string& program, std::vector<std::string> arguments,
                         const std::string& input, const std::string& errors) {
  const int in = ::open(input.c_str(), O_RDONLY | O_CLOEXEC);
  const int err = ::open(errors.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  const int out = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (in < 0 || err < 0 || out < 0 || ::dup2(in, 0) < 0 || ::dup2(out, 1) < 0 || ::dup2(err, 2) < 0)
    ::_exit(126);
  const rlimit limit{most_seconds, most_seconds};
  ::setrlimit(RLIMIT_CPU, &limit);
  std::vector<char*> argv;
  for (std::string& a : arguments) argv.push_back(a.data());
  argv.push_back(nullptr);
  ::execv(program.c_str(), argv.data());
  ::_exit(127);
}

std::string last_line(const std::string& path) {
  std::ifstream in(path);
  std::string line, last;
  while (std::getline(in, line))
    if (!line.empty()) last = line;
  return last;
}

}  // namespace

Expected<std::string> find_ffmpeg() {
  const char* path = std::getenv("PATH");
  std::string rest = path ? path : "";
  while (!rest.empty()) {
    const std::size_t colon = rest.find(':');
    const std::string folder = rest.substr(0, colon);
    rest = colon == std::string::npos ? "" : rest.substr(colon + 1);
    // Never a program of the folder that one happens to be in.
    if (folder.empty() || folder[0] != '/') continue;
    const std::string file = folder + "/ffmpeg";
    std::error_code error;
    if (fs::is_regular_file(file, error) && ::access(file.c_str(), X_OK) == 0) return file;
  }
  return unexpected(
      failed("--motion mp4 needs the program ffmpeg, which is in no folder of PATH; install it "
             "(Debian: apt install ffmpeg), or use --motion png or glb"));
}

Expected<void> write_video(const std::string& ffmpeg, const std::string& path,
                           std::span<const std::string> pictures, double seconds_each) {
  const Temporary input(path + ".pictures"), output(path + ".part"), errors(path + ".log");
  std::string all;
  for (const std::string& picture : pictures) all += picture;
  if (auto ok = write_file(input.path, all); !ok) return ok;
  // Sizes of H.264 are even.
  const std::vector<std::string> arguments = {"ffmpeg",
                                              "-v",
                                              "error",
                                              "-y",
                                              "-f",
                                              "image2pipe",
                                              "-framerate",
                                              fixed(1 / seconds_each, 6),
                                              "-c:v",
                                              "png",
                                              "-i",
                                              "pipe:0",
                                              "-vf",
                                              "pad=ceil(iw/2)*2:ceil(ih/2)*2",
                                              "-pix_fmt",
                                              "yuv420p",
                                              "-map_metadata",
                                              "-1",
                                              "-fflags",
                                              "+bitexact",
                                              "-movflags",
                                              "+faststart",
                                              "-f",
                                              "mp4",
                                              output.path};
  std::fflush(nullptr);
  const pid_t child = ::fork();
  if (child < 0) return unexpected(failed("can't start ffmpeg: no process can be made"));
  if (child == 0) become(ffmpeg, arguments, input.path, errors.path);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return unexpected(failed("ffmpeg was lost while it ran"));
  std::error_code error;
  const bool written =
      fs::is_regular_file(output.path, error) && fs::file_size(output.path, error) > 0;
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || !written) {
    const std::string said = printable(last_line(errors.path));
    return unexpected(failed("ffmpeg made no motion.mp4" + (said.empty() ? "" : ": " + said)));
  }
  fs::rename(output.path, path, error);
  if (error) return unexpected(failed("can't write '" + printable(path) + "': " + error.message()));
  return {};
}

}  // namespace aircut::report
