#include "report/paths.h"

#include <filesystem>
#include <string_view>

namespace aircut::report {

namespace fs = std::filesystem;

std::string uri_of(const std::string& path, const std::string& folder) {
  fs::path relative = fs::path(path).lexically_normal();
  if (relative.is_absolute() && !folder.empty()) {
    const fs::path inside = relative.lexically_relative(fs::path(folder).lexically_normal());
    if (!inside.empty() && *inside.begin() != "..") relative = inside;
  }
  constexpr const char* digits = "0123456789ABCDEF";
  std::string out = relative.is_absolute() ? "file://" : "";
  for (const char c : relative.generic_string()) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                              (c >= '0' && c <= '9') ||
                              std::string_view("-._~/").find(c) != std::string_view::npos;
    if (plain_letter)
      out += c;
    else
      out += {'%', digits[byte >> 4], digits[byte & 15]};
  }
  return out;
}

}  // namespace aircut::report
