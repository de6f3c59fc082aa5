#include "peer/server.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <vector>

extern char** environ;

namespace aircut::test {
namespace {

constexpr int request_fd = 198, answer_fd = 199;  // as in fork_server.c

/// The environment with its own home, the server's code, and no other preloaded library.
std::vector<std::string> environment_for(const std::string& folder) {
  std::vector<std::string> words = {"HOME=" + folder, "LD_PRELOAD=" AIRCUT_FORK_SERVER};
  for (char** entry = environ; *entry; ++entry) {
    const std::string word = *entry;
    if (!word.starts_with("HOME=") && !word.starts_with("LD_PRELOAD=")) words.push_back(word);
  }
  return words;
}

std::vector<char*> pointers(std::vector<std::string>& words) {
  std::vector<char*> out;
  for (std::string& word : words) out.push_back(word.data());
  out.push_back(nullptr);
  return out;
}

}  // namespace

Server::Server(const std::string& folder, bool block_delete) {
  std::array<int, 2> to{}, from{};
  if (::pipe2(to.data(), O_CLOEXEC) != 0) return;
  if (::pipe2(from.data(), O_CLOEXEC) != 0) {
    ::close(to[0]);
    ::close(to[1]);
    return;
  }
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  for (const int fd : {0, 1, 2})
    ::posix_spawn_file_actions_addopen(&actions, fd, "/dev/null", fd == 0 ? O_RDONLY : O_WRONLY, 0);
  ::posix_spawn_file_actions_adddup2(&actions, to[0], request_fd);
  ::posix_spawn_file_actions_adddup2(&actions, from[1], answer_fd);
  std::vector<std::string> words = {"rs274",    "-i", "machine.ini", "-t",
                                    "tool.tbl", "-v", "start.var"};
  if (block_delete) words.push_back("-b");
  words.insert(words.end(), {"-g", "program.ngc"});
  std::vector<std::string> environment = environment_for(folder);
  if (::posix_spawnp(&pid_, "rs274", &actions, nullptr, pointers(words).data(),
                     pointers(environment).data()) != 0)
    pid_ = -1;
  ::posix_spawn_file_actions_destroy(&actions);
  ::close(to[0]);
  ::close(from[1]);
  requests_ = to[1];
  answers_ = from[0];
}

Server::~Server() {
  if (requests_ >= 0) ::close(requests_);
  if (answers_ >= 0) ::close(answers_);
  if (pid_ <= 0) return;
  while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

int Server::run() {
  // A server that has died must not end the test program too.
  static const auto ignored = std::signal(SIGPIPE, SIG_IGN);
  (void)ignored;
  int status = -1;
  const char request = 'r';
  if (pid_ <= 0 || ::write(requests_, &request, 1) != 1) return -1;
  ssize_t got = 0;
  do got = ::read(answers_, &status, sizeof status);
  while (got < 0 && errno == EINTR);
  return got == static_cast<ssize_t>(sizeof status) ? status : -1;
}

}  // namespace aircut::test
