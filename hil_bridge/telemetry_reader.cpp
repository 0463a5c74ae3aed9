#include "hil_bridge/telemetry_reader.h"

#include <hoof/sample_t.hpp>
#include <lcm/lcm-cpp.hpp>
#include <stdexcept>

#include "hil_bridge/recording.h"

namespace hoof::bridge {
namespace {

TelemetryRow to_row(const hoof::sample_t& message) {
  TelemetryRow row;
  row.time_ns = message.utime * 1'000 - kSimulatedEpoch_ns;
  row.tick = message.tick;
  row.depth_m = message.depth_m;
  row.sink_speed_m_s = message.sink_speed_m_s;
  for (std::size_t i = 0; i < 3; ++i) {
    row.foot_force_N[i] = message.foot_force_N[i];
    row.foot_torque_Nm[i] = message.foot_torque_Nm[i];
    row.desired[i] = {message.desired_position_rad[i], message.desired_velocity_rad_s[i],
                      message.desired_torque_Nm[i]};
    row.measured[i] = {message.measured_position_rad[i], message.measured_velocity_rad_s[i],
                       message.measured_torque_Nm[i]};
  }
  row.mode = message.mode;
  row.fault_bits = std::uint64_t(message.fault_bits);
  row.limit_bits = std::uint64_t(message.limit_bits);
  return row;
}

}  // namespace

std::vector<TelemetryRow> read_telemetry(const std::string& path) {
  lcm::LogFile file(path, "r");
  if (!file.good()) throw std::runtime_error(path + ": cannot be read as an LCM log");
  std::vector<TelemetryRow> rows;
  while (const lcm::LogEvent* event = file.readNextEvent()) {
    if (event->channel != kSampleChannel) continue;
    hoof::sample_t message{};
    if (message.decode(event->data, 0, event->datalen) < 0) {
      throw std::runtime_error(path + ": event " + std::to_string(event->eventnum) + " on " +
                               kSampleChannel +
                               " is not of the type hoof.sample_t of this program");
    }
    rows.push_back(to_row(message));
  }
  return rows;
}

}  // namespace hoof::bridge
