// Helpers for tests of the in-process wire.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hal/in_process/in_process_bus.h"

namespace hoof::test {

inline hal::CanFrame frame(std::uint32_t id, std::vector<std::uint8_t> data = {}) {
  hal::CanFrame out;
  out.id = id;
  out.length = static_cast<std::uint8_t>(data.size());
  for (std::size_t i = 0; i < data.size(); ++i) out.data[i] = data[i];
  return out;
}

inline hal::CanFrame extended_frame(std::uint32_t id, std::vector<std::uint8_t> data = {}) {
  hal::CanFrame out = frame(id, std::move(data));
  out.extended = true;
  return out;
}

/// What went over the wire.
struct Wire {
  struct Entry {
    hal::CanFrame frame;
    int sender;
    std::int64_t start_ns;
    std::int64_t end_ns;
    friend bool operator==(const Entry& a, const Entry& b) {
      return a.frame == b.frame && a.sender == b.sender && a.start_ns == b.start_ns &&
             a.end_ns == b.end_ns && a.frame.stamp_ns == b.frame.stamp_ns;
    }
  };
  std::vector<Entry> entries;

  hal::InProcessBus::Observer observer() {
    return [this](const hal::WireRecord& record) {
      entries.push_back({record.frame, record.sender, record.start_ns, record.end_ns});
    };
  }
  std::vector<std::uint32_t> ids() const {
    std::vector<std::uint32_t> out;
    for (const Entry& entry : entries) out.push_back(entry.frame.id);
    return out;
  }
};

using Ids = std::vector<std::uint32_t>;
inline constexpr std::int64_t kIntermission_ns = 3'000;  // at 1 Mbit/s

}  // namespace hoof::test
