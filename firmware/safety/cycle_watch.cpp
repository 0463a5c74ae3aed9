#include "firmware/safety/cycle_watch.h"

namespace hoof::firmware::safety {

void CycleWatch::begin() {
  count_ = 0;
  due_ = false;
}

void CycleWatch::passed(Stage stage) {
  count_ = static_cast<std::uint8_t>(stage) == count_ ? count_ + 1 : kBroken;
}

bool CycleWatch::finished() const {
  constexpr std::uint8_t kIdle = 1;
  constexpr std::uint8_t kAll = 4;
  return count_ == (due_ ? kAll : kIdle);
}

}  // namespace hoof::firmware::safety
