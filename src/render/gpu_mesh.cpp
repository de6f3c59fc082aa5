#include "render/gpu_mesh.h"

#include <cstddef>

namespace aircut::render {
namespace {

const void* at_offset(std::size_t bytes) { return reinterpret_cast<const void*>(bytes); }

template <class T>
void upload(const Gl& gl, GLenum target, GLuint buffer, const std::vector<T>& data, GLenum usage) {
  gl.BindBuffer(target, buffer);
  gl.BufferData(target, static_cast<GLsizeiptr>(data.size() * sizeof(T)), data.data(), usage);
}

void attribute(const Gl& gl, GLuint index, GLint size, std::size_t stride, std::size_t offset,
               GLuint divisor) {
  gl.EnableVertexAttribArray(index);
  gl.VertexAttribPointer(index, size, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(stride),
                         at_offset(offset));
  gl.VertexAttribDivisor(index, divisor);
}

}  // namespace

LineBatch::LineBatch(const Gl& gl, const std::vector<LineVertex>& lines)
    : gl_(&gl), count_(static_cast<GLsizei>(lines.size())) {
  if (count_ == 0) return;
  buffer_ = make_buffer(gl);
  array_ = make_array(gl);
  gl.BindVertexArray(array_.get());
  upload(gl, GL_ARRAY_BUFFER, buffer_.get(), lines, GL_STREAM_DRAW);
  attribute(gl, 0, 3, sizeof(LineVertex), offsetof(LineVertex, from), 1);
  attribute(gl, 1, 3, sizeof(LineVertex), offsetof(LineVertex, to), 1);
  attribute(gl, 2, 4, sizeof(LineVertex), offsetof(LineVertex, ink), 1);
}

void LineBatch::draw() const {
  if (count_ == 0) return;
  gl_->BindVertexArray(array_.get());
  gl_->DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, count_);
}

GpuMesh::GpuMesh(const Gl& gl, std::shared_ptr<const TriangleMesh> source)
    : gl_(&gl), source_(std::move(source)), shape_(make_draw_mesh(*source_)) {
  vertices_ = make_buffer(gl);
  indices_ = make_buffer(gl);
  array_ = make_array(gl);
  gl.BindVertexArray(array_.get());
  upload(gl, GL_ARRAY_BUFFER, vertices_.get(), shape_.vertices, GL_STATIC_DRAW);
  upload(gl, GL_ELEMENT_ARRAY_BUFFER, indices_.get(), shape_.indices, GL_STATIC_DRAW);
  attribute(gl, 0, 3, sizeof(DrawVertex), offsetof(DrawVertex, position), 0);
  attribute(gl, 1, 3, sizeof(DrawVertex), offsetof(DrawVertex, normal), 0);
  index_count_ = static_cast<GLsizei>(shape_.indices.size());

  std::vector<std::array<float, 3>> ends;
  for (const DrawEdge& edge : shape_.edges) {
    if (!edge.crease) break;  // creases come first
    ends.push_back(edge.a);
    ends.push_back(edge.b);
  }
  crease_count_ = static_cast<GLsizei>(ends.size() / 2);
  creases_ = make_buffer(gl);
  crease_array_ = make_array(gl);
  gl.BindVertexArray(crease_array_.get());
  upload(gl, GL_ARRAY_BUFFER, creases_.get(), ends, GL_STATIC_DRAW);
  constexpr std::size_t point = sizeof(ends[0]);
  attribute(gl, 0, 3, 2 * point, 0, 1);
  attribute(gl, 1, 3, 2 * point, point, 1);
  gl.BindVertexArray(0);
  if (!may_be_small()) {
    shape_.vertices = {};
    shape_.indices = {};
  }
}

void GpuMesh::draw_triangles() const {
  if (index_count_ == 0) return;
  gl_->BindVertexArray(array_.get());
  gl_->DrawElements(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr);
}

void GpuMesh::draw_creases() const {
  if (crease_count_ == 0) return;
  gl_->BindVertexArray(crease_array_.get());
  gl_->DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, crease_count_);
}

void MeshCache::next_frame() {
  for (auto it = meshes_.begin(); it != meshes_.end();)
    it = it->second->source().use_count() == 1 ? meshes_.erase(it) : std::next(it);
}

const GpuMesh& MeshCache::get(const std::shared_ptr<const TriangleMesh>& mesh) {
  auto& entry = meshes_[mesh.get()];
  if (entry == nullptr) entry = std::make_unique<GpuMesh>(*gl_, mesh);
  return *entry;
}

}  // namespace aircut::render
