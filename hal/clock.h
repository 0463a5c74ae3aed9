// Time of one node. Monotonic, no relation to the calendar.
#pragma once

#include <cstdint>

namespace hoof::hal {

class Clock {
 public:
  virtual std::int64_t now_ns() const = 0;

 protected:
  ~Clock() = default;
};

}  // namespace hoof::hal
