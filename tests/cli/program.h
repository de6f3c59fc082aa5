// Runs the built program as a user would, in a folder of its own for files.
#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/wait.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace aircut {

inline std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream out;
  out << in.rdbuf();
  return out.str();
}

struct Outcome {
  int code = -1;
  std::string out, err;
  bool says(const std::string& text) const { return (out + err).find(text) != std::string::npos; }
};

class Program : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "aircut-cli-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  void TearDown() override {
    using std::filesystem::perms;
    std::filesystem::permissions(folder_, perms::owner_all, std::filesystem::perm_options::add);
    std::filesystem::remove_all(folder_);
  }

  Outcome aircut(const std::string& arguments, const std::string& input = "") {
    put("stdin", input);
    const std::string command = "cd " AIRCUT_SOURCE_DIR " && " + environment_ +
                                " timeout 120 " AIRCUT_BINARY_DIR "/bin/aircut " + arguments +
                                " <" + path("stdin") + " >" + path("stdout") + " 2>" +
                                path("stderr");
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(path("stdout")),
            text_of(path("stderr"))};
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  void put(const std::string& name, const std::string& text) {
    std::ofstream(path(name), std::ios::binary) << text;
  }
  std::filesystem::path folder_;
  std::string environment_;  ///< assignments for the program, as the shell writes them
};

}  // namespace aircut
