// What a foot of 5,000 triangles, pressed into sand, costs against a step of the whole bed.
// Bar (issue 3): under a tenth of the step at 933,000 grains.
//
// The settled bed of 20,000 grains (tests/data/dem) is pressed once, then tiled with itself as it
// was. The boundary is timed alone, while the grains of the pressed tile fly on as they were and
// the foot goes on at its speed, so that the lists are renewed as often as in a run.
#include <benchmark/benchmark.h>
#include <time.h>

#include <cmath>

#include "sim/dem/sand_bed.h"
#include "tests/benchmarks/benchmark_foot.h"
#include "tests/benchmarks/tiled_bed.h"

namespace {

using namespace hoof::sim;

constexpr double kTileX_m = 0.1004, kTileY_m = 0.0502;  // periods of the settled bed
constexpr double kDeep_m = 0.008;
constexpr double kSpeed_m_s = 0.4;
constexpr double kHigh_m = 0.3;

/// How many tiles lie side by side, in x and y.
struct Tiles {
  int x, y;
};

DemSettings settings(Tiles tiles, int threads) {
  DemSettings s;
  s.low_m = {0, 0, -0.01};
  s.high_m = {tiles.x * kTileX_m, tiles.y * kTileY_m, kHigh_m};
  s.periodic = {true, true, false};
  s.walls = {{Eigen::Vector3d::UnitZ(), 0}};
  s.grain_material = {178.5e6, 0.25, 2650};  // the paper's sand and ABS, sim/config/materials
  s.wall_material = {2.02e9, 0.37, 1050};
  s.grain_grain = {0.54, 0.52, 0.34};
  s.grain_wall = {0.5636, 0.5929, 0.0408};
  s.threads = threads;
  return s;
}

struct Pressed {
  BedState before, after;
  MeshMotion foot;  // as it was left
};

/// Presses the foot into the middle of one tile. Takes some seconds.
const Pressed& pressed() {
  static const Pressed result = [] {
    Pressed p;
    p.before = hoof::benchmarks::read_periodic_bed(HOOF_SETTLED_BED, kTileX_m, kTileY_m).state;
    double top_m = 0;
    for (const Grain& g : p.before.grains) top_m = std::max(top_m, g.p_m.z() + g.radius_m);
    const DemSettings s = settings({1, 1}, 1);
    SandBed bed(s, p.before);
    p.foot.p_WB_m = {kTileX_m / 2, kTileY_m / 2, top_m};
    p.foot.v_WB_m_s = {0, 0, -kSpeed_m_s};
    const int foot = bed.add_mesh(hoof::benchmarks::foot_mesh(), p.foot.p_WB_m, p.foot.q_WB);
    bed.set_motion(foot, p.foot);
    const int steps = int(kDeep_m / kSpeed_m_s / s.dt_s);
    bed.advance(steps);
    p.foot.p_WB_m.z() -= kSpeed_m_s * steps * s.dt_s;
    p.after = bed.state();
    return p;
  }();
  return result;
}

/// The bed side by side with itself, the pressed one first.
BedState tiled(Tiles tiles, bool with_foot) {
  BedState bed;
  for (int i = 0; i < tiles.x * tiles.y; ++i) {
    const bool here = with_foot && i == 0;
    for (Grain g : here ? pressed().after.grains : pressed().before.grains) {
      g.id = std::uint32_t(bed.grains.size());
      // Back into its tile: the bed is saved anywhere within its period.
      g.p_m.x() -= kTileX_m * std::floor(g.p_m.x() / kTileX_m);
      g.p_m.y() -= kTileY_m * std::floor(g.p_m.y() / kTileY_m);
      g.p_m += Eigen::Vector3d(i % tiles.x * kTileX_m, i / tiles.x * kTileY_m, 0);
      bed.grains.push_back(g);
    }
  }
  return bed;
}

/// What the boundary is measured against: the whole bed at rest, with its floor.
void step_of_bed(benchmark::State& state) {
  const Tiles tiles = {int(state.range(0)), int(state.range(1))};
  SandBed bed(settings(tiles, int(state.range(2))), tiled(tiles, false));
  bed.advance(3);
  for (auto _ : state) bed.advance(1);
  state.counters["grains"] = double(bed.grain_count());
}

/// Time on the processor: what else runs on the machine does not count.
double thread_time_s() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

void boundary_alone(benchmark::State& state) {
  const Tiles tiles = {int(state.range(0)), int(state.range(1))};
  const bool with_foot = state.range(2) != 0;
  const DemSettings s = settings(tiles, 1);
  const Domain domain = Domain::spanning(s.low_m, s.high_m, s.periodic);
  const BedState bed = tiled(tiles, with_foot);
  std::vector<GrainRecord<float>, AlignedAllocator<GrainRecord<float>>> records;
  for (const Grain& g : bed.grains) {
    GrainRecord<float> r{};
    double rest;
    r.x = domain.to_steps<float>(0, g.p_m.x(), rest), r.y = domain.to_steps<float>(1, g.p_m.y(), rest);
    r.z = domain.to_steps<float>(2, g.p_m.z(), rest);
    r.radius_m = float(g.radius_m), r.mass_kg = float(11100 * std::pow(g.radius_m, 3));
    r.vx = float(g.v_m_s.x()), r.vy = float(g.v_m_s.y()), r.vz = float(g.v_m_s.z());
    r.wx = float(g.w_rad_s.x()), r.wy = float(g.w_rad_s.y()), r.wz = float(g.w_rad_s.z());
    r.id = g.id;
    records.push_back(r);
  }
  double fastest_m_s = 0;
  for (const Grain& g : bed.grains) fastest_m_s = std::max(fastest_m_s, g.v_m_s.norm());
  const std::size_t moving = pressed().after.grains.size();
  const auto count = std::uint32_t(records.size());
  while (records.size() % kLanes != 0) records.push_back({});
  BoundarySettings b;
  b.law = make_pair_law(s.grain_material, s.wall_material, s.grain_wall);
  b.walls = s.walls;
  b.skin_m = 2e-4;
  Boundary boundary(b);
  if (with_foot)
    boundary.set_motion(boundary.add_mesh(hoof::benchmarks::foot_mesh()), pressed().foot);
  double time_s = 0;
  for (auto _ : state) {
    const double start_s = thread_time_s();
    boundary.prepare<float>(records.data(), count, domain, time_s);
    boundary.compute<float>(records.data(), domain, s.dt_s, 0, std::uint32_t(records.size()) / 16);
    boundary.advance(fastest_m_s * s.dt_s);
    state.SetIterationTime(thread_time_s() - start_s);
    time_s += s.dt_s;
    for (std::size_t i = 0; i < moving; ++i) {
      GrainRecord<float>& r = records[i];
      r.x += std::int32_t(r.vx * s.dt_s / domain.lsb_m<float>(0));
      r.y += std::int32_t(r.vy * s.dt_s / domain.lsb_m<float>(1));
      r.z += std::int32_t(r.vz * s.dt_s / domain.lsb_m<float>(2));
    }
  }
  state.counters["grains"] = double(count);
  state.counters["fastest_m_s"] = fastest_m_s;
  if (!with_foot) return;
  const double force_N = boundary.take_load(0).impulse_W_Ns.z() / time_s;
  state.counters["force_N"] = force_N;
}

// Arguments: tiles in x and y (48 are 960,000 grains), then the number of threads, or whether there
// is a foot besides the floor.
BENCHMARK(step_of_bed)
    ->Args({6, 8, 1})
    ->Args({6, 8, 2})
    ->Unit(benchmark::kMicrosecond)
    ->UseRealTime()
    ->Iterations(100);
BENCHMARK(boundary_alone)
    ->Args({6, 8, 0})
    ->Args({6, 8, 1})
    ->Args({1, 1, 0})
    ->Args({1, 1, 1})
    ->Unit(benchmark::kMicrosecond)
    ->UseManualTime()
    ->Iterations(1500);

}  // namespace

BENCHMARK_MAIN();
