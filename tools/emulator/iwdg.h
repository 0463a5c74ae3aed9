// Independent watchdog: once started, only a reset of the part stops it.
//
// Source: RM0090 rev. 19, 21.3 and 21.4. Its oscillator has 17 to 47 kHz (DS8626); here 32 kHz
// unless set otherwise.
#pragma once

#include <cstdint>

#include "tools/emulator/peripheral.h"

namespace hoof::tools::emulator {

class Iwdg final : public Peripheral {
 public:
  explicit Iwdg(const BoardTime& time) : time_(time) {}

  const char* name() const override { return "IWDG"; }
  std::uint32_t read(std::uint32_t offset) override;
  void write(std::uint32_t offset, std::uint32_t value) override;
  void reset() override;

  void set_oscillator_Hz(std::uint32_t hertz) { oscillator_Hz_ = hertz; }
  bool expired() const { return running_ && time_.now >= deadline_; }
  bool running() const { return running_; }
  Cycles deadline() const { return deadline_; }

 private:
  void feed();
  void write_key(std::uint32_t key);

  const BoardTime& time_;
  std::uint32_t oscillator_Hz_ = 32'000;
  bool running_ = false;
  bool unlocked_ = false;
  std::uint32_t prescaler_ = 0, reload_ = 0xFFF;            // as written
  std::uint32_t prescaler_used_ = 0, reload_used_ = 0xFFF;  // as taken over by the slow clock
  int updating_looks_ = 0;
  Cycles deadline_ = 0;
};

}  // namespace hoof::tools::emulator
