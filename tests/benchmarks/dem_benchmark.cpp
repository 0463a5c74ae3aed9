// How fast the sand goes: particle-steps per second at rest and under a foot, one JSON line a case.
//
//   hoof benchmark dem [--bed FILE.csv] [--tile NxM] [--threads N] [--precision mixed|double]
//
// The settled bed of 20,000 grains (tests/data/dem; the paper's sand, dt 2.8 us, periodic sides) is
// tiled with itself. "step": the bed alone. "press": a foot of 5,400 triangles goes down into it.
// All physics is on: history, damping, Coulomb and rolling friction. List making is in the time.
#include <benchmark/benchmark.h>

#include <CLI/CLI.hpp>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tests/benchmarks/benchmark_foot.h"
#include "tests/benchmarks/machine_bounds.h"
#include "tests/benchmarks/tiled_bed.h"

namespace {

using namespace hoof::sim;
using hoof::benchmarks::PeriodicBed;

// Operations of the step kernel on one lane, counted in its source; a root or a division counts
// one.
constexpr double kFlopPerPlace = 22, kFlopPerTouch = 190, kFlopPerGrain = 90;
// Memory that a step moves: a record read and one written (its line is fetched first), the indices
// of a place, the displacement of a touching one read and written. Neighbours are taken from cache.
constexpr double kBytesPerGrain = 3 * 64, kBytesPerPlace = 4, kBytesPerTouch = 24;

struct Options {
  std::string bed = HOOF_SETTLED_BED;
  std::vector<double> period_mm{100.4, 50.2};
  std::string tile;
  int threads = 0;
  std::string precision;
  int steps = 0;
  int blocks = 5;
};

struct Case {
  std::string name;
  int nx, ny;
  int threads;
  Precision precision;
  double speed_m_s;  // of the foot; 0: no foot
  int steps;         // of one block
};

/// The tile with the contact histories that grow in its first thousand steps.
const PeriodicBed& settled_tile(const Options& o) {
  static const PeriodicBed tile = [&] {
    PeriodicBed t = hoof::benchmarks::read_periodic_bed(o.bed, 1e-3 * o.period_mm.at(0),
                                                        1e-3 * o.period_mm.at(1));
    SandBed bed(hoof::benchmarks::settings_for(t, Precision::kDouble, 1), t.state);
    bed.advance(1000);
    t.state = bed.state();
    t.surface_m = 0;
    for (const Grain& g : t.state.grains) {
      t.surface_m = std::max(t.surface_m, g.p_m.z() + g.radius_m);
    }
    return t;
  }();
  return tile;
}

std::map<std::string, double> forces_N;  // of pressed cases, by name without the precision

void report_case(benchmark::State& state, const Case& c, const SandBed& bed, double press_N) {
  const BedHealth health = bed.health();
  const auto set = [&](const char* name, double value) { state.counters[name] = value; };
  set("grains", double(bed.grain_count()));
  set("threads", c.threads);
  set("contacts_per_grain", bed.coordination_number());
  set("rebuilds", double(health.rebuilds));
  set("renewed_per_step", double(health.renewed) / double(health.steps));
  set("bytes_per_grain", double(bed.memory_bytes()) / double(bed.grain_count()));
  if (c.speed_m_s > 0) {
    set("foot_speed_m_s", c.speed_m_s);
    set("mean_force_N", press_N);
    const auto [other, is_first] = forces_N.try_emplace(c.name, press_N);
    if (!is_first) set("force_over_other_precision", press_N / other->second);
  }
  char hash[32];
  std::snprintf(hash, sizeof hash, "%016" PRIx64, bed.state_hash());
  state.SetLabel(std::string(c.precision == Precision::kDouble ? "double" : "mixed") + " " +
                 to_string(bed.settings().instruction_set) + " " + hash);
}

void run_case(benchmark::State& state, const Options& o, const Case& c) {
  const PeriodicBed bed = hoof::benchmarks::tiled(settled_tile(o), c.nx, c.ny);
  SandBed sand(hoof::benchmarks::settings_for(bed, c.precision, c.threads), bed.state);
  if (c.speed_m_s > 0) {
    // From the surface, where the first grain stands up.
    const Eigen::Vector3d start_m(bed.period_x_m / 2, bed.period_y_m / 2, bed.surface_m - 1e-3);
    const int foot = sand.add_mesh(hoof::benchmarks::foot_mesh(), start_m, {1, 0, 0, 0});
    sand.set_motion(foot, {start_m, {1, 0, 0, 0}, {0, 0, -c.speed_m_s}, {0, 0, 0}});
  }
  sand.advance(20);
  double best = 0;
  std::uint64_t steps = 0;
  for (auto _ : state) {
    const auto start = std::chrono::steady_clock::now();
    sand.advance(c.steps);
    const double s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    state.SetIterationTime(s);
    best = std::max(best, double(sand.grain_count()) * c.steps / s);
    steps += std::uint64_t(c.steps);
  }
  const double press_N = c.speed_m_s > 0 ? sand.take_load(0).impulse_W_Ns.z() /
                                               (double(steps + 20) * sand.settings().dt_s)
                                         : 0;
  state.counters["particle_steps_per_s"] =
      benchmark::Counter(double(sand.grain_count()) * double(steps), benchmark::Counter::kIsRate);
  state.counters["best_block_particle_steps_per_s"] = best;
  report_case(state, c, sand, press_N);
}

/// One JSON line a case.
class JsonLines : public benchmark::BenchmarkReporter {
 public:
  JsonLines(double bandwidth_B_s, double flop_s) : bandwidth_B_s_(bandwidth_B_s), flop_s_(flop_s) {}

  bool ReportContext(const Context&) override { return true; }

  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      std::map<std::string, double> value;
      for (const auto& [name, counter] : run.counters) value[name] = counter.value;
      std::string label = run.report_label;
      const std::size_t first = label.find(' '), last = label.rfind(' ');
      std::printf("{\"case\":\"%s\",\"precision\":\"%s\",\"instruction_set\":\"%s\"",
                  run.run_name.function_name.c_str(), label.substr(0, first).c_str(),
                  label.substr(first + 1, last - first - 1).c_str());
      for (const auto& [name, v] : value) std::printf(",\"%s\":%.9g", name.c_str(), v);
      const double touches = value["contacts_per_grain"], places = touches + 1.2;
      const double real = label.compare(0, first, "double") == 0 ? 2 : 1;
      std::printf(",\"bandwidth_bound_particle_steps_per_s\":%.3g",
                  bandwidth_B_s_ / real /
                      (kBytesPerGrain + kBytesPerPlace * places + kBytesPerTouch * touches));
      std::printf(
          ",\"flop_bound_particle_steps_per_s\":%.3g",
          flop_s_ / real / (kFlopPerGrain + kFlopPerPlace * places + kFlopPerTouch * touches));
      std::printf(",\"end_state_hash\":\"%s\"}\n", label.substr(last + 1).c_str());
      std::fflush(stdout);
    }
  }

 private:
  double bandwidth_B_s_, flop_s_;
};

std::vector<Case> cases(const Options& o) {
  struct Size {
    int nx, ny;
    const char* name;
  };
  std::vector<Size> sizes{{1, 1, "20k"}, {5, 1, "100k"}, {5, 4, "400k"}, {8, 6, "960k"}};
  std::vector<Size> pressed{{5, 5, "500k"}};
  if (!o.tile.empty()) {
    Size s{0, 0, o.tile.c_str()};
    if (std::sscanf(o.tile.c_str(), "%dx%d", &s.nx, &s.ny) != 2 || s.nx < 1 || s.ny < 1) {
      throw CLI::ValidationError("--tile", "must be like 5x4, not " + o.tile);
    }
    sizes = pressed = {s};
  }
  std::vector<int> threads{1, 2};
  if (o.threads > 0) threads = {o.threads};
  std::vector<Precision> precisions{Precision::kMixed, Precision::kDouble};
  if (!o.precision.empty()) {
    precisions = {o.precision == "double" ? Precision::kDouble : Precision::kMixed};
  }
  std::vector<Case> all;
  // About three seconds a block at 40 million particle-steps a second.
  const auto steps = [&](const Size& s) {
    return o.steps > 0 ? o.steps : std::max(20, 6000 / (s.nx * s.ny));
  };
  for (const Precision p : precisions) {
    for (const int t : threads) {
      for (const Size& s : sizes) {
        all.push_back({std::string("step/") + s.name, s.nx, s.ny, t, p, 0, steps(s)});
      }
    }
    for (const Size& s : pressed) {
      for (const double v : {0.1, 0.4}) {
        all.push_back({std::string("press/") + s.name + (v < 0.2 ? "/0.1" : "/0.4"), s.nx, s.ny,
                       threads.back(), p, v, steps(s)});
      }
    }
  }
  return all;
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  CLI::App app{"Speed of the sand: one JSON line a case", "hoof benchmark dem"};
  app.add_option("--bed", o.bed, "Settled periodic bed: columns d,x,y,z,vx,vy,vz,wx,wy,wz, SI")
      ->check(CLI::ExistingFile);
  app.add_option("--period", o.period_mm, "Its period along x and y, mm")->expected(2);
  app.add_option("--tile", o.tile, "Only this many copies, e.g. 5x4")->type_name("NxM");
  app.add_option("--threads", o.threads, "Only this many threads [1 and 2]")
      ->check(CLI::Range(1, 1024));
  app.add_option("--precision", o.precision, "Only mixed or double [both]")
      ->check(CLI::IsMember({"mixed", "double"}));
  app.add_option("--steps", o.steps, "Steps of a block [about 3 s]")->check(CLI::Range(1, 1000000));
  app.add_option("--blocks", o.blocks, "Blocks of a case")->check(CLI::Range(1, 1000));
  app.footer(
      "Examples:\n  hoof benchmark dem\n"
      "  hoof benchmark dem --tile 8x6 --threads 2 --precision mixed");
  try {
    app.parse(argc, argv);
    const int threads = o.threads > 0 ? o.threads : 2;
    const double bandwidth_B_s = hoof::benchmarks::copy_bandwidth_B_s(threads);
    const double flop_s = hoof::benchmarks::float_rate_flop_s(threads);
    std::printf("{\"machine\":{\"threads\":%d,\"copy_GB_s\":%.3g,\"float_Gflop_s\":%.4g}}\n",
                threads, 1e-9 * bandwidth_B_s, 1e-9 * flop_s);
    std::fflush(stdout);
    for (const Case& c : cases(o)) {
      benchmark::RegisterBenchmark(c.name.c_str(),
                                   [&o, c](benchmark::State& state) { run_case(state, o, c); })
          ->Iterations(o.blocks)
          ->UseManualTime();
    }
    JsonLines reporter(bandwidth_B_s, flop_s);
    benchmark::RunSpecifiedBenchmarks(&reporter);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "hoof benchmark dem: %s\n", e.what());
    return 3;
  }
  return 0;
}
