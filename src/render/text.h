// Text on pictures, by FreeType. Fonts come from the system.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "render/canvas.h"

namespace aircut::render {

enum class Face : unsigned char { sans, bold, mono };

/// Folders in which the DejaVu fonts are looked for.
std::vector<std::string> font_folders();

class Fonts {
 public:
  /// Error kind `output_failed`: a font is in none of the folders.
  static Expected<Fonts> load(std::span<const std::string> folders);
  ~Fonts();
  Fonts(Fonts&&) noexcept;

  /// Draws UTF-8 text from `x` on the base line `y`, `size` pixels per em; returns its width. A
  /// character that no font has is written as ‹U+4E2D›; control characters as ^[.
  double draw(Image& image, double x, double y, std::string_view text, Face face, int size,
              Ink ink) const;
  double width(std::string_view text, Face face, int size) const;
  /// The text, or its beginning with an ellipsis, no wider than `room` pixels.
  std::string fitted(std::string_view text, Face face, int size, double room) const;

 private:
  Fonts();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace aircut::render
