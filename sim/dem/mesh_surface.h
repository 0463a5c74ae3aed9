// A triangle mesh made ready for contact, in its body's frame: what is the same at every step is
// worked out once, and a grid tells which triangles are near a point.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "sim/dem/closest_point.h"
#include "sim/dem/mesh_spot.h"
#include "sim/dem/triangle_mesh.h"

namespace hoof::sim {

class MeshSurface {
 public:
  explicit MeshSurface(const TriangleMesh& mesh);

  /// Every edge is shared by two triangles that run along it in opposite directions: the body has
  /// an inside. Other meshes are thin sheets, touched from both sides alike.
  bool closed() const { return closed_; }
  /// Of the vertices about the body's origin.
  double radius_m() const { return radius_m_; }
  const Eigen::AlignedBox3d& box() const { return box_; }
  std::size_t facet_count() const { return facets_.size(); }
  /// Which triangle of the mesh a facet is: those without area are none.
  std::uint32_t triangle(std::uint32_t facet) const { return triangles_[facet]; }

  /// False only where no triangle is within reach of p.
  bool maybe_near(const Eigen::Vector3d& p, double reach_m) const;

  /// Appends the triangles within reach of p, in rising order.
  void append_near(const Eigen::Vector3d& p, double reach_m,
                   std::vector<std::uint32_t>& facets) const;

  /// @return whether the triangle is less than reach away from p; only then is spot set.
  bool find_spot(std::uint32_t facet, const Eigen::Vector3d& p, double reach_m,
                 MeshSpot& spot) const;

 private:
  struct CellRange {
    std::array<int, 3> low, high;
  };

  void add_facets(const TriangleMesh& mesh);
  void add_normals(const TriangleMesh& mesh);
  void make_grid();
  CellRange cells_of(const Eigen::Vector3d& low, const Eigen::Vector3d& high) const;
  template <typename Visit>
  void visit_cells(const CellRange& range, const Visit& visit) const;

  std::vector<Facet> facets_;
  std::vector<std::array<std::int32_t, 3>> corners_;  // of the facets, vertex numbers of the mesh
  std::vector<std::uint32_t> triangles_;              // of the facets, their numbers in the mesh
  std::vector<std::array<Eigen::Vector3d, 6>> part_normals_;  // out of the body, of corners, edges
  bool closed_ = false;
  double radius_m_ = 0;
  Eigen::AlignedBox3d box_;

  // Grid over the box: cell c holds the facets cell_facets_[cell_begin_[c] ... cell_begin_[c + 1]).
  std::array<int, 3> cell_count_{};
  Eigen::Vector3d cells_per_m_ = Eigen::Vector3d::Zero();
  std::vector<std::uint32_t> cell_begin_, cell_facets_;
};

}  // namespace hoof::sim
