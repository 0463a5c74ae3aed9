#include "hil_bridge/telemetry_log.h"

#include <cerrno>
#include <cstdio>
#include <hoof/run_t.hpp>
#include <hoof/sample_t.hpp>
#include <lcm/lcm-cpp.hpp>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include "hil_bridge/recording.h"

namespace hoof::bridge {
namespace {

std::int64_t utime_of(std::int64_t time_ns) {
  return (kSimulatedEpoch_ns + time_ns) / 1'000;
}

hoof::run_t to_message(const TelemetryRun& run) {
  hoof::run_t message;
  message.utime = utime_of(0);
  message.experiment = run.experiment;
  message.foot = run.foot;
  message.code_version = run.code_version;
  message.firmware_hash = run.firmware_hash;
  message.control_period_s = run.control_period_s;
  return message;
}

hoof::sample_t to_message(const TelemetryRow& row) {
  hoof::sample_t message;
  message.utime = utime_of(row.time_ns);
  message.tick = row.tick;
  message.time_s = static_cast<double>(row.time_ns) * 1e-9;
  message.depth_m = row.depth_m;
  message.sink_speed_m_s = row.sink_speed_m_s;
  for (std::size_t i = 0; i < 3; ++i) {
    message.foot_force_N[i] = row.foot_force_N[i];
    message.foot_torque_Nm[i] = row.foot_torque_Nm[i];
    message.desired_position_rad[i] = row.desired[i].position_rad;
    message.desired_velocity_rad_s[i] = row.desired[i].velocity_rad_s;
    message.desired_torque_Nm[i] = row.desired[i].torque_Nm;
    message.measured_position_rad[i] = row.measured[i].position_rad;
    message.measured_velocity_rad_s[i] = row.measured[i].velocity_rad_s;
    message.measured_torque_Nm[i] = row.measured[i].torque_Nm;
  }
  message.mode = row.mode;
  message.fault_bits = static_cast<std::int64_t>(row.fault_bits);
  message.limit_bits = static_cast<std::int64_t>(row.limit_bits);
  return message;
}

}  // namespace

/// Keeps LCM out of the header.
class TelemetryLog::Writer {
 public:
  explicit Writer(TelemetryLogSettings settings) : settings_(std::move(settings)) {
    if (settings_.live) {
      live_ = std::make_unique<lcm::LCM>(settings_.live_url);
      if (!live_->good()) {
        throw std::runtime_error("live telemetry: LCM cannot use the address '" +
                                 settings_.live_url + "'");
      }
    }
    errno = 0;
    file_ = std::make_unique<lcm::LogFile>(settings_.path, "w");
    if (!file_->good()) fail("cannot create ");
  }

  template <typename Message>
  void write(const char* channel, const Message& message) {
    const int size = message.getEncodedSize();
    encoded_.resize(static_cast<std::size_t>(size));
    message.encode(encoded_.data(), 0, size);

    lcm::LogEvent event;
    event.eventnum = 0;  // LogFile numbers them
    event.timestamp = message.utime;
    event.channel = channel;
    event.datalen = size;
    event.data = encoded_.data();
    errno = 0;
    if (file_->writeEvent(&event) != 0) fail("cannot write ");
    if (message.utime >= flushed_until_us_ + kRecordingFlush_ns / 1'000) {
      flush();
      flushed_until_us_ = message.utime;
    }
    if (live_ && live_->publish(channel, encoded_.data(), static_cast<unsigned>(size)) != 0) {
      ++live_failures_;
    }
  }

  void close() {
    if (!file_) return;
    errno = 0;
    const bool flushed = std::fflush(file_->getFilePtr()) == 0;
    const int error_number = errno;
    file_.reset();
    errno = error_number;
    if (!flushed) fail("cannot write ");
  }

  std::uint64_t rows = 0;
  std::uint64_t live_failures() const { return live_failures_; }

 private:
  void flush() {
    errno = 0;
    if (std::fflush(file_->getFilePtr()) != 0) fail("cannot write ");
  }

  [[noreturn]] void fail(const char* action) const {
    const int error_number = errno != 0 ? errno : EIO;
    throw std::system_error(error_number, std::generic_category(), action + settings_.path);
  }

  TelemetryLogSettings settings_;
  std::unique_ptr<lcm::LCM> live_;
  std::unique_ptr<lcm::LogFile> file_;
  std::vector<std::uint8_t> encoded_;
  std::int64_t flushed_until_us_ = 0;
  std::uint64_t live_failures_ = 0;
};

TelemetryLog::TelemetryLog(TelemetryLogSettings settings)
    : writer_(std::make_unique<Writer>(std::move(settings))) {}

TelemetryLog::~TelemetryLog() {
  try {
    close();
  } catch (const std::system_error&) {
    // Nobody is left to tell; documented at the destructor.
  }
}

void TelemetryLog::write(const TelemetryRun& run) {
  writer_->write(kRunChannel, to_message(run));
}

void TelemetryLog::write(const TelemetryRow& row) {
  writer_->write(kSampleChannel, to_message(row));
  ++writer_->rows;
}

void TelemetryLog::close() {
  writer_->close();
}

std::uint64_t TelemetryLog::rows() const {
  return writer_->rows;
}

std::uint64_t TelemetryLog::live_failures() const {
  return writer_->live_failures();
}

}  // namespace hoof::bridge
