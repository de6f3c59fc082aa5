// OSMesa back end. Frames go to framebuffer objects of our own; the buffer that OSMesa insists on
// is a dummy of 16 x 16 pixels. libOSMesa brings LLVM along (some 45 MiB, 20 ms), so it is opened
// when the first picture is drawn and not when the program starts; its header gives the types.
#include <GL/osmesa.h>

#include <array>

#include "base/shared_library.h"
#include "render/gl_context.h"

namespace aircut::render {
namespace {

struct OsMesa {
  decltype(&OSMesaCreateContextAttribs) create_context = nullptr;
  decltype(&OSMesaDestroyContext) destroy_context = nullptr;
  decltype(&OSMesaMakeCurrent) make_current = nullptr;
  decltype(&OSMesaGetCurrentContext) current_context = nullptr;
  decltype(&OSMesaGetProcAddress) get_proc_address = nullptr;
};

// The library stays open: Mesa does not survive being unloaded. Opening it again gives the same.
Expected<OsMesa> open_osmesa() {
  const auto library = open_library("libOSMesa.so.8", "install libosmesa6 (Mesa before 25.1)");
  if (!library) return unexpected(library.error());
  OsMesa osmesa;
  const bool complete =
      find_function(*library, "OSMesaCreateContextAttribs", osmesa.create_context) &&
      find_function(*library, "OSMesaDestroyContext", osmesa.destroy_context) &&
      find_function(*library, "OSMesaMakeCurrent", osmesa.make_current) &&
      find_function(*library, "OSMesaGetCurrentContext", osmesa.current_context) &&
      find_function(*library, "OSMesaGetProcAddress", osmesa.get_proc_address);
  if (!complete)
    return unexpected(
        make_error("output_failed", "libOSMesa.so.8 is older than Mesa 12; install a newer one"));
  return osmesa;
}

class OsMesaGlContext final : public GlContext {
 public:
  OsMesaGlContext(const OsMesa& osmesa, OSMesaContext context)
      : osmesa_(osmesa), context_(context) {}
  ~OsMesaGlContext() override {
    // The current context must not die while it is bound to this thread.
    if (osmesa_.current_context() == context_) osmesa_.make_current(nullptr, nullptr, 0, 0, 0);
    osmesa_.destroy_context(context_);
  }
  OsMesaGlContext(const OsMesaGlContext&) = delete;
  OsMesaGlContext& operator=(const OsMesaGlContext&) = delete;

  bool make_current() override {
    return osmesa_.make_current(context_, buffer_.data(), GL_UNSIGNED_BYTE, side, side) == GL_TRUE;
  }
  void (*function(const char* name))() override { return osmesa_.get_proc_address(name); }

 private:
  static constexpr int side = 16;
  OsMesa osmesa_;
  OSMesaContext context_;
  std::array<unsigned char, std::size_t{4} * side * side> buffer_{};
};

}  // namespace

Expected<std::unique_ptr<GlContext>> create_osmesa_context() {
  const auto osmesa = open_osmesa();
  if (!osmesa) return unexpected(osmesa.error());
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
  OSMesaContext context = osmesa->create_context(attributes.data(), nullptr);
  if (context == nullptr)
    return unexpected(make_error(
        "output_failed",
        "OSMesa gives no OpenGL 3.3 core context; install libosmesa6 (Mesa before 25.1)"));
  auto out = std::make_unique<OsMesaGlContext>(*osmesa, context);
  if (!out->make_current())
    return unexpected(make_error("output_failed", "OSMesa cannot bind its OpenGL context"));
  return out;
}

}  // namespace aircut::render
