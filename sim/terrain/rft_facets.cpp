#include "sim/terrain/rft_facets.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>

namespace hoof::sim {
namespace {

/// cos 20 deg: alpha changes by less than a tenth over half of that.
constexpr double kSameNormal = 0.9397;

struct Triangle {
  Eigen::Vector3d a, b, c;
};

/// Cuts the longest side in the middle until none is longer than size_m.
void cut(const Triangle& t, double size_m, std::vector<Triangle>& out) {
  const double ab = (t.b - t.a).norm(), bc = (t.c - t.b).norm(), ca = (t.a - t.c).norm();
  if (std::max({ab, bc, ca}) <= size_m) {
    out.push_back(t);
  } else if (ab >= bc && ab >= ca) {
    const Eigen::Vector3d m = 0.5 * (t.a + t.b);
    cut({t.a, m, t.c}, size_m, out);
    cut({m, t.b, t.c}, size_m, out);
  } else if (bc >= ca) {
    const Eigen::Vector3d m = 0.5 * (t.b + t.c);
    cut({t.a, t.b, m}, size_m, out);
    cut({t.a, m, t.c}, size_m, out);
  } else {
    const Eigen::Vector3d m = 0.5 * (t.c + t.a);
    cut({t.a, t.b, m}, size_m, out);
    cut({m, t.b, t.c}, size_m, out);
  }
}

struct Sum {
  Eigen::Vector3d first_normal = Eigen::Vector3d::Zero();
  Eigen::Vector3d vector_area_m2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d moment_m3 = Eigen::Vector3d::Zero();
  double area_m2 = 0;
};

}  // namespace

std::vector<RftFacet> make_facets(const TriangleMesh& mesh, double size_m) {
  std::vector<Triangle> pieces;
  for (const auto& t : mesh.triangles) {
    const auto corner = [&](int k) { return mesh.vertices_m[std::size_t(t[std::size_t(k)])]; };
    cut({corner(0), corner(1), corner(2)}, size_m, pieces);
  }
  std::vector<Sum> sums;
  std::map<std::array<long, 3>, std::vector<std::size_t>> cells;
  for (const Triangle& t : pieces) {
    const Eigen::Vector3d vector_area = 0.5 * (t.b - t.a).cross(t.c - t.a);
    const double area = vector_area.norm();
    if (!(area > 0)) continue;
    const Eigen::Vector3d normal = vector_area / area, centre = (t.a + t.b + t.c) / 3;
    // Half a cell aside: soles and sides lie on round numbers.
    const auto cell = [&](int k) { return std::lround(std::floor(centre[k] / size_m + 0.5)); };
    std::vector<std::size_t>& here = cells[{cell(0), cell(1), cell(2)}];
    std::size_t index = sums.size();
    for (const std::size_t i : here) {
      if (sums[i].first_normal.dot(normal) > kSameNormal) {
        index = i;
        break;
      }
    }
    if (index == sums.size()) {
      here.push_back(index);
      sums.push_back({});
      sums.back().first_normal = normal;
    }
    Sum& sum = sums[index];
    sum.vector_area_m2 += vector_area;
    sum.moment_m3 += area * centre;
    sum.area_m2 += area;
  }
  if (sums.empty()) throw std::invalid_argument("a body on fast soil has no surface");
  std::vector<RftFacet> facets;
  for (const Sum& s : sums) {
    const double area = s.vector_area_m2.norm();
    facets.push_back({s.moment_m3 / s.area_m2, s.vector_area_m2 / area, area});
  }
  return facets;
}

}  // namespace hoof::sim
