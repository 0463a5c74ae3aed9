// The foot in the sand, cut along a plane of constant y, as an SVG drawing.
#pragma once

#include <string>

#include "sim/dem/grain.h"
#include "sim/multibody/rig.h"

namespace hoof::tools {

/// Grains as circles where the plane cuts them, the darker the further they were moved; the foot's
/// outline; a scale. World x to the right (the robot's forward), z up.
/// @param before, after the bed at the start and at the end, same grains
/// @param cut_y_m where the plane stands
std::string draw_section(const sim::BedState& before, const sim::BedState& after,
                         const sim::Rig& rig, double d50_m, double cut_y_m);

}  // namespace hoof::tools
