#include "tools/emulator/board.h"

#include <algorithm>
#include <cstring>
#include <random>
#include <vector>

namespace hoof::tools::emulator {
namespace {

constexpr std::uint32_t kFlash = 0x0800'0000, kFlashBytes = 1u << 20;
constexpr std::uint32_t kData = FlashController::kDataStart;
constexpr std::uint32_t kAfterData = kData + FlashController::kDataBytes;
constexpr std::uint32_t kSlots = FlashController::kSlotsStart;
constexpr std::uint32_t kAfterSlots = kSlots + FlashController::kSlotsBytes;
constexpr std::uint32_t kRam = 0x2000'0000, kRamBytes = 128u << 10;
constexpr std::uint32_t kPeripherals = 0x4000'0000, kPeripheralBytes = 0x8'0000;
constexpr std::uint32_t kSystem = 0xE000'E000, kSystemBytes = 0x1000;

constexpr std::uint32_t kSystemMemory = 0x1FFF'7000, kSystemMemoryBytes = 0x1000;

constexpr std::uint32_t kButtonPin = 12, kEnablePin = 8, kTimer1Function = 1;
// Clock enables: AHB1ENR of the ports, APB2ENR of TIM1, USART1 and ADC1, APB1ENR of the others.
constexpr std::uint32_t kPortAClock = 0, kPortBClock = 1, kPortCClock = 2;
constexpr std::uint32_t kTimer1Clock = 0, kAdc1Clock = 8, kCan1Clock = 25, kCan2Clock = 26;
constexpr std::uint32_t kPowerClock = 28, kUsart2Clock = 17, kUsart1Clock = 4;

}  // namespace

hal::RamFlash blank_flash(std::uint32_t seed) {
  const std::size_t words = FlashController::kSectorBytes / 4;
  const std::size_t slot_words = FlashController::kSlotBytes / 4;
  return hal::RamFlash({words, words, words, slot_words, slot_words}, seed);
}

Board::Board(ElfFile image, hal::Nonvolatile& flash)
    : image_(std::move(image)), flash_(flash, time_, [this](Cycles cycles) { spend(cycles); }) {
  const auto apb1 = [this] { return rcc_.apb1_MHz(); };
  can_[0] = std::make_unique<BxCan>(1, time_, nvic_, filters_, 19, apb1);
  can_[1] = std::make_unique<BxCan>(2, time_, nvic_, filters_, 63, apb1);
  cpu_.map_memory(kFlash, kData - kFlash, Cpu::Access::kReadExecute);
  cpu_.map_memory(kAfterData, kSlots - kAfterData, Cpu::Access::kReadExecute);
  cpu_.map_flash(kSlots, flash_.slots(), *this);
  cpu_.map_memory(kAfterSlots, kFlash + kFlashBytes - kAfterSlots, Cpu::Access::kReadExecute);
  cpu_.map_memory(kRam, kRamBytes, Cpu::Access::kAll);
  cpu_.map_memory(kSystemMemory, kSystemMemoryBytes, Cpu::Access::kReadExecute);
  cpu_.map_registers(kData, FlashController::kDataBytes, *this);
  cpu_.map_registers(kPeripherals, kPeripheralBytes, *this);
  cpu_.map_registers(kSystem, kSystemBytes, *this);
  load_image();
  press_emergency_stop(false);
}

void Board::load_image() {
  const std::vector<std::uint8_t> erased(kFlashBytes, 0xFF);
  cpu_.write_memory(kFlash, erased.data(), kData - kFlash);
  cpu_.write_memory(kAfterData, erased.data(), kSlots - kAfterData);
  cpu_.write_memory(kAfterSlots, erased.data(), kFlash + kFlashBytes - kAfterSlots);
  const auto factory = Adc::factory_calibration();
  cpu_.write_memory(Adc::kFactoryAddress, factory.data(), sizeof factory);
  flash_.show_slots();
  const bool blank = std::ranges::all_of(flash_.slots(), [](auto byte) { return byte == 0xFF; });
  for (const ElfFile::Segment& s : image_.segments) {
    const bool slot = s.load_address >= kSlots && s.load_address < kAfterSlots;
    if (!slot) load_segment(s);
    if (slot && blank) load_slots(s.load_address, s.bytes);
    cpu_.watch_unmasking(s.run_address, s.bytes);
  }
}

void Board::load_segment(const ElfFile::Segment& s) {
  if (cpu_.write_memory(s.load_address, s.bytes.data(), s.bytes.size())) return;
  throw EmulatorError("the image has " + std::to_string(s.bytes.size()) + " bytes at " +
                      hex(s.load_address) + ", where it cannot be written");
}

void Board::load_slots(std::uint32_t address, const std::vector<std::uint8_t>& bytes) {
  for (std::size_t i = 0; i < bytes.size(); i += 4) {
    std::uint32_t word = hal::Nonvolatile::kErased;
    std::memcpy(&word, bytes.data() + i, std::min<std::size_t>(4, bytes.size() - i));
    flash_.put_word(address + std::uint32_t(i), word);
  }
}

void Board::connect(std::size_t bus, std::unique_ptr<CanWire> wire) {
  can_[bus]->connect(std::move(wire));
}

void Board::hear(std::size_t bus, const std::string& bytes, std::uint32_t baud) {
  usart_[bus].receive(bytes, baud);
  if (powered_ && state_ == State::kAsleep && core_.wakes()) run();
}

/// The button's loop feeds 3.3 V to the pin; pressed, it is open.
void Board::press_emergency_stop(bool pressed) {
  port_b_.wire_high(kButtonPin, !pressed);
  timer1_.on_input();
}

/// What an input that no pin is switched to reads as is not told anywhere.
bool Board::break_level() const {
  if (port_b_.has_function(kButtonPin, kTimer1Function)) return port_b_.level(kButtonPin);
  throw EmulatorError("TIM1: the break is on, and no pin is its input");
}

double Board::drive_enable_Hz() const {
  return powered_ && port_a_.has_function(kEnablePin, kTimer1Function) ? timer1_.wave_Hz() : 0;
}

void Board::set_clock_faults(const ClockFaults& faults) {
  const bool fails = faults.crystal_dead && rcc_.from_crystal() && powered_;
  rcc_.set_faults(faults);
  if (!fails) return;
  if (!rcc_.fail_crystal()) throw EmulatorError("the crystal fails, and nobody watches it");
  timer1_.on_clock_failure();
  nvic_.pend(exception::kNmi);
}

void Board::power_on() {
  std::mt19937 random(1);
  std::vector<std::uint32_t> noise(kRamBytes / 4);
  for (std::uint32_t& word : noise) word = std::uint32_t(random());
  cpu_.write_memory(kRam, noise.data(), kRamBytes);
  resets_ = 0;
  powered_ = true;
  start(hal::ResetCause::kPowerOn);
  run();
}

void Board::reset(hal::ResetCause cause) {
  start(cause);
  run();
}

void Board::start(hal::ResetCause cause) {
  last_reset_ = cause;
  if (cause != hal::ResetCause::kPowerOn) ++resets_;
  nvic_.reset();
  control_.reset();
  system_tick_.reset();
  rcc_.reset();
  rcc_.note_reset(cause);
  flash_.reset();
  cpu_.forget_code(kSlots, FlashController::kSlotsBytes);
  cpu_.watch_unmasking(kSlots, flash_.slots());
  iwdg_.reset();
  pwr_.reset();
  port_a_.reset();
  port_b_.reset();
  port_c_.reset();
  timer1_.reset();
  adc_.reset();
  for (Usart& usart : usart_) usart.reset();
  for (const auto& can : can_) can->reset();
  core_.reset(kFlash);
  state_ = State::kAsleep;
}

/// Until the image sleeps; where it resets itself, until it sleeps after that.
void Board::run() {
  try {
    run_core();
  } catch (const hal::PowerCut&) {
    powered_ = false;
  } catch (const EmulatorError& error) {
    throw EmulatorError(std::string(error.what()) + ", in the straight line of code from " +
                        image_.place(cpu_.registers().pc & ~1u));
  }
}

void Board::run_core() {
  constexpr int kMostResets = 10;
  for (int i = 0; i < kMostResets; ++i) {
    switch (core_.run()) {
      case Core::Stop::kAsleep:
        state_ = State::kAsleep;
        return;
      case Core::Stop::kResetRequested:
        start(hal::ResetCause::kSoftware);
        break;
      case Core::Stop::kLockedUp:
      case Core::Stop::kStuck:
        state_ = State::kStuck;  // time goes on, and the watchdog ends it
        if (iwdg_.running()) return;
        throw EmulatorError("the image never sleeps, and no watchdog runs");
    }
  }
  throw EmulatorError("the image resets itself again and again");
}

/// The core waits: the counters go on.
void Board::spend(Cycles cycles) {
  time_.now += cycles;
  system_tick_.advance();
}

bool Board::advance_buses(bool overrun) {
  bool waiting = false;
  for (const auto& can : can_) waiting = can->advance(overrun) || waiting;
  return waiting;
}

void Board::advance_to(Cycles t) {
  if (!powered_) {
    time_.now = std::max(time_.now, t);
    return;
  }
  if (time_.now > t) {
    advance_buses(true);  // the core is behind: it waits for the flash
    return;
  }
  for (;;) {
    Cycles next = std::min(t, system_tick_.next_tick());
    if (iwdg_.running()) next = std::min(next, iwdg_.deadline());
    time_.now = std::max(time_.now, next);
    system_tick_.advance();
    const bool arrived = time_.now >= t;
    const bool waiting = arrived && advance_buses(false);
    if (iwdg_.expired()) {
      start(hal::ResetCause::kWatchdog);
      run();
    } else if (state_ == State::kAsleep && core_.wakes()) {
      run();
    } else if (time_.now >= t && waiting) {
      advance_buses(true);  // nobody takes them
    }
    // A core that came to t by waiting for the flash has not seen what the buses bring at t.
    if (!powered_ || ((arrived || time_.now > t) && !waiting)) return;
    if (state_ == State::kStuck && time_.now >= t) return;
  }
}

Peripheral& Board::peripheral_at(std::uint32_t address, std::uint32_t& offset) {
  const auto with_clock = [&](Peripheral& block, bool on) -> Peripheral& {
    if (on) return block;
    throw EmulatorError(std::string(block.name()) + " is used while its clock is off");
  };
  const auto block = [&](std::uint32_t base) { return offset = address - base, address >= base; };
  if (address >= kSystem) {
    if (block(0xE000'ED00)) return control_;
    if (block(0xE000'E100)) return nvic_;
    if (block(0xE000'E010)) return system_tick_;
  }
  offset = address & 0x3FF;
  switch (address & ~0x3FFu) {
    case 0x4000'3000:
      return iwdg_;
    case 0x4000'4400:
      return with_clock(usart_[1], rcc_.apb1_on(kUsart2Clock));
    case 0x4001'0000:
      return with_clock(timer1_, rcc_.apb2_on(kTimer1Clock));
    case 0x4001'2000:
      return with_clock(adc_, rcc_.apb2_on(kAdc1Clock));
    case 0x4001'1000:
      return with_clock(usart_[0], rcc_.apb2_on(kUsart1Clock));
    case 0x4000'6400:
      return with_clock(*can_[0], rcc_.apb1_on(kCan1Clock));
    case 0x4000'6800:
      return with_clock(*can_[1], rcc_.apb1_on(kCan2Clock) && rcc_.apb1_on(kCan1Clock));
    case 0x4000'7000:
      return with_clock(pwr_, rcc_.apb1_on(kPowerClock));
    case 0x4002'0000:
      return with_clock(port_a_, rcc_.ahb1_on(kPortAClock));
    case 0x4002'0400:
      return with_clock(port_b_, rcc_.ahb1_on(kPortBClock));
    case 0x4002'0800:
      return with_clock(port_c_, rcc_.ahb1_on(kPortCClock));
    case 0x4002'3800:
      return rcc_;
    case 0x4002'3C00:
      return flash_;
    default:
      throw EmulatorError("no model of a register at " + hex(address));
  }
}

std::uint32_t Board::read(std::uint32_t address, unsigned bytes) {
  if (address >= kData && address < kAfterData) {
    const std::uint32_t word = flash_.read_word(address & ~3u);
    return word >> (8 * (address & 3)) & (bytes == 4 ? ~0u : (1u << (8 * bytes)) - 1);
  }
  if (bytes != 4)
    throw EmulatorError("register " + hex(address) + " is read by " + std::to_string(bytes) +
                        " bytes");
  std::uint32_t offset = 0;
  return peripheral_at(address, offset).read(offset);
}

void Board::write(std::uint32_t address, unsigned bytes, std::uint32_t value) {
  if (bytes != 4)
    throw EmulatorError("register " + hex(address) + " is written by " + std::to_string(bytes) +
                        " bytes");
  const bool slot = address >= kSlots && address < kAfterSlots;
  if (slot || (address >= kData && address < kAfterData))
    return flash_.program_word(address, value);
  std::uint32_t offset = 0;
  peripheral_at(address, offset).write(offset, value);
  if (control_.reset_requested()) cpu_.request_stop();
}

}  // namespace hoof::tools::emulator
