// EGL back end: Mesa's surfaceless platform, which needs neither a screen nor a window and draws on
// the processor. libEGL is opened at run time, so that a machine without it still has the OSMesa
// back end; the few declarations below are EGL 1.5's own.
#include <array>
#include <cstdint>

#include "base/shared_library.h"
#include "render/gl_context.h"

namespace aircut::render {
namespace {

using Display = void*;
using Config = void*;
using Context = void*;
using Int = std::int32_t;

constexpr unsigned opengl_api = 0x30A2;            // EGL_OPENGL_API
constexpr unsigned platform_surfaceless = 0x31DD;  // EGL_PLATFORM_SURFACELESS_MESA
constexpr Int none = 0x3038;                       // EGL_NONE
constexpr Int renderable_type = 0x3040;            // EGL_RENDERABLE_TYPE
constexpr Int opengl_bit = 0x0008;                 // EGL_OPENGL_BIT
constexpr Int surface_type = 0x3033;               // EGL_SURFACE_TYPE
constexpr Int major_version = 0x3098;              // EGL_CONTEXT_MAJOR_VERSION
constexpr Int minor_version = 0x30FB;              // EGL_CONTEXT_MINOR_VERSION
constexpr Int profile_mask = 0x30FD;               // EGL_CONTEXT_OPENGL_PROFILE_MASK
constexpr Int core_profile = 0x0001;               // EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT

using Function = void (*)();

struct Egl {
  Function (*get_proc_address)(const char*) = nullptr;
  Display (*get_platform_display)(unsigned, void*, const std::intptr_t*) = nullptr;
  unsigned (*initialize)(Display, Int*, Int*) = nullptr;
  unsigned (*bind_api)(unsigned) = nullptr;
  unsigned (*choose_config)(Display, const Int*, Config*, Int, Int*) = nullptr;
  Context (*create_context)(Display, Config, Context, const Int*) = nullptr;
  unsigned (*make_current)(Display, void*, void*, Context) = nullptr;
  unsigned (*destroy_context)(Display, Context) = nullptr;
};

// The library stays open: Mesa does not survive being unloaded.
Expected<Egl> open_egl() {
  const auto library = open_library("libEGL.so.1", "install libegl1");
  if (!library) return unexpected(library.error());
  Egl egl;
  const bool complete =
      find_function(*library, "eglGetProcAddress", egl.get_proc_address) &&
      find_function(*library, "eglGetPlatformDisplay", egl.get_platform_display) &&
      find_function(*library, "eglInitialize", egl.initialize) &&
      find_function(*library, "eglBindAPI", egl.bind_api) &&
      find_function(*library, "eglChooseConfig", egl.choose_config) &&
      find_function(*library, "eglCreateContext", egl.create_context) &&
      find_function(*library, "eglMakeCurrent", egl.make_current) &&
      find_function(*library, "eglDestroyContext", egl.destroy_context);
  if (!complete)
    return unexpected(make_error("output_failed", "libEGL.so.1 is older than EGL 1.5"));
  return egl;
}

class EglGlContext final : public GlContext {
 public:
  EglGlContext(const Egl& egl, Display display, Context context)
      : egl_(egl), display_(display), context_(context) {}
  ~EglGlContext() override {
    egl_.make_current(display_, nullptr, nullptr, nullptr);
    egl_.destroy_context(display_, context_);
  }
  EglGlContext(const EglGlContext&) = delete;
  EglGlContext& operator=(const EglGlContext&) = delete;

  bool make_current() override {
    return egl_.bind_api(opengl_api) != 0 &&
           egl_.make_current(display_, nullptr, nullptr, context_) != 0;
  }
  void (*function(const char* name))() override { return egl_.get_proc_address(name); }

 private:
  Egl egl_;
  Display display_;
  Context context_;
};

}  // namespace

Expected<std::unique_ptr<GlContext>> create_egl_context() {
  const auto egl = open_egl();
  if (!egl) return unexpected(egl.error());
  const auto refused = [] {
    return unexpected(make_error("output_failed",
                                 "EGL gives no OpenGL 3.3 core context without a screen; install "
                                 "libegl-mesa0 and libgl1-mesa-dri"));
  };
  // All contexts share one display, which stays initialised.
  Display display = egl->get_platform_display(platform_surfaceless, nullptr, nullptr);
  if (display == nullptr || egl->initialize(display, nullptr, nullptr) == 0) return refused();
  if (egl->bind_api(opengl_api) == 0) return refused();
  constexpr std::array<Int, 5> wanted = {renderable_type, opengl_bit, surface_type, 0, none};
  Config config = nullptr;
  Int count = 0;
  if (egl->choose_config(display, wanted.data(), &config, 1, &count) == 0 || count == 0)
    return refused();
  constexpr std::array<Int, 7> attributes = {major_version, 3,   minor_version, 3, profile_mask,
                                             core_profile,  none};
  Context context = egl->create_context(display, config, nullptr, attributes.data());
  if (context == nullptr) return refused();
  auto out = std::make_unique<EglGlContext>(*egl, display, context);
  if (!out->make_current()) return refused();
  return out;
}

}  // namespace aircut::render
