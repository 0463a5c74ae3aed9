#include "sim/terrain/rft_settings.h"

#include <cmath>
#include <cstring>
#include <sstream>
#include <stdexcept>

namespace hoof::sim {

void RftTerrainSettings::validate() const {
  const auto require = [](bool holds, const char* name, double value, const char* rule) {
    if (holds) return;
    std::ostringstream text;
    text << name << " = " << value << ": must be " << rule;
    throw std::invalid_argument(text.str());
  };
  const bool linear = pressure_law == PressureLaw::kLinear;
  require(!linear || xi_n_N_m3.value > 0, "xi_n_N_m3", xi_n_N_m3.value, "above 0");
  require(linear || bekker_width_m > 0, "bekker_width_m", bekker_width_m, "above 0");
  require(linear || bekker_exponent > 0, "bekker_exponent", bekker_exponent, "above 0");
  const double k_Pa = linear ? 1 : bekker_k_c_N_m / bekker_width_m + bekker_k_phi_Pa;
  require(k_Pa > 0, "bekker_k_c_N_m / bekker_width_m + bekker_k_phi_Pa", k_Pa, "above 0");
  require(surface_friction >= 0, "surface_friction", surface_friction, "at least 0");
  require(yield_displacement_m.value > 0, "yield_displacement_m", yield_displacement_m.value,
          "above 0");
  require(damping_s >= 0, "damping_s", damping_s, "at least 0");
  require(facet_size_m > 0, "facet_size_m", facet_size_m, "above 0");
}

std::uint64_t RftTerrainSettings::hash() const {
  std::uint64_t hash = 14695981039346656037u;  // FNV-1a, 64 bits
  for (const double value :
       {surface_height_m, double(pressure_law), xi_n_N_m3.value, bekker_k_phi_Pa, bekker_k_c_N_m,
        bekker_exponent, bekker_width_m, surface_friction, yield_displacement_m.value, damping_s,
        facet_size_m}) {
    unsigned char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    for (const unsigned char byte : bytes) hash = (hash ^ byte) * 1099511628211u;
  }
  return hash;
}

RftTerrainSettings read_rft_terrain(Reader section) {
  RftTerrainSettings soil;
  section.text("name", soil.name);
  section.number("surface_height_mm", soil.surface_height_m, kMillimetre, -1000.0, 1000.0);
  std::string law;
  section.choice("pressure_law", law, {"linear", "bekker"});
  soil.pressure_law = law == "bekker" ? PressureLaw::kBekker : PressureLaw::kLinear;
  section.measured("xi_n_N_m3", soil.xi_n_N_m3, kNewtonPerCubicMetre, 1e3, 1e9);
  section.number("bekker_k_phi_Pa", soil.bekker_k_phi_Pa, kPascal, -1e9, 1e9);
  section.number("bekker_k_c_N_m", soil.bekker_k_c_N_m, kNewtonPerMetre, -1e9, 1e9);
  section.number("bekker_exponent", soil.bekker_exponent, kUnitless, 0.1, 3.0);
  section.number("bekker_width_mm", soil.bekker_width_m, kMillimetre, 1.0, 1000.0);
  section.number("surface_friction", soil.surface_friction, kUnitless, 0.0, 5.0);
  section.measured("yield_displacement_mm", soil.yield_displacement_m, kMillimetre, 0.01, 50.0);
  section.number("damping_ms", soil.damping_s, kMillisecond, 0.0, 100.0);
  section.number("facet_size_mm", soil.facet_size_m, kMillimetre, 1.0, 100.0);
  section.number("fit_error_ratio", soil.fit_error, kUnitless, 0.0, 100.0);
  section.number("held_out_error_ratio", soil.held_out_error, kUnitless, 0.0, 100.0);
  section.text("fitted_to", soil.fitted_to);
  section.finish();
  section.check([&soil] { soil.validate(); });
  return soil;
}

}  // namespace hoof::sim
