// Frames between the receive interrupt and the main loop.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace hoof::hal {

/// One writer, which may interrupt the one reader; never the other way round.
/// @tparam Frame as the peripheral holds it
/// @tparam kPlaces a power of two, as both counts go on past 2^32
/// @tparam kUrgent of them only urgent frames may take, so that no flood of others keeps an e-stop
/// out
template <typename Frame, std::uint32_t kPlaces, std::uint32_t kUrgent>
class ReceiveQueue {
  static_assert((kPlaces & (kPlaces - 1)) == 0 && kUrgent < kPlaces);

 public:
  static constexpr std::uint32_t kSize = kPlaces;
  static constexpr std::uint32_t kUrgentPlaces = kUrgent;

  /// @return false when there is no place; the frame is then lost
  bool put(const Frame& frame, bool urgent) {
    const std::uint32_t written = written_.load(std::memory_order_relaxed);
    const std::uint32_t waiting = written - taken_.load(std::memory_order_relaxed);
    if (waiting >= (urgent ? kSize : kSize - kUrgentPlaces)) return false;
    frames_[written % kSize] = frame;
    std::atomic_signal_fence(std::memory_order_release);
    written_.store(written + 1, std::memory_order_relaxed);
    return true;
  }

  bool take(Frame& frame) {
    const Frame* first = oldest();
    if (first == nullptr) return false;
    frame = *first;
    drop();
    return true;
  }

  /// Stays where it is until drop(). @return null when nothing waits
  const Frame* oldest() const {
    if (empty()) return nullptr;
    std::atomic_signal_fence(std::memory_order_acquire);
    return &frames_[taken_.load(std::memory_order_relaxed) % kSize];
  }

  /// The oldest has been read. @pre there is one
  void drop() {
    std::atomic_signal_fence(std::memory_order_release);
    taken_.store(taken_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  }

  bool empty() const {
    return written_.load(std::memory_order_relaxed) == taken_.load(std::memory_order_relaxed);
  }

 private:
  std::array<Frame, kSize> frames_{};
  std::atomic<std::uint32_t> written_{0};
  std::atomic<std::uint32_t> taken_{0};
};

}  // namespace hoof::hal
