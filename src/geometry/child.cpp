// A forked copy of the process does the work and sends its result through a pipe. Limits of CPU
// time and address space apply to the copy only; a crash ends the copy and is told by its exit
// status. The copy ends with _exit, so that nothing of the parent's (buffers, files, handlers) is
// run twice.
#include "geometry/child.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

namespace aircut::geometry {
namespace {

/// Address space in use, bytes.
std::size_t memory_in_use() {
  std::FILE* file = std::fopen("/proc/self/statm", "re");
  if (file == nullptr) return 0;
  std::array<char, 64> line{};
  const bool read = std::fgets(line.data(), line.size(), file) != nullptr;
  std::fclose(file);
  const std::string_view text(line.data());
  const auto pages = read ? parse_number(text.substr(0, text.find(' '))) : std::nullopt;
  return pages
             ? static_cast<std::size_t>(*pages) * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE))
             : 0;
}

void limit(int resource, rlim_t most) {
  struct rlimit now {};
  if (::getrlimit(static_cast<__rlimit_resource>(resource), &now) != 0) return;
  now.rlim_cur = std::min(now.rlim_max, most);
  ::setrlimit(static_cast<__rlimit_resource>(resource), &now);
}

bool write_all(int fd, const std::string& bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t put = ::write(fd, bytes.data() + done, bytes.size() - done);
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0) return false;
    done += static_cast<std::size_t>(put);
  }
  return true;
}

std::string read_all(int fd) {
  std::string out;
  std::array<char, 65536> buffer{};
  while (true) {
    const ssize_t got = ::read(fd, buffer.data(), buffer.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return out;
    out.append(buffer.data(), static_cast<std::size_t>(got));
  }
}

[[noreturn]] void be_the_child(int out, const std::function<std::string()>& work,
                               const ChildLimits& limits) {
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, limits.cpu_seconds);
  if (const std::size_t now = memory_in_use(); now > 0) limit(RLIMIT_AS, now + limits.extra_memory);
  for (const int signal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGXCPU, SIGINT, SIGTERM})
    std::signal(signal, SIG_DFL);
  if (const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC); nowhere >= 0)
    ::dup2(nowhere, STDERR_FILENO);
  ::_exit(write_all(out, work()) ? 0 : 1);
}

}  // namespace

tl::expected<std::string, std::string> run_in_child(const std::function<std::string()>& work,
                                                    const ChildLimits& limits) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    return unexpected(fmt::format("no pipe to a child process: {}", std::strerror(errno)));
  const pid_t child = ::fork();
  if (child < 0) {
    const int why = errno;
    ::close(ends[0]);
    ::close(ends[1]);
    return unexpected(fmt::format("no child process: {}", std::strerror(why)));
  }
  if (child == 0) {
    ::close(ends[0]);
    be_the_child(ends[1], work, limits);
  }
  ::close(ends[1]);
  std::string bytes = read_all(ends[0]);
  ::close(ends[0]);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return bytes;
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
    return unexpected(fmt::format("it took more than {} s of CPU time", limits.cpu_seconds));
  if (WIFSIGNALED(status))
    return unexpected(fmt::format("it crashed (signal {})", WTERMSIG(status)));
  return unexpected(std::string("it ended without a result"));
}

}  // namespace aircut::geometry
