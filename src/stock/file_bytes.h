// Private to stock: the numbers of a saved stock's file, little-endian, between its first line and
// the SHA-256 of all that precedes it, as 64 digits.
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "base/base.h"

namespace aircut::stock {

/// First lines of the files: of a Stock, of a TurnedStock.
inline constexpr std::string_view milled_heading = "aircut stock 1\n";
inline constexpr std::string_view turned_heading = "aircut turned stock 1\n";

/// What lies between that line and the check sum. Error `stock_file`.
Expected<std::string_view> file_content(std::string_view bytes, std::string_view heading,
                                        const std::string& name);
/// The error `stock_file` of the file that messages call `name`.
Diagnostic file_error(const std::string& name, const std::string& why);

class FileWriter {
 public:
  explicit FileWriter(std::string_view heading) : out_(heading) {}
  template <class Int>
  void number(Int value) {
    for (std::size_t i = 0; i < sizeof(Int); ++i)
      out_ += static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i) & 255);
  }
  void real(double value) { number(std::bit_cast<std::uint64_t>(value)); }

  std::string finish() {
    out_ += sha256(out_);
    return std::move(out_);
  }

 private:
  std::string out_;
};

/// Reads numbers until something is wrong; then all that follows is 0.
class FileReader {
 public:
  explicit FileReader(std::string_view bytes) : bytes_(bytes) {}

  template <class Int>
  Int number() {
    if (bytes_.size() - at_ < sizeof(Int)) {
      wrong("it ends too early");
      return 0;
    }
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < sizeof(Int); ++i)
      value |= std::uint64_t{static_cast<unsigned char>(bytes_[at_ + i])} << (8 * i);
    at_ += sizeof(Int);
    return static_cast<Int>(value);
  }
  double real() { return std::bit_cast<double>(number<std::uint64_t>()); }

  void wrong(const std::string& what) {
    if (good()) {
      what_ = what;
      where_ = at_;
    }
    at_ = bytes_.size();
  }
  bool good() const { return what_.empty(); }
  bool at_end() const { return at_ == bytes_.size(); }
  std::string message() const { return what_ + " (at byte " + std::to_string(where_) + ")"; }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0, where_ = 0;
  std::string what_;
};

}  // namespace aircut::stock
