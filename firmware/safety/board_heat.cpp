#include "firmware/safety/board_heat.h"

namespace hoof::firmware::safety {

control::FaultBits BoardHeatWatch::note(float temperature_C) {
  const bool is_hot = temperature_C > kHottestBoard_C;  // false for not-a-number
  const bool stays = is_hot && was_hot_;
  was_hot_ = is_hot;
  return stays ? control::fault::kOverTemperature : 0;
}

}  // namespace hoof::firmware::safety
