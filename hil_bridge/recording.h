// What all recordings of a run have in common.
#pragma once

#include <cstdint>

namespace hoof::bridge {

/// Where simulated time 0 stands on the calendar: 2026-01-01T00:00:00Z as Unix time. Recordings
/// carry absolute time, as every CAN and LCM tool expects; a fixed day instead of the day of the
/// run makes the same run give the same bytes.
inline constexpr std::int64_t kSimulatedEpoch_s = 1'767'225'600;
inline constexpr std::int64_t kSimulatedEpoch_ns = kSimulatedEpoch_s * 1'000'000'000;

/// A run that is killed loses no more than this much simulated time of its recordings. A system
/// call every ten control ticks costs next to nothing.
inline constexpr std::int64_t kRecordingFlush_ns = 10'000'000;

}  // namespace hoof::bridge
