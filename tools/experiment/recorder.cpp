#include "tools/experiment/recorder.h"

#include <algorithm>

#include "hil_bridge/fault_targets.h"
#include "hil_bridge/recording_facts.h"
#include "tools/run/output_file.h"
#include "tools/run/sha256.h"
#include "tools/run/version.h"

namespace hoof::tools {
namespace {

std::vector<std::string> columns(const RunSettings& run) {
  std::vector<std::string> names = {"time_s",         "phase_name", "depth_m",
                                    "sink_speed_m_s", "foot_x_m",   "foot_z_m",
                                    "fx_N",           "fy_N",       "fz_N"};
  if (run.foot.has_toes) {
    for (const char* name : {"toe_command_rad", "toe_measured_rad"}) names.emplace_back(name);
    if (!run.concealed) {
      for (const char* name : {"toe_left_rad", "toe_right_rad", "toe_torque_Nm"}) {
        names.emplace_back(name);
      }
    }
  }
  if (run.firmware_leg()) {
    for (const std::string joint : {"hip", "knee"}) {
      names.insert(names.end(), {joint + "_command_rad", joint + "_measured_rad"});
      if (!run.concealed) names.push_back(joint + "_torque_Nm");
    }
  }
  return names;
}

bridge::RecordingFacts facts_of(const RunSettings& run, const std::string& wires) {
  auto facts = bridge::recording_facts(wires, run.coupling.exchange_s, run.parameters);
  for (const bridge::FaultSpec& fault : run.faults) {
    if (bridge::unseen_by_bus(fault, bridge::find_target(fault, run.has_drives()))) {
      facts.unseen_faults.push_back(fault.name());
    }
  }
  return facts;
}

}  // namespace

Recorder::Recorder(const RunSettings& run, const std::string& wires,
                   const std::filesystem::path& folder, bool live)
    : run_(run),
      samples_(folder / "samples.csv", columns(run)),
      bus_log_({(folder / "bus.log").string()}),
      telemetry_({(folder / "telemetry.lcm").string(), live, ""}) {
  bridge::TelemetryRun start;
  start.experiment = run.kind;
  start.foot = run.foot_name;
  start.code_version = std::string(build_version().code);
  start.firmware_hash = sha256_hex_of_file(run.image.empty() ? "/proc/self/exe" : run.image);
  telemetry_.write(start);
  write_file(folder / bridge::kRecordingFactsFile, to_json(facts_of(run, wires)));
}

std::vector<CsvCell> Recorder::cells(const bridge::TickRecord& r) const {
  const sim::Observation& o = r.plant;
  std::vector<CsvCell> row = {
      o.time_s,     sim::to_string(o.phase), o.depth_m,      o.sink_speed_m_s, o.foot_m.x(),
      o.foot_m.z(), o.ground_N.x(),          o.ground_N.y(), o.ground_N.z()};
  if (run_.foot.has_toes) {
    row.emplace_back(double(r.firmware.toe_set_point_rad));
    row.emplace_back(double(r.firmware.state[0].position_rad));
    if (!run_.concealed) {
      for (const double v : {o.toe_left_rad, o.toe_right_rad, r.torques.mean_Nm[0]}) {
        row.emplace_back(v);
      }
    }
  }
  if (run_.firmware_leg()) {
    const auto& wanted = r.firmware.leg_set_point_rad;
    const double command_rad[] = {double(wanted.hip_rad), double(wanted.knee_rad)};
    for (const int joint : {1, 2}) {
      row.emplace_back(command_rad[joint - 1]);
      row.emplace_back(double(r.firmware.state[joint].position_rad));
      if (!run_.concealed) row.emplace_back(r.torques.mean_Nm[joint]);
    }
  }
  return row;
}

bridge::TelemetryRow Recorder::telemetry_row(const bridge::TickRecord& r) const {
  bridge::TelemetryRow row;
  row.time_ns = r.firmware.time_ns;
  row.tick = r.firmware.tick;
  row.depth_m = r.plant.depth_m;
  row.sink_speed_m_s = r.plant.sink_speed_m_s;
  for (int axis = 0; axis < 3; ++axis) row.foot_force_N[axis] = r.plant.ground_N[axis];
  for (int j = 0; j < sim::kJointCount; ++j) {
    const auto& command = r.firmware.verdict.joint[j].command;
    const auto& state = r.firmware.state[j];
    row.desired[j] = {command.position_rad, command.velocity_rad_s, command.torque_Nm};
    row.measured[j] = {state.position_rad, state.velocity_rad_s, state.torque_Nm};
  }
  row.mode = std::int32_t(r.firmware.mode);
  row.fault_bits = r.firmware.faults;
  row.limit_bits = r.firmware.verdict.active_limits();
  return row;
}

void Recorder::tick(const bridge::TickRecord& r) {
  const std::vector<CsvCell> row = cells(r);
  samples_.row(std::span<const CsvCell>(row));
  telemetry_.write(telemetry_row(r));
  const sim::Observation& o = r.plant;
  if (o.phase != sim::Phase::kLoaded) return;
  forces_.push_back({o.time_s, o.ground_N.x(), o.ground_N.z()});
  if (!run_.is_sinkage()) {
    ellipse_error_m_ =
        std::max(ellipse_error_m_, run_.traction.ellipse.distance_m({o.foot_m.x(), o.foot_m.z()}));
  }
}

void Recorder::close() {
  samples_.close();
  bus_log_.close();
  telemetry_.close();
}

}  // namespace hoof::tools
