// Drives, floor and coupling from the shipped settings.
#pragma once

#include "sim/coupling/plant.h"
#include "sim/terrain/rigid_terrain.h"
#include "tests/sim/multibody/shipped.h"

namespace hoof::sim {

inline Reader shipped_section(Settings& run, const std::string& folder, const std::string& name,
                              const std::string& section) {
  run.merge(Settings::load_file(default_config_dir() / folder / (name + ".toml")), section);
  return Reader(run).section(section);
}

inline DriveSet shipped_drives() {
  Settings run;
  Reader drives = shipped_section(run, "drives", "goat", "drives");
  DriveSet set;
  for (int i = 0; i < kJointCount; ++i) {
    set[i] = read_drive(drives.section(joint_name(static_cast<Joint>(i))));
  }
  return set;
}

inline RigidTerrainSettings shipped_floor() {
  Settings run;
  return read_rigid_terrain(shipped_section(run, "rigid_terrain", "floor", "rigid_terrain"));
}

inline CouplingSettings shipped_coupling() {
  Settings run;
  return read_coupling(shipped_section(run, "coupling", "standard", "coupling"));
}

}  // namespace hoof::sim
