#include "tools/log/cut.h"

#include <algorithm>
#include <cmath>

#include "firmware/protocol/codec.h"
#include "hal/can_timing.h"
#include "tools/run/errors.h"

namespace hoof::tools {
namespace {

namespace protocol = firmware::protocol;

/// When the SYNC of tick `tick` or the first after it began, or nothing: both buses carry it at the
/// same time, so that its start is what parts one tick from the next.
std::optional<std::int64_t> start_of_tick(const BusRecording& recording, std::uint32_t tick) {
  for (const LoggedFrame& logged : recording.frames) {
    protocol::Sync sync;
    if (logged.bus != 0 || decode(logged.frame, sync) != protocol::DecodeResult::kOk) continue;
    if (sync.tick >= tick) return logged.stamp_ns - hal::frame_time_ns(logged.frame);
  }
  return {};
}

}  // namespace

BusRecording cut(const BusRecording& recording, const CutRange& range) {
  std::int64_t from_ns = INT64_MIN, to_ns = INT64_MAX;
  const auto at_s = [&](double s) { return recording.origin_ns + std::llround(s * 1e9); };
  if (range.from_s) from_ns = at_s(*range.from_s);
  if (range.to_s) to_ns = at_s(*range.to_s);
  if (range.from_tick) {
    const auto start = start_of_tick(recording, *range.from_tick);
    if (!start) {
      throw UserError(recording.path.string() + ": no SYNC of tick " +
                      std::to_string(*range.from_tick) + " or later");
    }
    from_ns = std::max(from_ns, *start);
  }
  if (range.to_tick && *range.to_tick != UINT32_MAX) {
    if (const auto end = start_of_tick(recording, *range.to_tick + 1))
      to_ns = std::min(to_ns, *end);
  }
  BusRecording part = recording;
  std::erase_if(part.frames, [&](const LoggedFrame& logged) {
    return logged.stamp_ns < from_ns || logged.stamp_ns >= to_ns;
  });
  if (part.frames.empty()) {
    throw UserError(
        recording.path.string() + ": no frames there; the recording is from " +
        std::to_string(double(recording.first_ns() - recording.origin_ns) * 1e-9) + " to " +
        std::to_string(double(recording.last_ns() - recording.origin_ns) * 1e-9) + " s");
  }
  return part;
}

}  // namespace hoof::tools
