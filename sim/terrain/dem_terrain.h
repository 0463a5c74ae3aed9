// The sand bed behind the interface that all grounds share.
#pragma once

#include <vector>

#include "sim/dem/sand_bed.h"
#include "sim/terrain/resumable_terrain.h"

namespace hoof::sim {

class DemTerrain final : public ResumableTerrain {
 public:
  /// @throws std::invalid_argument as SandBed
  DemTerrain(const DemSettings& settings, const BedState& state);

  int add_body(const TriangleMesh& mesh, const Pose& pose) override;

  /// The bed follows in equal steps. @throws std::invalid_argument unless the interval is a whole
  /// number of steps; std::runtime_error when the bed blows up
  void advance(double interval_s, std::span<const BodyMotion> motions,
               std::span<Wrench> wrenches) override;

  double surface_height_m() const override { return 0; }
  double work_on_bodies_J() const override { return work_J_; }

  std::string snapshot() const override;
  void restore(std::string_view snapshot) override;

  const SandBed& bed() const { return bed_; }

 private:
  SandBed bed_;
  double work_J_ = 0;
};

}  // namespace hoof::sim
