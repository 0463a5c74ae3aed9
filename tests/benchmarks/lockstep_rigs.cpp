#include "tests/benchmarks/lockstep_rigs.h"

#include "sim/terrain/rigid_terrain.h"
#include "tools/experiment/bench.h"

namespace hoof::benchmarks {
namespace {

/// All joints where they were; a single body far above the ground.
class HeldRig final : public sim::Rig {
 public:
  explicit HeldRig(bool leg) : joints_{sim::Joint::kToe, sim::Joint::kHip, sim::Joint::kKnee} {
    count_ = leg ? 3 : 1;
    mesh_.vertices_m = {{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}};
    mesh_.triangles = {{0, 1, 2}};
    pose_.p_WB_m.z() = 1;
  }
  int body_count() const override { return 1; }
  const sim::TriangleMesh& mesh(int) const override { return mesh_; }
  sim::Pose pose(int) const override { return pose_; }
  std::span<const sim::Joint> joints() const override { return {joints_.data(), count_}; }
  double joint_position_rad(sim::Joint joint) const override {
    return joint == sim::Joint::kKnee ? -1.0 : 0.0;
  }
  double joint_velocity_rad_s(sim::Joint) const override { return 0; }
  void apply_joint_torque(sim::Joint, double) override {}
  void apply_wrench(int, const sim::Wrench&) override {}
  void step(double) override {}
  sim::RigEnergy energy() const override { return {}; }
  Eigen::Vector3d foot_velocity_m_s() const override { return Eigen::Vector3d::Zero(); }
  double toe_opening_rad(int) const override { return 0; }

 private:
  std::array<sim::Joint, 3> joints_;
  std::size_t count_;
  sim::TriangleMesh mesh_;
  sim::Pose pose_;
};

class Endless final : public sim::Experiment {
 public:
  explicit Endless(std::unique_ptr<sim::Plant> plant) : Experiment(std::move(plant)) {}
  void foot_ready() override {}
  bool finished() const override { return false; }
  double progress() const override { return 0; }

 protected:
  void after_interval() override {}
  double depth_m() const override { return 0; }
};

}  // namespace

tools::RunSettings rigid_settings(const std::string& kind) {
  return tools::read_run_settings(kind, {"experiment.terrain=\"rigid\""});
}

std::unique_ptr<sim::Experiment> held(const tools::RunSettings& run) {
  return std::make_unique<Endless>(
      std::make_unique<sim::Plant>(std::make_unique<HeldRig>(run.firmware_leg()), run.drives,
                                   std::make_unique<sim::RigidTerrain>(run.rigid), run.coupling));
}

std::unique_ptr<sim::Experiment> on_floor(const tools::RunSettings& run) {
  return tools::make_experiment(
      run, [](double) { return true; }, [](const std::string&) {});
}

}  // namespace hoof::benchmarks
