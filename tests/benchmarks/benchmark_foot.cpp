#include "tests/benchmarks/benchmark_foot.h"

#include <array>
#include <vector>

namespace hoof::benchmarks {

using hoof::sim::TriangleMesh;

TriangleMesh foot_mesh() {
  const std::array<int, 3> cells = {30, 15, 20};
  const Eigen::Vector3d size_m(0.06, 0.03, 0.04);
  TriangleMesh mesh;
  std::vector<std::int32_t> number(31 * 16 * 21, -1);
  const auto vertex = [&](std::array<int, 3> at) {
    std::int32_t& v = number[std::size_t((at[2] * 16 + at[1]) * 31 + at[0])];
    if (v < 0) {
      v = std::int32_t(mesh.vertices_m.size());
      Eigen::Vector3d p(at[0] / 30.0 - 0.5, at[1] / 15.0 - 0.5, at[2] / 20.0);
      p = p.cwiseProduct(size_m);
      const double rise_m = 5 * p.head<2>().squaredNorm();  // sole of radius 100 mm
      p.z() += rise_m * (1 - p.z() / size_m.z());
      mesh.vertices_m.push_back(p);
    }
    return v;
  };
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const bool far : {false, true}) {
      for (int i = 0; i < cells[std::size_t(u)]; ++i) {
        for (int j = 0; j < cells[std::size_t(v)]; ++j) {
          const auto corner = [&](int di, int dj) {
            std::array<int, 3> at{};
            at[std::size_t(axis)] = far ? cells[std::size_t(axis)] : 0;
            at[std::size_t(u)] = i + di, at[std::size_t(v)] = j + dj;
            return vertex(at);
          };
          const std::int32_t a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
          if (far) {
            mesh.triangles.push_back({a, b, c}), mesh.triangles.push_back({a, c, d});
          } else {
            mesh.triangles.push_back({a, c, b}), mesh.triangles.push_back({a, d, c});
          }
        }
      }
    }
  }
  return mesh;
}

}  // namespace hoof::benchmarks
