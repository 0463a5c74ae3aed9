// Maps of a moment as SVG drawings with a colour bar each, as the paper's nephograms (figures 14,
// 16, 20, 21, 24, 26, 27).
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/fields/field_scene.h"

namespace hoof::tools {

struct FieldMap {
  std::string key;     // "speed": of the file's name
  std::string title;   // what is shown
  std::string number;  // what was measured of it, in words
  std::string svg;
};

/// Viridis (S. van der Walt, N. Smith, matplotlib, CC0) from 0 to 1, as "#rrggbb".
std::string viridis(double share);

/// Grain speed, kinetic energy, displacement, rearward speed, vertical stress and force chains in a
/// cut along x at cut_y_m; pressure on the soles from below. A bar goes from zero to the value that
/// one in a hundred of what is drawn exceeds.
/// @param measured of the moment, by measure_fields()
std::vector<FieldMap> field_maps(const FieldScene& scene, const FieldMoment& contact,
                                 const nlohmann::ordered_json& measured, double cut_y_m);

}  // namespace hoof::tools
