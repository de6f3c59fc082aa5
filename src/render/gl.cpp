#include "render/gl.h"

#include <fmt/format.h>

#include <array>

namespace aircut::render {

Expected<Gl> load_gl(GlContext& context) {
  Gl gl;
  std::string missing;
#define AIRCUT_GL_LOAD(type, name)                                \
  gl.name = reinterpret_cast<type>(context.function("gl" #name)); \
  if (gl.name == nullptr && missing.empty()) missing = "gl" #name;
  AIRCUT_GL_FUNCTIONS(AIRCUT_GL_LOAD)
#undef AIRCUT_GL_LOAD
  if (!missing.empty())
    return unexpected(
        make_error("output_failed",
                   fmt::format("the OpenGL library has no {}; OpenGL 3.3 is needed", missing)));
  return gl;
}

GlBuffer make_buffer(const Gl& gl) {
  GLuint name = 0;
  gl.GenBuffers(1, &name);
  return {gl, name};
}

GlArray make_array(const Gl& gl) {
  GLuint name = 0;
  gl.GenVertexArrays(1, &name);
  return {gl, name};
}

GlFramebuffer make_framebuffer(const Gl& gl) {
  GLuint name = 0;
  gl.GenFramebuffers(1, &name);
  return {gl, name};
}

GlRenderbuffer make_renderbuffer(const Gl& gl, GLenum format, int samples, int width, int height) {
  GLuint name = 0;
  gl.GenRenderbuffers(1, &name);
  gl.BindRenderbuffer(GL_RENDERBUFFER, name);
  gl.RenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, width, height);
  return {gl, name};
}

GlTexture make_texture(const Gl& gl, GLenum internal, GLenum format, GLenum type, int width,
                       int height) {
  GLuint name = 0;
  gl.GenTextures(1, &name);
  gl.BindTexture(GL_TEXTURE_2D, name);
  gl.TexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(internal), width, height, 0, format, type,
                nullptr);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return {gl, name};
}

namespace {

Expected<GLuint> compile(const Gl& gl, GLenum kind, const std::string& source) {
  const GLuint shader = gl.CreateShader(kind);
  const char* text = source.c_str();
  gl.ShaderSource(shader, 1, &text, nullptr);
  gl.CompileShader(shader);
  GLint ok = 0;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  if (ok != 0) return shader;
  std::array<char, 2000> log{};
  gl.GetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
  gl.DeleteShader(shader);
  return unexpected(make_error("output_failed",
                               fmt::format("the OpenGL driver refuses a shader: {}", log.data())));
}

}  // namespace

Expected<Program> Program::link(const Gl& gl, const std::string& vertex,
                                const std::string& fragment) {
  const auto v = compile(gl, GL_VERTEX_SHADER, vertex);
  if (!v) return unexpected(v.error());
  const auto f = compile(gl, GL_FRAGMENT_SHADER, fragment);
  if (!f) {
    gl.DeleteShader(*v);
    return unexpected(f.error());
  }
  Program out;
  out.gl_ = &gl;
  out.name_ = {gl, gl.CreateProgram()};
  gl.AttachShader(out.name_.get(), *v);
  gl.AttachShader(out.name_.get(), *f);
  gl.LinkProgram(out.name_.get());
  gl.DeleteShader(*v);
  gl.DeleteShader(*f);
  GLint ok = 0;
  gl.GetProgramiv(out.name_.get(), GL_LINK_STATUS, &ok);
  if (ok != 0) return out;
  std::array<char, 2000> log{};
  gl.GetProgramInfoLog(out.name_.get(), static_cast<GLsizei>(log.size()), nullptr, log.data());
  return unexpected(make_error("output_failed",
                               fmt::format("the OpenGL driver refuses a program: {}", log.data())));
}

void Program::set(const char* name, int value) const { gl_->Uniform1i(place(name), value); }

void Program::set(const char* name, double value) const {
  gl_->Uniform1f(place(name), static_cast<float>(value));
}

void Program::set(const char* name, const Eigen::Vector2i& value) const {
  gl_->Uniform2i(place(name), value.x(), value.y());
}

void Program::set(const char* name, const Eigen::Vector2d& value) const {
  const Eigen::Vector2f v = value.cast<float>();
  gl_->Uniform2f(place(name), v.x(), v.y());
}

void Program::set(const char* name, const Eigen::Vector3d& value) const {
  const Eigen::Vector3f v = value.cast<float>();
  gl_->Uniform3f(place(name), v.x(), v.y(), v.z());
}

void Program::set(const char* name, const Eigen::Vector4d& value) const {
  const Eigen::Vector4f v = value.cast<float>();
  gl_->Uniform4f(place(name), v.x(), v.y(), v.z(), v.w());
}

void Program::set(const char* name, const Eigen::Matrix3d& value) const {
  const Eigen::Matrix3f m = value.cast<float>();
  gl_->UniformMatrix3fv(place(name), 1, GL_FALSE, m.data());
}

void Program::set(const char* name, const Eigen::Matrix4d& value) const {
  const Eigen::Matrix4f m = value.cast<float>();
  gl_->UniformMatrix4fv(place(name), 1, GL_FALSE, m.data());
}

Expected<void> check_framebuffer(const Gl& gl, const std::string& what) {
  const GLenum status = gl.CheckFramebufferStatus(GL_FRAMEBUFFER);
  if (status == GL_FRAMEBUFFER_COMPLETE) return {};
  return unexpected(
      make_error("output_failed", fmt::format("the OpenGL driver gives no {} (framebuffer status "
                                              "0x{:x}); try a smaller picture",
                                              what, status)));
}

}  // namespace aircut::render
