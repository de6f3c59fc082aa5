#include <png.h>

#include <csetjmp>

#include "render/render.h"

namespace aircut::render {
namespace {

void append(png_structp png, png_bytep data, png_size_t size) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(data), size);
}

void flush(png_structp) {}

// libpng reports errors by a jump; nothing with a destructor may be created after setjmp here.
bool write_rows(png_structp png, png_infop info, const Image& image, std::vector<png_bytep>& rows) {
  // NOLINTNEXTLINE(cert-err52-cpp): the only way that libpng has
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_IHDR(png, info, static_cast<png_uint_32>(image.width),
               static_cast<png_uint_32>(image.height), 8, PNG_COLOR_TYPE_RGB_ALPHA,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  png_set_compression_level(png, 3);
  png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_write_info(png, info);
  png_write_image(png, rows.data());
  png_write_end(png, nullptr);
  return true;
}

}  // namespace

std::string png_bytes(const Image& image) {
  std::string out;
  if (image.width <= 0 || image.height <= 0) return out;
  const auto stride = static_cast<std::size_t>(image.width) * 4;
  if (image.rgba.size() < stride * static_cast<std::size_t>(image.height)) return out;
  std::vector<png_bytep> rows;
  for (std::size_t y = 0; y < static_cast<std::size_t>(image.height); ++y)
    rows.push_back(const_cast<png_bytep>(image.rgba.data() + y * stride));
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  if (png == nullptr) return out;
  png_infop info = png_create_info_struct(png);
  if (info != nullptr) {
    png_set_write_fn(png, &out, append, flush);
    if (!write_rows(png, info, image, rows)) out.clear();
  }
  png_destroy_write_struct(&png, &info);
  return out;
}

}  // namespace aircut::render
