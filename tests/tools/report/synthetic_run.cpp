#include "tests/tools/report/synthetic_run.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/run/csv_writer.h"
#include "tools/run/output_file.h"
#include "tools/run/result_json.h"
#include "tools/run/version.h"

namespace hoof::tests {
namespace {

const std::vector<std::string> kColumns = {"time_s",
                                           "phase_name",
                                           "depth_m",
                                           "velocity_m_s",
                                           "fx_N",
                                           "fy_N",
                                           "fz_N",
                                           "toe_command_rad",
                                           "toe_measured_rad",
                                           "toe_torque_Nm",
                                           "hip_angle_rad",
                                           "knee_angle_rad",
                                           "hip_torque_Nm",
                                           "knee_torque_Nm",
                                           "bus0_load_ratio",
                                           "bus1_load_ratio",
                                           "toe_current_A",
                                           "hip_current_A",
                                           "knee_current_A",
                                           "exchange_energy_J",
                                           "contact_count",
                                           "toe_motor_degC",
                                           "hip_motor_degC",
                                           "knee_motor_degC",
                                           "hip_speed_rad_s"};

void write_samples(const std::filesystem::path& path, int sample_count) {
  tools::CsvWriter csv(path, kColumns);
  for (int i = 0; i < sample_count; ++i) {
    const double t = 0.001 * i;
    const double settled = 1.0 - std::exp(-4.0 * t);
    const double ring = std::exp(-3.0 * t) * std::sin(60.0 * t);
    const std::string_view phase = t < 0.4 ? "homing" : t < 0.8 ? "opening" : "loaded";
    const double toe_rad = t < 0.4 ? 0.0 : 0.5236;
    csv.row({t,
             phase,
             0.0138 * settled,
             0.1 * std::exp(-4.0 * t),
             6.0 * ring,
             -2.0 * ring,
             392.4 * settled + 40.0 * ring,
             toe_rad,
             toe_rad * settled,
             3.0 * ring,
             0.4 + 0.1 * ring,
             -0.9 - 0.1 * ring,
             40.0 * ring,
             -60.0 * ring,
             0.41,
             0.47,
             1.2 * ring,
             4.0 * ring,
             5.0 * ring,
             1e-4 * t,
             std::int64_t{i},
             30.0 + t,
             31.0 + t,
             32.0 + t,
             ring});
  }
  csv.close();
}

}  // namespace

void write_synthetic_run(const std::filesystem::path& folder, int sample_count) {
  tools::write_file(folder / "settings.toml",
                    "[experiment]\nkind = \"sinkage\"\nload_kg = 40.0\n"
                    "load_as = \"force\"\nspeed_m_s = 0.1\ntoe_deg = 30.0\n\n[foot]\nname = "
                    "\"bionic\"\n\n[bed]\nname = \"demo\"\n"
                    "note = \"</script><b>&\"\n");
  nlohmann::ordered_json result;
  result["frames"] = 12000;
  result["ticks"] = sample_count;
  result["max_depth_m"] = 0.013812345;
  result["final_depth_m"] = 0.01379;
  result["toe_command_rad"] = 0.5235987755982988;
  result["toe_reached_rad"] = 0.5229;
  result["toe_deflection_rad"] = 0.0007;
  result["torque_peak_Nm"] = {{"toe", 2.9}, {"hip", 39.0}, {"knee", 58.5}};
  result["gate_interventions"] = 0;
  result["bus_load_ratio"] = {{"bus0", 0.41}, {"bus1", 0.47}};
  result["resolution"] = {{"d50_m", 0.008},
                          {"grain_count", 20123},
                          {"spine_pitch_over_d50", 1.5},
                          {"sole_width_over_d50", 8.75},
                          {"sinkage_over_d50", 1.73},
                          {"box_over_foot", 2.4},
                          {"claims_refused",
                           {"absolute sinkage: the grains are coarser than the spines' pitch",
                            "effect of the spines: less than 3 grains between two spines"}}};
  result["version"] = tools::version_json();
  tools::write_result_json(folder / "result.json", result);
  write_samples(folder / "samples.csv", sample_count);
}

}  // namespace hoof::tests
