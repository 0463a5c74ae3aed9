#pragma once

#include <limits>
#include <string>
#include <vector>

#include "tools/conceal/goal_path.h"
#include "tools/conceal/hidden_effect.h"

namespace hoof::tools::conceal {

/// Bekker's numbers of a sand: pressure (k_c / b + k_phi) z^n, z in m.
struct SandBed {
  double k_c = 0.0;      ///< N/m^(n+1)
  double k_phi = 4.0e6;  ///< N/m^(n+2)
  double n = 1.2;
};

/// One press of one plate. Travel is the carriage's way down from where it started, m.
struct SandPress {
  bool disc = true;
  double width_m = 0.06, length_m = 0.06;  ///< a disc's diameter is its width
  double start_height_m = 0.1;             ///< carriage, up positive
  double surface_height_m = 0.095;
  GoalPath travel;
  std::vector<double> times_s;
  int index = 0;  ///< presses before this one

  double area_m2() const;
  double breadth_m() const;  ///< b: radius of a disc, else the smaller side
  double perimeter_m() const;
};

/// Force (N) at each sample of a press into sand. `depth_m` is the sinkage as the carriage has it,
/// one value per sample.
std::vector<double> sand_force(const SandBed& bed, const std::vector<HiddenEffect>& hidden,
                               const SandPress& press, const std::vector<double>& depth_m);

/// Sinkage by the carriage at each sample: negative above the surface.
std::vector<double> carriage_depth(const SandPress& press);

/// Effects of the contract's section 4 that a press of plates can hide, and the examiner's own.
const std::vector<std::string>& listed_sand_effects();
const std::vector<std::string>& unlisted_sand_effects();

}  // namespace hoof::tools::conceal
