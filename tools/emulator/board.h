// The board around the image: memory, models, supply, resets, time.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "hal/board.h"
#include "hal/in_process/ram_flash.h"
#include "tools/emulator/adc.h"
#include "tools/emulator/bxcan.h"
#include "tools/emulator/core.h"
#include "tools/emulator/elf_file.h"
#include "tools/emulator/flash_controller.h"
#include "tools/emulator/gpio.h"
#include "tools/emulator/iwdg.h"
#include "tools/emulator/pwr.h"
#include "tools/emulator/rcc.h"
#include "tools/emulator/system_tick.h"
#include "tools/emulator/timer1.h"
#include "tools/emulator/usart.h"

namespace hoof::tools::emulator {

/// What a part fresh from the factory keeps: sectors 1 to 3 of data, 5 and 6 for images.
hal::RamFlash blank_flash(std::uint32_t seed = 1);

/// Runs the image as it is. The core is taken to be infinitely fast: time stands still while it
/// runs and passes while it sleeps, or waits for the flash. So its answers have the simulator's
/// time, as the loop's in one process have.
class Board final : private RegisterSpace {
 public:
  static constexpr std::size_t kBuses = 2;

  /// @param image is written as a programmer would write it; into the slots only where both are
  /// blank, so that an update outlives the board as well
  /// @param flash what sectors 1 to 3, 5 and 6 hold: outlives the board, as real flash does a
  /// supply
  Board(ElfFile image, hal::Nonvolatile& flash);

  /// The supply comes on: RAM holds anything, the image starts. Runs until it sleeps for the first
  /// time. @throws EmulatorError
  void power_on();
  /// The reset pin, a fallen supply that comes back, or whatever else.
  void reset(hal::ResetCause cause);
  bool powered() const { return powered_; }

  /// Time comes to `t`: the image wakes where something happens before or at it.
  void advance_to(Cycles t);
  Cycles now() const { return time_.now; }
  /// The next tick of SysTick.
  Cycles next_tick() const { return system_tick_.next_tick(); }

  void connect(std::size_t bus, std::unique_ptr<CanWire> wire);
  /// Bytes come on the serial line in place of a bus; the image runs where they wake it.
  void hear(std::size_t bus, const std::string& bytes, std::uint32_t baud = 1'000'000);
  std::string take_said(std::size_t bus) { return usart_[bus].take_sent(); }
  /// Acts on the drives' line at once; the image wakes when time goes on.
  void press_emergency_stop(bool pressed);
  /// The square wave on the line that lets the drives have torque; 0 where there is none.
  double drive_enable_Hz() const;
  void set_voltages(const BoardVoltages& voltages) { adc_.set_voltages(voltages); }
  const BoardVoltages& voltages() const { return adc_.voltages(); }
  void set_converter_dead(bool dead) { adc_.set_dead(dead); }
  void set_supply_low(bool low) { pwr_.set_supply_low(low); }
  /// A crystal that fails while the core runs by it is told by the clock security system, if that
  /// is on; without it the core stands still for good.
  void set_clock_faults(const ClockFaults& faults);
  /// SysTick stands: it counts no more, or again.
  void set_tick_stuck(bool stuck) { system_tick_.set_stuck(stuck); }
  void set_watchdog_oscillator_Hz(std::uint32_t hertz) { iwdg_.set_oscillator_Hz(hertz); }

  std::uint32_t resets() const { return resets_; }  // since power-on
  hal::ResetCause last_reset() const { return last_reset_; }
  bool stuck() const { return state_ == State::kStuck; }

  const ElfFile& image() const { return image_; }
  Cpu& cpu() { return cpu_; }
  const Core::Counts& counts() const { return core_.counts(); }

 private:
  enum class State { kAsleep, kStuck };

  std::uint32_t read(std::uint32_t address, unsigned bytes) override;
  void write(std::uint32_t address, unsigned bytes, std::uint32_t value) override;
  Peripheral& peripheral_at(std::uint32_t address, std::uint32_t& offset);
  void load_image();
  void load_segment(const ElfFile::Segment& segment);
  void load_slots(std::uint32_t address, const std::vector<std::uint8_t>& bytes);
  void start(hal::ResetCause cause);
  void run();
  void run_core();
  void spend(Cycles cycles);
  bool advance_buses(bool overrun);
  bool break_level() const;

  ElfFile image_;
  BoardTime time_;
  Nvic nvic_;
  Cpu cpu_{[this] { return nvic_.highest_pending() != 0; }};
  SystemControl control_{nvic_};
  Core core_{cpu_, nvic_, control_};
  SystemTick system_tick_{time_, nvic_};
  Rcc rcc_{[this](std::uint32_t megahertz) { system_tick_.set_core_MHz(megahertz); }};
  FlashController flash_;
  Iwdg iwdg_{time_};
  Pwr pwr_;
  Gpio port_a_{Gpio::kPortA}, port_b_{Gpio::kPortB}, port_c_{Gpio::kPortC};
  Timer1 timer1_{nvic_, [this] { return break_level(); }, [this] { return rcc_.timer2_MHz(); }};
  Adc adc_{time_, [this] { return rcc_.apb2_MHz(); },
           [this](std::uint32_t) { return port_c_.mode(0) == Gpio::Mode::kAnalog; }};
  CanFilters filters_;
  std::array<std::unique_ptr<BxCan>, kBuses> can_;
  std::array<Usart, kBuses> usart_{Usart{1, 37, nvic_, [this] { return rcc_.apb2_MHz(); }},
                                   Usart{2, 38, nvic_, [this] { return rcc_.apb1_MHz(); }}};
  State state_ = State::kAsleep;
  bool powered_ = false;
  std::uint32_t resets_ = 0;
  hal::ResetCause last_reset_ = hal::ResetCause::kPowerOn;
};

}  // namespace hoof::tools::emulator
