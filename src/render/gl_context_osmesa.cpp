// OSMesa back end. Frames go to framebuffer objects of our own; the buffer that OSMesa insists on
// is a dummy of 16 x 16 pixels.
#include <GL/osmesa.h>

#include <array>

#include "render/gl_context.h"

namespace aircut::render {
namespace {

class OsMesaGlContext final : public GlContext {
 public:
  explicit OsMesaGlContext(OSMesaContext context) : context_(context) {}
  ~OsMesaGlContext() override {
    // The current context must not die while it is bound to this thread.
    if (OSMesaGetCurrentContext() == context_) OSMesaMakeCurrent(nullptr, nullptr, 0, 0, 0);
    OSMesaDestroyContext(context_);
  }
  OsMesaGlContext(const OsMesaGlContext&) = delete;
  OsMesaGlContext& operator=(const OsMesaGlContext&) = delete;

  bool make_current() override {
    return OSMesaMakeCurrent(context_, buffer_.data(), GL_UNSIGNED_BYTE, side, side) == GL_TRUE;
  }
  void (*function(const char* name))() override { return OSMesaGetProcAddress(name); }

 private:
  static constexpr int side = 16;
  OSMesaContext context_;
  std::array<unsigned char, std::size_t{4} * side * side> buffer_{};
};

}  // namespace

Expected<std::unique_ptr<GlContext>> create_osmesa_context() {
  constexpr std::array<int, 13> attributes = {OSMESA_FORMAT,
                                              OSMESA_RGBA,
                                              OSMESA_DEPTH_BITS,
                                              0,
                                              OSMESA_PROFILE,
                                              OSMESA_CORE_PROFILE,
                                              OSMESA_CONTEXT_MAJOR_VERSION,
                                              3,
                                              OSMESA_CONTEXT_MINOR_VERSION,
                                              3,
                                              0,
                                              0,
                                              0};
  OSMesaContext context = OSMesaCreateContextAttribs(attributes.data(), nullptr);
  if (context == nullptr)
    return unexpected(make_error(
        "output_failed",
        "OSMesa gives no OpenGL 3.3 core context; install libosmesa6 (Mesa before 25.1)"));
  auto out = std::make_unique<OsMesaGlContext>(context);
  if (!out->make_current())
    return unexpected(make_error("output_failed", "OSMesa cannot bind its OpenGL context"));
  return out;
}

}  // namespace aircut::render
