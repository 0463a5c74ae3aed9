// The press of a study on fast soil, with physics of the catalogue in it.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "sim/terrain/rft_settings.h"
#include "tools/study/press.h"

namespace hoof::tools {

/// Values of an effect's parameters in their order, SI; no name: none.
struct SoilEffectChoice {
  std::string name;
  std::vector<double> values;
};

/// An indenter straight down at the case's speed to its depth, in steps of 0.1 mm. Box, grains and
/// seed mean nothing to this soil.
/// @throws std::invalid_argument where there is no such effect of the soil
PressCurve press_fast_soil(const PressCase& c, const sim::RftTerrainSettings& soil,
                           const SoilEffectChoice& effect);

/// Where a rising or falling function meets a target, sought by the logarithm of its argument.
/// @return the nearer end where it does not between low and high, both positive
double solve_monotone(const std::function<double(double)>& f, double target, double low,
                      double high);

}  // namespace hoof::tools
