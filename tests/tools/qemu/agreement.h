// How far two runs of the same test sent the same frames.
#pragma once

#include <algorithm>
#include <set>

#include "tests/tools/emulator/image_bench.h"

namespace hoof::test {

using Commands = std::vector<hal::CanFrame>;

inline Commands commands(const RunRecord& record, int bus) {
  Commands found;
  for (const SeenFrame& s : record.frames) {
    if (s.bus == bus && is_command(s.frame)) found.push_back(s.frame);
  }
  return found;
}

inline std::size_t command_count(const RunRecord& record) {
  return commands(record, 0).size() + commands(record, 1).size();
}

/// Commands of the runs that are the same, byte for byte, on each bus from its first on.
inline std::size_t agreed_commands(const RunRecord& a, const RunRecord& b) {
  std::size_t count = 0;
  for (const int bus : {0, 1}) {
    const Commands of_a = commands(a, bus), of_b = commands(b, bus);
    const auto end = std::mismatch(of_a.begin(), of_a.end(), of_b.begin(), of_b.end()).first;
    count += std::size_t(end - of_a.begin());
  }
  return count;
}

/// Frames of anybody that are the same from the first on, their times included.
inline std::size_t agreed_frames(const RunRecord& a, const RunRecord& b) {
  const auto same = [](const SeenFrame& x, const SeenFrame& y) {
    return x.bus == y.bus && x.frame.stamp_ns == y.frame.stamp_ns && x.frame == y.frame;
  };
  const auto end =
      std::mismatch(a.frames.begin(), a.frames.end(), b.frames.begin(), b.frames.end(), same).first;
  return std::size_t(end - a.frames.begin());
}

/// How many commands are unlike all before: commands that never change would show nothing.
inline std::size_t different(const Commands& commands) {
  std::set<std::array<std::uint8_t, 8>> seen;
  for (const hal::CanFrame& frame : commands) {
    std::array<std::uint8_t, 8> bytes{};
    std::copy_n(frame.data.begin(), bytes.size(), bytes.begin());
    seen.insert(bytes);
  }
  return seen.size();
}

}  // namespace hoof::test
