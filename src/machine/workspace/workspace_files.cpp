#include "machine/workspace/workspace_files.h"

#include <array>

namespace aircut::machine {

namespace {

template <class See>
void each_point(const Workspace& w, See&& see) {
  const auto [nx, ny, nz] = w.count();
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) see(i, j, k);
}

// Beyond the grid nothing is reached.
bool reached(const Workspace& w, const std::array<int, 3>& p) {
  for (std::size_t a = 0; a < 3; ++a)
    if (p[a] < 0 || p[a] >= w.count()[a]) return false;
  return w.in(p[0], p[1], p[2]);
}

}  // namespace

std::string workspace_csv(const Workspace& w) {
  std::string out = "x_mm,y_mm,z_mm,reached\n";
  each_point(w, [&](int i, int j, int k) {
    const Vec3 p = w.place(i, j, k);
    for (int a = 0; a < 3; ++a) {
      append_shortest(out, p[a]);
      out += ',';
    }
    out += w.in(i, j, k) ? "1\n" : "0\n";
  });
  return out;
}

std::string workspace_npy(const Workspace& w) {
  const auto [nx, ny, nz] = w.count();
  std::string head = "{'descr': '|u1', 'fortran_order': False, 'shape': (" + std::to_string(nz) +
                     ", " + std::to_string(ny) + ", " + std::to_string(nx) + "), }";
  constexpr std::size_t preamble = 10, line = 64;  // the data start at a multiple of 64
  while ((preamble + head.size() + 1) % line != 0) head += ' ';
  head += '\n';
  std::string out("\x93NUMPY\x01\x00", 8);
  out += static_cast<char>(head.size() & 255);
  out += static_cast<char>(head.size() >> 8);
  out += head;
  each_point(w, [&](int i, int j, int k) { out += w.in(i, j, k) ? '\1' : '\0'; });
  return out;
}

TriangleMesh workspace_solid(const Workspace& w) {
  TriangleMesh mesh;
  const double half = w.pitch() / 2;
  each_point(w, [&](int i, int j, int k) {
    const std::array<int, 3> here = {i, j, k};
    if (!reached(w, here)) return;
    const Vec3 middle = w.place(i, j, k);
    for (std::size_t a = 0; a < 3; ++a)
      for (const int side : {-1, 1}) {
        std::array<int, 3> beside = here;
        beside[a] += side;
        if (reached(w, beside)) continue;
        const auto axis = static_cast<Eigen::Index>(a);
        // u, v and the outward direction are right-handed.
        const Vec3 out = side * half * Vec3::Unit(axis);
        const Vec3 u = half * Vec3::Unit((axis + 1) % 3);
        const Vec3 v = side * half * Vec3::Unit((axis + 2) % 3);
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        for (const auto& [su, sv] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}})
          mesh.vertices.push_back(middle + out + su * u + sv * v);
        mesh.triangles.push_back({first, first + 1, first + 2});
        mesh.triangles.push_back({first, first + 2, first + 3});
      }
  });
  return mesh;
}

}  // namespace aircut::machine
