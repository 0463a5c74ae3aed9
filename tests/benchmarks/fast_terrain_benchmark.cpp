// What a fast ground costs: one exchange of 50 us, and a whole tick of 1 ms with the rig on it.

#include <benchmark/benchmark.h>

#include "sim/coupling/plant.h"
#include "sim/multibody/sinkage_rig.h"
#include "sim/terrain/rft_terrain.h"
#include "tests/sim/coupling/shipped_plant.h"

namespace hoof::sim {
namespace {

constexpr int kExchanges = 20;  // in a tick of 1 ms

RftTerrainSettings shipped_soil() {
  Settings run;
  return read_rft_terrain(shipped_section(run, "rft_terrain", "demo", "rft_terrain"));
}

/// The whole foot in the sand, sliding to and fro: every lower facet flows.
void soil_advance(benchmark::State& state) {
  RftTerrain terrain(shipped_soil());
  const Foot foot = shipped_foot("bionic");
  const Eigen::Vector3d hinge = foot.hinges.left_F_m;
  const std::vector<Eigen::Vector3d> places = {
      {0, 0, 0}, hinge, {hinge.x(), -hinge.y(), hinge.z()}};
  std::vector<BodyMotion> motions;
  for (std::size_t i = 0; i < places.size(); ++i) {
    Pose pose;
    pose.p_WB_m = places[i] - Eigen::Vector3d(0, 0, 0.02);
    terrain.add_body(i == 0 ? foot.middle : foot.left_toe, pose);
    motions.push_back({pose, pose});
  }
  std::vector<Wrench> wrenches(motions.size());
  std::int64_t n = 0;
  for (auto _ : state) {
    const Eigen::Vector3d step(n % 400 < 200 ? 1e-5 : -1e-5, 0, n % 40 < 20 ? -1e-5 : 1e-5);
    ++n;
    for (BodyMotion& motion : motions) {
      motion.start = motion.end;
      motion.end.p_WB_m += step;
    }
    terrain.advance(50e-6, motions, wrenches);
    benchmark::DoNotOptimize(wrenches.data());
  }
  state.counters["facets"] = double(terrain.facet_count());
}

template <typename Ground>
void tick(benchmark::State& state, std::unique_ptr<Ground> ground) {
  SinkageRigSettings rig;
  rig.foot = shipped_foot("bionic");
  rig.load_N = 400;
  rig.start_height_m = 0.012;
  auto sinkage = std::make_unique<SinkageRig>(rig);
  sinkage->release();
  Plant plant(std::move(sinkage), shipped_drives(), std::move(ground), shipped_coupling());
  for (auto _ : state) {
    for (int i = 0; i < kExchanges; ++i) plant.advance();
  }
  state.counters["ticks/s"] =
      benchmark::Counter(double(state.iterations()), benchmark::Counter::kIsRate);
}

void tick_on_rft(benchmark::State& state) {
  tick(state, std::make_unique<RftTerrain>(shipped_soil()));
}

void tick_on_rigid(benchmark::State& state) {
  tick(state, std::make_unique<RigidTerrain>(shipped_floor()));
}

BENCHMARK(soil_advance)->Unit(benchmark::kMicrosecond);
BENCHMARK(tick_on_rft)->Unit(benchmark::kMicrosecond);
BENCHMARK(tick_on_rigid)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace hoof::sim

BENCHMARK_MAIN();
