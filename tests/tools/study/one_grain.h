// A bed of one grain on the floor under a flat strip: its force is a closed form.
#pragma once

#include "sim/config/materials.h"
#include "sim/config/settings.h"
#include "tools/study/press.h"

namespace hoof::tests {

constexpr double kGrainRadius_m = 2e-3;

inline sim::Materials materials() {
  sim::Settings run;
  run.merge(sim::Settings::load_file(sim::default_config_dir() / "materials/paper.toml"),
            "materials");
  return sim::read_materials(sim::Reader(run).section("materials"));
}

/// Pressed slowly: 20 mm/s take 5 ms for 0.1 mm, fifty times the grain's own period of 0.1 ms.
inline tools::PressCase one_grain_case() {
  sim::FootGeometry sole;
  sole.middle = {0.1, 0.04, 0.04, 0.008};
  tools::PressCase c;
  c.bed.name = "grain";
  c.bed.box_length_m = 0.1;
  c.bed.box_width_m = 0.06;
  c.bed.depth_m = 2 * kGrainRadius_m;
  c.bed.periodic_sides = true;
  c.bed.sieve = {{3.9e-3, 4.1e-3, 1.0}};
  c.bed.skin_m = 1e-4;
  c.indenter = tools::make_strip(sole, c.bed.box_width_m, false);
  c.speed_m_s = 0.02;
  c.depth_m = 0.2e-3;
  return c;
}

inline sim::BedState one_grain() {
  sim::BedState state;
  sim::Grain g;
  g.radius_m = kGrainRadius_m;
  g.p_m = {0, 0, -kGrainRadius_m};
  state.grains.push_back(g);
  return state;
}

}  // namespace hoof::tests
