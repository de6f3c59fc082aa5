// Text from files on its way out: valid UTF-8, and nothing in it that acts.

#include <cstdint>

#include "base/text.h"

namespace aircut {

namespace {

// A character of a text: its code point and bytes; `bytes` is 0 where the text is not UTF-8.
struct Character {
  std::uint32_t point = 0;
  std::size_t bytes = 0;
};

// Well-formed sequences only: no overlong forms, no surrogates, nothing above U+10FFFF.
Character character_at(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[at + i]); };
  const unsigned char first = byte(0);
  if (first < 0x80) return {first, 1};
  const std::size_t width = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : first >= 0xc2 ? 2 : 0;
  if (width == 0 || first > 0xf4 || at + width > text.size()) return {};
  std::uint32_t point = first & (0x7fu >> width);
  for (std::size_t i = 1; i < width; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return {};
    point = point << 6 | (byte(i) & 0x3fu);
  }
  constexpr std::uint32_t smallest[] = {0, 0, 0x80, 0x800, 0x10000};
  if (point < smallest[width] || point > 0x10ffff || (point >= 0xd800 && point < 0xe000)) return {};
  return {point, width};
}

bool acts(std::uint32_t point) {
  const auto within = [point](std::uint32_t a, std::uint32_t b) {
    return point >= a && point <= b;
  };
  return within(0x7f, 0x9f) ||                                                   // DEL, C1
         point == 0x61c || within(0x200e, 0x200f) || within(0x202a, 0x202e) ||   // directions
         within(0x2066, 0x2069) || within(0x2028, 0x2029) || point == 0xfeff ||  // separators, BOM
         (point & 0xfffe) == 0xfffe;                                             // non-characters
}

}  // namespace

std::string utf8(std::string_view bytes) {
  std::string out;
  out.reserve(bytes.size());
  for (std::size_t i = 0; i < bytes.size();) {
    const Character c = character_at(bytes, i);
    if (c.bytes > 0) {
      out += bytes.substr(i, c.bytes);
      i += c.bytes;
      continue;
    }
    const auto byte = static_cast<unsigned char>(bytes[i++]);
    out += byte < 0xc0 ? '\xc2' : '\xc3';
    out += static_cast<char>(byte < 0xc0 ? byte : byte - 0x40);
  }
  return out;
}

std::string harmless(std::string_view text) {
  const std::string valid = utf8(text);
  std::string out;
  out.reserve(valid.size());
  for (std::size_t i = 0; i < valid.size();) {
    const Character c = character_at(valid, i);
    if (acts(c.point))
      out += "\xef\xbf\xbd";
    else
      out += valid.substr(i, c.bytes);
    i += c.bytes;
  }
  return out;
}

}  // namespace aircut
