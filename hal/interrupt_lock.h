// No interrupt handler runs while one of these lives.
#pragma once

#include <cstdint>

namespace hoof::hal {

#if defined(__arm__)

class InterruptLock {
 public:
  [[gnu::always_inline]] InterruptLock() {
    asm volatile("mrs %0, primask\n\tcpsid i" : "=r"(primask_)::"memory");
  }
  [[gnu::always_inline]] ~InterruptLock() {
    asm volatile("msr primask, %0" ::"r"(primask_) : "memory");
  }

#else

/// On the host nothing interrupts a driver: tests call its handlers themselves.
class InterruptLock {
 public:
  InterruptLock() {}
  ~InterruptLock() {}

#endif

  InterruptLock(const InterruptLock&) = delete;
  InterruptLock& operator=(const InterruptLock&) = delete;

#if defined(__arm__)
 private:
  std::uint32_t primask_;
#endif
};

}  // namespace hoof::hal
