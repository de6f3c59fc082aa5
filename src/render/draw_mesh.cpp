// Crease normals and feature edges, linear in the number of triangles.
//
// Vertices at exactly the same place are one. Every edge is found twice or more by listing, per
// vertex, the edges to vertices of larger number. Two triangles that meet at less than `crease`
// share the normals of their common corners: those corners are united (union-find), and a group's
// normal is the sum of its triangles' normals, weighted by area times corner angle. The area keeps
// a large flat face flat beside the narrow facets of a fillet; the angle makes the result
// independent of how a face is cut into triangles.
//
//        flat |\   < crease: one normal per corner group, looks round
//             | \_
//             |   \_____   > crease: two groups, a sharp corner and a drawn line
#include "render/draw_mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace aircut::render {
namespace {

// cos 31°: a cylinder of 12 facets (30° each) still counts as round.
constexpr double cos_crease = 0.857;
// cos 0.5°: triangles of one plane, as exported in 32-bit floats.
constexpr double cos_flat = 0.99996;

using Triangle = std::array<std::uint32_t, 3>;

struct Faces {
  std::vector<Vec3> points;  // distinct places
  std::vector<Triangle> triangles;
  std::vector<Vec3> normals;  // unit, per triangle
  std::vector<double> areas;
};

bool smaller(const Vec3& a, const Vec3& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

// Number of each vertex's place, places in order of coordinates.
std::vector<std::uint32_t> number_places(const std::vector<Vec3>& vertices,
                                         std::vector<Vec3>& places) {
  std::vector<std::uint32_t> order(vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t i, std::uint32_t j) { return smaller(vertices[i], vertices[j]); });
  std::vector<std::uint32_t> place(vertices.size());
  for (const std::uint32_t i : order) {
    if (places.empty() || places.back() != vertices[i]) places.push_back(vertices[i]);
    place[i] = static_cast<std::uint32_t>(places.size() - 1);
  }
  return place;
}

bool is_drawable(const TriangleMesh& mesh, const Triangle& t) {
  return std::all_of(t.begin(), t.end(), [&](std::uint32_t i) {
    return i < mesh.vertices.size() && mesh.vertices[i].allFinite();
  });
}

Faces make_faces(const TriangleMesh& mesh) {
  Faces out;
  TriangleMesh finite;  // a NaN has no place in an order
  finite.vertices = mesh.vertices;
  for (Vec3& v : finite.vertices)
    if (!v.allFinite()) v = Vec3::Zero();
  const auto place = number_places(finite.vertices, out.points);
  for (const auto& t : mesh.triangles) {
    if (!is_drawable(mesh, t)) continue;
    const Triangle p = {place[t[0]], place[t[1]], place[t[2]]};
    const Vec3 twice_area =
        (out.points[p[1]] - out.points[p[0]]).cross(out.points[p[2]] - out.points[p[0]]);
    const double length = twice_area.norm();
    if (!(length > 0) || !std::isfinite(length)) continue;
    out.triangles.push_back(p);
    out.normals.emplace_back(twice_area / length);
    out.areas.push_back(length / 2);
  }
  return out;
}

// One use of an edge by a triangle: corner `from` to corner from + 1.
struct EdgeUse {
  std::uint32_t other = 0;   // the larger vertex number
  std::uint32_t corner = 0;  // 3 · triangle + from
  bool forward = false;      // runs from the smaller to the larger vertex
};

struct EdgeTable {
  std::vector<std::uint32_t> first;  // by smaller vertex number, into uses
  std::vector<EdgeUse> uses;
};

EdgeTable make_edge_table(const Faces& faces) {
  EdgeTable out;
  out.first.assign(faces.points.size() + 1, 0);
  const auto ends = [&](std::size_t t, unsigned k) {
    return std::pair{faces.triangles[t][k], faces.triangles[t][(k + 1) % 3]};
  };
  for (std::size_t t = 0; t < faces.triangles.size(); ++t)
    for (unsigned k = 0; k < 3; ++k) {
      const auto [a, b] = ends(t, k);
      ++out.first[std::min(a, b) + 1];
    }
  std::partial_sum(out.first.begin(), out.first.end(), out.first.begin());
  out.uses.resize(out.first.back());
  std::vector<std::uint32_t> next(out.first.begin(), out.first.end() - 1);
  for (std::size_t t = 0; t < faces.triangles.size(); ++t)
    for (unsigned k = 0; k < 3; ++k) {
      const auto [a, b] = ends(t, k);
      out.uses[next[std::min(a, b)]++] = {std::max(a, b), static_cast<std::uint32_t>(3 * t + k),
                                          a < b};
    }
  for (std::size_t v = 0; v + 1 < out.first.size(); ++v)
    std::sort(out.uses.begin() + out.first[v], out.uses.begin() + out.first[v + 1],
              [](const EdgeUse& x, const EdgeUse& y) {
                return std::pair(x.other, x.corner) < std::pair(y.other, y.corner);
              });
  return out;
}

class Groups {
 public:
  explicit Groups(std::size_t size) : parent_(size) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  // The smaller number leads, so that the result does not depend on the order of calls.
  void unite(std::uint32_t i, std::uint32_t j) {
    i = find(i);
    j = find(j);
    if (i != j) parent_[std::max(i, j)] = std::min(i, j);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

std::array<float, 3> to_float(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

std::uint32_t next_corner(std::uint32_t corner) {
  return corner % 3 == 2 ? corner - 2 : corner + 1;
}

// One edge with all its uses: unites corners over a smooth edge, lists it unless it is flat.
void take_edge(const Faces& faces, std::uint32_t vertex, const EdgeUse* use, std::size_t count,
               Groups& groups, DrawMesh& out) {
  const bool pair = count == 2 && use[0].forward != use[1].forward;
  if (!pair) out.closed = false;
  const std::size_t t1 = use[0].corner / 3, t2 = use[count - 1].corner / 3;
  const Vec3 &n1 = faces.normals[t1], &n2 = faces.normals[t2];
  const double cos_angle = pair ? n1.dot(n2) : -1;
  if (cos_angle > cos_crease) {
    // The two triangles run along the edge in opposite ways.
    groups.unite(use[0].corner, next_corner(use[1].corner));
    groups.unite(use[1].corner, next_corner(use[0].corner));
  }
  if (cos_angle > cos_flat) return;
  out.edges.push_back({to_float(faces.points[vertex]), to_float(faces.points[use[0].other]),
                       to_float(n1), to_float(n2), cos_angle <= cos_crease});
}

double corner_angle(const Faces& faces, std::uint32_t corner) {
  const Triangle& t = faces.triangles[corner / 3];
  const unsigned k = corner % 3;
  const Vec3 u = faces.points[t[(k + 1) % 3]] - faces.points[t[k]];
  const Vec3 v = faces.points[t[(k + 2) % 3]] - faces.points[t[k]];
  return std::atan2(u.cross(v).norm(), u.dot(v));
}

void emit_vertices(const Faces& faces, Groups& groups, DrawMesh& out) {
  const std::size_t corners = 3 * faces.triangles.size();
  std::vector<Vec3> normal(corners, Vec3::Zero());
  for (std::uint32_t c = 0; c < corners; ++c)
    normal[groups.find(c)] += faces.normals[c / 3] * faces.areas[c / 3] * corner_angle(faces, c);
  constexpr std::uint32_t none = ~0u;
  std::vector<std::uint32_t> index(corners, none);
  out.indices.reserve(corners);
  for (std::uint32_t c = 0; c < corners; ++c) {
    const std::uint32_t g = groups.find(c);
    if (index[g] == none) {
      index[g] = static_cast<std::uint32_t>(out.vertices.size());
      const double length = normal[g].norm();
      const Vec3 n = length > 0 ? Vec3(normal[g] / length) : faces.normals[c / 3];
      out.vertices.push_back({to_float(faces.points[faces.triangles[c / 3][c % 3]]), to_float(n)});
    }
    out.indices.push_back(index[g]);
  }
}

double signed_volume(const Faces& faces, const Vec3& about) {
  double six = 0;
  for (const Triangle& t : faces.triangles)
    six += (faces.points[t[0]] - about)
               .dot((faces.points[t[1]] - about).cross(faces.points[t[2]] - about));
  return six / 6;
}

}  // namespace

DrawMesh make_draw_mesh(const TriangleMesh& mesh) {
  const Faces faces = make_faces(mesh);
  DrawMesh out;
  if (faces.triangles.empty()) return out;
  for (const Triangle& t : faces.triangles)
    for (const std::uint32_t i : t) out.box.extend(faces.points[i]);
  out.area = std::accumulate(faces.areas.begin(), faces.areas.end(), 0.0);
  const EdgeTable table = make_edge_table(faces);
  Groups groups(3 * faces.triangles.size());
  out.closed = true;
  for (std::uint32_t v = 0; v + 1 < table.first.size(); ++v)
    for (std::size_t i = table.first[v]; i < table.first[v + 1];) {
      std::size_t end = i + 1;
      while (end < table.first[v + 1] && table.uses[end].other == table.uses[i].other) ++end;
      take_edge(faces, v, &table.uses[i], end - i, groups, out);
      i = end;
    }
  std::stable_partition(out.edges.begin(), out.edges.end(),
                        [](const DrawEdge& e) { return e.crease; });
  emit_vertices(faces, groups, out);
  out.closed = out.closed && signed_volume(faces, out.box.center()) > 0;
  return out;
}

}  // namespace aircut::render
