// Compares a text with a file under a test folder's golden/. AIRCUT_UPDATE_GOLDEN=1 rewrites the
// file instead; the difference is reviewed like code.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace aircut::testing {

/// `path` is relative to tests/.
inline void expect_golden(const std::string& path, const std::string& text) {
  const std::string file = std::string(AIRCUT_SOURCE_DIR) + "/tests/" + path;
  const char* update = std::getenv("AIRCUT_UPDATE_GOLDEN");
  if (update && std::string(update) == "1") {
    std::filesystem::create_directories(std::filesystem::path(file).parent_path());
    std::ofstream(file, std::ios::binary) << text;
    return;
  }
  std::ifstream in(file, std::ios::binary);
  ASSERT_TRUE(in) << file << " is missing; AIRCUT_UPDATE_GOLDEN=1 writes it";
  std::stringstream wanted;
  wanted << in.rdbuf();
  EXPECT_EQ(text, wanted.str()) << path;
}

}  // namespace aircut::testing
