// The settings of a sinkage or traction run, read and checked as a whole before anything is built.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "firmware/app/parameters.h"
#include "hil_bridge/fault_spec.h"
#include "sim/config/settings.h"
#include "sim/coupling/plant.h"
#include "sim/experiments/sinkage.h"
#include "sim/experiments/traction.h"
#include "sim/multibody/foot.h"
#include "sim/multibody/leg.h"
#include "sim/terrain/bed_settings.h"
#include "sim/terrain/rft_settings.h"
#include "sim/terrain/rigid_terrain.h"
#include "tools/experiment/run_effects.h"

namespace hoof::tools {

struct RunSettings {
  sim::Settings tree;      // everything as resolved; written beside the results
  sim::Settings declared;  // the same without what --effects added
  std::string kind;        // "sinkage" or "traction"
  std::string foot_name;
  std::string terrain;   // "dem", "rft" or "rigid"
  std::string bus;       // "in_process", or SocketCAN interfaces
  std::string firmware;  // "host": in this process; "emulated" or "qemu": the board's image
  std::string image;     // of that board, an ELF file; empty with "host"
  std::string fields = "report";  // "none", "report" or "vtk": what is kept of the sand's insides
  std::uint64_t seed = 0;
  int threads = 1;

  sim::Foot foot;
  std::optional<sim::Leg> leg;
  sim::BedSettings bed;
  sim::Materials materials;
  sim::DriveSet drives;
  sim::CouplingSettings coupling;
  sim::RigidTerrainSettings rigid;
  sim::RftTerrainSettings rft;
  sim::SinkageSettings sinkage;    // of a sinkage run
  sim::TractionSettings traction;  // of a traction run
  firmware::app::Parameters parameters;
  std::vector<bridge::FaultSpec> faults;  // put in on the way; none in a clean run
  std::vector<RunEffect> effects;         // beyond the nominal plant; none unless asked for
  std::map<std::string, double> setup;    // numbers of the plant set anew beside them, SI
  /// The run's folder shall look like one of a real machine's bench: it tells neither effects nor
  /// what only a simulator knows.
  bool concealed = false;

  bool in_qemu() const { return firmware == "qemu"; }
  bool on_grains() const { return terrain == "dem"; }
  /// A real machine's bench sees nothing of them.
  bool keeps_fields() const { return on_grains() && fields != "none" && !concealed; }
  bool is_sinkage() const { return kind == "sinkage"; }
  double toe_rad() const { return is_sinkage() ? sinkage.toe_rad : traction.toe_rad; }
  std::array<bool, sim::kJointCount> has_drives() const;
  bool firmware_leg() const { return !is_sinkage() && !traction.prescribed; }
};

/// Of a traction run: how far the ends of the foot go to either side of the middle of the bed.
double reach_m(const RunSettings& run);

/// @param experiment "sinkage", "traction" or a TOML file of one
/// @param overrides "dotted.key=value", as of --set; keys "control.NAME" are firmware parameters
/// @param fault_file TOML with [[fault]] entries and nothing else; "" for none
/// @param effects_file TOML as `hoof diagnose` writes it: [effects.NAME], [setup]; "" for none
/// @throws sim::ConfigError, UserError: one line that names file, key, value and bound
RunSettings read_run_settings(const std::string& experiment,
                              const std::vector<std::string>& overrides,
                              const std::string& fault_file = "",
                              const std::string& effects_file = "");

}  // namespace hoof::tools
