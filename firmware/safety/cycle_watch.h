// Which stages of a control cycle were passed, and in order: what the watchdog is fed for.
#pragma once

#include <cstdint>

namespace hoof::firmware::safety {

enum class Stage : std::uint8_t { kRead = 0, kDecide, kGate, kWrite };

/// The loop tells each stage when it is done with it. A cycle without a due tick is finished once
/// it has read; one with a due tick only after all stages, each once and in their order. A loop
/// that hangs, returns early or runs its stages out of order does not feed the watchdog.
class CycleWatch {
 public:
  /// A cycle begins; what was passed before does not count any more.
  void begin();
  /// The cycle has a tick to run.
  void tick_due() { due_ = true; }
  void passed(Stage stage);
  bool finished() const;

 private:
  static constexpr std::uint8_t kBroken = 0xFF;  // stays until begin()

  std::uint8_t count_ = 0;  // stages passed in order
  bool due_ = false;
};

}  // namespace hoof::firmware::safety
