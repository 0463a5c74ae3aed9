// Ticks that take longer than there is time for.
#pragma once

#include <cstdint>

#include "firmware/control/types.h"

namespace hoof::firmware::safety {

/// One tick too long is late by as much and caught up; three in a row are a loop that does not keep
/// pace with its drives.
class OverrunWatch {
 public:
  /// A tick's work, by the local clock, from its begin to the end of its last write.
  /// @return kOverrun with the third tick in a row that took longer than a millisecond, and with
  ///         each that follows it
  control::FaultBits note(std::int64_t begin_ns, std::int64_t end_ns);

  /// Ticks that took too long since start.
  std::uint32_t overruns() const { return overruns_; }

 private:
  std::uint32_t overruns_ = 0;
  std::uint8_t in_a_row_ = 0;
};

}  // namespace hoof::firmware::safety
