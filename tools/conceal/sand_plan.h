#pragma once

#include <string>
#include <vector>

#include "tools/conceal/case_request.h"
#include "tools/conceal/random_stream.h"
#include "tools/conceal/sand_bench.h"

namespace hoof::tools::conceal {

struct DoubtfulSand {
  std::string key;
  double SandBed::*field;
  double believed = 0.0, sigma = 0.0;
};

struct SandPlan {
  SandBed bed;
  std::vector<SandPress> presses;
  std::vector<bool> holdout;
  std::vector<DoubtfulSand> doubts;
  double snr_db = 0.0, force_sigma_N = 0.0, position_sigma_m = 0.0;
  bool millimetres = false, noise_given = false, rigid_beside = false;
};

/// Plates of three to five sizes, each pressed once to thrice.
SandPlan draw_sand_plan(const CaseRequest& request, RandomStream& random);

/// An effect that changes the force by about `share`.
HiddenEffect draw_sand_effect(const std::string& name, double share, const SandPlan& plan,
                              RandomStream& random);

/// Depth that most presses reach, m, and the largest force with nothing hidden, N.
double usual_depth_m(const SandPlan& plan);
double largest_force_N(const SandPlan& plan);

}  // namespace hoof::tools::conceal
