// The files of a run as they grow: samples.csv, bus.log, telemetry.lcm.
#pragma once

#include <filesystem>
#include <vector>

#include "hil_bridge/bus_log.h"
#include "hil_bridge/session.h"
#include "hil_bridge/telemetry_log.h"
#include "tools/experiment/run_settings.h"
#include "tools/run/csv_writer.h"

namespace hoof::tools {

/// Ground on foot at one tick, for peaks.
struct ForceSample {
  double time_s;
  double fx_N;
  double fz_N;
};

class Recorder {
 public:
  /// @param wires what carries the frames, as recording.json is to name it
  /// @throws UserError, std::system_error where a file cannot be written
  Recorder(const RunSettings& run, const std::string& wires, const std::filesystem::path& folder,
           bool live);

  void frame(int bus, const hal::CanFrame& frame) { bus_log_.write(bus, frame); }
  void tick(const bridge::TickRecord& record);
  void close();

  const std::vector<ForceSample>& forces() const { return forces_; }
  double ellipse_error_m() const { return ellipse_error_m_; }

 private:
  std::vector<CsvCell> cells(const bridge::TickRecord& record) const;
  bridge::TelemetryRow telemetry_row(const bridge::TickRecord& record) const;

  const RunSettings& run_;
  CsvWriter samples_;
  bridge::BusLogWriter bus_log_;
  bridge::TelemetryLog telemetry_;
  std::vector<ForceSample> forces_;
  double ellipse_error_m_ = 0;
};

}  // namespace hoof::tools
