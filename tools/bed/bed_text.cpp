#include "tools/bed/bed_text.h"

#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <fstream>

#include "sim/dem/contact_material.h"
#include "tools/run/progress_line.h"
#include "tools/run/result_json.h"

namespace hoof::tools {
namespace {

std::filesystem::path making_file(const std::filesystem::path& bed_file) {
  return bed_file.string() + ".making.json";
}

double step_over_rayleigh(const ChosenBed& origin, double step_s) {
  const sim::DemSettings dem = sim::dem_settings(origin.bed, origin.materials, 1);
  return step_s / sim::rayleigh_time_s(dem.grain_material, origin.bed.smallest_diameter_m() / 2);
}

[[gnu::format(printf, 2, 3)]] void print(std::string& text, const char* format, ...) {
  char line[256];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(line, sizeof line, format, arguments);
  va_end(arguments);
  text += line;
}

}  // namespace

nlohmann::ordered_json bed_json(const ChosenBed& origin, const sim::BedReport& report) {
  const sim::BedSettings& bed = origin.bed;
  nlohmann::ordered_json grading = nlohmann::ordered_json::array();
  for (std::size_t k = 0; k < bed.sieve.size(); ++k) {
    grading.push_back({{"low_m", bed.grain_scale * bed.sieve[k].low_m},
                       {"high_m", bed.grain_scale * bed.sieve[k].high_m},
                       {"wanted_mass_share", bed.sieve[k].mass_share},
                       {"got_mass_share", report.graded_share[k]}});
  }
  nlohmann::ordered_json json = {
      {"name", bed.name},
      {"file", origin.file.string()},
      {"seed", origin.seed},
      {"box_length_m", bed.box_length_m},
      {"box_width_m", bed.box_width_m},
      {"depth_m", bed.depth_m},
      {"sides", bed.periodic_sides ? "periodic" : "walls"},
      {"grains", report.grains},
      {"solids_kg", report.solids_kg},
      {"d50_m", bed.d50_m()},
      {"solid_share", report.solid_share},
      {"layer_solid_share", report.layer_solid_share},
      {"coordination_number", report.coordination_number},
      {"region_grains", report.region_grains},
      {"largest_region_deviation", report.largest_region_deviation},
      {"grading", grading},
      {"largest_overlap_ratio", report.largest_overlap_ratio},
      {"kinetic_energy_J", report.kinetic_energy_J},
      {"energy_ratio", report.energy_ratio},
      {"highest_grain_m", report.highest_grain_m},
      {"step_s", bed.step_s()},
      {"step_over_rayleigh", step_over_rayleigh(origin, bed.step_s())},
      {"settling_step_s", bed.settling_step_s()},
      {"settling_step_over_rayleigh", step_over_rayleigh(origin, bed.settling_step_s())}};
  const nlohmann::ordered_json making = read_making(origin.file);
  if (!making.is_null()) json["making"] = making;
  return json;
}

std::string bed_text(const ChosenBed& origin, const sim::BedReport& report) {
  const sim::BedSettings& bed = origin.bed;
  std::string t;
  print(t, "bed '%s', seed %llu: %.0f x %.0f mm, %.0f mm deep, sides: %s\n", bed.name.c_str(),
        static_cast<unsigned long long>(origin.seed), bed.box_length_m * 1e3, bed.box_width_m * 1e3,
        bed.depth_m * 1e3, bed.periodic_sides ? "periodic" : "walls");
  print(t, "grains               %zu, %.3f kg, d50 %.2f mm\n", report.grains, report.solids_kg,
        bed.d50_m() * 1e3);
  print(t, "solid share          %.4f between a tenth and nine tenths of the depth\n",
        report.solid_share);
  t += "  tenths, floor first";
  for (const double share : report.layer_solid_share) print(t, " %.3f", share);
  print(t, "\ncoordination number  %.3f touching partners of a grain\n",
        report.coordination_number);
  print(
      t, "uniformity           grain counts of %d x %d x 1 regions within %.1f %% of their mean\n",
      sim::BedReport::kRegionsX, sim::BedReport::kRegionsY, 100 * report.largest_region_deviation);
  for (std::size_t k = 0; k < bed.sieve.size(); ++k) {
    print(t, "%s%6.2f to %6.2f mm: wanted %5.2f %% of the mass, got %5.2f %%\n",
          k == 0 ? "grading              " : "                     ",
          bed.grain_scale * bed.sieve[k].low_m * 1e3, bed.grain_scale * bed.sieve[k].high_m * 1e3,
          100 * bed.sieve[k].mass_share, 100 * report.graded_share[k]);
  }
  print(t, "largest overlap      %.4f %% of the smaller radius\n",
        100 * report.largest_overlap_ratio);
  print(t, "kinetic energy       %.3g J, %.2g of what lifts each grain by its diameter\n",
        report.kinetic_energy_J, report.energy_ratio);
  print(t, "level                highest grain %.2f mm below the scraper\n",
        -1e3 * report.highest_grain_m);
  print(t, "time step            %.4g us, %.1f %% of the Rayleigh time of the smallest grain\n",
        bed.step_s() * 1e6, 100 * step_over_rayleigh(origin, bed.step_s()));
  print(t, "  while it was made  %.4g us, %.1f %%\n", bed.settling_step_s() * 1e6,
        100 * step_over_rayleigh(origin, bed.settling_step_s()));
  const nlohmann::ordered_json making = read_making(origin.file);
  if (!making.is_null()) {
    print(t, "made in              %s on %d threads, %lld steps\n",
          format_duration(making.at("wall_s").get<double>()).c_str(),
          making.at("threads").get<int>(), making.at("steps").get<long long>());
  }
  return t;
}

nlohmann::ordered_json read_making(const std::filesystem::path& bed_file) {
  std::ifstream in(making_file(bed_file));
  // It is for people to know and decides nothing: a damaged one is as good as none.
  const auto making = nlohmann::ordered_json::parse(in, nullptr, false);
  const bool whole = making.is_object() && making.contains("wall_s") &&
                     making.contains("threads") && making.contains("steps");
  return whole ? making : nlohmann::ordered_json();
}

void write_making(const std::filesystem::path& bed_file, const nlohmann::ordered_json& making) {
  write_result_json(making_file(bed_file), making);
}

}  // namespace hoof::tools
