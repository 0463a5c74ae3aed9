// Walls and moving triangle meshes: what the grains touch besides each other.
//
// Only grains near a wall or a mesh take part ("boundary grains"); they are few, so their contacts
// are computed in double whatever the precision of the step.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "sim/dem/contact_law.h"
#include "sim/dem/domain.h"
#include "sim/dem/grain_record.h"
#include "sim/dem/neighbour_list.h"
#include "sim/dem/triangle_mesh.h"

namespace hoof::sim {

/// A flat wall; grains stay where normal . p > offset_m.
struct Wall {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit, into the bed
  double offset_m = 0;
};

/// Motion of a mesh over one interval: pose at its start, constant velocities.
struct MeshMotion {
  Eigen::Vector3d p_WB_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();
  Eigen::Vector3d v_WB_m_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d w_WB_rad_s = Eigen::Vector3d::Zero();
};

/// What the grains did to one mesh, summed over the steps since the last take.
struct MeshLoad {
  Eigen::Vector3d impulse_W_Ns = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_impulse_Bo_W_Nms = Eigen::Vector3d::Zero();  // about the moving origin
  double work_J = 0;
};

struct BoundarySettings {
  PairLaw<double> law{};  // grain against wall and mesh
  CoulombCap cap = CoulombCap::kTotalNormal;
  RollingLaw rolling = RollingLaw::kOwnSpin;
  std::vector<Wall> walls;
  double skin_m = 0;  // how far beyond touch a grain is looked for
};

class Boundary {
 public:
  static constexpr int kMaxMeshes = 4;

  explicit Boundary(BoundarySettings settings) : settings_(std::move(settings)) {}

  /// @return index of the mesh. At most kMaxMeshes.
  int add_mesh(const TriangleMesh& mesh);
  int mesh_count() const { return int(meshes_.size()); }
  void set_law(const PairLaw<double>& law) { settings_.law = law; }

  /// Begins an interval in which mesh i moves as motion says.
  void set_motion(int mesh, const MeshMotion& motion);

  /// Puts the meshes where they are `time_s` after the start of the interval.
  void place_meshes(double time_s);

  /// Largest speed of any vertex, m/s.
  double fastest_vertex_m_s() const;

  /// Finds the boundary grains anew. The loads gathered so far are kept.
  template <typename Real>
  void rebuild(const typename NeighbourList<Real>::Records& records, std::uint32_t count,
               const CellGrid& cells, const Domain& domain, double largest_radius_m,
               double grain_drift_m);

  /// Rows have a new order: old_row[new] = old. To be followed by rebuild.
  void reorder(const std::vector<std::uint32_t>& old_row);

  /// Forces on the boundary grains of the groups [begin, end). Meshes must be placed.
  template <typename Real>
  void compute(const GrainRecord<Real>* records, const Domain& domain, double dt_s,
               std::uint32_t group_begin, std::uint32_t group_end);

  template <typename Real>
  const std::vector<BoundaryForce<Real>, AlignedAllocator<BoundaryForce<Real>>>& forces() const;
  const std::vector<std::int32_t>& force_of_group() const { return force_of_group_; }

  /// Load on mesh i since the last take; sums in row order, so independent of the threads.
  MeshLoad take_load(int mesh);

  /// Tangential displacement of a grain on wall w; for saving and loading beds.
  bool wall_history(std::uint32_t row, int wall, Eigen::Vector3d& xi_m) const;
  void set_wall_history(std::uint32_t row, int wall, const Eigen::Vector3d& xi_m);

  /// Largest overlap over grain radius seen since the last call, and the grain that had it.
  double take_deepest_ratio();

 private:
  static constexpr int kMaxContacts = 8;

  struct Mesh {
    TriangleMesh mesh;
    std::uint32_t first_vertex = 0;  // in vertices_
    double radius_m = 0;             // of the vertices about the origin
    MeshMotion motion;
    Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();  // now
    MeshLoad load;                                       // flushed part
  };
  struct Triangle {
    std::int32_t mesh;
    std::uint32_t a, b, c;  // in vertices_
  };
  struct Memory {          // one contact of the last step
    std::int32_t partner;  // wall w: -1 - w; mesh m: m
    Eigen::Vector3d n, xi_m;
  };
  struct BoundaryGrain {
    std::uint32_t row = 0;
    std::uint32_t walls = 0;  // bit per wall within reach
    std::uint32_t triangle_begin = 0, triangle_end = 0;
    std::int32_t load = -1;  // index of its loads, if it is near a mesh
    int contacts = 0;
    std::array<Memory, kMaxContacts> memory;
  };
  struct Load {
    std::array<MeshLoad, kMaxMeshes> of_mesh;
    double deepest_ratio = 0;
  };
  struct Found {
    double distance_m;
    Eigen::Vector3d point_m;
    std::int32_t mesh;
  };
  struct Grain;  // one grain's state and sums while it is worked on

  template <typename Real>
  void list_walls(const typename NeighbourList<Real>::Records& records, std::uint32_t count,
                  const Domain& domain);
  template <typename Real>
  void list_triangles(const typename NeighbourList<Real>::Records& records, const CellGrid& cells,
                      const Domain& domain, double largest_radius_m, double grain_drift_m);
  void merge_lists(std::uint32_t group_count);
  void carry_memory();
  void flush_loads();
  void touch_walls(BoundaryGrain& b, Grain& g);
  void touch_meshes(BoundaryGrain& b, Grain& g, const Domain& domain);
  void touch_point(const BoundaryGrain& b, std::int32_t partner, const Eigen::Vector3d& n,
                   double delta_m, const Eigen::Vector3d& v_point_m_s, Grain& g);
  Eigen::Vector3d remembered(const BoundaryGrain& b, std::int32_t partner,
                             const Eigen::Vector3d& n) const;

  BoundarySettings settings_;
  std::vector<Mesh> meshes_;
  std::vector<Triangle> triangles_;
  std::vector<Eigen::Vector3d> vertices_m_;  // world, now
  std::vector<BoundaryGrain> grains_, old_grains_;
  std::vector<std::uint32_t> grain_begin_;  // per group: first of its boundary grains
  std::vector<std::uint32_t> near_triangles_;
  std::vector<Load> loads_;
  std::vector<std::int32_t> force_of_group_;
  std::vector<BoundaryForce<float>, AlignedAllocator<BoundaryForce<float>>> forces_float_;
  std::vector<BoundaryForce<double>, AlignedAllocator<BoundaryForce<double>>> forces_double_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> wall_pairs_, triangle_pairs_;
  double deepest_ratio_ = 0;
};

}  // namespace hoof::sim
