// OpenGL 3.3 core as a table of functions, and owners of its objects. Private to render.
#pragma once

#include <GL/glcorearb.h>

#include <Eigen/Core>
#include <string>
#include <utility>

#include "base/base.h"
#include "render/gl_context.h"

namespace aircut::render {

#define AIRCUT_GL_FUNCTIONS(X)                                               \
  X(PFNGLACTIVETEXTUREPROC, ActiveTexture)                                   \
  X(PFNGLATTACHSHADERPROC, AttachShader)                                     \
  X(PFNGLBINDBUFFERPROC, BindBuffer)                                         \
  X(PFNGLBINDFRAMEBUFFERPROC, BindFramebuffer)                               \
  X(PFNGLBINDRENDERBUFFERPROC, BindRenderbuffer)                             \
  X(PFNGLBINDTEXTUREPROC, BindTexture)                                       \
  X(PFNGLBINDVERTEXARRAYPROC, BindVertexArray)                               \
  X(PFNGLBLENDFUNCPROC, BlendFunc)                                           \
  X(PFNGLBLITFRAMEBUFFERPROC, BlitFramebuffer)                               \
  X(PFNGLBUFFERDATAPROC, BufferData)                                         \
  X(PFNGLCHECKFRAMEBUFFERSTATUSPROC, CheckFramebufferStatus)                 \
  X(PFNGLCLEARPROC, Clear)                                                   \
  X(PFNGLCLEARCOLORPROC, ClearColor)                                         \
  X(PFNGLCOLORMASKPROC, ColorMask)                                           \
  X(PFNGLCOMPILESHADERPROC, CompileShader)                                   \
  X(PFNGLCREATEPROGRAMPROC, CreateProgram)                                   \
  X(PFNGLCREATESHADERPROC, CreateShader)                                     \
  X(PFNGLCULLFACEPROC, CullFace)                                             \
  X(PFNGLDELETEBUFFERSPROC, DeleteBuffers)                                   \
  X(PFNGLDELETEFRAMEBUFFERSPROC, DeleteFramebuffers)                         \
  X(PFNGLDELETEPROGRAMPROC, DeleteProgram)                                   \
  X(PFNGLDELETERENDERBUFFERSPROC, DeleteRenderbuffers)                       \
  X(PFNGLDELETESHADERPROC, DeleteShader)                                     \
  X(PFNGLDELETETEXTURESPROC, DeleteTextures)                                 \
  X(PFNGLDELETEVERTEXARRAYSPROC, DeleteVertexArrays)                         \
  X(PFNGLDEPTHFUNCPROC, DepthFunc)                                           \
  X(PFNGLDEPTHMASKPROC, DepthMask)                                           \
  X(PFNGLDISABLEPROC, Disable)                                               \
  X(PFNGLDRAWARRAYSPROC, DrawArrays)                                         \
  X(PFNGLDRAWARRAYSINSTANCEDPROC, DrawArraysInstanced)                       \
  X(PFNGLDRAWBUFFERPROC, DrawBuffer)                                         \
  X(PFNGLDRAWELEMENTSPROC, DrawElements)                                     \
  X(PFNGLENABLEPROC, Enable)                                                 \
  X(PFNGLENABLEVERTEXATTRIBARRAYPROC, EnableVertexAttribArray)               \
  X(PFNGLFRAMEBUFFERRENDERBUFFERPROC, FramebufferRenderbuffer)               \
  X(PFNGLFRAMEBUFFERTEXTURE2DPROC, FramebufferTexture2D)                     \
  X(PFNGLGENBUFFERSPROC, GenBuffers)                                         \
  X(PFNGLGENFRAMEBUFFERSPROC, GenFramebuffers)                               \
  X(PFNGLGENRENDERBUFFERSPROC, GenRenderbuffers)                             \
  X(PFNGLGENTEXTURESPROC, GenTextures)                                       \
  X(PFNGLGENVERTEXARRAYSPROC, GenVertexArrays)                               \
  X(PFNGLGETERRORPROC, GetError)                                             \
  X(PFNGLGETINTEGERVPROC, GetIntegerv)                                       \
  X(PFNGLGETPROGRAMINFOLOGPROC, GetProgramInfoLog)                           \
  X(PFNGLGETPROGRAMIVPROC, GetProgramiv)                                     \
  X(PFNGLGETSHADERINFOLOGPROC, GetShaderInfoLog)                             \
  X(PFNGLGETSHADERIVPROC, GetShaderiv)                                       \
  X(PFNGLGETUNIFORMLOCATIONPROC, GetUniformLocation)                         \
  X(PFNGLLINKPROGRAMPROC, LinkProgram)                                       \
  X(PFNGLPIXELSTOREIPROC, PixelStorei)                                       \
  X(PFNGLPOLYGONOFFSETPROC, PolygonOffset)                                   \
  X(PFNGLREADBUFFERPROC, ReadBuffer)                                         \
  X(PFNGLREADPIXELSPROC, ReadPixels)                                         \
  X(PFNGLRENDERBUFFERSTORAGEMULTISAMPLEPROC, RenderbufferStorageMultisample) \
  X(PFNGLSCISSORPROC, Scissor)                                               \
  X(PFNGLSHADERSOURCEPROC, ShaderSource)                                     \
  X(PFNGLSTENCILFUNCPROC, StencilFunc)                                       \
  X(PFNGLSTENCILOPPROC, StencilOp)                                           \
  X(PFNGLTEXIMAGE2DPROC, TexImage2D)                                         \
  X(PFNGLTEXPARAMETERFVPROC, TexParameterfv)                                 \
  X(PFNGLTEXPARAMETERIPROC, TexParameteri)                                   \
  X(PFNGLTEXSUBIMAGE2DPROC, TexSubImage2D)                                   \
  X(PFNGLUNIFORM1FPROC, Uniform1f)                                           \
  X(PFNGLUNIFORM1IPROC, Uniform1i)                                           \
  X(PFNGLUNIFORM2FPROC, Uniform2f)                                           \
  X(PFNGLUNIFORM3FPROC, Uniform3f)                                           \
  X(PFNGLUNIFORM4FPROC, Uniform4f)                                           \
  X(PFNGLUNIFORMMATRIX3FVPROC, UniformMatrix3fv)                             \
  X(PFNGLUNIFORMMATRIX4FVPROC, UniformMatrix4fv)                             \
  X(PFNGLUSEPROGRAMPROC, UseProgram)                                         \
  X(PFNGLVERTEXATTRIB4FPROC, VertexAttrib4f)                                 \
  X(PFNGLUNIFORM2IPROC, Uniform2i)                                           \
  X(PFNGLVERTEXATTRIBDIVISORPROC, VertexAttribDivisor)                       \
  X(PFNGLVERTEXATTRIBPOINTERPROC, VertexAttribPointer)                       \
  X(PFNGLVIEWPORTPROC, Viewport)

/// The functions that this library calls, without their `gl`.
struct Gl {
#define AIRCUT_GL_MEMBER(type, name) type name = nullptr;
  AIRCUT_GL_FUNCTIONS(AIRCUT_GL_MEMBER)
#undef AIRCUT_GL_MEMBER
};

/// Error kind `output_failed` when the context lacks one of the functions.
Expected<Gl> load_gl(GlContext& context);

/// Owner of one OpenGL name. The context must be current when it is destroyed.
template <class Delete>
class GlName {
 public:
  GlName() = default;
  GlName(const Gl& gl, GLuint name) : gl_(&gl), name_(name) {}
  GlName(GlName&& other) noexcept
      : gl_(std::exchange(other.gl_, nullptr)), name_(std::exchange(other.name_, 0u)) {}
  GlName& operator=(GlName&& other) noexcept {
    std::swap(gl_, other.gl_);
    std::swap(name_, other.name_);
    return *this;
  }
  GlName(const GlName&) = delete;
  GlName& operator=(const GlName&) = delete;
  ~GlName() {
    if (gl_ != nullptr && name_ != 0) Delete{}(*gl_, name_);
  }
  GLuint get() const { return name_; }
  explicit operator bool() const { return name_ != 0; }

 private:
  const Gl* gl_ = nullptr;
  GLuint name_ = 0;
};

struct DeleteBuffer {
  void operator()(const Gl& gl, GLuint name) const { gl.DeleteBuffers(1, &name); }
};
struct DeleteArray {
  void operator()(const Gl& gl, GLuint name) const { gl.DeleteVertexArrays(1, &name); }
};
struct DeleteTexture {
  void operator()(const Gl& gl, GLuint name) const { gl.DeleteTextures(1, &name); }
};
struct DeleteRenderbuffer {
  void operator()(const Gl& gl, GLuint name) const { gl.DeleteRenderbuffers(1, &name); }
};
struct DeleteFramebuffer {
  void operator()(const Gl& gl, GLuint name) const { gl.DeleteFramebuffers(1, &name); }
};
struct DeleteProgram {
  void operator()(const Gl& gl, GLuint name) const { gl.DeleteProgram(name); }
};
using GlBuffer = GlName<DeleteBuffer>;
using GlArray = GlName<DeleteArray>;
using GlTexture = GlName<DeleteTexture>;
using GlRenderbuffer = GlName<DeleteRenderbuffer>;
using GlFramebuffer = GlName<DeleteFramebuffer>;

GlBuffer make_buffer(const Gl& gl);
GlArray make_array(const Gl& gl);
GlFramebuffer make_framebuffer(const Gl& gl);
GlRenderbuffer make_renderbuffer(const Gl& gl, GLenum format, int samples, int width, int height);
GlTexture make_texture(const Gl& gl, GLenum internal, GLenum format, GLenum type, int width,
                       int height);

/// A linked pair of shaders.
class Program {
 public:
  Program() = default;
  /// The error holds the compiler's log: a driver that can't take our shaders.
  static Expected<Program> link(const Gl& gl, const std::string& vertex,
                                const std::string& fragment);
  void use() const { gl_->UseProgram(name_.get()); }
  // Uniforms of the program in use. A name that the compiler dropped is ignored by OpenGL.
  void set(const char* name, int value) const;
  void set(const char* name, double value) const;
  void set(const char* name, const Eigen::Vector2i& value) const;
  void set(const char* name, const Eigen::Vector2d& value) const;
  void set(const char* name, const Eigen::Vector3d& value) const;
  void set(const char* name, const Eigen::Vector4d& value) const;
  void set(const char* name, const Eigen::Matrix3d& value) const;
  void set(const char* name, const Eigen::Matrix4d& value) const;
  explicit operator bool() const { return static_cast<bool>(name_); }

 private:
  GLint place(const char* name) const { return gl_->GetUniformLocation(name_.get(), name); }

  const Gl* gl_ = nullptr;
  GlName<DeleteProgram> name_;
};

/// Ready to draw, or the reason why not, as an error that names `what`.
Expected<void> check_framebuffer(const Gl& gl, const std::string& what);

}  // namespace aircut::render
