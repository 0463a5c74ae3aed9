#include "sim/terrain/rft_facets.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hoof::sim {
namespace {

/// cos 20 deg: alpha changes by less than a tenth over half of that.
constexpr double kSameNormal = 0.9397;
/// A facet is no further off a plane than this share of its reach: 20 degrees from edge to middle.
constexpr double kLevel = 0.36;

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

struct Cluster {
  Eigen::Vector3d seed_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d seed_normal = Eigen::Vector3d::Zero();
  Eigen::Vector3d vector_area_m2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d moment_m3 = Eigen::Vector3d::Zero();
  double area_m2 = 0;

  void add(const Eigen::Vector3d& piece_area_m2, const Eigen::Vector3d& centre_m) {
    vector_area_m2 += piece_area_m2;
    moment_m3 += piece_area_m2.norm() * centre_m;
    area_m2 += piece_area_m2.norm();
  }
};

/// The nearest cluster that a piece may join, or the end.
std::size_t find_cluster(const std::vector<Cluster>& clusters, const Eigen::Vector3d& centre_m,
                         const Eigen::Vector3d& normal, double reach_m) {
  std::size_t nearest = clusters.size();
  double least_m2 = reach_m * reach_m;
  for (std::size_t i = 0; i < clusters.size(); ++i) {
    const Eigen::Vector3d way_m = centre_m - clusters[i].seed_m;
    const double distance_m2 = way_m.squaredNorm();
    // The tip of a spine looks down as the sole beside it does, but deeper in the sand.
    const bool level = std::abs(way_m.dot(clusters[i].seed_normal)) < kLevel * reach_m;
    if (level && distance_m2 < least_m2 && clusters[i].seed_normal.dot(normal) > kSameNormal) {
      nearest = i, least_m2 = distance_m2;
    }
  }
  return nearest;
}

}  // namespace

std::vector<RftFacet> make_facets(const TriangleMesh& mesh, double size_m) {
  std::vector<Triangle> pieces;
  for (const auto& t : mesh.triangles) {
    const auto corner = [&](int k) { return mesh.vertices_m[std::size_t(t[std::size_t(k)])]; };
    cut({corner(0), corner(1), corner(2)}, 0.5 * size_m, pieces);
  }
  std::vector<Cluster> clusters;
  for (const Triangle& t : pieces) {
    const Eigen::Vector3d vector_area = 0.5 * (t.b - t.a).cross(t.c - t.a);
    if (!(vector_area.norm() > 0)) continue;
    const Eigen::Vector3d normal = vector_area.normalized(), centre = (t.a + t.b + t.c) / 3;
    const std::size_t found = find_cluster(clusters, centre, normal, 0.5 * size_m);
    if (found == clusters.size()) clusters.push_back({centre, normal});
    clusters[found].add(vector_area, centre);
  }
  if (clusters.empty()) throw std::invalid_argument("a body on fast soil has no surface");
  std::vector<RftFacet> facets;
  for (const Cluster& c : clusters) {
    const double area = c.vector_area_m2.norm();
    facets.push_back({c.moment_m3 / c.area_m2, c.vector_area_m2 / area, area});
  }
  return facets;
}

}  // namespace hoof::sim
