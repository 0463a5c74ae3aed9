// A recorded bus drives the real firmware, and its answers are held against the recorded ones, byte
// for byte.
//
// The firmware is polled at the recorded run's own times (every exchange interval), on a clock that
// stands at them, and receives what had arrived by then; so it computes what it computed. A frame
// is the firmware's own where the dictionary names it as the sender: one that somebody else sent
// under the foot's identifier reads as a difference.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "firmware/app/control_loop.h"
#include "hil_bridge/recording_facts.h"
#include "tools/log/bus_recording.h"

namespace hoof::tools {

/// The first answer that is not the recorded one.
struct ReplayDifference {
  std::uint32_t tick = 0;  // the last SYNC that the firmware had seen
  double time_s = 0;
  int bus = 0;
  std::optional<hal::CanFrame> recorded;  // none: the firmware now sends one more
  std::optional<hal::CanFrame> replayed;  // none: it does not send it
  std::uint32_t id = 0;

  /// One line: tick, time, bus, frame, signal, both values; then one for each further signal.
  std::string text(const std::vector<std::string>& interfaces) const;
};

struct ReplayResult {
  std::uint64_t compared = 0;  // answers that were the same
  std::uint64_t fed = 0;       // frames of other nodes
  std::uint32_t last_tick = 0;
  std::string answers_sha256;  // over bus, identifier and data of the answers, in order
  std::optional<ReplayDifference> difference;
  bool stopped = false;  // at the tick asked for
};

struct ReplayOptions {
  std::optional<std::uint32_t> to_tick;
  /// Called before the firmware runs tick `to_tick`.
  std::function<void(const firmware::app::ControlLoop&)> at_tick;
  /// Called after the firmware has run it.
  std::function<void(const firmware::app::ControlLoop&)> after_tick;
};

/// @throws std::invalid_argument where such a recording cannot be replayed exactly: what and why
ReplayResult replay(const BusRecording& recording, const bridge::RecordingFacts& facts,
                    const ReplayOptions& options = {});

}  // namespace hoof::tools
