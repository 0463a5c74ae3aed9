#include "sim/dem/mesh_surface.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

namespace hoof::sim {
namespace {

constexpr int kMostCells = 64;  // along an axis: a megabyte of grid at most

double angle_at(const Eigen::Vector3d& corner, const Eigen::Vector3d& one,
                const Eigen::Vector3d& other) {
  const Eigen::Vector3d u = one - corner, v = other - corner;
  return std::atan2(u.cross(v).norm(), u.dot(v));
}

}  // namespace

MeshSurface::MeshSurface(const TriangleMesh& mesh) {
  for (const Eigen::Vector3d& v : mesh.vertices_m) {
    radius_m_ = std::max(radius_m_, v.norm());
    box_.extend(v);
  }
  add_facets(mesh);
  add_normals(mesh);
  make_grid();
}

void MeshSurface::add_facets(const TriangleMesh& mesh) {
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& t = mesh.triangles[i];
    const Eigen::Vector3d &a = mesh.vertices_m[std::size_t(t[0])],
                          &b = mesh.vertices_m[std::size_t(t[1])],
                          &c = mesh.vertices_m[std::size_t(t[2])];
    // A triangle without area has no normal, and all of it lies on edges of its neighbours.
    if ((b - a).cross(c - a).squaredNorm() == 0) continue;
    facets_.emplace_back(a, b, c);
    corners_.push_back(t);
    triangles_.push_back(std::uint32_t(i));
  }
  if (facets_.empty()) throw std::invalid_argument("a mesh needs a triangle that has an area");
}

/// The sign of to_p . normal tells inside from outside at the point of the surface closest to p if
/// an edge has the sum of its faces' normals and a corner their sum weighted by angle.
/// Source: J. A. Baerentzen, H. Aanaes, IEEE TVCG 11(3), 2005, 243-253.
void MeshSurface::add_normals(const TriangleMesh& mesh) {
  using Edge = std::pair<std::int32_t, std::int32_t>;
  struct Side {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    int facets = 0;
  };
  std::map<Edge, Side> side_of;  // of directed edges
  std::vector<Eigen::Vector3d> corner_normal(mesh.vertices_m.size(), Eigen::Vector3d::Zero());
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    const auto& t = corners_[f];
    for (int k = 0; k < 3; ++k) {
      const std::int32_t v = t[k], next = t[(k + 1) % 3], last = t[(k + 2) % 3];
      Side& side = side_of[{v, next}];
      side.normal += facets_[f].normal;
      ++side.facets;
      corner_normal[std::size_t(v)] +=
          angle_at(mesh.vertices_m[std::size_t(v)], mesh.vertices_m[std::size_t(next)],
                   mesh.vertices_m[std::size_t(last)]) *
          facets_[f].normal;
    }
  }
  closed_ = std::all_of(side_of.begin(), side_of.end(), [&](const auto& entry) {
    const auto opposite = side_of.find({entry.first.second, entry.first.first});
    return entry.second.facets == 1 && opposite != side_of.end();
  });
  if (!closed_) return;
  for (const auto& t : corners_) {
    std::array<Eigen::Vector3d, 6> normals;
    for (int k = 0; k < 3; ++k) {
      const std::int32_t v = t[k], next = t[(k + 1) % 3];
      normals[std::size_t(k)] = corner_normal[std::size_t(v)];
      normals[std::size_t(3 + k)] = side_of[{v, next}].normal + side_of[{next, v}].normal;
    }
    part_normals_.push_back(normals);
  }
}

void MeshSurface::make_grid() {
  // Cells about as wide as the triangles: few triangles in a cell, few cells to a triangle.
  double area_m2 = 0;
  for (const Facet& f : facets_) area_m2 += 0.5 * f.ab.cross(f.ac).norm();
  const double width_m =
      std::max(std::sqrt(area_m2 / double(facets_.size())), box_.sizes().maxCoeff() / kMostCells);
  for (int axis = 0; axis < 3; ++axis) {
    cells_per_m_[axis] = 1 / width_m;
    // The same product as in cells_of(), so that the box's far corner lies in the last cell.
    cell_count_[std::size_t(axis)] = int(box_.sizes()[axis] * cells_per_m_[axis]) + 1;
  }
  const auto cells_of_facet = [&](const Facet& f) {
    const Eigen::Vector3d b = f.a + f.ab, c = f.a + f.ac;
    return cells_of(f.a.cwiseMin(b).cwiseMin(c), f.a.cwiseMax(b).cwiseMax(c));
  };
  const auto cells =
      std::size_t(cell_count_[0]) * std::size_t(cell_count_[1]) * std::size_t(cell_count_[2]);
  std::vector<std::uint32_t> filled(cells + 1, 0);
  for (const Facet& f : facets_) {
    visit_cells(cells_of_facet(f), [&](std::size_t c) { return ++filled[c + 1], true; });
  }
  for (std::size_t c = 0; c < cells; ++c) filled[c + 1] += filled[c];
  cell_begin_ = filled;
  cell_facets_.resize(cell_begin_.back());
  for (std::uint32_t f = 0; f < facets_.size(); ++f) {
    visit_cells(cells_of_facet(facets_[f]),
                [&](std::size_t c) { return cell_facets_[filled[c]++] = f, true; });
  }
}

MeshSurface::CellRange MeshSurface::cells_of(const Eigen::Vector3d& low,
                                             const Eigen::Vector3d& high) const {
  CellRange range;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = Eigen::Index(axis);
    const auto cell = [&](double x) {
      const double c = std::floor((x - box_.min()[i]) * cells_per_m_[i]);
      return int(std::clamp(c, -1.0, double(cell_count_[axis])));
    };
    range.low[axis] = std::max(cell(low[i]), 0);
    range.high[axis] = std::min(cell(high[i]), cell_count_[axis] - 1);
  }
  return range;
}

/// Until visit returns false.
template <typename Visit>
void MeshSurface::visit_cells(const CellRange& range, const Visit& visit) const {
  for (int z = range.low[2]; z <= range.high[2]; ++z) {
    for (int y = range.low[1]; y <= range.high[1]; ++y) {
      const std::size_t line = (std::size_t(z) * std::size_t(cell_count_[1]) + std::size_t(y)) *
                               std::size_t(cell_count_[0]);
      for (int x = range.low[0]; x <= range.high[0]; ++x) {
        if (!visit(line + std::size_t(x))) return;
      }
    }
  }
}

bool MeshSurface::maybe_near(const Eigen::Vector3d& p, double reach_m) const {
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(reach_m);
  bool near = false;
  visit_cells(cells_of(p - reach, p + reach), [&](std::size_t c) {
    near = cell_begin_[c] != cell_begin_[c + 1];
    return !near;
  });
  return near;
}

void MeshSurface::append_near(const Eigen::Vector3d& p, double reach_m,
                              std::vector<std::uint32_t>& facets) const {
  const auto first = std::ptrdiff_t(facets.size());
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(reach_m);
  visit_cells(cells_of(p - reach, p + reach), [&](std::size_t c) {
    facets.insert(facets.end(), cell_facets_.begin() + cell_begin_[c],
                  cell_facets_.begin() + cell_begin_[c + 1]);
    return true;
  });
  std::sort(facets.begin() + first, facets.end());
  facets.erase(std::unique(facets.begin() + first, facets.end()), facets.end());
  const auto is_far = [&](std::uint32_t f) {
    return closest_point(facets_[f], p).to_p_m.squaredNorm() >= reach_m * reach_m;
  };
  facets.erase(std::remove_if(facets.begin() + first, facets.end(), is_far), facets.end());
}

bool MeshSurface::find_spot(std::uint32_t facet, const Eigen::Vector3d& p, double reach_m,
                            MeshSpot& spot) const {
  const Facet& f = facets_[facet];
  const double height_m = f.normal.dot(p - f.a);
  if (std::abs(height_m) >= reach_m) return false;  // settles most that are listed, at little cost
  const ClosestPoint closest = closest_point(f, p);
  if (closest.part == FacetPart::kInside) {
    const bool out = closed_ || height_m >= 0;
    spot.normal = out ? f.normal : Eigen::Vector3d(-f.normal);
    spot.distance_m = out ? height_m : -height_m;
  } else {
    const double distance_m = closest.to_p_m.norm();
    if (distance_m >= reach_m || distance_m == 0) return false;
    const bool inside =
        closed_ && part_normals_[facet][std::size_t(closest.part)].dot(closest.to_p_m) < 0;
    spot.distance_m = inside ? -distance_m : distance_m;
    spot.normal = closest.to_p_m / spot.distance_m;
  }
  spot.facet = facet;
  spot.on_border = closest.part != FacetPart::kInside;
  spot.to_centre_m = closest.to_p_m;
  spot.point_m = p - closest.to_p_m;
  return true;
}

}  // namespace hoof::sim
