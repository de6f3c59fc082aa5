// Meshes and lines on the graphics side.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "render/draw_mesh.h"
#include "render/gl.h"

namespace aircut::render {

/// Line instances as the line program wants them.
struct LineVertex {
  std::array<float, 3> from, to;
  std::array<float, 4> ink;  ///< display colour and opacity
};

/// Lines that change with every frame.
class LineBatch {
 public:
  LineBatch(const Gl& gl, const std::vector<LineVertex>& lines);
  void draw() const;
  bool empty() const { return count_ == 0; }

 private:
  const Gl* gl_;
  GlBuffer buffer_;
  GlArray array_;
  GLsizei count_ = 0;
};

class GpuMesh {
 public:
  GpuMesh(const Gl& gl, std::shared_ptr<const TriangleMesh> source);

  /// Many triangles without a rim: `shape` keeps vertices and indices, for SmallTriangles.
  bool may_be_small() const { return shape_.closed && index_count_ >= 3 * 300; }
  int triangles() const { return index_count_ / 3; }
  void draw_triangles() const;
  /// The ink is the constant attribute 2.
  void draw_creases() const;
  const DrawMesh& shape() const { return shape_; }
  const std::shared_ptr<const TriangleMesh>& source() const { return source_; }

 private:
  const Gl* gl_;
  std::shared_ptr<const TriangleMesh> source_;  // keeps the address taken
  DrawMesh shape_;
  GlBuffer vertices_, indices_, creases_;
  GlArray array_, crease_array_;
  GLsizei index_count_ = 0, crease_count_ = 0;
};

/// Uploaded meshes by the address of their source.
class MeshCache {
 public:
  explicit MeshCache(const Gl& gl) : gl_(&gl) {}
  /// Starts a frame: lets go of meshes that nobody else holds.
  void next_frame();
  const GpuMesh& get(const std::shared_ptr<const TriangleMesh>& mesh);
  std::size_t size() const { return meshes_.size(); }

 private:
  const Gl* gl_;
  std::map<const TriangleMesh*, std::unique_ptr<GpuMesh>> meshes_;
};

}  // namespace aircut::render
