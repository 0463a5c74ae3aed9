// Fast soil: resistive force theory on the facets of each body, behind the interface of the grains.
//
// The theory knows only flowing sand: its stress depends on the direction of motion and not on the
// speed, so that it says nothing about a foot that stands. Here each facet drags a memory along,
// its displacement u against resting sand, no longer than the yield displacement u_y. The stress is
// the theory's for the direction of u, in the share |u| / u_y. A facet that flows has |u| = u_y
// along its motion: the theory as it stands. One that stops keeps u, and its load, without creep;
// one that goes back unloads within u_y, as stiffly as sand does. (Splitting motion into an elastic
// and a plastic part: Yilmaz, Douglas, Perron, Kamrin, Elastic resistive force theory, Soft Matter
// 2026, doi 10.1039/D6SM00040A. The law above is simpler than theirs.)
//
// Below its limit the stress has a viscous part (damping), else a standing foot would ring.
//
// Optional physics of the soil acts on each facet by itself: what an effect makes of a force that
// grows with depth is made of the facet's, in its own direction, at full flow. Walls are as far as
// an effect takes those to be that it is not told of. Unloading is this law's own.
//
// Not modelled: the footprint (depth is from the undisturbed surface, also where a foot stood
// before), heaps, the sand's inertia, walls and floor of a box, what one facet does to the sand
// before the next one.
#pragma once

#include <memory>
#include <vector>

#include "sim/effects/soil_effect.h"
#include "sim/terrain/rft_facets.h"
#include "sim/terrain/rft_settings.h"
#include "sim/terrain/terrain.h"

namespace hoof::sim {

/// Wrenches are those at the end of the interval. No facet gives back more work than it took in and
/// could have stored, whatever its path.
class RftTerrain final : public Terrain {
 public:
  /// @throws std::invalid_argument for settings that validate() refuses
  explicit RftTerrain(const RftTerrainSettings& settings);

  /// Optional physics, before the first interval.
  void add_effect(std::unique_ptr<SoilEffect> effect);

  /// @throws std::invalid_argument where the mesh has no area
  int add_body(const TriangleMesh& mesh, const Pose& pose) override;
  void advance(double interval_s, std::span<const BodyMotion> motions,
               std::span<Wrench> wrenches) override;
  WrenchTime wrench_time() const override { return WrenchTime::kEndOfInterval; }
  double surface_height_m() const override { return settings_.surface_height_m; }
  double work_on_bodies_J() const override { return work_J_; }

  std::size_t facet_count() const;

 private:
  struct Contact {
    RftFacet facet;
    bool in_sand = false;
    /// u, world frame.
    Eigen::Vector3d displacement_m = Eigen::Vector3d::Zero();
    Eigen::Vector3d stress_Pa = Eigen::Vector3d::Zero();
    /// Work taken in that may come back, J/m^2.
    double stored_J_m2 = 0;
    /// Level way since it entered the sand.
    double shear_m = 0;
  };

  /// Stress of flowing sand over alpha.
  double scale_Pa(double depth_m) const;
  void update(Contact& contact, const Eigen::Vector3d& normal_W, double depth_m,
              const Eigen::Vector3d& moved_m, double interval_s) const;
  SoilContact as_soil_contact(const Contact& contact, double depth_m, double alpha,
                              double speed_m_s) const;
  double effect_factor(const SoilContact& contact) const;

  RftTerrainSettings settings_;
  std::vector<std::unique_ptr<SoilEffect>> effects_;
  double time_s_ = 0;
  std::vector<std::vector<Contact>> bodies_;
  double work_J_ = 0;
};

}  // namespace hoof::sim
