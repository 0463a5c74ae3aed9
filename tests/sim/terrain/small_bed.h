// A bed that settles in about a second: for tests of what is done with beds, not of sand.
#pragma once

#include "sim/terrain/bed_maker.h"
#include "sim/terrain/bed_report.h"

namespace hoof::sim::test {

inline Materials shipped_materials() {
  Settings run;
  run.merge(Settings::load_file(default_config_dir() / "materials/paper.toml"), "materials");
  return read_materials(Reader(run).section("materials"));
}

/// About 620 grains of one narrow class, 60 x 60 x 30 mm: 11 grains wide and 5 deep.
inline BedSettings small_bed() {
  BedSettings bed;
  bed.name = "small";
  bed.box_length_m = 0.060;
  bed.box_width_m = 0.060;
  bed.depth_m = 0.030;
  bed.sieve = {{2.5e-3, 3.0e-3, 1.0}};
  bed.grain_scale = 2;
  // 6.25 us, 12 % of the Rayleigh time of the smallest grain: whole numbers of steps in 25 us.
  bed.steps_per_ms = 160;
  bed.settling_steps_per_ms = 80;
  bed.skin_m = 3e-4;
  bed.packing_friction = 0.3;
  bed.packing_rolling_friction = 0;
  bed.rain_share = 0.30;
  bed.overfill = 1.10;
  return bed;
}

/// The paper's grading in a box of the given size.
inline BedSettings paper_grains(double length_m, double width_m, double depth_m) {
  BedSettings bed;
  bed.name = "grading";
  bed.box_length_m = length_m;
  bed.box_width_m = width_m;
  bed.depth_m = depth_m;
  bed.sieve = {{2e-3, 4e-3, 0.5784}, {4e-3, 6.4e-3, 0.4216}};
  bed.overfill = 1;
  return bed;
}

inline BedState make_small_bed(const BedSettings& bed, std::uint64_t seed = 1, int threads = 1) {
  return make_bed(bed, shipped_materials(), seed, threads, {});
}

/// Every number of a state, for comparing bits.
inline std::vector<double> numbers(const BedState& state) {
  std::vector<double> all;
  const auto add = [&all](const Eigen::Vector3d& v) { all.insert(all.end(), {v[0], v[1], v[2]}); };
  for (const Grain& g : state.grains) {
    all.insert(all.end(), {double(g.id), g.radius_m});
    add(g.p_m), add(g.v_m_s), add(g.w_rad_s);
  }
  for (const GrainContact& c : state.contacts) {
    all.insert(all.end(), {double(c.i), double(c.j)});
    add(c.xi_m);
  }
  return all;
}

}  // namespace hoof::sim::test
