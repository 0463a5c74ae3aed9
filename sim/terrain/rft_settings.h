// The numbers of a fast soil: resistive force theory with a linear or Bekker's pressure over depth.
#pragma once

#include <cstdint>
#include <string>

#include "sim/config/reader.h"

namespace hoof::sim {

/// How the stress of flowing sand grows with depth.
enum class PressureLaw {
  kLinear,  ///< xi_n times depth, as in 3D-RFT
  kBekker,  ///< Bekker's pressure of a flat plate, in RFT's proportions for other facets
};

struct RftTerrainSettings {
  std::string name;
  double surface_height_m = 0;
  PressureLaw pressure_law = PressureLaw::kLinear;
  /// The sand's scale, N/m^3 (rft_law.h).
  Measured xi_n_N_m3;
  /// Bekker's k_phi and k_c with the depth in units of 1 m: p = (k_c / b + k_phi) (z / 1 m)^n.
  double bekker_k_phi_Pa = 0;
  double bekker_k_c_N_m = 0;
  double bekker_exponent = 1;
  /// b: the smaller width of what stands on the sand.
  double bekker_width_m = 0;
  /// mu_surf: sand on the foot.
  double surface_friction = 0;
  /// A facet moved this far against resting sand meets its full resistance.
  Measured yield_displacement_m;
  /// Viscous part of the resistance below its limit, as a time: damper over spring.
  double damping_s = 0;
  /// Edge of the facets that a mesh is made into.
  double facet_size_m = 0;
  /// Of the fit: rms of measured less predicted force over rms of the measured, on the pushes that
  /// were fitted and on those held out; 0 where nothing was fitted.
  double fit_error = 0;
  double held_out_error = 0;
  std::string fitted_to;

  /// @throws std::invalid_argument naming the first broken rule
  void validate() const;

  /// FNV-1a of all that decides a force: equal soils, equal hashes.
  std::uint64_t hash() const;
};

/// Reads the section "rft_terrain".
RftTerrainSettings read_rft_terrain(Reader section);

}  // namespace hoof::sim
