#include "firmware/safety/overrun.h"

namespace hoof::firmware::safety {

control::FaultBits OverrunWatch::note(std::int64_t begin_ns, std::int64_t end_ns) {
  constexpr std::int64_t kLongest_ns = 1'000'000;
  constexpr std::uint8_t kTooMany = 3;
  if (end_ns - begin_ns <= kLongest_ns) {
    in_a_row_ = 0;
    return 0;
  }
  ++overruns_;
  if (in_a_row_ < kTooMany) ++in_a_row_;
  return in_a_row_ == kTooMany ? control::fault::kOverrun : 0;
}

}  // namespace hoof::firmware::safety
