// What the loop counts; all since start.
#pragma once

#include <cstdint>

namespace hoof::firmware::app {

struct Counters {
  std::uint32_t ticks = 0;             // control ticks run
  std::uint32_t missed_ticks = 0;      // SYNC numbers that never came, or came too late to be used
  std::uint32_t stale_syncs = 0;       // repeated or older SYNC numbers, ignored
  std::uint32_t frames = 0;            // understood
  std::uint32_t unknown_frames = 0;    // identifier not ours, or on the wrong bus
  std::uint32_t malformed_frames = 0;  // extended, remote, FD, error; short or long; wrong drive
  std::uint32_t bad_crc_frames = 0;
  std::uint32_t refused_orders = 0;  // orders, connections and services
  std::uint32_t overruns = 0;        // ticks that took longer than a tick
  std::uint32_t unsent_frames = 0;   // the bus would not take them

  std::uint32_t bad_frames() const { return unknown_frames + malformed_frames + bad_crc_frames; }
};

}  // namespace hoof::firmware::app
