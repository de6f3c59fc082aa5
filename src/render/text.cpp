#include "render/text.h"

#include <fmt/format.h>
#include <ft2build.h>
#include FT_FREETYPE_H

#include <array>
#include <cmath>
#include <fstream>

namespace aircut::render {
namespace {

constexpr std::array<const char*, 3> font_files = {"DejaVuSans.ttf", "DejaVuSans-Bold.ttf",
                                                   "DejaVuSansMono.ttf"};

// Code points of a UTF-8 text; each byte of a broken sequence becomes U+FFFD.
std::u32string code_points(std::string_view text) {
  std::u32string out;
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const std::size_t length = lead < 0x80   ? 1
                               : lead < 0xC2 ? 0
                               : lead < 0xE0 ? 2
                               : lead < 0xF0 ? 3
                               : lead < 0xF5 ? 4
                                             : 0;
    char32_t point = length == 1 ? lead : lead & (0x7Fu >> length);
    bool good = length > 0 && i + length <= text.size();
    for (std::size_t k = 1; good && k < length; ++k) {
      const auto byte = static_cast<unsigned char>(text[i + k]);
      good = (byte & 0xC0u) == 0x80;
      point = (point << 6) | (byte & 0x3Fu);
    }
    const bool overlong = (length == 3 && point < 0x800) || (length == 4 && point < 0x10000);
    const bool surrogate = point >= 0xD800 && point < 0xE000;
    if (!good || overlong || surrogate || point > 0x10FFFF) {
      out.push_back(0xFFFD);
      ++i;
      continue;
    }
    out.push_back(point);
    i += length;
  }
  return out;
}

std::string utf8(char32_t c) {
  std::string out;
  const auto tail = [&](int shift) {
    out.push_back(static_cast<char>(0x80u | ((c >> shift) & 0x3Fu)));
  };
  if (c < 0x80) {
    out.push_back(static_cast<char>(c));
  } else if (c < 0x800) {
    out.push_back(static_cast<char>(0xC0u | (c >> 6)));
    tail(0);
  } else if (c < 0x10000) {
    out.push_back(static_cast<char>(0xE0u | (c >> 12)));
    tail(6);
    tail(0);
  } else {
    out.push_back(static_cast<char>(0xF0u | (c >> 18)));
    tail(12);
    tail(6);
    tail(0);
  }
  return out;
}

}  // namespace

std::vector<std::string> font_folders() {
  return {"/usr/share/fonts/truetype/dejavu", "/usr/share/fonts/dejavu",
          "/usr/share/fonts/dejavu-sans-fonts", "/usr/share/fonts/TTF",
          "/usr/local/share/fonts/dejavu"};
}

struct Fonts::Impl {
  FT_Library library = nullptr;
  std::array<FT_Face, 3> faces{};
  ~Impl() {
    for (FT_Face face : faces)
      if (face != nullptr) FT_Done_Face(face);
    if (library != nullptr) FT_Done_FreeType(library);
  }

  // A glyph of the wished face, else of the sans face, which has the most characters.
  FT_Face face_with(char32_t c, Face wished) const {
    FT_Face first = faces[static_cast<std::size_t>(wished)];
    if (FT_Get_Char_Index(first, c) != 0) return first;
    return FT_Get_Char_Index(faces[0], c) != 0 ? faces[0] : nullptr;
  }

  // Replaces what has no glyph by something readable.
  std::u32string drawable(std::string_view text, Face face) const {
    std::u32string out;
    for (const char32_t c : code_points(text)) {
      std::string spelled;
      if (c < 0x20 || c == 0x7F)
        spelled = fmt::format("^{}", static_cast<char>(c ^ 0x40u));
      else if (c >= 0x80 && c < 0xA0)
        spelled = fmt::format("‹U+{:04X}›", static_cast<unsigned>(c));
      else if (face_with(c, face) == nullptr)
        spelled = fmt::format("‹U+{:04X}›", static_cast<unsigned>(c));
      else
        out.push_back(c);
      out += code_points(spelled);
    }
    return out;
  }

  // Calls use(face with the glyph loaded, x) for each character; returns the width.
  template <class Use>
  double lay_out(const std::u32string& text, Face face, int size, int flags, const Use& use) const {
    double x = 0;
    for (const char32_t c : text) {
      FT_Face from = face_with(c, face);
      if (from == nullptr || FT_Set_Pixel_Sizes(from, 0, static_cast<FT_UInt>(size)) != 0) continue;
      if (FT_Load_Char(from, c, flags | FT_LOAD_TARGET_LIGHT) != 0) continue;
      use(from, x);
      x += static_cast<double>(from->glyph->advance.x) / 64;
    }
    return x;
  }
};

Fonts::Fonts() : impl_(std::make_unique<Impl>()) {}
Fonts::~Fonts() = default;
Fonts::Fonts(Fonts&&) noexcept = default;

Expected<Fonts> Fonts::load(std::span<const std::string> folders) {
  Fonts out;
  if (FT_Init_FreeType(&out.impl_->library) != 0)
    return unexpected(make_error("output_failed", "FreeType cannot be started"));
  for (std::size_t i = 0; i < font_files.size(); ++i) {
    for (const std::string& folder : folders) {
      const std::string path = folder + "/" + font_files[i];
      if (FT_New_Face(out.impl_->library, path.c_str(), 0, &out.impl_->faces[i]) == 0) break;
      out.impl_->faces[i] = nullptr;
    }
    if (out.impl_->faces[i] != nullptr) continue;
    std::string where;
    for (const std::string& folder : folders) where += (where.empty() ? "" : ", ") + folder;
    return unexpected(make_error(
        "output_failed", fmt::format("font {} for the text on pictures is in none of: {}; install "
                                     "the DejaVu fonts (Debian: fonts-dejavu-core)",
                                     font_files[i], where)));
  }
  return out;
}

double Fonts::draw(Image& image, double x, double y, std::string_view text, Face face, int size,
                   Ink ink) const {
  const auto put = [&](FT_Face from, double at) {
    const FT_GlyphSlot slot = from->glyph;
    const FT_Bitmap& map = slot->bitmap;
    const int left = static_cast<int>(std::lround(x + at)) + slot->bitmap_left;
    const int top = static_cast<int>(std::lround(y)) - slot->bitmap_top;
    for (unsigned row = 0; row < map.rows; ++row)
      for (unsigned column = 0; column < map.width; ++column) {
        const unsigned char v =
            map.buffer[static_cast<std::ptrdiff_t>(row) * map.pitch + static_cast<int>(column)];
        if (v != 0)
          blend(image, left + static_cast<int>(column), top + static_cast<int>(row), ink,
                v / 255.0);
      }
  };
  return impl_->lay_out(impl_->drawable(text, face), face, size, FT_LOAD_RENDER, put);
}

double Fonts::width(std::string_view text, Face face, int size) const {
  return impl_->lay_out(impl_->drawable(text, face), face, size, FT_LOAD_DEFAULT,
                        [](FT_Face, double) {});
}

std::string Fonts::fitted(std::string_view text, Face face, int size, double room) const {
  if (width(text, face, size) <= room) return std::string(text);
  const double dots = width("…", face, size);
  if (dots > room) return {};
  double used = dots;
  std::string out;
  for (const char32_t c : code_points(text)) {
    const std::string next = utf8(c);
    used += width(next, face, size);
    if (used > room) break;
    out += next;
  }
  return out + "…";
}

}  // namespace aircut::render
