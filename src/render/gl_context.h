// The one place that knows where the OpenGL context comes from. A second back end (EGL surfaceless)
// is one more class and one more factory.
#pragma once

#include <memory>

#include "base/base.h"

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

}  // namespace aircut::render
