// One start of rs274 that serves many programs (fork_server.c says how).
#pragma once

#include <sys/types.h>

#include <string>

namespace aircut::test {

class Server {
 public:
  /// Starts rs274 in `folder`, which holds machine.ini and tool.tbl, with its own $HOME there: it
  /// keeps its tools in a file in the home folder, which all runs would share.
  Server(const std::string& folder, bool block_delete);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Runs `program.ngc` with the parameters of `start.var`; both are read now. Its outputs are the
  /// files `stdout` and `stderr`. Gives the wait status, -1 when the server has died.
  int run();

 private:
  pid_t pid_ = -1;
  int requests_ = -1, answers_ = -1;
};

}  // namespace aircut::test
