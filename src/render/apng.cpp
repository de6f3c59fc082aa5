// An animated PNG is a PNG whose further pictures are in chunks of their own (PNG specification,
// third edition, sections 4.9 and 11.3.6): `acTL` says how many there are, `fcTL` stands before
// each, and `fdAT` holds what `IDAT` holds for the first. A viewer that does not know them shows
// the first picture.
#include <algorithm>
#include <cmath>

#include "base/deflate.h"
#include "render/render.h"

namespace aircut::render {
namespace {

constexpr std::size_t signature = 8, frame_of_chunk = 12;  // bytes; length, type, checksum

std::string number(std::uint32_t value) {
  std::string out;
  for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(value >> shift & 0xff);
  return out;
}

std::uint32_t number_at(std::string_view bytes) {
  std::uint32_t out = 0;
  for (std::size_t i = 0; i < 4; ++i) out = out << 8 | static_cast<unsigned char>(bytes[i]);
  return out;
}

std::string chunk(const std::string& type, std::string_view data) {
  const std::string body = type + std::string(data);
  return number(static_cast<std::uint32_t>(data.size())) + body + number(crc32_of(body));
}

}  // namespace

std::string apng_bytes(std::span<const std::string> pictures, double seconds_each) {
  std::string out;
  std::uint32_t sequence = 0;
  const auto milliseconds =
      static_cast<std::uint32_t>(std::clamp(std::lround(1000 * seconds_each), 1L, 65535L));
  for (const std::string& picture : pictures) {
    std::string_view rest(picture);
    if (rest.size() < signature) return {};
    rest.remove_prefix(signature);
    bool has_control = false;
    while (rest.size() >= frame_of_chunk) {
      const std::size_t size = number_at(rest);
      if (size > rest.size() - frame_of_chunk) return {};
      const std::string_view type = rest.substr(4, 4), data = rest.substr(8, size);
      const std::string_view whole = rest.substr(0, frame_of_chunk + size);
      rest.remove_prefix(whole.size());
      const bool first = &picture == pictures.data();
      if (type == "IHDR" && first) {
        out = picture.substr(0, signature);
        out += whole;
        out += chunk("acTL", number(static_cast<std::uint32_t>(pictures.size())) + number(0));
      } else if (type == "IHDR") {
        if (out.substr(signature, whole.size()) != whole) return {};  // of another size
      } else if (type == "IDAT") {
        if (!has_control) {
          const std::size_t header = signature + 8;
          out += chunk("fcTL", number(sequence++) + out.substr(header, 8) + number(0) + number(0) +
                                   number(milliseconds << 16 | 1000) + std::string(2, '\0'));
          has_control = true;
        }
        out += first ? std::string(whole) : chunk("fdAT", number(sequence++) + std::string(data));
      } else if (type != "IEND" && first) {
        out += whole;
      }
    }
  }
  return out.empty() ? out : out + chunk("IEND", "");
}

}  // namespace aircut::render
