// Walls and moving triangle meshes: what the grains touch besides each other.
//
// Few grains do. They are found in two stages: candidates, near enough to be worth watching, by a
// pass over the whole bed that is seldom needed; and from these, often, the grains that a small
// skin lets touch. Both stages know how far grains and meshes can have moved and renew themselves.
// The contacts are few too, so they are computed in double whatever the precision of the step.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "sim/dem/aligned_allocator.h"
#include "sim/dem/byte_archive.h"
#include "sim/dem/contact_energy.h"
#include "sim/dem/contact_law.h"
#include "sim/dem/domain.h"
#include "sim/dem/grain_record.h"
#include "sim/dem/mesh_surface.h"
#include "sim/dem/triangle_mesh.h"
#include "sim/dem/vec3.h"

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

/// One spot where a grain touches a mesh at this moment, as the grain feels it.
struct MeshTouch {
  std::uint32_t grain = 0;  // id
  std::uint32_t mesh = 0;
  std::uint32_t triangle = 0;  // of the mesh
  double overlap_m = 0;
  Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();       // on the surface
  Eigen::Vector3d to_grain_m = Eigen::Vector3d::Zero();  // from there to the grain's centre
  Eigen::Vector3d f_normal_N = Eigen::Vector3d::Zero();
  Eigen::Vector3d f_tangential_N = Eigen::Vector3d::Zero();
};

struct BoundarySettings {
  PairLaw<double> law{};  // grain against wall and mesh
  CoulombCap cap = CoulombCap::kTotalNormal;
  RollingLaw rolling = RollingLaw::kOwnSpin;
  std::vector<Wall> walls;
  double skin_m = 0;            // how far beyond touch a grain is looked for
  bool account_energy = false;  // energy() costs some time at every contact
};

/// A step is: prepare, compute (from several threads at once, each its own groups), advance.
class Boundary {
 public:
  static constexpr int kMaxMeshes = 4;
  template <typename Real>
  using Forces = std::vector<BoundaryForce<Real>, AlignedAllocator<BoundaryForce<Real>>>;

  explicit Boundary(BoundarySettings settings) : settings_(std::move(settings)) {}

  /// @return index of the mesh. At most kMaxMeshes.
  int add_mesh(const TriangleMesh& mesh);
  int mesh_count() const { return int(meshes_.size()); }
  void set_law(const PairLaw<double>& law) { settings_.law = law; }
  void set_skin(double skin_m) { settings_.skin_m = skin_m; }

  /// Begins an interval in which mesh i moves as motion says.
  void set_motion(int mesh, const MeshMotion& motion);

  /// Puts the meshes where they are `time_s` after the start of the interval, and makes the lists
  /// anew where grains or meshes have moved too far for them. The records hold `count` grains,
  /// always the same ones.
  template <typename Real>
  void prepare(const GrainRecord<Real>* records, std::uint32_t count, const Domain& domain,
               double time_s);

  /// Forces on the boundary grains of the groups [begin, end).
  template <typename Real>
  void compute(const GrainRecord<Real>* records, const Domain& domain, double dt_s,
               std::uint32_t group_begin, std::uint32_t group_end);

  /// To be called after the grains have moved: none by more than this.
  void advance(double furthest_m);

  /// Rows have a new order: old_row[new] = old.
  void reorder(const std::vector<std::uint32_t>& old_row);

  template <typename Real>
  const Forces<Real>& forces() const;
  const std::vector<std::int32_t>& force_of_group() const { return force_of_group_; }

  /// Load on mesh i since the last take; sums in row order, so independent of the threads.
  MeshLoad take_load(int mesh);
  /// Work in the loads of all meshes that were not taken yet, J.
  double pending_work_J() const;

  /// All spots where grains touch meshes, by grain, with the meshes where they are `time_s` after
  /// the start of the interval: forces by the law from places, speeds and histories as they stand.
  /// Changes nothing. After a step, with the records that it left.
  template <typename Real>
  std::vector<MeshTouch> mesh_touches(const GrainRecord<Real>* records, const Domain& domain,
                                      double time_s) const;

  /// Tangential displacement of a grain on wall w; for saving and loading beds.
  bool wall_history(std::uint32_t row, int wall, Eigen::Vector3d& xi_m) const;
  void set_wall_history(std::uint32_t row, int wall, const Eigen::Vector3d& xi_m);

  /// Energy of the contacts with walls and meshes: stored at the last step, lost so far; sums in
  /// row order. Of rolling friction by a grain's own spin, which the step applies as one brake for
  /// all its contacts, this is what walls and meshes alone would take. All zero unless switched on.
  ContactEnergy energy() const;

  /// Everything that decides what comes next, but settings and meshes, which the boundary that
  /// loads must have been given alike. @throws std::runtime_error if it has not, or if the bytes
  /// end too early
  void save(ByteWriter& out) const;
  template <typename Real>
  void load(ByteReader& in);

  /// Largest overlap with a mesh over grain radius seen since the last call.
  double take_deepest_ratio();

 private:
  static constexpr int kMaxContacts = 8;  // with meshes, of one grain, that are remembered

  struct Pose {
    Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
    Eigen::Matrix3d R_WB = Eigen::Matrix3d::Identity();
  };
  struct Mesh {
    MeshSurface surface;
    MeshMotion motion;
    Pose now, at_search, at_listing;
    MeshLoad load;  // of contacts that are listed no longer
  };
  struct Candidate {
    std::uint32_t row;
    std::uint32_t walls, meshes;  // a bit each
    WholeSteps listed_at;
  };
  struct NearGrain {
    std::uint32_t row;
    std::uint32_t wall_begin, wall_end;    // in wall_contacts_
    std::uint32_t patch_begin, patch_end;  // in patches_
    std::int32_t memory;                   // in memories_, if it has patches
    std::int32_t force;                    // in forces
    std::uint32_t account;                 // in energies_
    WholeSteps listed_at;
  };
  struct Account {  // of one contact at the last step, only if energy is accounted
    double damping_N = 0;
    Vec3<double> f_tangential_N{};
    double stored_tangential_J = 0;
  };
  struct WallContact {
    std::int32_t wall;
    std::int32_t touching;
    Vec3<double> xi_m;
  };
  struct Load {
    Vec3<double> impulse_Ns, angular_impulse_Nms;
    double work_J;
    double deepest_ratio;
  };
  struct Patch {  // triangles of one mesh near one grain
    std::uint32_t mesh;
    std::uint32_t facet_begin, facet_end;  // in near_facets_
    Vec3<double> p_m;                      // the grain's image near the mesh, when listed
    Load load;
  };
  struct MeshContact {
    std::uint32_t mesh;
    std::uint32_t inner;  // the grain belongs inside the body
    Vec3<double> n, xi_m;
  };
  struct Memory {  // a grain's mesh contacts of the last step
    std::uint64_t count;
    std::array<MeshContact, kMaxContacts> contacts;
  };
  using MemoryAccounts = std::array<Account, kMaxContacts>;
  struct Grain;  // one grain's state and sums while it is worked on
  struct Workspace;

  // boundary_archive.cpp
  template <typename Archive, typename Self>
  static void transfer(Archive& archive, Self& self);

  // boundary_lists.cpp
  static Eigen::AlignedBox3d world_box(const Mesh& m);
  double mesh_travel_m(Pose Mesh::*since) const;
  template <typename Real>
  void search(const GrainRecord<Real>* records, std::uint32_t count, const Domain& domain);
  template <typename Real>
  void list(const GrainRecord<Real>* records, std::uint32_t count, const Domain& domain);
  template <typename Real>
  double furthest_candidate_m(const GrainRecord<Real>* records, const Domain& domain) const;
  void append_walls(std::uint32_t walls, const Eigen::Vector3d& p_m, double reach_m);
  void append_patches(std::uint32_t meshes, const Eigen::Vector3d& p_m, double reach_m,
                      const Domain& domain);
  void carry_memory();
  template <typename Real>
  void number_forces(std::uint32_t count);
  void flush_loads();
  void flush_energies();

  // boundary.cpp
  static Pose pose_at(const MeshMotion& motion, double time_s);
  void place_meshes(double time_s);
  template <typename Real>
  static Grain grain_of(const GrainRecord<Real>& r, const Domain& domain);
  /// The distinct spots of one mesh, whose patches begin at `patch`, which moves behind them.
  bool find_spots(const NearGrain& b, const Grain& g, const Pose& pose, std::uint32_t& patch,
                  Workspace& w) const;
  void touch_walls(const NearGrain& b, Grain& g);
  void touch_meshes(const NearGrain& b, Grain& g, Workspace& w);
  void touch_spots(const NearGrain& b, Patch& patch, bool inner, Grain& g, Workspace& w);
  static bool is_inner(const Workspace& w, std::uint32_t mesh);
  static int take_over(Workspace& w, std::uint32_t mesh, const Vec3<double>& n);
  void end_mesh_contacts(const Patch& patch, Grain& g, Workspace& w) const;
  static void end_contact(Grain& g, const Vec3<double>& n, const Vec3<double>& v_point_m_s,
                          Account& account);
  static void account_work(Grain& g, const Touch<double>& c, const Account& now, Account& last);
  static double rolling_loss_J(const Grain& g);
  Vec3<double> push(Grain& g, const Vec3<double>& n, double delta_m,
                    const Vec3<double>& v_point_m_s, Vec3<double>& xi_m, Account& account) const;
  std::ptrdiff_t find_wall_contact(std::uint32_t row, int wall) const;
  template <typename Real>
  Forces<Real>& forces_of() {
    return const_cast<Forces<Real>&>(forces<Real>());
  }

  BoundarySettings settings_;
  std::vector<Mesh> meshes_;

  bool searched_ = false, listed_ = false;
  double travel_since_search_m_ = 0, travel_since_listing_m_ = 0;  // of the grains, at most
  std::vector<Candidate> candidates_;                              // by row

  std::vector<NearGrain> grains_, old_grains_;  // by row
  std::vector<WallContact> wall_contacts_, old_wall_contacts_;
  std::vector<Account> wall_accounts_, old_wall_accounts_;  // as wall_contacts_
  std::vector<Patch> patches_;
  std::vector<std::uint32_t> near_facets_;
  std::vector<Memory> memories_, old_memories_;
  std::vector<MemoryAccounts> memory_accounts_, old_memory_accounts_;  // as memories_
  std::vector<ContactEnergy> energies_;                                // of grains_, when listed
  ContactEnergy lost_;        // by grains that are listed no longer
  double deepest_ratio_ = 0;  // of contacts that are listed no longer

  std::vector<std::int32_t> force_of_group_;
  Forces<float> forces_float_;
  Forces<double> forces_double_;
};

}  // namespace hoof::sim
