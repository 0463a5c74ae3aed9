// telemetry.lcm: typed telemetry of a run as an LCM log (types in hil_bridge/messages), written in
// this process so that nothing is lost however fast the simulator runs; on request also published
// live.
//
// LCM stays in the .cpp files here: rows come in as the plain structs below.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>

namespace hoof::bridge {

/// Channels, in the log and live.
inline constexpr char kRunChannel[] = "HOOF_RUN";
inline constexpr char kSampleChannel[] = "HOOF_SAMPLE";

/// Who ran what; see messages/hoof_run_t.lcm.
struct TelemetryRun {
  std::string experiment;
  std::string foot;
  std::string code_version;
  std::string firmware_hash;
  double control_period_s = 0.001;
};

/// Of one drive, on the joint's side.
struct TelemetryJoint {
  double position_rad = 0.0;
  double velocity_rad_s = 0.0;
  double torque_Nm = 0.0;
};

/// One control tick; meaning and frames in messages/hoof_sample_t.lcm.
struct TelemetryRow {
  std::int64_t time_ns = 0;  // simulated time from 0
  std::int64_t tick = 0;
  double depth_m = 0.0;
  double sink_speed_m_s = 0.0;
  std::array<double, 3> foot_force_N{};
  std::array<double, 3> foot_torque_Nm{};
  std::array<TelemetryJoint, 3> desired{};  // toe, hip, knee
  std::array<TelemetryJoint, 3> measured{};
  std::int32_t mode = 0;
  std::uint64_t fault_bits = 0;
  std::uint64_t limit_bits = 0;
};

struct TelemetryLogSettings {
  std::string path;
  bool live = false;     // also publish each event at once
  std::string live_url;  // LCM provider; empty: LCM_DEFAULT_URL, else UDP multicast on this machine
};

/// Events are stamped with simulated time from the simulated epoch, so the same rows give the same
/// bytes. A run that is killed leaves a log that LCM reads up to about its last 10 ms.
class TelemetryLog {
 public:
  /// Creates the file, or empties it.
  /// @throws std::system_error naming the path; std::runtime_error naming a live URL that cannot be
  /// used
  explicit TelemetryLog(TelemetryLogSettings settings);
  ~TelemetryLog();  // closes; errors are lost here, so call close() first
  TelemetryLog(const TelemetryLog&) = delete;
  TelemetryLog& operator=(const TelemetryLog&) = delete;

  /// @throws std::system_error when the disk is full and the like, naming the path
  void write(const TelemetryRun& run);
  void write(const TelemetryRow& row);

  /// Flushes and closes; further calls do nothing.
  /// @throws std::system_error
  void close();

  std::uint64_t rows() const;
  /// Events that live listeners did not get because sending failed; never a reason to end a run.
  std::uint64_t live_failures() const;

 private:
  class Writer;
  std::unique_ptr<Writer> writer_;
};

}  // namespace hoof::bridge
