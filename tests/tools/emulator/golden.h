// Host build and board's image, the same test: they must say the same, byte for byte.
#pragma once

#include <catch2/catch.hpp>
#include <cstdlib>

#include "tests/tools/emulator/image_bench.h"

namespace hoof::test {

/// `tools/hoof test --full`
inline bool full() {
  return std::getenv("HOOF_FULL_TESTS") != nullptr;
}

inline std::string text(const SeenFrame& s) {
  std::string line = std::to_string(s.frame.stamp_ns) + " ns bus " + std::to_string(s.bus) +
                     " id " + std::to_string(s.frame.id) + ":";
  for (int i = 0; i < s.frame.length; ++i) line += " " + std::to_string(s.frame.data[i]);
  return line;
}

/// Every frame on both buses, with its time to the nanosecond.
/// @param least_commands so many of them are drive commands, or the test compares too little
inline void require_same_frames(const RunRecord& host, const RunRecord& board,
                                std::size_t least_commands) {
  const std::size_t count = std::min(host.frames.size(), board.frames.size());
  std::size_t commands = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const SeenFrame& a = host.frames[i];
    const SeenFrame& b = board.frames[i];
    const bool same = a.bus == b.bus && a.frame.id == b.frame.id &&
                      a.frame.stamp_ns == b.frame.stamp_ns && a.frame == b.frame;
    if (!same) FAIL("frame " << i << ", host " << text(a) << "\n           image " << text(b));
    if (is_command(a.frame)) ++commands;
  }
  CHECK(host.frames.size() == board.frames.size());
  CHECK(commands >= least_commands);
}

/// The same, and the result.
inline void require_same(const RunRecord& host, const RunRecord& board,
                         std::size_t least_commands) {
  require_same_frames(host, board, least_commands);
  CHECK(host.result.ticks == board.result.ticks);
  CHECK(host.result.toe_reached_rad == board.result.toe_reached_rad);
}

}  // namespace hoof::test
