// A fast soil from pushes, by least squares.
#pragma once

#include <string>
#include <vector>

#include "sim/terrain/rft_settings.h"
#include "tools/terrain/push_case.h"

namespace hoof::tools {

/// Forces that a soil gives along a push, sample by sample. Without the damper: a push is slow.
std::vector<Eigen::Vector3d> predict(const PushCase& plate, const sim::RftTerrainSettings& soil);

struct CaseError {
  std::string name;
  bool held_out = false;
  double ratio = 0;      ///< rms of measured less predicted over rms of measured, of the push
  double force_N = 0;    ///< rms of measured
  double xi_n_N_m3 = 0;  ///< the scale that this push alone asks for
};

struct SoilFit {
  sim::RftTerrainSettings soil;
  std::vector<CaseError> cases;
  double fit_error = 0;       ///< root of the mean square of the cases' ratios
  double held_out_error = 0;  ///< the same of those held out
};

/// Fits xi_n or Bekker's k_c, k_phi and n to the pushes that are not held out, each weighted by its
/// own mean square force, with the yield displacement that fits them best (3D-RFT's scale given).
/// @param start all that is not fitted, and the law
/// @throws UserError where the pushes do not determine the numbers, with the reason
SoilFit fit_soil(const std::vector<Push>& pushes, const sim::RftTerrainSettings& start);

}  // namespace hoof::tools
