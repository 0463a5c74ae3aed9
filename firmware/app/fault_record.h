// One fault as it is kept in flash: what, when, and the ticks that led to it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "firmware/app/trace_ring.h"
#include "firmware/control/types.h"
#include "hal/nonvolatile.h"

namespace hoof::firmware::app {

struct FaultRecord {
  std::int64_t time_ns = 0;  // local clock, since its start
  std::uint32_t tick = 0;    // number of the SYNC
  control::FaultBits faults = 0;
  control::Mode mode = control::Mode::kOff;  // in which it happened
  std::size_t trace_count = 0;
  std::array<TraceSample, TraceRing::kTicks> trace{};  // newest first

  friend bool operator==(const FaultRecord&, const FaultRecord&) = default;
};

inline constexpr std::size_t kTraceSampleWords = 3 + 3 * control::kJointCount;
inline constexpr std::size_t kFaultRecordWords =
    1 + 2 + 1 + 2 + TraceRing::kTicks * kTraceSampleWords + 1;

/// Magic, time, tick, bits, trace, CRC-32 of all before.
using FaultRecordWords = std::array<hal::Nonvolatile::Word, kFaultRecordWords>;

void encode(const FaultRecord& record, FaultRecordWords& words);

/// Nothing unless the CRC tells that the record is whole.
std::optional<FaultRecord> decode(const FaultRecordWords& words);

}  // namespace hoof::firmware::app
