#include "render/gl_context.h"

namespace aircut::render {

Expected<std::unique_ptr<GlContext>> create_gl_context(Backend backend) {
  switch (backend) {
    case Backend::osmesa:
      return create_osmesa_context();
    case Backend::egl:
      return create_egl_context();
    case Backend::automatic:
      break;
  }
  auto osmesa = create_osmesa_context();
  if (osmesa) return osmesa;
  auto egl = create_egl_context();
  if (egl) return egl;
  Diagnostic error = osmesa.error();
  error.notes.push_back({"note", egl.error().message});
  return unexpected(std::move(error));
}

}  // namespace aircut::render
