// The one place that knows where the OpenGL context comes from. Another back end is one more class
// and one more factory.
#pragma once

#include <memory>

#include "base/base.h"
#include "render/render.h"

namespace aircut::render {

class GlContext {
 public:
  virtual ~GlContext() = default;
  /// Binds the context to the calling thread.
  virtual bool make_current() = 0;
  /// Address of an OpenGL function, or null.
  virtual void (*function(const char* name))() = 0;
};

/// A 3.3 core context on OSMesa's software rasteriser. Error kind `output_failed`.
Expected<std::unique_ptr<GlContext>> create_osmesa_context();
/// The same from EGL without a surface. Error kind `output_failed`.
Expected<std::unique_ptr<GlContext>> create_egl_context();
/// As asked for; `automatic` takes OSMesa, and EGL where OSMesa gives nothing. The error is then
/// that of OSMesa, with EGL's as a note.
Expected<std::unique_ptr<GlContext>> create_gl_context(Backend backend);

}  // namespace aircut::render
