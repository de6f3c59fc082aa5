#include "logbook/canvas.h"

#include <cairo/cairo.h>

namespace aircut::logbook {

struct Canvas::Impl {
  cairo_surface_t* surface = nullptr;
  cairo_t* cairo = nullptr;

  void set_font(double size, bool bold) {
    cairo_select_font_face(cairo, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                           bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cairo, size);
  }
  void set(Colour c) { cairo_set_source_rgb(cairo, c.r, c.g, c.b); }
};

Canvas::Canvas(int width, int height) : impl_(std::make_unique<Impl>()) {
  impl_->surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
  impl_->cairo = cairo_create(impl_->surface);
  impl_->set({1, 1, 1});
  cairo_paint(impl_->cairo);
  cairo_set_line_join(impl_->cairo, CAIRO_LINE_JOIN_ROUND);
}

Canvas::~Canvas() {
  cairo_destroy(impl_->cairo);
  cairo_surface_destroy(impl_->surface);
}

void Canvas::fill(double x, double y, double width, double height, Colour colour) {
  impl_->set(colour);
  cairo_rectangle(impl_->cairo, x, y, width, height);
  cairo_fill(impl_->cairo);
}

void Canvas::polyline(const std::vector<Spot>& spots, Colour colour, double width, double dash) {
  if (spots.empty()) return;
  impl_->set(colour);
  cairo_set_line_width(impl_->cairo, width);
  cairo_set_dash(impl_->cairo, &dash, dash > 0 ? 1 : 0, 0);
  cairo_move_to(impl_->cairo, spots.front().x, spots.front().y);
  for (const Spot& spot : spots) cairo_line_to(impl_->cairo, spot.x, spot.y);
  cairo_stroke(impl_->cairo);
}

double Canvas::text_width(const std::string& text, double size, bool bold) {
  impl_->set_font(size, bold);
  cairo_text_extents_t extents;
  cairo_text_extents(impl_->cairo, text.c_str(), &extents);
  return extents.x_advance;
}

void Canvas::text(double x, double y, const std::string& text, double size, Colour colour,
                  Align align, bool bold) {
  const double width = align == Align::left ? 0 : text_width(text, size, bold);
  impl_->set_font(size, bold);
  impl_->set(colour);
  cairo_move_to(impl_->cairo,
                x - width * (align == Align::right ? 1 : 0.5 * (align == Align::middle)), y);
  cairo_show_text(impl_->cairo, text.c_str());
}

void Canvas::clip(double x, double y, double width, double height) {
  cairo_save(impl_->cairo);
  cairo_rectangle(impl_->cairo, x, y, width, height);
  cairo_clip(impl_->cairo);
}

void Canvas::clip_off() { cairo_restore(impl_->cairo); }

Expected<std::string> Canvas::png() {
  std::string out;
  const auto write = [](void* to, const unsigned char* data, unsigned int length) {
    static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(data), length);
    return CAIRO_STATUS_SUCCESS;
  };
  const cairo_status_t status = cairo_surface_write_to_png_stream(impl_->surface, write, &out);
  if (cairo_status(impl_->cairo) != CAIRO_STATUS_SUCCESS || status != CAIRO_STATUS_SUCCESS)
    return unexpected(make_error("output_failed", std::string("the picture can't be drawn: ") +
                                                      cairo_status_to_string(status)));
  return out;
}

}  // namespace aircut::logbook
