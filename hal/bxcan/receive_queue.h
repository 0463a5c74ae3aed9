// Frames between the receive interrupt and the main loop.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace hoof::hal::bxcan {

/// A frame as the peripheral holds it, with its arrival: a quarter of a CanFrame.
struct ReceivedFrame {
  std::uint32_t identifier = 0;
  std::uint32_t length = 0;
  std::uint32_t low = 0;
  std::uint32_t high = 0;
  std::int64_t stamp_ns = 0;
};

/// One writer, which may interrupt the one reader; never the other way round.
class ReceiveQueue {
 public:
  static constexpr std::uint32_t kSize = 32;
  /// Places that only urgent frames may take, so that no flood of others keeps an e-stop out.
  static constexpr std::uint32_t kUrgentPlaces = 3;

  /// @return false when there is no place; the frame is then lost
  bool put(const ReceivedFrame& frame, bool urgent) {
    const std::uint32_t written = written_.load(std::memory_order_relaxed);
    const std::uint32_t waiting = written - taken_.load(std::memory_order_relaxed);
    if (waiting >= (urgent ? kSize : kSize - kUrgentPlaces)) return false;
    frames_[written % kSize] = frame;
    std::atomic_signal_fence(std::memory_order_release);
    written_.store(written + 1, std::memory_order_relaxed);
    return true;
  }

  bool take(ReceivedFrame& frame) {
    if (empty()) return false;
    std::atomic_signal_fence(std::memory_order_acquire);
    const std::uint32_t taken = taken_.load(std::memory_order_relaxed);
    frame = frames_[taken % kSize];
    std::atomic_signal_fence(std::memory_order_release);
    taken_.store(taken + 1, std::memory_order_relaxed);
    return true;
  }

  bool empty() const {
    return written_.load(std::memory_order_relaxed) == taken_.load(std::memory_order_relaxed);
  }

 private:
  std::array<ReceivedFrame, kSize> frames_{};
  std::atomic<std::uint32_t> written_{0};  // both count on for ever, past 2^32
  std::atomic<std::uint32_t> taken_{0};
};

}  // namespace hoof::hal::bxcan
