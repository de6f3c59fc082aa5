// Private: a picture to draw on with lines, bands and text. Cairo stays in canvas.cpp.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/base.h"

namespace aircut::logbook {

struct Colour {
  double r = 0, g = 0, b = 0;
};

struct Spot {
  double x = 0, y = 0;  ///< pixels from the left and from the top
};

enum class Align { left, middle, right };

class Canvas {
 public:
  Canvas(int width, int height);
  ~Canvas();
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;

  void fill(double x, double y, double width, double height, Colour colour);
  /// `dash`: length of dashes in pixels, 0 = drawn through.
  void polyline(const std::vector<Spot>& spots, Colour colour, double width, double dash = 0);
  /// `y`: of the base line.
  void text(double x, double y, const std::string& text, double size, Colour colour,
            Align align = Align::left, bool bold = false);
  double text_width(const std::string& text, double size, bool bold = false);
  /// Until clip_off() nothing outside is drawn.
  void clip(double x, double y, double width, double height);
  void clip_off();
  /// Bytes of the PNG file.
  Expected<std::string> png();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace aircut::logbook
