// What a recording holds, and what is wrong with it.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/log/bus_recording.h"

namespace hoof::tools {

/// All frames of one identifier on one bus.
struct IdStatistics {
  int bus = 0;
  hal::CanFrame example;
  std::uint64_t count = 0;
  std::int64_t first_ns = 0, last_ns = 0;  // Unix time
  std::int64_t shortest_ns = INT64_MAX;    // between two of them
  std::int64_t longest_ns = 0;
  std::int64_t longest_from_ns = 0;             // when the longest gap began
  std::map<std::string, std::uint64_t> faults;  // frames that do not read, by reason

  double rate_Hz() const {
    return last_ns > first_ns ? double(count - 1) * 1e9 / double(last_ns - first_ns) : 0;
  }
};

struct BusStatistics {
  std::uint64_t frames = 0, error_frames = 0;
  double mean_load_ratio = 0, worst_10ms_ratio = 0;  // at 1 Mbit/s, from the frames' own bits
};

struct LogStatistics {
  std::vector<IdStatistics> ids;  // by bus, then identifier
  std::vector<BusStatistics> buses;
  std::optional<std::uint32_t> first_tick, last_tick;  // of SYNC
  std::vector<std::string> findings;  // one line each: gaps, faults, what does not read
};

LogStatistics measure(const BusRecording& recording);

/// Tables and findings for a terminal.
void print_info(const BusRecording& recording, std::ostream& out);

}  // namespace hoof::tools
