// Feet and legs from the shipped settings.
#pragma once

#include <string>

#include "sim/multibody/foot.h"
#include "sim/multibody/leg.h"

namespace hoof::sim {

inline Foot shipped_foot(const std::string& name) {
  Settings run;
  run.merge(Settings::load_file(default_config_dir() / "feet" / (name + ".toml")), "foot");
  return read_foot(Reader(run).section("foot"));
}

inline Leg shipped_leg() {
  Settings run;
  run.merge(Settings::load_file(default_config_dir() / "legs/goat.toml"), "leg");
  return read_leg(Reader(run).section("leg"));
}

}  // namespace hoof::sim
