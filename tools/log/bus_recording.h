// A bus log in memory: its frames by time, with the bus each went over.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hal/can_frame.h"

namespace hoof::tools {

struct LoggedFrame {
  std::int64_t stamp_ns = 0;  // Unix time
  int bus = 0;                // index into BusRecording::interfaces
  hal::CanFrame frame;
};

struct BusRecording {
  std::filesystem::path path;           // of the log
  std::vector<std::string> interfaces;  // by bus: names ending in 0, 1 are buses 0, 1
  std::vector<LoggedFrame> frames;      // by time; equal times in the order of the file
  std::int64_t origin_ns = 0;           // where times are told from: see origin_of()
  std::vector<std::string> notes;       // what a reader should know: unsorted, cut off

  double time_s(const LoggedFrame& frame) const {
    return double(frame.stamp_ns - origin_ns) * 1e-9;
  }
  std::int64_t first_ns() const { return frames.empty() ? origin_ns : frames.front().stamp_ns; }
  std::int64_t last_ns() const { return frames.empty() ? origin_ns : frames.back().stamp_ns; }
};

/// Time 0 of a recording: the simulated epoch where the first frame is of its first hour, so that
/// times are those of samples.csv, else the first frame.
std::int64_t origin_of(std::int64_t first_stamp_ns);

/// Gives each interface name the number of its bus; names are kept in the order they came.
class BusNames {
 public:
  /// can0 and vcan0 are bus 0, can1 is bus 1; a name without a number is the next free one.
  int bus_of(const std::string& interface);
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::vector<std::string> names_;
};

/// @param run_or_log a run's folder (its bus.log is taken) or a log in candump format
std::filesystem::path find_bus_log(const std::filesystem::path& run_or_log);

/// A last line without its line break that does not read is left out, with a note: a recorder was
/// stopped in it, or still writes.
/// @throws UserError where the file cannot be read, or naming the line that is broken and how
BusRecording read_bus_log(const std::filesystem::path& run_or_log);

}  // namespace hoof::tools
