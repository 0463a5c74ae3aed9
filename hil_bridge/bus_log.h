// bus.log: every frame that went over the buses of a run, as candump lines.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hal/can_frame.h"

namespace hoof::bridge {

struct BusLogSettings {
  std::string path;
  std::vector<std::string> interfaces = {"can0", "can1"};  // name of bus 0, bus 1, ...
};

/// Writes whole lines at a time: a run that is killed leaves a log that can be read up to its last
/// 10 ms of simulated time or 64 KiB, whichever is less. Only where it is killed in the very write
/// can the last line be cut; CandumpReader leaves such a line out.
class BusLogWriter {
 public:
  /// Creates the file, or empties it. Whether an earlier one may be replaced is the caller's
  /// decision.
  /// @throws std::system_error naming the path and the reason
  explicit BusLogWriter(BusLogSettings settings);
  ~BusLogWriter();  // closes; errors are lost here, so call close() first
  BusLogWriter(const BusLogWriter&) = delete;
  BusLogWriter& operator=(const BusLogWriter&) = delete;

  /// @param bus_index index into settings.interfaces
  /// @param frame its stamp_ns is simulated time from 0; the line carries it from the simulated
  /// epoch
  /// @throws std::system_error when the disk is full and the like; std::out_of_range for a bus
  /// without a name
  void write(int bus_index, const hal::CanFrame& frame);

  /// Hands everything to the operating system.
  void flush();

  /// Flushes and closes; further calls do nothing.
  /// @throws std::system_error
  void close();

  std::uint64_t frames() const { return frames_; }

 private:
  [[noreturn]] void fail(const char* action, int error_number) const;

  BusLogSettings settings_;
  int fd_ = -1;
  std::string buffer_;
  std::int64_t flushed_until_ns_ = 0;
  std::uint64_t frames_ = 0;
};

}  // namespace hoof::bridge
