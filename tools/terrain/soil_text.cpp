#include "tools/terrain/soil_text.h"

#include <cstdio>

#include "sim/config/settings.h"
#include "tools/run/csv_writer.h"

namespace hoof::tools {
namespace {

std::string quoted(const std::string& text) {
  return sim::to_text(sim::Value(text));
}

std::string measured(const sim::Measured& m, double units_in_si) {
  return "{ value = " + format_number(m.value * units_in_si) +
         ", sigma = " + format_number(m.sigma * units_in_si) + ", source = " + quoted(m.source) +
         " }";
}

}  // namespace

std::string soil_toml(const sim::RftTerrainSettings& soil, const std::string& command) {
  const bool linear = soil.pressure_law == sim::PressureLaw::kLinear;
  std::string t;
  const auto line = [&t](const std::string& text) { t += text + "\n"; };
  const auto number = [&](const char* key, double value) {
    line(std::string(key) + " = " + format_number(value));
  };
  line("# A fast soil for --terrain rft, made by");
  line("#   " + command);
  line("name = " + quoted(soil.name));
  number("surface_height_mm", soil.surface_height_m * 1e3);
  line(
      "# \"linear\": xi_n times depth. \"bekker\": (k_c / b + k_phi) (z / 1 m)^n of a flat plate.");
  line("pressure_law = " + quoted(linear ? "linear" : "bekker"));
  line("xi_n_N_m3 = " + measured(soil.xi_n_N_m3, 1));
  if (linear) line("# Not fitted; not used with the linear law.");
  number("bekker_k_phi_Pa", soil.bekker_k_phi_Pa);
  number("bekker_k_c_N_m", soil.bekker_k_c_N_m);
  number("bekker_exponent", soil.bekker_exponent);
  line("# b: the smaller width of the foot that will stand on it.");
  number("bekker_width_mm", soil.bekker_width_m * 1e3);
  line("# Of the sand on the pushed plates, as the grains had it: not fitted.");
  number("surface_friction", soil.surface_friction);
  line("yield_displacement_mm = " + measured(soil.yield_displacement_m, 1e3));
  line("# A foot of 1.5 kg under 400 N then stops ringing within a few cycles. Estimate.");
  number("damping_ms", soil.damping_s * 1e3);
  number("facet_size_mm", soil.facet_size_m * 1e3);
  line("# rms of measured less predicted force over rms of the measured.");
  number("fit_error_ratio", soil.fit_error);
  number("held_out_error_ratio", soil.held_out_error);
  line("fitted_to = " + quoted(soil.fitted_to));
  return t;
}

std::string fit_table(const SoilFit& fit) {
  std::string table =
      "push                                            set       rms force   error"
      "   own xi_n\n";
  char line[200];
  for (const CaseError& c : fit.cases) {
    std::snprintf(line, sizeof line, "%-46s  %-8s %8.1f N %6.1f %% %8.3g N/m3\n", c.name.c_str(),
                  c.held_out ? "held out" : "fitted", c.force_N, 100 * c.ratio, c.xi_n_N_m3);
    table += line;
  }
  if (fit.soil.pressure_law == sim::PressureLaw::kLinear) {
    std::snprintf(line, sizeof line, "xi_n = %.4g N/m3 (spread of the pushes %.2g)\n",
                  fit.soil.xi_n_N_m3.value, fit.soil.xi_n_N_m3.sigma);
  } else {
    std::snprintf(line, sizeof line, "p = (%.4g N/m / b + %.4g Pa) (z / 1 m)^%.3f\n",
                  fit.soil.bekker_k_c_N_m, fit.soil.bekker_k_phi_Pa, fit.soil.bekker_exponent);
  }
  table += line;
  std::snprintf(line, sizeof line, "yield displacement %.2f mm (%s)\n",
                fit.soil.yield_displacement_m.value * 1e3,
                fit.soil.yield_displacement_m.source.c_str());
  table += line;
  std::snprintf(line, sizeof line,
                "error: %.1f %% on the pushes fitted, %.1f %% on those held out\n",
                100 * fit.fit_error, 100 * fit.held_out_error);
  return table + line;
}

}  // namespace hoof::tools
