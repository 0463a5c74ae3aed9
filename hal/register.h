// One 32-bit register of a peripheral. On the board a volatile word; on the host a word whose
// accesses a test can watch, so that the very driver source runs over a simulated peripheral.
#pragma once

#include <cstdint>

namespace hoof::hal {

#if defined(__arm__)

class Register {
 public:
  [[gnu::always_inline]] std::uint32_t read() const { return value_; }
  [[gnu::always_inline]] void write(std::uint32_t value) { value_ = value; }

#else

class Register;

/// The simulated peripherals. A register that nobody simulates is a plain word.
class RegisterWatcher {
 public:
  /// @return what the driver gets
  virtual std::uint32_t on_read(Register& accessed) = 0;
  virtual void on_write(Register& accessed, std::uint32_t value) = 0;

 protected:
  ~RegisterWatcher() = default;
};

class Register {
 public:
  inline static RegisterWatcher* watcher = nullptr;

  std::uint32_t read() const {
    return watcher == nullptr ? value_ : watcher->on_read(const_cast<Register&>(*this));
  }
  void write(std::uint32_t value) {
    if (watcher == nullptr) {
      value_ = value;
    } else {
      watcher->on_write(*this, value);
    }
  }

  // For the simulation: past the watcher.
  std::uint32_t stored() const { return value_; }
  void store(std::uint32_t value) { value_ = value; }

#endif

  /// Read, change, write: not for registers whose bits are cleared by writing 1.
  [[gnu::always_inline]] void change(std::uint32_t clear, std::uint32_t set) {
    write((read() & ~clear) | set);
  }
  [[gnu::always_inline]] void set(std::uint32_t bits) {
    change(0, bits);
  }
  [[gnu::always_inline]] void clear(std::uint32_t bits) {
    change(bits, 0);
  }
  [[gnu::always_inline]] bool has(std::uint32_t bits) const {
    return (read() & bits) == bits;
  }
  [[gnu::always_inline]] bool has_any(std::uint32_t bits) const {
    return (read() & bits) != 0;
  }

 private:
#if defined(__arm__)
  volatile std::uint32_t value_;
#else
  std::uint32_t value_ = 0;
#endif
};

static_assert(sizeof(Register) == 4);

/// Waits until `done()` holds, looking at most `tries` times: nothing in this firmware waits for
/// ever. Counted and not timed, so that it also ends where no clock runs.
/// @return whether it came to hold
template <typename Done>
[[gnu::always_inline]] inline bool wait_until(std::uint32_t tries, Done&& done) {
  for (std::uint32_t i = 0; i < tries; ++i) {
    if (done()) return true;
  }
  return false;
}

}  // namespace hoof::hal
